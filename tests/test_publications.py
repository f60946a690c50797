"""Papers with printed tables: Mathieu's values, a toy made here, and what holds for every paper."""

import json
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from commands import csv_lines, refusal
from rich.console import Console
from scipy.linalg import eigh_tridiagonal

from compare import both_routes, publications, verify
from compare.__main__ import main
from compare.both_routes import crosscheck
from compare.erratum import Erratum
from compare.publication import Cell, Column, Publication, Rendering
from compare.publications import mathieu
from compare.publications.mathieu.outcome import Around
from compare.publications.mathieu.table import Row
from compare.verification import Report
from hill import HillEquation

MATHIEU = mathieu.PUBLICATION
ROWS = {row.id: row for row in MATHIEU.all_rows()}
# Rounding of an eigenvalue of a matrix of norm 3600: an ulp of that is 5e-13; measured 2e-13.
EIGENVALUE = 1e-12
UNDECIDED = {"a10-q10", "b10-q10", "b15-q20"}


@pytest.fixture(scope="module")
def report() -> Report:
    return verify(publication="mathieu")


def eigenvalue(letter: str, r: int, q: float) -> float:
    """a_r or b_r(q): of the Fourier coefficients' symmetric tridiagonal matrix (DLMF 28.4)."""
    n = 30
    even = r % 2 == 0
    first = 0.0 if (even and letter == "a") else 2.0 if even else 1.0
    diagonal = (first + 2.0 * np.arange(n)) ** 2
    off = np.full(n - 1, float(q))
    if even and letter == "a":
        off[0] *= np.sqrt(2.0)
    if not even:
        diagonal[0] += q if letter == "a" else -q
    place = round((r - first) / 2.0)
    (found,) = eigh_tridiagonal(diagonal, off, select="i", select_range=(place, place))[0]
    return float(found)


def exact(row: Row) -> float:
    return eigenvalue(row.id[0], row.r, row.q)


# ---- Mathieu's characteristic values -------------------------------------------------------------


def test_the_eigenvalues_are_the_textbook_s() -> None:
    """DLMF 28: q = 1 and 5."""
    for letter, r, q, value in (
        ("a", 0, 1.0, -0.45513860410741355),
        ("b", 1, 1.0, -0.11024881699209517),
        ("b", 2, 1.0, 3.9170247729984712),
        ("a", 2, 5.0, 7.4491097395291778),
    ):
        assert eigenvalue(letter, r, q) == pytest.approx(value, abs=EIGENVALUE)


@pytest.mark.parametrize("name", ROWS)
def test_every_value_is_an_eigenvalue(name: str) -> None:
    """To half a unit of the last digit, by a matrix that neither route has seen."""
    row = ROWS[name]
    assert abs(exact(row) - float(row.printed)) <= row.half_unit - EIGENVALUE
    assert row.half_unit == 5e-9


@pytest.mark.parametrize("name", ROWS)
def test_P_changes_its_sign_about_the_eigenvalue(name: str, report: Report) -> None:
    outcome = {o.row.id: o for o in report.outcomes}[name]
    assert outcome.routes_agree
    assert outcome.expected
    assert (outcome.cause == "undecided") == (name in UNDECIDED)
    for seen in (outcome.hill, outcome.floquet):
        assert seen.changes_sign == (name not in UNDECIDED)
        if seen.changes_sign:
            # P runs through zero where the eigenvalue is: linear, to a share of the interval
            share = seen.below / (seen.below - seen.above)
            at = float(outcome.row.printed) + outcome.row.half_unit * (2.0 * share - 1.0)
            unsure = outcome.row.half_unit * 2.0 * seen.bound / abs(seen.below - seen.above)
            assert abs(at - exact(outcome.row)) <= unsure + EIGENVALUE
        else:
            assert seen.may_vanish


def test_why_three_values_are_undecided() -> None:
    gap = eigenvalue("a", 10, 10.0) - eigenvalue("b", 10, 10.0)
    assert gap == pytest.approx(5.6e-7, rel=0.01)
    assert eigenvalue("a", 15, 20.0) - eigenvalue("b", 15, 20.0) == pytest.approx(
        3.1e-11, abs=EIGENVALUE
    )
    # between them P(1) is -z''(a) gap^2/8, with z = cos(pi sqrt a) nearly
    assert (np.pi / 20.0) ** 2 * gap**2 / 8.0 == pytest.approx(1e-15, rel=0.1)
    assert {e.row for e in MATHIEU.errata()} == UNDECIDED


def test_the_other_neighbour_is_no_root() -> None:
    """P(-1) at an even r is far from zero: the sign that is asked for is the right one."""
    for row in ROWS.values():
        x = crosscheck(HillEquation([[float(row.printed)]], [[1.0]], -2.0 * row.q, 2.0))
        assert abs(x.hill.polynomial[1] - row.z) > 1.9


def wrong(row: Row, digit: int) -> Row:
    """The row with one digit of its value another."""
    moved = Decimal(row.printed) + Decimal(1).scaleb(-digit)
    return replace(row, printed=f"{moved:.8f}")


@pytest.mark.parametrize("name", ["a0-q5", "a5-q5", "b2-q25"])
@pytest.mark.parametrize("digit", [3, 7])
def test_a_misprint_is_found_and_its_correction_too(name: str, digit: int) -> None:
    row = wrong(ROWS[name], digit)
    lost = MATHIEU.check(row)
    assert (lost.cause, lost.expected, lost.routes_agree) == ("unexplained", False, True)
    entry = Erratum("x", "cell", "x", row.printed, ROWS[name].printed, "x", "x", name, "a")
    paper = replace(MATHIEU, errata=lambda: (entry,))
    found = paper.check(row)
    assert (found.cause, found.expected) == ("misprint", True)
    assert found.note == f"should be {ROWS[name].printed}"
    # a correction that is wrong too explains nothing
    paper = replace(MATHIEU, errata=lambda: (replace(entry, corrected=row.printed),))
    assert paper.check(row).cause == "unexplained"


def test_undecided_without_a_reason_is_not_expected() -> None:
    found = replace(MATHIEU, errata=lambda: ()).check(ROWS["a10-q10"])
    assert (found.cause, found.expected) == ("undecided", False)


def test_what_counts_as_a_change_of_sign() -> None:
    assert Around(-2.0, 0.5, 2.0, 1.0).changes_sign
    assert not Around(-0.5, 0.5, 2.0, 1.0).changes_sign
    assert not Around(2.0, 0.5, 2.0, 1.0).changes_sign
    assert Around(2.0, 0.5, 2.0, 1.0).may_vanish
    assert not Around(2.0, 1.5, 2.0, 1.0).may_vanish


def test_cvodes_shows_the_same() -> None:
    found = MATHIEU.check(ROWS["b2-q5"], method="cvodes")
    assert found.cause == "agrees"
    assert found.floquet.bound > 1e-12


# ---- the command ---------------------------------------------------------------------------------


def test_the_command_prints_every_value(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--publication", "mathieu"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len([line for line in lines if line[:1] in "ab" and "-q" in line]) == 19
    assert lines[-2].startswith("19 printed values: 16 right to the last digit by both routes, 3 ")
    assert lines[-1].startswith("The two routes agree on 19 of 19 within their own error bounds")


def test_json_markdown_and_csv_agree(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--publication", "mathieu", "--table", "2", "--row", "b2-q5", "--row", "B10-q10"]
    assert main([*words, "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["summary"]["ok"] is True
    assert (content["summary"]["agrees"], content["summary"]["undecided"]) == (1, 1)
    assert [row["id"] for row in content["rows"]] == ["b2-q5", "b10-q10"]
    one = content["rows"][0]
    assert (one["printed"], one["half_unit"], one["z"]) == (2.09946045, 5e-9, 1)
    assert one["hill"]["below"] * one["hill"]["above"] < 0.0
    assert main([*words, "--format", "csv"]) == 0
    _, lines = csv_lines(capsys.readouterr().out)
    assert [line["shown_by"] for line in lines] == ["both", "neither"]
    assert float(lines[0]["hill_P"]) == one["hill"]["at"]
    assert main([*words, "--format", "md", "--show", "differs"]) == 0
    written = capsys.readouterr().out
    assert "| b10-q10 | 10 | 100.50676946 |" in written
    assert "b2-q5" not in written


def test_exit_status_1_where_a_value_is_wrong(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        mathieu, "PUBLICATION", replace(MATHIEU, rows=lambda _: (wrong(ROWS["a0-q5"], 6),))
    )
    assert main(["--publication", "mathieu", "--table", "1"]) == 1
    assert "1 wrong without an explanation" in capsys.readouterr().out


def test_exit_status_1_where_the_routes_disagree(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    right = both_routes.monodromy

    def moved(*words: object, **options: object) -> object:
        m = right(*words, **options)
        return replace(m, polynomial=m.polynomial + np.array([0.0, 1e-9]))

    monkeypatch.setattr(both_routes, "monodromy", moved)
    assert main(["--publication", "mathieu", "--row", "a5-q5"]) == 1
    assert "agree on 0 of 1" in capsys.readouterr().out


@pytest.mark.parametrize("width", [60, 80, 140])
def test_the_table_fits_the_terminal(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    command = pytest.importorskip("compare.commands.rows")
    monkeypatch.setattr(command, "terminal", lambda: Console(width=width))
    assert main(["--publication", "mathieu", "--row", "a10-q10"]) == 0
    table = capsys.readouterr().out.splitlines()[:3]
    assert all(len(line) <= width for line in table)
    assert not any("\N{HORIZONTAL ELLIPSIS}" in line for line in table)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--publication", "mathiu"], "did you mean mathieu?"),
        (["--publication", "kincade"], "did you mean kincaid?"),
        (["--publication", "xyz"], "must be one of kincaid, mathieu"),
        (["--publication", "mathieu", "--table", "3"], "table = 3: must be one of 1, 2"),
        (["--publication", "mathieu", "--row", "a1-q1"], "row = 'a1-q1'"),
        (["--publication", "mathieu", "--modes", "4"], "modes = 4: must be left out"),
    ],
)
def test_wrong_names_are_refused(
    words: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert says in refusal(words, capsys)


# ---- every paper ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", publications.names())
def test_a_paper_is_complete(name: str) -> None:
    paper = publications.find(name)
    assert paper.name == name
    rows = paper.all_rows()
    ids = [row.id for row in rows]
    assert len(set(ids)) == len(ids) > 0
    assert {row.table for row in rows} == set(paper.tables)
    assert {e.row for e in paper.errata()} - {""} <= set(ids)
    tests = Path(__file__).parent
    for erratum in paper.errata():
        file, _, function = erratum.test.partition("::")
        assert f"def {function}(" in (tests.parent / file).read_text()
    outcome = paper.check(rows[0])
    assert outcome.row == rows[0]
    rendering = paper.rendering
    assert len(rendering.cells(outcome)) == len(rendering.columns)
    assert len(rendering.csv_line(outcome)) == len(rendering.csv_header)
    assert json.loads(json.dumps(rendering.record(outcome)))["id"] == ids[0]


# ---- one that is made here -----------------------------------------------------------------------


@dataclass(frozen=True)
class Printed:
    id: str
    table: int
    Omega: float
    verdict: str


@dataclass(frozen=True)
class Found:
    row: Printed
    verdict: str
    routes_agree: bool
    expected: bool

    @property
    def differs(self) -> bool:
        return self.verdict != self.row.verdict

    flips = differs


@dataclass(frozen=True)
class Tally:
    rows: int
    wrong: int

    @property
    def lines(self) -> tuple[str, ...]:
        return (f"{self.rows} verdicts: {self.wrong} wrong.",)


@cache
def printed(table: int) -> tuple[Printed, ...]:
    return (Printed("S-1", table, 2.0, "unstable"), Printed("S-2", table, 3.0, "unstable"))


def explain(
    row: Printed, found: both_routes.CrossCheck, as_run: float, errata: tuple[Erratum, ...]
) -> Found:
    assert as_run == 2.0 * row.Omega
    known = found.verdict == row.verdict or bool(errata)
    return Found(row, found.verdict, found.routes_agree, known)


TOY = Publication(
    name="toy",
    title="Verdicts on x'' + (1 + 0.4 cos Omega t) x = 0",
    tables=(7,),
    rows=printed,
    errata=lambda: (Erratum("S-2", "cell", "S-2", "unstable", "stable", "x", "x", "S-2", "v"),),
    solve=lambda row, **how: crosscheck(HillEquation([[1.0]], [[1.0]], 0.4, row.Omega)),
    explain=explain,
    as_run=lambda row: 2.0 * row.Omega,
    rendering=Rendering(
        columns=(Column("row", words=True), Column("verdict", words=True)),
        cells=lambda o: (Cell(o.row.id), Cell(o.verdict, loud=o.flips)),
        record=lambda o: {"id": o.row.id, "verdict": o.verdict},
        csv_header=("id", "verdict"),
        csv_line=lambda o: (o.row.id, o.verdict),
        count=lambda outcomes: Tally(len(outcomes), sum(o.differs for o in outcomes)),
    ),
)


def test_another_paper_is_a_file_and_no_change_of_ours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    seen = []
    found = verify(publication=TOY, progress=seen.append)
    assert found.ok
    assert [o.verdict for o in found.outcomes] == ["unstable", "stable"]
    assert seen == list(found.outcomes)

    (tmp_path / "toy.py").write_text("PUBLICATION = None\n")
    monkeypatch.setattr(publications, "__path__", [*publications.__path__, str(tmp_path)])
    assert publications.names() == ("kincaid", "mathieu", "toy")
    module = pytest.importorskip("compare.publications.toy")
    monkeypatch.setattr(module, "PUBLICATION", TOY)
    assert main(["--publication", "toy"]) == 0
    written = capsys.readouterr().out
    assert written.splitlines()[-1] == "2 verdicts: 1 wrong."
    assert main(["--publication", "toy", "--format", "md", "--show", "flips"]) == 0
    assert "| S-2 | **stable** |" in capsys.readouterr().out
    assert main(["--publication", "toy", "--format", "json", "--table", "7"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["summary"] == {"rows": 2, "wrong": 1, "ok": True}
    assert main(["--publication", "toi"]) == 2
    assert "did you mean toy?" in capsys.readouterr().err
    monkeypatch.setattr(module, "PUBLICATION", replace(TOY, errata=lambda: ()))
    assert main(["--publication", "toy"]) == 1
