"""A chart as one HTML file that evaluates itself: no server, no network."""

import html
import json
from collections.abc import Sequence
from importlib.resources import files
from importlib.util import find_spec
from string import Template
from typing import Any

from compare.chart_files import about
from compare.charts.result import Chart
from compare.edges.tongue import Tongue
from compare.explorer.data import check_axes, data_of, label, per_cycle
from compare.provenance import in_words, provenance

NO_EXPLORER = 'a page to explore needs Bokeh: pip install "floquet-crosscheck[explore]"'

LARGEST = 20_000_000
"""Bytes of a page: more is no mail's attachment."""


def check_explorable(count: int) -> None:
    """Refuse a page that there will be none of, before anything is computed.

    Parameters
    ----------
    count : int
        Of axes.

    Raises
    ------
    ValueError
        Too few or too many of them; Bokeh is not installed.
    """
    check_axes(count)
    if find_spec("bokeh") is None:
        raise ValueError(NO_EXPLORER)


def explorer_page(chart: Chart, *, title: str = "", tongues: Sequence[Tongue] = ()) -> str:
    """The chart as one HTML page, with sliders for the third and fourth of its axes.

    The page holds the series of P, and the points that have none, and evaluates P, its roots, T and
    the verdict where the reader points, with the chart's bound on P. Names are those of the tongues
    that a point is in; where there are no tongues, that of its nearest resonance.

    Parameters
    ----------
    chart : Chart
        Of two to four axes.
    title : str, optional
        What the system is called; its type where nothing is said.
    tongues : sequence of Tongue, optional
        Of `compare.tongues`, on a chart of Omega and one other parameter: drawn and named.

    Raises
    ------
    ValueError
        The chart has one axis or more than four; Bokeh is not installed; the series are too large
        for one file.
    """
    check_explorable(len(chart.axes))
    data = json.dumps(data_of(chart, tongues)).replace("<", "\\u003c")
    if len(data) > LARGEST:
        raise ValueError(
            f"axes: the series of P take {len(data) / 1e6:.0f} MB, {LARGEST / 1e6:.0f} at most "
            "in a page; ask for a larger tolerance, narrower ranges or fewer points"
        )
    version, library = _bokeh()
    x, y, *others = (label(axis.name, chart.scenario) for axis in chart.axes)
    beside = f", with {' and '.join(others)}" if others else ""
    head = f"{title or type(chart.system).__name__}: T over {x} and {y}{beside}"
    record = provenance(about(chart))
    return Template(_own("page.html")).substitute(
        title=html.escape(head),
        made_by=html.escape(str(record["made_by"])),
        about=html.escape(_fixed(chart)),
        map_words=html.escape(f"Map of T over {x} and {y}"),
        error=html.escape(_known(chart)),
        words=html.escape(in_words(about(chart))),
        bokeh=html.escape(version),
        style=_own("page.css"),
        data=data,
        library=library,
        evaluate=_own("evaluate.js"),
        view=_own("view.js"),
    )


def _own(name: str) -> str:
    return (files("compare.explorer") / name).read_text(encoding="utf-8").rstrip()


def _bokeh() -> tuple[str, str]:
    """Its version and its scripts, each in an element."""
    import bokeh
    from bokeh.resources import Resources

    inline = Resources(
        mode="inline", components=["bokeh", "bokeh-api"], minified=True, log_level="warn"
    )
    scripts = inline.js_raw
    return bokeh.__version__, "\n".join(f"<script>\n{script}\n</script>" for script in scripts)


def _fixed(chart: Chart) -> str:
    """What does not vary."""
    of = chart.scenario
    words = [
        f"{label(name, of)} = {value / per_cycle(name, of):g}" for name, value in of.fixed.items()
    ]
    return ", ".join(words).replace("inf", "∞")


def _known(chart: Chart) -> str:
    if not any(piece.series is not None for piece in chart.surface.pieces):
        return "No series is good here: the map is of the chart's own points."
    found: Any = f"The coefficients of P are known to {chart.error:.0e}"
    return f"{found}; a verdict is given where this decides it, and “undecided” elsewhere."
