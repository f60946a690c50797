"""T and the verdict at every pixel of a picture, whatever the chart's own points are."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.axis import Axis
from compare.charts.compute import argument
from compare.charts.result import Chart

Float = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class _Spaced(Axis):
    """The middles of `count` pixels, equal ones or of equal ratio."""

    log: bool = False

    @property
    def edges(self) -> Float:
        """Between the pixels, one more of them."""
        spaced = np.geomspace if self.log else np.linspace
        return np.asarray(spaced(self.low, self.high, self.count + 1))

    @property
    def points(self) -> Float:
        """Where the pixels are evaluated."""
        low, high = self.edges[:-1], self.edges[1:]
        return np.sqrt(low * high) if self.log else 0.5 * (low + high)


@dataclass(frozen=True, eq=False)
class Pixels:
    """A chart at a picture's pixels.

    Attributes
    ----------
    edges : tuple of ndarray
        Between the pixels, along each axis.
    points : tuple of ndarray
        Their middles.
    T : ndarray
        The last axis comes first, as in a chart.
    verdict : ndarray of str
    unproven : ndarray of bool
        Where it was to be proven of the chart's cell as a whole, and was not.
    """

    edges: tuple[Float, ...]
    points: tuple[Float, ...]
    T: Float
    verdict: NDArray[np.str_]
    unproven: NDArray[np.bool_]


def pixels(chart: Chart, counts: tuple[int, ...], log: Collection[str] = ()) -> Pixels:
    """Evaluate the chart's series at every pixel; where there is none, its nearest point's values.

    Parameters
    ----------
    chart : Chart
    counts : tuple of int
        Pixels along each axis.
    log : collection of str, optional
        Axes along which the pixels have equal ratios.
    """
    axes = tuple(
        _Spaced(a.name, a.low, a.high, count, a.smooth, a.name in log)
        for a, count in zip(chart.axes, counts, strict=True)
    )
    finer = replace(chart.scenario, axes=axes)
    T = argument(chart.surface, (), finer)
    shown = replace(chart, scenario=finer, T=T, alone=())
    verdict = shown.verdict().copy()
    near = [_nearest(own, axis.points) for own, axis in zip(chart.axes, axes, strict=True)]
    nearest = np.ix_(*reversed(near))
    unproven = np.zeros(T.shape, bool)
    if chart.certified is not None:
        unproven = chart.certified.cells[nearest] == "undecided"
    without = np.isnan(T)
    if np.any(without):
        T = np.where(without, chart.T[nearest], T)
        verdict = np.where(without, chart.verdict()[nearest], verdict)
    return Pixels(
        tuple(a.edges for a in axes),
        tuple(a.points for a in axes),
        T,
        np.asarray(verdict),
        unproven,
    )


def _nearest(axis: Axis, values: Float) -> NDArray[np.int_]:
    share = (values - axis.low) / (axis.high - axis.low)
    return np.asarray(np.rint(share * (axis.count - 1)), int)
