"""Writes ``docs/errata.md``: the errata, with what the two routes compute beside them.

``python -m compare.report.errata_page``
"""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import median

import numpy as np
from scipy.optimize import linear_sum_assignment

from compare.erratum import Erratum
from compare.output import check_writable, write_whole
from compare.provenance import in_words
from compare.publications.kincaid import check
from compare.report.errata import all_errata
from compare.report.match import distance
from compare.report.row import Outcome
from compare.report.tables import all_rows, corrected

PAGE = Path("docs/errata.md")
"""From the root of a clone."""

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

ABOUT = {"of": "Tables 1 to 3, each row at its own beam and forcing, its own matrices each route"}

INTRODUCTION = """\
# Errata of the report

<!-- Written by python -m compare.report.errata_page from errata.toml and the computation. -->

What is wrong in the report, printed form beside corrected form. Three values of the same thing are
kept apart:

- **printed**: what stands on the page;
- **as run**: what the report's program gives, with its truncation and its slips, at the forcing
  frequency it was run at (printed to three decimals, recovered in
  `compare/report/data/recovered.toml`);
- **converged**: what the corrected equations give, by two independent routes that agree.

Each entry names the test that shows it."""

VERDICTS = """\
## Verdicts that change

Rows whose printed verdict on stability is not that of the corrected, converged equations. A T of 0
means stable."""

BACK = """\
## How well the tables come back

Distance between the printed values and those of the report's program as run, cells corrected, open
rows left out. The tables have five decimals, so that half a unit is 5e-6."""


def page(outcomes: Iterable[Outcome] | None = None) -> str:
    """The page as Markdown.

    Parameters
    ----------
    outcomes : iterable of Outcome, optional
        All rows of the three tables; computed where not given.
    """
    found = tuple(map(check, all_rows()) if outcomes is None else outcomes)
    by_row = {outcome.row.id: outcome for outcome in found}
    parts = [INTRODUCTION]
    for kind, (title, lead) in KINDS.items():
        parts += [f"## {title}"] + ([lead] if lead else [])
        parts += [_entry(e, by_row) for e in all_errata() if e.kind == kind]
    parts += [VERDICTS, _flips(found), BACK, _misses(found)]
    return "\n\n".join([*parts, in_words(ABOUT)]) + "\n"


def _entry(erratum: Erratum, by_row: dict[str, Outcome]) -> str:
    """One erratum: a heading, printed beside corrected, why, and the test."""
    lines = [f"### {erratum.where}", ""]
    if erratum.kind == "cell":
        outcome = by_row[erratum.row]
        cells = (erratum.printed, erratum.corrected, *_values(erratum, outcome))
        lines += _table(("printed", "corrected", "as run", "converged"), [cells])
    elif erratum.kind == "open":
        outcome = by_row[erratum.row]
        header = ("", "T", *(["z"] if outcome.row.z else []))
        rows = [("printed", outcome.row.T_printed, *_printed_z(outcome))]
        for name, T, z in (
            ("as run", outcome.as_run_T, outcome.as_run_z),
            ("converged", outcome.hill.T, outcome.hill.z),
        ):
            paired = _paired(outcome.row.z, z)
            rows.append(
                (name, _T(T, outcome), *([", ".join(map(_z, paired))] if outcome.row.z else []))
            )
        lines += _table(header, rows)
        if outcome.row.z:
            missed = _power(distance(outcome.as_run_z, outcome.row.z), 1)
            lines += ["", f"As run, z misses the printed one by {missed}."]
        else:
            missed = _fixed(abs(max(outcome.as_run_T, 0.0) - outcome.row.T), 1)
            lines += [
                "",
                f"As run at the recovered frequency, T misses the printed one by {missed}.",
            ]
    else:
        lines += _table(
            ("printed", "corrected"), [(_code(erratum.printed), _code(erratum.corrected))]
        )
    return "\n".join([*lines, "", erratum.why, "", f"Shown by `{erratum.test}`."])


def _values(erratum: Erratum, outcome: Outcome) -> tuple[str, str]:
    """A cell's quantity as run and converged."""
    if not erratum.field.startswith("z"):
        return _fixed(outcome.row.Omega, 4), "given"
    place, imaginary = int(erratum.field[1]) - 1, erratum.field.endswith("im")
    printed = corrected(outcome.row).z
    chosen = [_paired(printed, z)[place] for z in (outcome.as_run_z, outcome.hill.z)]
    run, converged = (_signed(z.imag if imaginary else z.real) for z in chosen)
    return run, converged


def _flips(outcomes: Sequence[Outcome]) -> str:
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
    header = ("row", "Omega", "T printed", "T as run", "T converged", "verdict", "cause")
    return "\n".join(_table(header, rows))


def _misses(outcomes: Sequence[Outcome]) -> str:
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
    header = ("", "rows", "z, median", "z, worst", "T, median of unstable rows", "T, worst")
    return "\n".join(_table(header, rows))


def _table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    lines = [header, ["---"] * len(header), *rows]
    return ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]


def _code(text: str) -> str:
    """Formulas as they are; words as words."""
    return f"`{text}`" if any(sign in text for sign in "=()_^'") else text


def _paired(printed: Sequence[complex], z: Iterable[complex]) -> list[complex]:
    """`z` in the order of the printed ones."""
    values = np.asarray(list(z), complex)
    if not printed:
        return []
    apart = np.abs(np.subtract.outer(np.asarray(printed, complex), values))
    return [complex(values[k]) for k in linear_sum_assignment(apart)[1]]


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


def main() -> None:
    """Write the page."""
    check_writable(PAGE)
    write_whole(PAGE, page())
    print(f"written: {PAGE}")


if __name__ == "__main__":
    main()
