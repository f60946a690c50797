"""Where stability ends on a chart of any two parameters: zeros of P(c), P(-c) and pairs of z.

A chart of Omega has tongues, which `compare.edges.on_chart` follows one by one, however narrow.
On others the zeros are found on a grid and then moved onto the zero by Newton's method on the
interpolant: as exact, but a strip narrower than the grid's step goes unseen, and so does what lies
where there is no series.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.result import Chart
from compare.charts.surface import evaluate

Float = NDArray[np.floating[Any]]

GRID = 201
"""Points an axis of the grid on which signs are compared."""

# Shares of an axis: for slopes, and for a look at either side. A T that begins as the root of the
# distance is 1e-2 there, far above its error.
SLOPE, SIDE = 1e-6, 2e-4
ITERATIONS = 8

# A last step longer than this, in shares of an axis, is no convergence: the zero is a double one.
CONVERGED = 1e-9


@dataclass(frozen=True, eq=False)
class Curve:
    """A piece of the boundary between stable and unstable.

    Attributes
    ----------
    kind : {"+1", "-1", "pair"}
        What vanishes: P(c), P(-c), c = cosh(pi eta/Omega), or the product over pairs of z of
        `compare.stability.indicators.edge_function`.
    x, y : (k,) ndarray
        The chart's two parameters.
    error : float
        How far a point may still be from the zero, in shares of the axes: Newton's last step.
    """

    kind: str
    x: Float
    y: Float
    error: float


def boundaries(chart: Chart) -> tuple[Curve, ...]:
    """Where stability ends on a chart of two parameters.

    Raises
    ------
    ValueError
        The chart has not two axes, or contourpy (of the extra `plot`) is not installed.
    """
    if len(chart.axes) != 2:
        raise ValueError(f"boundaries: need a chart of two parameters, not of {len(chart.axes)}")
    try:
        from contourpy import contour_generator
    except ImportError:
        raise ValueError(
            'boundaries need contourpy: pip install "floquet-crosscheck[plot]"'
        ) from None
    s = np.linspace(0.0, 1.0, GRID)
    mesh = np.stack(np.meshgrid(s, s), axis=-1)
    found: list[Curve] = []
    for kind in chart.scenario.reading.kinds:
        f = _function(chart, kind)
        values = f(mesh.reshape(-1, 2)).reshape(GRID, GRID)
        for line in contour_generator(s, s, np.ma.masked_invalid(values)).lines(0.0):
            found += _kept(chart, kind, f, np.asarray(line))
    return tuple(found)


def _function(chart: Chart, kind: str) -> Callable[[Float], Float]:
    """The edge function at points of the unit square."""

    def f(at: Float) -> Float:
        named = _named(chart, at)
        points = np.column_stack([named[axis.name] for axis in chart.axes])
        P, _ = evaluate(chart.surface, chart.scenario.smooth.to_smooth(points))
        there = np.isfinite(P[0])
        given = dict(chart.scenario.forcing) | named
        Omega, eta = (np.broadcast_to(given.get(n, 0.0), len(at))[there] for n in ("Omega", "eta"))
        value = np.full(len(at), np.nan)
        value[there] = chart.scenario.reading.edge_function(kind, P[:, there].T, Omega, eta)
        return value

    return f


def _named(chart: Chart, at: Float) -> dict[str, Float]:
    """Parameters at points of the unit square."""
    return {
        axis.name: np.clip(axis.low + (axis.high - axis.low) * s, axis.low, axis.high)
        for axis, s in zip(chart.axes, at.T, strict=True)
    }


def _kept(chart: Chart, kind: str, f: Callable[[Float], Float], line: Float) -> Iterator[Curve]:
    """The pieces of a zero line across which stability changes."""
    at, normal, left = _onto(f, line)
    there = np.all(np.isfinite(at), axis=1)
    at, normal, left = at[there], normal[there], left[there]
    sides = [
        chart.at(**_named(chart, np.clip(at + sign * SIDE * normal, 0.0, 1.0))).unstable
        for sign in (-1.0, 1.0)
    ]
    kept = np.flatnonzero((sides[0] != sides[1]) & (left < CONVERGED))
    for run in np.split(kept, np.flatnonzero(np.diff(kept) > 1) + 1):
        if len(run) > 1:
            named = _named(chart, at[run])
            x, y = (named[axis.name] for axis in chart.axes)
            yield Curve(kind, x, y, float(left[run].max()))


def _onto(f: Callable[[Float], Float], line: Float) -> tuple[Float, Float, Float]:
    """Points moved onto the zero along the slope, the unit normals there, and the last step."""
    at = line.copy()
    normal, step = np.zeros_like(at), np.full(len(at), np.inf)
    for _ in range(ITERATIONS):
        slope = np.empty_like(at)
        for k in range(2):
            ahead, behind = at.copy(), at.copy()
            ahead[:, k] = np.minimum(at[:, k] + SLOPE, 1.0)
            behind[:, k] = np.maximum(at[:, k] - SLOPE, 0.0)
            slope[:, k] = (f(ahead) - f(behind)) / (ahead[:, k] - behind[:, k])
        size = np.maximum(np.linalg.norm(slope, axis=1), np.finfo(float).tiny)
        normal = slope / size[:, None]
        # a step is never longer than the grid's: the zero is within the cell
        step = np.clip(f(at) / size, -1.0 / GRID, 1.0 / GRID)
        at = np.clip(at - step[:, None] * normal, 0.0, 1.0)
    return at, normal, np.abs(step)
