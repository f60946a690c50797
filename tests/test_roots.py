"""Roots from the determinant itself: many coordinates, discs, distances."""

import re
from typing import Any

import numpy as np
import pytest

from floquet import monodromy
from hill import (
    Fourier,
    HillEquation,
    PeriodicEquation,
    RootDistance,
    characteristic,
    root_distance,
)
from hill.determinant.roots import At, Evaluate, apart, discs, improved, symmetrised
from hill.multipliers import in_discs, newton_polygon, polynomial_roots
from hill.stability import stability_in_discs

EPS = float(np.finfo(float).eps)


def many(n: int, eta: Any = 0.0) -> HillEquation:
    """Frequencies from 1 to 3, pulsating with 2: sums and differences meet all over."""
    w = np.linspace(1.0, 3.0, n)
    return HillEquation(np.diag(w**2), np.diag(0.3 * w**2), 0.3, 2.0, eta)


def mixed(n: int, seed: int) -> tuple[HillEquation, HillEquation]:
    """Coordinates that know nothing of each other, and the same in a turned frame."""
    rng = np.random.default_rng(seed)
    w, g = rng.uniform(0.5, 3.0, n), rng.uniform(-1.0, 1.0, n)
    alone = HillEquation(np.diag(w**2), np.diag(g), 0.4, 1.7, 0.05)
    Q = np.linalg.qr(rng.standard_normal((n, n)))[0]
    return alone, HillEquation(Q @ alone.F @ Q.T, Q @ alone.G @ Q.T, 0.4, 1.7, 0.05)


# ---- many coordinates ----------------------------------------------------------------------------


def test_thirty_coordinates_by_the_thirty_alone() -> None:
    """P of them all has lost every digit of its roots; its discs hold those of each alone."""
    alone, together = mixed(30, 1)
    expected = [
        characteristic(HillEquation([[f]], [[g]], 0.4, 1.7, 0.05))
        for f, g in zip(np.diag(alone.F), np.diag(alone.G), strict=True)
    ]
    c = characteristic(together)
    z = np.sort([one.z[0].real for one in expected])
    # rounding of the turned matrices, 1e-15 of 9, moves z by as much; discs are 1e-13
    assert np.max(np.abs(np.sort(c.z.real) - z)) < 1e-13
    T = max(one.T for one in expected)
    assert abs(c.T - T) <= c.T_error + 1e-13
    assert c.T_error < 1e-12
    assert c.verdict == ("unstable" if T > 0.0 else "stable")


@pytest.mark.parametrize("n", [13, 28])
@pytest.mark.parametrize("eta", [0.0, 0.02, "matrix"])
def test_many_coordinates_by_both_routes(n: int, eta: Any) -> None:
    """Once T was known to .076 here and called stable, with a multiplier of 1.073."""
    e = many(n, 0.02 * np.eye(n) if eta == "matrix" else eta)
    c, m = characteristic(e), monodromy(e)
    assert c.verdict == "unstable"
    assert c.T_error <= 1e-11
    assert abs(c.T - m.T) <= c.T_error + m.T_error
    # some of these meet in pairs, which both routes then know less well
    nearest = np.min(np.abs(m.multipliers[:, None] - c.multipliers), axis=1)
    assert np.max(nearest) < 1e-9


def test_sixty_coordinates() -> None:
    rng = np.random.default_rng(0)
    w = np.linspace(1.0, 3.0, 60)
    G = np.diag(0.3 * w**2) + 0.05 * rng.standard_normal((60, 60))
    e = HillEquation(np.diag(w**2), G, 0.3, 2.0, 0.01)
    c, m = characteristic(e), monodromy(e)
    assert c.verdict == "unstable"
    assert c.T_error <= 1e-11
    assert abs(c.T - m.T) <= c.T_error + m.T_error


def test_all_within_the_circle_is_shown() -> None:
    """Damped, far from every resonance: stable by 30 discs, T = -eta to the last digits."""
    w = np.sqrt(np.linspace(30.0, 40.0, 30))
    e = HillEquation(np.diag(w**2), 0.3 * np.eye(30), 0.1, 1.0, 0.02)
    c = characteristic(e)
    assert c.verdict == "stable"
    assert abs(c.T + 0.02) <= c.T_error < 1e-14
    general = characteristic(e.general())
    assert general.verdict == "stable"
    assert abs(general.T + 0.02) <= general.T_error < 1e-11


def test_equal_multipliers_with_vectors_of_their_own() -> None:
    """The same system twice: the polynomial knows a double root to half the digits."""
    one = PeriodicEquation(
        K=Fourier([[2.0, 0.3], [0.2, 1.0]], cos={1: [[0.5, 0.1], [0.2, -0.3]]}),
        C=0.1 * np.eye(2),
        Omega=1.7,
    )
    twice = PeriodicEquation(
        K=Fourier(np.kron(np.eye(2), one.K.mean), cos={1: np.kron(np.eye(2), one.K.cos[1])}),
        C=0.1 * np.eye(4),
        Omega=1.7,
    )
    c, single = characteristic(twice), characteristic(one)
    assert c.T_error < 1e-11
    assert abs(c.T - single.T) <= c.T_error + single.T_error
    assert c.stable


# ---- distances -----------------------------------------------------------------------------------


@pytest.mark.parametrize("off", [1e-3, 1e-6, 1e-9, 0.0])
def test_distance_is_no_less_than_the_true_one(off: float) -> None:
    """And no more than the degree times it, where the roots are apart."""
    e = HillEquation(
        [[2.0, 0.3], [0.2, 1.0]], [[1, 2], [3, 1]], 0.3, 1.3, [[0.1, 0.5], [-0.5, 0.1]]
    )
    c = characteristic(e)
    assert np.max(c.exponent_errors) < 1e-12
    r = root_distance(e, multipliers=c.multipliers * (1.0 + off))
    true = off * np.abs(c.multipliers)
    unsure = 1e-12
    assert np.all(r.distance >= true - unsure)
    assert np.all(r.distance <= 4.5 * true + unsure)
    assert np.all(r.radius >= true - unsure)
    assert np.all(np.abs(r.newton) <= 1.5 * true + unsure)
    assert np.all(r.error <= unsure + 1e-11 * off)


def test_distance_in_z() -> None:
    e = HillEquation([[2.0, 0.3], [0.2, 1.0]], [[1, 2], [3, 1]], 0.3, 1.3, 0.1)
    c = characteristic(e)
    r = root_distance(e, z=c.z + 1e-7)
    assert np.all(r.distance >= 1e-7 - c.error)
    assert np.all(r.distance <= 2.5e-7)
    by_multipliers = root_distance(e, multipliers=monodromy(e).multipliers)
    assert np.max(by_multipliers.distance) < 1e-12


def test_some_of_the_roots() -> None:
    e = many(28)
    m = monodromy(e)
    r = root_distance(e, multipliers=m.multipliers[:3])
    assert isinstance(r, RootDistance)
    assert r.radius.shape == (0,)
    # what the time domain found is right to 1e-12, whatever its bounds say
    assert np.max(r.distance) < 1e-11


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "multipliers, z: give one of them"),
        ({"multipliers": [1.0], "z": [1.0]}, "multipliers, z: give one of them"),
        ({"multipliers": [0.0]}, "multipliers: must not be 0"),
        ({"multipliers": [np.nan]}, "multipliers: must be a sequence of finite numbers"),
        ({"multipliers": "none"}, "multipliers: must be numbers"),
        ({"multipliers": 1.0}, "multipliers: must be a sequence of finite numbers"),
    ],
)
def test_bad_points(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        root_distance(many(2), **given)


def test_no_z_without_one_damping() -> None:
    for e in (many(2, 0.1 * np.eye(2)), many(2).general()):
        with pytest.raises(ValueError, match="z: the equation has none"):
            root_distance(e, z=[0.5])


# ---- the method, on polynomials that are known ---------------------------------------------------


def of_roots(roots: Any, rounding: float = EPS) -> Evaluate:
    def evaluate(v: Any, bounds: bool) -> At:
        apart = v[:, None] - np.array(roots)
        with np.errstate(divide="ignore", invalid="ignore"):
            log, slope = np.sum(np.log(np.abs(apart)), axis=1), np.sum(1.0 / apart, axis=1)
        if not np.all(np.isfinite(log)):
            raise np.linalg.LinAlgError
        one = np.ones(len(v))
        # an error of P as large as its terms' rounding
        size = rounding * np.sum(np.abs(v)[:, None] + np.abs(roots), axis=1)
        return At(log, slope, 4.0 * EPS * np.abs(v), one, size / np.exp(log) if bounds else one[:0])

    return evaluate


@pytest.mark.parametrize("start", ["near", "rough", "conjugate"])
def test_roots_are_found(start: str) -> None:
    roots = np.array([-1.1, -0.9, 0.2, 0.3, 0.5 + 0.4j, 0.5 - 0.4j])
    v = {
        "near": roots + 1e-3,
        "rough": 1.3 * np.exp(2j * np.pi * (np.arange(6) + 0.3) / 6),
        # two pairs that have to become real
        "conjugate": np.array(
            [-1 + 0.1j, -1 - 0.1j, 0.25 + 0.05j, 0.25 - 0.05j, 0.4 + 1j, 0.4 - 1j]
        ),
    }[start]
    found = improved(of_roots(roots), v.astype(complex))
    nearest = np.min(np.abs(found[:, None] - roots), axis=1)
    assert np.max(nearest) < 1e-13
    assert len(np.unique(np.argmin(np.abs(found[:, None] - roots), axis=1))) == 6
    assert np.sum(found.imag == 0.0) == 4


@pytest.mark.parametrize("off", [1e-2, 1e-5, 1e-10])
def test_discs_hold_roots_of_their_own(off: float) -> None:
    rng = np.random.default_rng(3)
    for _ in range(50):
        roots = rng.uniform(-1, 1, 7) + 1j * rng.uniform(-1, 1, 7)
        if rng.uniform() < 0.5:
            roots[1] = roots[0] + 0.3 * off
        v = roots + off * np.exp(2j * np.pi * rng.uniform(size=7))
        found = discs(of_roots(roots), v)
        # roots assigned to centres as they were made
        assert np.all(np.abs(found.centre - roots) <= found.radius)


def test_points_are_kept_apart() -> None:
    found = apart(np.array([1.0, 1.0, 0.0, 0.0, 2.0, 1.0]))
    assert len(np.unique(found)) == 6
    assert np.max(np.abs(found - [1, 1, 0, 0, 2, 1])) < 1e-13


def test_conjugates_are_made_so() -> None:
    v = np.array([1.0 + 1e-17j, 0.5 + 0.3j, 0.5 - 0.3j + 1e-16, -2.0 - 1e-18j])
    found = symmetrised(v)
    assert np.sum(found.imag == 0.0) == 2
    assert found[1] == found[2].conjugate()


# ---- from polynomials and discs ------------------------------------------------------------------


@pytest.mark.parametrize(
    "roots",
    [
        [1.0, 1e-66],
        [1e10, 1e5, 1e-15, 2e-15],
        [1e5, 3.0, -2.0, 1e-9, -1e-30],
        list(10.0 ** -np.arange(0.0, 24.0, 2.0)),
    ],
    ids=["two", "clusters", "signs", "graded"],
)
def test_roots_of_very_different_size(roots: list[float]) -> None:
    """Each to its own last digits."""
    found = polynomial_roots(np.real(np.poly(roots)))
    apart = np.abs(found[:, None] / np.array(roots) - 1.0)
    # the pair 1e-15 and 2e-15 is known to 1e-15 of itself
    assert np.max(np.min(apart, axis=0)) < 1e-13


def test_roots_at_zero() -> None:
    found = polynomial_roots(np.array([1.0, -3.0, 2.0, 0.0, 0.0]))
    assert np.sum(found == 0.0) == 2
    assert np.allclose(np.sort(found.real)[2:], [1.0, 2.0])


def test_newtons_polygon() -> None:
    """Of y^3 - 100 y^2 + ... with moduli 100, 1, 1: edges of one root and of two."""
    sizes = np.log(np.abs(np.poly([100.0, 1.0, -1.0])[::-1]) + 1e-300)
    edges = newton_polygon(sizes, np.array([True, True, True, True]))
    assert [(a, b) for a, b, _ in edges] == [(0, 2), (2, 3)]
    assert np.exp([r for _, _, r in edges]) == pytest.approx([1.0, 100.0], rel=1e-12)


def test_discs_within_the_circle_or_not() -> None:
    y, period = np.array([0.9 + 0j, -0.5 + 0j]), 2.0
    assert in_discs(y, np.array([0.05, 0.1]), period, 0.0, 1.0).verdict == "stable"
    assert in_discs(y, np.array([0.11, 0.1]), period, 0.0, 1.0).verdict == "undecided"
    assert in_discs(1.2 * y, np.array([0.05, 0.1]), period, 0.0, 1.0).verdict == "unstable"
    found = in_discs(y, np.array([0.05, 0.1]), period, 0.0, 1.0)
    assert pytest.approx(np.log(0.9)) == found.T
    assert np.log(0.95) <= found.T + found.T_error <= np.log(0.95) + 0.01
    assert found.exponent_errors[0] >= -np.log(1.0 - 0.05 / 0.9) / period


def test_real_discs_within_the_edges() -> None:
    """All z real, alone and inside: T is -eta exactly."""
    z, radius = np.array([0.5 + 0j, -0.7 + 0j]), np.array([0.1, 0.2])
    found = stability_in_discs(z, radius, 1.3, 0.0)
    assert (found.T, found.verdict) == (0.0, "stable")
    assert found.T_error < 1e-14
    assert stability_in_discs(z, np.array([0.1, 0.31]), 1.3, 0.0).verdict == "undecided"
    # not alone: they may be a conjugate pair
    near = np.array([0.5 + 0j, 0.55 + 0j])
    assert stability_in_discs(near, np.array([0.1, 0.1]), 1.3, 0.0).verdict == "undecided"
    beyond = np.array([1.5 + 0j, 0.2 + 0j])
    assert stability_in_discs(beyond, np.array([0.1, 0.1]), 1.3, 0.0).verdict == "unstable"
