"""How an outcome of the report looks: outcomes in, cells and records out, nothing computed."""

import math
from collections.abc import Iterable
from typing import Any

from compare.publication import Cell, Column, Rendering
from compare.report.row import TERMS, Outcome
from compare.report.summary import count
from floquet import Monodromy
from hill import Characteristic

COLUMNS = (
    Column("row", words=True),
    Column("Omega"),
    Column("run at", width=112),
    Column("T printed"),
    Column("as run"),
    Column("Hill"),
    Column("Floquet"),
    Column("T +-"),
    Column("|dP|", width=96),
    Column("bound", width=112),
    Column("cause", words=True),
    Column("verdict", words=True),
)
STYLES = {
    "agrees": "green",
    "truncation": "yellow",
    "listing-slip": "magenta",
    "misprint": "cyan",
    "unexplained": "red",
}
LOUD = "bold reverse red"


def cells(outcome: Outcome) -> tuple[Cell, ...]:
    """The cells of `COLUMNS`."""
    row = outcome.row
    cause = outcome.cause + ("" if outcome.expected else "!")
    reason = outcome.note.removeprefix("as corrected: ")
    corrected = f" ({reason})" if reason != outcome.note else ""
    verdict = f"-> {outcome.verdict.upper()}" if outcome.flips else outcome.verdict
    return (
        Cell(row.id),
        Cell(row.Omega_printed),
        Cell(f"{row.Omega:.6f}"),
        Cell(_short(row.T_printed)),
        Cell(decimal(outcome.as_run_T)),
        Cell(decimal(outcome.hill.T, outcome.hill.T_error)),
        Cell(decimal(outcome.floquet.T, outcome.floquet.T_error)),
        Cell(f"{max(outcome.hill.T_error, outcome.floquet.T_error):.0e}"),
        Cell(f"{outcome.difference:.0e}", "" if outcome.routes_agree else LOUD),
        Cell(f"{outcome.hill.error + outcome.floquet.error:.0e}"),
        Cell(cause + corrected, STYLES[outcome.cause], short=cause),
        Cell(verdict, LOUD if outcome.flips else "", loud=outcome.flips),
    )


def decimal(T: float, error: float = 1e-7) -> str:
    """T to five decimals as the report prints it: no leading zero, 0 where it is none."""
    return "0" if abs(T) <= max(error, 1e-7) else _short(f"{T:.5f}")


def _short(number: str) -> str:
    return number.replace("0.", ".", 1) if number.startswith(("0.", "-0.")) else number


def record(outcome: Outcome) -> dict[str, Any]:
    """One outcome with the names of the JSON; complex numbers are [re, im]."""
    row = outcome.row
    found: dict[str, Any] = {
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
        found["initial_conditions"] = row.initial_conditions
        # as many as the report keeps: a truncation like any other, see the errata
        found["terms"] = TERMS if row.initial_conditions else 0
    return found


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


CSV_HEADER = (
    *("id", "table", "Omega_printed", "Omega", "Omega_from", "T_printed", "T_as_run"),
    *(f"{route}_{what}" for route in ("hill", "floquet") for what in ("T", "T_error", "error")),
    *("difference", "routes_agree", "cause", "verdict_printed", "verdict", "note"),
)


def csv_line(o: Outcome) -> list[Any]:
    """The values under `CSV_HEADER`."""
    return [
        *(o.row.id, o.row.table, o.row.Omega_printed, o.row.Omega, o.row.Omega_from),
        *(o.row.T_printed, o.as_run_T),
        *(x for route in (o.hill, o.floquet) for x in (route.T, route.T_error, route.error)),
        *(o.difference, o.routes_agree, o.cause, o.verdict_printed, o.verdict, o.note),
    ]


RENDERING = Rendering(COLUMNS, cells, record, CSV_HEADER, csv_line, count)
