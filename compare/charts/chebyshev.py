"""Tensor Chebyshev series: from values at Lobatto points to coefficients, and back anywhere."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct

Float = NDArray[np.floating[Any]]

GRAIN = 16
"""Blocks have a multiple of so many points along an axis, and are filled up to it.

The last few lines and columns of a product of matrices are treated by other instructions, which
round otherwise; no library takes more than these at a time. So no number depends on the blocks.
"""


def lobatto(n: int) -> Float:
    """The n points cos(pi j/(n - 1)) of [-1, 1], descending; every second one of 2n - 1 is here."""
    return np.asarray(np.sin(0.5 * np.pi * np.linspace(1.0, -1.0, n)))


def coefficients(values: Float, axes: tuple[int, ...]) -> Float:
    """Chebyshev coefficients along `axes` of values at Lobatto points."""
    series = np.asarray(values, float)
    for axis in axes:
        n = series.shape[axis]
        series = dct(series, type=1, axis=axis) / (n - 1)
        ends: list[Any] = [slice(None)] * series.ndim
        for end in (0, -1):
            ends[axis] = end
            series[tuple(ends)] *= 0.5
    return series


def basis(x: Float, n: int) -> Float:
    """T_0 .. T_(n-1) at the points x of [-1, 1], shape (len(x), n)."""
    table = np.empty((n, len(x)))
    table[0] = 1.0
    if n > 1:
        table[1] = x
    for k in range(2, n):
        table[k] = 2.0 * x * table[k - 1] - table[k - 2]
    return table.T


def on_blocks(
    series: Float, points: Sequence[Float], most: int
) -> Iterator[tuple[tuple[slice, ...], Float]]:
    """The monic polynomials whose lower coefficients are n series, on a grid, a block at a time.

    Matrix products only: for k points and c coefficients an axis, c operations a grid point on the
    last axis and fewer before it. The numbers do not depend on the blocks.

    Parameters
    ----------
    series : (n, coefficients on each axis) ndarray
    points : sequence of ndarray
        One an axis.
    most : int
        Points of a block, about; `GRAIN` an axis at least.

    Yields
    ------
    tuple of slice
        Which points along each axis.
    (n + 1, points of the block) ndarray
        1 and the n sums, the last axis running fastest.
    """
    counts = [len(x) for x in points]
    parts = _parts(counts, most)
    # filled up to whole grains: with points that are left out again, with coefficients that are 0
    filled = [np.pad(x, (0, -len(x) % GRAIN), mode="edge") for x in points]
    series = np.pad(series, [(0, 0), (0, 0), *((0, -c % GRAIN) for c in series.shape[2:])])
    tables = [basis(x, c) for x, c in zip(filled, series.shape[1:], strict=True)]
    for part, P in _blocks(series, tables, parts, ()):
        there = tuple(slice(0, p.stop - p.start) for p in part)
        yield part, P[(slice(None), *there)].reshape(len(P), -1)


def _blocks(
    sums: Float, tables: list[Float], parts: list[list[slice]], before: tuple[slice, ...]
) -> Iterator[tuple[tuple[slice, ...], Float]]:
    """The same, filled up, (n + 1, *sides), of a series summed already along the axes before."""
    axis, n = len(before), len(sums)
    shape, c = sums.shape[: axis + 1], sums.shape[axis + 1]
    for part in parts[axis]:
        table = tables[axis][part.start : part.stop + -part.stop % GRAIN]
        if axis + 1 < len(tables):
            rest = sums.shape[axis + 2 :]
            partly = np.matmul(table, sums.reshape(-1, c, math.prod(rest)))
            longer = partly.reshape(*shape, len(table), *rest)
            yield from _blocks(longer, tables, parts, (*before, part))
            continue
        P = np.empty((n + 1, *shape[1:], len(table)))
        P[0] = 1.0
        np.matmul(sums.reshape(n, -1, c), table.T, out=P[1:].reshape(n, -1, len(table)))
        yield (*before, part), P


def _parts(counts: Sequence[int], most: int) -> list[list[slice]]:
    """Each axis in parts, about as long as another where it can be; the last takes the rest."""
    result: list[list[slice]] = [[] for _ in counts]
    order = sorted(range(len(counts)), key=lambda k: counts[k])
    for left, k in zip(range(len(counts), 0, -1), order, strict=True):
        side = max(GRAIN, int(most ** (1.0 / left)) // GRAIN * GRAIN)
        starts = [side * j for j in range(max(1, counts[k] // side))]
        result[k] = [slice(*ends) for ends in pairwise([*starts, counts[k]])]
        most //= min(side, counts[k])
    return result


def along(series: Float, axis: int, x: Float) -> Float:
    """Sum the series along one axis, which is then that of the points x."""
    table = basis(x, series.shape[axis])
    return np.moveaxis(np.tensordot(series, table, axes=(axis, 1)), -1, axis)


def at_points(series: Float, points: tuple[Float, ...]) -> Float:
    """Sum the series at scattered points, one array of coordinates an axis; leading axes stay."""
    first = series.ndim - len(points)
    tables = [
        basis(np.asarray(x, float), n) for x, n in zip(points, series.shape[first:], strict=True)
    ]
    result = np.tensordot(series, tables[-1], axes=(series.ndim - 1, 1))
    for table in reversed(tables[:-1]):
        result = np.einsum("...np,pn->...p", result, table)
    return result


def decay(series: Float, axis: int, last: int = 3) -> float:
    """Largest of the last few coefficients along an axis: what is left out is of this size."""
    tail = np.moveaxis(series, axis, -1)[..., -last:]
    return float(np.max(np.abs(tail)))
