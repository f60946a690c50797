"""A study's chart: T over the pulsation's frequency in cycles and its ratio, as a picture."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from compare.chart_picture import PICTURES, Mark, picture
from compare.charts.axis import Axis
from compare.charts.compute import chart
from compare.charts.result import Chart
from compare.charts.scenario import scenario
from compare.edges.on_chart import tongues
from compare.edges.tongue import Tongue
from compare.explorer.page import check_explorable, explorer_page
from compare.vehicle.outlines import outlines
from compare.vehicle.study import Study
from hill import Vehicle

SUFFIXES = (*PICTURES, ".html")

# Points of the picture's axes: as many as it has dots, about.
COUNTS = (600, 300)

# And where P is one of the multipliers: T takes the eigenvalues of a matrix at every point.
COUNTS_GENERAL = (300, 150)

# Pulsation ratios that are drawn, over the vehicle's own and over the lowest that opens a band.
OVER_OWN, OVER_LOWEST = 3.0, 2.0
LARGEST = 1.0

# Of the lowest resonance, where the range has no beginning; and of the range's end: P oscillates
# in 1/Omega, and takes nodes in proportion.
BELOW, LEAST = 0.8, 0.02
# And of it where the picture reaches no farther than what opens in it.
LEAST_SEEN = 0.01

# Over the highest resonance, which may be the range's end: its tongue is drawn.
BEYOND = 1.04


def check_charted(vehicle: Vehicle, gamma: float, eta: float, path: Path) -> None:
    """Refuse a chart that there will be none of, before anything is computed."""
    if path.suffix not in SUFFIXES:
        raise ValueError(f"--chart {path}: must end in {', '.join(SUFFIXES)}")
    if path.suffix == ".html":
        check_explorable(2)
    scale = float(abs(vehicle.natural_frequencies()[-1]))
    try:
        scenario(vehicle, (Axis("Omega", scale, 2.0 * scale, 2), _ratios(gamma, 2)), {"eta": eta})
    except ValueError as why:
        raise ValueError(f"--chart {path}: {why}") from None


def charted(study: Study, stage: Callable[[str, int, int], Any]) -> tuple[Chart, list[Tongue]]:
    """The chart of what was studied, and its tongues.

    Of Hill's equation both routes make the chart, and the tongues are followed on it. Of any other
    the time domain makes it alone, for a determinant takes tens of milliseconds a node, and the
    tongues are the study's own bands, by Hill's matrix.

    Parameters
    ----------
    study : Study
    stage : callable
        As of `study`.
    """
    system, forcing = study.vehicle, {"eta": study.eta}
    opens = min((row.critical for row in study.rows if row.critical), default=0.0)
    top = min(max(OVER_OWN * abs(study.gamma), OVER_LOWEST * opens), LARGEST)
    low, high = _range(study, top)

    def axes(counts: tuple[int, int]) -> tuple[Axis, Axis]:
        return Axis("Omega", low, high, counts[0]), _ratios(top, counts[1])

    def followed(done: int, of: int) -> None:
        stage("tongues", done, of)

    if not scenario(system, axes(COUNTS), forcing).reading.general:
        made = chart(system, axes(COUNTS), forcing=forcing, stage=stage)
        return made, list(tongues(made, study.orders, progress=followed))
    made = chart(system, axes(COUNTS_GENERAL), forcing=forcing, route="floquet", stage=stage)
    return made, outlines(study, top, followed)


def _range(study: Study, top: float) -> tuple[float, float]:
    """Omega from one end of the picture to the other: what was asked for, or what there is to see.

    That is the operating point and what opens below the picture's top, or else the resonances.
    """
    rows = [row.band.Omega for row in study.rows]
    opening = [r.band.Omega for r in study.rows if r.critical is not None and r.critical < top]
    if study.of_itself and opening:
        seen = [*opening, *([study.Omega] if study.Omega else [])]
        return max(BELOW * min(seen), LEAST_SEEN * study.high), max(seen) / BELOW
    low = study.low or max(BELOW * min(rows, default=study.high), LEAST * study.high)
    return low, max(study.high, BEYOND * max(rows, default=0.0))


def drawn(title: str, study: Study, kind: str, stage: Callable[[str, int, int], Any]) -> bytes:
    """The chart as a picture or a page, the tongues by their names; pictures mark where it runs."""
    made, edges = charted(study, stage)
    stage("picture", 0, 0)
    return shown(title, study, made, edges, kind)


def shown(title: str, study: Study, made: Chart, edges: Sequence[Tongue], kind: str) -> bytes:
    """The same of a chart that is there already."""
    if made.route == "floquet":
        title = f"{title}: T by the time domain, tongues by Hill's matrix"
    if kind == "html":
        return explorer_page(made, title=title, tongues=edges).encode()
    marks = []
    if study.operating is not None and study.Omega is not None:
        marks.append(Mark(study.Omega, abs(study.gamma), study.operating.verdict == "unstable"))
    unit = study.vehicle.units.frequency
    name = f"pulsation of the thrust, {unit or 'cycles per unit of time'}"
    return picture(
        made, edges, kind, title=title, marks=marks, marks_label="operating", in_cycles=name
    )


def _ratios(top: float, count: int) -> Axis:
    return Axis("gamma", 0.0, abs(top), count)
