"""Small pictures as data: points on a sheet, for a template to write as SVG.

Nothing here knows what is drawn; `Frame` carries values to points of the sheet.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT = 420.0, 280.0
LEFT, RIGHT, TOP, BOTTOM = 62.0, 12.0, 12.0, 44.0
"""Margins, for the labels of the axes."""

MOST_TICKS = 6
DECIMALS_ACROSS, DECIMALS_UP = 6, 4
"""Of a tick's label at most, where there is as much room; powers of ten beyond."""

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

LETTER = 7.7
"""Dots that a digit is wide: .64 of the type's size in DejaVu Serif, as wide as any."""


@dataclass(frozen=True)
class Label:
    """Words at a point; `anchor` as SVG has it."""

    x: float
    y: float
    text: str
    anchor: str = "middle"


@dataclass(frozen=True)
class Curve:
    """A line through points, ``x,y x,y ...``; `look` is a class of the style sheet."""

    points: str
    look: str


@dataclass(frozen=True)
class Mark:
    """A mark at a point; `shape` is "dot", "ring" or "diamond"."""

    x: float
    y: float
    shape: str
    look: str
    says: str = ""
    """What is told where the pointer rests on it."""


@dataclass(frozen=True)
class Key:
    """One line of a legend."""

    look: str
    shape: str
    text: str


@dataclass(frozen=True)
class Picture:
    """A picture and what it shows in words.

    Attributes
    ----------
    name : str
        Unique on its page.
    title, description : str
        For those who do not see it.
    """

    name: str
    title: str
    description: str
    curves: tuple[Curve, ...] = ()
    marks: tuple[Mark, ...] = ()
    labels: tuple[Label, ...] = ()
    legend: tuple[Key, ...] = ()
    width: float = WIDTH
    height: float = HEIGHT


@dataclass(frozen=True)
class Frame:
    """A rectangle of values laid on the sheet."""

    low_x: float
    high_x: float
    low_y: float
    high_y: float
    width: float = WIDTH
    height: float = HEIGHT

    def x(self, value: float) -> float:
        """Across the sheet."""
        share = (value - self.low_x) / (self.high_x - self.low_x)
        return LEFT + share * (self.width - LEFT - RIGHT)

    def y(self, value: float) -> float:
        """Down the sheet."""
        share = (value - self.low_y) / (self.high_y - self.low_y)
        return self.height - BOTTOM - share * (self.height - BOTTOM - TOP)

    def curve(
        self,
        x: Sequence[float] | NDArray[np.floating[Any]],
        y: Sequence[float] | NDArray[np.floating[Any]],
        look: str,
    ) -> Curve:
        """A line through values, kept within the frame."""
        pairs = (
            (value, float(np.clip(height, self.low_y, self.high_y)))
            for value, height in zip(map(float, x), map(float, y), strict=True)
            if math.isfinite(value) and not math.isnan(height)
        )
        points = ((_tenths(self.x(a)), _tenths(self.y(b))) for a, b in pairs)
        return Curve(" ".join(f"{a},{b}" for a, b in points), look)

    def mark(self, x: float, y: float, shape: str, look: str, says: str = "") -> Mark:
        """A mark at values."""
        return Mark(round(self.x(x), 1), round(self.y(y), 1), shape, look, says)

    def axes(
        self, x_name: str, y_name: str, y_words: Sequence[tuple[float, str]] | None = None
    ) -> tuple[tuple[Curve, ...], tuple[Label, ...]]:
        """Lines and labels of both axes; `y_words` are ticks with words of their own."""
        bottom, right = self.height - BOTTOM, self.width - RIGHT
        box = f"{LEFT},{TOP} {LEFT},{bottom} {right},{bottom} {right},{TOP} {LEFT},{TOP}"
        curves, labels = [Curve(box, "frame")], []
        for value, words in _worded(self.low_x, self.high_x, DECIMALS_ACROSS):
            at = round(self.x(value), 1)
            curves.append(Curve(f"{at},{bottom} {at},{bottom - 4}", "frame"))
            labels.append(
                Label(min(at, self.width - 0.5 * LETTER * len(words)), bottom + 15, words)
            )
        own = _worded(self.low_y, self.high_y, DECIMALS_UP) if y_words is None else y_words
        for value, words in own:
            at = round(self.y(value), 1)
            curves.append(Curve(f"{LEFT},{at} {LEFT + 4},{at}", "frame"))
            labels.append(Label(LEFT - 6, at + 4, words, "end"))
        labels.append(Label(0.5 * (LEFT + right), self.height - 8, x_name))
        labels.append(Label(LEFT, TOP - 1, y_name, "end") if len(y_name) < 8 else _upright(y_name))
        return tuple(curves), tuple(labels)


def _tenths(value: float) -> str:
    """A tenth of a dot is not seen, and pages have many."""
    return f"{value:.1f}".removesuffix(".0")


def _upright(name: str) -> Label:
    return Label(14.0, 0.5 * (HEIGHT - BOTTOM + TOP), name, "upright")


def _worded(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """Ticks with as many decimals as tell them apart."""
    at = ticks(low, high)
    step = at[1] - at[0] if len(at) > 1 else high - low
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    if decimals > most or max(abs(low), abs(high)) >= 10.0 ** (most + 2):
        words = [_scientific(value) for value in at]
        if len(set(words)) == len(words):
            return list(zip(at, words, strict=True))
    return [(value, f"{value + 0.0:.{decimals}f}".replace("-", "−")) for value in at]


def _scientific(value: float) -> str:
    mantissa, _, exponent = f"{value:.3g}".partition("e")
    power = f"×{power_of_ten(int(exponent))}" if exponent else ""
    return f"{mantissa}{power}".replace("-", "−")


def power_of_ten(exponent: int) -> str:
    """In letters, 10⁻³: there are no small ones in a picture's words."""
    return "10" + str(exponent).translate(RAISED)


def ticks(low: float, high: float, most: int = MOST_TICKS) -> list[float]:
    """Round numbers within an interval: 1, 2 or 5 times a power of ten apart."""
    raw = (high - low) / most
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(power * k for k in (1.0, 2.0, 5.0, 10.0) if power * k >= raw * (1.0 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [k * step for k in range(first, last + 1)]
