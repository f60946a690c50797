"""The errata as tables: printed beside corrected, and what the two routes compute; no layout."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median

from compare.erratum import Erratum
from compare.report.errata import all_errata
from compare.report.match import distance, paired
from compare.report.row import Outcome
from compare.report.tables import corrected

# ITS of the listing, and far above the rounding of T.
STABLE = 1e-7

KINDS = {
    "cell": (
        "Cells of the tables",
        "Each printed row was run again by the report's own program. With the corrected cell it "
        "comes back, with the printed one it does not.",
    ),
    "text": ("Headings and text", ""),
    "equation": (
        "Equations",
        "The corrected form is the one that the independent quadrature of the beam's equation, "
        "or the time domain, agrees with.",
    ),
    "slip": (
        "Slips of the programs",
        "The printed tables were computed with these. `compare.report.program.listing` keeps them; "
        "the rest of the code does not.",
    ),
    "open": (
        "Without an explanation",
        "The report's program, run again, does not give these printed values.",
    ),
}
"""By kind of erratum: a title, and a sentence where one is needed."""

VERDICTS = (
    "Rows whose printed verdict on stability is not that of the corrected, converged equations. A "
    "T of 0 means stable."
)

BACK = (
    "Distance between the printed values and those of the report's program as run, cells "
    "corrected, open rows left out. The tables have five decimals, so that half a unit is 5e-6."
)


@dataclass(frozen=True)
class Table:
    """Heads, and rows of as many cells."""

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Entry:
    """One erratum.

    Attributes
    ----------
    erratum : Erratum
    table : Table
        Printed beside corrected, or the row's values.
    formulas : bool
        Whether the cells are formulas, or words, as they stand; numbers otherwise.
    missed : str
        By how much the program as run misses what is open; empty otherwise.
    """

    erratum: Erratum
    table: Table
    formulas: bool
    missed: str = ""


def entries(outcomes: Iterable[Outcome]) -> tuple[Entry, ...]:
    """All errata, kind by kind.

    Parameters
    ----------
    outcomes : iterable of Outcome
        All rows of the three tables.
    """
    by_row = {outcome.row.id: outcome for outcome in outcomes}
    return tuple(_entry(e, by_row) for kind in KINDS for e in all_errata() if e.kind == kind)


def _entry(erratum: Erratum, by_row: dict[str, Outcome]) -> Entry:
    if erratum.kind == "cell":
        values = _values(erratum, by_row[erratum.row])
        row = (erratum.printed, erratum.corrected, *values)
        heads = ("printed", "corrected", "as run", "converged")
        return Entry(erratum, Table(heads, (row,)), formulas=False)
    if erratum.kind == "open":
        return _open(erratum, by_row[erratum.row])
    cells = (erratum.printed, erratum.corrected)
    return Entry(erratum, Table(("printed", "corrected"), (cells,)), formulas=True)


def _open(erratum: Erratum, outcome: Outcome) -> Entry:
    row = outcome.row
    rows = [("printed", row.T_printed, *_printed_z(outcome))]
    for name, T, z in (
        ("as run", outcome.as_run_T, outcome.as_run_z),
        ("converged", outcome.hill.T, outcome.hill.z),
    ):
        values = [", ".join(map(_z, paired(row.z, z)))] if row.z else []
        rows.append((name, _T(T, outcome), *values))
    if row.z:
        by = _power(distance(outcome.as_run_z, row.z), 1)
        missed = f"As run, z misses the printed one by {by}."
    else:
        by = _fixed(abs(max(outcome.as_run_T, 0.0) - row.T), 1)
        missed = f"As run at the recovered frequency, T misses the printed one by {by}."
    heads = ("", "T", *(["z"] if row.z else []))
    return Entry(erratum, Table(heads, tuple(rows)), formulas=False, missed=missed)


def _values(erratum: Erratum, outcome: Outcome) -> tuple[str, str]:
    """A cell's quantity as run and converged."""
    if erratum.field == "T":
        return _T(outcome.as_run_T, outcome), _T(outcome.hill.T, outcome)
    if not erratum.field.startswith("z"):
        return _fixed(outcome.row.Omega, 4), "given"
    place, imaginary = int(erratum.field[1]) - 1, erratum.field.endswith("im")
    printed = corrected(outcome.row).z
    chosen = [paired(printed, z)[place] for z in (outcome.as_run_z, outcome.hill.z)]
    run, converged = (_signed(z.imag if imaginary else z.real) for z in chosen)
    return run, converged


def flips(outcomes: Sequence[Outcome]) -> Table:
    """The rows whose printed verdict is wrong."""
    rows = [
        (
            outcome.row.id,
            outcome.row.Omega_printed,
            outcome.row.T_printed,
            _T(outcome.as_run_T, outcome),
            _T(outcome.hill.T, outcome),
            f"{outcome.verdict_printed} → {outcome.verdict}",
            outcome.cause if outcome.expected and outcome.cause != "unexplained" else "open",
        )
        for outcome in outcomes
        if outcome.flips
    ]
    heads = ("row", "Omega", "T printed", "T as run", "T converged", "verdict", "cause")
    return Table(heads, tuple(rows))


def misses(outcomes: Sequence[Outcome]) -> Table:
    """How well the tables come back, a line a table."""
    left_out = {e.row for e in all_errata() if e.kind == "open"}
    rows = []
    for table in (1, 2, 3):
        of_table = [o for o in outcomes if o.row.table == table and o.row.id not in left_out]
        z = [(distance(o.as_run_z, corrected(o.row).z), o.row.id) for o in of_table if o.row.z]
        T = [(abs(max(o.as_run_T, 0.0) - o.row.T), o.row.id) for o in of_table]
        unstable = [miss for (miss, _), o in zip(T, of_table, strict=True) if o.row.T > 0.0]
        (worst_z, z_row), (worst_T, T_row) = max(z, default=(math.nan, "")), max(T)
        rows.append(
            (
                f"Table {table}",
                str(len(of_table)),
                _power(median(miss for miss, _ in z)) if z else "none printed",
                f"{_power(worst_z)} ({z_row})" if z else "",
                _power(median(unstable)),
                f"{_power(worst_T)} ({T_row})",
            )
        )
    heads = ("", "rows", "z, median", "z, worst", "T, median of unstable rows", "T, worst")
    return Table(heads, tuple(rows))


def _printed_z(outcome: Outcome) -> tuple[str, ...]:
    parts = [complex(z) for z in outcome.row.z]
    return (", ".join(map(_z, parts)),) if parts else ()


def _z(z: complex) -> str:
    """Five decimals, as printed; the imaginary part only where one would be."""
    return _signed(z.real) + (f" {_signed(z.imag)}i" if abs(z.imag) >= 1e-4 else "")


def _T(T: float, outcome: Outcome) -> str:
    """Five decimals, in the manner of its table; 0 for a stable row."""
    if T <= STABLE:
        return "0"
    return _fixed(T, 5).removeprefix("0" if outcome.row.table == 1 else "")


def _signed(value: float) -> str:
    return ("-" if value < 0.0 else "+") + _fixed(abs(value), 5).removeprefix("0")


def _fixed(value: float, digits: int) -> str:
    return f"{value:.{digits}f}"


def _power(value: float, digits: int = 0) -> str:
    """One digit: as much as a distance to five decimals is worth."""
    return f"{value:.{digits}e}"
