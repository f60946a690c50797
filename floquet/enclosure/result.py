"""What is enclosed."""

from dataclasses import dataclass
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
