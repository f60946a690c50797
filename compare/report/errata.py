"""The report's errata as data: printed beside corrected."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files


@dataclass(frozen=True)
class Erratum:
    """One entry of ``errata.toml``.

    Attributes
    ----------
    kind : str
        "cell", "text", "equation", "slip" (of the listing), or "open" (not explained).
    row, field : str
        For a cell, the printed row and the column of its CSV; empty otherwise.
    test : str
        The test that shows it.
    """

    id: str
    kind: str
    where: str
    printed: str
    corrected: str
    why: str
    test: str
    row: str = ""
    field: str = ""


@cache
def errata() -> tuple[Erratum, ...]:
    """All errata, in the order of the file."""
    text = (files("compare") / "report/data/errata.toml").read_text()
    return tuple(Erratum(**entry) for entry in tomllib.loads(text)["erratum"])


def corrected_cells(row: str) -> dict[str, str]:
    """Corrected cells of a printed row, by column."""
    return {e.field: e.corrected for e in errata() if e.kind == "cell" and e.row == row}


def is_open(row: str) -> bool:
    """Whether a printed row is known to have no explanation."""
    return any(e.kind == "open" and e.row == row for e in errata())
