"""M^-1 times matrices, each element to about an ulp, with a bound on what it is off."""

import numpy as np

from floquet.arrays import EPS, Float

# Splits a float into two halves of 26 bits.
SPLIT = 2.0**27 + 1.0


def divided(M: Float, matrices: Float) -> tuple[Float, Float]:
    """Solve M X = B, with a correction from the exact residual.

    Parameters
    ----------
    M : (n, n) ndarray
    matrices : (k, n, n) ndarray

    Returns
    -------
    X, error : (k, n, n) ndarray
    """
    # rows near 1 by powers of two: to split a float multiplies it
    rows = 2.0 ** -np.frexp(np.max(np.abs(M), axis=1))[1].astype(float)[:, None]
    M, matrices = M * rows, matrices * rows
    inverse = np.linalg.inv(M)
    size = np.abs(inverse)
    X = inverse @ matrices
    for _ in range(2):
        residual, unsure = _residual(M, X, matrices)
        correction = inverse @ residual
        X = X + correction
    # the last sum, by the exact residual, is off by its rounding and by what `inverse` is off
    left = residual - M @ correction
    n = len(M)
    rounding = 2.0 * n * EPS * (np.abs(residual) + np.abs(M) @ np.abs(correction))
    error = 2.0 * size @ (np.abs(left) + rounding + unsure) + 0.5 * EPS * np.abs(X)
    if not (np.all(np.isfinite(X)) and np.all(np.isfinite(error))):
        raise OverflowError("M: M^-1 C or M^-1 K exceeds what a float can hold")
    return X, error


def _residual(M: Float, X: Float, B: Float) -> tuple[Float, Float]:
    """B - M X in twice the digits, and a bound on its error."""
    total, small = B.copy(), np.zeros_like(B)
    size = np.abs(B)
    for j in range(M.shape[1]):
        product, rest = _product(-M[:, j, None], X[:, j, None, :])
        total, lost = _sum(total, product)
        small = small + (lost + rest)
        size = size + np.abs(product)
    return total + small, 4.0 * M.shape[1] * EPS**2 * size + EPS * np.abs(total + small)


def _sum(a: Float, b: Float) -> tuple[Float, Float]:
    """A + b, and what its rounding lost (Knuth)."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def _product(a: Float, b: Float) -> tuple[Float, Float]:
    """A b, and what its rounding lost (Dekker)."""
    a_high, b_high = _high(a), _high(b)
    a_low, b_low = a - a_high, b - b_high
    p = a * b
    return p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low


def _high(a: Float) -> Float:
    c = SPLIT * a
    return c - (c - a)
