"""A tongue: two edges along a second parameter; its sections; why it goes no further."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.averaging import Resonance

Float = NDArray[np.floating[Any]]
Pair = tuple[float, float]

# A tip's distance from the middle of the section next to it, in that one's widths: 0.9 at most over
# 60 tips of the report's two beams, along gamma, T0 and K_theta; 2.5 and more where the deepest
# point in the window was another tongue's.
DRIFT = 1.5
# From one section to the next the middle, measured from the resonance, moves by so many widths, or
# by this share of Omega where it is narrow: by 0.005 of Omega at most where it moved farther than
# 1.5 widths, in 80 tongues of the same charts; by half of Omega where it was another's edges.
JUMP = 0.02

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


def continues(before: Section, here: Section) -> bool:
    """Whether two sections with edges can be the same tongue's."""
    if here.edges is None:
        return True
    (a, b), (c, d) = before.offsets, here.offsets
    return 0.5 * abs(c + d - a - b) <= max(DRIFT * max(b - a, d - c), JUMP * here.Omega)


def continued(before: Sequence[Section], y: float) -> Pair | None:
    """Offsets continued in a straight line from the last two sections."""
    if len(before) < 2:
        return before[0].offsets if before else None
    first, last = before[-2:]
    if last.y == first.y:  # a tip upon a station
        return last.offsets
    t = min(1.0, (y - last.y) / (last.y - first.y))
    low, high = (b + t * (b - a) for a, b in zip(first.offsets, last.offsets, strict=True))
    return (low, high) if low < high else last.offsets
