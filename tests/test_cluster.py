"""The same call on a Dask cluster: two processes of this machine stand for it."""

import logging
import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.charts.compute import chart
from compare.charts.nodes import NODES_PER_JOB, Nodes
from compare.charts.scenario import scenario
from compare.jobs import cluster
from compare.jobs.cluster import connect, over
from compare.jobs.workers import WorkersError, unordered
from hill import UniformBeam

distributed = pytest.importorskip("distributed", reason="needs the extra: cluster")
dask_config = pytest.importorskip("dask.config")

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
CUBE = [("Omega", 1.0, 1.3, 8), ("gamma", 0.0, 0.2, 7), ("T0", 15.0, 20.0, 6)]


@pytest.fixture(scope="module")
def local() -> Iterator[Any]:
    # one death of a worker is forgiven (Dask's own rule is three), to see both in a short time
    with (
        dask_config.set({"distributed.scheduler.allowed-failures": 1}),
        distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=True,
            dashboard_address=":0",
            silence_logs=logging.CRITICAL,
        ) as processes,
    ):
        yield processes


@pytest.fixture(scope="module")
def client(local: Any) -> Iterator[Any]:
    with distributed.Client(local) as connected:
        yield connected


def where(_: int) -> tuple[int, list[int]]:
    import numpy  # noqa: F401 - loads what is asked about
    from threadpoolctl import threadpool_info

    time.sleep(0.05)
    return os.getpid(), [info["num_threads"] for info in threadpool_info()]


def leave(job: tuple[int, str, int]) -> int:
    """Job 1 takes its process with it, so many times; the file counts."""
    number, path, times = job
    with Path(path).open("a") as file:
        if number == 1 and file.tell() < times:
            file.write("x")
            file.close()
            os._exit(1)
    return number


def wrong(number: int) -> int:
    if number == 2:
        raise ZeroDivisionError("job 2")
    return number


def wrong_or_slow(number: int) -> int:
    return wrong(2) if number == 0 else slow(number)


def slow(number: int) -> int:
    time.sleep(0.2)
    return number


def wait_until(there: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30.0
    while not there():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def test_a_chart_of_three_parameters_is_the_same_to_the_last_bit(client: Any) -> None:
    here = chart(BEAM, CUBE, route="floquet", tolerance=1e-3)
    there = chart(BEAM, CUBE, route="floquet", tolerance=1e-3, workers=over(client))
    assert there.T.shape == (6, 7, 8)
    assert 0.0 < np.mean(there.T > 1e-3) < 1.0
    assert np.array_equal(here.T, there.T)
    # several jobs for either process
    assert there.nodes > 4 * NODES_PER_JOB / 2


def test_both_routes_are_asked_there(client: Any, tmp_path: Path) -> None:
    points = np.random.default_rng(5).uniform([0.8, 0.0, 15.0], [0.9, 0.2, 20.0], (48, 3))
    path = tmp_path / "cube.nodes"
    sample = [
        Nodes(scenario(BEAM, CUBE), "both", run, store)
        for run, store in ((map, None), (over(client), path))
    ]
    (P, errors), (other, _) = (nodes(points) for nodes in sample)
    assert np.array_equal(P, other)
    assert 0.0 < sample[0].disagreement == sample[1].disagreement < errors.max()
    # what the cluster finished is on this side's disk
    assert Nodes(scenario(BEAM, CUBE), "both", map, path).resumed == 48


def test_two_processes_of_one_thread_each(client: Any) -> None:
    found = list(over(client)(where, range(8)))
    assert len({pid for pid, _ in found} - {os.getpid()}) == 2
    assert {n for _, counts in found for n in counts} == {1}


def test_order_is_kept_or_not_waited_for(client: Any) -> None:
    assert list(over(client)(slow, range(4))) == [0, 1, 2, 3]
    assert sorted(unordered(over(client))(slow, range(4))) == [0, 1, 2, 3]
    assert unordered(over(client)) != over(client)


def test_equal_jobs_are_done_each(client: Any) -> None:
    # one process would answer for all of them, at once, if Dask took equal jobs for one
    assert list(over(client)(slow, [7, 7, 7])) == [7, 7, 7]


def test_a_job_that_raises_is_heard(client: Any) -> None:
    with pytest.raises(ZeroDivisionError, match=r"^job 2$"):
        list(over(client)(wrong, range(4)))


def test_one_that_stops_leaves_nothing_behind(client: Any, local: Any) -> None:
    results = iter(over(client)(slow, range(40)))
    assert next(results) == 0
    results.close()  # type: ignore[attr-defined]
    wait_until(lambda: not local.scheduler.tasks)
    # ... though somebody keeps the error, and with it the frame that has the futures
    with pytest.raises(ZeroDivisionError) as kept:
        list(over(client)(wrong_or_slow, range(40)))
    wait_until(lambda: not local.scheduler.tasks)
    assert kept.traceback


def test_a_cluster_by_its_address(local: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    with connect(local.scheduler_address) as run:
        assert list(run(slow, range(3))) == [0, 1, 2]
    monkeypatch.setattr(cluster, "CONNECT_TIMEOUT", 0.2)
    for address in ("tcp://127.0.0.1:1", "nonsense"):
        says = f"^cluster = '{address}': no scheduler"
        with pytest.raises(ValueError, match=says), connect(address):
            pass


def test_a_client_is_told_how_to_go_in(client: Any) -> None:
    with pytest.raises(ValueError, match=r"workers = Client: .*over\(client\)"):
        chart(BEAM, CUBE, route="floquet", workers=client)
    with pytest.raises(ValueError, match=r"returned a Future .*over\(client\)"):
        chart(BEAM, CUBE, route="floquet", workers=client.map)


def test_a_cluster_that_closes_is_reported(local: Any) -> None:
    for way in (lambda run: run, unordered):
        with distributed.Client(local, set_as_default=False) as own:
            results = iter(way(over(own))(slow, range(40)))
            next(results)
            own.close()
            with pytest.raises(WorkersError, match="closed before the jobs were done"):
                list(results)


# last: Dask takes its time to start new workers
def test_a_worker_that_dies_is_replaced_once(client: Any, tmp_path: Path) -> None:
    once, always = str(tmp_path / "once"), str(tmp_path / "always")
    assert list(over(client)(leave, [(k, once, 1) for k in range(3)])) == [0, 1, 2]
    assert Path(once).read_text() == "x"
    with pytest.raises(WorkersError, match="lost every worker that it was given to"):
        list(over(client)(leave, [(1, always, 9)]))
    assert Path(always).read_text() == "xx"


@pytest.mark.parametrize(
    "address",
    ["http://host:80", "tcp://:80", "tcp://host:0", "tcp://host:65536", "tcp://host:٣", "host", ""],
)
def test_what_is_no_address(address: str) -> None:
    with pytest.raises(ValueError, match="no scheduler has such an address"), connect(address):
        pass


def test_who_listens_and_is_no_scheduler(monkeypatch: pytest.MonkeyPatch) -> None:
    """Dask would wait for a word from it for ever."""
    monkeypatch.setattr(cluster, "CONNECT_TIMEOUT", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(ValueError, match="no scheduler answers"), connect(address):
            pass


SCHEDULER = """\
import time
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(
        n_workers=1, processes=False, protocol="tcp://", dashboard_address=None
    ) as local:
        print(local.scheduler_address, flush=True)
        time.sleep(60.0)
"""


def test_a_scheduler_that_dies_is_one_line(tmp_path: Path) -> None:
    script, nodes = tmp_path / "scheduler.py", tmp_path / "chart.nodes"
    script.write_text(SCHEDULER)
    command = [sys.executable, "-m", "compare", "chart", "--x", "Omega", "0.35", "6", "100"]
    command += ["--y", "T0", "0", "25", "100", "--also", "gamma", "0", "0.3", "10"]
    with subprocess.Popen(
        [sys.executable, str(script)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as scheduler:
        assert scheduler.stdout is not None
        address = scheduler.stdout.readline().strip()
        command += ["--cluster", address, "--resume", str(nodes)]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
            deadline = time.monotonic() + 60.0
            while not (nodes.exists() and b"NODE" in nodes.read_bytes()):
                assert time.monotonic() < deadline
                assert run.poll() is None
                time.sleep(0.02)
            scheduler.kill()
            _, said = run.communicate(timeout=30)
    assert run.returncode == 2
    assert said == "verify chart: workers: the cluster was closed before the jobs were done\n"
