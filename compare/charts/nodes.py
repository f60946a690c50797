"""Evaluations of P for a chart: by either route or both, on several processes, kept on disk."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.identity import (
    code_fingerprint,
    own_modules,
    source_fingerprint,
    type_name,
    value_fingerprint,
)
from compare.charts.scenario import Scenario
from compare.charts.store import Store
from compare.jobs.workers import MapLike, WorkersError, unordered
from floquet.data_errors import data_share
from hill import HillEquation
from hill.system import FORCING, varied

Float = NDArray[np.floating[Any]]

ROUTES = ("floquet", "hill", "both")

SAME = 1e-11
"""Of P's largest coefficient: the routes differ beyond it. No bound of P counts the last digits of
matrices that are made twice: 3e-14 at the report's nodes, 8e-12 along poles of omega_L."""

NODES_PER_JOB = 256
"""What is lost, at most, of a process that is killed.

The size does not depend on the number of workers: nodes evaluated together share their steps, and a
chart shall be the same to the last bit on one process and on many.
"""


@dataclass(frozen=True, eq=False)
class Job:
    """Nodes to evaluate, the values of the axes (k, axes); which one of many; by whose code.

    `own_modules` are the user's own, whose code goes with the job to where they are not.
    """

    scenario: Scenario
    points: Float
    route: str
    number: int = 0
    code: str = ""
    own_modules: tuple[str, ...] = ()


def code_of(scenario: Scenario) -> str:
    """A name for everything that computes a scenario's nodes."""
    return f"{source_fingerprint()} {code_fingerprint(scenario.system)}"


def run_job(job: Job) -> tuple[int, Float]:
    """The number of a job and its `evaluate`: results may then arrive in any order.

    Raises
    ------
    WorkersError
        The job was made elsewhere, by other code.
    """
    if job.code != code_of(job.scenario):
        raise WorkersError(
            "workers: one runs another version of hill and floquet, or of the system's own code; "
            "install the same everywhere"
        )
    return job.number, evaluate(job)


def evaluate(job: Job) -> Float:
    """P at the nodes of a job.

    Returns
    -------
    (k, degree + 3) ndarray
        Coefficients, highest power first; bound on their error; difference between the routes,
        over the largest coefficient (nan where only one was asked, and where it is beyond `SAME`
        but no more than what both may be off, their matrices' rounding included: nothing is
        compared there). A line of nan on a pole of the system, of infinities where P is beyond a
        float.
    """
    values = dict(zip(job.scenario.names, job.points.T, strict=True))
    return solved(job.scenario, values, job.route)


def solved(scenario: Scenario, values: Mapping[str, Float], route: str) -> Float:
    """P at some values of the varied parameters, as `evaluate`.

    Only what says that there is no answer is taken for one: nan where the system has no equation,
    or one so near a pole that it would take for ever; infinity where P is beyond a float. Anything
    else is told.
    """
    asked = ("floquet", "hill") if route == "both" else (route,)
    made = [scenario.equations(values, asked[0])]
    if len(asked) == 2:
        made.append(made[0] if scenario.shared_matrices else scenario.equations(values, asked[1]))
    lines = np.full((len(made[0]), scenario.coordinates + 3), np.nan)
    there = [k for k, pair in enumerate(zip(*made, strict=True)) if None not in pair]
    if there:
        own = [[equations[k] for k in there] for equations in made]
        lines[there] = _lines(scenario, asked, own)
    return lines


def _lines(scenario: Scenario, routes: Sequence[str], made: Sequence[Sequence[Any]]) -> Float:
    """P of equations that there are, as `solved`; each route has its own."""
    try:
        # growth beyond a float is said by an OverflowError
        with np.errstate(over="ignore", invalid="ignore"):
            own = [
                scenario.reading.polynomials[route](equations)
                for route, equations in zip(routes, made, strict=True)
            ]
    except OverflowError:
        count = len(made[0])
        if count == 1:
            return np.full((1, scenario.coordinates + 3), np.inf)
        halves = np.array_split(np.arange(count), 2)
        parts = ([[equations[k] for k in half] for equations in made] for half in halves)
        return np.vstack([_lines(scenario, routes, part) for part in parts])
    P, errors = own[0].coefficients, own[0].errors
    apart = np.full(len(P), np.nan)
    if len(own) == 2:
        difference = np.max(np.abs(P - own[1].coefficients), axis=1)
        apart = difference / np.max(np.abs(P), axis=1)
        for k in np.flatnonzero(apart > SAME):
            # as next to a pole, where much growth makes much of a matrix's last digit
            both = (equations[int(k)] for equations in made)
            shares = [data_share(e) for e in both if isinstance(e, HillEquation)]
            known_to = errors[k] + own[1].errors[k] + sum(shares) * np.sum(np.abs(P[k]))
            if difference[k] <= known_to:
                apart[k] = np.nan
    return np.column_stack([P, errors, apart])


class Nodes:
    """A sampler for `compare.charts.surface.fit` that remembers, on disk if asked.

    Parameters
    ----------
    scenario, route
        What is charted.
    mapper : map-like
        Where jobs go; results may come back in any order.
    store : Path, optional
        A file of finished nodes, read at the start; each job is added to it as it is finished. The
        file of another chart, or of another version of the code, is refused.
    progress : callable, optional
        Called with the number of nodes just finished, after they are on disk.
    stage : callable, optional
        Called with "nodes", how many are known and how many have been asked for so far.

    Raises
    ------
    ValueError
        The file cannot be used; or, while sampling, the map is not one.
    WorkersError
        While sampling: workers were lost, or run another version.
    """

    def __init__(
        self,
        scenario: Scenario,
        route: str,
        mapper: MapLike,
        store: Path | None = None,
        progress: Callable[[int], Any] | None = None,
        stage: Callable[[str, int, int], Any] | None = None,
    ) -> None:
        self.scenario, self.route, self.mapper = scenario, route, mapper
        self.progress, self.stage = progress, stage
        self.disagreement = 0.0
        self.resumed = 0
        self.known: dict[bytes, Float] = {}
        self.columns = scenario.coordinates + 3
        self.store: Store | None = None
        if store is not None:
            self.store = Store(store, self.owner, len(scenario.axes) + self.columns)
            self._remember(self.store.lines)
            self.resumed = len(self.known)

    @property
    def owner(self) -> dict[str, Any]:
        """What a store belongs to: everything but the number of points of the picture."""
        scenario = self.scenario
        low = {a.name: a.low for a in scenario.axes if a.name not in FORCING}
        system = varied(scenario.system, low)
        own = [f.name for f in fields(system)] if is_dataclass(system) else []
        numbers = {n: getattr(system, n) for n in own if _is_number(getattr(system, n))}
        fixed = {k: v for k, v in (numbers | scenario.fixed).items() if k not in scenario.names}
        return {
            "system": type_name(system),
            "axes": [[a.name, float(a.low), float(a.high)] for a in scenario.axes],
            "fixed": {name: fixed[name] for name in sorted(fixed)},
            "values": value_fingerprint(system),
            "route": self.route,
            "source": source_fingerprint(),
            "code": code_fingerprint(system),
        }

    @property
    def sampled(self) -> tuple[Float, Float]:
        """Where P is known, the values of the axes (nodes, axes); how far the routes differ.

        In order of the axes' values: jobs end in any order.
        """
        keys = np.array([np.frombuffer(key) for key in self.known])
        keys = keys.reshape(len(self.known), len(self.scenario.axes))
        apart = np.array([line[-1] for line in self.known.values()])
        order = np.lexsort(keys.T[::-1])
        return keys[order], apart[order]

    def __call__(self, smooth: Float) -> tuple[Float, Float]:
        """Coefficients of P and their errors at smooth coordinates (k, axes)."""
        return self.at(self.scenario.smooth.from_smooth(smooth))

    def at(self, points: Float) -> tuple[Float, Float]:
        """Coefficients of P and their errors at values of the axes (k, axes)."""
        jobs = {job.number: job for job in self._jobs(points)}
        wanted = len(self.known) + sum(len(job.points) for job in jobs.values())
        self._tell(wanted)
        results = unordered(self.mapper)(run_job, list(jobs.values()))
        try:
            for result in results:
                self._finish(*self._job_of(jobs, result))
                self._tell(wanted)
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

    def _tell(self, wanted: int) -> None:
        if self.stage is not None:
            self.stage("nodes", len(self.known), wanted)

    def _finish(self, job: Job, lines: Float) -> None:
        whole = np.column_stack([job.points, lines])
        if self.store is not None:
            self.store.append(whole)
        self._remember(whole)
        if self.progress is not None:
            self.progress(len(lines))

    def _jobs(self, points: Float) -> list[Job]:
        """What is not known of the points, cut where it would be cut if nothing were known.

        Nodes of one system come together, and those of like Omega: they share matrices and steps.
        """
        # the last key is the slowest to vary: the system's parameters, then Omega, gamma, eta
        names, smooth = self.scenario.names, self.scenario.smooth
        slower = sorted(range(len(names)), key=lambda k: _sort_rank(names[k]))
        keys = points.copy()
        if smooth.ratio is not None:
            keys[:, smooth.ratio] = smooth.to_smooth(points)[:, smooth.ratio]
        ordered = points[np.lexsort(keys.T[slower])]
        code, own = code_of(self.scenario), own_modules(self.scenario.system)
        jobs = []
        for k in range(0, len(ordered), NODES_PER_JOB):
            part = ordered[k : k + NODES_PER_JOB]
            new = [p for p in part if p.tobytes() not in self.known]
            if new:
                jobs.append(Job(self.scenario, np.array(new), self.route, k, code, own))
        return jobs

    def _job_of(self, jobs: dict[int, Job], result: Any) -> tuple[Job, Float]:
        """The job that a result is of, and its lines; the job is then done with."""
        if isinstance(result, tuple) and len(result) == 2 and result[0] in jobs:
            return jobs.pop(result[0]), result[1]
        raise ValueError(
            f"workers: the map returned a {type(result).__name__} that is no job's result; a Dask "
            "client goes in as compare.over(client)"
        )

    def _remember(self, whole: Iterable[Float]) -> None:
        axes = len(self.scenario.axes)
        for line in whole:
            self.known[line[:axes].tobytes()] = line[axes:]


def _sort_rank(name: str) -> int:
    """How readily a parameter varies from node to node of a job."""
    return {"eta": 0, "gamma": 1, "Omega": 2}.get(name, 3)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | str) and not isinstance(value, bool)
