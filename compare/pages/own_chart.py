"""The chart that goes with the pages of one's own system: which axes, and what is told of it."""

from collections.abc import Callable
from dataclasses import replace
from importlib.util import find_spec

import numpy as np

from compare.chart_files import tongues_csv
from compare.chart_picture import NO_PICTURES
from compare.chart_saving import content
from compare.chart_text import describe, ended, told, tongue_cells
from compare.charts.compute import chart
from compare.charts.scenario import scenario
from compare.edges.curves import boundaries
from compare.edges.instabilities import instabilities
from compare.edges.interpolated import axes_of
from compare.edges.on_chart import tongues
from compare.edges.unnamed import unnamed
from compare.explorer.page import NO_EXPLORER
from compare.pages.own import Charted
from compare.pages.site import Table
from compare.system_file import Described
from compare.vehicle.charted import charted as charted_study
from compare.vehicle.charted import shown
from compare.vehicle.study import Study
from hill.system import natural_frequencies

Stage = Callable[[str, int, int], None]
Axes = tuple[tuple[str, float, float, int], ...]

# Points of axes that nobody asked for: a page's width. A general equation's T takes the eigenvalues
# of a matrix at every point; and its determinant tens of milliseconds a node, so that the time
# domain charts it alone, as of a vehicle.
COUNTS, COUNTS_GENERAL = (400, 200), (160, 80)

# Frequencies whose resonances are charted, the lowest ones, and what of the range lies beside them.
FIRST = 4
BELOW, ABOVE = 0.6, 1.15
# P oscillates in 1/Omega and takes nodes in proportion: no lower than this share of the highest.
LEAST = 1 / 30
# Of the forcing's own gamma; and where that is 0.
OVER_OWN, WITHOUT = 2.0, 0.5


def charted(found: Described, stage: Stage) -> Charted:
    """The chart of a file's own axes, or of Omega and gamma about its resonances."""
    try:
        axes = found.axes or _lowest(found)
        if len(axes) != 2:
            return Charted((f"No chart: a page shows two axes, the file has {len(axes)}.",))
        forcing = {k: v for k, v in found.forcing.items() if k not in [name for name, *_ in axes]}
        general = scenario(found.system, axes, forcing).reading.general
        route = "floquet" if general else "both"
        if general and not found.axes:
            axes = tuple(
                (*axis[:3], count) for axis, count in zip(axes, COUNTS_GENERAL, strict=True)
            )
        made = chart(found.system, axes, forcing=forcing, route=route, stage=stage)
        made.verdict()
    except ValueError as why:
        return Charted((f"No chart: {why}.",))
    lines = [*describe(made)]
    if general:
        lines.append("By the time domain alone: of this kind of equation it is the quicker one.")
    if "Omega" not in made.scenario.names:
        stage("picture", 0, 0)
        return _shown(lines, lambda kind: content(made, kind, boundaries(made), title=found.title))
    other = axes_of(made)[1].name
    edges = tongues(made, progress=lambda k, n: stage("resonances followed", k, n))
    stage("their widths", 0, 0)
    known = instabilities(made, edges)
    lines += [*ended(known, other), *map(told, unnamed(made, edges))]
    heads, rows = tongue_cells(known, other)
    listed = Table("Tongues, the widest first", tuple(heads), tuple(map(tuple, rows)), words=3)
    stage("picture", 0, 0)
    return replace(
        _shown(lines, lambda kind: content(made, kind, edges, title=found.title)),
        tongues=listed if rows else None,
        files={"tongues.csv": tongues_csv(made, known, other)},
    )


def vehicle_charted(title: str, study: Study, stage: Stage) -> Charted:
    """The chart of a vehicle, in cycles; its resonances are on a page of their own."""
    try:
        made, edges = charted_study(study, stage)
    except ValueError as why:
        return Charted((f"No chart: {why}.",))
    stage("picture", 0, 0)
    lines = [
        *describe(made),
        "A circle in the picture is the operating point, filled where it is unstable.",
    ]
    return _shown(lines, lambda kind: shown(title, study, made, edges, kind.removeprefix(".")))


def _shown(lines: list[str], draw: Callable[[str], bytes]) -> Charted:
    """As a picture and as a page to explore, or with a line that says why there is none."""
    found = {}
    for kind, library, missing in (
        (".svg", "matplotlib", f"No picture: {NO_PICTURES}."),
        (".html", "bokeh", f"Not to be explored: {NO_EXPLORER}."),
    ):
        try:
            found[kind] = draw(kind) if find_spec(library) else b""
        except ValueError as why:
            found[kind], missing = b"", f"Not drawn: {why}."
        if not found[kind]:
            lines.append(missing)
    return Charted(tuple(lines), found[".svg"], found[".html"])


def _lowest(found: Described) -> Axes:
    """Omega and gamma about the lowest resonances and what the file asks for."""
    w = np.sort(np.real(natural_frequencies(found.system)))
    w = w[w > 1e-6 * np.max(np.abs(w), initial=0.0)][:FIRST]
    if not len(w):
        raise ValueError("nothing oscillates, so that there are no resonances to chart")
    seen = [2.0 * float(w[0]), 2.0 * float(w[-1]), found.forcing["Omega"]]
    if len(w) > 1:
        seen.append(float(np.min(np.diff(w))))
    high = ABOVE * max(seen)
    low = max(BELOW * min(seen), LEAST * high)
    top = OVER_OWN * abs(found.forcing["gamma"]) or WITHOUT
    return (("Omega", low, high, COUNTS[0]), ("gamma", 0.0, top, COUNTS[1]))
