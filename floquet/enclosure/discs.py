"""Damped z by Smith's discs, whose middles move over a rectangle as the roots do.

Moving points are arrays (m, n, 6), a `Local` without a rest each; where they are is a choice, and
only what is said of the discs about them has to hold.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.enclosure.local import ROUNDING, Local, product

Float = NDArray[np.floating[Any]]
Index = NDArray[np.intp]

UNDECIDED, STABLE, UNSTABLE = 0, 1, 2


def by_discs(p: Local, z: Any, edges: tuple[Float, Float], found: Index) -> None:
    """Where discs about moving points settle it: the roots, or all but the nearest two.

    Parameters
    ----------
    p : Local
    z : (m, n) ndarray
        Roots in the middle, as far as floats tell.
    edges : (low, high)
        Bounds (m,) on cosh(pi eta/Omega).
    found : (m,) ndarray
        What is undecided there is decided, where it can be.
    """
    for decide in (_apart, _but_two):
        some = np.flatnonzero(found == UNDECIDED)
        own, v = Local(p.terms[some], p.rest[some]), z[some]
        found[some] = decide(own, _moving(own, v), (edges[0][some], edges[1][some]))


def _apart(p: Local, c: Any, edges: tuple[Float, Float]) -> Index:
    """Each connected set of the discs has as many roots as discs.

    With foci -1 and 1 the ellipse through z has the half-axis (|z - 1| + |z + 1|)/2; a root is
    damped where that is below cosh(pi eta/Omega).
    """
    distance, radius = _distances(c, c), _radii(p, c)
    low, high = _half_axes(c, radius)
    beyond = low > edges[1][:, None]
    touching = ~(distance > radius[:, :, None] + radius[:, None, :])
    # discs of one kind that touch none of the other have as many roots as they are
    mixed = np.any(touching & (beyond[:, :, None] != beyond[:, None, :]), axis=(1, 2))
    found = np.full(len(c), UNDECIDED)
    found[np.any(beyond, axis=1) & ~mixed] = UNSTABLE
    found[np.all(high < edges[0][:, None], axis=1)] = STABLE
    return found


def _but_two(p: Local, c: Any, edges: tuple[Float, Float]) -> Index:
    """The nearest two by their sum s and product q, which do not mind that they meet.

    Where the discs of the others are apart from theirs, and from the conjugates of theirs, s and q
    are real and follow from P's coefficients. With d = pi eta/Omega both roots of z^2 - s z + q are
    within the ellipse with the half-axes A = cosh d, B = sinh d where

        |s| < 2 A,  A^2 - A |s| + q > 0,  q - s^2/4 < B^2 (1 - s^2/(4 A^2)),

    and one is beyond it where the last is the other way round.
    """
    (m, n), found = c.shape[:2], np.full(len(c), UNDECIDED)
    if n < 2 or not m:
        return found
    c = _drawn_apart(p, c)
    radius = _radii(p, c)
    known = np.all(np.isfinite(radius), axis=1)
    both = radius[:, :, None] + radius[:, None, :]
    for mine in (c, c.conj()):
        free = _distances(mine, c) > both
        free[:, :2, :2] = True
        free[:, range(n), range(n)] = True
        # of the others it is enough that each is apart as it is
        known &= np.all(free[:, :2], axis=(1, 2)) & (np.all(free, axis=(1, 2)) | (mine is not c))
    radius = np.where(known[:, None], radius, 0.0)
    inside = np.all(_half_axes(c, radius)[1][:, 2:] < edges[0][:, None], axis=1)

    first, second = _constant(m, 0.0), _constant(m, 0.0)
    for k in range(2, n):
        root = Local(c[:, k], radius[:, k])
        second, first = _sum(second, product(first, root)), _sum(first, root)
    s = _scaled(_sum(_coefficient(p, 0), first), -1.0)
    q = _sum(_coefficient(p, 1), _scaled(_sum(product(s, first), second), -1.0))
    bent_low, bent_high = _sum(q, _scaled(product(s, s), -0.25)).real.ends
    (s_low, s_high), (q_low, _) = s.real.ends, q.real.ends
    most = np.maximum(np.abs(s_low), np.abs(s_high))
    least = np.maximum(np.maximum(s_low, -s_high), 0.0)
    inner, outer = edges
    shares = 1.0 - most**2 / (4.0 * inner**2), 1.0 - least**2 / (4.0 * outer**2)
    squares = np.maximum(inner**2 - 1.0, 0.0), outer**2 - 1.0
    slack = ROUNDING * outer**2 * (1.0 + most) ** 2
    fits = (most < 2.0 * inner) & (inner**2 - inner * most + q_low > slack)
    room = np.minimum(*(square * shares[0] for square in squares)) - slack
    reach = np.maximum(*(square * shares[1] for square in squares)) + slack
    found[known & inside & fits & (bent_high < room)] = STABLE
    found[known & (bent_low > reach)] = UNSTABLE
    return found


def _distances(c: Any, d: Any) -> Float:
    """Of each of some moving points from each of others, at least."""
    apart = np.abs(c[:, :, None] - d[:, None, :])
    swing = apart[..., 1:].sum(axis=-1)
    return np.asarray(apart[..., 0] * (1.0 - 1e-12) - swing * (1.0 + 1e-12))


def _radii(p: Local, c: Any) -> Float:
    """Smith's: |z - v_i| <= n |P(v_i)/prod (v_i - v_j)| about moving points v_i."""
    n, apart = c.shape[1], np.maximum(_distances(c, c), 0.0)
    apart[:, range(n), range(n)] = 1.0
    size = np.stack([_along(p, c[:, i]).size for i in range(n)], axis=1)
    with np.errstate(divide="ignore"):
        return np.asarray(n * size / np.prod(apart, axis=2) * (1.0 + 1e-9))


def _half_axes(c: Any, radius: Float) -> tuple[Float, Float]:
    """Bounds on the half-axes of the ellipses through what is in the discs.

    They are convex in z: largest at a corner, nowhere below a tangent plane.
    """
    v, x, y = (c[..., k] for k in range(3))
    more = radius + np.abs(c[..., 3:]).sum(axis=-1) * (1.0 + 1e-12)
    corners = np.stack([v + x + y, v + x - y, v - x + y, v - x - y])
    high = _half_axis(corners).max(axis=0) * (1.0 + 1e-12) + more
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = 0.5 * ((v - 1.0) / np.abs(v - 1.0) + (v + 1.0) / np.abs(v + 1.0)).conj()
        swing = np.abs((normal * x).real) + np.abs((normal * y).real)
        low = _half_axis(v) * (1.0 - 1e-12) - swing * (1.0 + 1e-12) - more
    return low, high


def _half_axis(z: Any) -> Float:
    return np.asarray(0.5 * (np.abs(z - 1.0) + np.abs(z + 1.0)))


def _moving(p: Local, z: Any) -> Any:
    """The roots as they move with x and y, to second order as far as floats tell: (m, n, 6)."""
    m, n = z.shape
    c = np.zeros((m, n, 6), complex)
    c[..., 0] = z
    apart = z[:, :, None] - z[:, None, :] + np.eye(n)
    for terms in (slice(1, 3), slice(3, 6)):
        for i in range(n):
            with np.errstate(all="ignore"):
                step = _along(p, c[:, i]).terms / np.prod(apart[:, i], axis=1)[:, None]
            # a step as long as the gap is none
            near = np.abs(step).sum(axis=1) < np.min(np.abs(apart[:, i]), axis=1)
            c[near, i, terms] -= step[near, terms]
    return c


def _drawn_apart(p: Local, c: Any) -> Any:
    """The nearest two first, moved from their middle by what makes their discs least."""
    m, n = c.shape[:2]
    each, v = np.arange(m), c[..., 0]
    apart = np.abs(v[:, :, None] - v[:, None, :]) + np.diag(np.full(n, np.inf))
    i, j = np.unravel_index(np.argmin(apart.reshape(m, n * n), axis=1), (n, n))
    others = (np.arange(n) != i[:, None]) & (np.arange(n) != j[:, None])
    c = c[each[:, None], np.argsort(others, axis=1, kind="stable")]
    middle = 0.5 * (c[:, 0] + c[:, 1])
    gaps = np.prod(np.abs(middle[:, :1] - c[:, 2:, 0]), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        aside = np.sqrt(_along(p, middle).size / gaps)
    c[:, 0] = c[:, 1] = middle
    c[:, 0, 0] += np.where(np.isfinite(aside), aside, 0.0)
    c[:, 1, 0] -= np.where(np.isfinite(aside), aside, 0.0)
    return c


def _constant(m: int, value: float) -> Local:
    terms = np.zeros((m, 6), complex)
    terms[:, 0] = value
    return Local(terms, np.zeros(m))


def _coefficient(p: Local, j: int) -> Local:
    return Local(p.terms[:, j], p.rest[:, j])


def _sum(f: Local, g: Local) -> Local:
    return Local(f.terms + g.terms, f.rest + g.rest + ROUNDING * (f.size + g.size))


def _scaled(f: Local, by: float) -> Local:
    return Local(f.terms * by, f.rest * abs(by) + ROUNDING * abs(by) * f.size)


def _along(p: Local, place: Any) -> Local:
    """P at a point that moves with x and y."""
    moving, total = Local(place, np.zeros(len(place))), _constant(len(place), 1.0)
    for j in range(p.rest.shape[1]):
        total = _sum(product(total, moving), _coefficient(p, j))
    return total
