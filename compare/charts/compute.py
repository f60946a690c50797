"""The chart itself: T over two or more parameters, with its error, from an interpolated P(z)."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import surface
from compare.charts.axis import MAX_POINTS, Axis
from compare.charts.certified import certify as certified_cells
from compare.charts.grid import Cells, from_series, on_mesh, one_by_one, reasons
from compare.charts.nodes import ROUTES, Nodes, solved
from compare.charts.poles import singular_across
from compare.charts.result import Chart
from compare.charts.scenario import Scenario, scenario
from compare.charts.smooth import Smooth
from compare.jobs.workers import MapLike, mapper
from hill import System, checks

Float = NDArray[np.floating[Any]]
Stage = Callable[[str, int, int], Any]

CHECKS = 40
"""Random points at which every chart is held against direct evaluation."""

NOMINAL_POINTS = 2000
"""Points that every chart is taken to have: tongues are followed on its series."""

MAX_DIRECT = 2_000_000
"""Points without a series that are evaluated one by one: an hour or more on one core."""

# The charts' own smallest useful tolerance: P itself is known to about 1e-13.
MIN_TOLERANCE = 1e-13
# Beyond, T is not known to a digit anywhere.
MAX_TOLERANCE = 1e-2


def chart(
    system: System,
    axes: Sequence[Axis | tuple[str, float, float, int]],
    *,
    forcing: Mapping[str, float] | None = None,
    route: str = "both",
    tolerance: float = 1e-11,
    workers: int | MapLike = 1,
    resume: str | Path | None = None,
    certify: bool = False,
    progress: Callable[[int], Any] | None = None,
    stage: Stage | None = None,
) -> Chart:
    """T over two or more parameters of a system and its forcing.

    Parameters
    ----------
    system : System
        A beam, a `MatrixSystem`, anybody's. What is not varied of it stays as it is.
    axes : sequence of Axis or (name, low, high, count)
        x, y, and more. Any parameter of the system, `Omega`, `gamma` or `eta`.
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
    certify : bool, optional
        Prove the verdict of every cell, of a chart of Omega and gamma (extra `proof`).
    progress : callable, optional
        Called with the number of nodes just finished, after they are on disk.
    stage : callable, optional
        Called with what is being done, how much of it is done, and of how much: "nodes", of those
        asked for so far; "thousandths of the range"; both grow until the chart is done. Before
        them, what is done to certify it.

    Returns
    -------
    Chart

    Raises
    ------
    ValueError
        Parameters out of range, an axis that is not one, a resume file of another chart; a series
        that misses its own bound at one of the random points; too many points without a series;
        what cannot be certified.
    """
    started = time.perf_counter()
    if not axes:
        raise ValueError("axes: must name at least one parameter")
    drawn = tuple(axis if isinstance(axis, Axis) else Axis(*axis) for axis in axes)
    points = math.prod(axis.count for axis in drawn)
    if points > MAX_POINTS:
        raise ValueError(f"points = {points:,}: must be at most {MAX_POINTS:,} in all")
    wanted = scenario(system, drawn, forcing)
    if route not in ROUTES:
        raise ValueError(f"route = {route!r}: must be one of {', '.join(ROUTES)}")
    checks.between("tolerance", tolerance, MIN_TOLERANCE, MAX_TOLERANCE)

    smooth = wanted.smooth
    with mapper(workers) as run:
        proven = certified_cells(wanted, run, stage) if certify else None
        store = Path(resume) if resume else None
        sampler = Nodes(wanted, route, run, store, progress, stage)
        fitted = surface.fit(
            sampler,
            *smooth.span,
            tolerance,
            partial(_points_wanted, smooth),
            partial(singular_across, wanted),
            partial(_covered, stage) if stage else None,
            points,
            smooth.kept,
        )
        alone = one_by_one(fitted, smooth, sampler.at, MAX_DIRECT)
    sampled, apart = sampler.sampled
    checked, made = _check(fitted, wanted, "hill" if route == "hill" else "floquet")
    error, relative_error = _errors(fitted, alone)
    return Chart(
        scenario=wanted,
        T=argument(fitted, alone, wanted),
        error=error,
        relative_error=relative_error,
        checked=checked,
        checks=made,
        disagreement=sampler.disagreement if route == "both" else float("nan"),
        sampled=sampled,
        apart=apart,
        one_by_one=reasons(alone),
        resumed=sampler.resumed,
        route=route,
        surface=fitted,
        alone=alone,
        certified=proven,
        seconds=time.perf_counter() - started - (proven.seconds if proven else 0.0),
    )


def _covered(stage: Stage, share: float) -> None:
    stage("thousandths of the range", round(1000 * share), 1000)


def _points_wanted(smooth: Smooth, low: Float, high: Float) -> float:
    """Points of the grid in a rectangle of smooth coordinates, or its share of the nominal ones."""
    start, end = smooth.span
    part = smooth.part(low, high)
    share = float(np.prod((high - low) / (end - start)))
    return max(part.count if part else 0, share * NOMINAL_POINTS)


def _errors(fitted: surface.Surface, alone: Sequence[Cells]) -> tuple[float, float]:
    """P's error, absolute and over its largest coefficient; of the points alone without series."""
    if any(piece.series is not None for piece in fitted.pieces):
        return fitted.error, fitted.relative_error
    worst, relative = 0.0, 0.0
    for cells in alone:
        there = cells.there
        size = np.max(np.abs(cells.P[:, there]), axis=0)
        worst = max(worst, float(np.max(cells.error[there], initial=0.0)))
        relative = max(relative, float(np.max(cells.error[there] / size, initial=0.0)))
    return worst, relative


def argument(fitted: surface.Surface, alone: Sequence[Cells], wanted: Scenario) -> Float:
    """T on the grid, turned so that x comes last; infinite where P is, or where there is none.

    Nan where there is neither a series nor an evaluation.
    """
    T = np.full([axis.count for axis in reversed(wanted.axes)], np.nan)
    Omega, eta = on_mesh(wanted)
    for cells in chain(from_series(fitted, wanted.smooth), alone):
        P, at = cells.P, [cells.spread(x) for x in (Omega, eta)]
        finite = np.isfinite(P)
        if np.all(finite):
            own = wanted.reading.argument(P, *at)
        else:
            there = np.all(finite, axis=0)
            own = np.full(len(there), np.inf)
            own[there] = wanted.reading.argument(P[:, there], *(x[there] for x in at))
        T.T[cells.where] = own.reshape(cells.shape)
    return T


def _check(fitted: surface.Surface, wanted: Scenario, route: str) -> tuple[float | None, int]:
    """Largest difference from direct evaluation at random points, and at how many of them.

    A point counts where direct evaluation knows P as well as the series claims to. Where there is
    none, nothing is checked, and nothing is what is said.

    Raises
    ------
    ValueError
        It exceeds the series' own bound, which then is none.
    """
    # within what is drawn, not in the margin that tongues may reach into
    shares = np.random.default_rng(0).random((CHECKS, len(wanted.axes)))
    smooth = wanted.smooth.scattered(shares)
    P, error = surface.evaluate(fitted, smooth)
    known = np.flatnonzero(np.isfinite(error))
    if not len(known):
        return None, 0
    values = wanted.smooth.from_smooth(smooth[known])
    lines = solved(wanted, dict(zip(wanted.names, values.T, strict=True)), route)
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
