"""The `verify` command: output, exit status, refusals."""

import json
import os
import stat
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from commands import csv_lines, refusal
from rich.console import Console

import compare.commands.rows as rows_command
from compare import verification_text as render
from compare import verify
from compare.__main__ import main
from compare.publications.kincaid import PUBLICATION
from compare.report.row import Outcome
from compare.verification import Report

ONE = ["--row", "T1-12"]


@pytest.fixture(scope="module")
def report() -> Report:
    return verify(rows=["T1-07", "T1-12", "T3-02"])


def test_json_has_the_contract_s_names(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--row", "T1-12", "--row", "T3-02", "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert set(content) == {"summary", "rows"}
    assert [row["id"] for row in content["rows"]] == ["T1-12", "T3-02a", "T3-02b"]
    row = content["rows"][0]
    names = {"id", "table", "Omega_printed", "Omega", "printed", "as_run", "hill", "floquet"}
    names |= {"routes_agree", "cause", "verdict_printed", "verdict", "note"}
    assert names <= set(row)
    assert {"T", "z"} <= set(row["printed"])
    assert {"T", "z"} <= set(row["as_run"])
    for route in ("hill", "floquet"):
        assert {"T", "z", "error"} <= set(row[route])
    assert row["printed"]["z"][0] == [0.46111, -0.08649]
    assert "initial_conditions" not in row
    assert [row["initial_conditions"] for row in content["rows"][1:]] == [False, True]


def test_csv_keeps_every_digit(report: Report) -> None:
    _, lines = csv_lines(render.as_csv(report))
    assert [line["id"] for line in lines] == ["T1-07", "T1-12", "T3-02a", "T3-02b"]
    assert float(lines[1]["hill_T"]) == report.outcomes[1].hill.T


def test_show_selects(report: Report) -> None:
    assert {o.row.id for o in render.shown(report, "flips")} == {"T1-07", "T3-02b"}
    assert render.shown(report, "fail") == ()
    assert len(render.shown(report, "all")) == 4


def test_a_flipped_verdict_is_loud(report: Report) -> None:
    assert "**-> STABLE**" in render.markdown(report)


@pytest.mark.parametrize("width", [80, 100, 140])
def test_text_fits_the_terminal(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(rows_command, "terminal", lambda: Console(width=width))
    assert main(["--row", "T1-27", "--row", "T1-07"]) == 0
    lines = capsys.readouterr().out.splitlines()
    table = [line for line in lines if line.startswith(("row", "T1-"))]
    assert len(table) == 3
    assert all(len(line) <= width for line in table)
    assert not any("\N{HORIZONTAL ELLIPSIS}" in line for line in table)
    assert "\x1b" not in "".join(lines)


def broken(outcome: Outcome, **changes: object) -> Report:
    return Report((replace(outcome, **changes),), PUBLICATION)


def test_exit_status_1_where_the_routes_disagree(
    report: Report, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = broken(report.outcomes[1], routes_agree=False)
    monkeypatch.setattr(rows_command, "verify", lambda *_, **__: wrong)
    assert main(ONE) == 1
    assert "agree on 0 of 1" in capsys.readouterr().out


def test_exit_status_1_where_an_explanation_is_lost(
    report: Report, monkeypatch: pytest.MonkeyPatch
) -> None:
    lost = broken(report.outcomes[1], cause="unexplained", expected=False)
    monkeypatch.setattr(rows_command, "verify", lambda *_, **__: lost)
    assert main(ONE) == 1


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--table", "4"], "table = 4"),
        (["--row", "T9-99"], "row = 'T9-99'"),
        (["--table", "2", "--row", "T1-01"], "row = 'T1-01'"),
        (["--modes", "0", *ONE], "modes = 0"),
        (["--modes", "-2", *ONE], "modes = -2"),
        (["--workers", "0", *ONE], "workers = 0"),
        (["--output", "nowhere/at/all.md", *ONE], "nowhere/at/all.md"),
        (["--output", ".", *ONE], "is a directory"),
    ],
    ids=lambda value: value if isinstance(value, str) else None,
)
def test_bad_input_is_one_line(
    words: list[str],
    says: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    line = refusal(words, capsys)
    assert line.startswith("verify: ")
    assert says in line


@pytest.mark.parametrize(
    "words", [["--show", "some"], ["--method", "euler"], ["--table", "one"], ["--nothing"]]
)
def test_bad_usage_exits_with_2(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(words)
    assert stop.value.code == 2
    assert "Traceback" not in capsys.readouterr().err


def test_output_is_written_whole_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "rows.json"
    target.write_text("before")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fail)
    assert main([*ONE, "--output", str(target)]) == 2
    assert "no space left" in capsys.readouterr().err
    assert target.read_text() == "before"
    assert os.listdir(tmp_path) == ["rows.json"]
    monkeypatch.undo()
    assert main([*ONE, "--output", str(target)]) == 0
    assert json.loads(target.read_text())["rows"][0]["id"] == "T1-12"
    mask = os.umask(0)
    os.umask(mask)
    assert stat.S_IMODE(target.stat().st_mode) == 0o666 & ~mask


def test_modes_change_the_routes_and_not_the_cause() -> None:
    two, four = (verify(rows=["T2-38"], modes=n).outcomes[0] for n in (2, 4))
    assert four.cause == two.cause
    assert four.routes_agree
    assert len(four.hill.z) == 5
    assert four.hill.T != two.hill.T


def test_cvodes_agrees_too() -> None:
    outcome = verify(rows=["T1-12"], method="cvodes").outcomes[0]
    assert outcome.routes_agree
    # a second witness with an error of its own: looser than Taylor's 3e-14, not equal to it
    assert outcome.floquet.error > 1e-13


def test_workers_keep_the_order_and_the_numbers() -> None:
    names = ["T1-12", "T1-30", "T2-01", "T3-04"]
    serial = verify(rows=names)
    for workers in (2, lambda f, rows: [f(row) for row in rows]):
        parallel = verify(rows=names, workers=workers)
        assert [o.row.id for o in parallel.outcomes] == [o.row.id for o in serial.outcomes]
        for one, other in zip(serial.outcomes, parallel.outcomes, strict=True):
            assert abs(one.hill.T - other.hill.T) <= one.hill.T_error + other.hill.T_error


def test_python_m_compare_is_the_same_and_a_closed_pipe_is_no_error() -> None:
    line = f"{sys.executable} -m compare --row T1-12 --format csv | head -n 1"
    done = subprocess.run(
        ["bash", "-c", f"set -o pipefail; {line}"], capture_output=True, text=True
    )
    assert done.stdout.startswith('# {"schema": 1, "made_by": "floquet-crosscheck ')
    assert done.stderr == ""


def test_the_tables_import_no_other_command() -> None:
    script = (
        "import sys; from compare.__main__ import main; main(['--row', 'T1-12']); "
        "print(*(set(sys.modules) & {'compare.commands.chart', 'compare.chart_picture', "
        "'matplotlib', 'distributed', 'scipy.ndimage', 'scipy.interpolate'}), file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stderr.strip() == ""
    assert "T1-12" in done.stdout
