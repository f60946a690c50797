"""How an outcome looks, and what many of them say."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from compare.publication import Cell, Column, Rendering
from compare.publications.mathieu.outcome import Outcome

STYLES = {"agrees": "green", "misprint": "cyan", "undecided": "yellow", "unexplained": "red"}


@dataclass(frozen=True)
class Summary:
    """What was found, in numbers."""

    rows: int
    routes_agree: int
    agrees: int
    misprint: int
    undecided: int
    unexplained: int
    largest_difference: float

    @property
    def lines(self) -> tuple[str, str]:
        """The same in words."""
        counts = (
            (self.agrees, "right to the last digit by both routes"),
            (self.misprint, "misprinted"),
            (self.undecided, "not decided, the tongue being narrower than the error of P"),
            (self.unexplained, "wrong without an explanation"),
        )
        found = ", ".join(f"{n} {what}" for n, what in counts if n)
        return (
            f"{self.rows} printed value{'s' * (self.rows != 1)}: {found}.",
            f"The two routes agree on {self.routes_agree} of {self.rows} within their own error "
            f"bounds; P differs by {self.largest_difference:.1e} at most.",
        )


def count(outcomes: Sequence[Outcome]) -> Summary:
    """Counts of every kind of outcome."""
    causes = [o.cause for o in outcomes]
    return Summary(
        rows=len(outcomes),
        routes_agree=sum(o.routes_agree for o in outcomes),
        agrees=causes.count("agrees"),
        misprint=causes.count("misprint"),
        undecided=causes.count("undecided"),
        unexplained=causes.count("unexplained"),
        largest_difference=max((o.difference for o in outcomes), default=0.0),
    )


COLUMNS = (
    Column("row", words=True),
    Column("q"),
    Column("printed"),
    Column("P, Hill"),
    Column("P, Floquet", width=70),
    Column("bound", width=80),
    Column("shown by", words=True),
    Column("cause", words=True),
)


def cells(o: Outcome) -> tuple[Cell, ...]:
    """The cells of `COLUMNS`."""
    return (
        Cell(o.row.id),
        Cell(f"{o.row.q:g}"),
        Cell(o.row.printed),
        Cell(f"{o.hill.at:.1e}"),
        Cell(f"{o.floquet.at:.1e}", "" if o.routes_agree else "bold reverse red"),
        Cell(f"{max(o.hill.bound, o.floquet.bound):.0e}"),
        Cell(_shown_by(o)),
        Cell(o.cause + ("" if o.expected else "!"), STYLES[o.cause]),
    )


def _shown_by(o: Outcome) -> str:
    shown = [name for name in ("hill", "floquet") if getattr(o, name).changes_sign]
    return "both" if len(shown) == 2 else " ".join(shown) or "neither"


def record(o: Outcome) -> dict[str, Any]:
    """What JSON holds."""
    return {
        "id": o.row.id,
        "table": o.row.table,
        "r": o.row.r,
        "q": o.row.q,
        "printed": float(o.row.printed),
        "half_unit": o.row.half_unit,
        "z": o.row.z,
        "hill": vars(o.hill) | {"changes_sign": o.hill.changes_sign},
        "floquet": vars(o.floquet) | {"changes_sign": o.floquet.changes_sign},
        "difference": o.difference,
        "routes_agree": o.routes_agree,
        "shared_matrices": True,
        "cause": o.cause,
        "expected": o.expected,
        "note": o.note,
    }


CSV_HEADER = (
    *("id", "table", "r", "q", "printed"),
    *(f"{route}_{what}" for route in ("hill", "floquet") for what in ("P", "bound")),
    *("shown_by", "difference", "routes_agree", "cause", "note"),
)


def csv_line(o: Outcome) -> list[Any]:
    """The values under `CSV_HEADER`."""
    return [
        *(o.row.id, o.row.table, o.row.r, o.row.q, o.row.printed),
        *(o.hill.at, o.hill.bound, o.floquet.at, o.floquet.bound),
        *(_shown_by(o), o.difference, o.routes_agree, o.cause, o.note),
    ]


RENDERING = Rendering(COLUMNS, cells, record, CSV_HEADER, csv_line, count)
