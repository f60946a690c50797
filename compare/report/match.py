"""How far computed numbers are from printed ones."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

Complex = NDArray[np.complexfloating[Any, Any]]


def distance(z: Sequence[complex] | Complex, other: Sequence[complex] | Complex) -> float:
    """Largest |z - other| under the pairing with the smallest sum."""
    apart = np.abs(np.subtract.outer(np.asarray(z, complex), np.asarray(other, complex)))
    pairs = linear_sum_assignment(apart)
    return float(apart[pairs].max())


def paired(printed: Sequence[complex], z: Sequence[complex] | Complex) -> list[complex]:
    """`z` in the order of the printed ones; nothing where none is printed."""
    values = np.asarray(z, complex)
    return [complex(values[k]) for k in order(printed, values)] if printed else []


def order(printed: Sequence[complex], z: Sequence[complex] | Complex) -> list[int]:
    """Which of `z` each of the printed ones is."""
    apart = np.abs(np.subtract.outer(np.asarray(printed, complex), np.asarray(z, complex)))
    return [int(k) for k in linear_sum_assignment(apart)[1]]
