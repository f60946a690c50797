"""Several processes: which they are, in what order they answer, and what becomes of them."""

import os
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info

import compare.jobs.workers
from compare.jobs.workers import (
    STARTING,
    MapLike,
    WorkersError,
    mapper,
    unordered,
    worth_starting,
)


def square(x: int) -> int:
    return x * x


def blas_threads(_: int) -> list[int]:
    import numpy  # noqa: F401 - loads what is asked about

    return [info["num_threads"] for info in threadpool_info()]


def interruptible(_: int) -> bool:
    return signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])


def leave(_: int) -> None:
    os._exit(1)


def first_waits(job: tuple[int, str]) -> int:
    """The first job is finished only after a file has appeared."""
    number, path = job
    deadline = time.monotonic() + 30.0
    while number == 0 and not Path(path).exists():
        if time.monotonic() > deadline:
            raise TimeoutError
        time.sleep(0.01)
    return number


def test_a_process_has_one_blas_thread_and_no_ear_for_interrupts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # what they would be given otherwise (on two cores or more: one core has one thread anyhow)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    with mapper(2) as run:
        counts = list(run(blas_threads, range(2)))
        heard = list(run(interruptible, range(2)))
    assert all(counts)
    assert {n for each in counts for n in each} == {1}
    # ... and the caller's environment is the caller's
    assert os.environ["OPENBLAS_NUM_THREADS"] == "3"
    assert "OMP_NUM_THREADS" not in os.environ
    # Ctrl-C reaches every process of the terminal; only the caller answers
    assert heard == [False, False]
    assert interruptible(0)


def test_order_is_kept_or_not_waited_for(tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    with mapper(2) as run:
        assert list(run(square, range(7))) == [x * x for x in range(7)]
        arrived = []
        for number in unordered(run)(first_waits, [(k, str(gate)) for k in range(4)]):
            arrived.append(number)
            if len(arrived) == 3:
                gate.touch()
    assert sorted(arrived) == [0, 1, 2, 3]
    assert arrived[-1] == 0
    # anybody's map is taken as it is
    assert unordered(map) is map


def test_a_process_that_dies_is_reported() -> None:
    for way in (lambda run: run, unordered):
        with mapper(2) as run, pytest.raises(WorkersError, match="a process died"):
            list(way(run)(leave, range(1)))


def test_minus_one_is_every_core(monkeypatch: pytest.MonkeyPatch) -> None:
    assert 1 <= compare.jobs.workers.cores() <= (os.cpu_count() or 1)
    monkeypatch.setattr(compare.jobs.workers, "cores", lambda: 1)
    with mapper(-1) as run:
        assert run is map


def where(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


@pytest.mark.parametrize("way", [lambda run: run, unordered])
def test_all_cores_are_started_when_they_are_worth_it(
    way: Callable[[MapLike], MapLike], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compare.jobs.workers, "cores", lambda: 2)
    monkeypatch.setattr(compare.jobs.workers, "STARTING", 0.2)
    with mapper(-1) as run:
        assert set(way(run)(where, [0.0] * 50)) == {os.getpid()}
        # the first long job is done here, the others are worth two processes
        first, *others = way(run)(where, [0.1] * 6)
        assert first == os.getpid()
        assert os.getpid() not in others
        # and what has been started stays
        assert os.getpid() not in set(way(run)(where, [0.0] * 3))
    for pid in others:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


def test_processes_are_worth_what_they_save() -> None:
    # two of them save half; the last round of an odd number saves nothing
    assert not worth_starting(STARTING, 1, 2)
    assert not worth_starting(0.99 * STARTING, 2, 2)
    assert worth_starting(1.01 * STARTING, 3, 2)
    assert worth_starting(0.26 * STARTING, 5, 8)
    assert not worth_starting(1e-3, 1000, 8)
    assert not worth_starting(10.0, 0, 8)


@pytest.mark.parametrize("workers", [0, -2, 1.5, True, "2", None])
def test_other_numbers_are_refused(workers: object) -> None:
    with pytest.raises(ValueError, match="workers = "), mapper(workers):  # type: ignore[arg-type]
        pass


def test_an_executor_is_told_how_to_go_in() -> None:
    with ThreadPoolExecutor(1) as pool:
        says = r"ThreadPoolExecutor: .*executor's \.map"
        with pytest.raises(ValueError, match=says), mapper(pool):  # type: ignore[arg-type]
            pass
        with mapper(pool.map) as run:
            assert list(run(square, range(3))) == [0, 1, 4]


def _begun_and_long(folder: Path) -> None:
    (folder / str(os.getpid())).touch()
    time.sleep(120.0)


def _interrupt_when_begun(folder: Path, when: list[float]) -> None:
    deadline = time.monotonic() + 60.0
    while len(list(folder.iterdir())) < 2 and time.monotonic() < deadline:
        time.sleep(0.05)
    when.append(time.monotonic())
    # the thread that waits must hear it
    signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)


def _work_for_long(folder: Path) -> None:
    with mapper(2) as run:
        list(unordered(run)(_begun_and_long, [folder, folder]))


def test_nobody_waits_for_what_was_given_up(tmp_path: Path) -> None:
    """Two minutes of work, interrupted: over at once, and nobody left."""
    when: list[float] = []
    threading.Thread(target=_interrupt_when_begun, args=(tmp_path, when)).start()
    with pytest.raises(KeyboardInterrupt):
        _work_for_long(tmp_path)
    assert time.monotonic() - when[0] < 10.0
    for path in tmp_path.iterdir():
        with pytest.raises(ProcessLookupError):
            os.kill(int(path.name), 0)


def test_a_signal_waits_for_a_process_that_is_being_started() -> None:
    """Half a process would print a traceback, and nobody would know of it."""
    done = []

    def start() -> None:
        with compare.jobs.workers._signals_later():
            signal.raise_signal(signal.SIGINT)
            done.append(True)

    with pytest.raises(KeyboardInterrupt):
        start()
    assert done
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
