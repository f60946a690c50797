"""A chart as a file of any kind, by its suffix."""

from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from compare import chart_files
from compare.chart_picture import PICTURES, SIZE, Mark, check_drawn, picture
from compare.charts.result import Chart
from compare.edges.curves import Curve, boundaries
from compare.edges.instabilities import Instability, instabilities
from compare.edges.on_chart import ORDERS, tongues
from compare.edges.tongue import Tongue
from compare.explorer.page import check_explorable, explorer_page
from compare.output import check_writable, write_whole

SUFFIXES = (*PICTURES, ".html", ".npz", ".json", ".csv")

Stage = Callable[[str, int, int], object]


def check_saved(
    path: Path,
    axes: Sequence[tuple[str, float]],
    size: tuple[float, float] = SIZE,
    log: Collection[str] = (),
) -> None:
    """Refuse what could not be written, before anything is computed.

    Parameters
    ----------
    path : Path
    axes : sequence of (name, low)
    size, log
        Of a picture.

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
        check_explorable(len(axes))
    if path.suffix in PICTURES:
        check_drawn(axes, size, log)


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
    if suffix in PICTURES and len(chart.axes) == 2:
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
    size: tuple[float, float] = SIZE,
    log: Collection[str] = (),
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
    return picture(
        chart,
        edges,
        suffix[1:],
        show,
        title=title,
        marks=marks,
        marks_label="printed",
        size=size,
        log=log,
    )


def save(chart: Chart, path: Path, title: str = "") -> None:
    """Write it; see `Chart.save`."""
    check_saved(path, [(a.name, a.low) for a in chart.axes])
    edges = edges_of(chart, path.suffix)
    own = tuple(edge for edge in edges if isinstance(edge, Tongue))
    found = instabilities(chart, own) if path.suffix == ".json" and own else ()
    write_whole(path, content(chart, path.suffix, edges, found, title=title))
