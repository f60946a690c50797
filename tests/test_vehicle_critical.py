"""Steady thrust alone: columns and free beams of the literature, and how many modes are enough."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy import cos, cosh, sin, sinh
from scipy.optimize import brentq, minimize_scalar
from scipy.special import jv
from vehicles import random_vehicle

from hill import (
    Convergence,
    Damping,
    PointMass,
    Section,
    Sensor,
    Thrust,
    UniformBeam,
    Vehicle,
    critical_thrust,
    with_more_modes,
)
from hill.vehicle.convergence import extrapolated
from hill.vehicle.critical import Mean, _first
from hill.vehicle.discs import Moved
from hill.vehicle.matrices import structure

EXAMPLES = Path(__file__).parents[1] / "examples"
ONE = Section(1.0, 1.0, 1.0)
FREE = Vehicle(sections=(ONE,), thrust=Thrust(1.0), modes=2)


def limit(v: Vehicle, *modes: int) -> Convergence:
    return with_more_modes(v, lambda x: critical_thrust(x).thrust, modes=modes or None)


def test_inertial_buckling() -> None:
    """A controlled free beam: 26.58 at two modes, (3/2 j_{2/3,1})^2 = 25.638 in the limit.

    The report has 25.67 (7.2) and calls it the two modes'. Neither gain nor sensor matters.
    """
    exact = (1.5 * brentq(lambda x: jv(2.0 / 3.0, x), 3.0, 3.7, xtol=1e-14)) ** 2
    assert exact == pytest.approx(25.638, abs=5e-4)
    for station, gain in ((0.5, 0.5), (0.6, 0.3)):
        v = replace(FREE, sensors=(Sensor(station, gain),))
        two = critical_thrust(v)
        assert two.thrust == pytest.approx(26.58, abs=5e-3)
        assert two.kind == "divergence"
        assert two.frequency == 0.0
        assert two.margin(v) == two.thrust
        found = limit(v, 4, 6, 8, 10, 12, 14)
        assert found.modes == (4, 6, 8, 10, 12, 14)
        assert abs(found.limit - exact) <= found.error < 2e-3 * exact
        assert found.apart(4) == pytest.approx(25.840858 / found.limit - 1.0, abs=1e-6)


def test_the_report_s_buckling() -> None:
    """Appendix A's first vehicle against the singular F of its own closed forms."""

    def determinant(T0: float) -> float:
        beam = UniformBeam(T0=T0, K_theta=0.5, xi_G=0.5, modes=2)
        return float(np.linalg.det(beam.equation(Omega=1.0, gamma=0.0).F))

    exact = brentq(determinant, 20.0, 30.0, xtol=1e-14) * 1.360644e14 / 4800.0**2
    found = critical_thrust(Vehicle.from_file(EXAMPLES / "uniform.toml"))
    assert found.thrust == pytest.approx(exact, rel=1e-11)
    assert found.resolution < 1e-4 * exact


def test_flutter_of_a_free_beam() -> None:
    """Beal's 109.7 to 109.9, by the number of modes; without control the rotation is neutral."""
    by_modes = {2: 116.097, 3: 109.984, 4: 109.967, 6: 109.782, 8: 109.722}
    for modes, expected in by_modes.items():
        found = critical_thrust(replace(FREE, modes=modes))
        assert found.thrust == pytest.approx(expected, abs=6e-4)
        assert found.kind == "flutter"
        assert found.frequency > 0.0
    found_limit = limit(FREE, 4, 6, 8, 10, 12, 14)
    assert found_limit.error < 0.05
    assert abs(found_limit.limit - 109.69) < 0.005 + found_limit.error


def pflueger(ratio: float) -> float:
    """Where two frequencies of a clamped column meet: y''' + ratio w^2 y = y'' = 0 at its end."""

    def determinant(P: float, w: float) -> float:
        root = math.sqrt(P**2 / 4 + w**2)
        a, b = math.sqrt(root - P / 2), math.sqrt(root + P / 2)
        # both have y(0) = y'(0) = 0
        y = (cosh(a) - cos(b), a**2 * cosh(a) + b**2 * cos(b), a**3 * sinh(a) - b**3 * sin(b))
        z = (
            b * sinh(a) - a * sin(b),
            b * a**2 * sinh(a) + a * b**2 * sin(b),
            b * a**3 * cosh(a) + a * b**3 * cos(b),
        )
        k = ratio * w**2
        return y[1] * (z[2] + k * z[0]) - z[1] * (y[2] + k * y[0])

    def load(w: float) -> float:
        """The lowest P at which w is a frequency, with 0 outside the pair."""
        grid = np.linspace(0.01, 60.0, 1500)
        values = [determinant(P, w) for P in grid]
        for p, q, x, y in zip(grid, grid[1:], values, values[1:], strict=False):
            if x * y < 0.0:
                return float(brentq(determinant, p, q, (w,), xtol=1e-13))
        return 0.0

    first = brentq(lambda w: determinant(1e-9, w), 0.1, 5.0)
    peak = minimize_scalar(
        lambda w: -load(w),
        bounds=(1.01 * first, 4.0 * first + 6.0),
        method="bounded",
        options={"xatol": 1e-6},
    )
    return -float(peak.fun)


@pytest.mark.parametrize(("ratio", "expected"), [(0.0, 20.05), (0.5, None), (1.0, 16.21)])
def test_columns_of_beck_and_pflueger(ratio: float, expected: float | None) -> None:
    """20.05 EI/l^2 without a mass at the end; with one by the closed form's meeting frequencies."""
    exact = pflueger(ratio)
    if expected is not None:
        assert exact == pytest.approx(expected, abs=5e-3)
    masses = (PointMass(1.0, ratio),) if ratio else ()
    v = replace(FREE, ends=("clamped", "free"), masses=masses)
    found = limit(v, 6, 8, 10, 12, 14, 16)
    assert abs(found.limit - exact) <= found.error + 1e-6 * exact
    assert found.error < 1e-4 * exact
    name = "pflueger" if ratio else "beck"
    example = Vehicle.from_file(EXAMPLES / f"{name}.toml")
    assert replace(example, damping=Damping(), thrust=Thrust(1.0)).ends == v.ends


@pytest.mark.parametrize(
    ("ends", "expected"),
    [
        (("clamped", "free"), (math.pi / 2) ** 2),
        (("pinned", "pinned"), math.pi**2),
        (("clamped", "pinned"), 4.493409457909064**2),
        (("clamped", "clamped"), 4 * math.pi**2),
    ],
)
def test_euler(ends: tuple[str, str], expected: float) -> None:
    """Loads of fixed direction."""
    v = replace(FREE, ends=ends, thrust=Thrust(1.0, direction="fixed"))  # type: ignore[arg-type]
    found = limit(v, 6, 8, 10, 12, 14, 16)
    assert abs(found.limit - expected) <= found.error + 1e-12
    assert found.error < 2e-3 * expected
    assert critical_thrust(v).kind == "divergence"
    pulled = critical_thrust(replace(v, thrust=Thrust(-1.0, direction="fixed")))
    assert pulled.kind == "none"
    assert pulled.thrust == -math.inf
    assert math.isnan(pulled.frequency)


def test_in_the_vehicle_s_units() -> None:
    """The same column in inches and pounds, from a thrust of its own."""
    v = Vehicle(
        sections=(Section(48.0, 3.2, 1.7e7),), ends=("clamped", "free"), thrust=Thrust(3e3), modes=6
    )
    found = critical_thrust(v)
    expected = critical_thrust(replace(FREE, ends=("clamped", "free"), modes=6))
    assert found.thrust == pytest.approx(expected.thrust * 1.7e7 / 48.0**2)
    time = math.sqrt(3.2 * 48.0**4 / 1.7e7)
    assert found.frequency == pytest.approx(expected.frequency / time, rel=1e-6)
    assert found.margin(v) == found.thrust / 3e3


def test_a_little_damping_destabilizes() -> None:
    """Ziegler: with small damping in proportion to mass Beck's load stays, with damping in
    proportion to stiffness it falls to about half.
    """
    column = replace(FREE, ends=("clamped", "free"), modes=6)
    undamped = critical_thrust(column).thrust
    external = critical_thrust(replace(column, damping=Damping(eta=1e-3))).thrust
    assert external == pytest.approx(undamped, rel=1e-3)
    # ratios in proportion to the frequencies are Kelvin and Voigt's: 10.94 EI/l^2 (Bolotin)
    w = 2 * math.pi * column.frequencies()
    internal = critical_thrust(replace(column, damping=Damping(tuple(1e-6 * w)))).thrust
    assert internal == pytest.approx(10.94, abs=0.03)


def test_rates_and_servo() -> None:
    """Rate feedback damps a free vehicle's rotation; a slow servo without rates drives it."""
    v = replace(FREE, sensors=(Sensor(0.5, 0.5),), modes=4)
    steered = critical_thrust(v)
    assert steered.kind == "divergence"
    lagging = critical_thrust(replace(v, servo_time=0.01))
    assert lagging.thrust == 0.0
    assert lagging.kind == "flutter"
    rated = critical_thrust(replace(v, sensors=(Sensor(0.9, 0.5, 0.02),), servo_time=0.001))
    assert rated.thrust > 0.1
    damped = replace(v, sensors=(Sensor(0.5, 0.5),), servo_time=0.01, damping=Damping(eta=0.05))
    assert 0.0 < critical_thrust(damped).thrust < steered.thrust


def test_exact_before_and_behind() -> None:
    """On a fine grid of thrusts the frequencies are real before the critical one, not behind it."""
    v = replace(Vehicle.from_file(EXAMPLES / "three_stage.toml"), damping=Damping())
    v = replace(v, sensors=(Sensor(100.0, 0.5),))
    found = critical_thrust(v)
    for share, real in ((1.0 - 1e-6, True), (1.0 + 1e-6, False)):
        at = replace(v, thrust=Thrust(share * found.thrust)).natural_frequencies()
        assert np.isrealobj(at) == real
    assert critical_thrust(v, most=0.9 * found.thrust).kind == "none"


@pytest.mark.parametrize("coupling", [1e-1, 1e-3, 1e-5])
def test_a_narrow_pocket_is_found(coupling: float) -> None:
    """Two frequencies that pass each other and flutter while they do, between T of 1 -+ 2c."""
    pull = np.array([[1.0, coupling], [-coupling, 0.0]])
    nothing = np.zeros((2, 2))
    mean = Mean(np.diag([1.0, 2.0]), nothing, pull, nothing, None, 0.0)
    found, gap = _first(mean, 8e-5, 80.0, 1e-6)
    # (1 - T)^2 = 4 c^2 T^2
    assert found == pytest.approx(1.0 / (1.0 + 2.0 * coupling), rel=1e-6)
    assert gap < 1e-4
    assert mean.grows(1.0) > 0.0
    assert not mean.unstable(1.0 / (1.0 - 2.0 * coupling) + 1e-9)


def test_what_is_narrower_is_said() -> None:
    """A pocket of 4e-9 is not seen, and the gap that is told of is as wide."""
    pull = np.array([[1.0, 1e-9], [-1e-9, 0.0]])
    nothing = np.zeros((2, 2))
    mean = Mean(np.diag([1.0, 2.0]), nothing, pull, nothing, None, 0.0)
    found, gap = _first(mean, 2e-6, 2.0, 1e-6)
    assert found is None or found == pytest.approx(1.0, abs=1e-8)
    assert 4e-9 < gap < 1e-4


def test_a_rotation_that_only_its_damping_slows() -> None:
    """It stays where it is: neither safe nor unsafe, as without damping."""
    for ends in (("pinned", "free"), ("free", "free")):
        v = replace(FREE, ends=ends, damping=Damping(eta=1e-3))
        plain = critical_thrust(replace(v, damping=Damping()))
        assert critical_thrust(v).thrust == pytest.approx(plain.thrust, rel=2e-3)


@pytest.mark.parametrize("seed", range(12))
def test_every_thrust_below_is_safe(seed: int) -> None:
    """By the eigenvalues at many thrusts, chosen without the search's own."""
    v = random_vehicle(seed, control=True)
    found = critical_thrust(v)
    known = structure(v)
    mean = Mean.of(v, known, 1.0)
    most = min(found.thrust, found.searched) / known.modes.mesh.scales.force
    rng = np.random.default_rng(seed)
    for share in rng.uniform(1e-5, 1.0 - 1e-6, 300):
        assert not mean.unstable(share * most)
    assert found.resolution <= 1e-4 * max(found.thrust, 1e-2 * found.searched)


@pytest.mark.parametrize("seed", range(20))
def test_eigenvalues_stay_where_the_discs_say(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    A = rng.normal(size=(n, n)) - 2.0 * np.sqrt(n) * np.eye(n)
    B = rng.normal(size=(n, n)) * np.exp(rng.normal(size=(n, n)))
    h = Moved.of(A, B).stays_left(1.0)
    assert h > 0.0
    for d in h * rng.uniform(-1.0, 1.0, 100):
        assert np.linalg.eigvals(A + d * B).real.max() < 0.0
    # and not by much less than it might be
    assert any(np.linalg.eigvals(A + d * B).real.max() > 0.0 for d in (-200 * h, 200 * h))
    spectrum = np.sort(rng.uniform(0.1, 1.0, n)).cumsum()
    V = rng.normal(size=(n, n)) + 2.0 * np.eye(n)
    K = V @ np.diag(spectrum) @ np.linalg.inv(V)
    h = Moved.of(K, B).stays_positive(1e-2)
    assert h > 0.0
    for d in h * rng.uniform(-1.0, 1.0, 100):
        values = np.linalg.eigvals(K + d * B)
        assert np.all(values.imag == 0.0)
        assert values.real.min() > 0.0
    assert Moved.of(-A, B).stays_left(1.0) == 0.0
    assert Moved.of(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(2)).stays_positive(1.0) == 0.0


def test_laws() -> None:
    """An exact power law is continued exactly; what is no law has a large error."""
    modes = np.arange(4.0, 15.0, 2.0)
    for power in (1, 3):
        value, error = extrapolated(modes, 7.0 + 2.0 * modes**-power)
        assert value == pytest.approx(7.0, abs=1e-12)
        assert error >= 2.0 * 14.0**-power
    _, error = extrapolated(modes, np.array([1.0, 3.0, 2.0, 3.0, 1.0, 2.0]))
    assert error > 0.5
    assert math.isnan(extrapolated(modes, np.array([1.0, 2.0, 3.0, 4.0, math.inf, 5.0]))[0])


def test_what_cannot_have_more_modes() -> None:
    with pytest.raises(ValueError, match=r"damping\.matrix: fixes"):
        limit(replace(FREE, damping=Damping(matrix=np.eye(3))))
    for modes in ((2, 4, 6), (2, 4, 4, 6), (6, 4, 2, 1)):
        with pytest.raises(ValueError, match="four numbers or more, ascending"):
            limit(FREE, *modes)
    with pytest.raises(ValueError, match="modes = 0"):
        limit(FREE, 0, 2, 4, 6)
    for name in ("least", "resolution"):
        with pytest.raises(ValueError, match=f"{name} = -1"):
            critical_thrust(FREE, **{name: -1.0})
    with pytest.raises(ValueError, match="most = -1"):
        critical_thrust(FREE, most=-1.0)
