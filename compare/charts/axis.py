"""One varied parameter of a chart: its points, and the variable in which P(z) is smooth."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill import checks

Float = NDArray[np.floating[Any]]

MAX_POINTS = 50_000_000
"""Of a whole chart: T and the verdict of a point take 45 bytes, its error 8 more."""

MARGIN = 1.1
"""Factor by which the series reaches over the ends of Omega: a tongue is looked for in a window
about its resonance, and beyond the series P costs a hundred times as much."""


@dataclass(frozen=True)
class Axis:
    """`count` points of a parameter from `low` to `high`.

    Attributes
    ----------
    name : str
    low, high : float
    count : int
    smooth : {"value", "reciprocal", "ratio"}
        The variable of the series, as a `hill.Parameter` has it; of Omega always its reciprocal.

    Raises
    ------
    ValueError
        `low` not below `high`, or fewer than 2 points.
    """

    name: str
    low: float
    high: float
    count: int
    smooth: str = "value"

    def __post_init__(self) -> None:
        low = checks.number(f"{self.name} from", self.low)
        high = checks.number(f"{self.name} to", self.high)
        if checks.count(f"points of {self.name}", self.count, least=2) > MAX_POINTS:
            raise ValueError(
                f"points of {self.name} = {self.count}: must be at most {MAX_POINTS:,}"
            )
        if not low < high:
            raise ValueError(f"{self.name} from {low:g} to {high:g}: must ascend")
        if self.name == "Omega":
            checks.store(self, smooth="reciprocal")
        if self.smooth != "value" and low <= 0.0:
            raise ValueError(f"{self.name} from {low:g}: must be greater than 0")

    @property
    def points(self) -> Float:
        """Where the chart is evaluated."""
        return np.linspace(self.low, self.high, self.count)

    def to_smooth(self, value: Float, Omega: Any) -> Float:
        """The variable in which P(z) is smooth at `Omega`, and back: it is its own inverse."""
        if self.smooth == "value":
            return np.asarray(value, float)
        return (1.0 if self.smooth == "reciprocal" else Omega) / value

    @property
    def reach(self) -> tuple[float, float]:
        """What the series are made for: Omega wider than it is drawn, by `MARGIN`."""
        margin = MARGIN if self.name == "Omega" else 1.0
        return self.low / margin, self.high * margin
