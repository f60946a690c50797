"""The pages: complete, linked, named, the numbers those of the JSON, safe whatever a file says."""

import importlib.resources
import inspect
import json
import posixpath
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages_html import Parsed

from compare import verify
from compare.__main__ import main
from compare.commands import report as commands_report
from compare.output_folder import LIST, check_folder, write_folder
from compare.pages import mathematics, own, pictures, printed, printed_row, render
from compare.pages.drawing import Frame
from compare.pages.motion import PERIODS, SHOWN, Motion, let_go
from compare.pages.render import rendered
from compare.pages.site import Site
from compare.report.claims.both_routes import RoutesDisagree
from compare.report.claims.run import judge
from compare.report.errata import all_errata
from compare.report.proofs import prove_row
from compare.report.row import equation
from compare.report.tables import all_rows
from compare.verification import Report
from compare.verification_text import as_json
from hill import Fourier, HillEquation, PeriodicEquation

SVG = b'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"></svg>'
# Two of the quickest: all of them take half a minute.
CLAIMS = ("control-and-sensor", "integrals")
PROVEN = ("T1-07",)


@cache
def report() -> Report:
    return verify()


def grown(T: float, periods: int = 200) -> Motion:
    """Coordinates that grow like exp(T tau/2) by construction."""
    tau = np.linspace(0.0, 8 * np.pi * 2.0, 161)
    q = np.exp(0.5 * T * tau)[:, None] * np.cos(np.outer(tau, [0.5, 1.3, 2.9]))
    largest = np.exp(0.5 * T * 2.0 * np.pi * np.arange(1.0, periods + 1.0))[:, None] * np.ones(3)
    return Motion(tau, q, 2.0 * np.pi, largest, 1e-9, T, printed_row.COORDINATES, 3)


@cache
def site() -> Site:
    rows = {row.id: row for row in all_rows()}
    return printed.site(
        report(),
        motions={"T1-07": grown(0.0), "T1-12": grown(0.03)},
        claims=judge(CLAIMS),
        proofs=[prove_row(rows[name]) for name in PROVEN],
        figures={"figure03.svg": SVG, "figure03.csv": b"a,b\n", "figure08.png": b"\x89PNG"},
    )


@cache
def files() -> dict[str, bytes]:
    return rendered(site())


@cache
def pages() -> dict[str, Parsed]:
    return {
        path: Parsed(content.decode())
        for path, content in files().items()
        if path.endswith(".html")
    }


# ---- the set -------------------------------------------------------------------------------------


def test_every_row_table_claim_and_erratum_has_its_place() -> None:
    rows = {f"rows/{row.id}.html" for row in all_rows()}
    others = {"index", "table-1", "table-2", "table-3", "figures", "claims", "errata"}
    assert set(pages()) == rows | {f"{name}.html" for name in others}
    assert {e.id for e in all_errata()} <= set(pages()["errata.html"].ids)
    assert set(CLAIMS) <= set(pages()["claims.html"].ids)


def test_titles_are_unique_and_the_language_is_said() -> None:
    titles = [page.title for page in pages().values()]
    assert len(set(titles)) == len(titles)
    for page in pages().values():
        assert page.all("html")[0].attributes["lang"] == "en"
        assert len(page.all("h1")) == 1
        assert len(page.ids) == len(set(page.ids))


def target(of: str, reference: str) -> tuple[str, str]:
    path, _, anchor = reference.partition("#")
    return posixpath.normpath(posixpath.join(posixpath.dirname(of), path)) if path else of, anchor


def test_every_link_is_relative_and_leads_somewhere() -> None:
    """Within the set: nothing is fetched, and nothing is asked of a server."""
    count = 0
    for name, page in pages().items():
        for reference in page.references:
            if reference == "data:,":  # no icon
                continue
            assert "//" not in reference
            assert not reference.startswith(("/", "file:"))
            path, anchor = target(name, reference)
            assert path in files(), f"{name}: {reference}"
            if anchor:
                assert anchor in pages()[path].ids, f"{name}: {reference}"
            count += 1
    assert count > 1000


def test_every_page_is_reached_from_the_first() -> None:
    seen, ahead = {"index.html"}, ["index.html"]
    while ahead:
        here = ahead.pop()
        for reference in pages()[here].references:
            path, _ = target(here, reference)
            if path in pages() and path not in seen:
                seen.add(path)
                ahead.append(path)
    assert seen == set(pages())


def test_nothing_is_loaded_from_elsewhere() -> None:
    for path in ("pages.css", "tables.js"):
        text = files()[path].decode()
        assert "http" not in text
        assert "url(" not in text
        assert "@import" not in text


def test_every_picture_says_what_it_shows() -> None:
    count = 0
    for page in pages().values():
        for image in page.all("img"):
            assert len(image.attributes["alt"]) > 20
            assert "$" not in image.attributes["alt"]
            assert "\\" not in image.attributes["alt"]
        for svg in page.all("svg"):
            if svg.attributes.get("aria-hidden") == "true":
                continue
            assert svg.attributes["role"] == "img"
            named = svg.attributes["aria-labelledby"].split()
            own = {e.attributes["id"]: e.text for e in svg.children if "id" in e.attributes}
            assert len(named) == 2
            assert all(own[name].strip() for name in named)
            count += 1
    assert count == 3 * 89 + 2 * 2


def test_every_table_has_a_caption_and_heads_with_a_scope() -> None:
    for page in pages().values():
        for table in page.all("table"):
            assert table.children[0].name == "caption"
            assert table.children[0].text.strip()
            heads = table.all("th")
            assert heads
            assert all(head.attributes["scope"] in ("col", "row") for head in heads)
            widths = {sum(c.name in ("td", "th") for c in row.children) for row in table.all("tr")}
            assert len(widths) == 1


def test_the_navigation_knows_where_it_is() -> None:
    for name, page in pages().items():
        nav = page.all("nav")[0]
        (here,) = [a for a in nav.all("a") if "aria-current" in a.attributes]
        path, _ = target(name, here.attributes["href"])
        assert path == name or name.startswith("rows/")
        assert (here.attributes["aria-current"] == "page") == (path == name)


def test_every_template_is_used() -> None:
    """And what is used is there: a set of pages of one's own has its own tests."""
    folder = importlib.resources.files("compare") / "pages" / "templates"
    there = {file.name for file in folder.iterdir()}
    code = "".join(inspect.getsource(module) for module in (printed, own, render))
    text = code + "".join((folder / name).read_text() for name in there if name.endswith(".html"))
    assert {name for name in there if f'"{name}"' not in text} == set()


# ---- the numbers ---------------------------------------------------------------------------------


def records() -> dict[str, dict[str, Any]]:
    return {row["id"]: row for row in json.loads(as_json(report()))["rows"]}


def found(record: Any, key: str) -> Any:
    for part in key.split("."):
        record = record[int(part)] if isinstance(record, list) else record[part]
    return record


def test_the_json_goes_with_the_pages() -> None:
    assert files()["rows.json"].decode() == as_json(report())


@pytest.mark.parametrize("name", [row.id for row in all_rows()])
def test_numbers_of_a_row_are_those_of_the_json(name: str) -> None:
    record = records()[name]
    data = pages()[f"rows/{name}.html"].data()
    for key, (value, _) in data.items():
        assert value == found(record, key), key
    routes = [
        f"{route}.{what}"
        for route in ("hill", "floquet")
        for what in ("T", "T_error", "error", *(f"z.{k}" for k in range(3)))
    ]
    polynomials = [f"{r}.polynomial.{k}" for r in ("hill", "floquet") for k in range(4)]
    own = ["printed.T", "as_run.T", *(f"as_run.z.{k}" for k in range(3)), "difference", "Omega"]
    assert set(data) >= {*routes, *polynomials, *own}


@pytest.mark.parametrize("name", ["T1-21", "T2-31", "T2-11"])
def test_z_stand_in_the_order_of_the_printed_ones(name: str) -> None:
    """The columns of the table are the same root: as near to print as any pairing allows."""
    content = next(p.content for p in site().pages if p.path == f"rows/{name}.html")
    record = records()[name]
    printed_z = [complex(*z) for z in record["printed"]["z"]]
    for route in ("as_run", "hill", "floquet"):
        own = [complex(*record[route]["z"][k]) for k in content.z_order[route]]
        # the misprinted sign of one of a pair apart: measured .11 at most, roots are .5 apart
        assert max(abs(a.real - b.real) for a, b in zip(own, printed_z, strict=True)) < 0.12


def test_what_is_shown_of_a_number_is_that_number() -> None:
    data = pages()["rows/T1-08.html"].data()
    for key, digits in (("as_run.z.0", 6), ("floquet.polynomial.1", 15), ("hill.z.0", 9)):
        value, shown = data[key]
        real, imaginary = value if isinstance(value, list) else (value, 0.0)
        assert imaginary == 0.0
        assert float(shown.replace("−", "-")) == pytest.approx(real, rel=10.0 ** (1 - digits))


def test_the_tables_have_every_row_and_the_numbers_of_the_json() -> None:
    for table in (1, 2, 3):
        page = pages()[f"table-{table}.html"]
        lines = [row for row in page.all("tr") if "data-row" in row.attributes]
        ids = [line.attributes["data-row"] for line in lines]
        assert ids == [row.id for row in all_rows((table,))]
        for line, name in zip(lines, ids, strict=True):
            record = records()[name]
            for key, (value, _) in page.data(line).items():
                assert value == found(record, key), (name, key)
            assert len(page.data(line)) == 7
            assert ("flips" in line.attributes.get("class", "")) == record["flips"]
            assert line.attributes["data-cause"] == record["cause"]


def test_the_index_lists_what_print_has_wrong() -> None:
    page = pages()["index.html"]
    listed = [row.attributes["data-row"] for row in page.all("tr") if "data-row" in row.attributes]
    assert listed == [name for name, record in records().items() if record["flips"]]
    for line in report().summary.lines:
        assert line.split(";")[0] in page.root.text


def test_a_row_says_what_its_verdict_is() -> None:
    for name, record in records().items():
        lead = next(
            p for p in pages()[f"rows/{name}.html"].all("p") if p.attributes.get("class") == "lead"
        )
        words = [e.text for e in lead.all("span")]
        assert words == (
            [record["verdict_printed"], record["verdict"]]
            if record["flips"]
            else [record["verdict"]]
        )
        assert ("wrong" in lead.text) == record["flips"]


def test_proofs_stand_on_their_rows() -> None:
    for name in (row.id for row in all_rows()):
        text = pages()[f"rows/{name}.html"].root.text
        assert ("Balls that hold the true values" in text) == (name in PROVEN)
    assert "Proven stable" in " ".join(pages()["rows/T1-07.html"].root.text.split())


# ---- pictures ------------------------------------------------------------------------------------


def points(line: Any) -> list[tuple[float, float]]:
    pairs = (pair.split(",") for pair in line.points.split())
    return [(float(x), float(y)) for x, y in pairs]


def test_multipliers_lie_where_they_are() -> None:
    """On the circle's drawing: the same distance from its middle, at the same angle."""
    mu = [np.exp(0.7j), np.exp(-0.7j), 1.5 + 0.0j, -0.25j]
    drawn = pictures.multipliers(mu, mu)
    circle = np.array(points(next(c for c in drawn.curves if c.look == "circle")))
    middle = 0.5 * (circle.min(axis=0) + circle.max(axis=0))
    radius = 0.5 * np.ptp(circle[:, 0])
    for value, mark in zip(mu, drawn.marks, strict=False):
        at = (mark.x - middle[0] - 1j * (mark.y - middle[1])) / radius
        assert abs(at - value) < 2e-3
    assert "1 outside the unit circle" in drawn.description


def test_a_multiplier_far_out_is_marked_at_the_edge_and_told() -> None:
    drawn = pictures.multipliers([1e200, 1e-200], [1e200, 1e-200])
    assert all(0.0 <= mark.x <= drawn.width for mark in drawn.marks)
    assert "1 lie beyond the picture" in drawn.description


def test_a_root_is_drawn_where_P_crosses_its_axis() -> None:
    z = (-0.999, -0.2, 0.6)
    roots = pictures.Roots(tuple(np.poly(z)), z, z, ())
    for drawn in (pictures.whole(roots), pictures.closest(roots)):
        curve = np.array(points(next(c for c in drawn.curves if c.look == "a")))
        axis = points(next(c for c in drawn.curves if c.look == "guide"))[0][1]
        crossing = np.interp(0.0, (curve[:, 1] - axis)[::-1], curve[::-1, 0])
        near = min(abs(mark.x - crossing) for mark in drawn.marks)
        assert near < 3.0
    # the window of the closest holds both the root and the edge at -1
    assert sum(c.look == "edge" for c in pictures.closest(roots).curves) == 1


def test_a_root_that_is_off_is_where_it_is_decided() -> None:
    """And not two that happen to be closer to each other; an edge or a pair is in the window."""
    z = (-0.6, 0.59, 1.4)
    drawn = pictures.closest(pictures.Roots(tuple(np.poly(z)), z, z))
    assert [c.look for c in drawn.curves].count("edge") == 1
    assert sorted(float(m.says.split()[-1]) for m in drawn.marks if m.shape == "dot") == [1.4]
    z = (-0.6, 0.5 + 0.01j, 0.5 - 0.01j)
    drawn = pictures.closest(pictures.Roots(tuple(np.poly(z).real), z, z))
    assert len([m for m in drawn.marks if m.shape == "dot"]) == 2


def test_growth_is_drawn_with_the_slope_of_T() -> None:
    m = grown(0.03)
    drawn = pictures.growth(m)
    law, line = (
        np.array(points(next(c for c in drawn.curves if c.look == look))) for look in ("law", "a")
    )
    # to a tenth of a dot, both of them
    assert np.max(np.abs(np.interp(line[:, 0], *law.T) - line[:, 1])) < 0.16
    assert abs(law[-1, 1] - law[0, 1]) > 100.0
    assert not [c for c in pictures.growth(grown(0.0)).curves if c.look == "law"]


def test_the_motion_of_a_row_grows_as_its_T_says() -> None:
    row = next(row for row in all_rows() if row.id == "T1-12")
    T = records()["T1-12"]["floquet"]["T"]
    found = let_go(equation(row, 2), T, printed_row.COORDINATES)
    assert isinstance(found, Motion)
    assert found.largest.shape == (PERIODS, 3)
    assert found.shown == SHOWN
    assert found.known_to < 1e-6
    rate = np.polyfit(found.period * np.arange(100.0, 200.0), np.log(found.largest[100:]), 1)[0]
    # measured 2.1e-3: an extreme of 64 samples a period, and what else moves
    assert rate == pytest.approx(0.5 * T, rel=4e-3)


def test_of_many_coordinates_those_that_move_farthest_are_drawn() -> None:
    n = 9
    F = np.diag(np.append(np.full(n - 1, 30.0), -0.01))
    found = let_go(HillEquation(F=F, G=np.eye(n), gamma=0.1, Omega=2.0), 0.2)
    assert isinstance(found, Motion)
    assert found.of == n
    assert len(found.names) == found.q.shape[1] == found.largest.shape[1] == 6
    assert found.names[-1] == "q_9"


def test_a_motion_beyond_a_float_is_told() -> None:
    fast = HillEquation(F=[[-100.0]], G=[[0.0]], gamma=0.0, Omega=1.0)
    found = let_go(fast, 20.0)
    assert isinstance(found, Motion)
    assert 0 < len(found.largest) < PERIODS
    assert "stopped" in found.stopped
    assert np.all(np.isfinite(found.largest))
    first_order = PeriodicEquation.first_order(A=Fourier([[-0.1]]), Omega=1.0)
    decays = let_go(first_order, -0.2)
    assert isinstance(decays, Motion)
    assert decays.names == ("x_1",)
    drawn = pictures.growth(decays)
    assert [c for c in drawn.curves if c.look == "law"]


@pytest.mark.parametrize(
    ("low", "high"), [(0.0, 8.0), (-1.00002, -0.99999), (-3e-5, 2e-5), (-7e5, 6e5), (0.0, 1e12)]
)
def test_ticks_are_told_apart_and_fit(low: float, high: float) -> None:
    frame = Frame(low, high, low, high)
    _, labels = frame.axes("x", "y")
    across = [label for label in labels if label.y > frame.height - 40.0 and label.text != "x"]
    up = [label for label in labels if label.anchor == "end" and label.text != "y"]
    for some in (across, up):
        assert len({label.text for label in some}) == len(some) >= 2
    for label in across:
        assert label.x + 3.8 * len(label.text) <= frame.width + 1e-9
    # up the sheet numbers are about 0, or of a few digits
    for label in up if low != -1.00002 else ():
        assert label.x - 6.6 * len(label.text) >= 0.0


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("omega_(1) + omega_(B)", "<var>ω</var><sub>(1)</sub> + <var>ω</var><sub>(B)</sub>"),
        ("T0 l^2 +- 2e-16", "<var>T</var><sub>0</sub> l<sup>2</sup> ± 2 × 10<sup>−16</sup>"),
        ("row T1-07, -.5 - .2", "row T1-07, −.5 - .2"),
        ("a <b> & `x_1 < 2`", "a &lt;b&gt; &amp; <code>x_1 &lt; 2</code>"),
        ("M^-3, quadrature_force", "M<sup>−3</sup>, quadrature_force"),
        ("Fbar_22 of K_theta", "<var>F̄</var><sub>22</sub> of <var>K</var><sub>θ</sub>"),
    ],
)
def test_formulas(text: str, html: str) -> None:
    assert mathematics.as_html(text).replace("\N{NO-BREAK SPACE}", " ") == html


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (float("nan"), "–"),
        (None, "–"),
        (float("inf"), "∞"),
        (-0.0, "0"),
        (-1.5e-7, "−1.5 × 10<sup>−7</sup>"),
    ],
)
def test_numbers(value: float | None, shown: str) -> None:
    assert mathematics.number(value, 3).replace("\N{NO-BREAK SPACE}", " ") == shown


# ---- writing -------------------------------------------------------------------------------------

ABOUT = {"made_by": "tests"}


def tree(folder: Path) -> dict[str, bytes]:
    return {
        p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()
    }


def test_a_folder_is_written_and_replaced_whole(tmp_path: Path) -> None:
    place = tmp_path / "pages"
    write_folder(place, {"a.html": b"1", "rows/b.html": b"2"}, ABOUT)
    assert set(tree(place)) == {"a.html", "rows/b.html", LIST}
    write_folder(place, {"c.html": b"3"}, ABOUT)
    assert set(tree(place)) == {"c.html", LIST}
    assert [p.name for p in tmp_path.iterdir()] == ["pages"]


@pytest.mark.parametrize("where", ["write", "first", "second"])
@pytest.mark.parametrize("end", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_what_was_there_outlives_a_failure(
    where: str, end: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = tmp_path / "pages"
    write_folder(place, {"a.html": b"1"}, ABOUT)
    before = tree(place)
    real_rename, real_write, renames = Path.rename, Path.write_bytes, []

    def rename(self: Path, other: Path) -> Path:
        renames.append(self)
        if len(renames) == {"first": 1, "second": 2}.get(where):
            raise end
        return real_rename(self, other)

    def write(self: Path, data: bytes) -> int:
        if where == "write" and self.name == "c.html":
            raise end
        return real_write(self, data)

    monkeypatch.setattr(Path, "rename", rename)
    monkeypatch.setattr(Path, "write_bytes", write)
    with pytest.raises((ValueError, KeyboardInterrupt)):
        write_folder(place, {"b.html": b"2", "c.html": b"3"}, ABOUT)
    assert tree(place) == before
    assert [p.name for p in tmp_path.iterdir()] == ["pages"]


@pytest.mark.parametrize("listed", [None, "{}", "no JSON", '{"files": 3}', '{"files": ["b"]}'])
def test_what_is_not_ours_is_refused(listed: str | None, tmp_path: Path) -> None:
    place = tmp_path / "mine"
    place.mkdir()
    (place / "thesis.tex").write_text("years of work")
    if listed is not None:
        (place / LIST).write_text(listed)
    with pytest.raises(
        ValueError, match=r"not of this command, such as '(thesis.tex|made-by.json)'"
    ):
        write_folder(place, {"a.html": b"1"}, ABOUT)
    assert (place / "thesis.tex").read_text() == "years of work"


def test_a_file_added_to_ours_is_not_lost(tmp_path: Path) -> None:
    place = tmp_path / "pages"
    write_folder(place, {"a.html": b"1"}, ABOUT)
    (place / "rows").mkdir()
    (place / "rows" / "notes.txt").write_text("mine")
    with pytest.raises(ValueError, match=r"rows/notes\.txt"):
        check_folder(place)


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    place = tmp_path / "empty"
    place.mkdir(0o750)
    write_folder(place, {"a.html": b"1"}, ABOUT)
    assert tree(place)["a.html"] == b"1"
    assert place.stat().st_mode & 0o777 == 0o750


@pytest.mark.parametrize("words", [".", "..", "file", "gone/pages", "file/pages", "x" * 300])
def test_where_there_can_be_no_folder(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "file").write_text("")
    monkeypatch.chdir(tmp_path / "here")
    with pytest.raises(ValueError, match="output = "):
        check_folder(Path(words))


def test_a_link_to_a_folder_stays_one(tmp_path: Path) -> None:
    real, link = tmp_path / "real", tmp_path / "link"
    write_folder(real, {"a.html": b"1"}, ABOUT)
    link.symlink_to(real)
    write_folder(link, {"b.html": b"2"}, ABOUT)
    assert link.is_symlink()
    assert set(tree(real)) == {"b.html", LIST}


# ---- the command ---------------------------------------------------------------------------------


def test_the_command_writes_the_pages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(commands_report, "verify", lambda **_: report())
    monkeypatch.setattr(commands_report, "let_go", lambda *_: grown(0.01))
    figures = tmp_path / "figures"
    figures.mkdir()
    for name in ("figure03.svg", "figure03.png", "figure03.csv", "other.svg"):
        (figures / name).write_bytes(SVG)
    place = tmp_path / "pages"
    words = ["report", "--output", str(place), "--figures", str(figures), "--no-claims"]
    assert main(words) == 0
    assert "index.html" in capsys.readouterr().out
    written = tree(place)
    assert len([name for name in written if name.startswith("rows/")]) == 89
    drawn = {name for name in written if name.startswith("figures/")}
    assert drawn == {"figures/figure03.csv", "figures/figure03.svg"}
    # a few megabytes: a mail attachment
    assert sum(map(len, written.values())) < 10e6


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """The command with what it computes at hand."""
    known = prove_row(all_rows()[0])
    monkeypatch.setattr(commands_report, "verify", lambda **_: report())
    monkeypatch.setattr(commands_report, "let_go", lambda *_: "")
    monkeypatch.setattr(commands_report, "prove_row", lambda row: replace(known, row=row))
    monkeypatch.setattr(commands_report, "tasks", lambda _: [(27,)])
    return monkeypatch


def test_figures_are_drawn_and_rows_proven_where_that_is_asked_for(
    quick: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    place = tmp_path / "pages"
    words = ["report", "--output", str(place), "--draw", "--prove", "--no-claims"]
    assert main(words) == 0
    written = tree(place)
    assert {name for name in written if name.startswith("figures/")} == {
        "figures/figure27.csv",
        "figures/figure27.svg",
    }
    assert all(
        b"Balls that hold the true values" in data
        for name, data in written.items()
        if name.startswith("rows/")
    )
    assert b"89 of 89 verdicts are proven" in written["index.html"]


def test_the_status_says_whether_all_is_known(
    quick: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, *others = report().outcomes
    lost = replace(report(), outcomes=(replace(first, expected=False), *others))
    quick.setattr(commands_report, "verify", lambda **_: lost)
    words = ["report", "--output", str(tmp_path / "pages")]
    assert main([*words, "--no-claims"]) == 1
    assert (tmp_path / "pages" / "index.html").is_file()

    def disagree(**_: Any) -> None:
        raise RoutesDisagree("T at 2 omega_(B): the routes differ")

    quick.setattr(commands_report, "judge", disagree)
    before = tree(tmp_path / "pages")
    capsys.readouterr()
    assert main(words) == 1
    assert capsys.readouterr().err == "verify report: T at 2 omega_(B): the routes differ\n"
    assert tree(tmp_path / "pages") == before


def test_without_the_extra_one_line_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "jinja2", None)
    assert main(["report", "--output", str(tmp_path / "pages")]) == 2
    assert capsys.readouterr().err == (
        'verify report: pages need Jinja2: pip install "floquet-crosscheck[pages]"\n'
    )
    assert not (tmp_path / "pages").exists()
