"""A vehicle's equation: the report's beams in physical units, what all must obey, its forms."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh
from vehicles import random_vehicle, thrust_matrices

from hill import (
    Damping,
    HillEquation,
    LongitudinalResonance,
    PeriodicEquation,
    PointMass,
    Section,
    Sensor,
    SteppedBeam,
    System,
    Thrust,
    UniformBeam,
    Vehicle,
    characteristic,
)
from hill.matrices.modes import eigenvalue, mode
from hill.system import frequency_names, natural_frequencies, varied

EXAMPLES = Path(__file__).parents[1] / "examples"

# some length, mass and stiffness, no two of them alike
L, M, EI = 48.0, 3.2, 1.7e7
OMEGA_1 = eigenvalue(1) ** 2 * math.sqrt(EI / M) / L**2


def as_vehicle(beam: UniformBeam | SteppedBeam, **given: object) -> Vehicle:
    """The beam in physical units."""
    wave = beam.omega_L * OMEGA_1 * L / math.pi
    EA = M * wave**2
    sections = (Section(L, M, EI, EA),)
    if isinstance(beam, SteppedBeam):
        a, i, c = beam.area_ratio, beam.inertia_ratio, beam.xi_c
        sections = (Section(c * L, a * M, i * EI, a * EA), Section((1 - c) * L, M, EI, EA))
    else:
        given = {"g": beam.g} | given
    return Vehicle(
        sections=sections,
        thrust=Thrust(beam.T0 * EI / L**2),
        sensors=(Sensor(beam.xi_G * L, beam.K_theta),),
        **({"modes": beam.modes, "quadrature_force": False} | given),  # type: ignore[arg-type]
    )


@pytest.mark.parametrize("modes", [1, 2, 3, 6, 12])
@pytest.mark.parametrize(("omega_L", "g"), [(math.inf, 0.0), (7.3, 0.0), (2.2, 0.05), (7.3, 2.0)])
def test_the_report_s_uniform_beam(modes: int, omega_L: float, g: float) -> None:
    """The same basis, so the same matrices: F, G and P to rounding."""
    beam = UniformBeam(T0=17.0, K_theta=0.4, xi_G=0.3, omega_L=omega_L, g=g, modes=modes)
    v = as_vehicle(beam)
    report = beam.equation(Omega=1.3, gamma=0.1, eta=0.01)
    own = v.equation(Omega=1.3 * OMEGA_1, gamma=0.1, eta=0.01 * OMEGA_1)
    assert isinstance(own, HillEquation)
    # the report's phi_n(1) may be negative; its rotation is xi, of mass 1/12 about the middle
    size = [*(math.copysign(1.0, mode(n)(1.0)) for n in range(1, modes + 1)), 12.0**-0.5]
    for theirs, mine in ((report.F, own.F), (report.G, own.G)):
        expected = theirs * np.outer(size, 1.0 / np.array(size))
        assert np.abs(mine / OMEGA_1**2 - expected).max() <= np.abs(expected).max() * (
            own.data_error + report.data_error
        )
    # the two P differ by what the data's errors may do, which the routes' own errors are like
    one, other = characteristic(report), characteristic(own)
    assert np.abs(one.polynomial - other.polynomial).max() <= 20.0 * (one.error + other.error)
    assert abs(other.T / OMEGA_1 - one.T) < 1e-9
    assert v.natural_frequencies() / OMEGA_1 == pytest.approx(beam.natural_frequencies(), abs=1e-9)
    assert v.frequencies() * 2 * math.pi / OMEGA_1 == pytest.approx(
        [(eigenvalue(n) / eigenvalue(1)) ** 2 for n in range(1, modes + 1)], rel=1e-13
    )


def test_the_report_s_stepped_beam_with_many_modes() -> None:
    """The report's shapes are a uniform beam's: the same limit, from farther away and more slowly.

    At two modes its frequencies under T0 = 20 are 1.6, 1.8 and 1.1 % from those of the exact modes.
    """
    apart = {}
    for modes in (2, 8, 16, 32):
        beam = SteppedBeam(
            T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6, modes=modes
        )
        report = beam.natural_frequencies()[:3]
        own = as_vehicle(beam).natural_frequencies()[:3] / OMEGA_1
        apart[modes] = report / own - 1.0
    assert apart[2] == pytest.approx([0.01584, 0.01810, 0.01077], abs=1e-5)
    # the curvature's step costs the report's shapes an order: like 1/N
    for a, b in ((8, 16), (16, 32)):
        assert np.all(np.abs(apart[b]) < 0.62 * np.abs(apart[a]))
    assert np.abs(apart[32]).max() < 0.005


def test_the_stepped_beam_s_axial_force() -> None:
    """With equal sections it is the uniform beam, compliance and all."""
    beam = UniformBeam(T0=17.0, K_theta=0.4, xi_G=0.3, omega_L=2.6, modes=3)
    cut = SteppedBeam(
        T0=17.0,
        K_theta=0.4,
        xi_G=0.3,
        omega_L=2.6,
        modes=3,
        xi_c=0.37,
        area_ratio=1.0,
        inertia_ratio=1.0,
    )
    one, other = (as_vehicle(b).equation(2.0 * OMEGA_1, 0.1) for b in (beam, cut))
    assert isinstance(one, HillEquation)
    assert isinstance(other, HillEquation)
    for a, b in ((one.F, other.F), (one.G, other.G)):
        assert np.abs(a - b).max() <= np.abs(a).max() * (one.data_error + other.data_error)


# ---- what any vehicle obeys ----------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(30))
def test_a_free_vehicle_may_be_turned(seed: int) -> None:
    """No force answers a rigid rotation under a thrust that follows: the column is zero.

    It is so only if P has the mass ahead in it, point masses and the thrust's own jump included.
    """
    v = random_vehicle(seed, control=True, ends=("free", "free"), sensors=(), servo_time=0.0)
    v = replace(v, thrust=replace(v.thrust, direction="follower", mean=abs(v.thrust.mean)))
    eq = replace(v, damping=Damping()).equation(1.0, 0.1)
    assert isinstance(eq, HillEquation)
    thrust = np.abs(eq.F - np.diag(np.diag(eq.F))).max()
    assert np.abs(eq.F[:, -1]).max() < 1e-11 * max(thrust, np.abs(eq.G).max())
    assert np.abs(eq.G[:, -1]).max() < 1e-11 * np.abs(eq.G).max()


@pytest.mark.parametrize("seed", range(40))
def test_thrust_by_finite_elements(seed: int) -> None:
    """Squares of the frequencies under thrust, in as many modes of plain elements."""
    v = random_vehicle(seed, control=True)
    if not math.isinf(v.sections[0].kGA[0]):
        return
    v = replace(v, damping=Damping(), servo_time=0.0)
    mass, stiffness, pull = thrust_matrices(v, 60)
    squares, shapes = eigh(stiffness, mass)
    rigid = 2 - sum({"free": 0, "pinned": 1, "clamped": 2}[end] for end in v.ends)
    kept = shapes[:, : max(rigid, 0) + v.modes]
    F = np.diag(np.where(np.arange(kept.shape[1]) < rigid, 0.0, squares[: kept.shape[1]]))
    F += v.thrust.mean * kept.T @ pull @ kept
    expected = np.sort_complex(np.linalg.eigvals(F))
    if rigid == 2:  # the translation, which nothing answers
        expected = np.delete(expected, np.argmin(np.abs(expected)))
    found = np.sort_complex(v.natural_frequencies().astype(complex) ** 2)
    # elements are stiffer by 1e-4 of the higher ones, of which a pair has its share
    size = np.abs(expected)
    assert np.all(np.abs(found - expected) <= 3e-4 * np.sqrt(size * size.max()) + 1e-6 * size.max())


def test_a_bar_resonates_with_its_masses() -> None:
    """Held at the nose, a mass at the end: sigma tan sigma = (bar's mass)/(end's mass)."""
    from scipy.optimize import brentq

    v = Vehicle(
        sections=(Section(2.0, 3.0, 5.0, 7.0),),
        masses=(PointMass(2.0, 4.0),),
        ends=("clamped", "free"),
        thrust=Thrust(0.1),
        modes=3,
    )
    sigma = brentq(lambda x: x * math.tan(x) - 6.0 / 4.0, 0.1, 1.5, xtol=1e-15)
    resonance = sigma * math.sqrt(7.0 / 3.0) / 2.0
    with pytest.raises(LongitudinalResonance, match="Omega = "):
        v.equation(resonance, 0.1)
    below, above = (v.equation(resonance * x, 0.1) for x in (1 - 1e-6, 1 + 1e-6))
    assert isinstance(below, HillEquation)
    assert isinstance(above, HillEquation)
    assert np.abs(below.G).max() > 1e4 * np.abs(v.equation(resonance / 2, 0.1).G).max()  # type: ignore[union-attr]
    assert np.abs(below.G + above.G).max() < 1e-3 * np.abs(above.G).max()
    assert below.data_error > 1e3 * v.equation(resonance / 2, 0.1).data_error


def test_a_stiff_bar_is_rigid() -> None:
    v = Vehicle.from_file(EXAMPLES / "three_stage.toml")
    v = replace(v, sensors=(Sensor(100.0, 0.5),), damping=Damping())
    rigid = v.equation(18.0, 0.1)
    stiff = replace(v, sections=tuple(replace_EA(s, 1e18) for s in v.sections)).equation(18.0, 0.1)
    assert isinstance(rigid, HillEquation)
    assert isinstance(stiff, HillEquation)
    assert np.abs(stiff.G - rigid.G).max() < 1e-6 * np.abs(rigid.G).max()


def replace_EA(s: Section, EA: float) -> Section:
    return Section(s.length, s.mass_per_length, s.EI, EA, name=s.name)


def test_structural_damping() -> None:
    """Next to resonance the sine part is nearly all of it; both laws agree there to first order."""
    v = Vehicle(sections=(Section(2.0, 3.0, 5.0, 7.0),), thrust=Thrust(0.1), modes=3, g=1e-3)
    resonance = math.pi / 2.0 * math.sqrt(7.0 / 3.0)
    by_law = {}
    for law in ("report", "hysteretic"):
        eq = replace(v, axial_damping=law).equation(resonance, 1.0)  # type: ignore[arg-type]
        assert isinstance(eq, PeriodicEquation)
        assert eq.K is not None
        sin, cos = eq.K.sin[1], eq.K.cos[1]
        assert np.abs(sin).max() > 100.0 * np.abs(cos).max()
        by_law[law] = sin
    assert by_law["hysteretic"] == pytest.approx(by_law["report"], rel=1e-2, abs=1e-2)
    dropped = replace(v, quadrature_force=False).equation(resonance, 1.0)
    assert isinstance(dropped, HillEquation)


# ---- forms ---------------------------------------------------------------------------------------


def test_which_form_an_equation_has() -> None:
    v = Vehicle(sections=(Section(2.0, 3.0, 5.0),), thrust=Thrust(1.0), modes=3)
    assert isinstance(v, System)
    assert natural_frequencies(v).shape == (4,)
    assert frequency_names(v, 4) == ("B", "1", "2", "3")
    assert isinstance(v.equation(1.0, 0.1, 0.2), HillEquation)
    with_eta = replace(v, damping=Damping(eta=0.3)).equation(1.0, 0.1, 0.2)
    assert isinstance(with_eta, HillEquation)
    assert with_eta.eta == 0.5
    steered = replace(v, sensors=(Sensor(1.0, 0.5),))
    assert isinstance(steered.equation(1.0, 0.1), HillEquation)
    rated = replace(v, sensors=(Sensor(1.0, 0.5, 0.2),)).equation(1.0, 0.1)
    assert isinstance(rated, PeriodicEquation)
    assert rated.C is not None
    assert rated.C.cos[1] == pytest.approx(0.1 * rated.C.mean)
    served = replace(steered, servo_time=0.1).equation(1.0, 0.1)
    assert isinstance(served, PeriodicEquation)
    assert served.order == 9
    # nothing to serve
    assert isinstance(replace(v, servo_time=0.1).equation(1.0, 0.1), HillEquation)


def test_modal_ratios() -> None:
    v = Vehicle(sections=(Section(2.0, 3.0, 5.0),), modes=4, damping=Damping((0.01, 0.02), eta=0.3))
    eq = v.equation(1.0, 0.0)
    assert isinstance(eq, PeriodicEquation)
    assert eq.C is not None
    ratios = np.array([0.01, 0.02, 0.02, 0.02])
    expected = np.append(2.0 * ratios * 2.0 * math.pi * v.frequencies(), 0.0) + 0.3
    assert eq.C.mean == pytest.approx(np.diag(expected))
    matrix = np.arange(25.0).reshape(5, 5)
    other = replace(v, damping=Damping(matrix=matrix)).equation(1.0, 0.0, 0.5)
    assert isinstance(other, PeriodicEquation)
    assert other.C is not None
    assert other.C.mean == pytest.approx(matrix + 0.5 * np.eye(5))


def test_a_servo_obeys_its_own_equation() -> None:
    """Each s of A's mean solves det(s^2 + C s + K + push (gain + rate s)/(1 + time s)) = 0."""
    v = Vehicle.from_file(EXAMPLES / "three_stage.toml")
    v = replace(v, servo_time=0.07)
    served = v.equation(18.0, 0.1, 0.2)
    direct = replace(v, servo_time=0.0).equation(18.0, 0.1, 0.2)
    bare = replace(v, sensors=()).equation(18.0, 0.1, 0.2)
    assert isinstance(served, PeriodicEquation)
    assert isinstance(direct, PeriodicEquation)
    assert isinstance(bare, PeriodicEquation)
    assert served.A is not None
    assert direct.K is not None
    assert direct.C is not None
    assert bare.K is not None
    assert bare.C is not None
    gain, rate = direct.K.mean - bare.K.mean, direct.C.mean - bare.C.mean
    for factor, A in ((1.0, served.A.mean), (1.1, served.A.mean + served.A.cos[1])):
        K = bare.K.mean + (bare.K.cos[1] if factor > 1.0 else 0.0)
        for s in np.linalg.eigvals(A):
            D = s**2 * np.eye(5) + s * bare.C.mean + K + factor * (gain + rate * s) / (1 + 0.07 * s)
            singular = np.linalg.svd(D, compute_uv=False)
            assert singular[-1] < 1e-9 * singular[0]
    assert len(np.linalg.eigvals(served.A.mean)) == 11


def test_a_fast_servo_is_none() -> None:
    v = Vehicle.from_file(EXAMPLES / "three_stage.toml")
    direct = v.equation(18.0, 0.0)
    fast = replace(v, servo_time=1e-7).equation(18.0, 0.0)
    assert isinstance(direct, PeriodicEquation)
    assert isinstance(fast, PeriodicEquation)
    assert direct.K is not None
    assert direct.C is not None
    assert fast.A is not None
    n = len(direct.K.mean)
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [-direct.K.mean, -direct.C.mean]])
    slow = np.linalg.eigvals(fast.A.mean)
    slow = np.sort_complex(slow[np.abs(slow) < 1e5])
    assert slow == pytest.approx(np.sort_complex(np.linalg.eigvals(companion)), rel=1e-4)


def test_units_do_not_matter() -> None:
    """The three stages in SI: the same frequencies, the same P."""
    v = Vehicle.from_file(EXAMPLES / "three_stage.toml")
    v = replace(v, sensors=(Sensor(100.0, 0.5),), damping=Damping(eta=0.1))
    inch, slinch = 0.0254, 175.126835
    force = slinch * inch
    metric = replace(
        v,
        units="SI",  # type: ignore[arg-type]
        sections=tuple(
            Section(
                s.length * inch, s.mass_per_length[0] * slinch / inch, s.EI[0] * force * inch**2
            )
            for s in v.sections
        ),
        sensors=(Sensor(100.0 * inch, 0.5),),
        thrust=Thrust(2e7 * force),
    )
    assert metric.frequencies() == pytest.approx(v.frequencies(), rel=1e-12)
    one, other = (characteristic(x.equation(18.0, 0.1)) for x in (v, metric))
    assert np.abs(one.polynomial - other.polynomial).max() <= 10.0 * (one.error + other.error)


def test_the_three_stages() -> None:
    """Elements of the same stages, by another hand (outside.json): 9.4057 25.2445 44.0537 ..."""
    v = replace(Vehicle.from_file(EXAMPLES / "three_stage.toml"), modes=5)
    assert 2 * math.pi * v.frequencies() == pytest.approx(
        [9.4057, 25.2445, 44.0537, 73.590, 109.926], abs=6e-4
    )


def test_half_the_euler_load() -> None:
    """NASTRAN's demonstration problem 13-1-1 to its seven digits (outside.json)."""
    v = Vehicle(
        sections=(Section(100.0, 0.0002 * 2.0, 10.4e6 * 0.666667),),
        ends=("pinned", "pinned"),
        thrust=Thrust(3423.17, direction="fixed"),
        units="in-lbf-s",  # type: ignore[arg-type]
        modes=3,
    )
    found = v.frequencies(under_thrust=True)
    assert found == pytest.approx([14.61968, 77.37659, 180.8778], rel=4e-7)
    # pinned ends do not move: following or not is the same
    assert replace(v, thrust=Thrust(3423.17)).frequencies(under_thrust=True) == pytest.approx(found)


def test_parameters_move_an_equation_as_they_say() -> None:
    """F and G are linear in what is called linear."""
    v = Vehicle.from_file(EXAMPLES / "stepped.toml")
    for name in ("thrust", "K_theta"):
        at = [varied(v, {name: x}).equation(6.0, 0.1) for x in (1.0, 2.0, 3.0)]
        for which in ("F", "G"):
            a, b, c = (getattr(x, which) for x in at)
            assert a - 2 * b + c == pytest.approx(np.zeros_like(a), abs=1e-12 * np.abs(a).max())


def test_an_end_that_is_held_does_not_move() -> None:
    """A thrust or a sensor there does nothing at all, not even by rounding."""
    for ends, rate in ((("free", "pinned"), 0.2), (("clamped", "clamped"), 0.2)):
        v = Vehicle(
            sections=(Section(2.0, (3.0, 4.0), 5.0),),
            ends=ends,  # type: ignore[arg-type]
            thrust=Thrust(1.0),
            sensors=(Sensor(1.0, 0.5, rate), Sensor(2.0, 0.3)),
            modes=3,
        )
        eq = v.equation(1.0, 0.1)
        assert isinstance(eq, HillEquation)
        if ends[0] == "free":
            assert not np.any(eq.G)
    at_the_end = replace(v, thrust=Thrust(1.0, 1.5), sensors=(Sensor(2.0, 0.3, 0.1),))
    assert isinstance(at_the_end.equation(1.0, 0.1), HillEquation)
