"""Products of many matrices, and the size of what errors of each of them add to the whole."""

import numpy as np

from floquet.arrays import Float

# Factors multiplied one after the other in Python; beyond, groups of them go side by side.
MAX_LINKS = 256


def chain(factors: Float, *scales: Float) -> tuple[Float, ...]:
    """P_k ... P_1, and sum_j |P_k ... P_(j+1)| S_j |P_(j-1) ... P_1| for each S.

    Parameters
    ----------
    factors : (k, ..., m, m) ndarray
    *scales : (k, ..., m, m) ndarray
        An error of P_j is bounded by a small number times S_j >= 0: that of the product is bounded
        by the same number times the sum, to first order.

    Returns
    -------
    product, *sums : (..., m, m) ndarray
    """
    count = len(factors)
    if count > MAX_LINKS:
        return chain(*grouped(int(np.ceil(np.sqrt(count))), factors, *scales))
    before = [np.broadcast_to(np.eye(factors.shape[-1]), factors.shape[1:])]
    for P in factors[:-1]:
        before.append(P @ before[-1])
    sums = [np.zeros(factors.shape[1:]) for _ in scales]
    after = before[0]
    for j in reversed(range(count)):
        left, right = np.abs(after), np.abs(before[j])
        sums = [total + left @ S[j] @ right for total, S in zip(sums, scales, strict=True)]
        after = after @ factors[j]
    return factors[-1] @ before[-1], *sums


def grouped(size: int, *arrays: Float) -> list[Float]:
    """As `chain`, of `size` neighbours each, side by side; fewer in the last group."""
    whole = len(arrays[0]) // size * size
    parts = []
    if whole:
        shape = (-1, size, *arrays[0].shape[1:])
        parts.append(chain(*(np.moveaxis(x[:whole].reshape(shape), 1, 0) for x in arrays)))
    if whole < len(arrays[0]):
        parts.append(tuple(x[None] for x in chain(*(x[whole:] for x in arrays))))
    return [np.concatenate(pieces) for pieces in zip(*parts, strict=True)]
