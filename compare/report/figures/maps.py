"""Regions of instability: a panel for all of them, and one for each."""

from typing import Any

import numpy as np

from compare.report.figures import style
from compare.report.figures.catalogue import Figure
from compare.report.figures.data import FigureData, Series
from compare.report.figures.panels import dots, title

SHARED = {"(2 omega_(1))/3": "2 omega_(B)"}
"""Drawn in the panel of another one."""


def layout(page: Any, names: list[str]) -> tuple[Any, dict[str, Any], list[Any]]:
    """A large panel on the left for all, small ones on the right, and what cells are left over."""
    rows = int(np.ceil(len(names) / 2))
    grid = page.add_gridspec(rows, 3, width_ratios=(1.25, 1.0, 1.0))
    overview = page.add_subplot(grid[:, 0])
    cells = [(r, c) for c in (1, 2) for r in reversed(range(rows))]
    panels = {
        name: page.add_subplot(grid[r, c]) for name, (r, c) in zip(names, cells, strict=False)
    }
    return overview, panels, [grid[r, c] for r, c in cells[len(names) :]]


def own_panels(data: FigureData) -> list[str]:
    """Panels by frequency."""
    lowest: dict[str, float] = {}
    for s in data.select("region"):
        name = SHARED.get(s.panel, s.panel)
        if s.panel == name:
            lowest[name] = min(lowest.get(name, np.inf), float(np.mean(s.y)))
    return sorted(lowest, key=lambda name: lowest[name])


def regions(page: Any, figure: Figure, data: FigureData) -> None:
    """Unstable regions filled, all in one panel and each in its own."""
    names = own_panels(data)
    overview, small, left = layout(page, names)
    for cell in left:
        _key(page, cell, figure.eta > 0.0)
    for s in data.series:
        if s.role == "printed":
            continue
        shade = style.colour(s.panel)
        axes = small.get(SHARED.get(s.panel, s.panel))
        if s.role == "mark":
            dots(axes, s, shade)
            continue
        for target in (overview, axes):
            if target is not None:
                _region(target, s, shade)
    for name, axes in small.items():
        _frame(axes, data, name)
        _name(axes, data, name)
    _printed_rows(data, small)
    _finish(overview, small, figure)


def _region(axes: Any, s: Series, shade: str) -> None:
    if s.name == "outline":
        for y in s.edges:
            axes.plot(s.x, y, color="0.55", lw=0.5, zorder=1)
        return
    axes.fill_between(s.x, s.y, s.y_upper, color=shade, alpha=0.28, lw=0)
    for y in s.edges:
        axes.plot(s.x, y, color=shade, lw=0.8)


def _frame(axes: Any, data: FigureData, name: str) -> None:
    """Limits of a small panel: its regions, and some room for its name."""
    shown = [s for s in data.series if SHARED.get(s.panel, s.panel) == name]
    shown = [s for s in shown if s.role in ("region", "curve")]
    lo = min(float(s.y.min()) for s in shown)
    hi = max(float(s.edges[-1].max()) for s in shown)
    axes.set_ylim(lo - 0.10 * (hi - lo), hi + 0.08 * (hi - lo))
    axes.locator_params(axis="y", nbins=5)


def _name(axes: Any, data: FigureData, name: str) -> None:
    """In the lower left, unless a region is there."""
    lo, hi = axes.get_ylim()
    shown = [s for s in data.series if SHARED.get(s.panel, s.panel) == name and s.role != "mark"]
    end = max(float(s.x[-1]) for s in data.select("region"))
    taken = any(np.any((s.x < 0.5 * end) & (s.y < lo + 0.2 * (hi - lo))) for s in shown)
    if taken and not any(
        np.any((s.x > 0.5 * end) & (s.edges[-1] > hi - 0.2 * (hi - lo))) for s in shown
    ):
        title(axes, style.resonance(name), 0.95, 0.95, ha="right")
    else:
        title(axes, style.resonance(name), 0.05, 0.13)


def _printed_rows(data: FigureData, small: dict[str, Any]) -> None:
    """Each printed row in the panel of the nearest resonance."""
    for s in data.select("printed"):
        unstable = s.name.startswith("T > ")
        face = {} if unstable else {"mfc": "white", "mec": "black", "mew": 0.6}
        for x, y in zip(s.x, s.y, strict=True):
            name = min(small, key=lambda panel: _distance(data, panel, float(x), float(y)))
            lo, hi = small[name].get_ylim()
            if lo < y < hi:
                small[name].plot([x], [y], zorder=5, **(style.PRINTED | {"ms": 2.8} | face))


def _distance(data: FigureData, panel: str, x: float, y: float) -> float:
    """From a point to a panel's first region at this x; infinite where it does not reach."""
    shown = [s for s in data.select(panel=panel) if len(s.edges) == 2 and s.role != "mark"]
    gaps = [
        max(0.0, float(np.interp(x, s.x, s.edges[0])) - y, y - float(np.interp(x, s.x, s.edges[1])))
        for s in shown
        if s.x[0] <= x <= s.x[-1]
    ]
    return min(gaps, default=np.inf)


def _key(page: Any, cell: Any, damped: bool) -> None:
    """What is what, in a cell that no panel needs."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    axes = page.add_subplot(cell)
    axes.set_axis_off()
    hollow: dict[str, Any] = {"mfc": "white", "mec": "black", "mew": 0.6}
    handles = {
        "unstable": Patch(facecolor="0.8", edgecolor="0.3", lw=0.8),
        "Hill's determinant": Line2D([], [], mec="0.3", **style.MARK),
        "printed, growing": Line2D([], [], **style.PRINTED),
        "printed, not growing": Line2D([], [], **(style.PRINTED | hollow)),
    }
    if damped:
        handles["without damping"] = Line2D([], [], color="0.55", lw=0.5)
    axes.legend(handles.values(), handles.keys(), loc="center")


def _finish(overview: Any, small: dict[str, Any], figure: Figure) -> None:
    label = r"$\bar T_0$" if figure.along == "T0" else r"$\gamma=T_1/T_0$"
    bottom = max(axes.get_subplotspec().rowspan.start for axes in small.values())
    for axes in (overview, *small.values()):
        axes.set_xlim(*figure.span)
        lowest = axes is overview or axes.get_subplotspec().rowspan.start == bottom
        axes.tick_params(labelbottom=lowest)
        if lowest:
            axes.set_xlabel(label)
    overview.set_ylim(0.0, 6.0)
    overview.set_ylabel(r"$\bar\Omega$")


def coupled(page: Any, figure: Figure, data: FigureData) -> None:
    """Filled where longitudinal damping leaves an instability, hatched where it removes one."""
    names = own_panels(data)
    overview, small, _ = layout(page, names)
    undamped = f"g = {figure.values[0]:g}"
    for s in sorted(data.select("region"), key=lambda s: s.name != undamped):
        shade = style.colour(s.panel)
        for axes in (overview, small[s.panel]):
            if s.name == undamped:
                axes.fill_between(
                    s.x, s.y, s.y_upper, facecolor="none", edgecolor="0.55", hatch="xxxxx", lw=0
                )
                for y in (e for e in s.edges if np.ptp(e) > 0.0):  # a pole is no edge
                    axes.plot(s.x, y, color="0.35", lw=0.6, ls=(0, (4, 2)))
            else:
                axes.fill_between(s.x, s.y, s.y_upper, color="white", lw=0, zorder=2.1)
                axes.fill_between(s.x, s.y, s.y_upper, color=shade, alpha=0.4, lw=0, zorder=2.2)
                for y in s.edges:
                    axes.plot(s.x, y, color=shade, lw=0.8, zorder=2.3)
    for s in data.select("mark"):
        dots(small[s.panel], s, "0.35" if s.name == undamped else style.colour(s.panel))
    for name, axes in small.items():
        _frame(axes, data, name)
        _name(axes, data, name)
    _finish(overview, small, figure)
