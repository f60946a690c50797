"""Bands of instability along Omega, and where things begin, against the whole determinant."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from compare.vehicle.candidates import candidates
from compare.vehicle.critical import critical_gamma
from compare.vehicle.fits import excess
from compare.vehicle.near import Near
from hill import (
    Damping,
    PointMass,
    Section,
    Sensor,
    Thrust,
    UniformBeam,
    Vehicle,
    characteristic,
    critical_thrust,
)
from hill.averaging import Resonance, first_order, half_width
from hill.averaging import critical_gamma as Hsu_critical
from hill.oscillations.coupling import Coupled
from hill.oscillations.steady import steady
from hill.vehicle.inertia import rigid_body

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=2)
FIRST = [Resonance(0, 0), Resonance(1, 0), Resonance(2, 2), Resonance(2, 1, -1)]


def near(resonance: Resonance, gamma: float, eta: float) -> Near:
    return Near(
        lambda Omega: BEAM.equation(Omega, gamma, eta),
        resonance,
        steady(BEAM.equation(1.0, 0.0, eta)),
    )


def verdict(Omega: float, gamma: float, eta: float) -> str:
    return characteristic(BEAM.equation(Omega, gamma, eta)).verdict


# ---- averaging -----------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [0.0, 0.01])
@pytest.mark.parametrize("resonance", FIRST, ids=lambda r: r.name)
def test_the_guess_is_Hsus_of_the_first_order(resonance: Resonance, eta: float) -> None:
    at = near(resonance, 0.1, eta)
    e, guess = at.equation(at.Omega), at.guess()
    # eta/2 more frequency is no part of averaging
    assert guess.half_width == pytest.approx(half_width(resonance, e), rel=2e-3, abs=1e-12)
    if eta:
        assert 0.1 * guess.critical == pytest.approx(Hsu_critical(resonance, e), rel=1e-3)
    else:
        assert guess.critical == 0.0


def test_the_guess_of_the_second_order() -> None:
    """Where pulsation moves no frequency, the guess is the band: two oscillations coupled by G."""
    e = BEAM.equation(1.0, 0.02)
    alone = steady(e)
    resonance = Resonance(2, 1, 1, 2)
    Omega = resonance.Omega(alone.frequencies + 0j)
    guess = Coupled(BEAM.equation(Omega, 0.02), alone).guess(resonance)
    band = near(resonance, 0.02, 0.0).band()
    assert abs(guess.T - band.T) < 0.02 * band.T + 1e-9


# ---- a band --------------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [0.0, 0.01])
@pytest.mark.parametrize("gamma", [0.1, 0.3])
@pytest.mark.parametrize("resonance", FIRST, ids=lambda r: r.name)
def test_edges_are_where_the_determinant_has_them(
    resonance: Resonance, gamma: float, eta: float
) -> None:
    band = near(resonance, gamma, eta).band()
    whole = characteristic(BEAM.equation(band.Omega, gamma, eta))
    assert abs(band.T - whole.T) <= whole.T_error + band.T_error + 1e-12
    if band.edges is None:
        assert band.T < 0.0
        assert whole.verdict == "stable"
        return
    off = 1e-6 * band.width + band.edge_error
    low, high = band.edges
    for Omega, expected in (
        (low - off, "stable"),
        (low + off, "unstable"),
        (high - off, "unstable"),
        (high + off, "stable"),
    ):
        assert verdict(Omega, gamma, eta) == expected
    assert band.edge_error < 1e-4 * band.width
    # it grows nowhere faster
    for Omega in np.linspace(low, high, 9):
        assert characteristic(BEAM.equation(float(Omega), gamma, eta)).T <= band.T + 1e-9


def test_a_band_of_the_second_order() -> None:
    """Where averaging is wrong by a factor and by more than the width."""
    band = near(Resonance(1, 1, 1, 2), 0.1, 0.0).band()
    assert band.edges is not None
    low, high = band.edges
    off = 1e-5 * band.width
    found = [verdict(x, 0.1, 0.0) for x in (low - off, low + off, high - off, high + off)]
    assert found == ["stable", "unstable", "unstable", "stable"]


# ---- where it opens ------------------------------------------------------------------------------


@pytest.mark.parametrize("start", [0.05, 0.3])
@pytest.mark.parametrize("resonance", FIRST, ids=lambda r: r.name)
def test_the_critical_pulsation(resonance: Resonance, start: float) -> None:
    eta = 0.01

    def at(gamma: float) -> Near:
        return near(resonance, gamma, eta)

    found = critical_gamma(at, at(start).band(), start)
    assert found is not None
    assert at(found * 0.9999).band().edges is None
    opened = at(found * 1.0001).band()
    assert opened.edges is not None
    assert verdict(opened.Omega, found * 1.0001, eta) == "unstable"
    assert verdict(opened.Omega, found * 0.999, eta) == "stable"


def test_the_critical_pulsation_of_two_that_decay_unlike() -> None:
    """A sensor's rate damps the rotation more than the mode: T is not largest in the middle.

    On either side of the critical pulsation the growth over all of Omega is looked at one by one.
    """
    v = Vehicle(
        sections=(Section(1.0, 1.0, 1.0),),
        thrust=Thrust(12.0),
        sensors=(Sensor(0.5, 0.5, 0.02),),
        damping=Damping(0.003),
        units="none",  # type: ignore[arg-type]
        modes=3,
    )
    alone, resonance = steady(v.equation(1.0, 0.0)), Resonance(1, 0)

    def at(gamma: float) -> Near:
        return Near(lambda Omega: v.equation(Omega, gamma), resonance, alone)

    a, b = at(0.1).rates
    assert max(a, b) > 1.5 * min(a, b) > 0.0
    band = at(0.1).band()
    found = critical_gamma(at, band, 0.1)
    assert found is not None
    for share, opens in ((0.999, False), (1.001, True)):
        gamma = share * found
        centre = at(gamma).Omega + (band.middle - band.resonance.Omega(alone.frequencies + 0j)) * (
            (gamma / 0.1) ** 2
        )
        grid = centre + (a + b) * np.linspace(-1.0, 1.0, 401)
        most = max(at(gamma).at(float(x)).T for x in grid)
        assert (most > 0.0) == opens


def test_without_damping_it_opens_at_once() -> None:
    at = near(Resonance(1, 0), 0.1, 0.0)
    assert critical_gamma(lambda _: at, at.band(), 0.1) == 0.0


def test_one_that_never_opens() -> None:
    at = near(Resonance(2, 1), 0.1, 0.01)
    band = replace(at.band(), excess=at.excess_at_rest * 1.01)
    assert critical_gamma(lambda _: at, band, 0.1) is None


# ---- steady thrust -------------------------------------------------------------------------------

UNIT = Section(1.0, 1.0, 1.0)


@pytest.mark.parametrize("own", [3.0, 15.0, 40.0])
def test_becks_column_flutters(own: float) -> None:
    v = Vehicle(sections=(UNIT,), ends=("clamped", "free"), thrust=Thrust(own), modes=8)
    found = critical_thrust(v)
    assert found.kind == "flutter"
    assert found.thrust == pytest.approx(20.05, abs=5e-3)
    # Beck's column flutters at 11.02 sqrt(EI/m)/l^2
    assert 2.0 * pi * found.frequency == pytest.approx(11.016, abs=5e-3)


def test_eulers_column_buckles() -> None:
    thrust = Thrust(1.0, direction="fixed")
    v = Vehicle(sections=(UNIT,), ends=("pinned", "pinned"), thrust=thrust, modes=2)
    found = critical_thrust(v)
    assert found.kind == "divergence"
    assert found.frequency == 0.0
    assert found.thrust == pytest.approx(pi**2, rel=1e-6)


def test_what_carries_any_thrust() -> None:
    """One that is pulled."""
    thrust = Thrust(-1.0, direction="fixed")
    v = Vehicle(sections=(UNIT,), ends=("pinned", "pinned"), thrust=thrust, modes=2)
    assert critical_thrust(v).kind == "none"


# ---- which to look at ----------------------------------------------------------------------------


def test_candidates_are_ordered_by_danger() -> None:
    at = near(Resonance(0, 0), 0.1, 0.01)
    found = candidates(at, ("B", "1", "2"), 2, 0.3, 6.0)
    assert found[0].resonance.name == "omega_(1) + omega_(B)"
    critical = [c.guess.critical for c in found]
    assert critical == sorted(critical)
    assert all(0.3 <= c.Omega <= 6.0 for c in found)
    assert {c.resonance.order for c in found} == {1, 2}
    assert not candidates(at, ("B", "1", "2"), 2, 100.0, 200.0)


# ---- as a rigid body -----------------------------------------------------------------------------


def test_the_rigid_body() -> None:
    v = Vehicle(
        sections=(Section(2.0, (1.0, 3.0), 1.0, rotary_inertia=0.5), Section(1.0, 2.0, 1.0)),
        masses=(PointMass(0.5, 4.0, 0.25),),
    )
    x = np.linspace(0.0, 3.0, 300001)
    m = np.where(x < 2.0, 1.0 + x, 2.0)
    mass = np.trapezoid(m, x) + 4.0
    centre = (np.trapezoid(m * x, x) + 2.0) / mass
    inertia = np.trapezoid(m * (x - centre) ** 2, x) + 4.0 * (0.5 - centre) ** 2 + 0.25 + 1.0
    found = rigid_body(v)
    assert found.mass == pytest.approx(mass, rel=1e-5)
    assert found.centre == pytest.approx(centre, rel=1e-5)
    assert found.inertia == pytest.approx(inertia, rel=1e-5)


def test_the_three_stages_weigh_what_nastran_says() -> None:
    """Demonstration problem 10-1-1: 85,000, centre of mass 116.176 from the aft end."""
    v = Vehicle(
        sections=(
            Section(50.0, 100.0, 5.2e10),
            Section(100.0, 200.0, 2.08e11),
            Section(150.0, 400.0, 6.24e11),
        )
    )
    found = rigid_body(v)
    assert found.mass == 85000.0
    assert 300.0 - found.centre == pytest.approx(116.1765, abs=5e-5)


def test_a_vehicle_with_everything_has_bands_too() -> None:
    """Rates, modal damping and a servo: equations of second and of first order."""
    for servo, rate in ((0.0, 0.0005), (0.01, 0.005)):
        v = Vehicle(
            sections=(UNIT,),
            thrust=Thrust(5.0),
            sensors=(Sensor(0.5, 0.5, rate),),
            damping=Damping(0.002),
            servo_time=servo,
            modes=3,
        )
        alone = steady(v.equation(1.0, 0.0))
        assert alone.growth < 0.0
        band = Near(lambda Omega, v=v: v.equation(Omega, 0.5), Resonance(2, 2), alone).band()  # type: ignore[misc]
        whole = characteristic(v.equation(band.Omega, 0.5))
        assert abs(band.T - whole.T) < 1e-6


def test_a_band_of_very_unequal_dampings_opens_where_its_excess_is_nothing() -> None:
    """Held against another maximiser: one parabola of the whole width is off by 1e-3 there."""
    rocket = Vehicle.from_file(Path(__file__).parent.parent / "examples" / "three_stage.toml")
    vehicle = replace(rocket, modes=4, damping=Damping((0.001, 0.05)))
    alone = steady(vehicle.equation(1.0, 0.0))
    (two,) = (
        r
        for r in first_order(5, vehicle.frequency_names)
        if r.name == "omega_(2) + omega_(B)" and r.sign > 0
    )

    def at(gamma: float) -> Near:
        return Near(lambda Omega: vehicle.equation(Omega, gamma), two, alone)

    assert max(at(0.2).rates) > 20.0 * min(at(0.2).rates)
    band = at(0.2).band()
    critical = critical_gamma(at, band, 0.2)
    assert critical is not None
    opening = at(critical)
    most = minimize_scalar(
        lambda Omega: -excess(opening.at(Omega), Omega),
        bounds=(band.middle - 0.5, band.middle + 0.5),
        method="bounded",
        options={"xatol": 1e-7},
    )
    assert abs(most.fun) < 1e-5 * abs(opening.excess_at_rest)
