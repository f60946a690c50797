"""Contenders against each other: built once, timed in rounds, held against the reference."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import heyoka_peer, ours, peers
from benchmarks.measure import once, rounds, sample
from benchmarks.reference import Reference
from benchmarks.systems import Contender, Points, Solver


@dataclass(frozen=True)
class Built:
    """A contender ready to run, and what getting it ready took."""

    contender: Contender
    solve: Solver
    seconds: float


@dataclass
class Field:
    """Who takes part, and who could not and why.

    Attributes
    ----------
    missing : dict
        Names and reasons.
    before : Path or None
        A checkout of an earlier version, for the command's own time.
    """

    missing: dict[str, str] = field(default_factory=dict)
    before: Path | None = None

    def build(self, contenders: Iterable[Contender], points: Points) -> list[Built]:
        """Build what can be built."""
        found = []
        for contender in contenders:
            try:
                solve, seconds = once(lambda c=contender: c.build(points))  # type: ignore[misc]
            except (ImportError, OSError, RuntimeError, ValueError) as error:
                self.missing[contender.name] = reason(error)
                continue
            found.append(Built(contender, solve, seconds))
        return found

    def heyoka(self) -> list[Contender]:
        """Contenders of heyoka, none where it is not installed."""
        try:
            return heyoka_peer.all_peers()
        except ImportError as error:
            self.missing["heyoka"] = reason(error)
            return []

    def everyone(self) -> list[Contender]:
        """Ours, one by one and together, and all peers."""
        own = [*ours.singles(), *ours.batches()]
        return [*own, *peers.all_peers(), *self.heyoka()]

    def reference(self, points: Points) -> Reference | None:
        """The reference at some points, where python-flint is installed."""
        try:
            return Reference(points)
        except ImportError as error:
            self.missing["reference"] = reason(error)
            return None


def compete(
    built: Sequence[Built],
    points: Points,
    count: int,
    target: float,
    reference: Reference | None,
    least: tuple[int, int] = (8, 1024),
) -> list[dict[str, Any]]:
    """One line a contender: seconds a point in every round, and the errors.

    Parameters
    ----------
    built : sequence of Built
    points : Points
        Each takes as many of the first ones as fill `target` seconds.
    count : int
        Rounds.
    target : float
        Seconds a call.
    reference : Reference or None
    least : (int, int), optional
        Points a call at least: of those that go one by one, of those that gain by company.
    """
    # equations are made once, and what that takes is measured apart
    subset = cache(points.first)
    sizes, jobs = {}, {}
    for b in built:
        fewest = least[b.contender.together]
        size = sample(partial(_some, b.solve, subset), target, len(points), fewest)
        sizes[b.contender.name] = size
        jobs[b.contender.name] = partial(b.solve, subset(size))
    seconds = rounds(jobs, count)
    return [line(b, sizes[b.contender.name], seconds[b.contender.name], reference) for b in built]


def _some(solve: Solver, subset: Callable[[int], Points], count: int) -> Any:
    return solve(subset(count))


def line(
    built: Built, size: int, seconds: Sequence[float], reference: Reference | None
) -> dict[str, Any]:
    """What the JSON keeps of a contender: times are seconds a point."""
    return {
        "name": built.contender.name,
        "settings": built.contender.settings,
        "ours": built.contender.ours,
        "points": size,
        "build_seconds": built.seconds,
        "seconds": [s / size for s in seconds],
        **errors(built.solve, reference),
    }


def errors(solve: Solver, reference: Reference | None) -> dict[str, float | None]:
    """Largest and median error against the reference."""
    if reference is None:
        return {"error": None, "error_median": None}
    found = reference.errors(solve(reference.points))
    return {"error": float(found.max()), "error_median": float(np.median(found))}


def reason(error: BaseException) -> str:
    """The first line only, and no path of this machine."""
    first = str(error).splitlines()[0] if str(error) else type(error).__name__
    return " ".join(word for word in first.split() if "/" not in word and "\\" not in word)
