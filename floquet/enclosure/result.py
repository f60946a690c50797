"""What is enclosed."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal


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


@dataclass(frozen=True)
class RegionProof:
    """What is proven of every point of a rectangle of Omega and gamma.

    Attributes
    ----------
    Omega, gamma : tuple of float
        Ends.
    strips : tuple of (float, float, parts)
        Ascending: gamma's ends, and parts in Omega as of an `IntervalProof`, each for every gamma
        of the strip.
    """

    Omega: tuple[float, float]
    gamma: tuple[float, float]
    strips: tuple[tuple[float, float, tuple[tuple[float, float, str], ...]], ...]

    def share(self, kind: str) -> float:
        """Of the rectangle, of one kind."""
        total = sum(
            (b - a) * (high - low)
            for a, b, parts in self.strips
            for low, high, found in parts
            if found == kind
        )
        area = (self.Omega[1] - self.Omega[0]) * (self.gamma[1] - self.gamma[0])
        return total / area

    def cells(self, columns: int) -> tuple[tuple[str, ...], ...]:
        """A verdict a cell, strips by equal columns of Omega: what holds at every point of it."""
        low, high = self.Omega
        edges = [low + (high - low) * i / columns for i in range(columns + 1)]
        return tuple(
            tuple(
                next((kind for c, d, kind in parts if c <= a and b <= d), "undecided")
                for a, b in pairwise(edges)
            )
            for _, _, parts in self.strips
        )
