"""What docs/simulation.md says runs, and prints what it says."""

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

from compare.__main__ import main

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "simulation.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, flags=re.M | re.S)


def test_python_prints_what_it_says() -> None:
    (block,) = blocks("python")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(block, "simulation.md", "exec"), {})
    said = re.findall(r"^print\(.*\)  # (.*)$", block, flags=re.M)
    assert len(said) == 6
    assert printed.getvalue().splitlines() == said


@pytest.mark.parametrize("line", [line for block in blocks("sh") for line in block.splitlines()])
def test_commands_run(line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    words = shlex.split(line)
    assert words[:2] == ["verify", "simulate"]
    assert main(words[1:]) == 0
    if "--output" in words:
        assert (tmp_path / words[words.index("--output") + 1]).stat().st_size > 10_000


def test_its_picture_is_of_that_row_and_not_too_large() -> None:
    (name,) = re.findall(r"\]\((\S+\.svg)\)", PAGE)
    content = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert "&quot;row&quot;: &quot;T1-12&quot;" in content or '"row": "T1-12"' in content
    assert len(content) < 200_000


@pytest.mark.parametrize("place", re.findall(r"`(tests/\w+\.py)`", PAGE))
def test_the_tests_that_it_names_are_there(place: str) -> None:
    assert (ROOT / place).is_file()
