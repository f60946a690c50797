"""What arrays are called here, and an ulp of 1."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Bool = NDArray[np.bool_]
Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]

EPS = float(np.finfo(float).eps)
