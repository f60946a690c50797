"""A run that is killed: nothing finished is lost, nothing is half-written, and it resumes."""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.charts import identity, nodes
from compare.charts.compute import Chart, chart
from compare.charts.nodes import Nodes
from compare.charts.scenario import scenario
from compare.charts.store import HEAD, Store
from hill import UniformBeam

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
AXES = [("Omega", 0.9, 1.3, 31), ("gamma", 0.0, 0.3, 21)]

# Small jobs, so that there are many moments to be killed at. A job's line appears when the next
# one is asked for: then it is on disk.
SLOWLY = """
import sys, time
from compare.charts import nodes
from compare.charts.compute import chart
from hill import UniformBeam

def slowly(function, jobs):
    for job in jobs:
        time.sleep(0.02)
        yield function(job)
        print(len(job.points), flush=True)

nodes.NODES_PER_JOB = 8
beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
axes = [("Omega", 0.9, 1.3, 31), ("gamma", 0.0, 0.3, 21)]
chart(beam, axes, route="floquet", workers=slowly, resume=sys.argv[1])
print("done", flush=True)
"""

SPREAD = """
import multiprocessing, sys
from pathlib import Path
from compare.charts.nodes import Nodes
from compare.charts.scenario import scenario
from compare.jobs.workers import mapper
from hill import UniformBeam
import numpy as np

if __name__ == "__main__":
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
    wanted = scenario(beam, [("Omega", 0.9, 1.3, 31), ("gamma", 0.0, 0.3, 21)])
    points = np.random.default_rng(1).uniform([0.8, 0.0], [1.1, 0.3], (20000, 2))
    def told(count):
        print(count, *(p.pid for p in multiprocessing.active_children()), flush=True)
    with mapper(2) as run:
        Nodes(wanted, "hill", run, Path(sys.argv[1]), told)(points)
"""


def start(script: str, *words: str) -> "subprocess.Popen[str]":
    """A process in a session of its own, as from a terminal: its whole group can be signalled."""
    return subprocess.Popen(
        [sys.executable, "-c", script, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def held(path: Path, route: str = "floquet") -> Nodes:
    """The file as the next run will find it."""
    return Nodes(scenario(BEAM, AXES), route, map, path)


@pytest.fixture
def small_jobs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nodes, "NODES_PER_JOB", 8)


@pytest.fixture
def whole(small_jobs: None) -> Chart:
    return chart(BEAM, AXES, route="floquet")


# ---- killed ----------------------------------------------------------------------------------


def test_killed_again_and_again(whole: Chart, tmp_path: Path) -> None:
    path = tmp_path / "chart.nodes"
    rng = np.random.default_rng(2)
    reported = 0
    for jobs in (1, 2, 6):
        with start(SLOWLY, str(path)) as run:
            assert run.stdout is not None
            reported += sum(int(run.stdout.readline()) for _ in range(jobs))
            time.sleep(rng.uniform(0.0, 0.03))
            run.kill()
            reported += sum(map(int, run.stdout.read().split()))
        assert [p.name for p in tmp_path.iterdir()] == [path.name]
        assert held(path).resumed >= reported
    assert 0 < reported < whole.nodes
    again = chart(BEAM, AXES, route="floquet", resume=path)
    assert again.resumed >= reported
    assert np.array_equal(again.T, whole.T)
    # what is finished is not computed again
    finished = chart(BEAM, AXES, route="floquet", resume=path, workers=never)
    assert finished.resumed == finished.nodes == whole.nodes
    assert np.array_equal(finished.T, whole.T)


def never(function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterator[Any]:
    for _ in jobs:
        raise AssertionError("nothing was left to do")
    return iter(())


def test_killed_with_two_processes(tmp_path: Path) -> None:
    path = tmp_path / "chart.nodes"
    script = tmp_path / "run.py"
    script.write_text(SPREAD)
    with subprocess.Popen(
        [sys.executable, str(script), str(path)], stdout=subprocess.PIPE, text=True
    ) as run:
        assert run.stdout is not None
        lines = [run.stdout.readline().split() for _ in range(3)]
        run.kill()
    assert held(path, "hill").resumed >= sum(int(line[0]) for line in lines)
    # its processes do not outlive it
    deadline = time.monotonic() + 30.0
    started = {int(pid) for line in lines for pid in line[1:]}
    assert len(started) == 2
    while any(runs(pid) for pid in started):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def runs(pid: int) -> bool:
    """Whether a process is there and has not ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def test_interrupted_from_the_keyboard(tmp_path: Path) -> None:
    path = tmp_path / "chart.nodes"
    words = ["-m", "compare", "chart", "--x", "Omega", "0.35", "6", "9", "--y", "gamma", "0", "1"]
    words += ["9", "--route", "hill", "--workers", "2", "--resume", str(path)]
    with subprocess.Popen(
        [sys.executable, *words], stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as run:
        # the first line is there before the processes are, a node after the first job
        wait_for(lambda: path.exists() and b"NODE" in path.read_bytes())
        os.killpg(run.pid, signal.SIGINT)
        assert run.stderr is not None
        said = run.stderr.read()
    assert run.returncode == 130
    assert said == "verify chart: interrupted\n"
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    wide = [("Omega", 0.35, 6.0, 9), ("gamma", 0.0, 1.0, 9)]
    assert Nodes(scenario(BEAM, wide), "hill", map, path).resumed > 0


def wait_for(there: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 60.0
    while not there():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def test_results_may_come_in_any_order(whole: Chart, tmp_path: Path, small_jobs: None) -> None:
    path = tmp_path / "chart.nodes"

    def backwards(function: Callable[[Any], Any], jobs: list[Any]) -> Iterator[Any]:
        return (function(job) for job in reversed(jobs))

    def two_of_them(function: Callable[[Any], Any], jobs: list[Any]) -> Iterator[Any]:
        yield from (function(job) for job in jobs[-2:])
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        chart(BEAM, AXES, route="floquet", workers=two_of_them, resume=path)
    assert 8 < held(path).resumed <= 16
    again = chart(BEAM, AXES, route="floquet", workers=backwards, resume=path)
    assert np.array_equal(again.T, whole.T)


def test_progress_comes_after_the_disk(tmp_path: Path, small_jobs: None) -> None:
    path = tmp_path / "chart.nodes"
    told: list[int] = []

    def progress(count: int) -> None:
        told.append(count)
        assert held(path).resumed == sum(told)

    points = np.random.default_rng(1).uniform([0.8, 0.0], [1.1, 0.3], (20, 2))
    Nodes(scenario(BEAM, AXES), "floquet", map, path, progress)(points)
    assert told == [8, 8, 4]


# ---- the file --------------------------------------------------------------------------------

OWNER = {"chart": "this one", "values": [1.0, float("inf")]}


@pytest.fixture
def stored(tmp_path: Path) -> tuple[Path, np.ndarray[Any, Any]]:
    """A file of three records, of 1, 2 and 3 lines."""
    path = tmp_path / "lines"
    store = Store(path, OWNER, 3)
    lines = np.random.default_rng(3).normal(size=(6, 3))
    for a, b in ((0, 1), (1, 3), (3, 6)):
        store.append(lines[a:b])
    return path, lines


def test_cut_anywhere_it_keeps_its_whole_records(
    stored: tuple[Path, np.ndarray[Any, Any]],
) -> None:
    path, lines = stored
    data = path.read_bytes()
    first = data.index(b"\n") + 1
    ends = [first + HEAD.size * k + 8 * 3 * n for k, n in ((0, 0), (1, 1), (2, 3), (3, 6))]
    assert ends[-1] == len(data)
    for cut in range(len(data) + 1):
        sound = sum(end <= cut for end in ends[1:])
        kept = lines[: (0, 1, 3, 6)[sound]]
        # the file may have grown before its content arrived
        for tail in (b"", bytes(40)) if cut in ends else (b"",):
            path.write_bytes(data[:cut] + tail)
            store = Store(path, OWNER, 3)
            assert np.array_equal(store.lines, kept)
            store.append(lines[:2])
            store.append(lines[:1])
            after = np.concatenate([kept, lines[:2], lines[:1]])
            assert np.array_equal(Store(path, OWNER, 3).lines, after)
    assert [p.name for p in path.parent.iterdir()] == [path.name]


def test_no_changed_byte_goes_unseen(stored: tuple[Path, np.ndarray[Any, Any]]) -> None:
    path, _ = stored
    data = path.read_bytes()
    for place in range(len(data)):
        changed = bytearray(data)
        changed[place] ^= 0x55
        path.write_bytes(changed)
        with pytest.raises(ValueError, match=r"^resume = .*(damaged|not a file|another chart)"):
            Store(path, OWNER, 3)
        assert path.read_bytes() == changed


def test_damage_says_what_can_be_kept(stored: tuple[Path, np.ndarray[Any, Any]]) -> None:
    path, lines = stored
    data = bytearray(path.read_bytes())
    data[-1] ^= 1
    path.write_bytes(data)
    with pytest.raises(ValueError, match=r"damaged at byte \d+; cut there, it holds 3 sound") as e:
        Store(path, OWNER, 3)
    with path.open("r+b") as file:
        file.truncate(int(str(e.value).split("at byte ")[1].split(";")[0]))
    assert np.array_equal(Store(path, OWNER, 3).lines, lines[:3])


def test_a_full_disk_leaves_it_as_it_was(stored: tuple[Path, np.ndarray[Any, Any]]) -> None:
    path, lines = stored
    store = Store(path, OWNER, 3)
    before = path.read_bytes()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    # room for the beginning of a record
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) + 30, limits[1]))
    try:
        with pytest.raises(ValueError, match="cannot be written"):
            store.append(lines)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert path.read_bytes() == before


def test_a_file_that_is_taken_away_is_not_begun_again(
    stored: tuple[Path, np.ndarray[Any, Any]],
) -> None:
    path, lines = stored
    store = Store(path, OWNER, 3)
    path.unlink()
    with pytest.raises(ValueError, match="cannot be written"):
        store.append(lines)
    assert not path.exists()


# ---- whose -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"beam": UniformBeam(T0=20.0, K_theta=0.6, xi_G=0.5)}, "fixed = "),
        ({"axes": [AXES[0], ("gamma", 0.0, 0.2, 21)]}, "axes = "),
        ({"forcing": {"eta": 0.01}}, "fixed = "),
        ({"route": "hill"}, "route = floquet there, hill here"),
    ],
)
def test_another_chart_is_refused(change: dict[str, Any], says: str, tmp_path: Path) -> None:
    path = tmp_path / "chart.nodes"
    held(path)
    before = path.read_bytes()
    wanted: dict[str, Any] = {"beam": BEAM, "axes": AXES, "route": "floquet"} | change
    with pytest.raises(ValueError, match="holds the nodes of another chart") as error:
        chart(wanted.pop("beam"), wanted.pop("axes"), resume=path, **wanted)
    assert says in str(error.value)
    assert "\n" not in str(error.value)
    assert path.read_bytes() == before


def test_a_finer_picture_is_the_same_chart(tmp_path: Path) -> None:
    path = tmp_path / "chart.nodes"
    first = chart(BEAM, AXES, route="floquet", resume=path)
    finer = [(name, low, high, 3 * count) for name, low, high, count in AXES]
    again = chart(BEAM, finer, route="floquet", resume=path, workers=never)
    assert again.resumed == first.nodes


def test_nodes_of_other_numerics_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "chart.nodes"
    held(path)
    shutil.copytree(Path(nodes.__file__).parents[2] / "hill", tmp_path / "hill")
    shutil.copytree(Path(nodes.__file__).parents[2] / "floquet", tmp_path / "floquet")
    monkeypatch.setattr(identity, "files", lambda package: tmp_path / package)
    compute = identity.source_fingerprint.__wrapped__
    assert compute() == identity.source_fingerprint()
    source = tmp_path / "hill" / "determinant" / "finite.py"
    source.write_text(source.read_text() + "\nX = 1\n")
    assert compute() != identity.source_fingerprint()
    monkeypatch.setattr(nodes, "source_fingerprint", compute)
    with pytest.raises(ValueError, match=r"another chart \(source = "):
        held(path)


@pytest.mark.parametrize("content", [b"PK\x03\x04", b"{}\n", b"[1]\n", b"some\ntext\n", bytes(99)])
def test_a_foreign_file_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "chart.nodes"
    path.write_bytes(content)
    with pytest.raises(ValueError, match="is not a file of finished nodes"):
        held(path)
    assert path.read_bytes() == content


def test_a_place_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "nowhere" / "chart.nodes", Path("/dev/null")):
        with pytest.raises(ValueError, match=r"^resume = "):
            held(path)


@pytest.mark.parametrize(
    ("workers", "says"),
    [
        (lambda function, jobs: [function], "returned a function that is no job's result"),
        (lambda function, jobs: [function(jobs[0])] * 2, "returned a tuple"),
        (lambda function, jobs: [], "left 1 jobs without a result"),
    ],
)
def test_a_map_that_is_none_is_refused(workers: Any, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        chart(BEAM, AXES, route="floquet", workers=workers)


def test_two_processes_do_not_share_a_file(tmp_path: Path) -> None:
    script = (
        "import sys; from pathlib import Path; from compare.charts.store import Store; "
        "s = Store(Path(sys.argv[1]), {'of': 'me'}, 3); print('mine', flush=True); input()"
    )
    words = [sys.executable, "-c", script, str(tmp_path / "nodes")]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as first:
        assert first.stdout is not None
        assert first.stdout.readline() == "mine\n"
        second = subprocess.run(words, input="\n", capture_output=True, text=True, check=False)
        first.communicate("\n")
    assert "in use by another process" in second.stderr
    third = subprocess.run(words, input="\n", capture_output=True, text=True, check=False)
    assert third.stdout == "mine\n"
