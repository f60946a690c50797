"""A picture's edges: lines that tell what crosses the unit circle, and that do not cross."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from compare.edges.curves import Curve
from compare.edges.on_chart import merged
from compare.edges.tongue import Tongue

LINE: dict[str, Any] = {"color": "black", "linewidth": 0.6}
LINES: dict[str, dict[str, Any]] = {
    "+1": {"linestyle": (0, (6, 2))},
    "-1": {"linestyle": "-"},
    "pair": {"linestyle": (0, (6, 1.5, 1, 1.5))},
}
CROSSINGS = {"+1": r"$\mu = 1$", "-1": r"$\mu = -1$", "pair": r"a pair of $\mu$"}

BETWEEN = 200
"""Points of a tongue's edge as it is drawn."""


def draw_edges(axes: Any, boundaries: Sequence[Tongue | Curve], x: str) -> list[Any]:
    """Draw them; what the legend says of them.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    boundaries : sequence of Tongue or Curve
    x : str
        What runs along the picture: "Omega", or else Omega runs up it.
    """
    for boundary in boundaries:
        look = LINES[_kind(boundary)] | LINE
        for along, across in lines(boundary, boundaries, x):
            axes.plot(along, across, **look)
    return _crossings({_kind(boundary) for boundary in boundaries})


def _kind(boundary: Tongue | Curve) -> str:
    return boundary.kind if isinstance(boundary, Curve) else boundary.resonance.indicator


def _crossings(kinds: set[str]) -> list[Any]:
    """What the legend says of the lines: which multipliers leave the unit circle there."""
    from matplotlib.lines import Line2D

    shown = ((kind, words) for kind, words in CROSSINGS.items() if kind in kinds)
    return [Line2D([], [], label=words, **(LINES[kind] | LINE)) for kind, words in shown]


def lines(
    boundary: Tongue | Curve, others: Sequence[Tongue | Curve], x: str
) -> list[tuple[Any, Any]]:
    """What to draw of a boundary, whichever axis Omega is.

    Where a tongue has run into another one both have the same edges, which are drawn once; from
    there to where they are its own it has none.
    """
    if isinstance(boundary, Curve):
        return [(boundary.x, boundary.y)]
    tongues = [other for other in others if isinstance(other, Tongue)]
    shared = merged(boundary, tongues)
    first = tongues[: tongues.index(boundary)]
    again = merged(boundary, first)
    ends = np.flatnonzero(np.diff(shared.astype(int))) + 1
    found = []
    for part in np.split(np.arange(len(shared)), ends):
        if len(part) > 1 and not again[part[len(part) // 2]]:
            for edge in (boundary.lower[part], boundary.upper[part]):
                found.append(_smoothly(boundary.y[part], edge))
    return [(edge, y) if x == "Omega" else (y, edge) for y, edge in found]


def _smoothly(y: Any, edge: Any) -> tuple[Any, Any]:
    """An edge between its stations, without a wave of its own."""
    own = np.concatenate([[True], np.diff(y) > 0.0])
    if np.count_nonzero(own) < 3:
        return y, edge
    fine = np.unique(np.concatenate([y, np.linspace(y[0], y[-1], BETWEEN)]))
    return fine, PchipInterpolator(y[own], edge[own])(fine)
