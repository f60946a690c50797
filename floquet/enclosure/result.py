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
