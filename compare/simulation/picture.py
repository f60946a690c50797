"""A simulated motion as a picture: each coordinate in time under its envelope exp(T tau/2)."""

import io
import math
from typing import Any

import numpy as np

from compare.chart_picture import NO_PICTURES, STYLE
from compare.provenance import picture_metadata
from compare.report.figures.style import SEQUENCE
from compare.simulation.followed import Float, Followed
from compare.simulation.text import about, headline

MOST = 6
"""Coordinates that are drawn, those with the largest shares."""

DRAWN = 120
"""Periods that are drawn sample by sample; of more what each stretch lies between."""
STRETCHES = 800

SPAN = 1e3
"""Growth or decay over which the axes are logarithmic."""

PRINTED: dict[str, Any] = {"color": "#B00020", "linewidth": 1.0, "linestyle": (0, (1, 1.5))}
ENVELOPE: dict[str, Any] = {"color": "black", "linewidth": 0.7, "linestyle": (0, (5, 2))}


def picture(f: Followed, kind: str) -> bytes:
    """The history as PNG, SVG or PDF.

    Raises
    ------
    ValueError
        matplotlib is not installed.
    """
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.lines import Line2D
    except ImportError:
        raise ValueError(NO_PICTURES) from None
    shown = _shown(f)
    with matplotlib.rc_context(STYLE):
        height = 0.9 + 1.25 * len(shown)
        figure = Figure(figsize=(7.2, height), layout="constrained")
        FigureCanvasAgg(figure)
        panels = figure.subplots(len(shown), sharex=True, squeeze=False)[:, 0]
        for axes, i, colour in zip(panels, shown, _colours(len(shown)), strict=True):
            _panel(axes, f, i, colour)
        time = f.subject.in_time
        unit = f", {f.subject.time}" if f.subject.time else ""
        panels[-1].set_xlabel(f"time{unit}" if time else "periods of the forcing")
        panels[0].set_title(_title(f), fontsize=8, loc="left")
        growth = "$e^{T t/2}$" if time else r"$e^{T \tau/2}$"
        lines = [Line2D([], [], label=growth, **ENVELOPE)]
        if _print_is_bounded(f):
            lines.append(Line2D([], [], label=f"as printed, T = {f.subject.printed}", **PRINTED))
        panels[0].legend(
            handles=lines, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2,
            fontsize=7, frameon=False,
        )  # fmt: skip
        figure.align_ylabels(list(panels))
        buffer = io.BytesIO()
        metadata = picture_metadata(about(f), kind)
        figure.savefig(buffer, format=kind, dpi=200, metadata=metadata)
    return buffer.getvalue()


def _panel(axes: Any, f: Followed, i: int, colour: str) -> None:
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    h = f.history
    x = h.tau if f.subject.in_time else h.tau / h.source.period
    q, envelope = h.q[:, i], f.log_envelope[:, i]
    logarithmic = abs(0.5 * f.known.T * h.tau[-1]) > math.log(SPAN) and bool(np.any(q))
    if logarithmic:
        # powers of ten on a plain axis: a float's whole range would overflow the other
        at, _, high = _stretches(x, np.abs(q))
        axes.plot(at[high > 0.0], np.log10(high[high > 0.0]), color=colour, linewidth=1.0)
        axes.plot(x, envelope / math.log(10.0), **ENVELOPE)
        _as_printed(axes, f, x, lambda level: level / math.log(10.0), envelope[0])
        axes.yaxis.set_major_locator(MaxNLocator(5, integer=True))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"$10^{{{value:.0f}}}$"))
    else:
        if h.periods <= DRAWN:
            axes.plot(x, q, color=colour, linewidth=0.6)
        else:
            at, low, high = _stretches(x, q)
            axes.fill_between(at, low, high, color=colour, alpha=0.75, linewidth=0.4)
        for side in (1.0, -1.0):
            axes.plot(x, side * np.exp(envelope), **ENVELOPE)
        _as_printed(axes, f, x, lambda level: np.exp(np.minimum(level, 700.0)), envelope[0])
        axes.axhline(0.0, color="0.6", linewidth=0.4, zorder=0)
    axes.margins(x=0.0)
    axes.set_ylabel(f"|{f.names[i]}|" if logarithmic else f.names[i])
    axes.tick_params(labelsize=7)


def _as_printed(axes: Any, f: Followed, x: Float, shown: Any, start: float) -> None:
    """Where the motion would stay by print; where it would grow no axes have it."""
    if _print_is_bounded(f):
        axes.plot(x[[0, -1]], [shown(start)] * 2, **PRINTED)


def _stretches(x: Float, q: Float) -> tuple[Float, Float, Float]:
    """Least and largest of equal stretches of a history, and where these are."""
    count = min(STRETCHES, len(x))
    edges = np.linspace(0, len(x), count + 1).astype(int)[:-1]
    return x[edges], np.minimum.reduceat(q, edges), np.maximum.reduceat(q, edges)


def _print_is_bounded(f: Followed) -> bool:
    return f.print_is_wrong and float(f.subject.printed) == 0.0


def _shown(f: Followed) -> list[int]:
    """The coordinates drawn, in their own order."""
    size = np.max(np.abs(f.history.q), axis=0)
    order = np.argsort(-size, kind="stable")[:MOST]
    return sorted(int(i) for i in order)


def _colours(count: int) -> list[str]:
    return [SEQUENCE[k % len(SEQUENCE)] for k in range(count)]


def _title(f: Followed) -> str:
    lines = [f.subject.title, headline(f)]
    if f.history.stopped:
        lines.append(f.history.stopped)
    if f.print_is_wrong and not _print_is_bounded(f):
        printed = float(f.subject.printed)
        periods = math.log(10.0) / (0.5 * printed * f.history.source.period)
        lines.append(
            f"as printed, T = {f.subject.printed}, it would grow tenfold in {periods:,.0f} periods"
        )
    return "\n".join(line.replace("$", r"\$") for line in lines)
