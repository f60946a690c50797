"""Jobs on this process, on several, or on whatever maps like `map`."""

import os
import pickle
import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from functools import partial
from multiprocessing import parent_process
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any

from hill import checks

MapLike = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
"""A function that maps like `map` and keeps the order."""

ALL_CORES = -1
"""As SciPy says "all cores": as many as there are, once they are worth starting."""

STARTING = 3.0
"""Seconds that several processes must save to be started. It takes one to two until the first has
this package and its libraries; jobs to come may be shorter than the last one."""

# As many processes as cores leave nothing for BLAS threads to do but wait for each other.
ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class WorkersError(RuntimeError):
    """Workers were lost: nothing is said about the numbers."""


@contextmanager
def mapper(workers: int | MapLike, chunk: int = 1, *, long_jobs: bool = False) -> Iterator[MapLike]:
    """A map over jobs.

    Parameters
    ----------
    workers : int or map-like
        Processes, or the map itself. Processes are spawned, each with one BLAS thread, and go when
        this process goes, however it ends. -1 is one a core, started only when what is left to do,
        measured by the last job done here, is worth it; until then jobs are done in this process.
    chunk : int, optional
        Jobs handed to a process at a time.
    long_jobs : bool, optional
        Each takes seconds: -1 then starts at once.

    Raises
    ------
    ValueError
        `workers` is neither callable nor a whole number >= 1 nor -1.
    WorkersError
        While mapping: a process died.
    """
    if callable(workers):
        yield workers
        return
    if hasattr(workers, "submit"):
        kind = type(workers).__name__
        raise ValueError(
            f"workers = {kind}: must be a number, or a function that maps like map, such as an "
            "executor's .map or compare.over(client)"
        )
    count = cores() if workers == ALL_CORES else checks.count("workers", workers, least=1)
    if count == 1:
        yield map
        return
    if workers == ALL_CORES and not long_jobs:
        with ExitStack() as stack:
            start = partial(stack.enter_context, _processes(count, chunk))
            yield _WhenWorthIt(count, start)
        return
    with _processes(count, chunk) as run:
        yield run


@contextmanager
def _processes(count: int, chunk: int) -> Iterator["_Processes"]:
    context = _Context()
    pool = ProcessPoolExecutor(count, mp_context=context, initializer=_follow_parent)
    try:
        yield _Processes(pool, chunk)
    except BaseException:
        # nobody waits for what is still being worked on, half a minute of it perhaps
        context.kill()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def unordered(run: MapLike) -> MapLike:
    """The same map with results as they are ready, where it has a way to do that."""
    return getattr(run, "unordered", run)


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def worth_starting(seconds: float, left: int, count: int) -> bool:
    """Whether `count` processes would save `STARTING` on so many jobs that take so long each."""
    rounds = -(-left // count)  # the last round may leave some without a job
    return seconds * (left - rounds) > STARTING


class _WhenWorthIt:
    """Jobs are done here, until those that are left are worth several processes."""

    def __init__(self, count: int, start: Callable[[], "_Processes"]) -> None:
        self._count, self._start = count, start
        self._processes: _Processes | None = None

    def __call__(self, function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterator[Any]:
        left = deque(jobs)
        yield from self._here(function, left)
        if self._processes is not None:
            yield from self._processes(function, left)

    def unordered(self, function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterator[Any]:
        """Results as they are ready."""
        left = deque(jobs)
        yield from self._here(function, left)
        if self._processes is not None:
            yield from self._processes.unordered(function, left)

    def _here(self, function: Callable[[Any], Any], left: deque[Any]) -> Iterator[Any]:
        """Take jobs from the left and do them, while there are no processes."""
        while left and self._processes is None:
            started = time.perf_counter()
            result = function(left.popleft())
            seconds = time.perf_counter() - started
            yield result
            if worth_starting(seconds, len(left), self._count):
                self._processes = self._start()


class _Processes:
    """A pool as a map: in order when called, as they are ready by `unordered`."""

    def __init__(self, pool: ProcessPoolExecutor, chunk: int) -> None:
        self._pool, self._chunk = pool, chunk

    def __call__(self, function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterator[Any]:
        wanted = list(jobs)
        _check_sendable(function, wanted)
        with _translate_worker_loss():
            yield from self._pool.map(function, wanted, chunksize=self._chunk)

    def unordered(self, function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterator[Any]:
        """Results as they are ready."""
        wanted = list(jobs)
        _check_sendable(function, wanted)
        with _translate_worker_loss():
            for future in as_completed([self._pool.submit(function, job) for job in wanted]):
                yield future.result()


def _check_sendable(function: Callable[[Any], Any], jobs: list[Any]) -> None:
    """Refuse what no process could be given, in the words of what is wrong with it."""
    try:
        pickle.dumps((function, jobs[:1]))
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        words = " ".join(str(error).split())
        raise ValueError(
            f"workers: a job cannot be sent to another process ({words}); a system's class must "
            "stand at the top of a script or a module"
        ) from None


@contextmanager
def _translate_worker_loss() -> Iterator[None]:
    try:
        yield
    except BrokenProcessPool:
        raise WorkersError(
            "workers: a process died, killed or out of memory; or the calling script is not "
            'guarded by if __name__ == "__main__", or has its system\'s class behind that line'
        ) from None


class _Process(SpawnProcess):
    """A process whose libraries find `ONE_THREAD` set when they are loaded."""

    def start(self) -> None:
        """Start it; it ignores the terminal's Ctrl-C, which is this process's to answer."""
        with _environment(ONE_THREAD), _no_interrupts(), _signals_later():
            super().start()


class _Context(SpawnContext):
    """Knows the processes that it made."""

    def __init__(self) -> None:
        self._made: list[_Process] = []

    def Process(self, *args: Any, **keywords: Any) -> _Process:  # type: ignore[override]
        """One more."""
        made = _Process(*args, **keywords)
        self._made.append(made)
        return made

    def kill(self) -> None:
        """End them, wherever they are: jobs only compute, so that there is nothing to take back.

        Not by a signal that Python answers: that would print where it met them, imports included.
        """
        for process in self._made:
            if process.is_alive():
                process.kill()


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _no_interrupts() -> Iterator[None]:
    """Hold back Ctrl-C; a process started meanwhile never hears it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _signals_later() -> Iterator[None]:
    """Hold back whatever signal would end the caller: half a process cannot be ended in order.

    A blocked one is not enough: another thread may take it, and the main one is told all the same.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard: list[int] = []
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    # None: set by other than Python, which could not put it back
    mine = {number: handler for number, handler in before.items() if handler is not None}
    for number in mine:
        signal.signal(number, lambda number, _: heard.append(number))
    try:
        yield
    finally:
        for number, handler in mine.items():
            signal.signal(number, handler)
        if heard:
            signal.raise_signal(heard[0])


def _follow_parent() -> None:
    """End with the parent: if it is killed the pool's queues alone would keep this one waiting."""
    parent = parent_process()
    if parent is None:
        return

    def wait() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
