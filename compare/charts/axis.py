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
    smooth : {"value", "reciprocal"}
        The variable of the series, as a `hill.Parameter` has it; of Omega always its reciprocal,
        since P depends on it through F/Omega^2 and G/Omega^2.

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
        if self.smooth == "reciprocal" and low <= 0.0:
            raise ValueError(f"{self.name} from {low:g}: must be greater than 0")

    @property
    def points(self) -> Float:
        """Where the chart is evaluated."""
        return np.linspace(self.low, self.high, self.count)

    def to_smooth(self, value: Float) -> Float:
        """The variable in which P(z) is smooth."""
        return 1.0 / value if self.smooth == "reciprocal" else np.asarray(value, float)

    def from_smooth(self, value: Float) -> Float:
        """Back again."""
        return self.to_smooth(value)

    @property
    def span(self) -> tuple[float, float]:
        """The axis in its smooth variable, ascending; Omega wider than it is drawn, by `MARGIN`."""
        margin = MARGIN if self.name == "Omega" else 1.0
        ends = (self.low / margin, self.high * margin)
        low, high = sorted(float(self.to_smooth(np.asarray(value))) for value in ends)
        return low, high

    @property
    def drawn(self) -> tuple[float, float]:
        """The axis as it is drawn, in its smooth variable, ascending."""
        low, high = sorted(
            float(self.to_smooth(np.asarray(value))) for value in (self.low, self.high)
        )
        return low, high


def to_smooth(axes: tuple[Axis, ...], values: Float) -> Float:
    """Parameters (k, axes) in the variables in which P is smooth."""
    return np.column_stack([a.to_smooth(x) for a, x in zip(axes, values.T, strict=True)])


def from_smooth(axes: tuple[Axis, ...], smooth: Float) -> Float:
    """Back again."""
    return np.column_stack([a.from_smooth(x) for a, x in zip(axes, smooth.T, strict=True)])
