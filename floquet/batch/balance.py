"""Coordinates in units of their own, so that no pivot and no norm depends on the units given.

F and G become D F D^-1 and D G D^-1, and so does everything made of them; P stays. D consists of
powers of two: nothing is rounded.
"""

import numpy as np
from numpy.typing import NDArray

from floquet.arrays import Float

# All rows at once, and so by half of what each would ask for alone; two settle in one sweep.
SWEEPS = 30

# A row and its column are alike within so many powers of two: what is left of no harm.
ALIKE = 5.0


def balanced(matrices: Float, weights: Float) -> Float:
    """Matrices side by side, with rows and columns of like size.

    Parameters
    ----------
    matrices : (1 + terms, n, n) or (1 + terms, k, n, n) ndarray
        Shared, or each point's own.
    weights : (1 + terms, k) ndarray
        What multiplies them at each point.

    Returns
    -------
    ndarray
        Of the shape of `matrices`.
    """
    if matrices.shape[-1] == 1:
        return matrices
    moduli, size = np.abs(matrices), np.abs(weights)
    if matrices.ndim == 3:
        total = np.einsum("t,tij->ij", size.max(axis=1), moduli)
    else:
        total = np.einsum("tk,tkij->kij", size, moduli)
    exponent = _exponents(total)
    if not np.any(exponent):
        return matrices
    # what overflows here overflows in the march, and is told there
    with np.errstate(over="ignore", under="ignore"):
        return np.ldexp(matrices, exponent[..., :, None] - exponent[..., None, :])


def _exponents(total: Float) -> NDArray[np.int_]:
    """Of two: row i times 2**e_i, column j times 2**-e_j; (..., n)."""
    off = total * (1.0 - np.eye(total.shape[-1]))
    found = np.zeros(total.shape[:-1], int)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(SWEEPS):
            # a row or a column without anything in it has no size to be made like another
            apart = np.log2(off.max(axis=-2)) - np.log2(off.max(axis=-1))
            apart = np.where(np.isfinite(apart), apart, 0.0)
            left = np.any(np.abs(apart) > ALIKE, axis=-1, keepdims=True)
            if not np.any(left):
                break
            step = np.where(left, np.rint(0.25 * apart), 0.0).astype(int)
            found += step
            off = np.ldexp(off, step[..., :, None] - step[..., None, :])
    return found
