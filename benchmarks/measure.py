"""Times: interleaved rounds, their spread, ratios round by round."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from random import Random
from statistics import quantiles
from typing import Any

Job = Callable[[], Any]

LEAST = 0.01
"""Seconds that are timed at least: shorter calls are repeated."""


@dataclass(frozen=True)
class Spread:
    """Of several measurements: the median, the quartiles, the extremes."""

    least: float
    low: float
    median: float
    high: float
    most: float


def spread(values: Sequence[float]) -> Spread:
    """Median, quartiles and extremes.

    Raises
    ------
    ValueError
        No values.
    """
    if not values:
        raise ValueError("values: must be at least one")
    if len(values) == 1:
        low = median = high = values[0]
    else:
        low, median, high = quantiles(values, n=4, method="inclusive")
    return Spread(min(values), low, median, high, max(values))


def ratios(theirs: Sequence[float], ours: Sequence[float]) -> Spread:
    """Of theirs to ours, round by round: what slows the machine down slows both.

    Raises
    ------
    ValueError
        Not as many rounds of the one as of the other.
    """
    if len(theirs) != len(ours):
        raise ValueError(f"rounds: {len(theirs)} of theirs, {len(ours)} of ours; must be as many")
    return spread([a / b for a, b in zip(theirs, ours, strict=True)])


def rounds(jobs: Mapping[str, Job], count: int, seed: int = 0) -> dict[str, list[float]]:
    """Seconds of every job in every round; each round does all once, in an order of its own.

    Parameters
    ----------
    jobs : mapping of name to callable
    count : int
        Rounds.
    seed : int, optional
        Of the orders.
    """
    random, seconds = Random(seed), {name: list[float]() for name in jobs}
    for _ in range(count):
        order = list(jobs)
        random.shuffle(order)
        for name in order:
            seconds[name].append(timed(jobs[name]))
    return seconds


def timed(job: Job) -> float:
    """Seconds of one call; of many, divided, where one is too short to time."""
    start = time.perf_counter()
    job()
    elapsed = time.perf_counter() - start
    if elapsed >= LEAST:
        return elapsed
    repeats = int(LEAST / max(elapsed, 1e-7)) + 1
    start = time.perf_counter()
    for _ in range(repeats):
        job()
    return (time.perf_counter() - start) / repeats


def once(job: Callable[[], Any]) -> tuple[Any, float]:
    """A call's result and its seconds."""
    start = time.perf_counter()
    result = job()
    return result, time.perf_counter() - start


def sample(job: Callable[[int], Any], target: float, most: int, least: int = 8) -> int:
    """How many points make a call that takes about `target` seconds: a power of two.

    Parameters
    ----------
    job : callable
        Computes so many points.
    target : float
        Seconds.
    most, least : int
        Points.
    """
    count = least
    while count < most and 2.0 * timed(partial(job, count)) <= target:
        count *= 2
    return min(count, most)
