"""P(z) to more than 40 digits, by the arbiter of the trial (`benchmarks.honesty`); needs flint."""

from functools import cached_property
from math import floor, log10
from typing import Any

import numpy as np

from benchmarks.systems import Float, Points


class Reference:
    """Reference polynomials of some points.

    Parameters
    ----------
    points : Points
        Where; each takes some hundredths of a second.
    """

    def __init__(self, points: Points) -> None:
        from benchmarks.honesty import arbiter

        self.points = points
        self.arbiter = arbiter
        self.truth = [arbiter.reference(e) for e in points.equations]

    @cached_property
    def digits(self) -> int:
        """Digits, of the largest coefficient, to which the balls know each P."""
        shares = (
            max(float(t.rad()) for t in truth) / max(float(abs(t)) for t in truth)
            for truth in self.truth
        )
        return floor(-log10(max(*shares, 1e-300)))

    def errors(self, P: Float) -> Float:
        """Largest coefficient error of each P, over the largest coefficient."""
        return np.array([self._error(p, t) for p, t in zip(P, self.truth, strict=True)])

    def _error(self, p: Float, truth: Any) -> float:
        size = max(abs(float(t)) for t in truth)
        if not np.all(np.isfinite(p)):
            return float("inf")
        return float(self.arbiter.largest_error([float(c) for c in p], truth)) / size
