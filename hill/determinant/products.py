"""Products that neither overflow nor underflow."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.arrays import Complex, Float


def products(factors: Complex) -> tuple[Complex, NDArray[np.int_]]:
    """Product of each row as a mantissa and a power of two, so that nothing overflows."""
    count = len(factors)
    exponent = np.zeros(count, int)
    while factors.shape[1] > 1:
        # groups of 16 factors in [1/2, 1) stay above 2**-16
        padded = np.hstack([factors, np.ones((count, -factors.shape[1] % 16))])
        shifts = np.frexp(np.abs(padded))[1]
        exponent += shifts.sum(axis=1)
        factors = np.prod((padded * np.ldexp(1.0, -shifts)).reshape(count, -1, 16), axis=2)
    return factors[:, 0], exponent


def from_logs(phase: Any, log: Float) -> tuple[Complex, NDArray[np.int_]]:
    """Product of each row's phase exp(log), the same way."""
    shifts = np.round(log / np.log(2.0))
    mantissa, exponent = products(phase * np.exp(log - shifts * np.log(2.0)))
    return mantissa, exponent + np.sum(shifts, axis=1).astype(int)
