"""What an equation's own numbers move P by: the rounding of F - eta^2/4, and `data_error`."""

from fractions import Fraction

import numpy as np

from floquet.accuracy import moved_by_data, moved_by_diagonal
from floquet.arrays import Float
from hill import HillEquation

# By its modes a change of F moves P so far without pulsation. With it, it moved P three times as
# far in one of 9,849 systems (`benchmarks.honesty --seed 40`); in the others the rest covered it.
MODES_SAFETY = 4.0


def subtraction_error(e: HillEquation, scale: Float) -> tuple[Float, float]:
    """What the rounding of F - eta^2/4 adds to A, and to P over its size, to first order.

    By Duhamel's formula a change dF moves A by the integral over the period of B dF A, and `scale`
    has the sizes of A and B at its end. A slow B has been larger on the way: it is the integral of
    D, and no larger than that over half the period. That counts every element as if it stood alone;
    by the modes of F it is far less, where F has modes.
    """
    n, eta = e.n, e.damping
    quarter, exact = 0.25 * eta**2, Fraction(eta) ** 2 / 4
    off = [abs(Fraction(f) - exact - Fraction(f - quarter)) for f in np.diag(e.F)]
    rounded = np.array([float(x) for x in off])
    B = np.maximum(scale[:n, n:], 0.5 * e.period * scale[n:, n:])
    alone = e.period * B @ (rounded[:, None] * scale[:n, :n])
    share = moved_by_diagonal(e.F, rounded, quarter, e.Omega)
    return alone, MODES_SAFETY * share


def data_share(e: HillEquation) -> float:
    """What the errors of the matrices move P by, over its size."""
    if e.data_error == 0.0:
        return 0.0
    largest = np.max(np.abs(e.F)) + sum(np.max(np.abs(H)) for H in (e.gamma * e.G, *e.H))
    x = np.array([1.0 / e.Omega**2])
    shift = 0.25 * e.damping**2 * x if np.ndim(e.eta) == 0 else 0.0 * x
    return float(e.data_error * largest * x[0] * moved_by_data(e.F, x, shift)[1][0])
