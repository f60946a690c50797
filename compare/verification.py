"""Printed rows held against both routes: in order, with progress, on one process or several."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from compare import publications
from compare.jobs.workers import MapLike, mapper
from compare.publication import Counts, Method, Publication
from hill import checks
from hill.beam_common import MAX_MODES

METHODS: tuple[Method, ...] = ("taylor", "cvodes")


@dataclass(frozen=True)
class Report:
    """Outcomes in printed order, and the publication that they belong to."""

    outcomes: tuple[Any, ...]
    publication: Publication[Any, Any, Any]
    more_terms: dict[str, Any] = field(default_factory=dict)
    """By row id, what more terms of the series that it sums give; only where asked for."""
    method: Method = "taylor"
    """How the time domain integrated."""
    modes: int | None = None
    """How many modes both routes had, where there is something to choose."""

    @property
    def ok(self) -> bool:
        """Whether the routes agree on every row and no printed value lost its explanation."""
        more = all(found.routes_agree for found in self.more_terms.values())
        return more and all(o.routes_agree and o.expected for o in self.outcomes)

    @property
    def about(self) -> dict[str, Any]:
        """What it is of, for a file to say."""
        paper = self.publication
        about = {"publication": paper.name, "title": paper.title, "method": self.method}
        return about | ({} if self.modes is None else {"modes": self.modes})

    @property
    def summary(self) -> Counts | Any:
        """Counts of every kind of outcome."""
        return self.publication.rendering.count(self.outcomes)

    def _repr_html_(self) -> str:
        from compare.notebook import of_report

        return of_report(self)


def verify(
    tables: Iterable[int] | None = None,
    *,
    publication: str | Publication[Any, Any, Any] = publications.FIRST,
    rows: Iterable[str] | None = None,
    method: Method = "taylor",
    modes: int | None = None,
    more_terms: bool = False,
    workers: int | MapLike = 1,
    progress: Callable[[Any], Any] | None = None,
) -> Report:
    """Check printed rows by both routes.

    Parameters
    ----------
    tables : iterable of int, optional
        Which tables; all by default.
    publication : str or Publication, optional
        Whose; by default the report this project began with.
    rows : iterable of str, optional
        Only these rows, such as "T1-07"; "T3-02" stands for both of its columns.
    method : {"taylor", "cvodes"}, optional
        How the time domain integrates.
    modes : int, optional
        Bending modes; the report has 2.
    more_terms : bool, optional
        Sum more terms where a printed value sums a series, and estimate the limit.
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
        A publication, table, row, method or number that does not exist; `more_terms` where no row
        sums any.
    """
    paper = publications.find(publication) if isinstance(publication, str) else publication
    chosen = paper.select(
        None if tables is None else tuple(tables), None if rows is None else tuple(rows)
    )
    if method not in METHODS:
        raise ValueError(f"method = {method!r}: must be {' or '.join(METHODS)}")
    if more_terms:
        check_more_terms(paper, chosen)
    count = _modes(paper, modes)
    job = partial(_check, paper, method, count, more_terms)
    outcomes, more = [], {}
    with mapper(workers, chunk=4) as run:
        for outcome, found in run(job, chosen):
            outcomes.append(outcome)
            if found is not None:
                more[outcome.row.id] = found
            if progress is not None:
                progress(outcome)
    return Report(tuple(outcomes), paper, more, method, count)


def check_more_terms(paper: Publication[Any, Any, Any], rows: Iterable[Any]) -> None:
    """Refuse to sum more terms where there are none.

    Raises
    ------
    ValueError
        None of the rows sums any.
    """
    if paper.more_terms is None or not any(map(paper.more_terms.applies, rows)):
        raise ValueError("more-terms: must be left out, none of these rows sums a series")


def _check(
    paper: Publication[Any, Any, Any],
    method: Method,
    modes: int | None,
    more_terms: bool,
    row: Any,
) -> tuple[Any, Any]:
    """A row, and what more terms give if it sums any and they are asked for."""
    outcome, more = paper.check(row, method=method, modes=modes), None
    if more_terms and paper.more_terms is not None and paper.more_terms.applies(row):
        more = paper.more_terms.compute(row)
    return outcome, more


def _modes(paper: Publication[Any, Any, Any], modes: int | None) -> int | None:
    if modes is None:
        return paper.modes
    count = checks.count("modes", modes, least=1, most=MAX_MODES)
    if paper.modes is None:
        raise ValueError(f"modes = {modes}: must be left out, {paper.name} has none to choose")
    return count
