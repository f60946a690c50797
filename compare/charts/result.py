"""A chart: T on its grid, and the solution anywhere in it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compare.charts import chebyshev, nodes, surface
from compare.charts.parameters import Axis, Family
from compare.charts.points import Points, solve, verdicts
from compare.stability.roots import growth

Float = NDArray[np.floating[Any]]

DIRECT = 4096
"""Points evaluated together where there is no series."""


@dataclass(frozen=True, eq=False)
class Chart:
    """T over a grid of parameters.

    Attributes
    ----------
    axes : tuple of Axis
        The first is the fastest to vary when drawn: x, then y.
    family : Family
        The beam and what is fixed.
    T : ndarray
        Characteristic argument (7.1.1), shape (..., points of y, points of x).
    error : float
        Bound on the absolute error of the interpolated coefficients of P; of those evaluated
        directly where none is interpolated.
    checked : float or None
        Largest difference from direct evaluation at random points; never above `error`. None where
        nothing could be checked.
    checks : int
        At how many random points.
    disagreement : float
        Largest difference between the two routes at the nodes, over the largest coefficient of P;
        nan where only one route was asked.
    sampled : (nodes, axes) ndarray
        Where P was evaluated.
    apart : (nodes,) ndarray
        Difference between the two routes there, as `disagreement`.
    direct : int
        Grid points evaluated one by one, where no series would converge.
    resumed : int
        Nodes that were already on disk.
    route : str
        Who evaluated the nodes.
    surface : Surface
        The interpolant, for further use.
    seconds : float
        Time taken, nodes included.
    """

    axes: tuple[Axis, ...]
    family: Family
    T: Float
    error: float
    checked: float | None
    checks: int
    disagreement: float
    sampled: Float
    apart: Float
    direct: int
    resumed: int
    route: str
    surface: surface.Surface
    seconds: float

    @property
    def nodes(self) -> int:
        """Evaluations of P."""
        return len(self.sampled)

    def at(self, **values: ArrayLike) -> Points:
        """z, R, T and the verdict at any points within the axes.

        Parameters
        ----------
        **values : array_like
            One for each axis, by its name; broadcast against each other to k points.

        Raises
        ------
        ValueError
            An axis without values, a name that is no axis, a value beyond its ends; a point on an
            undamped longitudinal resonance.
        """
        return _at(self, values)

    @cached_property
    def _verdict(self) -> NDArray[np.str_]:
        return _verdicts(self)

    def verdict(self) -> NDArray[np.str_]:
        """What is shown on the grid, like `T`: "stable", "unstable" or "undecided".

        Undecided next to boundaries, on undamped lines where z meet (gamma = 0 at a resonance), and
        on a longitudinal resonance, where there is no equation.
        """
        return self._verdict

    def unstable(self) -> NDArray[np.bool_]:
        """Where on the grid the system is shown to be unstable, like `T`."""
        return np.asarray(self._verdict == "unstable")

    def undecided(self) -> NDArray[np.bool_]:
        """Where on the grid neither is shown, like `T`."""
        return np.asarray(self._verdict == "undecided")


@dataclass(frozen=True, eq=False)
class Cells:
    """A part of the grid: which points along each axis, P (n + 1, k) there and its error (k,)."""

    chosen: list[NDArray[np.int_]]
    shape: tuple[int, ...]
    P: Float
    error: Float
    direct: bool


def on_grid(fitted: surface.Surface, axes: tuple[Axis, ...], family: Family) -> Iterator[Cells]:
    """P on the whole grid, a piece of the surface at a time."""
    points = [axis.points for axis in axes]
    smooth = [axis.to_smooth(x) for axis, x in zip(axes, points, strict=True)]
    for piece in fitted.pieces:
        chosen = [
            np.flatnonzero((s >= a) & (s <= b))
            for s, a, b in zip(smooth, piece.low, piece.high, strict=True)
        ]
        if any(len(index) == 0 for index in chosen):
            continue
        shape = tuple(map(len, chosen))
        if piece.series is None:
            own = [x[i] for x, i in zip(points, chosen, strict=True)]
            mesh = np.stack([m.ravel() for m in np.meshgrid(*own, indexing="ij")], axis=1)
            P, error = one_by_one(mesh, axes, family)
        else:
            own = [s[i] for s, i in zip(smooth, chosen, strict=True)]
            ends = zip(own, piece.low, piece.high, strict=True)
            local = (np.clip((2.0 * s - a - b) / (b - a), -1.0, 1.0) for s, a, b in ends)
            P = chebyshev.on_grid(piece.series, tuple(local))
            P = np.concatenate([np.ones((1, *shape)), P]).reshape(len(P) + 1, -1)
            error = np.full(P.shape[1], piece.error)
        yield Cells(chosen, shape, P, error, piece.series is None)


def ln_R(P: Float) -> Float:
    """Ln R of each P, (n + 1, k); infinite where there is none: the force, or P, is so."""
    there = np.all(np.isfinite(P), axis=0)
    result = np.full(P.shape[1], np.inf)
    result[there] = growth(P[:, there])
    return result


def _at(chart: Chart, values: Mapping[str, ArrayLike]) -> Points:
    names = [axis.name for axis in chart.axes]
    if set(values) != set(names):
        raise ValueError(f"at: needs {', '.join(names)}; got {', '.join(values) or 'nothing'}")
    arrays = np.broadcast_arrays(*(np.asarray(values[name], float) for name in names))
    for axis, x in zip(chart.axes, arrays, strict=True):
        beyond = ~((x >= axis.low) & (x <= axis.high))
        if np.any(beyond):
            raise ValueError(
                f"{axis.name} = {x[beyond].flat[0]:g}: must be from {axis.low:g} to {axis.high:g}"
            )
    points = np.column_stack([x.ravel() for x in arrays])
    smooth = to_smooth(chart.axes, points)
    P, error = surface.evaluate(chart.surface, smooth)
    without = ~np.isfinite(error)
    if np.any(without):
        found, own = one_by_one(points[without], chart.axes, chart.family)
        P = np.full((len(found), len(points)), np.nan) if len(P) == 1 else P
        P[:, without], error[without] = found, own
    if np.any(~np.isfinite(error)):
        there = points[~np.isfinite(error)][0]
        words = ", ".join(f"{name} = {x:g}" for name, x in zip(names, there, strict=True))
        raise ValueError(
            f"{words}: P is beyond a float, so fast does the solution grow"
            if np.any(np.isinf(P[:, ~np.isfinite(error)][:, 0]))
            else f"{words}: the axial force is infinite, a longitudinal resonance"
        )
    named = dict(zip(names, points.T, strict=True))
    Omega, eta = (np.broadcast_to(v, len(points)) for v in Omega_and_eta(named, chart.family))
    return solve(P.T, error, Omega, eta)


def _verdicts(chart: Chart) -> NDArray[np.str_]:
    axes = chart.axes
    result = np.full([axis.count for axis in axes], "undecided")
    grid = dict(zip((a.name for a in axes), np.ix_(*(a.points for a in axes)), strict=True))
    shape = result.shape
    Omega, eta = (np.broadcast_to(v, shape) for v in Omega_and_eta(grid, chart.family))
    for cells in on_grid(chart.surface, axes, chart.family):
        at = np.ix_(*cells.chosen)
        own = np.full(cells.P.shape[1], "undecided")
        # P beyond a float has a root beyond any edge
        own[np.any(np.isinf(cells.P), axis=0)] = "unstable"
        there = np.all(np.isfinite(cells.P), axis=0) & np.isfinite(cells.error)
        own[there] = verdicts(
            np.ascontiguousarray(cells.P[:, there].T),
            cells.error[there],
            growth(cells.P[:, there]),
            Omega[at].ravel()[there],
            eta[at].ravel()[there],
        )
        result[at] = own.reshape(cells.shape)
    return np.ascontiguousarray(np.transpose(result))


def one_by_one(values: Float, axes: tuple[Axis, ...], family: Family) -> tuple[Float, Float]:
    """P, (n + 1, k), and its error, at parameters (k, axes), where the series does not converge.

    Columns of nan where there is no equation, of infinities where P is beyond a float.
    """
    parts = np.array_split(values, len(values) // DIRECT + 1)
    names = [axis.name for axis in axes]
    lines = np.vstack(
        [nodes.solved(family, dict(zip(names, part.T, strict=True)), "floquet") for part in parts]
    )
    return lines[:, :-2].T, lines[:, -2]


def Omega_and_eta(varied: Mapping[str, Float], family: Family) -> tuple[Any, Any]:
    """Omega and eta, varied or fixed."""
    given: dict[str, Any] = {"eta": 0.0} | dict(family.forcing) | dict(varied)
    return given["Omega"], given["eta"]


def to_smooth(axes: tuple[Axis, ...], values: Float) -> Float:
    """Parameters (k, axes) in the variables in which P is smooth."""
    return np.column_stack([a.to_smooth(x) for a, x in zip(axes, values.T, strict=True)])


def from_smooth(axes: tuple[Axis, ...], smooth: Float) -> Float:
    """Back again."""
    return np.column_stack([a.from_smooth(x) for a, x in zip(axes, smooth.T, strict=True)])
