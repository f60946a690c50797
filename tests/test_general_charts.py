"""Charts, tongues and boundaries of any linear periodic system: polynomials of the multipliers."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare import Chart, boundaries, chart, crosscheck, instabilities
from compare.__main__ import main
from compare.edges.instabilities import Instability
from compare.stability import multipliers
from compare.stability.pairs import folded, has_pairs
from compare.stability.points import VERDICTS
from compare.stability.reading import IN_MU, IN_PAIRS, IN_Z
from floquet import batch as by_floquet
from floquet import monodromy
from hill import (
    Fourier,
    HillEquation,
    MatrixSystem,
    Parameter,
    PeriodicEquation,
    PeriodicSystem,
    characteristic,
)
from hill import batch as by_hill
from hill.averaging import Resonance
from hill.oscillations import expected

Float = np.ndarray[Any, Any]

GYROSCOPIC = np.array([[0.0, 0.3], [-0.3, 0.0]])
STIFF = np.diag([1.0, 5.29])

DAMPED = PeriodicSystem(
    K=Fourier(STIFF, cos={1: [[0.4, 0.3], [0.2, 0.8]]}),
    C=Fourier(GYROSCOPIC + np.diag([0.04, 0.06]), sin={1: [[0.1, 0.05], [0.0, 0.1]]}),
    frequency_names=("low", "high"),
)
CONSERVATIVE = PeriodicSystem(
    K=Fourier(STIFF, cos={1: [[0.4, 0.3], [0.3, 0.8]]}),
    C=GYROSCOPIC,
    frequency_names=("low", "high"),
)
AXES = [("Omega", 1.5, 5.2, 60), ("gamma", 0.0, 1.0, 40)]


@cache
def charted(which: str) -> tuple[Chart, tuple[Instability, ...]]:
    c = chart({"damped": DAMPED, "conservative": CONSERVATIVE}[which], AXES)
    return c, instabilities(c)


@pytest.mark.parametrize("which", ["damped", "conservative"])
def test_a_chart_is_what_both_routes_say_of_its_points(which: str) -> None:
    c, _ = charted(which)
    assert c.routes_agree
    assert c.shared_matrices
    # the routes' rounding: measured 1e-14
    assert 0.0 < c.disagreement < 1e-12
    assert c.checked is not None
    assert c.checked <= c.error < 1e-9
    rng = np.random.default_rng(3)
    Omega, gamma = rng.uniform(1.5, 5.2, 25), rng.uniform(0.0, 1.0, 25)
    points = c.at(Omega=Omega, gamma=gamma)
    for k in range(25):
        x = crosscheck(c.system, Omega=Omega[k], gamma=gamma[k])
        assert abs(points.T[k] - x.T) <= points.T_error[k] + x.T_error
        assert points.verdict[k] == x.verdict != "undecided"
        assert points.T_error[k] < 1e-4
        most = np.sort(np.abs(points.multipliers[k]))[::-1]
        # roots of a polynomial that is known to 1e-10, two of them close
        assert most == pytest.approx(np.abs(x.floquet.multipliers), abs=1e-4)


def test_what_the_polynomials_are_of() -> None:
    assert charted("damped")[0].scenario.reading == IN_MU
    assert charted("damped")[0].at(Omega=2.0, gamma=0.5).z.shape == (1, 0)
    conservative = charted("conservative")[0]
    assert conservative.scenario.reading == IN_PAIRS
    assert conservative.at(Omega=2.0, gamma=0.5).z.shape == (1, 2)
    special = chart(MatrixSystem(STIFF, np.eye(2)), AXES[:1], forcing={"gamma": 0.1})
    assert special.scenario.reading is IN_Z


@pytest.mark.parametrize(
    ("which", "undecided"),
    # at gamma = 0 the resonances themselves are grid points of the conservative one
    [("damped", 0), ("conservative", 60)],
)
def test_verdicts_and_errors_of_the_grid(which: str, undecided: int) -> None:
    c, _ = charted(which)
    assert np.sum(c.undecided()) <= undecided
    assert 0.02 < np.mean(c.unstable()) < 0.2
    assert np.all(c.T_error() >= 0.0)
    # the eigenvalues of one period, unchecked, at every tenth point
    for j, i in ((j, i) for j in range(0, 40, 10) for i in range(0, 60, 10)):
        Omega, gamma = c.axes[0].points[i], c.axes[1].points[j]
        T = monodromy(c.system.equation(Omega, gamma)).T
        assert abs(c.T[j, i] - T) <= c.T_error()[j, i] + 1e-9


@pytest.mark.parametrize(
    ("which", "names"),
    [
        ("damped", {"2 omega_(low)", "2 omega_(high)", "omega_(high) + omega_(low)"}),
        ("conservative", {"2 omega_(low)", "2 omega_(high)", "omega_(high) + omega_(low)"}),
    ],
)
def test_tongues_have_the_mean_systems_frequencies(which: str, names: set[str]) -> None:
    _, found = charted(which)
    assert names <= {i.resonance.name for i in found}
    for i in found:
        if i.resonance.name not in names:
            continue
        # averaging is of the first order: measured 6 % at most
        assert i.width == pytest.approx(i.width_Hsu, rel=0.1)
        if which == "damped":
            assert i.critical_gamma == pytest.approx(i.critical_gamma_Hsu, rel=0.01)


@pytest.mark.parametrize("which", ["damped", "conservative"])
def test_what_crosses_the_unit_circle_at_an_edge(which: str) -> None:
    """At each edge the witness has a multiplier where the resonance says: 1, -1, or a pair."""
    c, found = charted(which)
    crossings = set()
    for i in found[:4]:
        k = len(i.tongue.y) - 2
        y, error = float(i.tongue.y[k]), float(i.edge_error[k])
        crossings.add(i.resonance.crossing)
        for edge, outwards in ((i.tongue.lower[k], -1.0), (i.tongue.upper[k], 1.0)):
            inside, outside = (
                crosscheck(c.system, Omega=float(edge) + sign * 10.0 * error, gamma=y)
                for sign in (-outwards, outwards)
            )
            assert inside.T > 0.0
            assert inside.verdict != "stable"
            assert outside.verdict != "unstable"
            mu = inside.floquet.multipliers[0]
            at = {"mu = 1": mu.real, "mu = -1": -mu.real, "a pair": abs(mu)}[i.resonance.crossing]
            # the root of the distance, which is 1e-8 and less
            assert at == pytest.approx(1.0, abs=1e-3)
            assert (abs(mu.imag) > 0.1) == (i.resonance.crossing == "a pair")
    assert {"mu = -1", "a pair"} <= crossings


@dataclass(frozen=True)
class InGeneralForm:
    """A system of Hill's equation as anybody's general one."""

    T0: float
    parameters = (Parameter("T0", low=0.0),)

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> PeriodicEquation:
        F = STIFF + 0.1 * self.T0 * np.array([[0.0, 0.4], [0.2, 0.1]])
        return HillEquation(F, [[0.4, 0.3], [0.2, 0.8]], gamma, Omega, eta).general()


@dataclass(frozen=True)
class Special(InGeneralForm):
    """The same as it is."""

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> Any:
        F = STIFF + 0.1 * self.T0 * np.array([[0.0, 0.4], [0.2, 0.1]])
        return HillEquation(F, [[0.4, 0.3], [0.2, 0.8]], gamma, Omega, eta)


@pytest.mark.parametrize("eta", [0.0, 0.05])
def test_hills_equation_in_general_form_has_the_same_chart(eta: float) -> None:
    one, other = (
        chart(kind(1.0), AXES, forcing={"eta": eta}, route="floquet")
        for kind in (Special, InGeneralForm)
    )
    assert one.scenario.reading is IN_Z
    assert other.scenario.reading.general
    decided = ~(one.undecided() | other.undecided())
    assert np.mean(decided) > 0.97
    assert np.all((one.verdict() == other.verdict())[decided])
    assert np.all(np.abs(one.T - other.T) <= one.T_error() + other.T_error())


def test_boundaries_over_two_other_parameters() -> None:
    c = chart(DAMPED, [("eta", 0.0, 0.3, 30), ("gamma", 0.0, 1.0, 30)], forcing={"Omega": 3.31})
    (curve,) = boundaries(c)
    assert curve.kind == "pair"
    for k in (0, len(curve.x) // 2, len(curve.x) - 1):
        x = crosscheck(DAMPED, Omega=3.31, gamma=float(curve.y[k]), eta=float(curve.x[k]))
        assert abs(x.T) < 1e-8


def test_a_damping_matrix_and_an_equation_of_first_order_have_charts() -> None:
    @dataclass(frozen=True)
    class Dashpots:
        parameters = ()

        def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
            return HillEquation(STIFF, np.eye(2), gamma, Omega, np.diag([0.1, 0.02]) + eta)

    rotating = PeriodicSystem(
        A=Fourier(
            [[0.0, 1.0, 0.0], [-1.0, -0.1, 0.2], [0.1, 0.0, -0.3]],
            sin={1: [[0.0, 0.0, 0.0], [0.9, 0.0, 0.1], [0.0, 0.1, 0.0]]},
        )
    )
    axes = [("Omega", 1.2, 2.8, 30), ("gamma", 0.0, 1.0, 20)]
    for system, order in ((Dashpots(), 4), (rotating, 3)):
        c = chart(system, axes, tolerance=1e-8)
        assert c.scenario.coordinates == order
        assert c.routes_agree
        for Omega, gamma in ((1.9, 0.9), (2.3, 0.2)):
            (T,), (error,) = (getattr(c.at(Omega=Omega, gamma=gamma), n) for n in ("T", "T_error"))
            found = monodromy(system.equation(Omega, gamma))
            assert abs(T - found.T) <= error + found.T_error
    assert "2 omega_(1)" in {i.resonance.name for i in instabilities(c)}


def test_damping_that_a_system_adds_is_in_the_multipliers() -> None:
    """T of a chart is not read with the forcing's eta where the equation has more."""

    @dataclass(frozen=True)
    class Damped:
        parameters = ()

        def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
            return HillEquation(STIFF, np.eye(2), gamma, Omega, eta + 0.05)

    c = chart(Damped(), [("Omega", 1.8, 2.2, 20), ("gamma", 0.0, 0.5, 10)], route="floquet")
    assert c.scenario.reading is IN_MU
    x = crosscheck(Damped(), Omega=2.0, gamma=0.3)
    (point,) = c.at(Omega=2.0, gamma=0.3).T
    assert point == pytest.approx(x.T, abs=1e-9)


def test_pairs_at_the_corners_only_are_no_pairs() -> None:
    @dataclass(frozen=True)
    class Odd:
        parameters = ()

        def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> PeriodicEquation:
            drag = max(0.0, (Omega - 1.0) * (2.0 - Omega)) if 1.4 < Omega < 1.6 else 0.0
            corner = drag if abs(Omega - 1.5) > 1e-3 and abs(Omega - 1.382) > 1e-3 else 0.0
            C = GYROSCOPIC + corner * np.diag([1.0, 2.0])
            return PeriodicEquation(K=Fourier(STIFF, cos={1: gamma * np.eye(2)}), C=C, Omega=Omega)

    with pytest.raises(ValueError, match=r"Omega = 1\.\d+: the multipliers come in no pairs"):
        chart(Odd(), [("Omega", 1.0, 2.0, 20), ("gamma", 0.1, 0.3, 20)])


@pytest.mark.parametrize("route", [by_hill.polynomials, by_floquet.polynomials])
def test_folded_polynomials_are_those_of_z(route: Any) -> None:
    rng = np.random.default_rng(11)
    for n in (1, 2, 3, 5):
        e = HillEquation(np.diag(rng.uniform(0.5, 6.0, n)), rng.normal(size=(n, n)), 0.2, 1.3, 0.05)
        assert has_pairs(e.general(), 0.05)
        special, found = characteristic(e), folded(route, [e.general()])
        apart = np.abs(found.coefficients[0] - special.polynomial)
        assert np.max(apart) <= found.errors[0] + special.error
        # what folding adds: measured 1e-13 at most
        assert found.errors[0] < 1e-10


def _clusters(rng: np.random.Generator) -> tuple[Float, Float]:
    """Roots of real polynomials, next to the unit circle and far from it, and some together."""
    m = int(rng.integers(1, 7))
    angle = rng.uniform(0.1, 3.0, m // 2)
    if rng.uniform() < 0.4:
        angle[:] = angle[:1] + 1e-3 * rng.normal(size=m // 2)
    size = 1.0 + rng.choice([-1.0, 1.0], m // 2) * 10.0 ** rng.uniform(-9.0, 0.3, m // 2)
    pair = np.abs(size) * np.exp(1j * angle)
    single = rng.choice([-1.0, 1.0], m % 2) * (1.0 + 10.0 ** rng.uniform(-9.0, -0.5, m % 2))
    return np.concatenate([pair, pair.conj(), single]), 10.0 ** rng.uniform(-14.0, -5.0)


def test_bounds_hold_whatever_the_error_does() -> None:
    """Polynomials of known roots, every coefficient off by all of its error, either way."""
    rng = np.random.default_rng(5)
    shown, useful = 0, 0
    for _ in range(1500):
        roots, error = _clusters(rng)
        true = np.poly(roots).real
        P = (true + error * rng.choice([-1.0, 1.0], len(true)))[None]
        P[0, 0] = 1.0
        # np.poly's own rounding: some ulps of the coefficients
        given = np.array([error + 1e-14 * np.max(np.abs(true)) * len(true)])
        Omega, eta = np.array([1.7]), np.zeros(1)
        found = multipliers.solve(P, given, Omega, eta)
        growth = np.log(np.max(np.abs(roots)))
        T = 1.7 / np.pi * growth
        assert abs(found.T[0] - T) <= found.T_error[0]
        assert multipliers.argument(P.T, Omega, eta)[0] == pytest.approx(found.T[0], abs=1e-12)
        (code,) = multipliers.verdicts(P, given, found.T, Omega, eta)
        verdict = VERDICTS[code]
        assert verdict == found.verdict[0]
        assert verdict in {"undecided", "unstable" if growth > 0.0 else "stable"}
        shown += verdict != "undecided"
        useful += found.T_error[0] < 1e-2
    # far more than half are decided, or the bounds would be of no use: measured 1,180 and 1,200
    assert shown > 1000
    assert useful > 1000


def test_edge_functions_vanish_where_multipliers_cross() -> None:
    def value(kind: str, *roots: complex) -> float:
        P = np.poly(roots).real[None]
        return float(multipliers.edge_function(kind, P, np.ones(1))[0])

    turn = np.exp(0.7j)
    assert abs(value("+1", 1.0, 0.3, 0.2j, -0.2j)) < 1e-14
    assert abs(value("-1", -1.0, 0.3, 0.2j, -0.2j)) < 1e-14
    assert abs(value("pair", turn, turn.conjugate(), 0.5, 0.2)) < 1e-14
    # the sign changes across, and only there
    for kind, beyond, within in (
        (
            "pair",
            (1.01 * turn, 1.01 * turn.conjugate(), 0.5),
            (0.99 * turn, 0.99 * turn.conjugate(), 0.5),
        ),
        ("+1", (1.01, 0.3), (0.99, 0.3)),
    ):
        assert value(kind, *beyond) * value(kind, *within) < 0.0
    P = np.poly([1.1, 0.4, 0.9 * turn, 0.9 * turn.conjugate()]).real[None]
    for kind, wanted in (("+1", -0.1), ("-1", 1.4), ("pair", 0.1)):
        measured = multipliers.indicator(kind, P, np.ones(1))[0]
        assert measured == pytest.approx(
            1.0 + min(0.4, 0.9 * turn.real) if kind == "-1" else wanted
        )


def test_what_averaging_expects_of_hills_equation_in_general_form() -> None:
    e = HillEquation(np.diag([1.0, 2.0]), [[0.3, 0.5], [0.2, 0.4]], 0.2, 2.0, 0.01)
    g = e.general()
    assert expected.strength(HillEquation([[1.0]], [[1.0]], 0.2, 2.0).general()) == pytest.approx(
        0.2
    )
    for r in (Resonance(0, 0), Resonance(1, 1), Resonance(1, 0), Resonance(1, 0, -1)):
        for damped in (True, False):
            # the exponents move by the damping's square
            one, other = (expected.half_width(r, x, damped=damped) for x in (e, g))
            assert other == pytest.approx(one, rel=1e-3)
        assert expected.damping(r, g) == pytest.approx(0.01)
        one, other = (expected.critical_gamma(r, x, 0.2) for x in (e, g))
        assert other == pytest.approx(one, rel=1e-3, nan_ok=True)
    overdamped = PeriodicEquation(K=np.diag([1.0, 4.0]), C=np.diag([5.0, 0.0]), Omega=1.0)
    assert expected.half_width(Resonance(0, 0), overdamped) == 0.0
    assert expected.damping(Resonance(1, 0), overdamped) == 0.0


FILE = """\
kind = "matrices"
[system]
frequency_names = ["low", "high"]
[system.K]
mean = [[1.0, 0.0], [0.0, 5.29]]
cos.1 = [[0.4, 0.3], [0.2, 0.8]]
[system.C]
mean = [[0.04, 0.3], [-0.3, 0.06]]
[[axis]]
name = "Omega"
low = 1.7
high = 2.3
count = 30
[[axis]]
name = "gamma"
low = 0.0
high = 1.0
count = 20
"""


def test_from_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    (tmp_path / "mine.toml").write_text(FILE)
    asked = ["chart", str(tmp_path / "mine.toml"), "--tongues", str(tmp_path / "t.csv")]
    asked += ["--route", "floquet"]
    assert main([*asked, "--output", str(tmp_path / "c.svg")]) == 0
    assert "2 omega_(low)" in capsys.readouterr().out
    head, *lines = (tmp_path / "t.csv").read_text().splitlines()[1:]
    assert head.split(",")[:4] == ["resonance", "type", "order", "crossing"]
    assert {line.split(",")[3] for line in lines} == {"mu = -1"}
    assert (tmp_path / "c.svg").read_text().startswith("<?xml")
