"""Jobs on this process, on several, or on whatever maps like `map`."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context
from typing import Any

from hill import checks

MapLike = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
"""A function that maps like `map` and keeps the order."""


@contextmanager
def mapper(workers: int | MapLike, chunk: int = 1) -> Iterator[MapLike]:
    """A map over jobs.

    Parameters
    ----------
    workers : int or map-like
        Processes, or the map itself.
    chunk : int, optional
        Jobs handed to a process at a time.

    Raises
    ------
    ValueError
        `workers` is neither callable nor a whole number >= 1.
    """
    if callable(workers):
        yield workers
        return
    count = checks.count("workers", workers, least=1)
    if count == 1:
        yield map
        return
    with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as pool:
        yield partial(pool.map, chunksize=chunk)
