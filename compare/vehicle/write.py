"""A study as text, JSON or Markdown."""

import json
import math
from typing import Any

from rich.console import Console

from compare.charts.identity import known_values, type_name
from compare.console import bare_table, say, show
from compare.provenance import in_words, provenance
from compare.vehicle.convergence import Settling
from compare.vehicle.study import Row, Study
from compare.vehicle.words import (
    HEADS,
    KINDS,
    cells,
    cycles,
    doubling,
    facts,
    few_modes,
    moved,
    remarks,
    settling_table,
    summary,
)
from hill import CriticalThrust

STYLES = {"stable": "bold green", "unstable": "bold red", "undecided": "bold yellow"}

NARROW = 100
"""Columns below which the table leaves out what the rest implies, and shortens its heads."""

LEFT_OUT = {"type", "grows in"}
SHORT = {"unstable from": "from", "doubles in": "doubles"}


def text(title: str, study: Study, console: Console) -> None:
    """Print everything; on a narrow terminal without the types and the growth's time constants."""
    first, second = summary(title, study)
    style = STYLES[study.operating.verdict] if study.operating else "bold"
    say(console, first, style)
    say(console, second)
    console.print()
    for line in facts(study):
        say(console, line)
    console.print()
    narrow = console.width < NARROW
    shown = [k for k, head in enumerate(HEADS) if not (narrow and head in LEFT_OUT)]
    table = bare_table()
    for k in shown:
        head = SHORT.get(HEADS[k], HEADS[k]) if narrow else HEADS[k]
        table.add_column(head, justify="right" if k > 1 else "left", no_wrap=True)
    for row in study.rows:
        table.add_row(*(cells(row)[k] for k in shown))
    show(console, table)
    told = [row for row in study.rows if row.effects]
    if told:
        console.print()
        say(console, "What T moves by with 1% more of the numbers that matter most:")
        for row in told:
            say(console, moved(row))
    console.print()
    say(console, few_modes(study))
    heads, rows = settling_table(study, 2 if narrow else 3)
    if rows:
        table = bare_table()
        for k, head in enumerate(heads):
            table.add_column(head, justify="right" if k > 1 else "left", no_wrap=True)
        for cells_ in rows:
            table.add_row(*cells_)
        show(console, table)
    console.print()
    for line in remarks(study):
        say(console, line)
    console.print()
    say(console, in_words(about(study)), "dim")


def markdown(title: str, study: Study) -> str:
    """For a report."""
    lines = [*summary(title, study), "", *(f"- {line}" for line in facts(study)), ""]
    lines += ["| " + " | ".join(HEADS) + " |", "| --- " * len(HEADS) + "|"]
    lines += ["| " + " | ".join(cells(row)) + " |" for row in study.rows]
    lines += ["", *(f"- {moved(row)}" for row in study.rows if row.effects), ""]
    lines += [few_modes(study), ""]
    heads, rows = settling_table(study)
    if rows:
        lines += ["| " + " | ".join(heads) + " |", "| --- " * len(heads) + "|"]
        lines += ["| " + " | ".join(row) + " |" for row in rows] + [""]
    lines += [*(f"- {line}" for line in remarks(study)), "", in_words(about(study))]
    return "\n".join(lines) + "\n"


def as_json(title: str, study: Study) -> str:
    """Every digit; frequencies in cycles per unit of time."""
    u, loss, x = study.vehicle.units, study.loss, study.operating
    content = provenance(about(study)) | {
        "title": title,
        "summary": list(summary(title, study)),
        "units": {
            "length": u.length,
            "mass": u.mass,
            "time": u.time,
            "force": u.force,
            "frequency": u.frequency,
        },
        "mass": study.body.mass,
        "centre_of_mass": study.body.centre,
        "moment_of_inertia": study.body.inertia,
        "frequencies_without_thrust": [cycles(w) for w in study.free],
        "frequencies_under_thrust": [cycles(float(w)) for w in study.alone.frequencies],
        "steady_thrust": loss and _steady(study, loss),
        "operating": x
        and {
            "frequency": cycles(study.Omega or 0.0),
            "verdict": x.verdict,
            "T": x.T,
            "T_error": x.T_error if math.isfinite(x.T_error) else None,
            "routes_agree": x.routes_agree,
            "difference": x.difference,
            "bound": x.bound,
            "discretisation": x.discretisation,
        },
        "resonances": [_row(row) for row in study.rows],
        "more_modes": [_settling(one) for one in study.settling],
        "not_solved_for": len(study.others),
        "without_a_band": list(study.refused),
        "routes_agree": study.routes_agree,
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def about(study: Study) -> dict[str, Any]:
    """The vehicle, by what it holds, and what was asked of it."""
    u = study.vehicle.units
    return {
        "system": type_name(study.vehicle),
        "values": known_values(study.vehicle),
        "gamma": study.gamma,
        "eta": study.eta,
        "range": [cycles(study.low), cycles(study.high)],
        "orders": study.orders,
        "units": f"{', '.join(x for x in (u.length, u.mass, u.time, u.force) if x) or 'none named'}"
        f"; frequencies in {u.frequency or 'cycles'}",
    }


def _steady(study: Study, loss: CriticalThrust) -> dict[str, Any]:
    lost = loss.kind != "none"
    return {
        "kind": KINDS[loss.kind] if lost else None,
        "critical": loss.thrust if lost else None,
        "margin": loss.margin(study.vehicle) if lost else None,
        "frequency": loss.frequency if lost else None,
        "searched_to": loss.searched,
        "resolution": loss.resolution,
    }


def _settling(one: Settling) -> dict[str, Any]:
    def shown(value: float | None) -> float | None:
        return cycles(value) if value is not None and one.what == "width" else value

    return {
        "resonance": one.of.name if one.of else None,
        "what": one.what,
        "modes": list(one.modes),
        "values": [shown(x) for x in one.values],
        "limit": shown(one.limit),
        "error_estimate": shown(one.error),
    }


def _row(row: Row) -> dict[str, Any]:
    band, w = row.band, row.witnessed
    return {
        "name": row.resonance.name,
        "type": row.resonance.type,
        "order": row.resonance.order,
        "frequency": cycles(band.Omega),
        "band": [cycles(x) for x in band.edges] if band.edges else None,
        "band_error": cycles(band.edge_error),
        "T": band.T,
        "T_error": band.T_error,
        "time_constant": 2.0 / band.T if band.T > 0.0 else None,
        "doubling_time": doubling(row),
        "critical_gamma": row.critical,
        "witness": w
        and {
            "T": w.T,
            "T_error": w.T_error if math.isfinite(w.T_error) else None,
            "discretisation": w.discretisation,
            "verdict": w.verdict,
            "agrees": w.agrees,
            "another_grows_more": w.another,
        },
        "effects": [
            {"name": e.name, "value": e.value, "dT": e.slope, "dT_witness": e.witness}
            for e in row.effects
        ],
    }
