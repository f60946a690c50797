"""What every command owes: to bad input status 2 and one line; of a CSV file its lines."""

import csv
import io
import json
from collections.abc import Sequence
from typing import Any

import pytest

from compare.__main__ import main


def refusal(words: Sequence[str], capsys: pytest.CaptureFixture[str]) -> str:
    """The line with which the command refuses its words."""
    assert main(words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err


def csv_lines(text: str) -> tuple[dict[str, Any], list[dict[str, str]]]:
    """The record behind "# " at the top of a CSV file, and its lines."""
    first, _, rest = text.partition("\n")
    assert first.startswith("# ")
    return json.loads(first[2:]), list(csv.DictReader(io.StringIO(rest)))
