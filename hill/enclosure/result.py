"""What is enclosed."""

from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True, eq=False)
class Enclosure:
    """Balls that hold the true values; balls are of python-flint, arb and acb.

    Attributes
    ----------
    polynomial : tuple of arb
        P(z), monic, highest power first.
    roots : tuple of acb
        Balls that hold all roots z, each connected set of them as many as it has balls.
    T : arb
        Characteristic argument (7.1.1).
    verdict : {"stable", "unstable", "undecided"}
        Proven, or undecided.
    decimals : bool
        Whether it is of parameters as they are written, matrices included; otherwise of floats.
    harmonics : int
        Folded one by one on each side; the rest is in the tail.
    tail : float
        Radius of the tail's ball, of the logarithm of the determinant.
    """

    polynomial: tuple[Any, ...]
    roots: tuple[Any, ...]
    T: Any
    verdict: Literal["stable", "unstable", "undecided"]
    decimals: bool
    harmonics: int
    tail: float

    @property
    def radius(self) -> float:
        """Largest radius of P's coefficients."""
        return max(float(c.rad()) for c in self.polynomial)
