"""The README's code runs, and its table is the tool's."""

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

from compare.__main__ import main

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, flags=re.M | re.S)


def test_python_blocks_run_and_print_what_they_say() -> None:
    namespace: dict[str, object] = {}
    for block in blocks("python"):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(block, "README.md", "exec"), namespace)
        lines = printed.getvalue().splitlines()
        calls = [line for line in block.splitlines() if line.startswith("print(")]
        assert len(lines) == len(calls)
        for call, line in zip(calls, lines, strict=True):
            if "  # " in call:
                assert line == call.split("  # ")[1]


COMMANDS = [
    line for block in blocks("sh") for line in block.splitlines() if line.startswith("verify")
]


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_run(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = shlex.split(line)[1:]
    assert main(words) == 0
    written = [word for word in words if word.endswith((".md", ".json"))]
    assert all((tmp_path / name).stat().st_size > 0 for name in written)
    assert capsys.readouterr().out or written


def test_fresh_machine_has_two_lines_that_install_this_project() -> None:
    section = README.split("## On a fresh machine")[1].split("\n## ")[0]
    lines = re.findall(r"^```sh\n(.*)\n```$", section, flags=re.M)
    assert len(lines) == 2
    for line in lines:
        assert "python3 -m venv" in line
        assert "pip install" in line


def without_noise(table: str) -> list[list[str]]:
    """Cells of a Markdown table, but for the three columns made of rounding errors.

    The bound, the last of them, is measured by rounding too: 4.5e-13 for T1-07, and one digit of it
    is 4 on one processor and 5 on the next.
    """
    rows = [re.split(r"(?<!\\)\|", line)[1:-1] for line in table.splitlines() if line[:1] == "|"]
    return [[cell.strip() for cell in row[:7] + row[10:]] for row in rows]


def bounds(table: str) -> list[float]:
    """The column of the bounds on P."""
    rows = [re.split(r"(?<!\\)\|", line)[1:-1] for line in table.splitlines() if line[:3] == "| T"]
    return [float(row[9]) for row in rows]


def test_headline_table_is_the_tools_own(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--show", "flips", "--format", "md"]) == 0
    printed = capsys.readouterr().out
    section = README.split("## What it found")[1].split("\n## ")[0]
    assert without_noise(section) == without_noise(printed)
    assert len(without_noise(section)) > 5
    assert bounds(section) == pytest.approx(bounds(printed), rel=0.5)
    first = next(line for line in printed.splitlines() if "printed values" in line)
    assert first in section
