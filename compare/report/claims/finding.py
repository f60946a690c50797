"""What the check of one claim returns, and the register of the checks."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Verdict = Literal["confirmed", "qualified", "refuted"]
VERDICTS: tuple[Verdict, ...] = ("confirmed", "qualified", "refuted")

VISIBLE = 0.05
"""What the report's eye could see: its figures are drawn on paper of 20 squares to the inch, and a
region of instability an inch or so in radius shows a departure of one square, a twentieth."""

PRINTED = 5e-6
"""Half a unit of the last printed digit of T."""


@dataclass(frozen=True)
class Number:
    """One number a verdict rests on.

    Attributes
    ----------
    label : str
    hill, floquet : float or None
        By either route; `floquet` is None where there is only one way (arithmetic, a formula, the
        truncated determinant).
    digits : int
        Decimals worth printing.
    """

    label: str
    hill: float
    floquet: float | None
    digits: int

    @property
    def texts(self) -> tuple[str, str]:
        """Both values, rounded; the second is empty where there is none."""
        return _rounded(self.hill, self.digits), (
            "" if self.floquet is None else _rounded(self.floquet, self.digits)
        )


@dataclass(frozen=True)
class Finding:
    """What was computed for a claim, and the verdict that its rule draws from it."""

    numbers: tuple[Number, ...]
    verdict: Verdict
    because: str


CHECKS: dict[str, Callable[[], Finding]] = {}
"""The check of every claim, by id."""


def check_for(name: str) -> Callable[[Callable[[], Finding]], Callable[[], Finding]]:
    """Register a function as the check of a claim."""

    def register(check: Callable[[], Finding]) -> Callable[[], Finding]:
        CHECKS[name] = check
        return check

    return register


def graded(confirmed: bool, qualified: bool) -> Verdict:
    """The first verdict whose condition holds."""
    if confirmed:
        return "confirmed"
    return "qualified" if qualified else "refuted"


def share(value: float) -> str:
    """A fraction in per cent, two digits: 0.034 is "3.4 %"."""
    percent = 100.0 * value
    return f"{percent:.0f} %" if abs(percent) >= 9.95 else f"{percent:.2g} %"


def _rounded(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}"
    return text.lstrip("-") if float(text) == 0.0 else text
