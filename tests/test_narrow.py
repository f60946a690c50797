"""What the commands print on a terminal of 80 columns, and of titles with brackets."""

import io
from pathlib import Path

import pytest
from rich.console import Console

import compare.commands.chart as chart_command
import compare.commands.simulate as simulate_command
import compare.commands.system as system_command
import compare.commands.vehicle as vehicle_command
from compare.__main__ import COMMANDS, main
from compare.console import as_file, bare_table, say, show

WIDTH = 80
VEHICLE = str(Path(__file__).parent.parent / "examples" / "uniform.toml")
FILE = """
kind = "matrices"
title = "[bold]mine[/x] :smile:"
[system]
F = [[2.0, -1.0], [-1.0, 2.0]]
G = [[1.0, 0.0], [0.0, 1.0]]
frequency_names = ["[/a]", "b:b:"]
[forcing]
gamma = 0.15
Omega = 2.0
"""


@pytest.fixture
def narrow(monkeypatch: pytest.MonkeyPatch) -> io.StringIO:
    """What a terminal of 80 columns is given."""
    written = io.StringIO()
    for command in (chart_command, simulate_command, system_command, vehicle_command):
        console = Console(
            file=written,
            width=WIDTH,
            force_terminal=True,
            color_system=None,
            markup=False,
            emoji=False,
        )
        monkeypatch.setattr(command, "terminal", lambda console=console: console)
    return written


@pytest.mark.parametrize("command", ["rows", *COMMANDS])
def test_help_fits(
    command: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(WIDTH))
    with pytest.raises(SystemExit):
        main([*([] if command == "rows" else [command]), "--help"])
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) > 20
    assert [line for line in lines if len(line) > WIDTH] == []


CASES = {
    "vehicle": (["vehicle", VEHICLE, "--both", "0"], "(omega_(1) + omega_(B))/2 "),
    "chart": (
        [
            "chart",
            "{file}",
            "--x",
            "Omega",
            "1.6",
            "2.4",
            "40",
            "--y",
            "gamma",
            "0.1",
            "0.3",
            "20",
            "--tongues",
            "{folder}/t.csv",
        ],
        "2 omega_([/a]) ",
    ),
    "simulate": (["simulate", "{file}"], "50% q1, 50% q2"),
    "system": (["system", "{file}"], "omega_([/a]) = 1, omega_(b:b:) = 1.732051"),
}


@pytest.mark.parametrize("name", list(CASES))
def test_everything_fits(name: str, narrow: io.StringIO, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(FILE)
    words, says = CASES[name]
    assert main([word.format(file=file, folder=tmp_path) for word in words]) == 0
    lines = narrow.getvalue().splitlines()
    assert [line for line in lines if len(line.rstrip()) > WIDTH] == []
    assert not any("\N{HORIZONTAL ELLIPSIS}" in line for line in lines)
    assert any(says in line for line in lines)


def test_a_title_is_what_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(FILE)
    for words in (["system", str(file)], ["sensitivity", str(file)]):
        assert main(words) == 0
        assert "[bold]mine[/x] :smile:" in capsys.readouterr().out


def test_lines_are_whole_where_there_is_no_terminal() -> None:
    line = "word " * 40
    written = as_file(lambda console: say(console, line, whole=True), 80)
    assert written.count("\n") == 1
    assert as_file(lambda console: say(console, line), 80).count("\n") == 3


def test_a_table_that_is_too_wide_has_its_columns_nearer() -> None:
    def table(console: Console) -> None:
        made = bare_table(gap=2)
        for _ in range(3):
            made.add_column("four", no_wrap=True)
        made.add_row(*["1234"] * 3)
        show(console, made)

    assert as_file(table, 18).splitlines()[0].rstrip() == "four   four   four"
    assert as_file(table, 17).splitlines()[0].rstrip() == "four four four"
