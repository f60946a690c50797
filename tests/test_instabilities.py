"""Tongues as an engineer asks for them, points of a chart, boundaries of any two parameters."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from compare import Chart, chart
from compare.edges.curves import Curve, boundaries
from compare.edges.instabilities import Instability, instabilities
from compare.edges.interpolated import SECTIONS, on_surface
from compare.edges.on_chart import distinct, stations, tongues
from compare.edges.reach import may_reach
from compare.edges.tongue import RANGE
from compare.edges.tracer import TongueTracer, follow
from compare.edges.unnamed import unnamed
from compare.stability.indicators import BESIDE_POLE, edge_function
from floquet import monodromy
from floquet.weak_form import galerkin
from hill import SteppedBeam, UniformBeam, characteristic
from hill.averaging import Resonance

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)


@cache
def made(eta: float) -> Chart:
    axes = [("Omega", 0.7, 3.0, 40), ("gamma", 0.0, 0.4, 30)]
    return chart(BEAM, axes, forcing={"eta": eta}, route="floquet")


@cache
def found(eta: float) -> dict[str, Instability]:
    return {i.resonance.name: i for i in instabilities(made(eta))}


# ---- tongues -------------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [0.0, 0.01])
def test_edges_are_where_the_other_route_has_them(eta: float) -> None:
    for i in found(eta).values():
        kind, k = i.resonance.indicator, len(i.tongue.y) // 2
        gamma = float(i.tongue.y[k])

        def f(Omega: float, kind: str = kind, gamma: float = gamma) -> float:
            P = characteristic(BEAM.equation(Omega, gamma, eta)).polynomial
            return float(edge_function(kind, P[None], np.array([Omega]), eta)[0])

        for edge in (i.tongue.lower[k], i.tongue.upper[k]):
            # Hill's own P is known to 1e-13, a hundredth of the chart's
            near = 0.2 * (i.tongue.upper[k] - i.tongue.lower[k])
            exact = brentq(f, edge - near, edge + near, xtol=1e-14)
            assert abs(edge - exact) <= i.edge_error[k]
            # ... and that bound says something, the more the wider the tongue
            assert i.edge_error[k] < 1e-3 * near or near < 1e-4


@pytest.mark.parametrize("eta", [0.0, 0.01])
def test_unstable_inside_and_stable_outside(eta: float) -> None:
    others = found(eta).values()
    assert len(others) >= 5
    for i in others:
        # a tenth of the width, where T is well above its error
        step = 0.1 * i.width
        low, high = i.tongue.at(i.y) or (0.0, 0.0)
        assert characteristic(BEAM.equation(low + step, i.y, eta)).T > 0.0
        assert characteristic(BEAM.equation(high - step, i.y, eta)).T > 0.0
        outside = [x for x in (low - step, high + step) if not covered(x, i.y, eta)]
        for x in outside:
            assert monodromy(galerkin(BEAM, x, i.y, eta)).stable
        there = characteristic(BEAM.equation(i.Omega, i.y, eta)).T
        assert abs(i.T - there) < 1e-8


def covered(Omega: float, gamma: float, eta: float) -> bool:
    pairs = [pair for i in found(eta).values() if (pair := i.tongue.at(gamma))]
    return any(low <= Omega <= high for low, high in pairs)


def test_width_and_tip_without_damping() -> None:
    i = found(0.0)["omega_(1) + omega_(B)"]
    assert (i.resonance.type, i.resonance.order) == ("II", 1)
    frequencies = BEAM.natural_frequencies()
    assert i.tips == ((pytest.approx(sum(frequencies[:2]).real, abs=1e-12), 0.0),)
    assert np.isnan(i.critical_gamma)
    # Hsu's width is of first order: at gamma = .4 it misses by an eighth, at .002 by 1e-5
    assert i.width_Hsu / i.width == pytest.approx(1.08, abs=0.03)
    narrow = i.tongue.upper[0] - i.tongue.lower[0]
    assert narrow == pytest.approx(i.width_Hsu * i.tongue.y[0] / i.y, rel=1e-4)


def test_critical_gamma_under_damping() -> None:
    for name in ("omega_(1) + omega_(B)", "omega_(2) + omega_(B)", "2 omega_(1)"):
        i = found(0.01)[name]
        ((Omega, gamma),) = i.tips
        assert i.critical_gamma == gamma
        # to first order; at .226 the miss of 2 omega_(1) is the largest, 4e-3
        assert i.critical_gamma_Hsu == pytest.approx(gamma, rel=6e-3)
        assert monodromy(galerkin(BEAM, Omega, 0.99 * gamma, 0.01)).T < 0.0
        assert monodromy(galerkin(BEAM, Omega, 1.01 * gamma, 0.01)).T > 0.0


def test_damping_does_not_lose_a_tongue_that_drifts() -> None:
    """Of second order, with Hsu's width 0: its window must find it all the same."""
    i = found(0.01)["(2 omega_(1))/2"]
    assert i.critical_gamma == pytest.approx(0.1243, abs=1e-4)
    assert i.T > 0.05


def test_no_tongue_twice() -> None:
    for eta in (0.0, 0.01):
        own = [i.tongue for i in found(eta).values()]
        assert len(distinct(own)) == len(own)
        assert len(distinct(own + [replace(tongue) for tongue in own])) == len(own)


def test_axes_may_be_exchanged() -> None:
    turned = chart(
        BEAM,
        [("gamma", 0.1, 0.4, 30), ("Omega", 0.9, 1.3, 40)],
        route="floquet",
    )
    (own,) = (t for t in tongues(turned, orders=1) if t.resonance.name == "omega_(1) + omega_(B)")
    pair, other = own.at(0.4), found(0.0)["omega_(1) + omega_(B)"].tongue.at(0.4)
    assert pair == pytest.approx(other, abs=1e-9)
    with pytest.raises(ValueError, match="tongues: need a chart of Omega and one other"):
        tongues(chart(BEAM, [("T0", 5.0, 9.0, 3)], forcing={"Omega": 1.0, "gamma": 0.1}))


# ---- points --------------------------------------------------------------------------------------


def test_points_within_their_bounds() -> None:
    rng = np.random.default_rng(4)
    Omega, gamma = rng.uniform(0.7, 3.0, 60), rng.uniform(0.0, 0.4, 60)
    points = made(0.01).at(Omega=Omega, gamma=gamma)
    for k in range(60):
        c = characteristic(BEAM.equation(Omega[k], gamma[k], 0.01))
        assert np.abs(points.polynomial[k] - c.polynomial).max() <= points.error[k] + c.error
        assert abs(points.T[k] - c.T) <= points.T_error[k] + c.T_error
        assert np.sort_complex(points.z[k]) == pytest.approx(np.sort_complex(c.z), abs=1e-6)
        assert points.R[k] == pytest.approx(np.exp(np.pi / Omega[k] * (c.T + 0.01)), abs=1e-6)
        assert points.verdict[k] == c.verdict
    assert np.median(points.T_error) < 1e-8


def test_verdict_on_the_grid_is_that_of_its_points() -> None:
    small = made(0.0)
    x, y = np.meshgrid(*(axis.points for axis in small.axes))
    assert np.array_equal(
        small.unstable().ravel(), small.at(Omega=x.ravel(), gamma=y.ravel()).unstable
    )
    assert 0.05 < small.unstable().mean() < 0.5


def test_points_refuse() -> None:
    with pytest.raises(ValueError, match="at: needs Omega, gamma; got Omega"):
        made(0.0).at(Omega=1.0)
    with pytest.raises(ValueError, match=r"Omega = 3\.5: must be from 0\.7 to 3"):
        made(0.0).at(Omega=[1.0, 3.5], gamma=0.1)


# ---- boundaries of two other parameters ----------------------------------------------------------


@cache
def boundary(gamma: float) -> tuple[Curve, ...]:
    axes = [("K_theta", 0.1, 0.6, 30), ("T0", 10.0, 30.0, 30)]
    return boundaries(chart(BEAM, axes, forcing={"Omega": 1.8, "gamma": gamma}, route="floquet"))


def test_inertial_buckling_is_a_boundary() -> None:
    """Without pulsation the beam buckles where det F = 0, whatever K_theta is."""

    def det(T0: float) -> float:
        beam = UniformBeam(T0=T0, K_theta=0.5, xi_G=0.5)
        return float(np.linalg.det(beam.equation(1.0, 0.0).F))

    exact = brentq(det, 20.0, 30.0, xtol=1e-13)
    at = [c for c in boundary(0.0) if c.kind == "+1" and np.ptp(c.y) < 1e-6]
    assert sum(len(c.y) for c in at) > 100
    # Newton to 1e-9 of the axis; P's own 1e-11, at its slope of 1
    assert np.abs(np.concatenate([c.y for c in at]) - exact).max() < 1e-9


def test_stability_changes_across_every_curve() -> None:
    pulsating = boundary(0.1)
    assert {c.kind for c in pulsating} >= {"+1", "-1"}

    def stable(K_theta: float, T0: float) -> bool:
        beam = UniformBeam(T0=T0, K_theta=K_theta, xi_G=0.5)
        return monodromy(galerkin(beam, 1.8, 0.1)).stable

    for c in pulsating:
        for k in range(len(c.x) // 10, len(c.x) - 1, max(1, len(c.x) // 4)):
            tangent = np.array([(c.x[k + 1] - c.x[k - 1]) / 0.5, (c.y[k + 1] - c.y[k - 1]) / 20.0])
            normal = np.array([-tangent[1], tangent[0]]) / np.linalg.norm(tangent) * 1e-3
            sides = [(c.x[k] + s * 0.5 * normal[0], c.y[k] + s * 20.0 * normal[1]) for s in (-1, 1)]
            assert stable(*sides[0]) != stable(*sides[1])


def test_boundaries_refuse() -> None:
    with pytest.raises(ValueError, match="boundaries: need a chart of two parameters, not of 1"):
        boundaries(chart(BEAM, [("T0", 5.0, 9.0, 3)], forcing={"Omega": 1.0, "gamma": 0.1}))


# ---- two tongues that cross, and longitudinal resonances -----------------------------------------


def test_crossing_tongues_keep_their_names_and_widths() -> None:
    """omega_(1) + omega_(B) and omega_(2) - omega_(1) of the stepped beam, about K_theta = 1.4."""
    beam = SteppedBeam(T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6)
    axes = [("Omega", 1.0, 1.8, 40), ("K_theta", 0.6, 2.0, 30)]
    crossing = chart(beam, axes, forcing={"gamma": 0.1}, route="floquet")
    named = {i.resonance.name: i for i in instabilities(crossing, orders=1)}
    for name in ("omega_(1) + omega_(B)", "omega_(2) - omega_(1)"):
        i = named[name]
        # first order, beside the crossing: 1 and 11 per cent off; merged, they are 0.2 wide
        assert i.width == pytest.approx(i.width_Hsu, rel=0.15)
        assert i.tongue.y[0] < 1.0 < 1.9 < i.tongue.y[-1]


def test_a_chart_across_longitudinal_resonances() -> None:
    """Omega = omega_L runs across it: direct there, tongues broken off there, and no more."""
    axes = [("Omega", 2.4, 3.0, 100), ("omega_L", 2.9, 3.6, 60)]
    soft = chart(BEAM, axes, forcing={"gamma": 0.1}, route="floquet", tolerance=1e-6)
    assert 0 < soft.direct < 6000
    # cutting ends: no more than a few times the points themselves; measured 5,700
    assert soft.nodes < 4 * 6000
    for omega_L, Omega in ((3.55, 2.7), (2.95, 2.68)):
        beam = replace(BEAM, omega_L=omega_L)
        expected = characteristic(beam.equation(Omega, 0.1)).T
        # P's 1e-6 over T
        assert soft.at(Omega=Omega, omega_L=omega_L).T[0] == pytest.approx(expected, abs=1e-4)
        assert expected > 0.02
    with pytest.raises(ValueError, match=r"omega_L = 2\.95\): the undamped axial force is"):
        soft.at(Omega=2.95, omega_L=2.95)
    (own,) = (t for t in tongues(soft, orders=1) if t.resonance.name == "omega_(2) + omega_(B)")
    assert len(own.y) > 3


def test_a_tongue_centred_outside_the_range_is_followed() -> None:
    """Of 2 omega_(B) at .3825 only the upper half is in the chart."""
    frequencies = BEAM.natural_frequencies()
    axes = [("Omega", 0.385, 0.5, 60), ("gamma", 0.0, 0.3, 40)]
    c = chart(BEAM, axes, route="floquet")
    found = {i.resonance.name: i for i in instabilities(c)}
    own = found["2 omega_(B)"]
    assert own.resonance.Omega(frequencies.astype(complex)) < 0.385
    inside = c.unstable()
    assert inside.mean() > 0.05
    # every unstable point is in one of the tongues
    assert unnamed(c, [i.tongue for i in found.values()]) == ()
    low, high = own.tongue.at(0.2) or (0.0, 0.0)
    assert low < 0.385 < high
    for Omega, verdict in ((high - 1e-3, "unstable"), (high + 1e-3, "stable")):
        assert characteristic(BEAM.equation(Omega, 0.2)).verdict == verdict


def test_a_resonance_beside_the_range_is_followed_only_where_it_may_be_seen() -> None:
    """2 omega_(B) at .3825, which is .403 wide at most: .385 sees it, .42 does not."""
    for low, seen in ((0.385, True), (0.42, False)):
        axes = [("Omega", low, 0.5, 40), ("gamma", 0.0, 0.3, 30)]
        c = chart(BEAM, axes, forcing={"eta": 0.02}, route="floquet")
        tracer = TongueTracer(on_surface(c), Resonance(0, 0), (low, 0.5))
        at = stations(c.axes[1])
        assert may_reach(tracer, at) is seen
        # its window reaches both
        assert any(tracer.window(y) for y in at)
        # what is followed all the same says so too
        (own,) = follow(on_surface(c, 0.15, 1.0), tracer.resonance, at, Omega=(low, 0.5))
        assert bool(np.any(own.upper >= low)) is seen


def test_a_tongue_says_why_it_ends_at_a_pole() -> None:
    """2 omega_(1) about Omega = 1.82: a resonance of the bar crosses it where omega_L is that."""
    axes = [("Omega", 1.6, 2.4, 60), ("omega_L", 1.5, 3.0, 50)]
    c = chart(BEAM, axes, forcing={"gamma": 0.1}, route="floquet")
    pieces = [t for t in tongues(c, orders=1) if t.resonance.name == "2 omega_(1)"]
    (upper,) = (t for t in pieces if t.y[-1] == 3.0)
    assert upper.begins == BESIDE_POLE
    assert upper.ends == RANGE
    # it goes on to where the pole is less than half of omega_L away
    assert upper.y[0] < 2.3
    for k in (2, -3):
        beam = replace(BEAM, omega_L=float(upper.y[k]))
        width = float(upper.upper[k] - upper.lower[k])
        for Omega, verdict in (
            (upper.lower[k] - 0.05 * width, "stable"),
            (upper.lower[k] + 0.05 * width, "unstable"),
        ):
            assert characteristic(beam.equation(float(Omega), 0.1)).verdict == verdict


def test_no_tongue_jumps_to_another() -> None:
    """The third order of two differences crosses many tongues along K_theta."""
    beam = SteppedBeam(T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6)
    axes = [("Omega", 0.35, 6.0, 60), ("K_theta", 0.1, 2.0, 30)]
    c = chart(beam, axes, forcing={"gamma": 0.1}, route="floquet")
    field = on_surface(c)
    for t in tongues(c):
        Omega = np.array([t.resonance.Omega(field.frequencies(float(y))) for y in t.y])
        offsets, widths = 0.5 * (t.lower + t.upper) - Omega, t.upper - t.lower
        allowed = np.maximum(1.5 * np.maximum(widths[1:], widths[:-1]), 0.02 * Omega[1:])
        assert np.all(np.abs(np.diff(offsets)) <= allowed), t.resonance.name


def test_series_kept_are_bounded() -> None:
    field = on_surface(made(0.0))
    for y in np.linspace(0.0, 0.4, SECTIONS + 50):
        field.along(np.array([1.0]), float(y))
    assert field._section.cache_info().currsize == SECTIONS
