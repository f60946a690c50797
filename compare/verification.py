"""Printed rows held against both routes: in order, with progress, on one process or several."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
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

    @property
    def ok(self) -> bool:
        """Whether the routes agree on every row and no printed value lost its explanation."""
        return all(o.routes_agree and o.expected for o in self.outcomes)

    @property
    def summary(self) -> Counts | Any:
        """Counts of every kind of outcome."""
        return self.publication.rendering.count(self.outcomes)


def verify(
    tables: Iterable[int] | None = None,
    *,
    publication: str | Publication[Any, Any, Any] = publications.FIRST,
    rows: Iterable[str] | None = None,
    method: Method = "taylor",
    modes: int | None = None,
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
        A publication, table, row, method or number that does not exist.
    """
    paper = publications.find(publication) if isinstance(publication, str) else publication
    chosen = paper.select(
        None if tables is None else tuple(tables), None if rows is None else tuple(rows)
    )
    if method not in METHODS:
        raise ValueError(f"method = {method!r}: must be {' or '.join(METHODS)}")
    job = partial(paper.check, method=method, modes=_modes(paper, modes))
    outcomes = []
    with mapper(workers, chunk=4) as run:
        for outcome in run(job, chosen):
            outcomes.append(outcome)
            if progress is not None:
                progress(outcome)
    return Report(tuple(outcomes), paper)


def _modes(paper: Publication[Any, Any, Any], modes: int | None) -> int | None:
    if modes is None:
        return paper.modes
    count = checks.count("modes", modes, least=1, most=MAX_MODES)
    if paper.modes is None:
        raise ValueError(f"modes = {modes}: must be left out, {paper.name} has none to choose")
    return count
