"""A study's chart: what it holds, that its axis is in cycles, and what is refused."""

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare import crosscheck
from compare.__main__ import main
from compare.chart_ticks import ticks_in_cycles
from compare.edges.tongue import RANGE, TIP
from compare.vehicle import charted as module
from compare.vehicle.charted import charted
from compare.vehicle.study import Study, study
from hill import Damping, Vehicle
from hill.system import with_damping_apart

pytest.importorskip("skfem")
matplotlib = pytest.importorskip("matplotlib")

EXAMPLES = Path(__file__).parent.parent / "examples"
UNIFORM = str(EXAMPLES / "uniform.toml")


@pytest.fixture(autouse=True)
def few_points(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "COUNTS", (60, 30))


def test_the_chart_is_the_vehicles_own() -> None:
    """Its own damping counts, though a chart takes it from the forcing."""
    v = Vehicle.from_file(UNIFORM)
    found = study(v, gamma=0.15, Omega=2.0 * pi, span=(6.0, 8.0), orders=1, witness=0, more=3)
    made, edges = charted(found, lambda *_: None)
    Omega, gamma = made.axes
    assert (Omega.low, Omega.high) == (6.0, 8.0)
    assert gamma.high == pytest.approx(0.45)
    assert made.routes_agree
    unstable = np.argwhere(made.unstable())
    assert len(unstable)
    for k, j in (unstable[0], unstable[-1], (0, 0)):
        at = {"Omega": Omega.points[j], "gamma": gamma.points[k]}
        x = crosscheck(v, **at)
        assert made.T[k, j] == pytest.approx(x.T, abs=1e-8)
        assert made.verdict()[k, j] == x.verdict
    (own,) = (e for e in edges if e.resonance.name == "omega_(1) + omega_(B)")
    row = next(r for r in found.rows if r.resonance == own.resonance)
    # between a tongue's points it is interpolated
    assert own.at(0.15) == pytest.approx(row.band.edges, abs=0.01 * row.band.width)
    assert row.critical == pytest.approx(float(own.y[0]), rel=1e-3)


@pytest.fixture(scope="module")
def fed_back() -> tuple[Vehicle, Study]:
    """Rate feedback: the damping pulsates, and P is one of the multipliers."""
    v = replace(Vehicle.from_file(EXAMPLES / "three_stage.toml"), modes=2)
    return v, study(v, gamma=0.1, Omega=10.8, orders=1, witness=0, more=3)


def test_a_general_vehicles_chart_is_the_time_domains_and_its_tongues_the_bands(
    fed_back: tuple[Vehicle, Study], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "COUNTS_GENERAL", (40, 20))
    v, found = fed_back
    stages: list[str] = []
    made, edges = charted(found, lambda name, *_: stages.append(name))
    assert (made.route, made.T.shape) == ("floquet", (20, 40))
    assert {"nodes", "tongues"} <= set(stages)
    names = [e.resonance.name for e in edges]
    assert names == [r.resonance.name for r in found.rows if r.critical and r.critical < 0.3]
    # the picture reaches as far as these and the operating point do
    Omega = made.axes[0]
    low, high = (f(e.lower[0] for e in edges) for f in (min, max))
    assert Omega.low == pytest.approx(0.8 * low, rel=1e-3)
    assert Omega.high == pytest.approx(max(high, 10.8) / 0.8, rel=1e-3)
    for tongue in edges:
        row = next(r for r in found.rows if r.resonance == tongue.resonance)
        assert (tongue.begins, tongue.ends) == (TIP, RANGE)
        assert tongue.y[0] == pytest.approx(row.critical)
        assert tongue.lower[0] == tongue.upper[0]
        for k in (10, -1):
            low, high = tongue.lower[k], tongue.upper[k]
            step = 0.02 * (high - low)
            for at, verdict in ((low, "stable"), (high, "stable"), (low, "unstable")):
                off = step if verdict == "unstable" else -step if at == low else step
                x = crosscheck(v, Omega=at + off, gamma=float(tongue.y[k]))
                assert (x.verdict, x.routes_agree) == (verdict, True)


def test_a_range_that_is_asked_for_is_drawn_whole(
    fed_back: tuple[Vehicle, Study], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "COUNTS_GENERAL", (20, 10))
    found = study(fed_back[0], gamma=0.1, span=(9.0, 20.0), orders=1, witness=0, more=3)
    made, _ = charted(found, lambda *_: None)
    assert (made.axes[0].low, made.axes[0].high) == (9.0, 20.0)


@pytest.mark.parametrize("x", ["Omega", "gamma"])
def test_ticks_are_round_in_cycles(x: str) -> None:
    from matplotlib.figure import Figure

    axes = Figure().add_subplot()
    (axes.set_xlim if x == "Omega" else axes.set_ylim)(2.0 * pi * 0.13, 2.0 * pi * 5.4)
    ticks_in_cycles(axes, x, "pulsation, Hz")
    axis = axes.xaxis if x == "Omega" else axes.yaxis
    labels = [label.get_text() for label in axis.get_ticklabels()]
    assert labels[:3] == ["1", "2", "3"] or labels[:3] == ["0.5", "1", "1.5"]
    assert axis.get_majorticklocs() == pytest.approx([2.0 * pi * float(t) for t in labels])
    assert axis.get_label_text() == "pulsation, Hz"


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_the_command_draws_it(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"chart.{kind}"
    words = ["vehicle", UNIFORM, "--range", "0.9", "1.3", "--order", "1", "--both", "0"]
    assert main([*words, "--more-modes", "3", "--chart", str(path)]) == 0
    start = path.read_bytes()[:8]
    assert start == b"\x89PNG\r\n\x1a\n" if kind == "png" else start.startswith(b"<?xml")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([UNIFORM, "--chart", "c.doc"], "--chart c.doc: must end in .png, .svg, .pdf, .html"),
        ([UNIFORM, "--chart", "gone/c.png"], "cannot be written"),
        ([UNIFORM, "--chart", "c.png", "--set", "gamma=0"], "gamma = 0: must not be 0"),
        ([UNIFORM, "--chart", "c.png", "--output", "c.png"], "c.png"),
    ],
)
def test_refused_before_the_work(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str], monkeypatch: Any
) -> None:
    monkeypatch.setattr("compare.commands.vehicle.study", None)
    assert main(["vehicle", *words]) == 2
    caught = capsys.readouterr()
    assert caught.out == ""
    assert message in caught.err
    assert len(caught.err.strip().splitlines()) == 1


def test_a_general_vehicle_is_not_refused(monkeypatch: Any, tmp_path: Path) -> None:
    """Rates, modal damping and a servo make a general equation, and that has charts too."""
    reached = []
    monkeypatch.setattr("compare.commands.vehicle.study", lambda *_, **__: reached.append(True))
    words = ["vehicle", str(EXAMPLES / "three_stage.toml"), "--chart", str(tmp_path / "c.png")]
    monkeypatch.setattr("compare.commands.vehicle.drawn", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        main(words)
    assert reached


def test_damping_of_its_own_is_moved_to_the_forcing() -> None:
    v = Vehicle.from_file(UNIFORM)
    system, eta = with_damping_apart(v, 0.01)
    assert system.damping == Damping()
    assert eta == 0.01 + v.damping.eta
