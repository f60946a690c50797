"""Evaluations of P for a chart: by either route or both, on several processes, kept on disk."""

import hashlib
import io
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.parameters import Axis, Family
from compare.output import write_whole
from compare.workers import MapLike
from floquet.batch import polynomials
from hill import characteristic

Float = NDArray[np.floating[Any]]

ROUTES = ("floquet", "hill", "both")

BATCH = 256
"""Nodes of one job: enough for the batch's matrix products, few enough to lose little."""


@dataclass(frozen=True, eq=False)
class Job:
    """Nodes to evaluate, in smooth coordinates."""

    family: Family
    axes: tuple[Axis, ...]
    points: Float
    route: str


def evaluate(job: Job) -> Float:
    """P at the nodes of a job.

    Returns
    -------
    (k, n + 3) ndarray
        Coefficients, highest power first; bound on their error; difference between the routes,
        over the largest coefficient (nan where only one was asked).
    """
    values = {a.name: a.from_smooth(x) for a, x in zip(job.axes, job.points.T, strict=True)}
    own: list[tuple[Float, Float]] = []
    try:
        if job.route in ("floquet", "both"):
            found = polynomials(job.family.equations(values, closed_form=False))
            own.append((found.coefficients, found.errors))
        if job.route in ("hill", "both"):
            results = [characteristic(e) for e in job.family.equations(values, closed_form=True)]
            own.append(
                (np.array([c.polynomial for c in results]), np.array([c.error for c in results]))
            )
    except (ValueError, OverflowError):
        if len(job.points) > 1:
            halves = np.array_split(job.points, 2)
            return np.vstack([evaluate(replace(job, points=half)) for half in halves])
        # a node on a longitudinal resonance, where the force is infinite, has no P
        return np.full((1, job.family.beam.modes + 4), np.nan)
    P, errors = own[0]
    apart = np.full(len(P), np.nan)
    if len(own) == 2:
        apart = np.max(np.abs(P - own[1][0]), axis=1) / np.max(np.abs(P), axis=1)
    return np.column_stack([P, errors, apart])


class Nodes:
    """A sampler for `compare.charts.surface.fit` that remembers, on disk if asked.

    Parameters
    ----------
    family, axes, route
        What is charted.
    mapper : map-like
        Where jobs go.
    store : Path, optional
        A file of finished nodes, read at the start and replaced, whole, after every few jobs. A
        store of another chart is refused.
    """

    def __init__(
        self,
        family: Family,
        axes: tuple[Axis, ...],
        route: str,
        mapper: MapLike,
        store: Path | None = None,
    ) -> None:
        self.family, self.axes, self.route, self.mapper, self.store = (
            family,
            axes,
            route,
            mapper,
            store,
        )
        self.disagreement = 0.0
        self.resumed = 0
        self.known: dict[bytes, Float] = {}
        if store is not None and store.exists():
            self._load(store)

    @property
    def fingerprint(self) -> str:
        """What a store belongs to: everything but the number of points of the picture."""
        ranges = [(a.name, a.low, a.high) for a in self.axes]
        text = repr((self.family.beam, sorted(self.family.forcing.items()), ranges, self.route))
        return hashlib.sha256(text.encode()).hexdigest()

    def __call__(self, points: Float) -> tuple[Float, Float]:
        """Coefficients of P and their errors at smooth coordinates (k, axes)."""
        missing = np.array([i for i, p in enumerate(points) if p.tobytes() not in self.known], int)
        jobs = [
            Job(self.family, self.axes, points[missing[k : k + BATCH]], self.route)
            for k in range(0, len(missing), BATCH)
        ]
        for job, result in zip(jobs, self.mapper(evaluate, jobs), strict=True):
            for point, line in zip(job.points, result, strict=True):
                self.known[point.tobytes()] = line
            if self.store is not None:
                self._save(self.store)
        lines = np.array([self.known[p.tobytes()] for p in points])
        if self.route == "both":
            self.disagreement = max(self.disagreement, float(np.max(lines[:, -1])))
        return lines[:, :-2], lines[:, -2]

    def _save(self, store: Path) -> None:
        buffer = io.BytesIO()
        keys = np.array([np.frombuffer(key) for key in self.known])
        np.savez(
            buffer,
            points=keys,
            lines=np.array(list(self.known.values())),
            fingerprint=np.array(self.fingerprint),
        )
        write_whole(store, buffer.getvalue())

    def _load(self, store: Path) -> None:
        try:
            with np.load(store, allow_pickle=False) as content:
                owner = str(content["fingerprint"])
                points, lines = content["points"], content["lines"]
        except (OSError, ValueError, KeyError, EOFError):
            raise ValueError(f"resume = {str(store)!r}: is not a file of finished nodes") from None
        if owner != self.fingerprint:
            raise ValueError(f"resume = {str(store)!r}: holds the nodes of another chart")
        self.known = {p.tobytes(): line for p, line in zip(points, lines, strict=True)}
        self.resumed = len(self.known)
