"""Names of a picture's tongues, beside them: outside its frame, none on top of another."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import isotonic_regression

from compare.charts.axis import Axis
from compare.edges.tongue import Tongue
from compare.symbols import of_resonance

Float = NDArray[np.floating[Any]]

LINE_HEIGHT = 0.115
"""Inches that a name takes beside the next one."""

SIZE = 6.5

NEAR = 0.05
"""Share of the other axis from whose end a tongue is named outside too."""


@dataclass(frozen=True)
class Name:
    """What a tongue is called, where it leaves the chart or ends, and how wide it is there."""

    words: str
    Omega: float
    other: float
    width: float
    leaves: bool


def names(tongues: Sequence[Tongue], Omega: Axis, other: Axis) -> list[Name]:
    """One a tongue: at the far end of the other parameter, or the last place where it is seen."""
    found = []
    for tongue in tongues:
        low, high = np.maximum(tongue.lower, Omega.low), np.minimum(tongue.upper, Omega.high)
        seen = np.flatnonzero(low <= high)
        if len(seen):
            k = int(seen[-1])
            y, middle = float(tongue.y[k]), 0.5 * float(low[k] + high[k])
            leaves = y >= other.high - NEAR * (other.high - other.low)
            width = float(high[k] - low[k])
            found.append(Name(of_resonance(tongue.resonance), middle, y, width, leaves))
    return sorted(found, key=lambda name: -name.width)


def spread(wanted: Float, gap: float) -> Float:
    """Places within [0, 1], in the order of what is wanted, no nearer than `gap` to each other.

    The least squares of the distances from what is wanted.
    """
    if not len(wanted):
        return wanted
    order = np.argsort(wanted, kind="stable")
    apart = gap * np.arange(len(wanted))
    ascending = isotonic_regression(wanted[order] - apart).x
    result = np.empty(len(wanted))
    result[order] = np.clip(ascending, 0.0, max(1.0 - apart[-1], 0.0)) + apart
    return result


def write_names(
    axes: Any, tongues: Sequence[Tongue], x: Axis, y: Axis, log: Collection[str], length: float
) -> None:
    """Over the frame, or beside it where Omega runs upwards, a line from each to its tongue.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    tongues : sequence of Tongue
    x, y : Axis
        One of them Omega's.
    log : collection of str
    length : float
        Inches of the frame along Omega.
    """
    upright = x.name == "Omega"
    Omega, other = (x, y) if upright else (y, x)
    gap = LINE_HEIGHT / length
    every = names(tongues, Omega, other)
    leaving = [name for name in every if name.leaves][: int(1.0 / gap)]
    ends = np.array([name.Omega for name in leaving])
    places = spread(_share(ends, Omega, Omega.name in log), gap)
    for name, place in zip(leaving, places, strict=True):
        axes.annotate(
            name.words,
            (name.Omega, 1.0) if upright else (1.0, name.Omega),
            xycoords=("data", "axes fraction") if upright else ("axes fraction", "data"),
            xytext=(place, 1.035) if upright else (1.025, place),
            textcoords="axes fraction",
            rotation=90 if upright else 0,
            ha="center" if upright else "left",
            va="bottom" if upright else "center",
            fontsize=SIZE,
            arrowprops={"arrowstyle": "-", "lw": 0.4, "shrinkA": 0.5, "shrinkB": 0.0},
            annotation_clip=False,
        )
    for name in every:
        if not name.leaves:
            axes.annotate(
                name.words,
                (name.Omega, name.other) if upright else (name.other, name.Omega),
                xytext=(4, 4),
                textcoords="offset points",
                fontsize=SIZE,
                bbox={"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.8},
            )


def _share(values: Float, axis: Axis, log: bool) -> Float:
    low, high = float(axis.low), float(axis.high)
    if log:
        values, low, high = np.log(values), float(np.log(low)), float(np.log(high))
    return (values - low) / (high - low)
