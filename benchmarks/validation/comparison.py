"""A number that somebody else printed, and both routes' for the same thing."""

from dataclasses import dataclass
from decimal import Decimal

# Units of the last printed digit: rounded, or cut off, or rounded twice.
ROUNDED = 0.5
WITHIN = 1.0


@dataclass(frozen=True)
class Comparison:
    """One number.

    Attributes
    ----------
    what : str
        Of which system, which quantity.
    printed : str
        As its source has it, digit by digit.
    hill, floquet : float or None
        By each route; None where only the other has it.
    rounding : float
        What the routes' arithmetic may add, in the number's own unit.
    """

    what: str
    printed: str
    hill: float | None
    floquet: float | None
    rounding: float = 0.0

    @property
    def unit(self) -> float:
        """Of the last printed digit."""
        return 10.0 ** int(Decimal(self.printed).as_tuple().exponent)

    @property
    def ours(self) -> list[float]:
        """What there is of the two."""
        return [value for value in (self.hill, self.floquet) if value is not None]

    @property
    def off(self) -> float:
        """The larger distance from the printed number, in units of its last digit."""
        outside = float(self.printed)
        return max(abs(value - outside) for value in self.ours) / self.unit

    @property
    def found(self) -> str:
        """How the printed number comes back."""
        allowed = self.rounding / self.unit
        if self.off <= ROUNDED + allowed:
            return "yes"
        return "to a unit" if self.off < WITHIN + allowed else "**no**"

    def cells(self) -> list[str]:
        """Of a table: two digits more than printed, as far as a float has them."""
        decimals = max(0, -int(Decimal(self.printed).as_tuple().exponent)) + 1
        ours = [
            "-" if value is None else f"{round(value, decimals) + 0.0:.{min(decimals, 15)}f}"
            for value in (self.hill, self.floquet)
        ]
        return [self.what, self.printed, *ours, self.found]


@dataclass(frozen=True)
class Source:
    """A source and its numbers."""

    title: str
    words: str
    numbers: tuple[Comparison, ...]
