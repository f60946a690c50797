"""Pages of a system of one's own: the numbers of `verify system`, whatever a file calls itself."""

import json
from functools import cache, partial
from pathlib import Path
from typing import Any

import pytest
from browser import Browser
from commands import refusal
from pages_html import Parsed

from compare.__main__ import main
from compare.commands import report as commands_report
from compare.vehicle.study import study

EVIL = '<script>document.title="x"</script> & "co" <img src=x onerror=alert(1)>'
SYSTEM = f"""
kind = "matrices"
title = '{EVIL}'
[system]
F = [[2.0, -1.0], [-1.0, 2.0]]
G = [[1.0, 0.0], [0.0, 1.0]]
[forcing]
gamma = 0.15
Omega = 2.0
eta = 0.02
"""
AXES = """
[[axis]]
name = "Omega"
low = 1.7
high = 2.3
count = 31
[[axis]]
name = "gamma"
low = 0.0
high = 0.3
count = 21
"""
GENERAL = """
kind = "matrices"
title = "rotor"
[system]
K.mean = [[1.0, 0.2], [0.2, 4.0]]
K.cos.1 = [[0.3, 0.0], [0.0, 0.1]]
C.mean = [[0.1, 0.4], [-0.4, 0.1]]
[forcing]
Omega = 1.3
[[axis]]
name = "eta"
low = 0.0
high = 0.1
count = 9
[[axis]]
name = "gamma"
low = 0.8
high = 1.0
count = 7
"""
VEHICLE = Path(__file__).parents[1] / "examples" / "uniform.toml"


def found(record: Any, key: str) -> Any:
    for part in key.split("."):
        record = record[int(part)] if isinstance(record, list) else record[part]
    return record


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("own")


def written(place: Path, name: str, text: str, *words: str) -> Path:
    """The pages of a file's system, written once."""
    folder = place / name
    if not folder.exists():
        file = place / f"{name}.toml"
        file.write_text(text)
        assert main(["report", str(file), "--output", str(folder), *words]) == 0
    return folder


@pytest.fixture
def matrices(place: Path) -> Path:
    return written(place, "matrices", SYSTEM + AXES, "--set", "gamma=0.2", "--prove")


@pytest.fixture
def general(place: Path) -> Path:
    return written(place, "general", GENERAL)


@pytest.fixture
def vehicle(place: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """With less of everything: the whole study has tests of its own."""
    less = partial(study, closely=3, witness=1, more=3)
    monkeypatch.setattr(commands_report, "study", less)
    return written(place, "vehicle", VEHICLE.read_text())


@cache
def parsed(page: Path) -> Parsed:
    return Parsed(page.read_text(encoding="utf-8"))


def test_numbers_are_those_of_verify_system(matrices: Path, capsys: Any) -> None:
    words = ["system", str(matrices.with_suffix(".toml")), "--set", "gamma=0.2"]
    assert main([*words, "--format", "json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert json.loads((matrices / "system.json").read_text()) == record
    data = parsed(matrices / "index.html").data()
    assert {"T", "T_error", "difference", "bound"} <= set(data)
    for key, (value, _) in data.items():
        assert value == found(record, key), key
    cells = [cell.text for cell in parsed(matrices / "index.html").all("td")]
    assert cells.count(f"{record['T']:.9g}") == 2


def test_what_a_file_says_is_text_and_nothing_else(matrices: Path) -> None:
    """Its title is shown as it is written, on every page, and makes no element of its own."""
    for name in ("index.html", "chart.html"):
        page = parsed(matrices / name)
        assert len(page.all("script")) == 1
        assert all(image.attributes["src"] == "chart.svg" for image in page.all("img"))
        assert EVIL in page.all("header")[0].text
        assert EVIL in page.title
    assert b"<script" not in (matrices / "chart.svg").read_bytes()


def test_the_chart_is_of_the_axes_that_the_file_gives(matrices: Path) -> None:
    page = parsed(matrices / "chart.html")
    assert "31 x 21 points" in page.root.text
    assert any("31 x 21 points" in image.attributes["alt"] for image in page.all("img"))
    names = [row.all("th")[0].text for row in page.all("tbody")[0].all("tr")]
    assert names[0].startswith("2 ω")
    assert len((matrices / "tongues.csv").read_text().splitlines()) > 10


def test_without_axes_the_lowest_resonances_are_charted(place: Path) -> None:
    folder = written(place, "lowest", SYSTEM)
    names = [row.all("th")[0].text for row in parsed(folder / "chart.html").all("tr")[1:]]
    # frequencies 1 and 3^(1/2)
    assert {"2 ω(1)", "2 ω(2)"} <= set(names)


def test_a_damped_system_has_its_edges_where_they_are(matrices: Path) -> None:
    """cosh(pi eta/Omega), 1.0005 here: in words, for the line is a dot away from 1."""
    words = " ".join(svg.text for svg in parsed(matrices / "index.html").all("svg"))
    assert "between -1.00049 and 1.00049" in words


def test_a_proof_is_there_where_it_was_asked_for(matrices: Path, general: Path) -> None:
    assert "Balls that hold the true values" in parsed(matrices / "index.html").root.text
    assert "Balls that hold" not in parsed(general / "index.html").root.text


def test_a_general_equation_has_multipliers_and_no_z(general: Path) -> None:
    page = parsed(general / "index.html")
    titles = [title.text for title in page.all("title") if title.within("svg")]
    assert "Multipliers and the unit circle" in titles
    assert not [title for title in titles if title.startswith("P(z)")]
    record = json.loads((general / "system.json").read_text())
    table = next(t for t in page.all("table") if "modulus" in t.text)
    assert len(table.all("tbody")[0].all("tr")) == len(record["floquet"]["multipliers"])


def test_a_vehicle_has_its_resonances_in_its_own_units(vehicle: Path) -> None:
    record = json.loads((vehicle / "vehicle.json").read_text())
    index, listed = (parsed(vehicle / name) for name in ("index.html", "resonances.html"))
    assert "Hz" in index.root.text
    rows = listed.all("tbody")[0].all("tr")
    assert len(rows) == len(record["resonances"])
    for row, resonance in zip(rows, record["resonances"], strict=True):
        shown = row.all("data")[0]
        assert float(shown.attributes["value"]) == pytest.approx(resonance["frequency"], rel=1e-4)
    assert parsed(vehicle / "chart.html").all("img")


def test_every_link_leads_somewhere(matrices: Path, general: Path, vehicle: Path) -> None:
    for folder in (matrices, general, vehicle):
        titles = []
        for page in set(folder.glob("*.html")) - {folder / "explore.html"}:
            for reference in parsed(page).references:
                assert (
                    reference == "data:," or reference[0] == "#" or (folder / reference).is_file()
                )
            titles.append(parsed(page).title)
        assert len(titles) == len(set(titles)) > 1
        assert "explore.html" in parsed(folder / "chart.html").references


def test_in_a_browser_nothing_runs_that_is_not_ours(matrices: Path, browser: Browser) -> None:
    for width in (1280, 390):
        browser.look(width=width)
        for name in ("index.html", "chart.html"):
            browser.open(matrices / name)
            assert browser.complaints() == []
            assert browser.nameless() == []
            assert browser.run("return document.title") != "x"
            assert browser.run("return document.documentElement.scrollWidth") <= width


def test_the_chart_can_be_explored(matrices: Path, browser: Browser) -> None:
    """The page beside it: the title is text there too, and nothing is asked of a network."""
    browser.look()
    browser.open(matrices / "chart.html")
    browser.run("[...document.links].find(a => a.textContent === 'Explore it').click()")
    assert browser.run("return location.pathname").endswith("explore.html")
    assert browser.complaints() == []
    assert browser.run("return document.title").startswith(EVIL)
    assert browser.run("return document.images.length") == 0


def test_without_the_libraries_the_page_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("compare.pages.own_chart.find_spec", lambda _: None)
    folder = written(tmp_path, "plain", SYSTEM + AXES)
    text = parsed(folder / "chart.html").root.text
    assert "No picture: pictures need matplotlib" in text
    assert "Not to be explored: a page to explore needs Bokeh" in text
    assert "Explore it" not in text
    assert not (folder / "chart.svg").exists()
    assert not (folder / "explore.html").exists()
    assert not parsed(folder / "chart.html").all("img")


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["--set", "Omega=0"], "Omega"),
        (["--set", "k=2"], "k"),
        (["--draw"], "--draw"),
        (["--no-claims"], "--no-claims"),
        (["--figures", "."], "--figures"),
    ],
)
def test_what_is_refused(words: list[str], named: str, tmp_path: Path, capsys: Any) -> None:
    (tmp_path / "mine.toml").write_text(SYSTEM)
    place = tmp_path / "pages"
    line = refusal(["report", str(tmp_path / "mine.toml"), "--output", str(place), *words], capsys)
    assert named in line
    assert not place.exists()
