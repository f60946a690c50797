"""The chart itself: T over two or more parameters, with its error, from an interpolated P(z)."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compare.charts import chebyshev, nodes, surface
from compare.charts.nodes import ROUTES, Nodes
from compare.charts.parameters import Axis, Beam, Family
from compare.charts.points import Points, largest_error, solve
from compare.workers import MapLike, mapper
from floquet.batch import polynomials
from hill import checks
from hill.roots import growth

Float = NDArray[np.floating[Any]]

CHECKS = 40
"""Random points at which every chart is held against direct evaluation."""

DIRECT = 4096
"""Points evaluated together where there is no series."""

# The charts' own smallest useful tolerance: P itself is known to about 1e-13.
LEAST_TOLERANCE = 1e-13


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
            An axis without values, a name that is no axis, a value beyond its ends.
        """
        return _at(self, values)

    def unstable(self) -> NDArray[np.bool_]:
        """Where on the grid T exceeds what its error could explain, like `T`."""
        return _unstable(self)


def chart(
    beam: Beam,
    axes: Sequence[Axis | tuple[str, float, float, int]],
    *,
    forcing: Mapping[str, float] | None = None,
    route: str = "both",
    tolerance: float = 1e-11,
    workers: int | MapLike = 1,
    resume: str | Path | None = None,
    progress: Callable[[int], Any] | None = None,
) -> Chart:
    """T over two or more parameters of a beam and its forcing.

    Parameters
    ----------
    beam : UniformBeam or SteppedBeam
        What is not varied of it stays as it is.
    axes : sequence of Axis or (name, low, high, count)
        x, y, and more. Any parameter of the beam, `Omega`, `gamma` or `eta`.
    forcing : mapping, optional
        Values of `Omega`, `gamma` and `eta` that are not axes; `eta` is 0 by default.
    route : {"both", "floquet", "hill"}, optional
        Who evaluates P at the nodes; with "both" the chart carries their disagreement.
    tolerance : float, optional
        Of P's coefficients, relative to the largest; at least 1e-13.
    workers : int or map-like, optional
        Processes, or a function that maps like `map` and keeps the order.
    resume : path, optional
        A file of finished nodes: read if it is there, and kept up to date while nodes arrive.
    progress : callable, optional
        Called with the number of nodes just finished, after they are on disk.

    Returns
    -------
    Chart

    Raises
    ------
    ValueError
        Parameters out of range, an axis that is not one, a resume file of another chart.
    """
    started = time.perf_counter()
    drawn = tuple(a if isinstance(a, Axis) else Axis(*a) for a in axes)
    if not drawn:
        raise ValueError("axes: must name at least one parameter")
    family = Family(beam, dict(forcing or {}))
    family.check(drawn)
    if route not in ROUTES:
        raise ValueError(f"route = {route!r}: must be one of {', '.join(ROUTES)}")
    if checks.number("tolerance", tolerance) < LEAST_TOLERANCE:
        raise ValueError(f"tolerance = {tolerance:g}: must be at least {LEAST_TOLERANCE:g}")

    low, high = np.array([axis.span for axis in drawn]).T
    with mapper(workers) as run:
        sampler = Nodes(family, drawn, route, run, Path(resume) if resume else None, progress)
        fitted = surface.fit(sampler, low, high, tolerance)
    T, direct = _grid(fitted, drawn, family)
    smooth, apart = sampler.sampled
    return Chart(
        axes=drawn,
        family=family,
        T=T,
        error=fitted.error,
        checked=_check(fitted, drawn, family),
        disagreement=sampler.disagreement if route == "both" else float("nan"),
        sampled=_from_smooth(drawn, smooth),
        apart=apart,
        direct=direct,
        resumed=sampler.resumed,
        route=route,
        surface=fitted,
        seconds=time.perf_counter() - started,
    )


def _to_smooth(axes: tuple[Axis, ...], values: Float) -> Float:
    return np.column_stack([a.to_smooth(x) for a, x in zip(axes, values.T, strict=True)])


def _from_smooth(axes: tuple[Axis, ...], smooth: Float) -> Float:
    return np.column_stack([a.from_smooth(x) for a, x in zip(axes, smooth.T, strict=True)])


def _grid(fitted: surface.Surface, axes: tuple[Axis, ...], family: Family) -> tuple[Float, int]:
    """T on the whole grid, the last axis of the chart first."""
    points = [axis.points for axis in axes]
    smooth = [axis.to_smooth(x) for axis, x in zip(axes, points, strict=True)]
    log_R = np.full([len(x) for x in points], np.nan)
    direct = 0
    for piece in fitted.pieces:
        chosen = [
            np.flatnonzero((s >= a) & (s <= b))
            for s, a, b in zip(smooth, piece.low, piece.high, strict=True)
        ]
        if any(len(index) == 0 for index in chosen):
            continue
        own = [s[i] for s, i in zip(smooth, chosen, strict=True)]
        shape = tuple(map(len, own))
        if piece.series is None:
            mesh = np.stack([m.ravel() for m in np.meshgrid(*own, indexing="ij")], axis=1)
            P = _direct(mesh, axes, family)[0]
            direct += len(mesh)
        else:
            ends = zip(own, piece.low, piece.high, strict=True)
            local = (np.clip((2.0 * s - a - b) / (b - a), -1.0, 1.0) for s, a, b in ends)
            P = chebyshev.on_grid(piece.series, tuple(local))
            P = np.concatenate([np.ones((1, *shape)), P]).reshape(len(P) + 1, -1)
        log_R[np.ix_(*chosen)] = _log_R(P).reshape(shape)
    return _argument(log_R, axes, family), direct


def _log_R(P: Float) -> Float:
    """Ln R of each P, (n + 1, k); infinite where there is no P, the force being so."""
    there = np.isfinite(P[0])
    result = np.full(P.shape[1], np.inf)
    result[there] = growth(P[:, there])
    return result


def _argument(log_R: Float, axes: tuple[Axis, ...], family: Family) -> Float:
    """T = (Omega/pi) ln R - eta (7.1.1) on the grid, turned so that x comes last."""
    grid = np.ix_(*(axis.points for axis in axes))
    varied = {axis.name: x for axis, x in zip(axes, grid, strict=True)}
    Omega, eta = _forcing(varied, family)
    return np.asarray(np.transpose(log_R * (Omega / np.pi) - eta))


def _forcing(varied: Mapping[str, Float], family: Family) -> tuple[Any, Any]:
    """Omega and eta, varied or fixed."""
    given: dict[str, Any] = {"eta": 0.0} | dict(family.forcing) | dict(varied)
    return given["Omega"], given["eta"]


def _direct(smooth: Float, axes: tuple[Axis, ...], family: Family) -> tuple[Float, Float]:
    """P, (n + 1, k), and its error, where the series does not converge; nan without a P."""
    parts = np.array_split(smooth, len(smooth) // DIRECT + 1)
    lines = np.vstack([nodes.evaluate(nodes.Job(family, axes, part, "floquet")) for part in parts])
    return lines[:, :-2].T, lines[:, -2]


def _check(fitted: surface.Surface, axes: tuple[Axis, ...], family: Family) -> float:
    """Largest difference from direct evaluation at random points."""
    low, high = np.array([axis.span for axis in axes]).T
    smooth = low + (high - low) * np.random.default_rng(0).random((CHECKS, len(axes)))
    P, _ = surface.evaluate(fitted, smooth)
    known = np.flatnonzero(np.isfinite(P[0])) if len(P) > 1 else np.array([], int)
    if not len(known):
        return 0.0
    values = _from_smooth(axes, smooth[known])
    named = {axis.name: x for axis, x in zip(axes, values.T, strict=True)}
    other = polynomials(family.equations(named, closed_form=False))
    return float(np.max(np.abs(P[:, known].T - other.coefficients)))


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
    smooth = _to_smooth(chart.axes, points)
    P, error = surface.evaluate(chart.surface, smooth)
    without = ~np.isfinite(error)
    if np.any(without):
        found, own = _direct(smooth[without], chart.axes, chart.family)
        P = np.full((len(found), len(points)), np.nan) if len(P) == 1 else P
        P[:, without], error[without] = found, own
    named = dict(zip(names, points.T, strict=True))
    Omega, eta = (np.broadcast_to(v, len(points)) for v in _forcing(named, chart.family))
    return solve(P.T, error, Omega, eta)


def _unstable(chart: Chart) -> NDArray[np.bool_]:
    """Only where T is so small that its error could matter are the roots' discs looked at."""
    axes = chart.axes
    grid = dict(zip((a.name for a in axes), np.ix_(*(a.points for a in axes)), strict=True))
    Omega = np.transpose(np.asarray(_forcing(grid, chart.family)[0]))
    most = largest_error(chart.family.beam.modes + 1, chart.error) * Omega / np.pi
    result = np.asarray(chart.T > 0.0) & ~np.isnan(chart.T)
    close = result & (most >= chart.T)
    where = np.nonzero(close)
    points = {a.name: a.points[i] for a, i in zip(axes, where[::-1], strict=True)}
    result[where] = chart.at(**points).unstable
    return result
