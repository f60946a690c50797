"""Evaluations of P for a chart: by either route or both, on several processes, kept on disk."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.parameters import Axis, Family
from compare.charts.store import Store
from compare.jobs.workers import MapLike, WorkersError, unordered
from floquet import batch as by_floquet
from hill import HillEquation
from hill import batch as by_hill
from hill.errors import LongitudinalResonance

Float = NDArray[np.floating[Any]]

ROUTES = ("floquet", "hill", "both")

BATCH = 256
"""Nodes of one job: what is lost, at most, of a process that is killed.

The size does not depend on the number of workers: nodes evaluated together share their steps, and a
chart shall be the same to the last bit on one process and on many.
"""


@dataclass(frozen=True, eq=False)
class Job:
    """Nodes to evaluate, in smooth coordinates; which one of many; by whose numerics."""

    family: Family
    axes: tuple[Axis, ...]
    points: Float
    route: str
    number: int = 0
    numerics: str = ""


def answer(job: Job) -> tuple[int, Float]:
    """The number of a job and its `evaluate`: results may then arrive in any order.

    Raises
    ------
    WorkersError
        The job was made elsewhere, by another version of `hill` and `floquet`.
    """
    if job.numerics != numerics():
        raise WorkersError(
            "workers: one runs another version of hill and floquet; install the same everywhere"
        )
    return job.number, evaluate(job)


def evaluate(job: Job) -> Float:
    """P at the nodes of a job.

    Returns
    -------
    (k, n + 3) ndarray
        Coefficients, highest power first; bound on their error; difference between the routes,
        over the largest coefficient (nan where only one was asked). A line of nan on a longitudinal
        resonance, of infinities where P is beyond a float.
    """
    values = {a.name: a.from_smooth(x) for a, x in zip(job.axes, job.points.T, strict=True)}
    return solved(job.family, values, job.route)


def solved(family: Family, values: Mapping[str, Float], route: str) -> Float:
    """P at some values of the varied parameters, as `evaluate`.

    Only what says that there is no answer is taken for one: nan where the axial force is infinite,
    and there is no equation; infinity where P is beyond a float. Anything else is told.
    """
    own: list[tuple[Float, Float]] = []
    count = len(next(iter(values.values())))
    try:
        if route in ("floquet", "both"):
            own.append(_both_of(by_floquet, family.equations(values, closed_form=False)))
        if route in ("hill", "both"):
            own.append(_both_of(by_hill, family.equations(values, closed_form=True)))
    except (LongitudinalResonance, OverflowError) as reason:
        if count > 1:
            halves = np.array_split(np.arange(count), 2)
            parts = ({name: x[half] for name, x in values.items()} for half in halves)
            return np.vstack([solved(family, part, route) for part in parts])
        lost = np.nan if isinstance(reason, LongitudinalResonance) else np.inf
        return np.full((1, family.coordinates + 3), lost)
    P, errors = own[0]
    apart = np.full(len(P), np.nan)
    if len(own) == 2:
        apart = np.max(np.abs(P - own[1][0]), axis=1) / np.max(np.abs(P), axis=1)
    return np.column_stack([P, errors, apart])


def _both_of(route: Any, equations: list[HillEquation]) -> tuple[Float, Float]:
    found = route.polynomials(equations)
    return found.coefficients, found.errors


class Nodes:
    """A sampler for `compare.charts.surface.fit` that remembers, on disk if asked.

    Parameters
    ----------
    family, axes, route
        What is charted.
    mapper : map-like
        Where jobs go; results may come back in any order.
    store : Path, optional
        A file of finished nodes, read at the start; each job is added to it as it is finished. The
        file of another chart, or of another version of the numerics, is refused.
    progress : callable, optional
        Called with the number of nodes just finished, after they are on disk.

    Raises
    ------
    ValueError
        The file cannot be used; or, while sampling, the map is not one.
    WorkersError
        While sampling: workers were lost, or run another version.
    """

    def __init__(
        self,
        family: Family,
        axes: tuple[Axis, ...],
        route: str,
        mapper: MapLike,
        store: Path | None = None,
        progress: Callable[[int], Any] | None = None,
    ) -> None:
        self.family, self.axes, self.route, self.mapper = family, axes, route, mapper
        self.progress = progress
        self.disagreement = 0.0
        self.resumed = 0
        self.known: dict[bytes, Float] = {}
        self.columns = family.coordinates + 3
        self.store: Store | None = None
        if store is not None:
            self.store = Store(store, self.owner, len(axes) + self.columns)
            self._remember(self.store.lines)
            self.resumed = len(self.known)

    @property
    def owner(self) -> dict[str, Any]:
        """What a store belongs to: everything but the number of points of the picture."""
        varied = {axis.name for axis in self.axes}
        beam = {f.name: getattr(self.family.beam, f.name) for f in fields(self.family.beam)}
        fixed = beam | {name: float(value) for name, value in self.family.forcing.items()}
        return {
            "beam": type(self.family.beam).__name__,
            "axes": [[a.name, float(a.low), float(a.high)] for a in self.axes],
            "fixed": {name: fixed[name] for name in sorted(fixed) if name not in varied},
            "route": self.route,
            "numerics": numerics(),
        }

    @property
    def sampled(self) -> tuple[Float, Float]:
        """Where P is known, in smooth coordinates (nodes, axes), and how far the routes differ."""
        keys = [np.frombuffer(key) for key in self.known]
        apart = [line[-1] for line in self.known.values()]
        return np.array(keys).reshape(len(keys), len(self.axes)), np.array(apart)

    def __call__(self, points: Float) -> tuple[Float, Float]:
        """Coefficients of P and their errors at smooth coordinates (k, axes)."""
        jobs = {job.number: job for job in self._jobs(points)}
        results = unordered(self.mapper)(answer, list(jobs.values()))
        try:
            for result in results:
                self._finish(*self._taken(jobs, result))
        finally:
            # a map that is left in the middle may have jobs to call back
            if hasattr(results, "close"):
                results.close()
        if jobs:
            raise ValueError(f"workers: the map left {len(jobs)} jobs without a result")
        lines = np.array([self.known[p.tobytes()] for p in points])
        apart = lines[:, -1]
        self.disagreement = max([self.disagreement, *apart[np.isfinite(apart)].tolist()])
        return lines[:, :-2], lines[:, -2]

    def _finish(self, job: Job, lines: Float) -> None:
        whole = np.column_stack([job.points, lines])
        if self.store is not None:
            self.store.append(whole)
        self._remember(whole)
        if self.progress is not None:
            self.progress(len(lines))

    def _jobs(self, points: Float) -> list[Job]:
        """What is not known of the points, cut where it would be cut if nothing were known.

        Nodes whose beam is the same come together, and those of like Omega: they share matrices
        and steps.
        """
        # the last key is the slowest to vary: the beam's parameters, then Omega, gamma, eta
        slower = sorted(range(len(self.axes)), key=lambda k: _pace(self.axes[k].name))
        ordered = points[np.lexsort(points.T[slower])]
        mine = numerics()
        jobs = []
        for k in range(0, len(ordered), BATCH):
            new = [p for p in ordered[k : k + BATCH] if p.tobytes() not in self.known]
            if new:
                jobs.append(Job(self.family, self.axes, np.array(new), self.route, k, mine))
        return jobs

    def _taken(self, jobs: dict[int, Job], result: Any) -> tuple[Job, Float]:
        """The job that a result is of, and its lines; the job is then done with."""
        if isinstance(result, tuple) and len(result) == 2 and result[0] in jobs:
            return jobs.pop(result[0]), result[1]
        raise ValueError(
            f"workers: the map returned a {type(result).__name__} that is no job's result; a Dask "
            "client goes in as compare.jobs.cluster.over(client)"
        )

    def _remember(self, whole: Float) -> None:
        for line in whole:
            self.known[line[: len(self.axes)].tobytes()] = line[len(self.axes) :]


def _pace(name: str) -> int:
    """How readily a parameter varies from node to node of a job."""
    return {"eta": 0, "gamma": 1, "Omega": 2}.get(name, 3)


@cache
def numerics() -> str:
    """A name for what computes: it changes whenever `hill` or `floquet` do."""
    digest = hashlib.sha256()
    for package in ("hill", "floquet"):
        root = Path(str(files(package)))
        for path in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".c")):
            name = path.relative_to(root).as_posix()
            digest.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]
