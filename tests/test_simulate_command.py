"""`verify simulate`: what it tells of rows and files, what it writes, what it refuses."""

import csv
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from compare.console import as_file
from compare.report.row import witness
from compare.report.tables import rows as rows_of
from compare.simulation import picture as simulation_picture
from compare.simulation.followed import MANY, Subject, follow
from compare.simulation.picture import picture
from compare.simulation.text import show
from floquet import simulate
from hill import HillEquation, PeriodicEquation

EXAMPLES = Path(__file__).parents[1] / "examples"
ROWS = {row.id: row for table in (1, 2, 3) for row in rows_of(table)}
FILE = """
kind = "matrices"
title = "Two springs"
[system]
F = [[2.0, -1.0], [-1.0, 2.0]]
G = [[1.0, 0.0], [0.0, 1.0]]
[forcing]
gamma = 0.15
Omega = 2.0
"""


@pytest.fixture
def mine(tmp_path: Path) -> str:
    path = tmp_path / "mine.toml"
    path.write_text(FILE)
    return str(path)


def told(words: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["simulate", *words]) == 0
    return capsys.readouterr().out


def test_a_growing_row(capsys: pytest.CaptureFixture[str]) -> None:
    said = told(["--row", "T1-12"], capsys)
    assert "Row T1-12: the uniform beam at Omega = 1.100285, gamma = 0.1" in said
    T, measured = re.findall(r"Unstable: T = (\S+); measured over 40 periods (\S+)\.\n", said)[0]
    assert float(T) == pytest.approx(float(measured), abs=2e-6)
    assert "Begun in the fastest growing mode" in said
    assert "Print has T = .03404, unstable." in said
    assert re.search(r"0\.191795 +0\.5058 \+- 0\.9822i +1\.105 +99% rotation +1\.000", said)
    for name in ("bending 1", "bending 2", "rotation"):
        assert re.search(rf"^{name} ", said, flags=re.M)


@pytest.mark.parametrize(
    ("row", "verdict", "print_has"),
    [
        ("T1-07", "Stable: T = 0;", "as printed, 195 powers of ten"),
        ("T2-27", "Unstable: T = 0.002704;", "as printed, no growth"),
    ],
)
def test_a_row_whose_printed_verdict_is_wrong(
    row: str, verdict: str, print_has: str, capsys: pytest.CaptureFixture[str]
) -> None:
    said = " ".join(told(["--row", row], capsys).split())
    assert f"{verdict} measured over 2,000 periods" in said
    assert print_has in said
    grown = float(re.findall(r"excursion becomes (\S+) times what it was", said)[0])
    assert grown == pytest.approx(1.0, abs=0.05) if row == "T1-07" else grown > 1e3


def test_a_row_whose_motion_leaves_the_floats(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "far.png"
    said = told(["--row", "T3-01b", "--output", str(path)], capsys)
    assert re.search(r"Stopped after 49\d of 2000 periods: the motion exceeds what", said)
    assert path.stat().st_size > 20_000


def test_a_file_from_a_given_state_is_the_library_s_history(
    mine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "growth.csv"
    words = ["--q0", "0.1", "-0.2", "--v0", "0", "3e-2", "--periods", "12", "--samples", "9"]
    said = told([mine, *words, "--output", str(path)], capsys)
    assert "Begun in the given state; 109 samples" in said
    equation = HillEquation(F=[[2.0, -1.0], [-1.0, 2.0]], G=np.eye(2), gamma=0.15, Omega=2.0)
    s = simulate(equation, [0.1, -0.2], [0.0, 0.03], periods=12, samples=9)
    comment, rest = path.read_text().split("\n", 1)
    lines = list(csv.reader(io.StringIO(rest)))
    assert lines[0] == ["tau", "q1", "q2", "d_q1", "d_q2", "error"]
    table = np.array(lines[1:], float)
    assert table[:, 0] == pytest.approx(s.tau, rel=1e-11)
    assert table[:, 1:5] == pytest.approx(np.hstack([s.q, s.v]), rel=1e-11)
    assert table[:, 5] == pytest.approx(s.error, rel=0.05)
    about = json.loads(comment.removeprefix("# "))
    assert (about["began_in"], about["periods"], about["samples"]) == ("the given state", 12, 9)


def test_json_has_every_digit(mine: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = json.loads(told([mine, "--periods", "20", "--format", "json"], capsys))
    equation = HillEquation(F=[[2.0, -1.0], [-1.0, 2.0]], G=np.eye(2), gamma=0.15, Omega=2.0)
    q, v = (found[name][0] for name in ("q", "v"))
    s = simulate(equation, q, v, periods=20, samples=found["samples"])
    assert np.array_equal(s.q, found["q"])
    assert np.array_equal(s.v, found["v"])
    assert found["verdict"] == "unstable"
    assert found["T"] == pytest.approx(0.074951, abs=1e-6)
    assert found["measured"]["T"] == pytest.approx(found["T"], abs=1e-4)
    assert len(found["modes"]) == 4
    envelope = np.array(found["envelope"])
    assert np.all(np.abs(s.q) <= envelope * (1.0 + 1e-12))
    # it touches
    assert np.min(envelope / np.maximum(np.abs(s.q), 1e-300), axis=0) == pytest.approx(1.0)
    assert envelope[-1] / envelope[0] == pytest.approx(np.exp(0.5 * found["T"] * s.tau[-1]))


def test_a_vehicle_is_told_in_its_own_units(capsys: pytest.CaptureFixture[str]) -> None:
    said = told([str(EXAMPLES / "three_stage.toml"), "--set", "gamma=0.3"], capsys)
    assert re.search(r"^ +T +Hz +multiplier", said, flags=re.M)
    doubling = float(re.findall(r"It doubles every (\S+) s\.", said)[0])
    T = float(re.findall(r"T = (\S+);", said)[0])
    assert doubling == pytest.approx(2.0 * np.log(2.0) / T, rel=1e-3)
    assert "bending 4" in said
    assert "Units: time in s, Omega in radians per unit of time" in " ".join(said.split())


def test_text_goes_into_a_file(
    mine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "growth.txt"
    assert told([mine, "--output", str(path)], capsys) == ""
    assert "Two springs at Omega = 2, gamma = 0.15, eta = 0\n" in path.read_text()


@pytest.mark.parametrize("kind", ["png", "svg", "pdf"])
def test_pictures(kind: str, mine: str, tmp_path: Path) -> None:
    path = tmp_path / f"growth.{kind}"
    assert main(["simulate", mine, "--output", str(path)]) == 0
    begins = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[kind]
    content = path.read_bytes()
    assert content.startswith(begins)
    assert main(["simulate", mine, "--output", str(path)]) == 0
    assert path.read_bytes() == content


def test_pictures_of_motions_at_their_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """At rest, of one coordinate, of one of first order, of decay to 0, of many coordinates."""
    one = HillEquation(F=[[1.0]], G=[[0.3]], gamma=0.1, Omega=0.9)
    still = follow(one, Subject("still $x$"), q0=[0.0], v0=[0.0], periods=10)
    assert (still.measured, still.content) == (None, None)
    first = follow(PeriodicEquation.first_order(A=[[-0.5]], Omega=1.0), Subject("first"))
    assert (first.names, first.began) == (("x1",), "all modes alike")
    gone = follow(
        HillEquation(F=[[1.0]], G=[[0.0]], gamma=0.0, Omega=0.9, eta=1.0),
        Subject("gone"),
        periods=300,
    )
    n = 4
    many = follow(
        HillEquation(F=np.diag(np.arange(1.0, n + 1.0) ** 2), G=np.eye(n), gamma=0.01, Omega=1.3),
        Subject("many"),
        periods=30,
    )
    for f in (still, first, gone, many):
        assert picture(f, "svg").startswith(b"<?xml")
        assert as_file(lambda console, f=f: show(f, console), 80).count("\n") > 8
    monkeypatch.setattr(simulation_picture, "MOST", 2)
    labels = re.findall(rb"<!-- (q\d) -->", picture(many, "svg"))
    assert len(labels) == 2


def test_how_long_a_motion_is_followed() -> None:
    def periods(name: str, **more: bool) -> int:
        return follow(witness(ROWS[name], 2), Subject(name), samples=1, **more).history.periods

    assert periods("T1-13") == MANY
    grown = follow(witness(ROWS["T1-12"], 2), Subject(""), samples=1)
    T, tau = grown.known.T, grown.history.tau[-1]
    assert 50.0 <= np.exp(0.5 * T * tau) < 60.0
    assert periods("T1-12", long=True) == MANY
    assert periods("T3-01b") == 20


BAD = {
    "two columns": (["--row", "T3-01"], "row = 'T3-01': has two columns, say T3-01a or T3-01b"),
    "no row": (["--row", "T9-99"], "row = 'T9-99': no such row"),
    "row and set": (["--row", "T1-12", "--set", "gamma=1"], "leave out --set"),
    "row and beam": (["--row", "T1-12", "--beam", "stepped"], "leave out --beam"),
    "periods": (["--row", "T1-12", "--periods", "0"], "--periods = 0: must be at least 1"),
    "negative": (["--row", "T1-12", "--periods", "-5"], "--periods = -5: must be at least 1"),
    "samples": (["--row", "T1-12", "--samples", "0"], "--samples = 0: must be at least 1"),
    "many": (["--row", "T1-12", "--samples", "100000"], "samples = 100000: must be at most 10,000"),
    "shape": (["--row", "T1-12", "--q0", "1"], "q0 has shape (1,): must be (3,)"),
    "nan": (["--row", "T1-12", "--v0", "0", "nan", "0"], "v0[1] = nan: every element must be"),
    "no Omega": (["--set", "gamma=0.1"], "Omega: has no value"),
    "no file": (["gone.toml"], "gone.toml: cannot be read"),
    "a picture": (["--row", "T1-12", "--format", "csv", "--output", "x.png"], "x.png is a picture"),
    "no place": (["--row", "T1-12", "--output", "gone/x.png"], "output = 'gone/x.png': cannot be"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_commands_are_one_line(
    name: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    words, says = BAD[name]
    assert main(["simulate", *words]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert says in err
    assert err.startswith("verify simulate: ")
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
