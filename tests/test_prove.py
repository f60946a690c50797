"""`verify prove`: what is proven of rows and files, and what is not said to be."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

import floquet
from compare import crosscheck, proofs
from compare.__main__ import main
from compare.commands import prove as command
from compare.console import as_file
from compare.report.proofs import RowProof, printed_interval, prove_row
from compare.report.tables import all_rows, corrected
from hill import HillEquation, MatrixSystem

ROWS = {row.id: row for row in all_rows()}

MINE = """\
kind = "matrices"
title = "a pair"
[system]
F = [[2.0, -1.0], [-1.0, 2.0]]
G = [[1.0, 0.0], [0.0, 1.0]]
[forcing]
Omega = 2.0
gamma = 0.15
"""

DAMPED = """\
kind = "matrices"
[system]
K.mean = [[2.0, -1.0], [-1.0, 2.0]]
K.cos.1 = [[0.1, 0.0], [0.0, 0.1]]
C = [[0.2, 0.1], [-0.1, 0.1]]
[forcing]
Omega = 2.3
"""


def test_rows_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "T2-27", "T1-14", "--interval", "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    summary, (first, second) = content["summary"], content["rows"]
    assert (first["id"], second["id"]) == ("T1-14", "T2-27")
    assert summary["proven"] == summary["rows"] == summary["routes_meet"] == 2
    assert summary["wrong_in_print"] == ["T1-14", "T2-27"]
    assert summary["wrong_for_every_Omega"] == ["T2-27"]
    assert summary["depends_on_Omega"] == ["T1-14"]
    assert second["interval"]["verdict"] == second["verdict"] == "unstable"
    assert second["verdict_printed"] == "stable"
    for route in ("hill", "floquet"):
        ball = re.fullmatch(r"\[(0\.\d+) \+/- (\S+)\]", second[route]["T"])
        assert ball
        # the error is that of four printed digits: `verify` says .00270
        assert abs(float(ball[1]) - 0.0027) < 5e-6
        assert float(ball[2]) < 1e-20


def test_the_table_is_no_wider_than_a_terminal() -> None:
    rows = tuple(prove_row(ROWS[name], interval=True) for name in ("T1-14", "T2-27"))
    lines = as_file(lambda console: command.print_rows(rows, console), 80).splitlines()
    # the table, a line under its heads, and the two rows
    assert max(len(line.rstrip()) for line in lines[:4]) <= 80
    assert re.match(r"T1-14 .* -> STABLE +both, 44% stable", lines[2])
    assert re.match(r"T2-27 .* yes +-> UNSTABLE +-> UNSTABLE", lines[3])


@pytest.mark.parametrize(("text", "verdict"), [(MINE, "unstable"), (DAMPED, "stable")])
def test_a_file(text: str, verdict: str, tmp_path: Path, capsys: Any) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(text)
    words = [] if "gamma" in text else ["--set", "gamma=0.0"]
    assert main(["prove", str(file), *words]) == 0
    out = capsys.readouterr().out
    assert f"{verdict}, proven" in out
    assert "floats" in out
    # what has no z is for the time domain alone, and that is said
    assert ("the routes' balls meet" in out) == (text == MINE)


def test_what_is_not_proven_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "edge.toml"
    file.write_text(MINE.replace("gamma = 0.15", "gamma = 0.0"))
    assert main(["prove", str(file)]) == 1
    out = capsys.readouterr().out
    assert out.rstrip().endswith("undecided")
    assert "T is 0 within its ball" in out


def test_routes_that_do_not_meet_prove_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    e = HillEquation([[2.0]], [[1.0]], 0.3, 1.3)
    other = HillEquation([[2.0 + 1e-12]], [[1.0]], 0.3, 1.3)
    assert proofs.prove(e, {}).verdict == "stable"
    real = proofs.floquet.enclose
    monkeypatch.setattr(proofs.floquet, "enclose", lambda what, **given: real(other, **given))
    wrong = proofs.prove(e, {})
    assert not wrong.meet
    assert wrong.verdict == "undecided"
    assert "do not meet" in wrong.reason
    row = RowProof(ROWS["T2-41"], wrong, "stable", None)
    assert not row.proven


def test_what_verify_shows_must_be_what_is_proven() -> None:
    row = prove_row(ROWS["T2-41"])
    assert row.proven
    assert not RowProof(row.row, row.proof, "unstable", None).proven
    assert not RowProof(row.row, row.proof, "undecided", None).proven


def test_the_interval_holds_what_was_run() -> None:
    """But for rows whose Omega is a misprint, or only names the resonance."""
    outside = set()
    for row in all_rows():
        low, high = printed_interval(row)
        assert float(high - low) == pytest.approx(0.001)
        if not low <= row.Omega <= high:
            outside.add(row.id)
        assert low < float(corrected(row).Omega_printed) < high
    assert outside == set()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["T9-99"], "T9-99"),
        (["a.toml", "T1-01"], "must stand alone"),
        (["a.toml", "--interval"], "--interval: is for printed rows"),
        (["T1-01", "--set", "Omega=2"], "--set Omega=2: is for a file's system"),
    ],
)
def test_refusals(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", *words]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1


def test_without_the_extra(capsys: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("floquet.enclosure.find_spec", lambda name: None)
    assert main(["prove", "T1-01"]) == 2
    assert "pip install 'floquet-crosscheck[proof]'" in capsys.readouterr().err


# ---- precision = "proof" -------------------------------------------------------------------------


def edge() -> tuple[HillEquation, float]:
    """Mathieu's equation within a few ulps of the tongue at 2 w, and on which side it is."""
    gamma, low, high = 0.3, 1.0, 1.2
    equation = lambda F: HillEquation([[F]], [[1.0]], gamma, 2.0)  # noqa: E731
    for _ in range(60):
        F = 0.5 * (low + high)
        inside = floquet.enclose(equation(F)).verdict == "unstable"
        low, high = (F, high) if inside else (low, F)
    return equation(high), high - low


def test_proof_settles_what_double_precision_leaves_open() -> None:
    e, width = edge()
    assert width < 1e-15
    assert crosscheck(e).verdict == "undecided"
    settled = crosscheck(e, precision="proof")
    assert settled.proof is not None
    assert settled.verdict == settled.proof.verdict == "stable"
    assert settled.routes_agree
    assert settled.remark != crosscheck(e).remark


def test_proof_of_a_system_and_of_a_beam() -> None:
    pair = MatrixSystem([[2, -1], [-1, 2]], [[1, 0], [0, 1]])
    x = crosscheck(pair, Omega=2.0, gamma=0.15, precision="proof")
    assert x.verdict == "unstable"
    assert x.proof is not None
    assert not x.proof.decimals
    beam = ROWS["T2-27"].beam(2)
    y = crosscheck(beam, Omega=ROWS["T2-27"].Omega, gamma=0.1, precision="proof")
    assert y.verdict == "unstable"
    assert y.proof is not None
    assert y.proof.decimals


def test_an_unknown_precision_is_refused() -> None:
    with pytest.raises(ValueError, match='must be "double" or "proof"'):
        crosscheck(edge()[0], precision="quadruple")  # type: ignore[arg-type]
