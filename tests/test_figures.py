"""The figures, through their data."""

from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from compare.figures.catalogue import FIGURES
from compare.figures.compute import compute, tasks
from compare.figures.data import FigureData, as_csv, from_csv
from compare.tables import rows
from hill import UniformBeam, characteristic

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)


@pytest.fixture(scope="module")
def eight() -> FigureData:
    return compute(8, detail=0.3)


def test_every_figure_of_results_is_there() -> None:
    assert sorted(FIGURES) == list(range(3, 30))
    everything = [n for group in tasks(tuple(FIGURES)) for n in group]
    assert sorted(everything) == sorted(FIGURES)


def test_routes_agree_where_the_marks_are(eight: FigureData) -> None:
    # T from P within 1e-12: 9e-11 where T is .007, the smallest marked
    assert 0.0 < eight.disagreement < 1e-9
    assert len(eight.select("mark")) >= 5


def test_damped_curve_is_the_undamped_less_eta(eight: FigureData) -> None:
    for damped in (s for s in eight.select("curve") if s.damped):
        plain = next(
            s for s in eight.select("curve", damped.panel) if s.name == damped.name and not s.damped
        )
        # eta^2/4 shifts the frequencies too, by 2.9e-4 of T at most (docs/claims.md, shift); a
        # straight line between the sparse points of this test adds a little at the top
        assert damped.y.max() == pytest.approx(plain.y.max() - 0.01, abs=5e-4)
        outside = (damped.x == damped.x.min()) | (damped.x == damped.x.max())
        assert np.allclose(damped.y[outside], -0.01, rtol=0, atol=1e-12)


def test_T_curves_are_half_circles(eight: FigureData) -> None:
    curve = next(s for s in eight.select("curve") if s.name == "2 omega_(2)" and not s.damped)
    inside = curve.y > 1e-3
    Omega_0 = 2.0 * BEAM.natural_frequencies()[2]
    radius = curve.y[inside].max()
    # a third of a percent of the radius is of second order in gamma
    assert np.abs(np.hypot(curve.x[inside] - Omega_0, curve.y[inside]) / radius - 1.0).max() < 0.02


def test_printed_points_stand_where_they_are_printed(eight: FigureData) -> None:
    shown = {
        (float(x), float(y)) for s in eight.select("printed") for x, y in zip(s.x, s.y, strict=True)
    }
    table = {(float(r.Omega_printed), r.T) for r in rows(1)}
    assert shown <= table
    assert len(shown) > 20


def test_frequencies_are_the_listing_s() -> None:
    data = compute(3, detail=0.3)
    own = [s for s in data.select("curve") if s.name.startswith("K_theta = 0.5,")]
    at_20 = sorted(float(np.interp(20.0, s.x, s.y)) for s in own)
    # FORMAT 1 of the uniform listing, to what a straight line between sparse points leaves
    assert at_20 == pytest.approx([0.191271, 0.909014, 2.501638], abs=2e-3)


def test_integral_of_figure_27_in_closed_form() -> None:
    data = compute(27, detail=0.3)
    for s in data.select("curve"):
        g = 0.04 if "0.04" in s.name else 0.0
        away = (s.x > 0.05) & (np.abs(s.x - 1.0) > 0.05) & (s.x < 1.95)
        nu = np.pi * np.sqrt(s.x[away] ** 2 - 1j * g)
        expected = np.real(np.tan(0.5 * nu) / nu)
        assert np.allclose(s.y[away], expected, rtol=1e-9, atol=1e-12)


def test_boundaries_of_figure_10_are_boundaries() -> None:
    data = compute(10, detail=0.2)
    checked = 0
    for s in data.select("region"):
        if s.y_upper is None or s.name not in ("2 omega_(2)", "omega_(1) + omega_(B)"):
            continue
        k = len(s.x) // 2
        gamma, low, high = s.x[k], s.y[k], s.y_upper[k]
        beyond = 0.05 * (high - low)
        assert not characteristic(BEAM.equation(0.5 * (low + high), gamma)).stable
        assert characteristic(BEAM.equation(low - beyond, gamma)).stable
        assert characteristic(BEAM.equation(high + beyond, gamma)).stable
        checked += 1
    assert checked >= 2


def test_csv_reads_back(eight: FigureData) -> None:
    again = from_csv(as_csv(eight))
    assert sum(len(s.x) for s in again) == sum(len(s.x) for s in eight.series)
    assert np.array_equal(again[0].x, eight.series[0].x)
    assert np.array_equal(again[0].y, eight.series[0].y)


def test_command_draws_and_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "plots"
    assert main(["figures", "27", "--output", str(folder), "--workers", "1"]) == 0
    assert "Figure 27" in capsys.readouterr().out
    assert (folder / "figure27.png").read_bytes().startswith(b"\x89PNG")
    assert (folder / "figure27.svg").read_bytes().startswith(b"<?xml")
    assert (folder / "figure27.csv").read_text().startswith("figure,panel")
    first = (folder / "figure27.svg").read_bytes()
    assert main(["figures", "27", "--output", str(folder), "--workers", "1"]) == 0
    assert (folder / "figure27.svg").read_bytes() == first
    for words, says in (
        (["2"], "figure = 2"),
        (["27", "--output", str(tmp_path / "a" / "b")], "no such directory"),
        (["27", "--workers", "0", "--output", str(folder)], "workers = 0"),
    ):
        capsys.readouterr()
        assert main(["figures", *words]) == 2
        captured = capsys.readouterr().err
        assert captured.count("\n") == 1
        assert says in captured
