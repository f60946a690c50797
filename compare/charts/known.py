"""Evaluations that a chart's series have been given so far."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.floating[Any]]

Sampler = Callable[[Float], tuple[Float, Float]]
"""Smooth coordinates (k, axes) to coefficients of P (k, n + 1), highest first, and their errors."""


class Known:
    """Evaluations so far, so that nested points are not computed twice."""

    def __init__(self, sample: Sampler, low: Float, high: Float) -> None:
        self.sample, self.low, self.high = sample, low, high
        self.values: dict[bytes, tuple[Float, float]] = {}

    def on(self, grid: list[Float]) -> tuple[Float, Float]:
        """Coefficients of P below the leading one, on a grid: (n, *grid), and their errors."""
        points = np.stack([m.ravel() for m in np.meshgrid(*grid, indexing="ij")], axis=1)
        # nested points come out of different formulas: equal to twelve digits is the same point
        share = np.round((points - self.low) / (self.high - self.low), 12) + 0.0  # no -0
        keys = [line.tobytes() for line in share]
        new = [i for i, key in enumerate(keys) if key not in self.values]
        if new:
            found, errors = self.sample(points[new])
            for i, value, error in zip(new, found, errors, strict=True):
                self.values[keys[i]] = (value[1:], float(error))
        table = np.array([self.values[key][0] for key in keys])
        bounds = np.array([self.values[key][1] for key in keys])
        shape = [len(x) for x in grid]
        return table.T.reshape(-1, *shape), bounds
