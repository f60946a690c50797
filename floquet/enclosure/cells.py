"""Verdicts of whole rectangles within a patch, many at once.

From bounds on P(z), P' and P'' at a point z over a rectangle. Without damping:

- stable where P has n changes of sign between -1 and 1;
- unstable where P(1) < 0 or (-1)^n P(-1) < 0, or the like beyond 1 or -1: |z| > 1;
- unstable where (n - 1) P'^2 < n P P'' at a real point (Laguerre): not all z are real.

With damping 1 becomes cosh(pi eta/Omega), and complex z are told by discs.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.arrays import frozen
from floquet.enclosure.discs import STABLE, UNDECIDED, UNSTABLE, by_discs
from floquet.enclosure.local import ROUNDING, Local, about, at, product
from floquet.enclosure.surface import Patch

Float = NDArray[np.floating[Any]]
Index = NDArray[np.intp]

SLACK = 1e-12
"""Of cosh(pi eta/Omega), whose argument is below 710 and rounded by a few 1e-16 of itself."""

ASIDE = frozen(np.array([0.0, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0, 4.0, -4.0]))
"""Imaginary parts from the middle of a pair."""


def verdicts(p: Local, edges: tuple[Float, Float] | None) -> Index:
    """Of each rectangle.

    Parameters
    ----------
    p : Local
        P's coefficients.
    edges : (low, high) or None
        Bounds (m,) on cosh(pi eta/Omega) over it; None without damping.
    """
    m, n = p.rest.shape
    inner, outer = (np.ones(m), np.ones(m)) if edges is None else edges
    z = _roots(p.terms[:, :, 0])
    order = np.argsort(-z.real, axis=1)
    z = np.take_along_axis(z, order, axis=1)
    between = 0.5 * (z.real[:, 1:] + z.real[:, :-1])
    points = np.column_stack([inner, between, -inner])
    changes = np.all(np.diff(points, axis=1) < 0.0, axis=1)
    for k in range(n + 1):
        changes &= _signed(p, points[:, k], k)[0] > 0.0
    found = np.where(changes, STABLE, UNDECIDED)
    # a root beyond: P is positive above all of them, and (-1)^n P below
    beyond = [(outer, 0), (-outer, n)]
    if n > 1:
        beyond += [(np.maximum(between[:, 0], outer), 0), (np.minimum(between[:, -1], -outer), n)]
    for x, k in beyond:
        found[_signed(p, x, k)[1] < 0.0] = UNSTABLE
    if edges is None:
        _not_all_real(p, z, found)
    else:
        by_discs(p, z, edges, found)
    return found


def _signed(p: Local, x: Float, k: int) -> tuple[Float, Float]:
    """Bounds on (-1)^k P(x)."""
    low, high = at(p, x).ends
    return (low, high) if k % 2 == 0 else (-high, -low)


def _roots(coefficients: Float) -> NDArray[np.complexfloating[Any, Any]]:
    """Of monic polynomials (m, n), as far as floats tell: any points would do."""
    m, n = coefficients.shape
    companion = np.zeros((m, n, n))
    companion[:, 0] = -coefficients
    companion[:, range(1, n), range(n - 1)] = 1.0
    return np.asarray(np.linalg.eigvals(companion), complex)


def _not_all_real(p: Local, z: Any, found: Index) -> None:
    """Where Laguerre's inequality fails at a point."""
    n = z.shape[1]
    for k in range(n):
        some = np.flatnonzero((found == UNDECIDED) & (z.imag[:, k] > 0.0))
        if not len(some):
            continue
        own = Local(p.terms[some], p.rest[some])
        x = _between_a_pair(own.terms[:, :, 0], z[some, k])
        value, slope, bend = (at(own, x, d) for d in range(3))
        squared, other = product(slope, slope), product(value, bend)
        _, high = Local(
            (n - 1) * squared.terms - n * other.terms,
            (n - 1) * squared.rest + n * other.rest
            + ROUNDING * ((n - 1) * squared.size + n * other.size),
        ).ends  # fmt: skip
        found[some[high < 0.0]] = UNSTABLE


def _between_a_pair(coefficients: Float, z: Any) -> Float:
    """Where the inequality fails most clearly in the middle, as far as floats tell.

    That is midway between a pair, unless another root is near.
    """
    m, n = coefficients.shape
    monic = np.column_stack([np.ones(m), coefficients])
    x = z.real[:, None] + z.imag[:, None] * ASIDE
    powers = x[:, :, None] ** np.arange(n, -1, -1)
    value = np.einsum("mj,mkj->mk", monic, powers)
    slope = np.einsum("mj,mkj->mk", monic[:, :-1] * np.arange(n, 0, -1), powers[:, :, 1:])
    twice = np.arange(n, 1, -1) * np.arange(n - 1, 0, -1)
    bend = np.einsum("mj,mkj->mk", monic[:, :-2] * twice, powers[:, :, 2:])
    square, other = (n - 1) * slope**2, n * value * bend
    with np.errstate(invalid="ignore"):
        best = np.argmin((square - other) / (square + np.abs(other)), axis=1)
    return np.asarray(x[np.arange(m), best])


@dataclass(frozen=True)
class Place:
    """Where a patch lies: middle and half width in s = 1/Omega, half width in gamma."""

    s: float
    half_s: float
    half_gamma: float


def decided(
    patch: Patch, ends: Float, place: Place, eta: float, halvings: int
) -> tuple[Index, Float]:
    """How many parts of each rectangle are undecided, stable and unstable, and their areas.

    Parameters
    ----------
    patch : Patch
    ends : (m, 4) ndarray
        In x and y of the patch.
    place : Place
    eta : float
    halvings : int
        How often what is not decided is halved, each time along what it varies most with.

    Returns
    -------
    number, area : (3, m) ndarray
        By `UNDECIDED`, `STABLE`, `UNSTABLE`; areas are of Omega times gamma.
    """
    number, area = np.zeros((3, len(ends)), np.intp), np.zeros((3, len(ends)))
    owner = np.arange(len(ends))
    for left in range(halvings, -1, -1):
        p = about(patch, ends)
        kinds = verdicts(p, _edges(ends, place, eta) if eta else None)
        done = (kinds != UNDECIDED) | (left == 0)
        size = _area(ends, place)
        for kind in (UNDECIDED, STABLE, UNSTABLE):
            own = done & (kinds == kind)
            number[kind] += np.bincount(owner[own], minlength=number.shape[1])
            area[kind] += np.bincount(owner[own], size[own], minlength=number.shape[1])
        if np.all(done):
            break
        owner = np.repeat(owner[~done], 2)
        ends = _halved(ends[~done], np.abs(p.terms[~done]).sum(axis=1))
    return number, area


def _halved(ends: Float, swings: Float) -> Float:
    """Each as two, cut across x or y."""
    across = swings[:, 1] + swings[:, 3] >= swings[:, 2] + swings[:, 5]
    first, second = ends.copy(), ends.copy()
    for chosen, low in ((across, 0), (~across, 2)):
        middle = 0.5 * (ends[chosen, low] + ends[chosen, low + 1])
        first[chosen, low + 1] = second[chosen, low] = middle
    return np.stack([first, second], axis=1).reshape(-1, 4)


def _area(ends: Float, place: Place) -> Float:
    low, high = (place.s + place.half_s * ends[:, k] for k in (0, 1))
    return np.asarray((1.0 / low - 1.0 / high) * place.half_gamma * (ends[:, 3] - ends[:, 2]))


def _edges(ends: Float, place: Place, eta: float) -> tuple[Float, Float]:
    """Bounds on cosh(pi eta/Omega)."""
    low, high = (np.cosh(np.pi * eta * (place.s + place.half_s * ends[:, k])) for k in (0, 1))
    return low * (1.0 - SLACK), high * (1.0 + SLACK)
