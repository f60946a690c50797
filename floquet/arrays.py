"""What arrays are called here, an ulp of 1, and arrays that are shared."""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Bool = NDArray[np.bool_]
Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]

EPS = float(np.finfo(float).eps)

A = TypeVar("A", bound=NDArray[Any])


def frozen(array: A) -> A:
    """The array itself, which nobody may write to from now on: many have it."""
    array.flags.writeable = False
    return array
