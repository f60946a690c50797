"""A chart as a file of any kind, by its suffix."""

from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path

from compare import chart_files
from compare.chart_picture import NO_PICTURES, Mark, picture
from compare.charts.result import Chart
from compare.edges.curves import Curve, boundaries
from compare.edges.instabilities import Instability, instabilities
from compare.edges.on_chart import ORDERS, tongues
from compare.edges.tongue import Tongue
from compare.explorer.page import check_explorable, explorer_page
from compare.output import check_writable, write_whole

PICTURES = (".png", ".svg")
SUFFIXES = (*PICTURES, ".html", ".npz", ".json", ".csv")

Stage = Callable[[str, int, int], object]


def check_saved(path: Path, axes: int) -> None:
    """Refuse what could not be written, before anything is computed.

    Raises
    ------
    ValueError
        A suffix that says nothing, a file that cannot be written, a picture or a page of too many
        axes, or one that nothing here can draw.
    """
    if path.suffix not in SUFFIXES:
        raise ValueError(f"output = {str(path)!r}: must end in {', '.join(SUFFIXES)}")
    check_writable(path)
    if path.suffix == ".html":
        check_explorable(axes)
    if path.suffix in PICTURES:
        if axes != 2:
            raise ValueError(f"output = {str(path)!r}: a picture needs two axes")
        if find_spec("matplotlib") is None:
            raise ValueError(NO_PICTURES)


def has_tongues(chart: Chart, suffix: str) -> bool:
    """Whether a file of this kind has the chart's tongues."""
    own = len(chart.axes) == 2 and "Omega" in chart.scenario.names
    return own and suffix in (*PICTURES, ".html", ".json")


def edges_of(
    chart: Chart, suffix: str, order: int = ORDERS, stage: Stage = lambda *_: None
) -> Sequence[Tongue | Curve]:
    """The lines that a file of this kind has: tongues, or boundaries without names."""
    if has_tongues(chart, suffix):
        return tongues(chart, order, progress=lambda k, n: stage("resonances followed", k, n))
    if suffix in PICTURES:
        stage("boundaries", 0, 0)
        return boundaries(chart)
    return ()


def content(
    chart: Chart,
    suffix: str,
    edges: Sequence[Tongue | Curve] = (),
    found: Sequence[Instability] = (),
    *,
    show: str = "T",
    title: str = "",
    marks: Sequence[Mark] = (),
) -> bytes:
    """What a file of this kind holds."""
    if suffix == ".npz":
        return chart_files.npz(chart)
    if suffix == ".csv":
        return chart_files.as_csv(chart)
    if suffix == ".json":
        return chart_files.as_json(chart, found)
    if suffix == ".html":
        own = [edge for edge in edges if isinstance(edge, Tongue)]
        return explorer_page(chart, title=title, tongues=own).encode()
    return picture(chart, edges, suffix[1:], show, title=title, marks=marks, marks_label="printed")


def save(chart: Chart, path: Path, title: str = "") -> None:
    """Write it; see `Chart.save`."""
    check_saved(path, len(chart.axes))
    edges = edges_of(chart, path.suffix)
    own = tuple(edge for edge in edges if isinstance(edge, Tongue))
    found = instabilities(chart, own) if path.suffix == ".json" and own else ()
    write_whole(path, content(chart, path.suffix, edges, found, title=title))
