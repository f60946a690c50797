"""The chart itself: T over two or more parameters, with its error, from an interpolated P(z)."""

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import chebyshev, surface
from compare.charts.nodes import ROUTES, Nodes
from compare.charts.parameters import Axis, Beam, Family
from compare.charts.result import Chart, Omega_and_eta, from_smooth, one_by_one
from compare.workers import MapLike, mapper
from floquet.batch import polynomials
from hill import checks
from hill.roots import growth

Float = NDArray[np.floating[Any]]

CHECKS = 40
"""Random points at which every chart is held against direct evaluation."""

FINE = 2000
"""Points that every chart is taken to have: tongues are followed on its series."""

# The charts' own smallest useful tolerance: P itself is known to about 1e-13.
LEAST_TOLERANCE = 1e-13


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
        Parameters out of range, an axis that is not one, a resume file of another chart; a series
        that misses its own bound at one of the random points.
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
        fitted = surface.fit(sampler, low, high, tolerance, partial(_wanted, drawn))
    T, direct = _grid(fitted, drawn, family)
    smooth, apart = sampler.sampled
    return Chart(
        axes=drawn,
        family=family,
        T=T,
        error=fitted.error,
        checked=_check(fitted, drawn, family),
        disagreement=sampler.disagreement if route == "both" else float("nan"),
        sampled=from_smooth(drawn, smooth),
        apart=apart,
        direct=direct,
        resumed=sampler.resumed,
        route=route,
        surface=fitted,
        seconds=time.perf_counter() - started,
    )


def _wanted(axes: tuple[Axis, ...], low: Float, high: Float) -> float:
    """Points of the grid in a rectangle of smooth coordinates, or its share of `FINE`."""
    points, share = 1, 1.0
    for axis, a, b in zip(axes, low, high, strict=True):
        smooth, (start, end) = axis.to_smooth(axis.points), axis.span
        points *= int(np.count_nonzero((smooth >= a) & (smooth <= b)))
        share *= (b - a) / (end - start)
    return max(points, share * FINE)


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
            P = one_by_one(mesh, axes, family)[0]
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
    Omega, eta = Omega_and_eta(varied, family)
    return np.asarray(np.transpose(log_R * (Omega / np.pi) - eta))


def _check(fitted: surface.Surface, axes: tuple[Axis, ...], family: Family) -> float:
    """Largest difference from direct evaluation at random points.

    Raises
    ------
    ValueError
        It exceeds the series' own bound, which then is none.
    """
    low, high = np.array([axis.span for axis in axes]).T
    smooth = low + (high - low) * np.random.default_rng(0).random((CHECKS, len(axes)))
    P, error = surface.evaluate(fitted, smooth)
    known = np.flatnonzero(np.isfinite(P[0])) if len(P) > 1 else np.array([], int)
    if not len(known):
        return 0.0
    values = from_smooth(axes, smooth[known])
    named = {axis.name: x for axis, x in zip(axes, values.T, strict=True)}
    other = polynomials(family.equations(named, closed_form=False))
    apart = np.max(np.abs(P[:, known].T - other.coefficients), axis=1)
    if np.any(apart > error[known] + other.errors):
        raise ValueError(
            f"tolerance: the series is off by {apart.max():.0e} where its bound is "
            f"{error[known].max():.0e}; ask for a smaller one"
        )
    return float(apart.max())
