"""z, R, T and the verdict at any points of a chart, with what the error of P allows."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.roots import values
from hill.stability import modulus

Complex = NDArray[np.complexfloating[Any]]
Float = NDArray[np.floating[Any]]
EPS = float(np.finfo(float).eps)

RIM = np.exp(2j * np.pi * np.arange(16) / 16)

# For roots a little beyond [-1, 1], whose polynomials are a little larger.
MARGIN = 4.0

CHUNK = 8192
"""Points at a time: their discs' rims stay in the cache."""


@dataclass(frozen=True, eq=False)
class Points:
    """The solution at k points.

    Attributes
    ----------
    polynomial : (k, n + 1) ndarray
        P(z), monic, highest power first.
    error : (k,) ndarray
        Bound on the absolute error of its coefficients.
    z : (k, n) complex ndarray
    R : (k,) ndarray
        Largest |z +- sqrt(z^2 - 1)|, (7.1.2).
    T : (k,) ndarray
        Characteristic argument (7.1.1).
    T_error : (k,) ndarray
        Bound on the error of `T`.
    unstable : (k,) bool ndarray
        Where T exceeds `T_error`.
    """

    polynomial: Float
    error: Float
    z: Complex
    R: Float
    T: Float
    T_error: Float
    unstable: NDArray[np.bool_]


def solve(polynomial: Float, error: Float, Omega: Float, eta: Float) -> Points:
    """Roots and growth of many P(z), (k, n + 1), each with its own error, Omega and eta."""
    z = values(polynomial.T).T
    log_R = np.log(modulus(z))
    to_T = Omega / np.pi
    # each set of discs holds every root, so the tighter end of the two is the bound
    ends = [_between(z, log_R, radius) for radius in _discs(polynomial, error, z)]
    low = np.maximum(*(least for least, _ in ends))
    high = np.minimum(*(most for _, most in ends))
    worst = log_R.max(axis=1)
    T_error = to_T * np.maximum(high - worst, worst - low) + 4.0 * EPS * (to_T + np.abs(eta))
    T = to_T * worst - eta
    return Points(
        polynomial=polynomial,
        error=error,
        z=z,
        R=np.exp(worst),
        T=T,
        T_error=T_error,
        unstable=T_error < T,
    )


def largest_error(n: int, error: float) -> float:
    """More than the error of ln R can be where T is small: all n roots together, at +1 or -1.

    Within radius r of [-1, 1] ln R is at most arccosh(1 + r) < sqrt(2 r).
    """
    beyond = MARGIN * (error + 3 * n * EPS * 2.0**n)
    radius = (beyond * np.sum(2.0 ** np.arange(n))) ** (1.0 / n)
    return float(np.sqrt(2.0 * radius))


def _between(z: Complex, log_R: Float, radius: Float) -> tuple[Float, Float]:
    """Least and largest ln R of roots within `radius` of z, as in `hill.stability`."""
    least, most = log_R.copy(), log_R.copy()
    for start in range(0, len(z), CHUNK):
        part = slice(start, start + CHUNK)
        rim = np.log(modulus(z[part, :, None] + radius[part, :, None] * RIM))
        least[part] = np.minimum(least[part], rim.min(axis=2))
        most[part] = np.maximum(most[part], rim.max(axis=2))
    # ln R is harmonic off [-1, 1] and zero on it: its extremes are on the rim or on the segment
    meets = np.abs(z - np.clip(z.real, -1.0, 1.0)) <= radius
    return np.where(meets, 0.0, least).max(axis=1), most.max(axis=1)


def _discs(polynomial: Float, error: Float, z: Complex) -> tuple[Float, Float]:
    """Radii of the two sets of `hill.stability.root_discs`, (k, n) each."""
    n = z.shape[1]
    largest = np.abs(polynomial).max(axis=1)
    slack = error + 2 * n * EPS * largest
    size = np.sum(np.abs(z)[:, :, None] ** np.arange(n), axis=2)
    value = np.ones_like(z)
    for j in range(1, n + 1):
        value = value * z + polynomial[:, j, None]
    gaps = np.abs(z[:, :, None] - z[:, None, :]) + np.eye(n)
    with np.errstate(divide="ignore"):
        smith = n * (np.abs(value) + slack[:, None] * size) / gaps.prod(axis=2)
    backward = slack + n * EPS * largest
    farthest = np.abs(z).max(axis=1) + 1.0
    equal = (backward * np.sum(farthest[:, None] ** np.arange(n), axis=1)) ** (1.0 / n)
    rounding = 1.0 + 1e-9  # a disc that only touches [-1, 1] must not be lost to it
    return np.where(np.isfinite(smith), smith, farthest[:, None]) * rounding, np.broadcast_to(
        equal[:, None] * rounding, z.shape
    )
