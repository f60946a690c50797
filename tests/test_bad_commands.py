"""Every wrong command ends with status 2, one line that names what is wrong, and nothing left."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from bad_commands import COMMANDS, files

from compare.__main__ import main


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
