"""Boundaries as curves: first-order theory, Mathieu's characteristic values, the other route."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.linalg import eigh_tridiagonal

from compare.edges.field import PolynomialField
from compare.edges.tongue import NOT_REAL, Gap, Tongue
from compare.edges.tracer import TongueTracer, follow
from compare.report.one_route import Batched, family, solve
from compare.stability.indicators import (
    crossings,
    deepest,
    edges,
    growth,
    indicator,
    interpolate,
    interpolate_in_Omega,
)
from compare.stability.roots import companion_roots
from hill import HillEquation, UniformBeam, characteristic
from hill.averaging import Resonance, first_order, half_width, modal

Float = np.ndarray

# A dense, nonsymmetric system with frequencies 1, 1.7 and 2.9 and couplings of either sign.
MODES = np.array([[1.0, 0.3, -0.2], [0.1, 1.0, 0.4], [-0.3, 0.2, 1.0]])
FREQUENCIES = np.array([1.0, 1.7, 2.9])
G_MODAL = np.array([[0.8, 0.5, 0.7], [0.6, -0.9, 0.4], [-0.5, 0.3, 1.1]])
F = MODES @ np.diag(FREQUENCIES**2) @ np.linalg.inv(MODES)
G = MODES @ G_MODAL @ np.linalg.inv(MODES)

UNSTABLE = {
    Resonance(0, 0): 0.8 / 2.0,
    Resonance(1, 1): 0.9 / 3.4,
    Resonance(2, 2): 1.1 / 5.8,
    Resonance(1, 0): 0.5 * np.sqrt(0.30 / 1.7),
    Resonance(2, 1): 0.5 * np.sqrt(0.12 / (1.7 * 2.9)),
    Resonance(2, 0, -1): 0.5 * np.sqrt(0.35 / 2.9),
}
"""Hsu's half width over gamma, by hand."""


def along_gamma(eta: float = 0.0) -> PolynomialField:
    return Batched(
        lambda Omega, y: HillEquation(F, G, y, Omega, eta), lambda e: solve("floquet", [e])[0]
    )


@cache
def tongue(resonance: Resonance) -> Tongue:
    (found,) = follow(along_gamma(), resonance, [0.01, 0.02, 0.04])
    return found


def T(Omega: float, gamma: float, eta: float = 0.0) -> float:
    return characteristic(HillEquation(F, G, gamma, Omega, eta)).T


by_resonance = pytest.mark.parametrize("resonance", UNSTABLE, ids=lambda r: r.name)


def test_resonances_are_those_of_section_7_1() -> None:
    names = {r.name: r.Omega(FREQUENCIES.astype(complex)) for r in first_order(3)}
    assert len(names) == 9
    assert names["2 omega_(B)"] == 2.0
    assert names["omega_(2) - omega_(1)"] == pytest.approx(1.2)
    third = Resonance(1, 1, 1, 3)
    assert third.name == "(2 omega_(1))/3"
    assert (third.type, third.indicator, Resonance(1, 1, 1, 2).indicator) == ("I", "-1", "+1")
    assert (Resonance(2, 1).type, Resonance(2, 1).indicator) == ("II", "pair")


def test_a_frequency_that_is_not_real_has_no_resonance() -> None:
    assert np.isnan(Resonance(0, 0).Omega(np.array([0.1j, 1.0])))
    family_lost = PolynomialField(
        lambda Omega, y: HillEquation(np.diag([-1.0, 4.0]), np.eye(2), y, Omega),
        lambda e: characteristic(e).polynomial,
    )
    assert TongueTracer(family_lost, Resonance(0, 0)).section(0.1) == Gap(NOT_REAL)
    assert follow(family_lost, Resonance(0, 0), [0.1, 0.2]) == ()


@by_resonance
def test_half_width_is_hsu_s(resonance: Resonance) -> None:
    equation = HillEquation(F, G, 0.01, 1.0)
    assert half_width(resonance, equation) == pytest.approx(0.01 * UNSTABLE[resonance], rel=1e-12)
    damped = replace_eta(equation, 0.002)
    expected = np.sqrt((0.01 * UNSTABLE[resonance]) ** 2 - 0.002**2 + 0j).real
    assert half_width(resonance, damped) == pytest.approx(expected, rel=1e-9)


def replace_eta(e: HillEquation, eta: float) -> HillEquation:
    return HillEquation(e.F, e.G, e.gamma, e.Omega, eta)


@pytest.mark.parametrize("resonance", [r for r in first_order(3) if r not in UNSTABLE])
def test_the_other_sign_gives_no_instability(resonance: Resonance) -> None:
    assert half_width(resonance, HillEquation(F, G, 0.01, 1.0)) == 0.0
    assert follow(along_gamma(), resonance, [0.02]) == ()


@by_resonance
def test_edges_tend_to_first_order_theory(resonance: Resonance) -> None:
    t = tongue(resonance)
    Omega = resonance.Omega(modal(HillEquation(F, G, 0.0, 1.0))[0])
    width = UNSTABLE[resonance] * t.y
    off = np.array([t.lower - (Omega - width), t.upper - (Omega + width)])
    # what is left is of second order: quartered from .02 to .01, sixteenth of it from .04
    order = np.log2(np.abs(off[:, 1:]) / np.abs(off[:, :-1]))
    assert np.all(order > 1.85)
    # and about the same at both edges, a shift; the width itself differs in third order only
    shift = off.mean(axis=0)
    assert np.all(np.abs(off - shift) < 0.2 * np.abs(shift).max() + 30.0 * t.y**3)


@by_resonance
def test_edges_are_zeros_of_P_and_the_other_route_agrees(resonance: Resonance) -> None:
    t = tongue(resonance)
    for y, lower, upper in zip(t.y, t.lower, t.upper, strict=True):
        inwards = 0.02 * (upper - lower)
        for edge, sign in ((lower, 1.0), (upper, -1.0)):
            P = characteristic(HillEquation(F, G, y, edge)).polynomial
            if resonance.type == "I":
                # 2e-13 measured; the rest for other libm
                assert abs(np.polyval(P, -1.0)) < 1e-11
            else:
                z = np.roots(P)
                gap = min(abs(a - b) for i, a in enumerate(z) for b in z[:i])
                # the root of 1e-12, twice
                assert gap < 4e-6
            assert T(edge + sign * inwards, y) > 0.1 * (upper - lower) * 0.5
            assert T(edge - sign * inwards, y) < 1e-6


@by_resonance
def test_damped_edges_have_no_growth_and_lie_inside(resonance: Resonance) -> None:
    undamped = tongue(resonance)
    eta = 0.5 * UNSTABLE[resonance] * 0.04
    (damped,) = follow(along_gamma(eta), resonance, [0.01, 0.02, 0.03, 0.04], [undamped])
    assert damped.lower[0] == damped.upper[0]  # it closes, near gamma = .02
    assert damped.y[0] == pytest.approx(0.02, rel=0.02)
    for y, lower, upper in zip(damped.y[1:], damped.lower[1:], damped.upper[1:], strict=True):
        for edge in (lower, upper):
            # steep sides: |dT| <= 1e-12/(w dz/dOmega); 4e-12 measured
            assert abs(T(edge, y, eta)) < 1e-9
        around = undamped.at(float(y))
        assert around is not None
        assert around[0] - 1e-4 < lower < upper < around[1] + 1e-4


def mathieu(q: float, kind: str) -> float:
    """The characteristic values a_1 and b_1, by the symmetric tridiagonal matrix."""
    n = 40
    diagonal = (2.0 * np.arange(n) + 1.0) ** 2
    diagonal[0] += q if kind == "a" else -q
    return float(
        eigh_tridiagonal(diagonal, np.full(n - 1, q), select="i", select_range=(0, 0))[0][0]
    )


@pytest.mark.parametrize("gamma", [0.1, 0.5, 1.0])
def test_mathieu(gamma: float) -> None:
    """x'' + (a - 2 q cos 2t) x = 0 with a = 4/Omega^2, |q| = 2 gamma/Omega^2."""
    one = PolynomialField(
        lambda Omega, y: HillEquation(np.eye(1), np.eye(1), y, Omega),
        lambda e: characteristic(e).polynomial,
    )
    (t,) = follow(one, Resonance(0, 0), np.linspace(0.05, gamma, 8).tolist())
    for Omega, kind in ((t.lower[-1], "a"), (t.upper[-1], "b")):
        # DLMF 28.2: 1.8591080725143635 is a_1 at q = 1; 3e-13 measured here
        assert 4.0 / Omega**2 == pytest.approx(mathieu(2.0 * gamma / Omega**2, kind), rel=1e-11)


def test_mathieu_s_numbers() -> None:
    assert mathieu(1.0, "a") == pytest.approx(1.8591080725143635, rel=1e-14)
    assert mathieu(5.0, "b") == pytest.approx(-5.7900805986377710, rel=1e-14)


def test_a_tongue_begins_where_its_depth_is_zero() -> None:
    """omega_(2) - omega_(1) of the uniform beam appears at T0 = 14.28, between two steps."""
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
    beams = family("floquet", lambda T0: replace(beam, T0=T0), lambda _: 0.1)
    (t,) = follow(beams, Resonance(2, 1, -1), [12.0, 14.0, 16.0, 18.0])
    assert 14.0 < t.y[0] < 16.0
    assert t.lower[0] == t.upper[0]
    assert np.all(np.diff(t.y) > 0.0)
    assert np.all(np.diff(t.upper - t.lower) > 0.0)
    # edges open like a root: 4 % of the step on, a fifth of the width
    assert t.at(13.0) is None
    assert t.at(17.0) is not None


def test_the_interpolant_is_P() -> None:
    known = along_gamma()
    P = interpolate_in_Omega(lambda x: known.along(x, 0.1), 1.9, 2.2)
    x = np.array([1.903, 2.0, 2.117])
    # P is known to 1e-14, the interpolant's tail is below 1e-12 of its largest coefficient
    assert np.abs(P(x) - known.along(x, 0.1)).max() < 1e-11


def test_a_pole_is_refused() -> None:
    with pytest.raises(ValueError, match="not smooth enough"):
        interpolate(lambda s: np.column_stack([np.ones(len(s)), 1.0 / (s - 0.3007)]), 0.0, 1.0)


def test_indicators() -> None:
    stable, above, below = [1.0, 0.0, -0.25], [1.0, -1.7, 0.6], [1.0, 3.1, 2.2]
    P = np.array([stable, above, below])
    Omega = np.ones(3)
    assert np.allclose(np.sort(companion_roots(P).real), [[-0.5, 0.5], [0.5, 1.2], [-2.0, -1.1]])
    assert np.allclose(indicator("+1", P, Omega), [0.5, -0.2, 2.1])
    # both z below -1: P(-1) > 0 as in the stable case, and yet unstable
    assert np.allclose(indicator("-1", P, Omega), [0.5, 1.5, -1.0])
    assert np.allclose(indicator("pair", P, Omega), [1.0, 0.49, 0.81])
    assert growth(P, Omega)[0] == pytest.approx(0.0, abs=1e-15)
    assert growth(P, Omega, 0.1)[2] == pytest.approx(np.arccosh(2.0) / np.pi - 0.1)
    c = np.cosh(0.1 * np.pi)
    assert indicator("-1", P, Omega, 0.1) == pytest.approx(c + np.array([-0.5, 0.5, -2.0]))


def test_edges_choose_the_pair_nearest_to_the_guess() -> None:
    def f(x: Float) -> Float:
        return np.minimum((x - 1.0) ** 2 - 0.04, (x - 2.0) ** 2 - 0.01)

    falls, rises = crossings(f, np.linspace(0.0, 3.0, 100))
    assert falls == pytest.approx([0.8, 1.9])
    assert rises == pytest.approx([1.2, 2.1])
    assert edges(f, 0.0, 3.0, (1.95, 2.05), 2.0) == pytest.approx((1.9, 2.1))
    assert edges(f, 0.0, 3.0, (0.9, 1.1), 1.0) == pytest.approx((0.8, 1.2))
    assert edges(lambda x: x**2 + 1.0, -1.0, 1.0, (0.0, 0.0), 0.0) is None
    assert deepest(f, 0.0, 3.0) == pytest.approx((1.0, -0.04), abs=1e-6)
    # narrower than the grid, and found by its bottom
    narrow = edges(lambda x: (x - 0.12345) ** 2 - 1e-10, 0.0, 1.0, (0.0, 1.0), 0.12345)
    assert narrow == pytest.approx((0.12344, 0.12346), rel=1e-9)


def test_a_sign_that_rounding_makes_on_a_grid_is_a_zero_there() -> None:
    """Alone the function has another sign at the point of the grid where it is 0 to rounding."""

    def f(x: Float) -> Float:
        among_others = -1e-17 if len(x) > 1 else 1e-17
        return np.where(x == 0.5, among_others, np.abs(x - 0.5))

    assert crossings(f, np.array([0.0, 0.25, 0.5, 0.75, 1.0])) == ([0.5], [0.5])
