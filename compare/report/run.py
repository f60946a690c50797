"""Many rows: in order, with progress, on one process or several."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

from compare.jobs.workers import MapLike, mapper
from compare.report.row import Method, Outcome, check
from compare.report.tables import TABLES, Row, all_rows
from hill import checks
from hill.beam_common import MAX_MODES


@dataclass(frozen=True)
class Summary:
    """What was found, in numbers."""

    rows: int
    routes_agree: int
    agrees: int
    truncation: int
    listing_slip: int
    misprint: int
    unexplained: int
    flips: int
    undecided: int
    largest_difference: float
    """Largest |P_hill - P_floquet| over the largest coefficient."""
    largest_share: float
    """Largest |P_hill - P_floquet| over the sum of the two error bounds."""


@dataclass(frozen=True)
class Report:
    """Outcomes in printed order."""

    outcomes: tuple[Outcome, ...]

    @property
    def ok(self) -> bool:
        """Whether the routes agree on every row and no printed value lost its explanation."""
        return all(o.routes_agree and o.expected for o in self.outcomes)

    @property
    def summary(self) -> Summary:
        """Counts of every kind of outcome."""
        outcomes = self.outcomes

        def caused(cause: str) -> int:
            return sum(o.cause == cause for o in outcomes)

        return Summary(
            rows=len(outcomes),
            routes_agree=sum(o.routes_agree for o in outcomes),
            agrees=caused("agrees"),
            truncation=caused("truncation"),
            listing_slip=caused("listing-slip"),
            misprint=caused("misprint"),
            unexplained=caused("unexplained"),
            flips=sum(o.flips for o in outcomes),
            undecided=sum(o.verdict == "undecided" for o in outcomes),
            largest_difference=max(
                (o.difference / float(abs(o.hill.polynomial).max()) for o in outcomes), default=0.0
            ),
            largest_share=max(
                (o.difference / (o.hill.error + o.floquet.error) for o in outcomes), default=0.0
            ),
        )


def verify(
    tables: Iterable[int] = TABLES,
    *,
    rows: Iterable[str] | None = None,
    method: Method = "taylor",
    modes: int = 2,
    workers: int | MapLike = 1,
    progress: Callable[[Outcome], Any] | None = None,
) -> Report:
    """Check the report's printed rows by both routes.

    Parameters
    ----------
    tables : iterable of {1, 2, 3}, optional
        Which tables.
    rows : iterable of str, optional
        Only these rows, such as "T1-07"; "T3-02" stands for both of its columns.
    method : {"taylor", "cvodes"}, optional
        How the time domain integrates.
    modes : int, optional
        Bending modes; the report has 2.
    workers : int or map-like callable, optional
        Processes, or a function that maps like `map` and keeps the order.
    progress : callable, optional
        Called with each outcome as it arrives.

    Returns
    -------
    Report

    Raises
    ------
    ValueError
        A table, row, method or number that does not exist.
    """
    chosen = select(tables, rows)
    if method not in ("taylor", "cvodes"):
        raise ValueError(f"method = {method!r}: must be taylor or cvodes")
    job = partial(check, method=method, modes=checks.count("modes", modes, least=1, most=MAX_MODES))
    outcomes = []
    with mapper(workers, chunk=4) as run:
        for outcome in run(job, chosen):
            outcomes.append(outcome)
            if progress is not None:
                progress(outcome)
    return Report(tuple(outcomes))


def select(tables: Iterable[int], names: Iterable[str] | None) -> tuple[Row, ...]:
    """Rows by table and name."""
    numbers = tuple(tables)
    for table in numbers:
        if isinstance(table, bool) or not isinstance(table, int) or table not in TABLES:
            raise ValueError(f"table = {table!r}: the report has Tables 1, 2 and 3")
    found = all_rows(numbers)
    if names is None:
        return found
    wanted = tuple(names)
    for name in wanted:
        if not any(_is_named(row, name) for row in found):
            among = " and ".join(f"Table {table}" for table in numbers)
            raise ValueError(
                f"row = {name!r}: no such row in {among} ({found[0].id} to {found[-1].id})"
            )
    return tuple(row for row in found if any(_is_named(row, name) for name in wanted))


def _is_named(row: Row, name: str) -> bool:
    return name.upper() in (row.id.upper(), row.id.upper().rstrip("AB"))
