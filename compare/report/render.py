"""A report as text, JSON, Markdown or CSV: outcomes in, a string out, nothing computed."""

import csv
import io
import json
import math
from collections.abc import Iterable
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from compare.report.row import TERMS, Outcome
from compare.report.run import Report
from floquet import Monodromy
from hill import Characteristic

SHOWN = ("all", "differs", "flips", "fail")
FORMATS = ("text", "json", "md", "csv")

COLUMNS = (
    "row",
    "Omega",
    "run at",
    "T printed",
    "as run",
    "Hill",
    "Floquet",
    "|dP|",
    "bound",
    "cause",
    "verdict",
)
# What a terminal narrower than so many columns does without.
LEFT_OUT = {112: ("bound", "run at"), 96: ("|dP|",)}
STYLES = {
    "agrees": "green",
    "truncation": "yellow",
    "listing-slip": "magenta",
    "misprint": "cyan",
    "unexplained": "red",
}


def shown(report: Report, which: str) -> tuple[Outcome, ...]:
    """Outcomes to show: all, or those that differ from print, whose verdict flips, that fail."""
    if which == "differs":
        return tuple(o for o in report.outcomes if o.cause != "agrees" or o.flips)
    if which == "flips":
        return tuple(o for o in report.outcomes if o.flips)
    if which == "fail":
        return tuple(o for o in report.outcomes if not (o.routes_agree and o.expected))
    return report.outcomes


def summary(report: Report) -> tuple[str, str]:
    """Two lines that say what was found."""
    s = report.summary
    counts = (
        (s.agrees, "agrees with print", "agree with print"),
        (s.truncation, "is a truncation artefact", "are truncation artefacts"),
        (s.listing_slip, "follows a slip of the program", "follow slips of the program"),
        (s.misprint, "is a misprint", "are misprints"),
        (s.unexplained, "has no explanation", "have no explanation"),
    )
    found = [f"{n} {one if n == 1 else many}" for n, one, many in counts if n]
    verdicts = "verdict on stability is" if s.flips == 1 else "verdicts on stability are"
    wrong = f"{s.flips} printed {verdicts} wrong" if s.flips else "no printed verdict is wrong"
    if s.undecided:
        wrong += f", {s.undecided} {'is' if s.undecided == 1 else 'are'} undecided"
    return (
        f"{s.rows} printed value{'s' * (s.rows != 1)}: {', '.join(found)}; {wrong}.",
        f"The two routes agree on {s.routes_agree} of {s.rows} within their own error bounds; "
        f"P(z) differs by {s.largest_difference:.1e} of its largest coefficient at most, "
        f"{s.largest_share:.0%} of the bounds.",
    )


def text(report: Report, which: str = "all", *, console: Console) -> None:
    """Print the table and the two lines to a console; colour is the console's business."""
    left_out = {
        name for width, names in LEFT_OUT.items() if console.width < width for name in names
    }
    table = Table(
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        show_edge=False,
        header_style="bold",
        padding=(0, 1, 0, 0),
    )
    for name in COLUMNS:
        if name not in left_out:
            plain = name in ("row", "cause", "verdict")
            table.add_column(name, justify="left" if plain else "right", no_wrap=True)
    for outcome in shown(report, which):
        cells: dict[str, Any] = dict(zip(COLUMNS, cell_texts(outcome), strict=True))
        if "bound" in left_out:
            cells["cause"] = cells["cause"].split(" ")[0]
        cells["cause"] = Text(cells["cause"], style=STYLES[outcome.cause])
        if outcome.flips:
            cells["verdict"] = Text(cells["verdict"], style="bold reverse red")
        if not outcome.routes_agree:
            cells["|dP|"] = Text(cells["|dP|"], style="bold reverse red")
        table.add_row(*(cell for name, cell in cells.items() if name not in left_out))
    if table.row_count:
        console.print(table)
        console.print()
    for line in summary(report):
        console.print(line, style="bold" if report.ok else "bold red", soft_wrap=True)


def cell_texts(outcome: Outcome) -> tuple[str, ...]:
    """The cells of `COLUMNS`."""
    row = outcome.row
    cause = outcome.cause + ("" if outcome.expected else "!")
    if outcome.note.startswith("as corrected: "):
        cause += f" ({outcome.note.removeprefix('as corrected: ')})"
    return (
        row.id,
        row.Omega_printed,
        f"{row.Omega:.6f}",
        _short(row.T_printed),
        decimal(outcome.as_run_T),
        decimal(outcome.hill.T, outcome.hill.T_error),
        decimal(outcome.floquet.T, outcome.floquet.T_error),
        f"{outcome.difference:.0e}",
        f"{outcome.hill.error + outcome.floquet.error:.0e}",
        cause,
        f"-> {outcome.verdict.upper()}" if outcome.flips else outcome.verdict,
    )


def decimal(T: float, error: float = 1e-7) -> str:
    """T to five decimals as the report prints it: no leading zero, 0 where it is none."""
    return "0" if abs(T) <= max(error, 1e-7) else _short(f"{T:.5f}")


def _short(number: str) -> str:
    return number.replace("0.", ".", 1) if number.startswith(("0.", "-0.")) else number


def as_json(report: Report, which: str = "all") -> str:
    """The report as JSON; complex numbers are [re, im]."""
    content = {
        "summary": vars(report.summary) | {"ok": report.ok},
        "rows": [as_dict(outcome) for outcome in shown(report, which)],
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def as_dict(outcome: Outcome) -> dict[str, Any]:
    """One outcome with the names of the JSON."""
    row = outcome.row
    record: dict[str, Any] = {
        "id": row.id,
        "table": row.table,
        "page": row.page,
        "resonance": row.resonance,
        "Omega_printed": float(row.Omega_printed),
        "Omega": row.Omega,
        "Omega_from": row.Omega_from,
        "modes": outcome.modes,
        "printed": {"T": row.T, "z": _pairs(row.z)},
        "as_run": {"T": outcome.as_run_T, "z": _pairs(outcome.as_run_z)},
        "hill": _route(outcome.hill),
        "floquet": _route(outcome.floquet),
        "difference": outcome.difference,
        "matrices": outcome.matrices,
        "routes_agree": outcome.routes_agree,
        "cause": outcome.cause,
        "expected": outcome.expected,
        "verdict_printed": outcome.verdict_printed,
        "verdict": outcome.verdict,
        "flips": outcome.flips,
        "note": outcome.note,
    }
    if row.initial_conditions is not None:
        record["initial_conditions"] = row.initial_conditions
        # as many as the report keeps: a truncation like any other, see the errata
        record["terms"] = TERMS if row.initial_conditions else 0
    return record


def _route(route: Characteristic | Monodromy) -> dict[str, Any]:
    return {
        "T": route.T,
        "T_error": _finite(route.T_error),
        "z": _pairs(route.z),
        "polynomial": [float(p) for p in route.polynomial],
        "error": route.error,
        "data_error": route.data_error,
        "verdict": route.verdict,
        "stable": route.stable,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _pairs(z: Iterable[complex]) -> list[list[float]]:
    return [[float(value.real), float(value.imag)] for value in z]


def markdown(report: Report, which: str = "all") -> str:
    """A table for a report, and the two lines."""
    lines = ["| " + " | ".join(name.replace("|", "\\|") for name in COLUMNS) + " |"]
    lines.append("|" + "|".join(" --- " if k in (0, 9, 10) else " ---: " for k in range(11)) + "|")
    for outcome in shown(report, which):
        cells = list(cell_texts(outcome))
        if outcome.flips:
            cells[-1] = f"**{cells[-1]}**"
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join([*lines, "", *summary(report)]) + "\n"


def as_csv(report: Report, which: str = "all") -> str:
    """One line a row, every digit."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    names = ["id", "table", "Omega_printed", "Omega", "Omega_from", "T_printed", "T_as_run"]
    names += [f"{route}_{what}" for route in ("hill", "floquet") for what in ("T", "error")]
    names += ["difference", "routes_agree", "cause", "verdict_printed", "verdict", "note"]
    writer.writerow(names)
    for o in shown(report, which):
        writer.writerow(
            [o.row.id, o.row.table, o.row.Omega_printed, repr(o.row.Omega), o.row.Omega_from]
            + [o.row.T_printed, repr(float(o.as_run_T))]
            + [repr(float(x)) for route in (o.hill, o.floquet) for x in (route.T, route.error)]
            + [repr(o.difference), o.routes_agree, o.cause, o.verdict_printed, o.verdict, o.note]
        )
    return buffer.getvalue()
