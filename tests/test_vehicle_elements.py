"""The witness's vehicle against closed forms and other people's numbers; none of hill's modes."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import cos, cosh, inf, pi, sin, sinh, sqrt, tanh
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.linalg import eigh
from scipy.optimize import brentq, fsolve

from floquet import monodromy
from floquet.vehicle import discretise as module
from floquet.vehicle.axial import bar
from floquet.vehicle.bending import modes
from floquet.vehicle.discretise import discretise, discretised, rougher
from floquet.vehicle.mesh import mesh
from floquet.weak_form import galerkin
from hill import (
    Damping,
    HillEquation,
    LongitudinalResonance,
    PeriodicEquation,
    PointMass,
    Section,
    Sensor,
    Thrust,
    UniformBeam,
    Vehicle,
)

pytest.importorskip("skfem")

UNIT = Section(length=1.0, mass_per_length=1.0, EI=1.0)
# lambda_1^2 of the free beam, the report's unit of frequency
OMEGA_1 = 4.7300407448627040**2


def squares(vehicle: Vehicle, order: int = 12) -> Any:
    """omega^2 in the vehicle's units."""
    cut = mesh(vehicle)
    return modes(vehicle, cut, order).square / cut.scales.time**2


# ---- frequencies ---------------------------------------------------------------------------------

# each function is written to be bounded; its roots lie beside (n + shift) pi
TEXTBOOK: dict[tuple[str, str], tuple[Callable[[float], float], float]] = {
    ("free", "free"): (lambda z: cos(z) - 1.0 / cosh(z), 1.5),
    ("clamped", "clamped"): (lambda z: cos(z) - 1.0 / cosh(z), 1.5),
    ("clamped", "free"): (lambda z: cos(z) + 1.0 / cosh(z), 0.5),
    ("free", "clamped"): (lambda z: cos(z) + 1.0 / cosh(z), 0.5),
    ("clamped", "pinned"): (lambda z: sin(z) - cos(z) * tanh(z), 1.25),
    ("pinned", "free"): (lambda z: sin(z) - cos(z) * tanh(z), 1.25),
    ("free", "pinned"): (lambda z: sin(z) - cos(z) * tanh(z), 1.25),
    ("pinned", "pinned"): (sin, 1.0),
}


@pytest.mark.parametrize("ends", TEXTBOOK, ids="-".join)
def test_uniform_beams_of_the_textbooks(ends: tuple[Any, Any]) -> None:
    function, shift = TEXTBOOK[ends]
    roots = [
        brentq(function, (n + shift - 0.2) * pi, (n + shift + 0.2) * pi, xtol=1e-15)
        for n in range(12)
    ]
    # the same beam in other units: omega^2 goes with EI/(m l^4)
    beam = Section(length=50.0, mass_per_length=3e3, EI=7e9)
    found = squares(Vehicle(sections=(beam,), ends=ends, modes=12))[:12]
    unit = 7e9 / 3e3 / 50.0**4
    np.testing.assert_allclose(found / unit, np.power(roots, 4), rtol=1e-12)


def test_hermite_elements_would_not_do() -> None:
    """200 elements: what the mixed ones' docstring says of both."""
    import skfem

    exact = np.array([4.7300407448627040, 32.98672286269282]) ** 4
    uneven = Vehicle(
        sections=tuple(Section(length=1 / 200, mass_per_length=1.0, EI=1.0) for _ in range(200)),
        modes=10,
    )
    own = np.abs(squares(uneven, 6)[[0, 9]] / exact - 1.0)
    assert np.all(own < 1e-13)
    basis = skfem.Basis(
        skfem.MeshLine(np.linspace(0.0, 1.0, 201)), skfem.ElementLineHermite(), intorder=8
    )
    K = skfem.BilinearForm(lambda u, v, _: u.hess[0][0] * v.hess[0][0]).assemble(basis)
    M = skfem.BilinearForm(lambda u, v, _: u * v).assemble(basis)
    values = eigh(K.toarray(), M.toarray(), eigvals_only=True, subset_by_index=(2, 11))
    assert abs(values[9] / exact[1] - 1.0) > 1e-7


@pytest.mark.parametrize("mass", [0.1, 1.0, 10.0])
def test_a_mass_at_the_tip(mass: float) -> None:
    def function(z: float) -> float:
        return (1 / cosh(z) + cos(z)) + mass * z * (cos(z) * tanh(z) - sin(z))

    grid = np.linspace(0.3, 20.0, 400)
    at = [function(z) for z in grid]
    roots = [
        brentq(function, grid[k], grid[k + 1], xtol=1e-15)
        for k in range(399)
        if at[k] * at[k + 1] < 0
    ][:6]
    v = Vehicle(sections=(UNIT,), ends=("clamped", "free"), masses=(PointMass(1.0, mass),), modes=6)
    np.testing.assert_allclose(squares(v), np.power(roots, 4), rtol=1e-12)


def test_rotary_inertia_at_the_tip() -> None:
    """A rigid disc without mass on a cantilever: tip moment J omega^2 psi."""
    J = 0.3

    def function(z: float) -> float:
        # of y = cosh - cos - s (sinh - sin), with no shear force and M = omega^2 J psi at the tip
        A = np.array(
            [
                [sinh(z) - sin(z), cosh(z) + cos(z)],
                [
                    cosh(z) + cos(z) - J * z**3 * (sinh(z) + sin(z)),
                    sinh(z) + sin(z) - J * z**3 * (cosh(z) - cos(z)),
                ],
            ]
        )
        return float(np.linalg.det(A)) / cosh(z) ** 2

    grid = np.linspace(0.3, 15.0, 600)
    at = [function(z) for z in grid]
    roots = [
        brentq(function, grid[k], grid[k + 1], xtol=1e-15)
        for k in range(599)
        if at[k] * at[k + 1] < 0
    ][:4]
    v = Vehicle(
        sections=(UNIT,),
        ends=("clamped", "free"),
        masses=(PointMass(1.0, 0.0, rotary_inertia=J),),
        modes=4,
    )
    np.testing.assert_allclose(squares(v), np.power(roots, 4), rtol=1e-11)


@pytest.mark.parametrize("kGA", [30.0, 1e4, inf])
@pytest.mark.parametrize("inertia", [0.0, 0.003])
def test_timoshenko_between_pins(kGA: float, inertia: float) -> None:
    """y = sin n pi x, psi its cosine: two equations for omega^2."""
    section = Section(length=1.0, mass_per_length=1.0, EI=1.0, rotary_inertia=inertia, kGA=kGA)
    expected: list[float] = []
    for n in range(1, 40):
        k = n * pi
        if kGA == inf:
            expected.append(k**4 / (1.0 + inertia * k**2))
            continue
        # (kGA k^2 - w) y = kGA k psi, (k^2 + kGA - inertia w) psi = kGA k y
        b = inertia * kGA * k**2 + k**2 + kGA
        c = kGA * k**4
        expected.append(2.0 * c / (b + sqrt(b**2 - 4.0 * inertia * c)))
        if inertia:
            expected.append((b + sqrt(b**2 - 4.0 * inertia * c)) / (2.0 * inertia))
    if inertia and kGA < inf:
        expected.append(kGA / inertia)  # pure rotation, all alike
    found = squares(Vehicle(sections=(section,), ends=("pinned", "pinned"), modes=5))
    np.testing.assert_allclose(found, sorted(expected)[:5], rtol=1e-11)


def test_a_taper_by_another_method() -> None:
    """Ritz's method with Legendre polynomials, free-free, everything linear along one section."""
    m, EI, r = (1.0, 3.0), (2.0, 0.5), (0.01, 0.002)
    count = 26
    node, weight = legendre.leggauss(60)
    t = 0.5 * (1.0 + node)
    functions = np.eye(count)
    value = legendre.legval(node, functions.T)
    first = 2.0 * legendre.legval(node, legendre.legder(functions.T))
    second = 4.0 * legendre.legval(node, legendre.legder(functions.T, 2))

    def inner(f: Any, ends: tuple[float, float]) -> Any:
        return (f * 0.5 * weight * (ends[0] + (ends[1] - ends[0]) * t)) @ f.T

    M = inner(value, m) + inner(first, r)
    expected = eigh(inner(second, EI), M, eigvals_only=True)[2:7]
    section = Section(length=1.0, mass_per_length=m, EI=EI, rotary_inertia=r)
    found = squares(Vehicle(sections=(section,), modes=5))[:5]
    np.testing.assert_allclose(found, expected, rtol=1e-10)


def test_a_section_cut_in_many_is_the_same() -> None:
    whole = Vehicle(
        sections=(Section(length=3.0, mass_per_length=(1.0, 2.0), EI=(4.0, 1.0)),), modes=6
    )
    edges = np.linspace(0.0, 1.0, 8)
    parts = tuple(
        Section(
            length=3.0 * (b - a),
            mass_per_length=(1.0 + a, 1.0 + b),
            EI=(4.0 - 3.0 * a, 4.0 - 3.0 * b),
        )
        for a, b in pairwise(edges)
    )
    np.testing.assert_allclose(
        squares(Vehicle(sections=parts, modes=6)), squares(whole), rtol=1e-12, atol=1e-12
    )


# ---- the axial force -----------------------------------------------------------------------------

ELASTIC = Section(length=2.0, mass_per_length=3.0, EI=5.0, EA=7.0)


def force(vehicle: Vehicle, square: complex) -> tuple[Any, Any]:
    """Stations over the length and P there; `square` is omega^2 in the vehicle's units."""
    cut = mesh(vehicle)
    return np.ravel(cut.x), bar(vehicle, cut, 10).force(square * cut.scales.time**2)


@pytest.mark.parametrize("sigma", [0.0, 0.4, 1.37, 3.2])
@pytest.mark.parametrize("g", [0.0, 0.3])
def test_the_force_in_a_uniform_bar(sigma: float, g: float) -> None:
    omega_L = pi / 2.0 * sqrt(7.0 / 3.0)
    z = pi * np.sqrt(complex(sigma**2, -g))
    square = omega_L**2 * complex(sigma**2, -g)
    x, P = force(Vehicle(sections=(ELASTIC,)), square)
    expected = np.sin(z * x) / np.sin(z) if z else x
    np.testing.assert_allclose(P, expected, atol=1e-12 * np.max(np.abs(expected)))
    x, P = force(Vehicle(sections=(ELASTIC,), ends=("clamped", "free")), square)
    expected = np.cos(z * x) / np.cos(z)
    np.testing.assert_allclose(P, expected, atol=1e-12 * np.max(np.abs(expected)))


@pytest.mark.parametrize("refinements", [0, 2])
def test_a_force_between_held_ends_is_constant(refinements: int) -> None:
    """To rounding, whatever the elements' lengths: a matrix has it to EPS over the least."""
    v = Vehicle(
        sections=(
            Section(0.6, 1.0, 1.0),
            Section(3e-4, 7.0, 5.0),
            Section(0.3, (0.2, 0.5), 1.0),
            Section(1e-3, 20.0, 0.3),
        ),
        ends=("clamped", "pinned"),
        masses=(PointMass(0.2, 0.1),),
    )
    force = bar(v, mesh(v, refinements), 10).force(0.0)
    assert np.max(np.abs(force - 1.0)) <= 8.0 * np.finfo(float).eps


def test_the_lowest_axial_frequency() -> None:
    for ends, phase in ((("free", "free"), pi), (("free", "pinned"), 0.5 * pi)):
        v = Vehicle(sections=(ELASTIC,), ends=ends)
        cut = mesh(v)
        expected = (phase / 2.0) ** 2 * 7.0 / 3.0 * cut.scales.time**2
        assert bar(v, cut, 10).lowest == pytest.approx(expected, rel=1e-12)
    # two rigid halves and a spring between them: omega^2 = 2 k/m of each
    half = Section(length=1.0, mass_per_length=3.0, EI=5.0)
    spring = Section(length=1e-6, mass_per_length=3.0, EI=5.0, EA=7e-6)
    v = Vehicle(sections=(half, spring, half))
    cut = mesh(v)
    assert bar(v, cut, 10).lowest == pytest.approx(2.0 * 7.0 / 3.0 * cut.scales.time**2, rel=2e-6)
    rigid = Vehicle(sections=(UNIT,))
    assert bar(rigid, mesh(rigid), 10).lowest == inf


def test_masses_take_their_share_of_the_thrust() -> None:
    v = Vehicle(
        sections=(ELASTIC,),
        masses=(PointMass(0.0, 2.0), PointMass(1.0, 3.0), PointMass(2.0, 5.0)),
        thrust=Thrust(1.0, station=1.5),
    )
    x, P = force(v, 0.0)
    mass = 2.0 + 6.0 * x + np.where(x > 0.5, 3.0, 0.0)
    np.testing.assert_allclose(P, mass / 16.0 - (x > 0.75), atol=1e-13)


@pytest.mark.parametrize("ends", [("clamped", "free"), ("free", "pinned"), ("clamped", "pinned")])
@pytest.mark.parametrize("square", [0.0, 5.0])
def test_a_mass_at_a_held_end_changes_nothing(ends: Any, square: float) -> None:
    """Where both are held the nose is, and the aft end slides."""
    station = 2.0 if ends == ("free", "pinned") else 0.0
    bare = Vehicle(sections=(ELASTIC,), ends=ends, thrust=Thrust(1.0, 1.5))
    loaded = replace(bare, masses=(PointMass(station, 7.0),))
    np.testing.assert_allclose(force(loaded, square)[1], force(bare, square)[1], atol=1e-13)


def test_two_masses_on_a_rod() -> None:
    """A light rod: P = -k stretch of two masses, pushed at the aft one."""
    rod = Section(length=1.0, mass_per_length=1e-6, EI=1.0, EA=50.0)
    v = Vehicle(sections=(rod,), masses=(PointMass(0.0, 2.0), PointMass(1.0, 3.0)))
    for square in (0.0, 10.0, 55.0):
        # relative motion: mu u'' + k u = share of the thrust, mu = 6/5, k = 50
        expected = 50.0 * (2.0 / 5.0) / (50.0 - 1.2 * square)
        _, P = force(v, square)
        np.testing.assert_allclose(P, expected, rtol=1e-5)


def test_a_rigid_stage_is_the_limit_of_a_stiff_one() -> None:
    def ahead(EA: float) -> Any:
        stiff = Section(length=1.0, mass_per_length=3.0, EI=5.0, EA=EA)
        return force(Vehicle(sections=(stiff, ELASTIC)), 3.0)[1]

    np.testing.assert_allclose(ahead(1e10), ahead(inf), atol=1e-7)


@pytest.mark.parametrize(
    ("ends", "station", "expected"),
    [
        (("clamped", "free"), 2.0, lambda x: 1.0 + 0.0 * x),
        (("clamped", "free"), 1.0, lambda x: 1.0 * (x < 0.5)),
        (("free", "pinned"), 1.0, lambda x: -1.0 * (x > 0.5)),
        (("pinned", "pinned"), 1.0, lambda x: 1.0 * (x < 0.5)),
    ],
)
def test_a_held_end_takes_the_thrust(ends: Any, station: float, expected: Any) -> None:
    x, P = force(Vehicle(sections=(ELASTIC,), ends=ends, thrust=Thrust(1.0, station)), 0.0)
    np.testing.assert_allclose(P, expected(x), atol=1e-13)


def test_an_undamped_resonance_is_refused() -> None:
    omega_L = pi / 2.0 * sqrt(7.0 / 3.0)
    v = Vehicle(sections=(ELASTIC,), thrust=Thrust(1.0))
    with pytest.raises(LongitudinalResonance, match="infinite"):
        discretised(v, omega_L, 0.1)


# ---- the equation --------------------------------------------------------------------------------


def beam(T0: float = 20.0, K: float = 0.5, xi: float = 0.5, **others: Any) -> Vehicle:
    EA = others.pop("EA", inf)
    section = Section(length=1.0, mass_per_length=1.0, EI=1.0, EA=EA)
    return Vehicle(sections=(section,), thrust=Thrust(T0), sensors=(Sensor(xi, K),), **others)


@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize(("omega_L", "g"), [(inf, 0.0), (2.3, 0.0), (2.3, 0.1)])
def test_the_reports_beam(n: int, omega_L: float, g: float) -> None:
    """P of the uniform beam by quadrature of its weak form, whose modes are in closed form."""
    EA = (omega_L * OMEGA_1 / pi) ** 2
    v = beam(xi=0.3, modes=n, EA=EA, g=g, quadrature_force=False)
    own = monodromy(discretised(v, 1.2 * OMEGA_1, 0.3, 0.01 * OMEGA_1))
    same = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.3, omega_L=omega_L, g=g, modes=n)
    other = monodromy(galerkin(same, 1.2, 0.3, 0.01))
    assert np.max(np.abs(own.polynomial - other.polynomial)) <= own.error + other.error
    assert abs(own.T / OMEGA_1 - other.T) < 1e-11


def critical(make: Callable[[float], Vehicle], low: float, high: float) -> float:
    """The thrust at which a frequency ceases to be real."""

    def unstable(T0: float) -> bool:
        equation = discretised(make(T0), 1.0, 0.0)
        assert isinstance(equation, HillEquation)
        w = np.linalg.eigvals(equation.F)
        return bool(np.max(np.abs(w.imag)) > 1e-9 * np.max(np.abs(w)) or w.real.min() < -1e-6)

    assert unstable(high)
    assert not unstable(low)
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return low


def column(T0: float, tip: float = 0.0, **others: Any) -> Vehicle:
    masses = (PointMass(1.0, tip),) if tip else ()
    return Vehicle(
        sections=(UNIT,), ends=("clamped", "free"), thrust=Thrust(T0), masses=masses, **others
    )


def flutter(tip: float, near: tuple[float, float]) -> float:
    """Where two omega^2 of the column meet: its determinant and its slope are zero.

    y'''' + p y'' = omega^2 y; clamped at 0, y'' = 0 and y''' + tip omega^2 y = 0 at 1.
    """

    def determinant(square: float, p: float) -> float:
        root = sqrt(0.25 * p * p + square)
        a, b = sqrt(root - 0.5 * p), sqrt(root + 0.5 * p)
        moment = (a * a * cosh(a) + b * b * cos(b), a * a * sinh(a) + a * b * sin(b))
        shear = (
            a**3 * sinh(a) - b**3 * sin(b) + tip * square * (cosh(a) - cos(b)),
            a**3 * cosh(a) + a * b * b * cos(b) + tip * square * (sinh(a) - a / b * sin(b)),
        )
        return moment[0] * shear[1] - moment[1] * shear[0]

    def both(x: Any) -> list[float]:
        h = 1e-4 * x[0]
        slope = (determinant(x[0] + h, x[1]) - determinant(x[0] - h, x[1])) / (2.0 * h)
        return [determinant(*x), slope]

    return float(fsolve(both, near, xtol=1e-12)[1])


@pytest.mark.parametrize(
    ("tip", "near"), [(0.0, (121.0, 20.0)), (0.2, (70.0, 18.0)), (1.0, (60.0, 16.0))]
)
def test_the_columns_of_beck_and_pflueger(tip: float, near: tuple[float, float]) -> None:
    expected = flutter(tip, near)
    if not tip:
        assert expected == pytest.approx(20.05, abs=5e-3)  # Beck 1952
    # modes of the unloaded column: 14 of them leave 1e-4
    assert critical(lambda T0: column(T0, tip, modes=14), 10.0, 30.0) == pytest.approx(
        expected, abs=2e-4
    )


def test_eulers_columns() -> None:
    def fixed(T0: float) -> Vehicle:
        return Vehicle(
            sections=(UNIT,),
            ends=("pinned", "pinned"),
            thrust=Thrust(T0, direction="fixed"),
            modes=4,
        )

    assert critical(fixed, 5.0, 15.0) == pytest.approx(pi**2, abs=1e-5)


@pytest.mark.parametrize(
    ("n", "expected"), [(2, 116.097), (3, 109.984), (4, 109.967), (6, 109.782), (8, 109.722)]
)
def test_beals_free_beam_flutters(n: int, expected: float) -> None:
    found = critical(lambda T0: beam(T0, K=0.0, modes=n), 50.0, 130.0)
    assert found == pytest.approx(expected, abs=6e-4)


def test_inertial_buckling_of_the_controlled_beam() -> None:
    """(3/2 j_(2/3,1))^2 = 25.638 in the limit of many modes."""
    found = critical(lambda T0: beam(T0, modes=20), 10.0, 40.0)
    assert 25.638 < found < 25.642


def test_a_hinged_beam_under_half_eulers_load() -> None:
    """NASTRAN's demonstration problem 13-1-1, in Hz, to the digits of its print."""
    EI = 1.04e7 * 0.666667
    section = Section(length=100.0, mass_per_length=2.0 * 0.0002, EI=EI)
    v = Vehicle(
        sections=(section,),
        ends=("pinned", "pinned"),
        thrust=Thrust(3423.17, direction="fixed"),
        modes=4,
    )
    equation = discretised(v, 1.0, 0.0)
    assert isinstance(equation, HillEquation)
    Hz = np.sort(np.sqrt(np.linalg.eigvals(equation.F).real))[:3] / (2.0 * pi)
    np.testing.assert_allclose(Hz, [14.61968, 77.37659, 180.8778], rtol=1e-6)


# ---- what kind of equation -----------------------------------------------------------------------


def test_the_kinds_of_equation() -> None:
    assert isinstance(discretised(beam(), 10.0, 0.1, 0.2), HillEquation)
    rate = beam(modes=2)
    rated = Vehicle(
        sections=rate.sections,
        thrust=rate.thrust,
        sensors=(Sensor(0.5, 0.5, K_rate=0.01),),
        modes=2,
    )
    equation = discretised(rated, 10.0, 0.1)
    assert isinstance(equation, PeriodicEquation)
    assert equation.C is not None
    assert equation.K is not None
    # the damping pulsates with the thrust
    np.testing.assert_allclose(equation.C.cos[1], 0.1 * equation.C.mean, rtol=1e-12)
    damped = discretised(beam(damping=Damping(0.01)), 10.0, 0.1)
    assert isinstance(damped, PeriodicEquation)
    assert damped.C is not None
    # 2 zeta omega of the unloaded modes, nothing of the rotation
    expected = 0.02 * OMEGA_1
    assert damped.C.mean[0, 0] == pytest.approx(expected, rel=1e-12)
    assert damped.C.mean[-1, -1] == 0.0
    sine = discretised(beam(EA=5e3, g=0.2), 40.0, 0.1)
    assert isinstance(sine, PeriodicEquation)
    assert sine.K is not None
    assert np.max(np.abs(sine.K.sin[1])) > 0.0


def test_a_fast_servo_is_none() -> None:
    """And its angle is a coordinate of its own."""
    slow = discretised(beam(modes=2, servo_time=1e-9), 10.0, 0.0)
    assert isinstance(slow, PeriodicEquation)
    assert slow.A is not None
    assert slow.order == 7
    fast = discretised(beam(modes=2), 10.0, 0.0)
    assert isinstance(fast, HillEquation)
    exponents = np.linalg.eigvals(slow.A.mean)
    found = np.sort(np.abs(exponents.imag[np.abs(exponents) < 1e6]))
    w = np.sort(np.sqrt(np.linalg.eigvals(fast.F).real))
    np.testing.assert_allclose(found, np.repeat(w, 2), rtol=1e-6)


def test_a_damping_matrix_is_in_the_modes_coordinates() -> None:
    """Off the diagonal it matters which way the shapes point: the aft end is positive."""
    for ends in (("free", "free"), ("clamped", "free"), ("free", "pinned"), ("free", "clamped")):
        v = Vehicle(sections=(UNIT,), ends=ends, modes=3)
        cut = mesh(v)
        found = modes(v, cut, 10)
        if ends[1] == "free":
            aft = found.y_node[:, -1]
        elif ends[1] == "pinned":
            aft = found.rotation_node[:, -1]
        else:
            aft = found.y[:, -1]
        assert np.all(aft > 0.0)
    matrix = np.arange(9.0).reshape(3, 3)
    v = Vehicle(sections=(UNIT,), ends=("clamped", "free"), modes=3, damping=Damping(matrix=matrix))
    equation = discretised(v, 10.0, 0.1)
    assert isinstance(equation, PeriodicEquation)
    assert equation.C is not None
    np.testing.assert_allclose(equation.C.mean, matrix, rtol=1e-12)


# ---- how well it is known ------------------------------------------------------------------------


@pytest.mark.parametrize("orders", [(4, 5), (4, 6), (5, 7)])
def test_the_estimate_covers_the_error(
    orders: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Elements too poor for the task: what is said of F, and how far it is off."""
    monkeypatch.setattr(module, "ORDERS", orders)
    monkeypatch.setattr(module, "MAX_REFINEMENTS", 0)
    v = beam(0.0, modes=8)
    found = discretise(v, 10.0, 0.0)
    assert isinstance(found.best, HillEquation)
    exact = (np.arange(1, 9) + 0.5) * pi
    exact[0] = 4.7300407448627040
    exact[1] = 7.8532046240958376
    exact[2] = 10.995607838001671
    true = np.max(np.abs(np.diag(found.best.F)[:8] - exact**4)) / exact[-1] ** 4
    assert 1e-12 < true <= found.best.data_error


def test_refinement_goes_on_until_it_is_good_enough() -> None:
    v = beam(modes=6)
    for tolerance in (1e-4, 1e-11):
        assert discretise(v, 30.0, 0.2, tolerance=tolerance).best.data_error <= 2 * tolerance
    # waves of the force far shorter than those of bending
    fast = beam(modes=2, EA=50.0)
    assert discretise(fast, 700.0, 0.2).best.data_error <= 1e-9


def test_the_rougher_one_is_rougher() -> None:
    v = beam(modes=3)
    better, worse = discretised(v, 30.0, 0.2), rougher(v, 30.0, 0.2)
    assert isinstance(better, HillEquation)
    assert isinstance(worse, HillEquation)
    scale = np.max(np.abs(better.F))
    apart = np.max(np.abs(better.F - worse.F)) / scale
    assert 0.0 < apart <= better.data_error


def test_modes_of_almost_one_frequency_may_mix() -> None:
    """Two beams, joined by next to nothing: each pair of modes is found in any mixture."""
    soft = Section(length=0.02, mass_per_length=1e-3, EI=1e-7)
    v = Vehicle(
        sections=(UNIT, soft, UNIT), thrust=Thrust(1.0), sensors=(Sensor(0.3, 0.1),), modes=8
    )
    assert discretise(v, 30.0, 0.2).best.data_error < 1e-8


def test_without_scikit_fem_one_line_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    with pytest.raises(ValueError, match=r"pip install 'floquet-crosscheck\[vehicle\]'") as caught:
        discretised(beam(), 1.0, 0.1)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("forcing", "message"),
    [
        ((-1.0, 0.1, 0.0), "Omega = -1: must be greater than 0"),
        ((1.0, float("nan"), 0.0), "gamma = nan: must be finite"),
        ((1.0, 0.1, "no"), "eta = 'no': must be a real number"),
    ],
)
def test_a_forcing_that_is_none(forcing: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        discretised(beam(), *forcing)
