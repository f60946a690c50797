"""Damped z by Smith's discs, whose middles move over a rectangle as the roots do."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.enclosure.local import ROUNDING, Local, product

Float = NDArray[np.floating[Any]]
Index = NDArray[np.intp]

UNDECIDED, STABLE, UNSTABLE = 0, 1, 2


def by_discs(p: Local, z: Any, edges: tuple[Float, Float], found: Index) -> None:
    """Where discs about moving points settle it: the roots, or the nearest two drawn apart."""
    for drawn_apart in (False, True):
        some = np.flatnonzero(found == UNDECIDED)
        own, v = Local(p.terms[some], p.rest[some]), z[some]
        moves = _moves(own, v)
        if drawn_apart:
            v, moves = _drawn_apart(own, v, moves)
        found[some] = _discs(own, v, moves, (edges[0][some, None], edges[1][some, None]))


def _discs(p: Local, v: Any, moves: Any, edges: tuple[Float, Float]) -> Index:
    """Each connected set of the discs |z - v_i| <= n |P(v_i)/prod (v_i - v_j)| has its roots.

    The v_i move with x and y as the roots do, to first order. With foci -1 and 1 the ellipse
    through z has the half-axis (|z - 1| + |z + 1|)/2; a root is damped where that is below
    cosh(pi eta/Omega). It is convex in z: largest at a corner, nowhere below its tangent plane.
    """
    m, n = v.shape
    apart = np.abs(v[:, :, None] - v[:, None, :]) * (1.0 - 1e-12)
    apart -= np.abs(moves[:, :, None] - moves[:, None, :]).sum(axis=3) * (1.0 + 1e-12)
    radius = np.empty(v.shape)
    for i in range(n):
        gaps = np.prod(np.maximum(np.delete(apart[:, i], i, axis=1), 0.0), axis=1)
        with np.errstate(divide="ignore"):
            radius[:, i] = n * _along(p, v[:, i], moves[:, i]).size / gaps * (1.0 + 1e-9)
    corners = np.stack(
        [v + a * moves[..., 0] + b * moves[..., 1] for a in (-1, 1) for b in (-1, 1)]
    )
    high = _half_axis(corners).max(axis=0) * (1.0 + 1e-12) + radius
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = 0.5 * ((v - 1.0) / np.abs(v - 1.0) + (v + 1.0) / np.abs(v + 1.0))
        swing = np.abs((normal.conj()[..., None] * moves).real).sum(axis=2)
        low = _half_axis(v) * (1.0 - 1e-12) - swing * (1.0 + 1e-12) - radius
    beyond = low > edges[1]
    touching = ~(apart > radius[:, :, None] + radius[:, None, :])
    # discs of one kind that touch none of the other have as many roots as they are
    mixed = np.any(touching & (beyond[:, :, None] != beyond[:, None, :]), axis=(1, 2))
    found = np.full(m, UNDECIDED)
    found[np.any(beyond, axis=1) & ~mixed] = UNSTABLE
    found[np.all(high < edges[0], axis=1)] = STABLE
    return found


def _drawn_apart(p: Local, v: Any, moves: Any) -> tuple[Any, Any]:
    """The nearest two moved from their middle by what makes their discs least, where z may meet."""
    m, n = v.shape
    if n < 2:
        return v, moves
    each, v, moves = np.arange(m), v.copy(), moves.copy()
    apart = np.abs(v[:, :, None] - v[:, None, :]) + np.diag(np.full(n, np.inf))
    i, j = np.unravel_index(np.argmin(apart.reshape(m, n * n), axis=1), (n, n))
    middle = 0.5 * (v[each, i] + v[each, j])
    along = 0.5 * (moves[each, i] + moves[each, j])
    others = np.abs(middle[:, None] - v)
    others[each, i] = others[each, j] = 1.0
    with np.errstate(divide="ignore"):
        aside = np.sqrt(_along(p, middle, along).size / np.prod(others, axis=1))
    v[each, i], v[each, j] = middle + aside, middle - aside
    moves[each, i] = moves[each, j] = along
    return v, moves


def _half_axis(z: Any) -> Float:
    return np.asarray(0.5 * (np.abs(z - 1.0) + np.abs(z + 1.0)))


def _moves(p: Local, z: Any) -> Any:
    """Where each root goes along x and along y, as far as floats tell: (m, n, 2)."""
    n = z.shape[1]
    powers = z[:, :, None] ** np.arange(n - 1, -1, -1)
    apart = z[:, :, None] - z[:, None, :] + np.eye(n)
    along = np.einsum("mij,mjt->mit", powers, p.terms[:, :, 1:3])
    with np.errstate(divide="ignore", invalid="ignore"):
        found = -along / np.prod(apart, axis=2)[:, :, None]
    return np.where(np.isfinite(found), found, 0.0)


def _along(p: Local, z: Any, moves: Any) -> Local:
    """P at a complex point that moves with x and y."""
    zero = np.zeros(len(z))
    place = Local(np.column_stack([z, moves[:, 0], moves[:, 1], zero, zero, zero]), zero)
    total = Local(np.column_stack([zero + 1.0, *[zero] * 5]).astype(complex), zero)
    for j in range(p.rest.shape[1]):
        by = product(total, place)
        terms, rest = by.terms + p.terms[:, j], by.rest + p.rest[:, j]
        total = Local(terms, rest + ROUNDING * (by.size + np.abs(p.terms[:, j]).sum(axis=1)))
    return total
