"""A study's chart: T over the pulsation's frequency in cycles and its ratio, as a picture."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from compare.chart_picture import Mark, picture
from compare.charts.axis import Axis
from compare.charts.compute import chart
from compare.charts.result import Chart
from compare.charts.scenario import scenario
from compare.edges.on_chart import tongues
from compare.edges.tongue import Tongue
from compare.vehicle.study import Study
from hill import Vehicle

PICTURES = (".png", ".svg")

# Points of the picture's axes: as many as it has dots, about.
COUNTS = (600, 300)

# Pulsation ratios that are drawn, over the vehicle's own and over the lowest that opens a band.
OVER_OWN, OVER_LOWEST = 3.0, 2.0
LARGEST = 1.0

# Of the lowest resonance, where the range has no beginning; and of the range's end.
BELOW, LEAST = 0.8, 0.02

# Over the highest resonance, which may be the range's end: its tongue is drawn.
BEYOND = 1.04


def check_charted(vehicle: Vehicle, gamma: float, eta: float, path: Path) -> None:
    """Refuse a chart that there will be none of, before anything is computed."""
    if path.suffix not in PICTURES:
        raise ValueError(f"--chart {path}: must end in {' or '.join(PICTURES)}")
    system, forcing = _as_charts_have_it(vehicle, eta)
    scale = float(abs(vehicle.natural_frequencies()[-1]))
    try:
        scenario(system, (Axis("Omega", scale, 2.0 * scale, 2), _ratios(gamma, 2)), forcing)
    except ValueError as why:
        raise ValueError(f"--chart {path}: {why}") from None


def charted(study: Study, stage: Callable[[str, int, int], Any]) -> tuple[Chart, list[Tongue]]:
    """The chart of what was studied, and its tongues.

    Parameters
    ----------
    study : Study
    stage : callable
        As of `study`.
    """
    system, forcing = _as_charts_have_it(study.vehicle, study.eta)
    rows = [row.band.Omega for row in study.rows]
    low = study.low or max(BELOW * min(rows, default=study.high), LEAST * study.high)
    high = max(study.high, BEYOND * max(rows, default=0.0))
    opens = min((row.critical for row in study.rows if row.critical), default=0.0)
    top = min(max(OVER_OWN * abs(study.gamma), OVER_LOWEST * opens), LARGEST)
    made = chart(
        system,
        (Axis("Omega", low, high, COUNTS[0]), _ratios(top, COUNTS[1])),
        forcing=forcing,
        stage=stage,
    )
    found = tongues(made, study.orders, progress=lambda k, n: stage("tongues", k, n))
    return made, list(found)


def drawn(title: str, study: Study, kind: str, stage: Callable[[str, int, int], Any]) -> bytes:
    """The picture as PNG or SVG, the tongues by their names, the operating point marked."""
    made, edges = charted(study, stage)
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


def _as_charts_have_it(vehicle: Vehicle, eta: float) -> tuple[Vehicle, dict[str, float]]:
    """Its damping of all coordinates alike as the forcing's eta: a chart's T is read with that."""
    own = vehicle.damping
    return replace(vehicle, damping=replace(own, eta=0.0)), {"eta": eta + own.eta}
