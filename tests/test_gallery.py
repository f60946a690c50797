"""The gallery runs, cell by cell, prints what it says, and shows what a notebook would show."""

import ast
import inspect
import re
from pathlib import Path
from typing import Any

import pytest
from pages_html import Parsed

from compare import CrossCheck
from compare.charts.result import Chart
from compare.verification import Report
from floquet import Monodromy
from hill import Characteristic

FOLDER = Path(__file__).parents[1] / "examples" / "gallery"
SCRIPTS = sorted(FOLDER.glob("*.py"))


def cells(text: str) -> list[tuple[int, str]]:
    """Cells of code, each with the number of the line before it."""
    parts = re.split(r"^(# %%.*)\n", text, flags=re.M)
    found, line = [], parts[0].count("\n")
    for mark, body in zip(parts[1::2], parts[2::2], strict=True):
        line += 1
        if "[markdown]" in mark:
            assert all(row[:1] in ("", "#") for row in body.splitlines())
        else:
            found.append((line, body))
        line += body.count("\n")
    return found


def test_there_is_a_gallery() -> None:
    assert [script.stem for script in SCRIPTS] == ["my_own_vehicle", "report_in_ten_minutes"]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_it_runs_and_prints_what_it_says(script: Path) -> None:
    text = script.read_text(encoding="utf-8")
    lines = text.splitlines()
    expected = {
        number: line.split("  # ")[1]
        for number, line in enumerate(lines, start=1)
        if line.strip().startswith("print(") and "  # " in line
    }
    seen, printed, shown = set(), [], []

    def told(*words: Any) -> None:
        frame = inspect.currentframe()
        assert frame is not None
        assert frame.f_back is not None
        number = frame.f_back.f_lineno
        printed.append(" ".join(map(str, words)))
        if number in expected:
            assert printed[-1] == expected[number], lines[number - 1]
            seen.add(number)

    names: dict[str, Any] = {"__name__": "__main__", "print": told}
    for before, body in cells(text):
        tree = ast.increment_lineno(ast.parse(body), before)
        last = tree.body[-1]
        result = None
        if isinstance(last, ast.Expr) and not isinstance(last.value, ast.Call):
            tree.body.pop()
            result = ast.Expression(last.value)
        exec(compile(tree, str(script), "exec"), names)
        if result is not None:
            shown.append(eval(compile(result, str(script), "eval"), names))
    assert seen == set(expected)
    assert len(seen) >= 5
    assert shown
    for value in shown:
        assert isinstance(value, Characteristic | Monodromy | CrossCheck | Chart | Report)
        assert Parsed(value._repr_html_()).root.children
