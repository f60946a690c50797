"""The chart itself: T over two or more parameters, with its error, from an interpolated P(z)."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import surface
from compare.charts.nodes import ROUTES, Nodes, solved
from compare.charts.parameters import MOST_POINTS, Axis, Beam, Family
from compare.charts.result import Chart, Omega_and_eta, from_smooth, ln_R, on_grid
from compare.jobs.workers import MapLike, mapper
from hill import checks

Float = NDArray[np.floating[Any]]

CHECKS = 40
"""Random points at which every chart is held against direct evaluation."""

FINE = 2000
"""Points that every chart is taken to have: tongues are followed on its series."""

# The charts' own smallest useful tolerance: P itself is known to about 1e-13.
LEAST_TOLERANCE = 1e-13
# Beyond, T is not known to a digit anywhere.
MOST_TOLERANCE = 1e-2


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
    points = math.prod(axis.count for axis in drawn)
    if points > MOST_POINTS:
        raise ValueError(f"points = {points:,}: must be at most {MOST_POINTS:,} in all")
    family = Family(beam, dict(forcing or {}))
    family.check(drawn)
    if route not in ROUTES:
        raise ValueError(f"route = {route!r}: must be one of {', '.join(ROUTES)}")
    checks.between("tolerance", tolerance, LEAST_TOLERANCE, MOST_TOLERANCE)

    low, high = np.array([axis.span for axis in drawn]).T
    with mapper(workers) as run:
        sampler = Nodes(family, drawn, route, run, Path(resume) if resume else None, progress)
        fitted = surface.fit(
            sampler,
            low,
            high,
            tolerance,
            partial(_wanted, drawn),
            partial(_singular, drawn, family),
        )
    T, direct, error = _grid(fitted, drawn, family)
    smooth, apart = sampler.sampled
    checked, checks_made = _check(fitted, drawn, family, "hill" if route == "hill" else "floquet")
    return Chart(
        axes=drawn,
        family=family,
        T=T,
        error=error,
        checked=checked,
        checks=checks_made,
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


def _singular(axes: tuple[Axis, ...], family: Family, low: Float, high: Float) -> int | None:
    """The axis to cut by where a rectangle of smooth coordinates has a pole."""
    ends = [
        sorted((float(a.from_smooth(x)), float(a.from_smooth(y))))
        for a, x, y in zip(axes, low, high, strict=True)
    ]
    names = [axis.name for axis in axes]
    found = family.singular(
        dict(zip(names, (e[0] for e in ends), strict=True)),
        dict(zip(names, (e[1] for e in ends), strict=True)),
    )
    return None if found is None else names.index(found)


def _grid(
    fitted: surface.Surface, axes: tuple[Axis, ...], family: Family
) -> tuple[Float, int, float]:
    """T on the whole grid, the last axis of the chart first; how many points went alone; P's error.

    Of the series, if there are any; of the points alone where there are none.
    """
    log_R = np.full([axis.count for axis in axes], np.nan)
    direct, worst = 0, 0.0
    for cells in on_grid(fitted, axes, family):
        log_R[np.ix_(*cells.chosen)] = ln_R(cells.P).reshape(cells.shape)
        if cells.direct:
            direct += cells.P.shape[1]
            worst = max(
                worst, float(np.max(cells.error, where=np.isfinite(cells.error), initial=0.0))
            )
    return _argument(log_R, axes, family), direct, fitted.error or worst


def _argument(log_R: Float, axes: tuple[Axis, ...], family: Family) -> Float:
    """T = (Omega/pi) ln R - eta (7.1.1) on the grid, turned so that x comes last."""
    grid = np.ix_(*(axis.points for axis in axes))
    varied = {axis.name: x for axis, x in zip(axes, grid, strict=True)}
    Omega, eta = Omega_and_eta(varied, family)
    return np.asarray(np.transpose(log_R * (Omega / np.pi) - eta))


def _check(
    fitted: surface.Surface, axes: tuple[Axis, ...], family: Family, route: str
) -> tuple[float | None, int]:
    """Largest difference from direct evaluation at random points, and at how many of them.

    A point counts where direct evaluation knows P as well as the series claims to. Where there is
    none, nothing is checked, and nothing is what is said.

    Raises
    ------
    ValueError
        It exceeds the series' own bound, which then is none.
    """
    # within what is drawn, not in the margin that tongues may reach into
    ends = np.array([sorted(map(float, a.to_smooth(np.array([a.low, a.high])))) for a in axes])
    low, high = ends.T
    smooth = low + (high - low) * np.random.default_rng(0).random((CHECKS, len(axes)))
    P, error = surface.evaluate(fitted, smooth)
    known = np.flatnonzero(np.isfinite(error))
    if not len(known):
        return None, 0
    values = from_smooth(axes, smooth[known])
    named = {axis.name: x for axis, x in zip(axes, values.T, strict=True)}
    lines = solved(family, named, route)
    own = lines[:, -2]
    apart = np.max(np.abs(P[:, known].T - lines[:, :-2]), axis=1)
    if np.any(apart > error[known] + own):
        worst = int(np.argmax(apart - error[known] - own))
        raise ValueError(
            f"tolerance: the series is off by {apart[worst]:.0e} where its bound is "
            f"{error[known][worst]:.0e}; ask for a smaller one"
        )
    counts = own <= error[known]
    return (float(apart[counts].max()) if np.any(counts) else None), int(np.sum(counts))
