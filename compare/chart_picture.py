"""A chart as a picture: T as colour, boundaries as lines, tongues named, marks on top."""

import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np

from compare.chart_files import about
from compare.chart_ticks import ticks_in_cycles
from compare.charts.result import Chart
from compare.edges.curves import Curve
from compare.edges.tongue import Tongue
from compare.provenance import picture_metadata
from compare.symbols import of_resonance, of_value, symbol

STYLE: Any = {
    "font.family": "serif",
    "mathtext.fontset": "cm",
    "font.size": 9,
    "axes.linewidth": 0.6,
    "svg.hashsalt": "floquet-crosscheck",
}


LEGEND = 6
"""Entries that a line has room for."""

TITLE_WIDTH = 104
"""Characters of a title's line: the picture is as wide."""

NO_PICTURES = 'pictures need matplotlib: pip install "floquet-crosscheck[plot]"'

LINE: dict[str, Any] = {"color": "black", "linewidth": 0.6}
LINES: dict[str, dict[str, Any]] = {
    "+1": {"linestyle": (0, (6, 2))},
    "-1": {"linestyle": "-"},
    "pair": {"linestyle": (0, (6, 1.5, 1, 1.5))},
}
CROSSINGS = {"+1": r"$\mu = 1$", "-1": r"$\mu = -1$", "pair": r"a pair of $\mu$"}

QUANTITIES = ("T", "disagreement")

UNPROVEN = (0.45, 0.45, 0.45, 0.35)
"""Over the colours of T, which stay to be seen."""

MIN_DISAGREEMENT = 1e-17
"""Where the routes agree to the last bit, a disagreement is drawn as this."""


@dataclass(frozen=True)
class Mark:
    """A point to be marked: filled where it is said to be unstable."""

    x: float
    y: float
    unstable: bool


def picture(
    chart: Chart,
    boundaries: Sequence[Tongue | Curve],
    kind: str,
    quantity: str = "T",
    *,
    title: str = "",
    marks: Sequence[Mark] = (),
    marks_label: str = "marked",
    in_cycles: str = "",
) -> bytes:
    """The chart as PNG or SVG.

    Parameters
    ----------
    chart : Chart
    boundaries : sequence of Tongue or Curve
        Drawn as lines; tongues with their names.
    kind : {"png", "svg"}
    quantity : {"T", "disagreement"}, optional
        T over the chart, or how far the two routes differ at its nodes.
    title : str, optional
        What the system is called; its type where nothing is said.
    marks : sequence of Mark, optional
    marks_label : str, optional
        What the legend calls them.
    in_cycles : str, optional
        What Omega's axis is called, in cycles per unit of time; in radians where nothing is said.

    Raises
    ------
    ValueError
        The chart has not two axes, or no disagreement to draw; matplotlib is not installed.
    """
    if len(chart.axes) != 2:
        raise ValueError(f"a picture needs two axes, the chart has {len(chart.axes)}")
    if quantity == "disagreement" and chart.route != "both":
        raise ValueError(f"disagreement: needs route = 'both', the chart has {chart.route!r}")
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise ValueError(NO_PICTURES) from None
    x, y = chart.axes
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(7.2, 4.6), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.add_subplot()
        (_growth if quantity == "T" else _disagreement)(figure, axes, chart)
        for boundary in boundaries:
            look = LINES[_kind(boundary)] | LINE
            for along, across in _lines(boundary, x.name):
                axes.plot(along, across, **look)
        if quantity == "T":
            _name(axes, chart, [b for b in boundaries if isinstance(b, Tongue)])
            kinds = {_kind(boundary) for boundary in boundaries}
            _legend(axes, chart, [*_crossings(kinds), *_marked(axes, chart, marks, marks_label)])
        axes.set(xlim=(x.low, x.high), ylim=(y.low, y.high))
        axes.set_xlabel(symbol(x.name))
        axes.set_ylabel(symbol(y.name))
        if in_cycles:
            ticks_in_cycles(axes, x.name, in_cycles)
        axes.set_title(_title(chart, title), fontsize=8, loc="left")
        buffer = io.BytesIO()
        metadata = picture_metadata(about(chart), kind)
        figure.savefig(buffer, format=kind, dpi=200, metadata=metadata)
    return buffer.getvalue()


def _kind(boundary: Tongue | Curve) -> str:
    return boundary.kind if isinstance(boundary, Curve) else boundary.resonance.indicator


def _crossings(kinds: set[str]) -> list[Any]:
    """What the legend says of the lines: which multipliers leave the unit circle there."""
    from matplotlib.lines import Line2D

    shown = ((kind, words) for kind, words in CROSSINGS.items() if kind in kinds)
    return [Line2D([], [], label=words, **(LINES[kind] | LINE)) for kind, words in shown]


def _lines(boundary: Tongue | Curve, x: str) -> list[tuple[Any, Any]]:
    """What to draw of a boundary, whichever axis Omega is."""
    if isinstance(boundary, Curve):
        return [(boundary.x, boundary.y)]
    edges = [(edge, boundary.y) for edge in (boundary.lower, boundary.upper)]
    return edges if x == "Omega" else [(y, edge) for edge, y in edges]


def _growth(figure: Any, axes: Any, chart: Chart) -> None:
    """T as colour, white where the system is stable."""
    from matplotlib.colors import LogNorm

    x, y = chart.axes
    unstable = np.ma.array(chart.T, mask=~(chart.unstable() & np.isfinite(chart.T)))
    if unstable.count():
        top = float(unstable.max())
        shown = axes.imshow(
            unstable,
            extent=(x.low, x.high, y.low, y.high),
            origin="lower",
            aspect="auto",
            cmap="viridis_r",
            norm=LogNorm(max(top / 300.0, 1e-5), top),
            interpolation="none",
            rasterized=True,
        )
        figure.colorbar(shown, ax=axes, pad=0.015, label="$T$, twice the growth exponent")


def _legend(axes: Any, chart: Chart, marks: list[Any]) -> None:
    """Where no verdict is shown, and where T is beyond a float or there is no equation."""
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    x, y = chart.axes
    infinite = np.isinf(chart.T)
    found: tuple[tuple[Any, str, Any], ...] = (
        (chart.undecided() & ~infinite, "undecided", "0.55"),
        (chart.undecided() & infinite, "no equation", "tab:orange"),
        (chart.unstable() & infinite, "growth beyond a float", "tab:red"),
    )
    handles: list[Any] = [Patch(fc="white", ec="black", lw=0.4, label="stable")]
    if chart.certified:
        words = "cell not proven as a whole"
        found += ((chart.certified.cells == "undecided", words, UNPROVEN),)
    for where, label, colour in found:
        if np.any(where):
            axes.imshow(
                np.ma.array(np.ones(where.shape), mask=~where),
                extent=(x.low, x.high, y.low, y.high),
                origin="lower",
                aspect="auto",
                cmap=ListedColormap([colour]),
                interpolation="none",
                rasterized=True,
            )
            handles.append(Patch(fc=colour, ec="none", label=label))
    handles += marks
    if len(handles) > 1:
        axes.legend(
            handles=handles,
            loc="upper left",
            bbox_to_anchor=(0.0, -0.12),
            ncols=len(handles) if len(handles) <= LEGEND else ceil(len(handles) / 2),
            fontsize=6.5,
            frameon=False,
        )


def _disagreement(figure: Any, axes: Any, chart: Chart) -> None:
    """How far the routes differ, at every node."""
    from matplotlib.colors import LogNorm

    apart = np.maximum(chart.apart, MIN_DISAGREEMENT)
    shown = axes.scatter(*chart.sampled.T, c=apart, s=7, cmap="magma_r", norm=LogNorm(), lw=0)
    of = symbol(chart.scenario.reading.variable)
    label = f"largest difference of a coefficient of $P$({of}),\nover the largest coefficient"
    figure.colorbar(shown, ax=axes, pad=0.015, label=label)


def _name(axes: Any, chart: Chart, boundaries: Sequence[Tongue]) -> None:
    """Names of the wider tongues at their far ends, none on top of another."""
    x, y = chart.axes
    along, other = (x, y) if x.name == "Omega" else (y, x)
    tops = []
    for tongue in boundaries:
        end = min(other.high, float(tongue.y[-1]))
        low, high = tongue.at(end) or (np.nan, np.nan)
        if along.low < 0.5 * (low + high) < along.high:
            tops.append((high - low, 0.5 * (low + high), end, of_resonance(tongue.resonance)))
    taken: list[float] = []
    upright = along is x
    for _, centre, end, name in sorted(tops, reverse=True):
        if all(abs(centre - t) > 0.03 * (along.high - along.low) for t in taken):
            taken.append(centre)
            axes.annotate(
                name,
                (centre, end) if upright else (end, centre),
                xytext=(0, -3) if upright else (-3, 0),
                textcoords="offset points",
                rotation=90 if upright else 0,
                ha="center" if upright else "right",
                va="top" if upright else "center",
                fontsize=6.5,
                bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7},
            )


def _marked(axes: Any, chart: Chart, marks: Sequence[Mark], label: str) -> list[Any]:
    """Draw the marks that lie on the chart; what the legend shows of them."""
    x, y = chart.axes
    handles = []
    for unstable, fill in ((True, "black"), (False, "white")):
        own = [
            (m.x, m.y)
            for m in marks
            if m.unstable == unstable and x.low <= m.x <= x.high and y.low <= m.y <= y.high
        ]
        if own:
            words = f"{label}: {'unstable' if unstable else 'stable'}"
            look: Any = {"ms": 2.6, "mfc": fill, "mec": "black", "mew": 0.5, "label": words}
            handles += axes.plot(*np.transpose(own), "o", **look)
    return handles


def _title(chart: Chart, given: str) -> str:
    kind = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(chart.system).__name__)
    text = ", ".join(f"{symbol(k)} = {of_value(v)}" for k, v in chart.scenario.fixed.items())
    words = (given or kind.lower()).replace("$", r"\$") + (f": {text}" if text else "")
    if chart.route == "both":
        words += f"; the routes differ by {chart.disagreement:.0e} of P at most"
        words += ", with the same matrices" if chart.shared_matrices else ""
    return "\n".join(_wrapped(words.split(" ")))


def _wrapped(words: list[str]) -> list[str]:
    """Lines of words, as long as they look: mathematics has letters that are not seen."""
    lines: list[str] = []
    length = TITLE_WIDTH
    for word in words:
        seen = len(re.sub(r"\\mathrm|\\[A-Za-z]+|[${}_\\]", lambda m: "x" * (len(m[0]) > 1), word))
        length += 1 + seen
        if length > TITLE_WIDTH:
            lines.append(word)
            length = seen
        else:
            lines[-1] += f" {word}"
    return lines
