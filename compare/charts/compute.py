"""The chart itself: T over two or more parameters, with its error, from an interpolated P(z)."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import chebyshev, surface
from compare.charts.nodes import ROUTES, Nodes
from compare.charts.parameters import Axis, Beam, Family
from compare.workers import MapLike, mapper
from floquet.batch import polynomials
from hill import checks
from hill.roots import growth

Float = NDArray[np.floating[Any]]

CHECKS = 40
"""Random points at which every chart is held against direct evaluation."""

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
    nodes : int
        Evaluations of P.
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
    nodes: int
    direct: int
    resumed: int
    route: str
    surface: surface.Surface
    seconds: float


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
        Called with the number of nodes just finished.

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

    low = np.array([axis.span[0] for axis in drawn])
    high = np.array([axis.span[1] for axis in drawn])
    with mapper(workers) as run:
        nodes = Nodes(family, drawn, route, run, Path(resume) if resume else None)
        fitted = surface.fit(nodes, low, high, tolerance, progress)
    T, direct = _grid(fitted, drawn, family)
    return Chart(
        axes=drawn,
        family=family,
        T=T,
        error=fitted.error,
        checked=_check(fitted, drawn, family),
        disagreement=nodes.disagreement if route == "both" else float("nan"),
        nodes=fitted.nodes,
        direct=direct,
        resumed=nodes.resumed,
        route=route,
        surface=fitted,
        seconds=time.perf_counter() - started,
    )


def evaluate(fitted: surface.Surface, smooth: Float) -> Float:
    """P at scattered points: smooth coordinates (k, axes) to (n + 1, k); nan beyond the series."""
    size = next((len(p.series) for p in fitted.pieces if p.series is not None), 0)
    P = np.full((size + 1, len(smooth)), np.nan)
    for piece in fitted.pieces:
        inside = np.all((smooth >= piece.low) & (smooth <= piece.high), axis=1)
        if piece.series is not None and np.any(inside):
            local = _local(piece, smooth[inside])
            P[0, inside] = 1.0
            P[1:, inside] = chebyshev.at_points(piece.series, tuple(local.T))
    return P


def _local(piece: surface.Piece, smooth: Float) -> Float:
    return np.clip((2.0 * smooth - piece.low - piece.high) / (piece.high - piece.low), -1.0, 1.0)


def _grid(fitted: surface.Surface, axes: tuple[Axis, ...], family: Family) -> tuple[Float, int]:
    """T on the whole grid, the last axis of the chart first."""
    points = [axis.points for axis in axes]
    smooth = [axis.to_smooth(x) for axis, x in zip(axes, points, strict=True)]
    T = np.full([len(x) for x in points], np.nan)
    direct = 0
    for piece in fitted.pieces:
        chosen = [
            np.flatnonzero((s >= a) & (s <= b))
            for s, a, b in zip(smooth, piece.low, piece.high, strict=True)
        ]
        if any(len(index) == 0 for index in chosen):
            continue
        where = np.ix_(*chosen)
        shape = tuple(len(index) for index in chosen)
        if piece.series is None:
            T[where] = _direct([x[i] for x, i in zip(points, chosen, strict=True)], axes, family)
            direct += int(np.prod(shape))
            continue
        local = tuple(
            np.clip((2.0 * s[i] - a - b) / (b - a), -1.0, 1.0)
            for s, i, a, b in zip(smooth, chosen, piece.low, piece.high, strict=True)
        )
        P = chebyshev.on_grid(piece.series, local)
        P = np.concatenate([np.ones((1, *shape)), P]).reshape(len(P) + 1, -1)
        T[where] = growth(P).reshape(shape)
    return _argument(T, axes, family), direct


def _argument(log_R: Float, axes: tuple[Axis, ...], family: Family) -> Float:
    """T = (Omega/pi) ln R - eta (7.1.1) on the grid, turned so that x comes last."""
    given: dict[str, Any] = {"eta": 0.0} | dict(family.forcing)
    for k, axis in enumerate(axes):
        if axis.name in ("Omega", "eta"):
            shape = [1] * len(axes)
            shape[k] = -1
            given[axis.name] = axis.points.reshape(shape)
    T = log_R * (given["Omega"] / np.pi) - given["eta"]
    return np.asarray(np.transpose(T))


def _direct(points: list[Float], axes: tuple[Axis, ...], family: Family) -> Float:
    """Ln R one by one, where the series does not converge."""
    mesh = [m.ravel() for m in np.meshgrid(*points, indexing="ij")]
    named = {axis.name: m for axis, m in zip(axes, mesh, strict=True)}
    shape = [len(x) for x in points]
    result = np.empty(len(mesh[0]))
    for i in range(len(result)):
        one = {name: values[i : i + 1] for name, values in named.items()}
        try:
            (equation,) = family.equations(one, closed_form=False)
            P = polynomials([equation]).coefficients
            result[i] = growth(P.T)[0]
        except ValueError:
            result[i] = np.inf  # an undamped longitudinal resonance: the force is infinite
    return result.reshape(shape)


def _check(fitted: surface.Surface, axes: tuple[Axis, ...], family: Family) -> float:
    """Largest difference from direct evaluation at random points."""
    rng = np.random.default_rng(0)
    low = np.array([axis.span[0] for axis in axes])
    high = np.array([axis.span[1] for axis in axes])
    smooth = low + (high - low) * rng.random((CHECKS, len(axes)))
    P = evaluate(fitted, smooth)
    known = np.flatnonzero(np.isfinite(P[0])) if len(P) > 1 else np.array([], int)
    if not len(known):
        return 0.0
    named = {a.name: a.from_smooth(x) for a, x in zip(axes, smooth[known].T, strict=True)}
    other = polynomials(family.equations(named, closed_form=False))
    return float(np.max(np.abs(P[:, known].T - other.coefficients)))
