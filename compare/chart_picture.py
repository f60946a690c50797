"""A chart as a picture: T as colour, boundaries as lines, tongues named, marks on top."""

import io
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np

from compare.chart_edges import draw_edges
from compare.chart_files import about
from compare.chart_growth import NAMES, growth_as_colour, growth_as_curve, pixels_of
from compare.chart_names import write_names
from compare.chart_pixels import Pixels
from compare.chart_ticks import ticks_in_cycles
from compare.charts.result import Chart
from compare.edges.curves import Curve
from compare.edges.tongue import Tongue
from compare.edges.unnamed import uncovered
from compare.provenance import picture_metadata
from compare.symbols import of_value, symbol
from hill import checks

STYLE: Any = {
    "font.family": "serif",
    "mathtext.fontset": "cm",
    "font.size": 9,
    "axes.linewidth": 0.6,
    "svg.hashsalt": "floquet-crosscheck",
}


PICTURES = (".png", ".svg", ".pdf")

SIZE, SIZES = (7.2, 4.6), (2.0, 40.0)
"""Width and height in inches where nothing is said, and what they may be."""

DPI = 200
CHARACTERS = 16.5
"""Of a title's line, an inch."""

LETTER, HANDLE = 0.052, 0.4
"""Inches of a legend's letter, and of what stands before its words."""

MOST_NAMELESS = 12
"""Regions without a name that have a sign, those of the largest T."""

NO_PICTURES = 'pictures need matplotlib: pip install "floquet-crosscheck[plot]"'

QUANTITIES = ("T", "disagreement")

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
    size: tuple[float, float] = SIZE,
    log: Collection[str] = (),
) -> bytes:
    """The chart as PNG, SVG or PDF: a map of T over two axes, or T along one.

    Parameters
    ----------
    chart : Chart
    boundaries : sequence of Tongue or Curve
        Drawn as lines; tongues with their names.
    kind : {"png", "svg", "pdf"}
    quantity : {"T", "disagreement"}, optional
        T over the chart, or how far the two routes differ at its nodes.
    title : str, optional
        What the system is called; its type where nothing is said.
    marks : sequence of Mark, optional
    marks_label : str, optional
        What the legend calls them.
    in_cycles : str, optional
        What Omega's axis is called, in cycles per unit of time; in radians where nothing is said.
    size : tuple of float, optional
        Width and height in inches.
    log : collection of str, optional
        Axes that are logarithmic.

    Raises
    ------
    ValueError
        The chart has more than two axes, or no disagreement to draw; a logarithmic axis that is
        none of the chart's, or begins at 0; matplotlib is not installed.
    """
    check_drawn([(a.name, a.low) for a in chart.axes], size, log)
    if quantity == "disagreement" and (chart.route != "both" or len(chart.axes) != 2):
        raise ValueError(
            f"disagreement: needs two axes and route = 'both', the chart has {chart.route!r}"
        )
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=size, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.add_subplot()
        for axis, scale in zip(chart.axes, (axes.set_xscale, axes.set_yscale), strict=False):
            scale("log" if axis.name in log else "linear")
        if quantity == "disagreement":
            _disagreement(figure, axes, chart)
        elif len(chart.axes) == 1:
            growth_as_curve(axes, chart, size, log)
        else:
            _map(figure, axes, chart, boundaries, marks, marks_label, size, log)
        _frame(axes, chart, in_cycles)
        words = _title(chart, title, characters=int(size[0] * CHARACTERS))
        figure.suptitle(words, fontsize=8, x=0.01, ha="left")
        buffer = io.BytesIO()
        metadata = picture_metadata(about(chart), kind)
        figure.savefig(buffer, format=kind, dpi=DPI, metadata=metadata)
    return buffer.getvalue()


def check_drawn(
    axes: Sequence[tuple[str, float]], size: tuple[float, float], log: Collection[str]
) -> None:
    """Refuse a picture that there will be none of, before anything is computed.

    Parameters
    ----------
    axes : sequence of (name, low)
    size, log
        As for `picture`.

    Raises
    ------
    ValueError
        More than two axes; a size that is no picture's; a logarithmic axis that cannot be;
        matplotlib is not installed.
    """
    if len(axes) > 2:
        raise ValueError(f"output: a picture needs one or two axes, the chart has {len(axes)}")
    for name, value in zip(("width", "height"), size, strict=True):
        checks.between(f"{name} of the picture", value, *SIZES)
    lows = dict(axes)
    for name in log:
        if name not in lows:
            raise ValueError(f"log = {name!r}: must be an axis, {' or '.join(lows)}")
        if lows[name] <= 0.0:
            raise ValueError(f"log = {name!r}: begins at {lows[name]:g}; must be greater than 0")
    if find_spec("matplotlib") is None:
        raise ValueError(NO_PICTURES)


def _frame(axes: Any, chart: Chart, in_cycles: str) -> None:
    x, *others = chart.axes
    axes.set_xlim(x.low, x.high)
    axes.set_xlabel(symbol(x.name))
    for y in others:
        axes.set_ylim(y.low, y.high)
        axes.set_ylabel(symbol(y.name))
    if in_cycles:
        ticks_in_cycles(axes, x.name, in_cycles)


def _map(
    figure: Any,
    axes: Any,
    chart: Chart,
    boundaries: Sequence[Tongue | Curve],
    marks: Sequence[Mark],
    marks_label: str,
    size: tuple[float, float],
    log: Collection[str],
) -> None:
    x, y = chart.axes
    shown = pixels_of(chart, size, log)
    handles = growth_as_colour(figure, axes, chart, shown, log)
    handles += draw_edges(axes, boundaries, x.name)
    handles += _marked(axes, chart, marks, marks_label)
    if "Omega" in chart.scenario.names:
        own = [b for b in boundaries if isinstance(b, Tongue)]
        upright = x.name == "Omega"
        length = (0.8 if upright else 0.7) * size[0 if upright else 1]
        write_names(axes, own, x, y, log, length)
        handles += _nameless(axes, chart, shown, own)
    if len(handles) > 1:
        axes.legend(
            handles=handles,
            loc="upper left",
            bbox_to_anchor=(0.0, -0.55 / size[1]),
            ncols=_columns([handle.get_label() for handle in handles], 0.8 * size[0]),
            fontsize=NAMES,
            frameon=False,
        )


def _nameless(axes: Any, chart: Chart, shown: Pixels, tongues: Sequence[Tongue]) -> list[Any]:
    """A sign where an unstable region has no tongue's name; what the legend says of it."""
    x, y = chart.axes
    upright = x.name == "Omega"
    unstable, T = shown.verdict == "unstable", shown.T
    Omega, other = shown.points if upright else shown.points[::-1]
    if not upright:
        unstable, T = unstable.T, T.T
    regions = uncovered(Omega, other, unstable, T, tongues, y.name if upright else x.name)
    regions = regions[:MOST_NAMELESS]
    if not regions:
        return []
    places = [r.at if chart.axes[0].name == "Omega" else r.at[::-1] for r in regions]
    look: Any = {"marker": "$?$", "ls": "none", "color": "tab:red", "ms": 4.0, "mew": 0.3}
    axes.plot(*np.transpose(places), "o", ms=7.0, mfc="white", mec="none", alpha=0.85)
    return list(axes.plot(*np.transpose(places), label="unstable, no tongue's name", **look))


def _disagreement(figure: Any, axes: Any, chart: Chart) -> None:
    """How far the routes differ, at every node."""
    from matplotlib.colors import LogNorm

    apart = np.maximum(chart.apart, MIN_DISAGREEMENT)
    shown = axes.scatter(*chart.sampled.T, c=apart, s=7, cmap="magma_r", norm=LogNorm(), lw=0)
    of = symbol(chart.scenario.reading.variable)
    label = f"largest difference of a coefficient of $P$({of}),\nover the largest coefficient"
    figure.colorbar(shown, ax=axes, pad=0.015, label=label)


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


def _title(chart: Chart, given: str, characters: int) -> str:
    kind = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(chart.system).__name__)
    fixed = [f"{symbol(k)} = {of_value(v)}" for k, v in chart.scenario.fixed.items()]
    name = (given or kind.lower()).replace("$", r"\$")
    words = [*f"{name}{':' if fixed else ''}".split(" ")]
    words += [f"{text}," for text in fixed[:-1]] + fixed[-1:]
    if chart.route == "both":
        words[-1] += ";"
        words += f"the routes differ by {chart.disagreement:.0e} of P at most".split(" ")
        if chart.shared_matrices:
            words[-1] += ","
            words += ["with", "the", "same", "matrices"]
    return "\n".join(_wrapped(words, characters))


def _wrapped(words: list[str], characters: int) -> list[str]:
    """Lines of words, as long as they look: mathematics has letters that are not seen."""
    lines: list[str] = []
    length = characters
    for word in words:
        seen = _seen(word)
        length += 1 + seen
        if length > characters:
            lines.append(word)
            length = seen
        else:
            lines[-1] += f" {word}"
    return lines


def _seen(word: str) -> int:
    """Letters of it that are seen, of mathematics about."""
    return len(re.sub(r"\\mathrm|\\[A-Za-z]+|[${}_\\]", lambda m: "x" * (len(m[0]) > 1), word))


def _columns(labels: Sequence[str], inches: float) -> int:
    """As many columns of a legend, filled one after the other, as the picture is wide."""
    widths = [LETTER * _seen(label) + HANDLE for label in labels]
    for columns in range(len(labels), 1, -1):
        if sum(part.max() for part in np.array_split(widths, columns)) <= inches:
            return columns
    return 1
