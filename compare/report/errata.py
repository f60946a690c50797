"""The report's errata as data: printed beside corrected."""

from functools import cache
from importlib.resources import files

from compare.erratum import Erratum, errata_from


@cache
def all_errata() -> tuple[Erratum, ...]:
    """All errata, in the order of the file."""
    return errata_from(files("compare") / "report/data/errata.toml")


def corrected_cells(row: str) -> dict[str, str]:
    """Corrected cells of a printed row, by column."""
    return {e.field: e.corrected for e in all_errata() if e.kind == "cell" and e.row == row}


def is_open(row: str) -> bool:
    """Whether a printed row is known to have no explanation."""
    return any(e.kind == "open" and e.row == row for e in all_errata())
