"""The variables in which a chart's P is smooth, and what of the chart lies in a rectangle of them.

Omega goes as 1/Omega, since P depends on it through F/Omega^2 and G/Omega^2. A parameter that the
system knows only by what Omega is of it, as the axial force knows omega_L, goes as that ratio: the
poles, Omega = k omega_L, are then straight and parallel to an axis. A chart of both is no rectangle
in these variables; each line of constant Omega is one.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.axis import Axis

Float = NDArray[np.floating[Any]]
Int = NDArray[np.int_]
Where = tuple[Any, ...]
"""Of an array on the grid: slices, or integers that are broadcast against each other."""

# What a quotient and the way back are rounded by, with much in hand: a corner stays in.
ROUNDED = 1e-12


def shape_of(where: Where) -> tuple[int, ...]:
    """Of what is picked."""
    if all(isinstance(w, slice) for w in where):
        return tuple(w.stop - w.start for w in where)
    return np.broadcast_shapes(*(w.shape for w in where))


@dataclass(frozen=True, eq=False)
class Part:
    """Points of a chart's grid.

    Attributes
    ----------
    chosen : tuple of int ndarray
        Which along each axis; of the skew one all that are in some row.
    rows, columns : int
        The axes of which the second has others chosen for each point of the first; equal where
        there are none.
    first, counts : (points along `rows`,) int ndarray
        Which of the columns' axis are chosen for each row: so many, one after another.
    """

    chosen: tuple[Int, ...]
    rows: int = 0
    columns: int = 0
    first: Int | None = None
    counts: Int | None = None

    @property
    def count(self) -> int:
        """How many points."""
        if self.counts is None:
            return math.prod(map(len, self.chosen))
        return int(self.counts.sum()) * math.prod(len(c) for c in self.others)

    @property
    def others(self) -> list[Int]:
        """What is chosen along axes of which every point goes with every row."""
        return [c for k, c in enumerate(self.chosen) if k not in (self.rows, self.columns)]

    def where(self, rows: slice = slice(None)) -> Where:
        """What picks the points of some rows, or all, out of an array on the grid."""
        if self.first is None or self.counts is None:
            # the points of an axis in a rectangle are neighbours
            return tuple(slice(int(c[0]), int(c[-1]) + 1) for c in self.chosen)
        first, counts = self.first[rows], self.counts[rows]
        ends = np.cumsum(counts)
        within = np.arange(ends[-1]) - np.repeat(ends - counts, counts)
        pair, *mesh = np.ix_(np.arange(len(within)), *self.others)
        own = {
            self.rows: np.repeat(self.chosen[self.rows][rows], counts)[pair],
            self.columns: (np.repeat(first, counts) + within)[pair],
        }
        found = iter(mesh)
        return tuple(own[k] if k in own else next(found) for k in range(len(self.chosen)))


@dataclass(frozen=True)
class Smooth:
    """The axes of a chart in their smooth variables.

    Attributes
    ----------
    axes : tuple of Axis
        One of them at most is a ratio.
    Omega : float
        The forcing's, where it is no axis; nan where it is.
    """

    axes: tuple[Axis, ...]
    Omega: float = float("nan")

    @cached_property
    def _forcing(self) -> int | None:
        """Omega's axis."""
        return next((k for k, axis in enumerate(self.axes) if axis.name == "Omega"), None)

    @cached_property
    def ratio(self) -> int | None:
        """The axis that goes as a ratio."""
        return next((k for k, axis in enumerate(self.axes) if axis.smooth == "ratio"), None)

    @cached_property
    def skew(self) -> tuple[int, int] | None:
        """Omega's axis and the one whose smooth variable moves with Omega too, if there is one."""
        if self._forcing is None or self.ratio is None:
            return None
        return self._forcing, self.ratio

    def to_smooth(self, values: Float) -> Float:
        """Parameters (k, axes) in the variables in which P is smooth."""
        Omega = self.Omega if self._forcing is None else values[:, self._forcing]
        return self._each(values, Omega)

    def from_smooth(self, smooth: Float) -> Float:
        """Back again: each variable is its own inverse."""
        Omega = self.Omega if self._forcing is None else 1.0 / smooth[:, self._forcing]
        return self._each(smooth, Omega)

    def _each(self, values: Float, Omega: Any) -> Float:
        columns = (axis.to_smooth(x, Omega) for axis, x in zip(self.axes, values.T, strict=True))
        return np.column_stack(list(columns))

    @cached_property
    def span(self) -> tuple[Float, Float]:
        """The smallest rectangle that holds the chart, Omega wider than it is drawn."""
        return self.rectangle([axis.reach for axis in self.axes])

    def rectangle(self, ends: list[tuple[float, float]]) -> tuple[Float, Float]:
        """The smallest that holds a box of parameters, given by the ends of each."""
        Omega = (self.Omega,) if self._forcing is None else ends[self._forcing]
        sides = [
            [float(axis.to_smooth(np.asarray(x), of)) for x in own for of in Omega]
            for axis, own in zip(self.axes, ends, strict=True)
        ]
        return np.array([min(side) for side in sides]), np.array([max(side) for side in sides])

    def kept(self, low: Float, high: Float) -> tuple[Float, Float] | None:
        """The smallest rectangle that holds all that there is of the chart in one; None: nothing.

        There may be more of Omega in it than of its axis.
        """
        if self.skew is None:
            return low, high
        i, j = self.skew
        (first, last), a, b = self.axes[j].reach, low.copy(), high.copy()
        less, more = 1.0 - ROUNDED, 1.0 + ROUNDED
        a[j] = max(low[j], less / (high[i] * last))
        b[j] = min(high[j], more / (low[i] * first))
        a[i] = max(low[i], less / (high[j] * last))
        b[i] = min(high[i], more / (low[j] * first))
        return (a, b) if np.all(a < b) else None

    @cached_property
    def points(self) -> list[Float]:
        """Of the grid, along each axis; of a skew one the parameter itself."""
        own = None if self.skew is None else self.skew[1]
        return [
            axis.points if k == own else axis.to_smooth(axis.points, self.Omega)
            for k, axis in enumerate(self.axes)
        ]

    def part(self, low: Float, high: Float) -> Part | None:
        """Which points of the chart's grid lie in a rectangle; None where none do."""
        chosen = [
            np.flatnonzero((points >= a) & (points <= b))
            for points, a, b in zip(self.points, low, high, strict=True)
        ]
        if self.skew is None:
            return Part(tuple(chosen)) if all(map(len, chosen)) else None
        i, j = self.skew
        own, Omega = self.points[j], self.axes[i].points[chosen[i]]
        if not len(Omega):
            return None
        # one more to either side than there should be
        start = max(int(np.searchsorted(own, Omega[0] / high[j])) - 1, 0)
        end = int(np.searchsorted(own, Omega[-1] / low[j])) + 1
        ratio = self.axes[j].to_smooth(own[start:end], Omega[:, None])
        inside = (ratio >= low[j]) & (ratio <= high[j])
        counts = np.count_nonzero(inside, axis=1)
        there = np.flatnonzero(counts)
        first = start + np.argmax(inside, axis=1)[there]
        chosen[i], chosen[j] = chosen[i][there], np.arange(start, min(end, len(own)))
        if not all(map(len, chosen)):
            return None
        return Part(tuple(chosen), i, j, first, counts[there])

    def ratios(self, rows: Int, columns: Int) -> Float:
        """The skew axis' smooth variable at points of its grid and Omega's."""
        assert self.skew is not None
        i, j = self.skew
        return self.axes[j].to_smooth(self.points[j][columns], self.axes[i].points[rows])

    def scattered(self, shares: Float) -> Float:
        """Smooth coordinates of points within what is drawn, from their shares of each axis."""
        ends = np.array([[axis.low, axis.high] for axis in self.axes])
        Omega: Any = self.Omega
        if self._forcing is not None:
            low, high = 1.0 / ends[self._forcing, ::-1]
            Omega = 1.0 / (low + (high - low) * shares[:, self._forcing])
        found = np.empty_like(shares)
        for k, axis in enumerate(self.axes):
            both = [np.asarray(axis.to_smooth(np.asarray(x), Omega)) for x in ends[k]]
            low, high = np.minimum(*both), np.maximum(*both)
            found[:, k] = low + (high - low) * shares[:, k]
        return found
