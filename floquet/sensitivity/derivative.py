"""The derivative of an analytic function of one number that can only be evaluated.

It is the derivative of a Chebyshev interpolant. On a wide interval the series converges slowly, on
a narrow one rounding is divided by little: intervals are halved while that gains anything.
"""

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from floquet.arrays import EPS, Float

# With 8 and with 32 the error that is reported is 60 and 4 times as large in the median, over 31
# functions with poles and roots at distances of 1e-4 to 10, waves and exponentials.
NODES = 20

# The last interval is 1/8192 of the first: 7 of 186 places of those functions were refused with
# 4, one with 10 (a pole a ten-thousandth away), none with 14.
HALVINGS = 14

# On the last coefficients, as in `compare.charts.surface`: with these factors the error was .18 of
# what is reported at most, over 620 places of the same functions, and so it was with half the ULPS.
TAIL = 4.0

# Last coefficients over the largest: with a pole inside the interval they do not fall at all.
CONVERGED = 1e-6

# On halving, rounding is divided by half as much: twice that is no chance.
WORSE = 4.0

# Rounding of a value, in ulps of the largest element; more of it shows in the last coefficients.
ULPS = 4.0


def differentiate(
    f: Callable[[float], Float], x: float, low: float, high: float, width: float
) -> tuple[Float, Float]:
    """Derivative at `x` of matrices side by side, and a bound on the error of each matrix.

    Parameters
    ----------
    f : callable
        From a number to (k, n, n): k matrices. It may refuse a number by `ValueError`.
    x : float
    low, high : float
        Where f may be evaluated: inside ``(low, high)``; x may be an end.
    width : float
        Half the widest interval to try.

    Returns
    -------
    (k, n, n) ndarray
    (k,) ndarray
        For every element of a matrix, measured by its largest.

    Raises
    ------
    ValueError
        f refuses, or the series does not converge, on every interval.
    """
    best: Float = np.zeros(0)
    least: Float = np.full(1, np.inf)
    for _ in range(HALVINGS):
        ends = max(low, x - width), min(high, x + width)
        width *= 0.5
        try:
            found, error = _on(f, x, *ends)
        except ValueError:
            continue
        if error.sum() < least.sum():
            best, least = found, error
        elif error.sum() > WORSE * least.sum():
            break
    if not np.isfinite(least.sum()):
        raise ValueError("no interval is free of singularities")
    return best, least


def _on(f: Callable[[float], Float], x: float, a: float, b: float) -> tuple[Float, Float]:
    """From an interpolant on [a, b], with what is left out and what is rounded."""
    middle, half = 0.5 * (a + b), 0.5 * (b - a)
    nodes = chebyshev.chebpts1(NODES)
    values = np.array([f(float(middle + half * t)) for t in nodes])
    series = 2.0 / NODES * np.tensordot(chebyshev.chebvander(nodes, NODES - 1).T, values, axes=1)
    series[0] *= 0.5
    at = (x - middle) / half
    slopes = np.array([chebyshev.chebval(at, chebyshev.chebder(row)) for row in np.eye(NODES)])
    found = np.tensordot(slopes, series, axes=1) / half

    size = np.abs(series).max(axis=(-2, -1))
    tail, largest = size[-4:].max(axis=0), np.maximum(size.max(axis=0), 1e-300)
    if np.any(tail > CONVERGED * largest):
        raise ValueError("the series does not converge")
    ratio = (tail / largest) ** (1.0 / NODES)
    unknown = TAIL * tail / (1.0 - ratio) + ULPS * EPS * largest
    return found, np.abs(slopes).sum() * unknown / half
