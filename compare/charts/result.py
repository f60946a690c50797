"""A chart: T on its grid, and the solution anywhere in it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compare.charts import nodes, surface
from compare.charts.parameters import Axis, Family
from compare.charts.points import Points, largest_error, solve

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
        Bound on the absolute error of the interpolated coefficients of P.
    checked : float
        Largest difference from direct evaluation at `CHECKS` random points; never above `error`.
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
    checked: float
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

    def unstable(self) -> NDArray[np.bool_]:
        """Where on the grid T exceeds what its error could explain, like `T`."""
        return _unstable(self)


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
        found, own = one_by_one(smooth[without], chart.axes, chart.family)
        P = np.full((len(found), len(points)), np.nan) if len(P) == 1 else P
        P[:, without], error[without] = found, own
    if np.any(~np.isfinite(error)):
        there = points[~np.isfinite(error)][0]
        words = ", ".join(f"{name} = {x:g}" for name, x in zip(names, there, strict=True))
        raise ValueError(f"{words}: the axial force is infinite, a longitudinal resonance")
    named = dict(zip(names, points.T, strict=True))
    Omega, eta = (np.broadcast_to(v, len(points)) for v in Omega_and_eta(named, chart.family))
    return solve(P.T, error, Omega, eta)


def _unstable(chart: Chart) -> NDArray[np.bool_]:
    """Only where T is so small that its error could matter are the roots' discs looked at."""
    axes = chart.axes
    grid = dict(zip((a.name for a in axes), np.ix_(*(a.points for a in axes)), strict=True))
    Omega = np.transpose(np.asarray(Omega_and_eta(grid, chart.family)[0]))
    most = largest_error(chart.family.beam.modes + 1, chart.error) * Omega / np.pi
    result = np.asarray(chart.T > 0.0) & ~np.isnan(chart.T)
    close = result & (most >= chart.T)
    where = np.nonzero(close)
    points = {a.name: a.points[i] for a, i in zip(axes, where[::-1], strict=True)}
    result[where] = chart.at(**points).unstable
    return result


def one_by_one(smooth: Float, axes: tuple[Axis, ...], family: Family) -> tuple[Float, Float]:
    """P, (n + 1, k), and its error, where the series does not converge; nan without a P."""
    parts = np.array_split(smooth, len(smooth) // DIRECT + 1)
    lines = np.vstack([nodes.evaluate(nodes.Job(family, axes, part, "floquet")) for part in parts])
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
