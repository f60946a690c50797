"""P(z) to more than 30 digits: the arbiter of the tests, in ball arithmetic.

It is loaded from where it is, beside the tests that hold it against known answers, rather than
written a second time here.
"""

from functools import cached_property
from importlib.util import module_from_spec, spec_from_file_location
from math import floor, log10
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.systems import Float, Points

ARBITER = Path(__file__).parents[1] / "tests" / "arbiter.py"


class Reference:
    """Reference polynomials of some points; needs python-flint.

    Parameters
    ----------
    points : Points
        Where; each takes a tenth of a second or more.
    refine : bool, optional
        Compute them again with twice the steps, to know how many digits are right.
    """

    def __init__(self, points: Points, refine: bool = True) -> None:
        self.points = points
        self.arbiter = _arbiter()
        self.truth = [self.arbiter.reference(e) for e in points.equations]
        self.refine = refine

    @cached_property
    def digits(self) -> int:
        """Digits, of the largest coefficient, to which two step lengths agree, radii included."""
        if not self.refine:
            return 0
        flint = self.arbiter.ctx
        worst = 0.0
        with flint.workprec(self.arbiter.BITS):
            for equation, truth in zip(self.points.equations, self.truth, strict=True):
                finer = self.arbiter.reference(equation, 2)
                size = max(float(abs(t)) for t in truth)
                apart = (abs(a - b).upper() for a, b in zip(truth, finer, strict=True))
                worst = max(worst, max(map(float, apart)) / size)
        return floor(-log10(max(worst, 1e-300)))

    def errors(self, P: Float) -> Float:
        """Largest coefficient error of each P, over the largest coefficient."""
        return np.array([self._error(p, t) for p, t in zip(P, self.truth, strict=True)])

    def _error(self, p: Float, truth: Any) -> float:
        size = max(abs(float(t)) for t in truth)
        if not np.all(np.isfinite(p)):
            return float("inf")
        return float(self.arbiter.largest_error([float(c) for c in p], truth)) / size


def _arbiter() -> Any:
    spec = spec_from_file_location("arbiter", ARBITER)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
