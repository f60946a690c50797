"""How a rectangle of a chart is cut where one series will not do."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.floating[Any]]

MAX_CUTS = 7
"""Cuts of one axis; a piece is then 1/128 of the chart."""

MAX_GRADED = 30
"""Cuts towards poles that are straight: points that are left then are on the pole itself."""


@dataclass(frozen=True)
class Cut:
    """A rectangle is to be cut across this axis, and why it has no series as it is.

    Attributes
    ----------
    axis : int
    why : str
    at : float, optional
        Where; in the middle if nothing is said.
    graded : bool
        A pole runs straight across this axis, so that every cut leaves half of the rectangle, or
        all of it but the pole, without one.
    """

    axis: int
    why: str
    at: float | None = None
    graded: bool = False


@dataclass(frozen=True, eq=False)
class Uncovered:
    """A rectangle still to be covered.

    Attributes
    ----------
    low, high : (axes,) ndarray
    cuts : tuple of int
        Of each axis, on the way to it; but for graded ones.
    graded : int
        Those.
    share : float
        Of all that is to be covered.
    why : str
        What it was cut for.
    """

    low: Float
    high: Float
    cuts: tuple[int, ...]
    graded: int = 0
    share: float = 1.0
    why: str = ""

    def may_be(self, cut: Cut) -> bool:
        """Whether it has not been cut too often already."""
        return self.graded < MAX_GRADED if cut.graded else self.cuts[cut.axis] < MAX_CUTS

    def cut(self, low: Float, high: Float, by: Cut) -> "list[Uncovered]":
        """Two that cover it from `low` to `high`, which is all of it that counts."""
        k = by.axis
        at = 0.5 * (low[k] + high[k]) if by.at is None else by.at
        left, right = high.copy(), low.copy()
        left[k] = right[k] = at
        cuts = tuple(c + (j == k and not by.graded) for j, c in enumerate(self.cuts))
        part = self.share * float((at - low[k]) / (high[k] - low[k]))
        return [
            Uncovered(a, b, cuts, self.graded + by.graded, share, by.why)
            for a, b, share in ((right, high, self.share - part), (low, left, part))
        ]
