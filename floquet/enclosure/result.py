"""What is enclosed."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Enclosure:
    """Balls that hold the true values; balls are of python-flint, arb and acb.

    Attributes
    ----------
    polynomial : tuple of arb
        Of z, or of the multipliers; monic, highest power first.
    of : {"z", "multipliers"}
    roots : tuple of acb
        A ball about each root.
    simple : bool
        Whether the balls are apart, each with one root.
    T : arb
        Characteristic argument (7.1.1).
    verdict : {"stable", "unstable", "undecided"}
        Proven, or undecided.
    decimals : bool
        Whether it is of parameters as they are written, matrices included; otherwise of floats.
    """

    polynomial: tuple[Any, ...]
    of: Literal["z", "multipliers"]
    roots: tuple[Any, ...]
    simple: bool
    T: Any
    verdict: Literal["stable", "unstable", "undecided"]
    decimals: bool

    @property
    def radius(self) -> float:
        """Largest radius of P's coefficients."""
        return max(float(c.rad()) for c in self.polynomial)


@dataclass(frozen=True)
class IntervalProof:
    """What is proven of every Omega of an interval.

    Attributes
    ----------
    Omega : tuple of float
        The interval's ends.
    parts : tuple of (float, float, str)
        Ascending in Omega, without a gap: ends, and "stable", "unstable" or "undecided"; the ends
        are rounded to floats.
    verdict : {"stable", "unstable", "both", "undecided"}
        Of every Omega in it; "both": some are proven stable and some unstable.
    nodes : int
        At how many Omega P was enclosed.
    remainder : float
        Bound on what the polynomial through them leaves out of P's coefficients.
    """

    Omega: tuple[float, float]
    parts: tuple[tuple[float, float, str], ...]
    nodes: int
    remainder: float

    @property
    def verdict(self) -> Literal["stable", "unstable", "both", "undecided"]:
        """What holds all over it."""
        kinds = {kind for _, _, kind in self.parts}
        if kinds >= {"stable", "unstable"}:
            return "both"
        if "undecided" in kinds or len(kinds) != 1:
            return "undecided"
        return "stable" if kinds == {"stable"} else "unstable"

    def share(self, kind: str) -> float:
        """Of the interval, of one kind."""
        total = sum(high - low for low, high, found in self.parts if found == kind)
        return total / (self.Omega[1] - self.Omega[0])


@dataclass(frozen=True, eq=False)
class RegionProof:
    """What is proven of the cells of a grid in Omega and gamma.

    Attributes
    ----------
    Omega, gamma : tuple of float
        Edges of the cells, ascending; (columns + 1,) and (rows + 1,).
    cells : (rows, columns) ndarray of str
        "stable" or "unstable" where that is proven of every point of the closed cell, else
        "undecided".
    areas : dict of str to (rows, columns) ndarray
        How much of each cell, in Omega times gamma, is proven "stable" and "unstable" part by part,
        and how much is "undecided".
    nodes : int
        At how many points P was enclosed.
    remainder : float
        Bound on what the polynomial through them leaves out of P's coefficients.
    """

    Omega: tuple[float, ...]
    gamma: tuple[float, ...]
    cells: NDArray[np.str_]
    areas: Mapping[str, NDArray[np.floating[Any]]]
    nodes: int
    remainder: float

    def share(self, kind: str) -> float:
        """Of the rectangle, of one kind."""
        return float(self.areas[kind].sum() / sum(area.sum() for area in self.areas.values()))

    @property
    def whole(self) -> float:
        """Share of the cells that are proven as a whole."""
        return float(np.mean(self.cells != "undecided"))
