"""P(z) of many equations whose solutions grow, by two runs through the whole period side by side.

Much growth makes the half period's inverse a poor one. As in `floquet.period`, the bound is made of
the difference of two runs, here of Taylor steps of other lengths.
"""

from collections.abc import Callable
from math import ceil

import numpy as np

from floquet.accuracy import BASE_ULPS, OVERFLOW, amplitudes, bounded
from floquet.arrays import Float
from floquet.batch.numpy_kernel import ORDER, TOLERANCE, Points, fundamental, terms_of
from floquet.data_errors import subtraction_error
from floquet.integrate.step_length import fastest_rate, longest_step, perron_root
from hill import HillEquation

# Points side by side: neighbours in what limits their steps, which grows without end near a pole.
# 256 take 988 ms by 8, 619 by 16, 397 by 32, 308 by 64 and 321 all together.
CHUNK = 64

# Steps of the check over those of the run: neither truncation nor rounding are then alike. From 1.1
# to 2 times as many give the same bounds, over 64 systems that grow: rounding is most of them.
CHECK_SHARE = 4.0 / 3.0


def by_whole_period(points: Points, equation: Callable[[int], HillEquation]) -> tuple[Float, Float]:
    """P, (k, n + 1), and the bound on its error, (k,).

    Parameters
    ----------
    points : Points
        Each with matrices of its own.
    equation : callable
        The number of a point to its equation.

    Raises
    ------
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    n, count = points.matrices.shape[-1], points.weights.shape[1]
    moduli = np.abs(points.weights)[:, :, None, None] * np.abs(points.matrices)
    order = np.argsort(perron_root(np.sum(moduli, axis=0)), kind="stable")
    P, errors = np.empty((count, n + 1)), np.empty(count)
    for start in range(0, count, CHUNK):
        chunk = order[start : start + CHUNK]
        own = points.own(chunk)
        terms, still = terms_of(own), np.zeros((n, n))
        steps = ceil(2.0 * np.pi / longest_step(terms, still, ORDER, TOLERANCE))
        # what overflows is told below
        with np.errstate(over="ignore", invalid="ignore"):
            Phi, top = fundamental(own, steps, 2.0 * np.pi)
            check, _ = fundamental(own, ceil(CHECK_SHARE * steps) + 1, 2.0 * np.pi)
        if not (np.all(np.isfinite(Phi)) and np.all(np.isfinite(check))):
            raise OverflowError(OVERFLOW)
        fastest = fastest_rate(terms, still)
        for k, i in enumerate(map(int, chunk)):
            scale = amplitudes(top[k], fastest)
            scale[:n, :n] = np.maximum(scale[:n, :n], fastest * top[k, :n, n:])
            e = equation(i)
            found = bounded(
                Phi[k, :n, :n],
                check[k, :n, :n],
                scale[:n, :n],
                BASE_ULPS + 2.0 * np.pi * fastest,
                0.0,
                subtraction_error(e, in_tau(scale, e.Omega)) if e.damping else None,
            )
            P[i], errors[i] = found.p, np.max(found.errors)
    return P, errors


def in_tau(scale: Float, Omega: float) -> Float:
    """Sizes of a matrix of (u, du/dtheta) as those of (u, du/dtau)."""
    n = len(scale) // 2
    units = np.repeat([1.0, Omega], n)
    return units[:, None] * scale / units
