"""Slips and plausible mistakes, one at a time: what the suite checks must notice each of them.

Every test here runs its check twice, unharmed and mutated; it passes before and fails after.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache, lru_cache
from importlib import import_module
from typing import Any

import numpy as np
import pytest

from compare.publications.kincaid import check
from compare.report.match import distance
from compare.report.program.deck import constants
from compare.report.program.listing import Case, coefficients, stab
from compare.report.recover import T_AS_RUN, Z_AS_RUN
from compare.report.tables import Row, all_rows, corrected
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic

# Modules, whatever name the packages give to a function in them.
uniform = import_module("hill.matrices.uniform")
stepped = import_module("hill.matrices.stepped")
determinant = import_module("hill.determinant.finite")
solver = import_module("hill.determinant.converged")
result = import_module("hill.determinant.result")
residues = import_module("hill.determinant.residues")
modes = import_module("hill.matrices.modes")
listing = import_module("compare.report.program.listing")
row_module = import_module("compare.report.row")
galerkin = import_module("floquet.weak_form")
ode = import_module("floquet.integrate.ode")
taylor = import_module("floquet.integrate.taylor")
cvodes = import_module("floquet.integrate.cvodes")
monodromies = import_module("floquet.period")

ROWS = {row.id: row for row in all_rows()}

# As in test_rows.py and test_galerkin.py, where they are measured (1.4e-13 and 1.2e-14).
P_TOLERANCE = 1e-11
MATRIX_TOLERANCE = 5e-14

Patch = pytest.MonkeyPatch


def rebuild(monkeypatch: Patch) -> None:
    """CasADi functions are cached; a mutated one is compiled anew and does not outlive its test."""
    cached = ((taylor, "_step"), (taylor, "_march"), (taylor, "folded"), (cvodes, "_integrator"))
    for module, name in cached:
        monkeypatch.setattr(module, name, lru_cache(getattr(module, name).__wrapped__))


# ---- the checks ----------------------------------------------------------------------------------


def matrices_meet(one: HillEquation, other: HillEquation) -> bool:
    pairs = zip((one.F, one.G, *one.H), (other.F, other.G, *other.H), strict=True)
    return all(np.max(np.abs(a - b)) <= MATRIX_TOLERANCE * np.max(np.abs(b)) for a, b in pairs)


def solutions_meet(one: HillEquation, other: HillEquation) -> bool:
    """P to eleven digits and within bounds that are worth something; T within its own."""
    h, f = solver.characteristic(one), monodromies.monodromy(other)
    apart, size = np.max(np.abs(h.polynomial - f.polynomial)), np.max(np.abs(h.polynomial))
    bounded = apart <= h.error + f.error <= P_TOLERANCE * size
    return bool(bounded and abs(h.T - f.T) <= h.T_error + f.T_error)


def row_is_sound(name: str) -> bool:
    """What test_rows.py asks of a row's two routes."""
    found = check(ROWS[name])
    size = np.max(np.abs(found.hill.polynomial))
    return bool(
        found.routes_agree
        and found.difference <= P_TOLERANCE * size
        and found.matrices <= MATRIX_TOLERANCE
        and found.hill.error + found.floquet.error <= P_TOLERANCE
    )


@cache
def row_was_sound(name: str) -> bool:
    """The same before any mutation: computed once."""
    return row_is_sound(name)


def row_comes_back(name: str) -> bool:
    """What test_rows.py asks of a row as run."""
    row = ROWS[name]
    found = stab(constants(row.run["beam"]), row.case, row.Omega)
    z_miss = distance(found.roots, corrected(row).z) if row.z else 0.0
    return (
        z_miss <= Z_AS_RUN and abs(max(found.STAB1, 0.0) - corrected(row).T) <= T_AS_RUN / row.Omega
    )


def damped(beam: UniformBeam | SteppedBeam, eta: float = 0.05) -> tuple[HillEquation, HillEquation]:
    """Both routes' equations at 2 omega_(1), with transverse damping."""
    return beam.equation(1.82, 0.3, eta), galerkin.galerkin(beam, 1.82, 0.3, eta)


UNIFORM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.3, omega_L=3.3)
STEPPED = SteppedBeam(
    T0=20.0, K_theta=1.0, xi_G=0.3, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6, omega_L=3.3
)
BEAMS = {"uniform": UNIFORM, "stepped": STEPPED}


def beam_meets(name: str) -> bool:
    return matrices_meet(*damped(BEAMS[name]))


# ---- coefficients --------------------------------------------------------------------------------


def slopes_at_end(N: int) -> np.ndarray:
    return np.array([modes.slope(n)(1.0) for n in range(1, N + 1)] + [1.0])


def values_at_end(N: int) -> np.ndarray:
    return np.array([modes.mode(n)(1.0) for n in range(1, N + 1)])


@pytest.mark.parametrize("share", [1.0, 2.0], ids=["dropped", "flipped"])
@pytest.mark.parametrize("place", ["steady", "pulsating"])
def test_follower_term(share: float, place: str, monkeypatch: Patch) -> None:
    """phi_j(1) phi_k'(1) of (4.5.19) and (4.5.23)."""
    assert row_was_sound("T1-12")
    right = getattr(uniform, place)

    def mutated(N: int, T0: float, *rest: Any) -> np.ndarray:
        arm = np.append(values_at_end(N), 0.5)
        return right(N, T0, *rest) - share * uniform._scale(N, T0) * np.outer(arm, slopes_at_end(N))

    monkeypatch.setattr(uniform, place, mutated)
    assert not row_is_sound("T1-12")
    assert not beam_meets("uniform")


def test_follower_term_as_printed(monkeypatch: Patch) -> None:
    """(4.5.23) as printed: phi_j(1) phi_k(1)."""
    assert row_was_sound("T1-12")
    right = uniform.pulsating

    def mutated(N: int, T0: float, *rest: Any) -> np.ndarray:
        G = right(N, T0, *rest).copy()
        wrong = values_at_end(N) - slopes_at_end(N)[:N]
        G[:N, :N] += uniform._scale(N, T0)[:N] * np.outer(values_at_end(N), wrong)
        return G

    monkeypatch.setattr(uniform, "pulsating", mutated)
    assert not row_is_sound("T1-12")


@pytest.mark.parametrize("name", ["uniform", "stepped"])
@pytest.mark.parametrize(
    "end",
    [
        lambda w, slope: np.zeros((len(w), len(w))),
        lambda w, slope: -np.outer(w, slope),
        lambda w, slope: np.outer(slope, w),
        lambda w, slope: np.outer(w, w),
    ],
    ids=["dropped", "flipped", "transposed", "as printed"],
)
def test_follower_term_of_the_weak_form(
    name: str, end: Callable[[Any, Any], Any], monkeypatch: Patch
) -> None:
    assert beam_meets(name)
    monkeypatch.setattr(galerkin, "_axial_end", end)
    assert not beam_meets(name)


@pytest.mark.parametrize(
    ("module", "name", "change", "beam"),
    [
        (uniform, "steady", lambda F: F.T, "uniform"),
        (uniform, "pulsating", lambda G: G.T, "uniform"),
        (uniform, "pulsating", lambda G: -G, "uniform"),
        (uniform, "stiffness", lambda S: S * (1.0 + 1e-12), "uniform"),
        (stepped, "thrust", lambda B: B.T, "stepped"),
        (stepped, "bending", lambda B: 0.999 * B, "stepped"),
        (stepped, "mass", lambda A: A + np.diag([0.0, 0.0, 0.0, 1e-12]), "stepped"),
        (stepped, "reduce", lambda F: F.T, "stepped"),
    ],
)
def test_a_changed_matrix(
    module: Any, name: str, change: Callable[[Any], Any], beam: str, monkeypatch: Patch
) -> None:
    """Transposed, of the other sign, or off by 1e-12."""
    assert beam_meets(beam)
    right = getattr(module, name)
    # what the module keeps is made anew, and does not outlive the test
    for own, kept in list(vars(module).items()):
        if hasattr(kept, "cache_clear"):
            monkeypatch.setattr(module, own, lru_cache(kept.__wrapped__))
    monkeypatch.setattr(module, name, lambda *given: change(right(*given)))
    assert not beam_meets(beam)


def test_an_error_that_both_routes_share(monkeypatch: Patch) -> None:
    """Where both transpose G they still meet; that the printed row is lost is what shows it."""
    row = ROWS["T1-22"]
    assert row_was_sound("T1-22")
    assert check(row).cause == "agrees"
    closed, weak = uniform.pulsating, row_module.galerkin
    monkeypatch.setattr(uniform, "pulsating", lambda *given: closed(*given).T)

    def mutated(*given: Any, **options: Any) -> HillEquation:
        equation = weak(*given, **options)
        return HillEquation(F=equation.F, G=equation.G.T, gamma=0.1, Omega=equation.Omega)

    monkeypatch.setattr(row_module, "galerkin", mutated)
    found = check(row)
    assert found.routes_agree
    assert found.cause not in ("agrees", "truncation")


def listed_minus_right(N: int, X: float) -> np.ndarray:
    """GJK(J,N+1) as listed, less what errata.toml has in its place; both are 0 for X = 0."""
    if X == 0.0:
        return np.zeros(N)
    apart = []
    for j in range(1, N + 1):
        P, D, lam, odd = modes.mode(j)(1.0), modes.slope(j)(1.0), modes.eigenvalue(j), (-1.0) ** j
        below = (lam**4 - X**4) * math.sin(X)
        listed = -(X**2 * D * math.sin(X) + X**3 * P * (math.cos(X) + odd))
        right = X**3 * D * (odd - math.cos(X)) - X**4 * P * math.sin(X)
        apart.append((listed - right) / below)
    return np.array(apart)


def with_listed_column(monkeypatch: Patch) -> None:
    right = uniform.pulsating

    def mutated(N: int, T0: float, K_theta: float, xi_G: float, sigma: float) -> np.ndarray:
        G = right(N, T0, K_theta, xi_G, sigma).copy()
        G[:N, N] += T0 / modes.eigenvalue(1) ** 4 * listed_minus_right(N, np.pi * sigma)
        return G

    monkeypatch.setattr(uniform, "pulsating", mutated)


def test_slip_in_the_rotation_column(monkeypatch: Patch) -> None:
    """The listing's GJK(J,N+1) is wrong at a finite omega_L, where Table 3 shows it."""
    finite, infinite = "T3-05a", "T1-21"
    before = characteristic(ROWS[finite].beam(2).equation(ROWS[finite].Omega, 0.1))
    assert row_was_sound(finite)
    assert row_is_sound(infinite)
    # the corrected form of errata.toml is the closed form
    N, X = 2, math.pi * 0.5
    column = uniform.pulsating(N, 20.0, 0.0, 0.5, 0.5)[:N, N] / uniform._scale(N, 20.0)[0]
    for j in range(1, N + 1):
        P, D, lam, odd = modes.mode(j)(1.0), modes.slope(j)(1.0), modes.eigenvalue(j), (-1.0) ** j
        right = X**3 * D * (odd - math.cos(X)) - X**4 * P * math.sin(X)
        # the terms it sums are up to 70 times as large
        assert column[j - 1] == pytest.approx(
            right / ((lam**4 - X**4) * math.sin(X)), rel=1e-12, abs=1e-13
        )

    with_listed_column(monkeypatch)
    assert not row_is_sound(finite)
    assert row_is_sound(infinite)
    slipped = characteristic(ROWS[finite].beam(2).equation(ROWS[finite].Omega, 0.1))
    # measured 2.2e-4 before, 1e-5 after: converged, so the truncation is in it too
    assert abs(before.T - ROWS[finite].T) > 1e-4
    assert abs(slipped.T - ROWS[finite].T) < 5e-5


@pytest.mark.parametrize("name", ["T3-02b", "T3-04b", "T3-05b"])
def test_amplitude_without_s_pi(name: str, monkeypatch: Patch) -> None:
    """The listing's A_s for C_s: the bar does not start unstrained, and Table 3 comes back."""
    row = ROWS[name]

    def T() -> float:
        equation = row.beam(2).equation(row.Omega, 0.1, 0.0, 5)
        return max(characteristic(equation, truncation="report").T, 0.0)

    assert row_was_sound(name)
    # measured 4.9e-3 to .18
    assert abs(T() - row.T) > 1e-3
    right = uniform.start_amplitude
    monkeypatch.setattr(uniform, "start_amplitude", lambda g, o, s: right(g, o, s) / (s * math.pi))
    assert not row_is_sound(name)
    with_listed_column(monkeypatch)
    # measured 4.7e-6 at most
    assert abs(T() - row.T) <= 1e-5


@pytest.mark.parametrize(
    "mutated",
    [
        lambda right: lambda gamma, sigma, s: -right(gamma, sigma, s),
        lambda right: lambda gamma, sigma, s: right(-gamma, sigma, s),
        lambda right: lambda gamma, sigma, s: right(gamma, 0.0, s),
        lambda right: lambda gamma, sigma, s: right(gamma, sigma, s) * (1.0 - 1e-9 * (s == 3)),
    ],
    ids=["sign", "sign of gamma", "static", "third off by 1e-9"],
)
def test_amplitudes_of_the_free_vibration(mutated: Any, monkeypatch: Patch) -> None:
    assert row_was_sound("T3-02b")
    monkeypatch.setattr(uniform, "start_amplitude", mutated(uniform.start_amplitude))
    assert not row_is_sound("T3-02b")


# ---- the equation --------------------------------------------------------------------------------


@pytest.mark.parametrize("harmonic", [1, 2, 6, 10], ids=["cos", "H_1", "H_3", "H_5"])
def test_drop_a_harmonic(harmonic: int, monkeypatch: Patch) -> None:
    """From the determinant, one at a time; omega_L is twice Omega."""
    assert row_was_sound("T3-02b")
    right = determinant.blocks

    def mutated(equation: HillEquation) -> Any:
        system = right(equation)
        assert harmonic in system.B
        return replace(system, B={p: B for p, B in system.B.items() if p != harmonic})

    monkeypatch.setattr(determinant, "blocks", mutated)
    assert not row_is_sound("T3-02b")


@pytest.mark.parametrize("s", [0, 1, 3, 5], ids=["cos", "H_1", "H_3", "H_5"])
def test_drop_a_harmonic_in_the_time_domain(s: int, monkeypatch: Patch) -> None:
    assert row_was_sound("T3-02b")
    right = monodromies.parameter_values

    def mutated(equation: HillEquation, **options: Any) -> Any:
        p = right(equation, **options)
        if s == 0:
            return replace(p, gamma=0.0)
        H = np.array(p.H)
        H[:, (s - 1) * equation.n : s * equation.n] = 0.0
        return replace(p, H=H)

    monkeypatch.setattr(monodromies, "parameter_values", mutated)
    assert not row_is_sound("T3-02b")


@pytest.mark.parametrize(
    "cosine",
    [
        lambda right: lambda f, tau, h, order: right(f, tau + 0.3 / f, h, order),
        lambda right: lambda f, tau, h, order: right(f, tau + 0.5 * np.pi / f, h, order),
        lambda right: lambda f, tau, h, order: right(2.0 * f, tau, h, order),
        lambda right: lambda f, tau, h, order: [-c for c in right(f, tau, h, order)],
    ],
    ids=["phase", "sine", "twice the frequency", "sign"],
)
def test_time_factor(cosine: Any, monkeypatch: Patch) -> None:
    """cos(Omega tau), and no cos(n Omega tau) as in (4.4.22)."""
    assert row_was_sound("T3-05b")
    rebuild(monkeypatch)
    monkeypatch.setattr(taylor, "_cosine", cosine(taylor._cosine))
    assert not row_is_sound("T3-05b")


def test_time_factor_of_the_second_witness(monkeypatch: Patch) -> None:
    """The ODE that CVODES integrates is written apart from the Taylor coefficients."""
    row = ROWS["T3-05b"]

    def meets() -> bool:
        found = check(row, method="cvodes")
        # CVODES measured 5e-13
        return found.routes_agree and found.difference <= P_TOLERANCE

    assert meets()
    rebuild(monkeypatch)
    right = cvodes.acceleration
    monkeypatch.setattr(
        cvodes, "acceleration", lambda q, v, tau, p, size: right(q, v, tau + 0.1, p, size)
    )
    assert not meets()


@pytest.mark.parametrize("beam", BEAMS)
def test_rotation_keeps_its_damping(beam: str, monkeypatch: Patch) -> None:
    """eta**2/4 subtracted from the bending coordinates only, as in the listing's DRIVER."""
    assert solutions_meet(*damped(BEAMS[beam]))
    right = determinant.blocks

    def mutated(equation: HillEquation) -> Any:
        system = right(equation)
        Fbar = system.Fbar.copy()
        Fbar[-1, -1] += 0.25 * equation.damping**2 / equation.Omega**2
        return replace(system, Fbar=Fbar)

    monkeypatch.setattr(determinant, "blocks", mutated)
    assert not solutions_meet(*damped(BEAMS[beam]))


def test_rotation_keeps_its_damping_in_the_listing() -> None:
    """The slip itself: eta moves every diagonal element but the uniform program's last."""
    plain = Case(XG=0.5, SPC=0.5, TO=20.0, GAMMA=0.1)
    moved = {}
    for name, case in {
        "uniform": plain,
        "stepped": replace(plain, RC=0.6, RA=0.6, RI=0.6),
    }.items():
        F, damped_F = (
            coefficients(constants(name), replace(case, ETA=eta), 1.8)[0] for eta in (0.0, 0.2)
        )
        moved[name] = np.round(np.diag(F - damped_F), 12).tolist()
    assert moved == {"uniform": [0.01, 0.01, 0.0], "stepped": [0.01, 0.01, 0.01]}


@pytest.mark.parametrize("share", [0.0, -1.0], ids=["dropped", "flipped"])
@pytest.mark.parametrize("route", ["hill", "floquet"])
def test_damping_term(route: str, share: float, monkeypatch: Patch) -> None:
    """eta q' of (4.5.18), which the report prints without eta, and T = ... - eta."""
    assert solutions_meet(*damped(UNIFORM))
    if route == "hill":
        right_T = result.stability_of
        monkeypatch.setattr(
            result,
            "stability_of",
            lambda P, error, Omega, eta: right_T(P, error, Omega, share * eta),
        )
    else:
        right_C = monodromies.parameter_values

        def mutated(equation: HillEquation, **options: Any) -> Any:
            p = right_C(equation, **options)
            return replace(p, C=share * p.C)

        monkeypatch.setattr(monodromies, "parameter_values", mutated)
    assert not solutions_meet(*damped(UNIFORM))


# ---- the two solutions ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    "second_half",
    [
        lambda U: (U @ U, np.abs(U) @ np.abs(U)),
        lambda U: (np.linalg.inv(U) @ U, np.abs(U) @ np.abs(U)),
    ],
    ids=["as if autonomous", "without S"],
)
def test_half_a_period_needs_S(second_half: Any, monkeypatch: Patch) -> None:
    """Phi = S U^-1 S U and nothing simpler."""
    assert row_was_sound("T1-21")
    monkeypatch.setattr(monodromies, "second_half", second_half)
    assert not row_is_sound("T1-21")


@pytest.mark.parametrize("name", ["T1-21", "T3-02b"])
@pytest.mark.parametrize(
    "tail",
    [
        ("log_pair_tail", lambda right: lambda system, alpha, M: np.zeros(len(alpha), complex)),
        ("log_pair_tail", lambda right: lambda system, alpha, M: 0.9 * right(system, alpha, M)),
        ("log_block_tail", lambda right: lambda w2, alpha, M: np.zeros(len(alpha), complex)),
        ("log_block_tail", lambda right: lambda w2, alpha, M: right(w2, alpha, M + 1)),
    ],
    ids=["pairs dropped", "pairs off by a tenth", "blocks dropped", "blocks from M + 2"],
)
def test_tail_of_the_determinant(name: str, tail: Any, monkeypatch: Patch) -> None:
    assert row_was_sound(name)
    place, mutated = tail
    monkeypatch.setattr(determinant, place, mutated(getattr(determinant, place)))
    assert not row_is_sound(name)


def test_liouville_notices_what_is_no_polynomial(monkeypatch: Patch) -> None:
    """A determinant off by 1e-9 on the circle: coefficients beyond the leading one show it."""
    assert row_was_sound("T1-21")
    right = determinant.determinants

    def mutated(system: Any, alpha: Any, M: int, squares: Any) -> Any:
        return right(system, alpha, M, squares) * (1.0 + 1e-9 * np.cos(4.0 * np.pi * alpha))

    monkeypatch.setattr(determinant, "determinants", mutated)
    assert not row_is_sound("T1-21")


# ---- the program as it was run -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "place", "value"),
    [
        ("T1-01", "MAX_HARMONICS", 13),
        ("T1-20", "_fjk", lambda j, k, R, B: 1.0001 * right_fjk(j, k, R, B)),
    ],
)
def test_the_listing(name: str, place: str, value: Any, monkeypatch: Patch) -> None:
    assert row_comes_back(name)
    monkeypatch.setattr(listing, place, value)
    assert not row_comes_back(name)


right_fjk = listing._fjk


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("T2-40", {"always_compliant": False}),
        ("T1-29", {"OMEGL": 1e4}),
        ("T1-20", {"XG": 0.6}),
        ("T1-20", {"GAMMA": 0.101}),
        ("T2-10", {"RC": 0.5}),
        ("T2-10", {"RI": 0.599}),
        ("T2-10", {"SPC": 0.999}),
        ("T3-02b", {"Q": 0}),
        ("T3-02b", {"Q": 3}),
        # the most telling row: from 3 terms on, the printed digits stay as they are
        ("T3-04b", {"S": 1}),
    ],
    ids=lambda value: value if isinstance(value, str) else next(iter(value)),
)
def test_the_case(name: str, change: dict[str, Any], monkeypatch: Patch) -> None:
    """Every parameter of the run matters to its rows."""
    assert row_comes_back(name)
    case = replace(ROWS[name].case, **change)
    if "XG" in change:
        # the uniform deck carries its sensor in DPHG
        deck = constants("uniform")
        slopes = np.array([modes.slope(n)(0.6) for n in range(1, 6)])
        found = stab(replace(deck, DPHG=slopes), case, ROWS[name].Omega)
        assert distance(found.roots, ROWS[name].z) > Z_AS_RUN
        return
    monkeypatch.setattr(Row, "case", case)
    assert not row_comes_back(name)


@pytest.mark.parametrize("name", ["T1-03", "T1-12", "T2-10"])
def test_the_rule_of_truncation(name: str, monkeypatch: Patch) -> None:
    """One harmonic more or less than the report's M, and the cause is no longer truncation."""
    assert check(ROWS[name]).note in ("", "as corrected: truncation")
    assert check(ROWS[name]).cause == "truncation"
    right = residues.report_rule
    for more in (-1, 1):
        monkeypatch.setattr(
            residues, "report_rule", lambda eq, more=more: tuple(M + more for M in right(eq))
        )
        assert check(ROWS[name]).cause != "truncation"


def test_every_cache_is_rebuilt() -> None:
    """`rebuild` reaches all that holds a compiled equation."""
    for module, names in ((taylor, {"_step", "_march", "folded"}), (cvodes, {"_integrator"})):
        cached = {name for name, value in vars(module).items() if hasattr(value, "cache_clear")}
        assert cached == names
