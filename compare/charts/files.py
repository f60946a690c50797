"""A chart, and its tongues, as files."""

import csv
import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.charts.result import Chart
from compare.provenance import as_line
from compare.tongues.instabilities import Instability


def about(chart: Chart) -> dict[str, Any]:
    """The system, its forcing and the axes of a chart, for its files."""
    beam = chart.family.beam
    return {
        "system": type(beam).__name__,
        "parameters": vars(beam),
        "forcing": dict(chart.family.forcing),
        "axes": [[a.name, a.low, a.high, a.count] for a in chart.axes],
        "route": chart.route,
        "error_of_P": chart.error,
    }


def npz(chart: Chart) -> bytes:
    """Everything: axes, T, verdicts, errors, nodes and how far the routes differ there.

    And `provenance`, a line of JSON: system, forcing, version, units.
    """
    buffer = io.BytesIO()
    named = {axis.name: axis.points for axis in chart.axes}
    np.savez_compressed(
        buffer,
        T=chart.T,
        unstable=chart.unstable(),
        undecided=chart.undecided(),
        provenance=as_line(about(chart)),
        error=chart.error,
        disagreement=chart.disagreement,
        nodes=chart.sampled,
        apart=chart.apart,
        **named,  # type: ignore[arg-type]
    )
    return buffer.getvalue()


def as_csv(chart: Chart) -> bytes:
    """One line a point: the axes and T."""
    text = io.StringIO()
    names = [axis.name for axis in chart.axes]
    csv.writer(text, lineterminator="\n").writerow([*names, "T"])
    mesh = np.meshgrid(*(axis.points for axis in chart.axes), indexing="ij")
    columns = [m.ravel() for m in mesh] + [np.transpose(chart.T).ravel()]
    np.savetxt(text, np.column_stack(columns), fmt="%.12g", delimiter=",")
    return text.getvalue().encode()


def tongues_csv(found: Sequence[Instability], other: str) -> bytes:
    """One line for each tongue and value of the other parameter: its edges and their error."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["resonance", "type", "order", other, "lower", "upper", "error"])
    for i in found:
        head = [i.resonance.name, i.resonance.type, i.resonance.order]
        rows = zip(i.tongue.y, i.tongue.lower, i.tongue.upper, i.edge_error, strict=True)
        for y, lower, upper, error in rows:
            writer.writerow([*head, f"{y:.12g}", f"{lower:.14g}", f"{upper:.14g}", f"{error:.1e}"])
    return text.getvalue().encode()
