"""A tongue: two edges along a second parameter; its sections; why it goes no further."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.averaging import Resonance

Float = NDArray[np.floating[Any]]
Pair = tuple[float, float]

RANGE, TIP = "the end of the range", "its edges meet"
NOT_REAL = "the natural frequencies are not real"
UNSEEN = "no edges are seen; it may be narrower than the error of P"
"""Why a tongue goes no further."""


@dataclass(frozen=True, eq=False)
class Tongue:
    """One instability's boundary: two edges in Omega at each y, equal where it closes.

    Attributes
    ----------
    resonance : Resonance
    y, lower, upper : (k,) ndarray
    begins, ends : str
        Why it goes no further at its first and its last y.
    """

    resonance: Resonance
    y: Float
    lower: Float
    upper: Float
    begins: str = RANGE
    ends: str = RANGE

    def at(self, y: float) -> Pair | None:
        """Edges at y by straight lines; None beyond its ends."""
        if not self.y[0] <= y <= self.y[-1]:
            return None
        return float(np.interp(y, self.y, self.lower)), float(np.interp(y, self.y, self.upper))


@dataclass(frozen=True)
class Section:
    """A tongue at one y: edges if it is there, and its deepest point."""

    y: float
    Omega: float
    edges: Pair | None
    bottom: float
    depth: float

    @property
    def offsets(self) -> Pair:
        """Edges from the resonance."""
        lower, upper = self.edges or (self.bottom, self.bottom)
        return lower - self.Omega, upper - self.Omega


@dataclass(frozen=True)
class Gap:
    """No section here, and why."""

    why: str
