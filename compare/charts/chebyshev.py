"""Tensor Chebyshev series: from values at Lobatto points to coefficients, and back anywhere."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct

Float = NDArray[np.floating[Any]]


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


def on_grid(series: Float, points: tuple[Float, ...]) -> Float:
    """Sum the series on the grid of `points`, one array an axis; leading axes stay.

    Matrix products only: for k points and n coefficients an axis, n operations a grid point on the
    last axis and fewer before it.
    """
    first = series.ndim - len(points)
    for axis, x in enumerate(points, start=first):
        table = basis(np.asarray(x, float), series.shape[axis])
        series = np.moveaxis(np.tensordot(series, table, axes=(axis, 1)), -1, axis)
    return series


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
