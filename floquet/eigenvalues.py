"""Eigenvalues of a matrix whose characteristic polynomial is known to within an error."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complexfloating[Any]]
Float = NDArray[np.floating[Any]]


def eigenvalues(A: Float, error: float) -> tuple[Complex, Float]:
    """Eigenvalues by descending real part, and a radius about each that the true ones keep to.

    Rouche: where |P| exceeds the most its error can amount to, all round a circle, the true
    polynomial has as many roots inside as the computed one.
    """
    z = np.linalg.eigvals(A).astype(complex)
    z = z[np.lexsort((z.imag, -z.real))]
    radii = 2.0 ** np.arange(-52, 8)
    around = np.exp(2j * np.pi * np.arange(24) / 24)
    points = z[:, None, None] + radii[:, None] * around
    value = np.abs(np.prod(points[..., None] - z, axis=-1))
    # 24 points on a circle miss at most a factor cos(pi/24)^n of its smallest value
    allowed = 2.0 * error * np.sum(np.abs(points)[..., None] ** np.arange(len(z)), axis=-1)
    clear = np.all(value > allowed, axis=-1)
    first = np.where(clear.any(axis=1), clear.argmax(axis=1), len(radii) - 1)
    return z, radii[first]
