"""M^-1 times matrices, each element to about an ulp, with a bound on what it is off."""

import numpy as np

from floquet.arrays import EPS, Float

# Splits a float into two halves of 26 bits.
SPLIT = 2.0**27 + 1.0

# Each leaves the condition number times 1e-16 of the error before it.
MAX_CORRECTIONS = 30


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
    with np.errstate(over="ignore", invalid="ignore"):
        M, matrices = M * rows, matrices * rows
        X, error = _divided(M, matrices)
    if not (np.all(np.isfinite(X)) and np.all(np.isfinite(error))):
        raise OverflowError("M: M^-1 C or M^-1 K exceeds what a float can hold")
    return X, error


def _divided(M: Float, matrices: Float) -> tuple[Float, Float]:
    inverse, n = np.linalg.inv(M), len(M)
    X = inverse @ matrices
    for _ in range(MAX_CORRECTIONS):
        residual, unsure = _residual(M, X, matrices)
        correction = inverse @ residual
        X = X + correction
        if not np.any(np.abs(correction) > EPS * np.abs(X)):
            break
    # by the exact residual the last sum is off by its rounding and by M^-1 of what is left of it
    size = np.abs(M)
    left = residual - M @ correction
    unsure = unsure + 2.0 * n * EPS * (np.abs(residual) + size @ np.abs(correction))
    further = inverse @ left
    rest = np.abs(left - M @ further) + 2.0 * n * EPS * (np.abs(left) + size @ np.abs(further))
    error = np.abs(further) + 2.0 * np.abs(inverse) @ (rest + unsure)
    return X, error + 0.5 * EPS * np.abs(X)


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
