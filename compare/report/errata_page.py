"""Writes ``docs/errata.md``: the errata, with what the two routes compute beside them.

``python -m compare.report.errata_page``
"""

import textwrap
from collections.abc import Iterable
from pathlib import Path

from compare.output import check_writable, write_whole
from compare.provenance import in_words
from compare.publications.kincaid import check
from compare.report import errata_tables
from compare.report.errata_tables import BACK, KINDS, VERDICTS, Entry, Table
from compare.report.row import Outcome
from compare.report.tables import all_rows

PAGE = Path("docs/errata.md")
"""From the root of a clone."""

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


def page(outcomes: Iterable[Outcome] | None = None) -> str:
    """The page as Markdown.

    Parameters
    ----------
    outcomes : iterable of Outcome, optional
        All rows of the three tables; computed where not given.
    """
    found = tuple(map(check, all_rows()) if outcomes is None else outcomes)
    entries = errata_tables.entries(found)
    parts = [INTRODUCTION]
    for kind, (title, lead) in KINDS.items():
        parts += [f"## {title}"] + ([lead] if lead else [])
        parts += [_entry(e) for e in entries if e.erratum.kind == kind]
    for title, words, table in (
        ("Verdicts that change", VERDICTS, errata_tables.flips(found)),
        ("How well the tables come back", BACK, errata_tables.misses(found)),
    ):
        parts += [f"## {title}", textwrap.fill(words, 100), "\n".join(_table(table))]
    return "\n\n".join([*parts, in_words(ABOUT)]) + "\n"


def _entry(entry: Entry) -> str:
    """One erratum: a heading, printed beside corrected, why, and the test."""
    erratum, table = entry.erratum, entry.table
    if entry.formulas:
        table = Table(table.heads, tuple(tuple(map(_code, row)) for row in table.rows))
    lines = [f"### {erratum.where}", "", *_table(table)]
    lines += ["", entry.missed] if entry.missed else []
    return "\n".join([*lines, "", erratum.why, "", f"Shown by `{erratum.test}`."])


def _table(table: Table) -> list[str]:
    lines = [table.heads, ["---"] * len(table.heads), *table.rows]
    return ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]


def _code(text: str) -> str:
    """Formulas as they are; words as words."""
    return f"`{text}`" if any(sign in text for sign in "=()_^'") else text


def main() -> None:
    """Write the page."""
    check_writable(PAGE)
    write_whole(PAGE, page())
    print(f"written: {PAGE}")


if __name__ == "__main__":
    main()
