"""Every wrong command ends with status 2, one line that names what is wrong, and nothing left."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from bad_commands import COMMANDS, files

from compare.__main__ import main
from compare.commands import rows
from compare.commands.terminal import progress


def test_there_are_enough() -> None:
    assert len(COMMANDS) >= 340


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    files(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", COMMANDS)
def test_one_line(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words, named = COMMANDS[name]
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*")}
    try:
        status = main(words)
    except SystemExit as end:  # argparse
        status = end.code if isinstance(end.code, int) else 1
    told = capsys.readouterr()
    assert status == 2
    assert "Traceback" not in told.err
    assert told.out == ""
    lines = told.err.rstrip("\n").splitlines()
    # argparse shows the usage before its line
    own = lines if not lines[0].startswith("usage:") else lines[-1:]
    assert len(own) == 1
    assert own[0].startswith("verify")
    assert named in own[0]
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*")} == before


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


def test_a_link_is_followed_and_a_device_written_to(folder: Path) -> None:
    (folder / "link.json").symlink_to(folder / "target.json")
    assert main(["--row", "T1-01", "--format", "json", "--output", "link.json"]) == 0
    assert (folder / "link.json").is_symlink()
    assert (folder / "target.json").read_text().startswith("{")
    assert main(["--row", "T1-01", "--output", os.devnull]) == 0
    assert not Path(os.devnull).is_file()


def test_version_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("floquet-crosscheck ")
    with pytest.raises(SystemExit) as end:
        main(["help", "chart"])
    assert end.value.code == 0
    assert "--tongues" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["--help"])
    assert "verify system" in capsys.readouterr().out
