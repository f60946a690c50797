"""Exact modes of a vehicle: textbooks' digits, closed forms, and none missed on random ones."""

import math
import time
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy import cos, cosh, sin, sinh, tanh
from scipy.linalg import eigh
from scipy.optimize import brentq
from vehicles import finite_elements, random_vehicle

from benchmarks.validation.beams import TEXTBOOK
from hill import PointMass, Refused, Section, Vehicle
from hill.vehicle.mesh import mesh
from hill.vehicle.modes import Modes, modes, rigid_motions
from hill.vehicle.series import Series, series
from hill.vehicle.stiffness import grouped
from hill.vehicle.vehicle import End

ONE = Section(2.0, 3.0, 5.0)


def wavenumbers(found: Modes) -> np.ndarray:
    """lambda l of the fourth root, as textbooks tabulate it, of a uniform vehicle."""
    return found.lam**0.25


@pytest.mark.parametrize("ends", TEXTBOOK)
@pytest.mark.parametrize("turned", [False, True])
def test_textbook_frequencies(ends: tuple[End, End], turned: bool) -> None:
    v = Vehicle(sections=(ONE,), ends=ends[::-1] if turned else ends)
    for found, printed in zip(wavenumbers(modes(v, 5)), TEXTBOOK[ends], strict=True):
        digits = len(printed.split(".")[1])
        assert abs(found - float(printed)) <= 0.5001 * 10.0**-digits + 1e-8 * (digits == 7)


CHARACTERISTIC: dict[tuple[End, End], tuple[Callable[[float], float], float]] = {
    ("free", "free"): (lambda x: cos(x) - 1 / cosh(x), 1.5),
    ("clamped", "free"): (lambda x: cos(x) + 1 / cosh(x), 0.5),
    ("pinned", "free"): (lambda x: sin(x) - tanh(x) * cos(x), 1.25),
    ("pinned", "pinned"): (sin, 1.0),
}


@pytest.mark.parametrize("ends", CHARACTERISTIC)
def test_closed_forms_to_rounding(ends: tuple[End, End]) -> None:
    """A dozen modes, however the beam is cut into sections."""
    f, first = CHARACTERISTIC[ends]
    guess = (np.arange(12) + first) * math.pi
    expected = [brentq(f, x - 0.4, x + 0.4, xtol=1e-15, rtol=1e-15) for x in guess]
    for pieces in ((2.0,), (0.3, 0.5, 1.2), (1e-3,) * 10 + (1.99,)):
        v = Vehicle(sections=tuple(Section(x, 3.0, 5.0) for x in pieces), ends=ends)
        found = modes(v, 12)
        assert np.abs(wavenumbers(found) / expected - 1.0).max() < 1e-14
        assert found.defect < 1e-12


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
def test_a_mass_at_the_tip(ratio: float) -> None:
    """1 + cos x cosh x + ratio x (cos x sinh x - sin x cosh x) = 0."""

    def f(x: float) -> float:
        return 1 / cosh(x) + cos(x) + ratio * x * (cos(x) * sinh(x) - sin(x) * cosh(x)) / cosh(x)

    grid = np.linspace(0.1, 20.0, 2000)
    expected = [brentq(f, a, b, xtol=1e-15) for a, b in pairwise(grid) if f(a) * f(b) < 0]
    v = Vehicle(sections=(ONE,), masses=(PointMass(2.0, ratio * 6.0),), ends=("clamped", "free"))
    # lambda is over the whole mass
    found = wavenumbers(modes(v, 5)) / (1.0 + ratio) ** 0.25
    assert found == pytest.approx(expected[:5], rel=1e-13)


def test_shear_and_rotary_inertia() -> None:
    """Pinned ends: y sin k x, psi cos k x with k = n pi/l, two frequencies each, and psi alone."""
    length, m, EI, r, kGA = 2.0, 3.0, 5.0, 0.4, 60.0
    squares = [kGA / r]
    for n in range(1, 30):
        k = n * math.pi / length
        K = [[kGA * k**2, -kGA * k], [-kGA * k, EI * k**2 + kGA]]
        squares += list(eigh(K, [[m, 0.0], [0.0, r]], eigvals_only=True))
    section = Section(length, m, EI, rotary_inertia=r, kGA=kGA)
    v = Vehicle(sections=(section,), ends=("pinned", "pinned"))
    found = modes(v, 20)
    # both spectra, and the uniform shear between them, are among the first twenty
    assert sorted(squares)[19] > squares[0]
    assert found.lam / found.mesh.scales.time**2 == pytest.approx(sorted(squares)[:20], rel=1e-12)
    assert found.defect < 1e-12


def assert_like_elements(v: Vehicle, found: Modes, within: float, cuts: int = 60) -> None:
    """Elements are stiffer by their truncation, and off by the rounding of their largest square."""
    M, K = finite_elements(v, cuts)
    rigid = rigid_motions(v.ends)
    squares = eigh(K, M, eigvals_only=True)
    rounding = 8.0 * np.finfo(float).eps * squares[-1]
    expected = squares[rigid : rigid + len(found.lam)]
    assert rounding < 0.1 * expected[0]
    assert found.lam / found.mesh.scales.time**2 == pytest.approx(
        expected, rel=within, abs=rounding
    )


@pytest.mark.parametrize("first", range(0, 200, 25))
def test_none_is_missed(first: int) -> None:
    """The six lowest of 200 random vehicles are a fine finite-element matrix's, one by one."""
    for seed in range(first, first + 25):
        v = random_vehicle(seed)
        found = modes(v, 6)
        assert_like_elements(v, found, 2e-4)
        assert found.defect < 1e-10, seed


def test_wild_vehicles() -> None:
    """Stiffnesses and masses that change by thousands from section to section."""
    for seed in (0, 133, 194, 216, 245):
        v = random_vehicle(seed, wild=3.0)
        found = modes(v, 6)
        assert found.defect < 1e-9, seed
        assert_like_elements(v, found, 2e-3)


@pytest.mark.parametrize("heavy", [1e2, 1e4, 1e6, 1e8, 1e10])
def test_frequencies_that_nearly_meet(heavy: float) -> None:
    """Two clamped halves and a heavy mass between them: each frequency of a half nearly twice."""
    half = Section(1.0, 1.0, 1.0)
    v = Vehicle(
        sections=(half, half), masses=(PointMass(1.0, heavy, heavy),), ends=("clamped", "clamped")
    )
    found = modes(v, 6)
    squares = found.lam / found.mesh.scales.time**2
    # the mass on two clamped beams, moving (2 x 12 EI/l^3) and turning (2 x 4 EI/l); their own mass
    # adds 13/35 and 1/105 each
    assert squares[:2] == pytest.approx(
        [8.0 / (heavy + 2.0 / 105.0), 24.0 / (heavy + 26.0 / 35.0)],
        rel=1e-2 if heavy < 1e3 else 1e-4,
    )
    assert squares[2:] == pytest.approx(
        np.repeat([4.73004074486, 7.85320462410], 2) ** 4, rel=20.0 / heavy + 1e-9
    )
    assert np.all(np.diff(squares) >= 0.0)
    assert found.defect < 1e-6


def test_a_soft_joint() -> None:
    """A short stretch as soft as 1e-8: a hinge, EI/h = 1e-4, that does not shear, EI/h^3 = 1e4."""
    half = Section(1.0, 1.0, 1.0)
    v = Vehicle(sections=(half, Section(1e-4, 1.0, 1e-8), half), ends=("clamped", "clamped"))
    found = modes(v, 6)
    squares = found.lam / found.mesh.scales.time**2
    # with a hinge in the middle: clamped and free to move without turning it bends like two
    # cantilevers; clamped and pinned where it does not move
    assert squares[0::2] == pytest.approx(
        np.array([1.87510407, 4.69409113, 7.85475744]) ** 4, rel=1e-2
    )
    assert squares[1::2] == pytest.approx(
        np.array([3.92660231, 7.06858275, 10.21017612]) ** 4, rel=1e-2
    )
    assert found.defect < 1e-8


def test_orthonormal_by_other_means() -> None:
    """Mass and stiffness of the shapes, by a rule of the test's own, in the vehicle's units."""
    node, weight = np.polynomial.legendre.leggauss(8)
    for seed in (3, 8, 21):
        v = random_vehicle(seed)
        found = modes(v, 5)
        unit = found.mesh.scales
        n = len(found.shapes)
        mass, stiffness = np.zeros((n, n)), np.zeros((n, n))
        for start, section in zip(v.edges, v.sections, strict=False):
            # a rigid mass leaves a kink
            kinks = [p.station - start for p in v.masses if 0 < p.station - start < section.length]
            for a, b in pairwise(np.unique([*np.linspace(0.0, section.length, 50), *kinks])):
                for x, w in zip(
                    0.5 * (a + b) + 0.5 * (b - a) * node, 0.5 * (b - a) * weight, strict=True
                ):
                    y, psi, Q, M = found.shapes.at((start + x) / v.length).T
                    m, r, EI, kGA = (
                        p[0] + (p[1] - p[0]) * x / section.length if p[0] != p[1] else p[0]
                        for p in (
                            section.mass_per_length,
                            section.rotary_inertia,
                            section.EI,
                            section.kGA,
                        )
                    )
                    mass += w * (m * np.outer(y, y) + r * np.outer(psi, psi) / v.length**2)
                    stiffness += w * (
                        np.outer(M, M) * unit.EI / EI / v.length
                        + np.outer(Q, Q) * unit.EI / v.length**3 / kGA
                    )
        for p in v.masses:
            y, psi = found.shapes.at(p.station / v.length).T[:2]
            mass += p.mass * np.outer(y, y) + p.rotary_inertia * np.outer(psi, psi) / v.length**2
        assert mass / unit.mass == pytest.approx(np.eye(n), abs=1e-10)
        energy = stiffness[:5, :5] / (unit.EI / unit.EI)
        size = np.sqrt(np.outer(found.lam, found.lam))
        assert energy / size == pytest.approx(np.eye(5) * np.trace(energy / size) / 5, abs=1e-9)


def test_two_hundred_stations_and_twenty_modes() -> None:
    stations = np.linspace(0.0, 4 * math.pi, 201)
    m, EI = 1.0 + 0.3 * np.sin(stations), 1.0 + 0.5 * np.cos(stations / 4)
    v = Vehicle(
        sections=tuple(Section(0.5, (m[k], m[k + 1]), (EI[k], EI[k + 1])) for k in range(200))
    )
    began = time.process_time()
    found = modes(v, 20)
    # 1 s on the machine that this was written on
    assert time.process_time() - began < 10.0
    assert found.defect < 1e-11
    assert_like_elements(v, found, 1e-3, 200)


def test_as_many_modes_as_there_may_be() -> None:
    """Sixty, and fewer of them, which are found together."""
    v = Vehicle(sections=(Section(1.0, 1.0, 1.0),), units="none", modes=60)  # type: ignore[arg-type]
    every = np.sqrt(2.0 * np.pi * v.frequencies())
    # cos x cosh x = 1, beyond the first few (n + 1/2) pi to rounding
    assert every[10:] == pytest.approx((np.arange(11, 61) + 0.5) * np.pi, rel=1e-12)
    few = replace(v, modes=58)
    assert few.frequencies() == pytest.approx(v.frequencies()[:58], rel=1e-14)


def test_too_uneven() -> None:
    v = Vehicle(sections=(Section(1.0, 1.0, (1e-13, 1.0)),))
    with pytest.raises(Refused, match="EI from 1e-13 to 1"):
        modes(v, 2)


def test_a_rotating_beam() -> None:
    """Wright's clamped beam under N = m Om^2 (L^2 - x^2)/2, its printed digits (outside.json)."""
    printed = {
        0: (3.516, 22.035, 61.697),
        1: (3.682, 22.181, 61.842),
        6: (7.360, 26.809, 66.684),
        12: (13.170, 37.603, 79.615),
    }
    length, m, EI = math.sqrt(1000.0), 100.0, 1e8
    v = Vehicle(sections=(Section(length, m, EI),), ends=("clamped", "free"))
    cut = mesh(v, 4e4)
    x, half = cut.nodes[:-1] + cut.half, cut.half
    for speed, expected in printed.items():
        # P = -N over EI/l^2, a quadratic in t = (x - middle)/half
        size = -0.5 * m * speed**2 * length**2 * length**2 / EI
        force = size * np.stack([1.0 - x**2, -2.0 * x * half, -(half**2)], axis=1)
        solutions = series(cut, force)

        def below(lam: float, solutions: Series = solutions) -> int:
            return grouped(solutions, cut, v.ends, lam).below

        for number, omega in enumerate(expected, start=1):
            low, high = ((omega + off) * cut.scales.time for off in (-5.5e-4, 5.5e-4))
            assert (below(low**2), below(high**2)) == (number - 1, number)
