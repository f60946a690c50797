"""What a page needs of a chart to evaluate it anywhere by itself: series, points, names."""

import base64
import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.axis import Axis
from compare.charts.result import Chart
from compare.charts.scenario import Scenario
from compare.charts.surface import Piece
from compare.edges.on_chart import ORDERS
from compare.edges.tongue import Tongue
from compare.symbols import in_letters
from hill.averaging import Resonance, first_order
from hill.oscillations.expected import half_width
from hill.system import FORCING

Float = NDArray[np.floating[Any]]

MOST_AXES = 4
"""A map and two sliders."""

FREQUENCY_POINTS = (33, 9, 5)
"""Points of each parameter, where one, two or three move the frequencies. They name a point by its
nearest resonance, and are interpolated linearly between."""

LEAST_SHARE = 300.0
"""Colours reach from the largest T down to so much less of it, as in the pictures."""


def check_axes(count: int) -> None:
    """Refuse a chart that no page can show, before anything is computed.

    Raises
    ------
    ValueError
        It has one axis, or more than four.
    """
    if not 2 <= count <= MOST_AXES:
        raise ValueError(
            f"axes: a page shows 2 to {MOST_AXES}, a map and up to {MOST_AXES - 2} sliders; "
            f"the chart has {count}"
        )


def data_of(chart: Chart, tongues: Sequence[Tongue] = ()) -> dict[str, Any]:
    """As JSON can hold it; numbers of a series are little-endian doubles in base64.

    Parameters
    ----------
    chart : Chart
        Of two to four axes.
    tongues : sequence of Tongue, optional
        Of a chart of Omega and one other parameter.

    Raises
    ------
    ValueError
        As for `check_axes`.
    """
    check_axes(len(chart.axes))
    scenario = chart.scenario
    frequencies = _frequencies(scenario)
    return {
        "variable": scenario.reading.variable,
        "degree": scenario.coordinates,
        "axes": [_axis(axis, scenario) for axis in chart.axes],
        "forcing": dict(scenario.forcing),
        "pieces": [_piece(p) for p in _seen(chart)],
        "alone": _alone(chart),
        "colours": _colours(chart),
        "frequencies": frequencies,
        "resonances": _resonances(scenario, frequencies["count"]) if frequencies else [],
        "tongues": [_tongue(t) for t in tongues],
        "time": _units(scenario)[1],
    }


def per_cycle(name: str, scenario: Scenario) -> float:
    """What a parameter is divided by to be shown: a vehicle's Omega is in cycles."""
    return 2.0 * math.pi if name == "Omega" and _units(scenario)[0] else 1.0


def label(name: str, scenario: Scenario) -> str:
    """What a parameter is called, with its unit."""
    unit = _units(scenario)[0]
    return f"pulsation, {unit}" if name == "Omega" and unit else in_letters(name)


def _units(scenario: Scenario) -> tuple[str, str]:
    """A vehicle's names of a cycle per unit of time, and of that unit; nothing of other systems."""
    units = getattr(scenario.system, "units", None)
    if units is None:
        return "", ""
    return units.frequency or "cycles per unit of time", units.time or "unit of time"


def _axis(axis: Axis, scenario: Scenario) -> dict[str, Any]:
    return {
        "name": axis.name,
        "label": label(axis.name, scenario),
        "low": float(axis.low),
        "high": float(axis.high),
        "count": axis.count,
        "smooth": axis.smooth,
        "per": per_cycle(axis.name, scenario),
    }


def _seen(chart: Chart) -> list[Piece]:
    """The pieces that have a series and reach into what is drawn."""
    low, high = chart.scenario.smooth.rectangle([(axis.low, axis.high) for axis in chart.axes])
    return [
        piece
        for piece in chart.surface.pieces
        if piece.series is not None and np.all((piece.low <= high) & (piece.high >= low))
    ]


def _piece(piece: Piece) -> dict[str, Any]:
    assert piece.series is not None
    return {
        "low": piece.low.tolist(),
        "high": piece.high.tolist(),
        "shape": list(piece.series.shape),
        "error": piece.error,
        "series": _packed(piece.series),
    }


def _alone(chart: Chart) -> dict[str, Any]:
    """The points without a series, by their places on the grid, the last axis running fastest."""
    places = np.arange(chart.T.size).reshape([axis.count for axis in chart.axes])
    at = [places[cells.where].ravel() for cells in chart.alone]
    P = [cells.P for cells in chart.alone] or [np.empty((chart.scenario.coordinates + 1, 0))]
    errors = [cells.error for cells in chart.alone]
    return {
        "at": _packed(np.concatenate([*at, np.empty(0)])),
        "P": _packed(np.concatenate(P, axis=1)),
        "error": _packed(np.concatenate([*errors, np.empty(0)])),
    }


def _packed(values: Float) -> str:
    return base64.b64encode(np.ascontiguousarray(values, "<f8").tobytes()).decode()


def _colours(chart: Chart) -> list[float]:
    """The range of T that has colours; of the whole chart, so that sliders do not change it."""
    T = chart.T[chart.unstable() & np.isfinite(chart.T)]
    top = float(T.max(initial=0.0))
    return [max(top / LEAST_SHARE, 1e-5), top] if top > 1e-5 else [1e-5, 1e-3]


def _frequencies(scenario: Scenario) -> dict[str, Any] | None:
    """Natural frequencies over the parameters of the system; None where it does not say them."""
    own = [k for k, axis in enumerate(scenario.axes) if axis.name not in FORCING]
    count = FREQUENCY_POINTS[max(len(own) - 1, 0)]
    points = [np.linspace(scenario.axes[k].low, scenario.axes[k].high, count) for k in own]
    middle = {axis.name: 0.5 * (axis.low + axis.high) for axis in scenario.axes}
    Omega = {**scenario.forcing, **middle}["Omega"]
    found = []
    for values in product(*points):
        at = middle | {scenario.axes[k].name: float(v) for k, v in zip(own, values, strict=True)}
        try:
            w = scenario.frequencies(at, Omega)
        except ValueError:
            return None
        # buckled, or flutters of itself: no resonance is sought from there
        found.append(np.where(np.abs(w.imag) > 1e-9 * np.abs(w), np.nan, w.real))
    if len({len(w) for w in found}) != 1:
        return None
    return {
        "over": own,
        "points": [p.tolist() for p in points],
        "count": len(found[0]),
        "values": _packed(np.array(found)),
    }


def _resonances(scenario: Scenario, count: int) -> list[dict[str, Any]]:
    """Those that a point may be named after, up to the order that tongues are followed to."""
    middle = {axis.name: 0.5 * (axis.low + axis.high) for axis in scenario.axes}
    try:
        equation = scenario.equation(middle)
    except ValueError:  # a pole is there
        return []
    found = []
    for first in first_order(count, scenario.frequency_names(count)):
        opens = half_width(first, equation, damped=False) > 0.0
        for order in range(1, ORDERS + 1):
            r = replace(first, order=order)
            own = {key: getattr(r, key) for key in ("i", "j", "sign", "order")}
            found.append({"name": name(r), "kind": r.indicator, "opens": opens} | own)
    return found


def name(resonance: Resonance) -> str:
    """A resonance's name in letters."""
    return resonance.name.replace("omega_", "ω")


def _tongue(tongue: Tongue) -> dict[str, Any]:
    edges = {key: getattr(tongue, key).tolist() for key in ("y", "lower", "upper")}
    return {"name": name(tongue.resonance), "kind": tongue.resonance.indicator} | edges
