"""A chart, and its tongues, as files: each says what it is of, by which version, in which units."""

import csv
import io
import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.charts.identity import known_values, type_name
from compare.charts.result import Chart
from compare.edges.instabilities import Instability
from compare.provenance import as_comment, as_line, provenance
from hill.system import FORCING


def about(chart: Chart) -> dict[str, Any]:
    """The system, its forcing and the axes of a chart, and what is known of it."""
    return {
        "system": type_name(chart.system),
        "parameters": {k: v for k, v in chart.scenario.fixed.items() if k not in FORCING},
        "values": known_values(chart.system),
        "forcing": dict(chart.scenario.forcing),
        "axes": [[a.name, a.low, a.high, a.count] for a in chart.axes],
        "route": chart.route,
        "shared_matrices": chart.shared_matrices,
        "error_of_P": chart.error,
        "relative_error_of_P": chart.relative_error,
        "disagreement": _finite(chart.disagreement),
        "one_by_one": chart.one_by_one,
    } | ({"certified": _proven(chart)} if chart.certified else {})


def _proven(chart: Chart) -> dict[str, Any]:
    """What is proven, in numbers."""
    found = chart.certified
    assert found is not None
    return {
        "area": {kind: getattr(found, kind) for kind in ("stable", "unstable", "undecided")},
        "cells_proven": found.whole,
        "contradicted": chart.contradicted,
        "enclosures": found.enclosures,
        "remainder": found.remainder,
        "of_decimals": found.decimals,
    }


def npz(chart: Chart) -> bytes:
    """Everything: axes, T and its error, verdicts, nodes and how far the routes differ there.

    `certified`, of cells, where it was asked for; `provenance`, a line of JSON: system, forcing,
    version, units.
    """
    buffer = io.BytesIO()
    named: dict[str, Any] = {axis.name: axis.points for axis in chart.axes}
    if chart.certified:
        named["certified"] = chart.certified.cells
    np.savez_compressed(
        buffer,
        T=chart.T,
        T_error=chart.T_error(),
        verdict=chart.verdict(),
        unstable=chart.unstable(),
        undecided=chart.undecided(),
        provenance=as_line(about(chart)),
        error=chart.error,
        disagreement=chart.disagreement,
        nodes=chart.sampled,
        apart=chart.apart,
        **named,
    )
    return buffer.getvalue()


def as_csv(chart: Chart) -> bytes:
    """A line of provenance behind "# ", then one a point: the axes, T, its error, the verdict.

    And what is proven of its cell, where that was asked for.
    """
    text = io.StringIO()
    text.write(as_comment(about(chart)))
    names = [axis.name for axis in chart.axes]
    head = [*names, "T", "T_error", "verdict", *(["certified"] if chart.certified else [])]
    csv.writer(text, lineterminator="\n").writerow(head)
    mesh = np.meshgrid(*(axis.points for axis in chart.axes), indexing="ij")
    verdicts = np.transpose(chart.verdict()).ravel().tolist()
    if chart.certified:
        cells = np.transpose(chart.certified.cells).ravel().tolist()
        verdicts = [f"{shown},{proven}" for shown, proven in zip(verdicts, cells, strict=True)]
    numbers = np.column_stack(
        [*(m.ravel() for m in mesh), *(np.transpose(x).ravel() for x in (chart.T, chart.T_error()))]
    )
    form = ",".join(["%.12g"] * (len(names) + 1) + ["%.1e"])
    text.writelines(
        f"{form % tuple(line)},{verdict}\n"
        for line, verdict in zip(numbers.tolist(), verdicts, strict=True)
    )
    return text.getvalue().encode()


def as_json(chart: Chart, found: Sequence[Instability] = ()) -> bytes:
    """Provenance, axes, T, its error, verdicts and tongues; null where a number is not finite."""
    content = provenance(about(chart)) | {
        "points": {axis.name: axis.points.tolist() for axis in chart.axes},
        "T": _plain(chart.T),
        "T_error": _plain(chart.T_error()),
        "verdict": chart.verdict().tolist(),
        "tongues": [_tongue(i) for i in found],
    }
    if chart.certified:
        content["cells"] = chart.certified.cells.tolist()
    return (json.dumps(content, allow_nan=False) + "\n").encode()


def tongues_csv(chart: Chart, found: Sequence[Instability], other: str) -> bytes:
    """Provenance; one line for each tongue and value of the other parameter: edges, their error."""
    text = io.StringIO()
    text.write(as_comment(about(chart) | {"tongues": [_summary(i) for i in found]}))
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["resonance", "type", "order", "crossing", other, "lower", "upper", "error"])
    for i in found:
        head = [i.resonance.name, i.resonance.type, i.resonance.order, i.resonance.crossing]
        rows = zip(i.tongue.y, i.tongue.lower, i.tongue.upper, i.edge_error, strict=True)
        for y, lower, upper, error in rows:
            writer.writerow([*head, f"{y:.12g}", f"{lower:.14g}", f"{upper:.14g}", f"{error:.1e}"])
    return text.getvalue().encode()


def _summary(i: Instability) -> dict[str, Any]:
    """A tongue's numbers, but for its edges."""
    return {
        "resonance": i.resonance.name,
        "type": i.resonance.type,
        "order": i.resonance.order,
        "crossing": i.resonance.crossing,
        "begins": i.tongue.begins,
        "ends": i.tongue.ends,
        "y": i.y,
        "width": i.width,
        "T": i.T,
        "T_error": _finite(i.T_error),
        "Omega": i.Omega,
        "critical_gamma": _finite(i.critical_gamma),
    }


def _tongue(i: Instability) -> dict[str, Any]:
    edges = {name: getattr(i.tongue, name).tolist() for name in ("y", "lower", "upper")}
    return _summary(i) | {"edges": edges | {"error": _plain(i.edge_error)}}


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _plain(values: Any) -> Any:
    """Nested lists, with null where a number is not finite."""
    return np.where(np.isfinite(values), values, np.array(None)).tolist()
