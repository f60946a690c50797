"""The determinant of any periodic equation: closed forms, the literature, the arbiter, bounds."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from flint import acb_mat, arb, ctx
from scipy.linalg import expm
from systems import SPECIAL, random_system

from benchmarks.honesty import arbiter
from benchmarks.validation.literature import BITTANTI_COLANERI as STRONG
from benchmarks.validation.literature import VINOGRAD, ZHOU_HAGIWARA
from compare import crosscheck
from compare.report.row import equation
from compare.report.tables import Row, all_rows
from floquet.enclosure import general as general_arbiter
from hill import Characteristic, Fourier, HillEquation, PeriodicEquation, characteristic

# ---- systems -------------------------------------------------------------------------------------


def random_general(seed: int) -> PeriodicEquation:
    """1 to 6 coordinates, or as many rows of first order; up to four harmonics in C and K."""
    rng = np.random.default_rng(seed)
    n, harmonics = 1 + seed % 6, 1 + seed % 4
    Omega = 10.0 ** rng.uniform(-0.4, 0.5)

    def dense(size: float) -> Any:
        return size * rng.standard_normal((n, n)) / np.sqrt(n)

    def pulsating(mean: Any, size: float) -> Fourier:
        some = [k for k in range(1, harmonics + 1) if k == harmonics or rng.uniform() < 0.7]
        return Fourier(
            mean,
            cos={k: dense(size) for k in some},
            sin={k: dense(size) for k in some if rng.uniform() < 0.7},
        )

    if seed % 5 == 4:
        return PeriodicEquation.first_order(A=pulsating(dense(0.8), 0.5), Omega=Omega)
    gyroscopic = dense(0.5)
    C = dense(0.2) + gyroscopic - gyroscopic.T + rng.uniform(-0.1, 0.5) * np.eye(n)
    return PeriodicEquation(
        M=np.eye(n) + dense(0.2) if seed % 3 == 0 else None,
        C=pulsating(C, rng.uniform(0.05, 0.6)) if seed % 7 else C,
        K=pulsating(np.diag(rng.uniform(0.2, 4.0, n)) + dense(0.2), rng.uniform(0.1, 0.8)),
        Omega=Omega,
    )


def asymmetric_rotor(c: float, k0: float = 1.0, dk: float = 0.2) -> PeriodicEquation:
    """In the fixed frame; it turns at 1, its stiffness at 2."""
    return PeriodicEquation(
        C=c * np.eye(2),
        K=Fourier(
            k0 * np.eye(2),
            cos={2: [[dk, 0.0], [0.0, -dk]]},
            sin={2: [[0.0, dk], [dk, 0.0]]},
        ),
        Omega=1.0,
    )


def asymmetric_rotor_exponents(c: float, k0: float = 1.0, dk: float = 0.2) -> Any:
    """In the frame that turns with it its coefficients are constant."""
    J, one = np.array([[0.0, -1.0], [1.0, 0.0]]), np.eye(2)
    K = np.diag([k0 + dk, k0 - dk]) - one + c * J
    return np.linalg.eigvals(np.block([[np.zeros((2, 2)), one], [-K, -2.0 * J - c * one]]))


OUTSIDE = {
    "strong damping": STRONG,
    "vinograd": VINOGRAD,
    "zhou-hagiwara": ZHOU_HAGIWARA,
    "rotor": asymmetric_rotor(0.0),
    "rotor, damped": asymmetric_rotor(0.1),
}


def sorted_up(x: Any) -> Any:
    return x[np.lexsort((x.imag, np.round(x.real, 9)))]


# ---- closed forms --------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(6))
def test_constant_coefficients(seed: int) -> None:
    """The polynomial of the exponential of a matrix."""
    rng = np.random.default_rng(seed)
    n = 1 + seed % 3
    K, C = rng.standard_normal((n, n)), 0.5 * rng.standard_normal((n, n))
    M = np.eye(n) + 0.3 * rng.standard_normal((n, n))
    e = PeriodicEquation(M=M, C=C, K=K, Omega=float(rng.uniform(0.5, 3.0)))
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    c = characteristic(e)
    with ctx.workprec(200):
        # M divides in floats here, which moves the polynomial by its own roundings
        exact = acb_mat(A.tolist()) * (2 * arb.pi() / arb(e.Omega))
        expected = [float(x.real) for x in reversed(exact.exp().charpoly().coeffs())]
    size = np.max(np.abs(expected))
    assert np.max(np.abs(c.polynomial - expected)) <= c.error + 1e-13 * size
    assert np.max(np.abs(c.polynomial - np.poly(expm(A * e.period)))) <= c.error + 1e-12 * size
    assert c.error <= 1e-12 * size


@pytest.mark.parametrize(
    ("equation", "expected"),
    [
        (STRONG, [0.0, -24.0]),
        (VINOGRAD, [2.0 + 6j, -13.0 + 6j]),
        (ZHOU_HAGIWARA, [-1 + 2j, -2 + 2j]),
    ],
    ids=["strong damping", "vinograd", "zhou-hagiwara"],
)
def test_exponents_of_the_literature(equation: PeriodicEquation, expected: list[complex]) -> None:
    """Known exactly; their imaginary parts up to Omega."""
    c = characteristic(equation)
    apart = c.exponents - np.array(expected)
    apart -= 1j * equation.Omega * np.round(apart.imag / equation.Omega)
    assert np.all(np.abs(apart) <= c.exponent_errors)
    # Measured 1e-13: relative to the exponents, what is asked is 1e-10.
    assert np.max(c.exponent_errors) <= 1e-12
    assert abs(c.T - 2.0 * max(np.real(expected))) <= c.T_error


def test_the_constant_coefficient_is_known_to_its_last_digit() -> None:
    """exp(-48 pi), 66 powers of ten below the others."""
    c = characteristic(STRONG)
    with ctx.workprec(200):
        expected = (-48 * arb.pi()).exp()
        assert float(abs(arb(float(c.polynomial[2])) - expected)) <= c.errors[2]
    assert c.errors[2] < 1e-12 * c.polynomial[2]


@pytest.mark.parametrize("c", [0.0, 0.1, 1.0])
def test_an_asymmetric_rotor(c: float) -> None:
    """Sines and cosines in the fixed frame, constant gyroscopic terms in the turning one."""
    found = characteristic(asymmetric_rotor(c))
    expected = np.exp(2.0 * np.pi * asymmetric_rotor_exponents(c))
    # undamped two multipliers meet at 1, which rounding of the expected ones tears apart too
    assert np.max(np.abs(found.polynomial - np.poly(expected))) <= found.error + 1e-12
    assert found.verdict == ("unstable" if c < 0.2 else "stable")
    if c == 0.0:
        assert abs(found.T - 2.0 * np.sqrt(np.sqrt(4.04) - 2.0)) <= found.T_error


def test_mathieu_in_general_form() -> None:
    """Coupled Mathieu equations (Chicone, example 2.91), to the 13 digits known of them."""
    equation = HillEquation([[2.0, -1.0], [-1.0, 2.0]], np.eye(2), 0.15, 2.0).general()
    c = characteristic(equation)
    expected = [
        -1.124942799147935,
        0.665180257006653 + 0.746682814646592j,
        0.665180257006653 - 0.746682814646592j,
        -0.888934086921956,
    ]
    for mu in expected:
        assert np.min(np.abs(c.multipliers - mu)) < 1e-13
    assert c.verdict == "unstable"


# ---- against the special equation ----------------------------------------------------------------


def of_multipliers(P: Any, decay: float) -> Any:
    """From P(z) = prod (z - z_j): prod (mu^2 - 2 decay z_j mu + decay^2)."""
    n = len(P) - 1
    total = np.zeros(2 * n + 1)
    for k, p in enumerate(P):
        # z^(n - k) is (mu^2 + 1)^(n - k)/(2 mu)^(n - k)
        power = np.array([1.0])
        for _ in range(n - k):
            power = np.convolve(power, [1.0, 0.0, 1.0])
        total[k : k + len(power)] += p * 2.0**k * power
    return total * decay ** np.arange(2 * n + 1)


def same_system(special: Characteristic, general: Characteristic, decay: float) -> None:
    """Coefficients, T and verdicts meet within the bounds."""
    n = len(special.z)
    expected = of_multipliers(special.polynomial, decay)
    allowed = of_multipliers(np.full(n + 1, special.error), decay)
    # the sum's own rounding, and of the products gamma G by which the two forms differ
    rounding = 1e-13 * of_multipliers(np.abs(special.polynomial), decay)
    assert np.all(np.abs(general.polynomial - expected) <= allowed + general.errors + rounding)
    assert abs(general.T - special.T) <= general.T_error + special.T_error
    assert {special.verdict, general.verdict} != {"stable", "unstable"}


@pytest.mark.parametrize("name", SPECIAL)
def test_special_equations_in_general_form(name: str) -> None:
    e = SPECIAL[name]
    same_system(
        characteristic(e), characteristic(e.general()), np.exp(-np.pi * e.damping / e.Omega)
    )


@pytest.mark.parametrize("row", all_rows(), ids=lambda row: row.id)
def test_every_row_of_the_tables_in_general_form(row: Row) -> None:
    e = equation(row, 2)
    same_system(
        characteristic(e), characteristic(e.general()), np.exp(-np.pi * e.damping / e.Omega)
    )


# ---- honesty -------------------------------------------------------------------------------------

# The arbiter takes some tenths of a second for each.
SEEDS = [*[seed for seed in range(60) if seed % 6 <= 1][:16], 2, 8]


@cache
def by_determinant(name: str) -> Characteristic:
    return characteristic(system(name))


@cache
def system(name: str) -> PeriodicEquation:
    return OUTSIDE[name] if name in OUTSIDE else random_general(int(name.split()[1]))


@cache
def truth(name: str) -> list[Any]:
    """With so many bits because a coefficient may be known to its last digit, however small."""
    return general_arbiter.reference(system(name), narrow=300 if name == "strong damping" else 90)


NAMES = [*OUTSIDE, *(f"seed {seed}" for seed in SEEDS)]


@pytest.mark.parametrize("name", NAMES)
def test_no_error_is_too_small(name: str) -> None:
    found, known = by_determinant(name), truth(name)
    with ctx.workprec(400):
        # what is off by no more than a ball's own radius, 1e-27 of the largest, is not off
        pairs = zip(found.polynomial, known, strict=True)
        off = [float((arb(float(p)) - t).abs_lower()) for p, t in pairs]
    assert np.all(np.array(off) <= found.errors)
    growth = arbiter.judged(known, system(name).Omega, None)
    assert float(abs(arb(found.T) - growth.T).upper()) <= found.T_error
    assert found.verdict in (growth.truth, "undecided")


@pytest.mark.parametrize("name", NAMES)
def test_converged(name: str) -> None:
    """Both the error and what is said of it."""
    found = by_determinant(name)
    size = np.max(np.abs(found.polynomial))
    assert arbiter.largest_error(found.polynomial, truth(name)) <= 1e-13 * size
    assert found.error <= 1e-12 * size


@pytest.mark.parametrize("seed", range(100, 160))
def test_rounding_is_reached(seed: int) -> None:
    found = characteristic(random_general(seed))
    assert found.error <= 1e-12 * np.max(np.abs(found.polynomial))
    assert found.form == "converged"
    assert len(found.multipliers) == len(found.exponents) == len(found.polynomial) - 1


# ---- both routes ---------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(12))
def test_a_damping_matrix_by_both_routes(seed: int) -> None:
    e = random_system(seed)
    rng = np.random.default_rng(seed)
    eta = 0.2 * e.Omega * (np.eye(e.n) + rng.standard_normal((e.n, e.n)))
    damped = HillEquation(e.F, e.G, e.gamma, e.Omega, eta, e.H, e.omega_L)
    x = crosscheck(damped)
    assert x.routes_agree
    assert len(x.hill.z) == 0
    assert x.difference <= x.bound
    assert abs(x.hill.T - x.floquet.T) <= x.hill.T_error + x.floquet.T_error


def test_one_damping_as_a_number_and_as_a_matrix() -> None:
    special = HillEquation([[2.0, 0.3], [0.2, 1.0]], [[1, 2], [3, 1]], 0.3, 1.3, 0.1)
    general = HillEquation(special.F, special.G, 0.3, 1.3, 0.1 * np.eye(2))
    same_system(characteristic(special), characteristic(general), np.exp(-np.pi * 0.1 / 1.3))
    assert np.allclose(
        characteristic(special).exponents.real, characteristic(general).exponents.real, atol=1e-12
    )


# ---- refusals ------------------------------------------------------------------------------------


def test_too_slow_a_forcing_is_refused() -> None:
    with pytest.raises(ValueError, match=r"Omega = 1e-06: too small for the determinant"):
        characteristic(PeriodicEquation(K=Fourier([[1.0]], cos={1: [[0.5]]}), Omega=1e-6))


def test_too_large_a_growth_is_refused() -> None:
    with pytest.raises(OverflowError, match="grows beyond what a float can hold"):
        characteristic(PeriodicEquation(K=Fourier([[-1e6]], cos={1: [[1.0]]}), Omega=1.0))


@pytest.mark.parametrize("truncation", ["report", 8])
def test_no_other_truncation(truncation: Any) -> None:
    with pytest.raises(ValueError, match=r'truncation = .*: must be "converged"'):
        characteristic(STRONG, truncation=truncation)
