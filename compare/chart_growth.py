"""T of a chart drawn at every pixel: as colour over two axes, as a curve along one."""

from collections.abc import Collection
from typing import Any

import numpy as np

from compare.chart_pixels import Pixels, pixels
from compare.charts.result import Chart

NAMES = 6.5
"""Size of what a legend says."""

PER_INCH = {"z": 120, "mu": 45}
"""Evaluations an inch: nearly one a dot, fewer where a point takes a matrix's eigenvalues."""

ALONG = 250
"""Of one axis."""

UNPROVEN = (0.45, 0.45, 0.45, 0.35)
"""Over the colour of a cell that is not proven as a whole."""


def pixels_of(chart: Chart, size: tuple[float, float], log: Collection[str]) -> Pixels:
    """Of a map of two axes that is so many inches wide and high."""
    per_inch = PER_INCH[chart.scenario.reading.variable]
    return pixels(chart, tuple(max(2, round(0.8 * inches * per_inch)) for inches in size), log)


def growth_as_colour(
    figure: Any, axes: Any, chart: Chart, shown: Pixels, log: Collection[str]
) -> list[Any]:
    """T as colour, at every pixel; what else there is in colours of their own, for the legend."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm, to_rgba
    from matplotlib.patches import Patch

    infinite = np.isinf(shown.T)
    unstable = (shown.verdict == "unstable") & ~infinite
    colours = np.ones((*shown.T.shape, 4))
    if np.any(unstable):
        top = float(shown.T[unstable].max())
        norm, map_ = LogNorm(max(top / 300.0, 1e-5), top, clip=True), colormaps["viridis_r"]
        colours[unstable] = map_(norm(shown.T[unstable]))
        figure.colorbar(
            ScalarMappable(norm, map_), ax=axes, pad=0.015, label="$T$, twice the growth exponent"
        )
    handles: list[Any] = [Patch(fc="white", ec="black", lw=0.4, label="stable")]
    undecided = shown.verdict == "undecided"
    found = (
        (undecided & ~infinite, "undecided", "0.55"),
        (undecided & infinite, "no equation", "tab:orange"),
        ((shown.verdict == "unstable") & infinite, "growth beyond a float", "tab:red"),
    )
    for where, label, colour in found:
        if np.any(where):
            colours[where] = to_rgba(colour)
            handles.append(Patch(fc=colour, ec="none", label=label))
    if np.any(shown.unproven):
        veil = np.array(UNPROVEN)
        colours[shown.unproven] += veil[3] * (veil - colours[shown.unproven])
        colours[..., 3] = 1.0
        handles.append(Patch(fc=UNPROVEN, ec="none", label="cell not proven as a whole"))
    if log:
        axes.pcolormesh(*shown.edges, colours, rasterized=True)
    else:
        (x, y) = chart.axes
        axes.imshow(
            colours,
            extent=(x.low, x.high, y.low, y.high),
            origin="lower",
            aspect="auto",
            interpolation="none",
            rasterized=True,
        )
    return handles


def growth_as_curve(
    axes: Any, chart: Chart, size: tuple[float, float], log: Collection[str]
) -> None:
    """T along one axis; where it is shown to be stable, and where nothing is shown."""
    from matplotlib.patches import Patch

    along = pixels(chart, (int(size[0] * ALONG),), log)
    at, T = along.points[0], np.where(np.isfinite(along.T), along.T, np.nan)
    axes.plot(at, T, color="black", lw=0.9)
    axes.axhline(0.0, color="0.5", lw=0.5)
    handles: list[Any] = []
    infinite = np.isinf(along.T)
    found = (
        ((along.verdict == "unstable") & ~infinite, "unstable", "#cfe0ee"),
        ((along.verdict == "undecided") & ~infinite, "undecided", "0.8"),
        ((along.verdict == "undecided") & infinite, "no equation", "tab:orange"),
        ((along.verdict == "unstable") & infinite, "growth beyond a float", "tab:red"),
    )
    for where, label, colour in found:
        if np.any(where):
            starts = np.flatnonzero(np.diff(np.concatenate([[0], where.astype(int)])) == 1)
            ends = np.flatnonzero(np.diff(np.concatenate([where.astype(int), [0]])) == -1)
            for start, end in zip(starts, ends, strict=True):
                edges = along.edges[0][start], along.edges[0][end + 1]
                axes.axvspan(*edges, fc=colour, ec="none", zorder=0)
            handles.append(Patch(fc=colour, ec="none", label=label))
    axes.set_ylabel("$T$, twice the growth exponent")
    axes.margins(y=0.06)
    if handles:
        axes.legend(handles=handles, fontsize=NAMES, loc="upper right", framealpha=0.9)
