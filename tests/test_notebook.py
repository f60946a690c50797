"""Results as a notebook shows them: their own numbers, escaped, with a picture if there can be."""

import base64
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from pages_html import Parsed

from compare import Chart, CrossCheck, Report, chart, crosscheck, verify
from floquet import monodromy
from hill import MatrixSystem, UniformBeam, characteristic
from hill.notebook import LISTED, paragraphs, table

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=2)
EQUATION = BEAM.equation(Omega=1.1, gamma=0.1)
EVIL = "<script>alert(1)</script>"


@cache
def charted(axes: int = 2) -> Chart:
    wanted = [("Omega", 1.0, 1.2, 21), ("gamma", 0.05, 0.2, 11), ("eta", 0.0, 0.01, 3)]
    fixed = {"gamma": 0.1, "eta": 0.0}
    left = [name for name, *_ in wanted[axes:]]
    return chart(BEAM, wanted[:axes], forcing={name: fixed[name] for name in left})


@cache
def report() -> Report:
    return verify(rows=["T1-07", "T1-12"])


def cells(html: str) -> dict[str, list[str]]:
    """The rows of the first table by their heads."""
    rows = Parsed(html).all("tbody")[0].all("tr")
    return {row.all("th")[0].text: [cell.text for cell in row.all("td")] for row in rows}


@pytest.mark.parametrize("solve", [characteristic, monodromy])
def test_a_route_shows_its_numbers_and_their_bounds(solve: object) -> None:
    result = solve(EQUATION)  # type: ignore[operator]
    found = cells(result._repr_html_())
    assert found["verdict"] == [result.verdict, ""]
    assert found["T"] == [f"{result.T:.9g}", f"{result.T_error:.0e}"]
    assert [found[f"P, z^{k}"][0] for k in (2, 1, 0)] == [
        f"{p:.12g}" for p in result.polynomial[1:]
    ]
    assert found["P, z^0"][1] == f"{result.errors[-1]:.0e}"
    assert complex(found["z_1"][0].replace(" ", "").replace("i", "j")) == pytest.approx(
        complex(result.z[0]), rel=1e-8
    )


def test_of_many_coordinates_the_first_are_listed() -> None:
    n = 12
    F = np.diag(np.arange(1.0, n + 1.0) ** 2)
    result = characteristic(MatrixSystem(F, np.eye(n)).equation(Omega=5.0, gamma=0.01))
    html = result._repr_html_()
    assert len([head for head in cells(html) if head.startswith("P, ")]) == LISTED
    assert f"{n - LISTED} more coefficients and roots." in Parsed(html).root.text


def test_a_remark_is_told() -> None:
    told = replace(characteristic(EQUATION), remark="T is known to four digits")
    assert "T is known to four digits." in Parsed(told._repr_html_()).root.text


def test_a_crosscheck_shows_both_routes() -> None:
    x: CrossCheck = crosscheck(EQUATION)
    page = Parsed(x._repr_html_())
    assert [head.text for head in page.all("thead")[0].all("th")] == ["", "Hill", "Floquet"]
    assert cells(x._repr_html_())["T"] == [f"{x.hill.T:.9g}", f"{x.floquet.T:.9g}"]
    assert "The routes agree" in page.root.text
    assert "DISAGREE" in Parsed(replace(x, routes_agree=False)._repr_html_()).root.text


def test_a_report_shows_its_rows() -> None:
    found = cells(report()._repr_html_())
    assert list(found) == ["T1-07", "T1-12"]
    assert found["T1-07"][-1] == "-> STABLE"
    text = Parsed(report()._repr_html_()).root.text
    for line in report().summary.lines:
        assert line in text


def test_a_chart_of_two_axes_shows_its_picture() -> None:
    page = Parsed(charted()._repr_html_())
    (image,) = page.all("img")
    kind, _, data = image.attributes["src"].partition(",")
    assert kind == "data:image/png;base64"
    assert base64.b64decode(data).startswith(b"\x89PNG")
    assert "Omega and gamma" in image.attributes["alt"]
    assert "21 x 11 points" in page.root.text


def test_a_chart_of_one_axis_shows_a_curve() -> None:
    (image,) = Parsed(charted(1)._repr_html_()).all("img")
    assert image.attributes["alt"].startswith("T over Omega,")


def test_without_a_picture_words_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not Parsed(charted(3)._repr_html_()).all("img")
    monkeypatch.setattr("compare.notebook.find_spec", lambda _: None)
    page = Parsed(charted()._repr_html_())
    assert not page.all("img")
    assert "21 x 11 points" in page.root.text


def test_everything_is_escaped() -> None:
    named = replace(charted(), scenario=replace(charted().scenario, forcing={"eta": 0.0}))
    evil = replace(report().publication, title=EVIL)
    shown = (
        table(EVIL, [(EVIL, EVIL)], (EVIL, EVIL)),
        paragraphs([EVIL]),
        replace(crosscheck(EQUATION), remark=EVIL)._repr_html_(),
        replace(characteristic(EQUATION), remark=EVIL)._repr_html_(),
        replace(report(), publication=evil)._repr_html_(),
        replace(named, one_by_one={EVIL: 3})._repr_html_(),
    )
    for html in shown:
        assert "<script" not in html
        assert EVIL in Parsed(html).root.text
