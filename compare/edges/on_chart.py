"""Tongues on a chart of Omega and another parameter: each with its resonance and two edges."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.axis import Axis
from compare.charts.result import Chart
from compare.edges.interpolated import axes_of, on_surface
from compare.edges.reach import may_reach
from compare.edges.tongue import Tongue
from compare.edges.tracer import TongueTracer, follow
from hill.averaging import first_order

STATIONS = 33
"""Values of y at which the edges are solved for, before those added where a tongue closes."""

ORDERS = 3
"""Resonances are followed up to this order where nothing else is asked."""

FARTHEST = 4.0
"""Factor by which a series may reach beyond the chart's Omega; a window farther out is evaluated
line by line."""

SAME = 0.02
"""Two tongues are one where their edges differ by no more than this share of the width; they are
compared by straight lines between stations."""

MOSTLY = 0.7
"""Share of its stations from which a tongue that is another there is no tongue of its own.

On the charts of the report's two beams over gamma, and over T0, up to order 3, what is a tongue of
its own was another at .19 of its stations at most, and what is none at .78 at least; with `SAME`
from .02 to .2 alike.
"""


def stations(y: Axis) -> list[float]:
    """Where the edges are solved for; not at 0, where a tongue in gamma is a point."""
    first = y.low + (y.high - y.low) / 200.0 if y.low == 0.0 else y.low
    return [float(v) for v in np.linspace(first, y.high, STATIONS)]


def tongues(
    chart: Chart, orders: int = ORDERS, progress: Callable[[int, int], Any] | None = None
) -> tuple[Tongue, ...]:
    """Boundaries of the instabilities of the first orders over a chart of Omega and another one.

    A resonance outside the chart's Omega is followed too, where its tongue may reach in. Next to a
    pole of the system, where there is no series, P is evaluated; a tongue that a pole cuts is in
    pieces, and each says why it goes no further.

    Parameters
    ----------
    chart : Chart
    orders : int, optional
        Resonances 2 omega_i/k and (omega_i +- omega_j)/k up to this k.
    progress : callable, optional
        Called with how many resonances are done, and how many there are.

    Raises
    ------
    ValueError
        As for `axes_of`.
    """
    x, y = axes_of(chart)
    own = on_surface(chart)
    at = stations(y)
    count = len(own.frequencies(at[0]))
    wanted = [
        replace(resonance, order=order)
        for resonance in first_order(count, chart.scenario.frequency_names(count))
        for order in range(1, orders + 1)
    ]
    within = (x.low, x.high)
    tracers = [TongueTracer(own, resonance, within) for resonance in wanted]
    windows = [_windows(tracer, at) if may_reach(tracer, at) else [] for tracer in tracers]
    seen = [window for each in windows for window in each]
    low, high = (min(a for a, _ in seen), max(b for _, b in seen)) if seen else within
    curves = on_surface(chart, max(low, x.low / FARTHEST), min(high, x.high * FARTHEST))
    found: list[Tongue] = []
    for done, (resonance, any_there) in enumerate(zip(wanted, windows, strict=True), start=1):
        if any_there:
            found += [
                tongue
                for tongue in follow(curves, resonance, at, Omega=within)
                if np.any((tongue.upper >= x.low) & (tongue.lower <= x.high))
            ]
        if progress is not None:
            progress(done, len(wanted))
    return distinct(found)


def _windows(tracer: TongueTracer, at: Sequence[float]) -> list[tuple[float, float]]:
    """What the tracer may look at, where that reaches into the chart."""
    return [window for y in at if (window := tracer.window(y))]


def distinct(found: Sequence[Tongue]) -> tuple[Tongue, ...]:
    """Without those whose edges are another's nearly everywhere.

    A resonance of higher order that lies within a wide tongue is a guess that leads to its edges.
    """
    kept: list[Tongue] = []
    for tongue in sorted(found, key=lambda t: (t.resonance.order, -len(t.y))):
        if np.mean(merged(tongue, kept)) <= MOSTLY:
            kept.append(tongue)
    return tuple(kept)


def merged(tongue: Tongue, others: Sequence[Tongue]) -> NDArray[np.bool_]:
    """At which y the tongue's edges are another's: itself, or both have run into one another."""
    width = tongue.upper - tongue.lower
    result = np.zeros(len(width), bool)
    for other in others:
        if other is not tongue:
            within = (other.y[0] <= tongue.y) & (tongue.y <= other.y[-1])
            apart = np.maximum(
                np.abs(tongue.lower - np.interp(tongue.y, other.y, other.lower)),
                np.abs(tongue.upper - np.interp(tongue.y, other.y, other.upper)),
            )
            result |= within & (apart <= SAME * width) & (width > 0.0)
    return result
