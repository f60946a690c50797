"""Every wrong command ends with status 2, one line that names what is wrong, and nothing left."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from benchmarks.bad_commands import COMMANDS, files
from benchmarks.bad_commands.judge import Told, contents, faults
from compare.__main__ import main
from compare.commands import rows
from compare.commands.terminal import progress


def test_there_are_enough() -> None:
    assert len(COMMANDS) >= 700


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, dict[Path, int]]]:
    """The files, made once: nothing may change them. Modules among them are forgotten."""
    made = tmp_path_factory.mktemp("bad")
    files(made)
    known, path = set(sys.modules), list(sys.path)
    yield made, contents(made)
    sys.path[:] = path
    for name in set(sys.modules) - known:
        if str(made) in (getattr(sys.modules[name], "__file__", None) or ""):
            del sys.modules[name]


@pytest.fixture
def folder(written: tuple[Path, dict[Path, int]], monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(written[0])
    return written[0]


# `python -m benchmarks.bad_commands` tries all, each with its time; here a third of each kind.
@pytest.mark.parametrize("name", list(COMMANDS)[::3])
def test_one_line(
    name: str,
    written: tuple[Path, dict[Path, int]],
    folder: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    words, named = COMMANDS[name]
    try:
        status = main(words)
    except SystemExit as end:  # argparse
        status = end.code if isinstance(end.code, int) else 1
    assert faults(Told(status, *capsys.readouterr()), named) == []
    assert contents(folder) == written[1]


@pytest.mark.parametrize(
    ("status", "out", "err", "named", "fault"),
    [
        (2, "", "verify: T0 = x: must be a number\n", "T0", ""),
        (2, "", "usage: verify\n  [-h]\nverify: error: T0\n", "T0", ""),
        (1, "", "verify: T0\n", "T0", "status 1"),
        (-1, "", "verify: T0\n", "T0", "does not end"),
        (2, "3.0\n", "verify: T0\n", "T0", "standard output"),
        (2, "", "verify: T0\nverify: again\n", "T0", "2 lines"),
        (2, "", "", "", "0 lines"),
        (2, "", "T0\n", "T0", "who speaks"),
        (2, "", "verify: gamma\n", "T0", "does not name"),
        (2, "", "x.py:3: RuntimeWarning: overflow\n", "", "warning"),
        (2, "", "Traceback (most recent call last):\n", "", "exception"),
    ],
)
def test_each_fault_is_found(status: int, out: str, err: str, named: str, fault: str) -> None:
    found = "; ".join(faults(Told(status, out, err), named))
    assert fault in found
    assert bool(fault) == bool(found)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
def test_the_trial_finds_what_does_not_end(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A right command and one that hangs are not as a wrong one should be."""
    from benchmarks.bad_commands import run as trial

    def hang(_words: list[str]) -> int:
        time.sleep(60.0)
        return 2

    monkeypatch.chdir(".")
    assert trial.main(["--only", "table 'x'"]) == 0
    assert "1 wrong commands, 0 not as they should be" in capsys.readouterr().out
    monkeypatch.setattr(trial, "GIVEN_UP", 0.2)
    monkeypatch.setattr(trial, "verify", hang)
    assert trial.main(["--only", "table 'x'"]) == 1
    assert "does not end" in capsys.readouterr().out


def run(words: str, *, shell: str = "", folder: Path) -> subprocess.CompletedProcess[str]:
    """The command as a shell has it."""
    line = f"set -o pipefail; {sys.executable} -m compare {words} {shell}"
    return subprocess.run(
        ["bash", "-c", line], capture_output=True, text=True, cwd=folder, timeout=60, check=False
    )


needs_a_shell = pytest.mark.skipif(os.name != "posix", reason="a POSIX shell")


@needs_a_shell
@pytest.mark.parametrize(
    ("words", "shell", "status"),
    [
        ("chart --x Omega 1 2", "", 2),
        ("--row T1-01", "> /dev/full", 2),
        ("help chart", "> /dev/full", 2),
        ("--row T1-01 --format json", ">&-", 2),
        # a reader that is gone by the time there is something to read
        ("--row T1-01 --format json", "| true", 141),
        ("--row T1-01", "| true", 141),
    ],
)
def test_pipes(words: str, shell: str, status: int, tmp_path: Path) -> None:
    found = run(words, shell=shell, folder=tmp_path)
    assert found.returncode == status
    assert "Traceback" not in found.stderr
    assert "Exception ignored" not in found.stderr


@needs_a_shell
def test_an_interrupt_is_one_line(tmp_path: Path) -> None:
    """At any moment, imports included."""
    for delay in (0.25, 0.5, 1.0):
        process = subprocess.Popen(
            [sys.executable, "-m", "compare", "claims"],
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
            cwd=tmp_path,
        )
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(delay)
        process.send_signal(2)
        _, told = process.communicate(timeout=30)
        assert process.returncode == 130
        assert told.strip() == "verify claims: interrupted"


@needs_a_shell
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda n: n.name)
@pytest.mark.parametrize("delay", [1.2, 3.0])
def test_workers_end_with_a_signal(tmp_path: Path, number: signal.Signals, delay: float) -> None:
    """While they are started, and at work: of half a minute of it nothing is waited for."""
    words = [sys.executable, "-m", "compare", "figures", "--workers", "2", "--output", "figures"]
    with subprocess.Popen(
        words, stderr=subprocess.PIPE, text=True, cwd=tmp_path, start_new_session=True
    ) as process:
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(delay)
        os.killpg(process.pid, number)
        _, told = process.communicate(timeout=10)
    assert process.returncode == 128 + number
    assert told == f"verify figures: {'interrupted' if number == 2 else 'terminated'}\n"
    assert not list(tmp_path.rglob(".unfinished*"))
    deadline = time.monotonic() + 5.0
    while alive(process.pid):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def alive(group: int) -> list[str]:
    """Processes of a group that have not ended."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            state, _, own = path.read_text().rpartition(")")[2].split()[:3]
            if int(own) == group and state not in "ZX":
                found.append(path.parent.name)
    return found


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda n: n.name)
@pytest.mark.parametrize("made_of_it", [KeyboardInterrupt, RuntimeError, None])
def test_a_signal_is_told_whatever_a_library_makes_of_it(
    number: int,
    made_of_it: type[BaseException] | None,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def run(_options: object) -> int:
        with suppress(KeyboardInterrupt):
            signal.raise_signal(number)
        if made_of_it is not None:
            raise made_of_it
        return 0

    before = signal.getsignal(number)
    monkeypatch.setattr(rows, "run", run)
    assert main(["--table", "1"]) == (128 + number if made_of_it is not KeyboardInterrupt else 130)
    told = capsys.readouterr().err
    assert told in ("verify: interrupted\n", "verify: terminated\n")
    assert signal.getsignal(number) is before


def test_the_cursor_is_back_wherever_a_signal_meets_the_bar(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from rich.live import Live

    def begun(refresh: Callable[..., None]) -> Callable[..., None]:
        def interrupted(*args: object, **keywords: object) -> None:
            monkeypatch.setattr(Live, "refresh", refresh)
            raise KeyboardInterrupt

        return interrupted

    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TTY_INTERACTIVE", "1")
    monkeypatch.setattr(Live, "refresh", begun(Live.refresh))
    with pytest.raises(KeyboardInterrupt), progress("bar", 3):
        pass
    told = capsys.readouterr().err
    assert told.rfind("\x1b[?25h") > told.rfind("\x1b[?25l") >= 0


def test_a_link_is_followed_and_a_device_written_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path
    monkeypatch.chdir(folder)
    (folder / "link.json").symlink_to(folder / "target.json")
    assert main(["--row", "T1-01", "--format", "json", "--output", "link.json"]) == 0
    assert (folder / "link.json").is_symlink()
    assert (folder / "target.json").read_text().startswith("{")
    assert main(["--row", "T1-01", "--output", os.devnull]) == 0
    assert not Path(os.devnull).is_file()


def test_version_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("floquet-crosscheck ")
    assert "\nmany points at once: " in said
    with pytest.raises(SystemExit) as end:
        main(["help", "chart"])
    assert end.value.code == 0
    assert "--tongues" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["--help"])
    assert "verify system" in capsys.readouterr().out
