"""What every command owes to bad input: status 2 and one line on the standard error."""

from collections.abc import Sequence

import pytest

from compare.__main__ import main


def refusal(words: Sequence[str], capsys: pytest.CaptureFixture[str]) -> str:
    """The line with which the command refuses its words."""
    assert main(words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err
