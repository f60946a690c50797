"""Certified charts: cells proven, against the points' own verdicts and the boundaries traced."""

import csv
import io
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare import boundaries, chart, chart_files
from compare.__main__ import main
from compare.chart_text import describe
from compare.charts.certified import _edges
from compare.charts.result import Chart
from hill import MatrixSystem, SteppedBeam, UniformBeam

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
AXES = [("Omega", 2.5, 2.85, 36), ("gamma", 0.0, 0.3, 21)]


@pytest.fixture(scope="module")
def wide() -> Chart:
    """About omega_(2) + omega_(B)."""
    return chart(BEAM, AXES, route="floquet", certify=True)


def test_every_point_has_the_verdict_of_its_cell(wide: Chart) -> None:
    found = wide.certified
    assert found is not None
    assert found.cells.shape == wide.T.shape == (21, 36)
    assert wide.contradicted == 0
    assert {"stable", "unstable", "undecided"} == set(found.cells.ravel())
    assert found.stable + found.unstable + found.undecided == pytest.approx(1.0)
    assert 0.0 < found.undecided < 0.02
    assert found.whole == np.mean(found.cells != "undecided") > 0.85
    assert found.decimals


def test_no_cell_is_proven_across_a_boundary(wide: Chart) -> None:
    """Of the curves that the chart's own series is zero on."""
    assert wide.certified is not None
    x, y = wide.axes
    across, up = ([float(edge) for edge in _edges(axis)] for axis in (x, y))
    seen = 0
    for curve in boundaries(wide):
        for a, b in zip(curve.x, curve.y, strict=True):
            # inside of a cell, not on its edge
            k, i = np.searchsorted(across, a) - 1, np.searchsorted(up, b) - 1
            if min(abs(a - e) for e in across) > 1e-6 and min(abs(b - e) for e in up) > 1e-6:
                assert wide.certified.cells[i, k] == "undecided", (a, b)
                seen += 1
    assert seen > 50


def test_a_contradiction_is_counted_and_told(wide: Chart) -> None:
    assert wide.certified is not None
    cells = wide.certified.cells.copy()
    cells[tuple(np.argwhere(cells == "stable")[0])] = "unstable"
    wrong = replace(wide, certified=replace(wide.certified, cells=cells))
    assert wrong.contradicted == 1
    assert "1 verdicts CONTRADICT it." in describe(wrong)[-1]
    assert "no verdict contradicts it." in describe(wide)[-1]


def test_files_have_it(wide: Chart) -> None:
    assert wide.certified is not None
    cells = wide.certified.cells
    with np.load(io.BytesIO(chart_files.npz(wide))) as held:
        assert np.all(held["certified"] == cells)
    content = json.loads(chart_files.as_json(wide))
    assert content["cells"] == cells.tolist()
    assert content["certified"]["area"]["stable"] == wide.certified.stable
    assert content["certified"]["contradicted"] == 0
    lines = chart_files.as_csv(wide).decode().splitlines()
    rows = list(csv.DictReader(lines[1:]))
    assert [row["certified"] for row in rows] == cells.T.ravel().tolist()
    assert [row["verdict"] for row in rows] == wide.verdict().T.ravel().tolist()
    plain = replace(wide, certified=None)
    assert "certified" not in json.loads(chart_files.as_json(plain))
    assert "certified" not in chart_files.as_csv(plain).decode()


def test_axes_the_other_way_and_another_map_change_nothing() -> None:
    small = [("Omega", 2.6, 2.8, 9), ("gamma", 0.05, 0.2, 6)]

    def backwards(job: Any, jobs: Any) -> list[Any]:
        return [job(one) for one in list(jobs)[::-1]][::-1]

    one, other = (
        chart(BEAM, axes, route="floquet", certify=True, workers=run)
        for axes, run in ((small, 1), (small[::-1], backwards))
    )
    assert one.certified is not None
    assert other.certified is not None
    assert np.all(one.certified.cells == other.certified.cells.T)
    assert one.certified.stable == pytest.approx(other.certified.stable, rel=1e-13)


def test_other_systems_by_their_floats() -> None:
    """Two coordinates about 2 omega_1; the stepped beam by its decimals."""
    mine = MatrixSystem(F=[[1.0, 0.2], [0.2, 4.0]], G=[[1.0, 0.3], [0.3, 1.0]])
    axes = [("Omega", 1.6, 2.4, 17), ("gamma", 0.0, 0.4, 9)]
    damped = chart(mine, axes, route="floquet", certify=True, forcing={"eta": 0.02})
    assert damped.certified is not None
    assert not damped.certified.decimals
    assert damped.contradicted == 0
    assert damped.certified.undecided < 0.02
    assert {"stable", "unstable"} <= set(damped.certified.cells.ravel())

    stepped = SteppedBeam(T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6,
                          inertia_ratio=0.6)  # fmt: skip
    axes = [("Omega", 2.6, 2.7, 6), ("gamma", 0.05, 0.15, 5)]
    found = chart(stepped, axes, route="floquet", certify=True)
    assert found.certified is not None
    assert found.certified.decimals
    assert found.contradicted == 0
    assert {"stable", "unstable"} <= set(found.certified.cells.ravel())


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["--y", "T0", "1", "2", "3", "--set", "gamma=0.1"], "chart of Omega and gamma"),
        (["--y", "gamma", "0", "0.1", "3", "--set", "omega_L=3"], "omega_L = 3: must be infinite"),
        (["--y", "gamma", "0", "0.1", "3", "--set", "T0=30"], "real, positive eigenvalues"),
        (["--y", "gamma", "0", "0.1", "3000000"], "6,000,000 cells"),
    ],
)
def test_refusals(given: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chart", "--x", "Omega", "1.1", "1.2", "2", *given, "--certify"]) == 2
    told = capsys.readouterr().err
    assert words in told
    assert len(told.splitlines()) == 1


def test_without_the_extra_one_line_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("floquet.enclosure.find_spec", lambda name: None)
    words = ["chart", "--x", "Omega", "1.1", "1.2", "3", "--y", "gamma", "0", "0.1", "3"]
    assert main([*words, "--certify"]) == 2
    assert "floquet-crosscheck[proof]" in capsys.readouterr().err


def test_the_command_says_what_is_proven(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["chart", "--x", "Omega", "2.6", "2.8", "9", "--y", "gamma", "0.05", "0.2", "6"]
    written = tmp_path / "c.png"
    assert main([*words, "--certify", "--route", "floquet", "--output", str(written)]) == 0
    assert "of the 54 cells as a whole" in capsys.readouterr().out
    assert written.stat().st_size > 10_000
