"""Charts: the interpolated P(z), its error, its boundaries, its files, its refusals."""

import csv
import json
import tracemalloc
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import refusal

from compare.__main__ import main
from compare.charts import chebyshev, compute, cuts, grid, surface
from compare.charts.compute import chart
from compare.charts.nodes import NODES_PER_JOB
from compare.charts.result import Chart
from compare.charts.surface import evaluate
from compare.edges.on_chart import tongues
from floquet import monodromy
from floquet.weak_form import galerkin
from hill import SteppedBeam, UniformBeam, characteristic
from hill.averaging import half_width

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
WIDE = [("Omega", 0.35, 6.0, 300), ("gamma", 0.0, 0.5, 200)]


@pytest.fixture(scope="module")
def wide() -> Chart:
    return chart(BEAM, WIDE, route="floquet")


def test_series_reproduces_a_polynomial_exactly() -> None:
    x, y = chebyshev.lobatto(9), chebyshev.lobatto(5)
    f = lambda x, y: 1 + x**7 - 2 * x**3 * y**4 + y  # noqa: E731
    series = chebyshev.coefficients(f(*np.meshgrid(x, y, indexing="ij"))[None], (1, 2))
    at = np.random.default_rng(0).uniform(-1, 1, (2, 20))
    assert np.allclose(chebyshev.at_points(series, tuple(at))[0], f(*at), rtol=0, atol=1e-14)
    ((_, P),) = chebyshev.on_blocks(series, (at[0], at[1]), 1000)
    grid = f(*np.meshgrid(at[0], at[1], indexing="ij")).ravel()
    assert np.allclose(P, [np.ones(400), grid], rtol=0, atol=1e-14)


@pytest.mark.parametrize("counts", [(257, 301), (16, 1), (1000, 33), (2, 700), (35, 18, 33)])
def test_no_number_depends_on_the_blocks(counts: tuple[int, ...]) -> None:
    """Their ends fall where they may: BLAS rounds the last lines of a product otherwise."""
    degrees = (29, 13, 11)[: len(counts)]
    series = np.random.default_rng(4).normal(size=(3, *degrees))
    points = [np.linspace(-1.0, 1.0, k) for k in counts]

    def whole(most: int) -> Any:
        result = np.full((4, *counts), np.nan)
        for where, P in chebyshev.on_blocks(series, points, most):
            result[(slice(None), *where)] = P.reshape(result[(slice(None), *where)].shape)
        return result

    first = whole(10**9)
    mesh = [m.ravel() for m in np.meshgrid(*points, indexing="ij")]
    assert np.allclose(first[1:].reshape(3, -1), chebyshev.at_points(series, mesh), atol=1e-12)
    for most in (1, 700, 2000, 8192, 40_000):
        assert np.array_equal(first, whole(most))


def test_every_second_point_of_a_finer_set_is_there() -> None:
    assert np.allclose(chebyshev.lobatto(17)[::2], chebyshev.lobatto(9), rtol=0, atol=1e-16)


def test_interpolant_is_within_its_bound_of_either_route(wide: Chart) -> None:
    rng = np.random.default_rng(11)
    Omega, gamma = rng.uniform(0.35, 6.0, 60), rng.uniform(0.0, 0.5, 60)
    P, _ = evaluate(wide.surface, np.column_stack([1.0 / Omega, gamma]))
    for k in range(60):
        c = characteristic(BEAM.equation(Omega[k], gamma[k]))
        m = monodromy(galerkin(BEAM, Omega[k], gamma[k]))
        assert np.abs(P[:, k] - c.polynomial).max() <= wide.error + c.error
        assert np.abs(P[:, k] - m.polynomial).max() <= wide.error + m.error
    assert wide.checked <= wide.error
    assert wide.error < 1e-10
    # a million points from so few: what the chart is for
    assert wide.nodes < 2500


def test_a_series_that_misses_its_bound_is_no_chart(monkeypatch: pytest.MonkeyPatch) -> None:
    """A remainder that is not seen: nine points an axis are taken for enough."""
    monkeypatch.setattr(chebyshev, "decay", lambda series, axis: 1e-14)
    with pytest.raises(ValueError, match="tolerance: the series is off by"):
        chart(BEAM, WIDE, route="floquet")


def test_T_on_the_grid_is_T_of_the_equation(wide: Chart) -> None:
    x, y = (axis.points for axis in wide.axes)
    unstable = np.argwhere(wide.T > 1e-3)
    assert len(unstable) > 1000
    for j, i in unstable[:: len(unstable) // 25]:
        c = characteristic(BEAM.equation(x[i], y[j]))
        # P's bound of 1e-11 moves T by that over T; 1e-8 leaves a factor 1 for T = 1e-3
        assert wide.T[j, i] == pytest.approx(c.T, abs=1e-8)
    assert wide.T.shape == (200, 300)


def test_a_chart_of_other_blocks_is_the_same(wide: Chart, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grid, "BLOCK", 3000)
    other = chart(BEAM, WIDE, route="floquet")
    assert np.array_equal(other.T, wide.T)
    assert np.array_equal(other.verdict(), wide.verdict())


def test_memory_of_a_chart_is_that_of_its_result() -> None:
    """Never P of all points at once: it would take 32 bytes a point, and its temporaries more."""
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        found = chart(BEAM, [("Omega", 0.35, 6.0, 2000), ("gamma", 0.0, 0.5, 1500)], route="hill")
        at_T = tracemalloc.get_traced_memory()[1] - before
        tracemalloc.reset_peak()
        unstable = found.unstable()
        at_verdict = tracemalloc.get_traced_memory()[1] - before
    finally:
        tracemalloc.stop()
    size = found.T.size
    # beyond the result some 10 MB for nodes and blocks, 35 MB for discs about roots, however large
    assert at_T <= (8 + 8) * size
    # T, the verdicts' bytes, what was asked for
    assert at_verdict <= (8 + 1 + 1 + 16) * size
    assert unstable.any()


def test_damping_and_third_axis() -> None:
    cube = chart(
        BEAM,
        [("Omega", 1.1, 1.2, 6), ("gamma", 0.1, 0.2, 5), ("T0", 18.0, 20.0, 4)],
        forcing={"eta": 0.01},
        route="floquet",
        tolerance=1e-9,
    )
    assert cube.T.shape == (4, 5, 6)
    c = characteristic(UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5).equation(1.2, 0.2, 0.01))
    assert cube.T[-1, -1, -1] == pytest.approx(c.T, abs=1e-8)


def test_both_routes_sample_and_meet() -> None:
    small = chart(
        BEAM, [("Omega", 1.0, 1.1, 5), ("gamma", 0.0, 0.1, 5)], route="both", tolerance=1e-9
    )
    # the routes' own difference at single points, 1e-13 at most
    assert 0.0 < small.disagreement < 1e-12


def test_a_pole_of_the_axial_force_is_met_directly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cuts, "MAX_GRADED", 2)
    monkeypatch.setattr(surface, "MAX_POINTS", 33)
    soft = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=2.0)
    near = chart(
        soft, [("Omega", 1.98, 2.03, 6)], forcing={"gamma": 0.01}, route="floquet", tolerance=1e-4
    )
    assert near.direct > 0
    c = characteristic(soft.equation(1.98, 0.01))
    # P within 1e-4 leaves T, a root of it, 1e-2 of itself
    assert near.T[0] == pytest.approx(c.T, rel=0.02, abs=1e-2)
    # Omega = omega_L, the third point: the force is infinite, and so is T
    assert np.isinf(near.T[2])
    assert np.all(np.isfinite(np.delete(near.T, 2)))


def test_boundaries_are_boundaries(wide: Chart) -> None:
    found = tongues(wide, orders=1)
    names = [tongue.resonance.name for tongue in found]
    assert {"2 omega_(B)", "2 omega_(1)", "2 omega_(2)", "omega_(1) + omega_(B)"} <= set(names)
    tongue = found[names.index("2 omega_(2)")]
    for gamma in (0.05, 0.1, 0.3):
        low, high = tongue.at(gamma) or (0.0, 0.0)
        middle, beyond = 0.5 * (low + high), 0.02 * (high - low)
        assert monodromy(galerkin(BEAM, middle, gamma)).verdict == "unstable"
        for outside in (low - beyond, high + beyond):
            assert monodromy(galerkin(BEAM, outside, gamma)).stable
        for inside in (low + beyond, high - beyond):
            assert monodromy(galerkin(BEAM, inside, gamma)).verdict == "unstable"
    # first order in gamma: Hsu's width, the miss of second order
    low, high = tongue.at(0.0203125) or (0.0, 0.0)
    expected = half_width(tongue.resonance, BEAM.equation(5.0, 0.0203125))
    assert 0.5 * (high - low) == pytest.approx(expected, rel=0.02)


def interrupting(after: int) -> Callable[[Any, Iterable[Any]], Iterable[Any]]:
    """A map that is killed after some jobs."""
    done = 0

    def run(function: Callable[[Any], Any], jobs: Iterable[Any]) -> Iterable[Any]:
        nonlocal done
        for job in jobs:
            if done == after:
                raise KeyboardInterrupt
            done += 1
            yield function(job)

    return run


def test_an_interrupted_chart_resumes(tmp_path: Path) -> None:
    store = tmp_path / "nodes.npz"
    with pytest.raises(KeyboardInterrupt):
        chart(BEAM, WIDE, route="floquet", workers=interrupting(3), resume=store)
    assert [p.name for p in tmp_path.iterdir()] == ["nodes.npz"]
    again = chart(BEAM, WIDE, route="floquet", resume=store)
    assert again.resumed > 100
    fresh = chart(BEAM, WIDE, route="floquet")
    assert np.array_equal(again.T, fresh.T)
    # ... and a store of another chart is refused, as is any other file
    with pytest.raises(ValueError, match="another chart"):
        chart(BEAM, WIDE, route="hill", resume=store)
    store.write_text("something else")
    with pytest.raises(ValueError, match="not a file of finished nodes"):
        chart(BEAM, WIDE, route="floquet", resume=store)


def test_workers_change_nothing() -> None:
    # several jobs, which end in any order
    axes = [("Omega", 0.35, 3.0, 9), ("gamma", 0.0, 0.5, 9)]
    one, two = (chart(BEAM, axes, route="floquet", workers=n) for n in (1, 2))
    assert one.nodes > 2 * NODES_PER_JOB
    assert np.array_equal(one.T, two.T)
    assert np.array_equal(one.sampled, two.sampled)


@pytest.mark.parametrize(
    ("axes", "forcing", "says"),
    [
        ([("Omega", 1.0, 0.5, 5), ("gamma", 0, 1, 5)], {}, "must ascend"),
        ([("Omega", 0.0, 0.5, 5), ("gamma", 0, 1, 5)], {}, "greater than 0"),
        ([("Omega", 1.0, 2.0, 1), ("gamma", 0, 1, 5)], {}, "points of Omega = 1"),
        ([("omega", 1.0, 2.0, 5), ("gamma", 0, 1, 5)], {}, "axis = 'omega'"),
        ([("xi_c", 0.0, 1.0, 5), ("Omega", 1, 2, 5)], {"gamma": 0.1}, "axis = 'xi_c'"),
        ([("Omega", 1.0, 2.0, 5), ("Omega", 1, 2, 5)], {"gamma": 0.1}, "twice"),
        ([("Omega", 1.0, 2.0, 5)], {}, "gamma: has no value"),
        ([("xi_G", 0.5, 1.5, 5), ("Omega", 1, 2, 5)], {"gamma": 0.1}, "xi_G = 1.5"),
        ([("Omega", 1.0, 2.0, 5)], {"gamma": 0.1, "T0": 3.0}, "T0"),
    ],
)
def test_refusals(axes: list[Any], forcing: dict[str, float], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        chart(BEAM, axes, forcing=forcing)


def test_command_writes_each_kind(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["chart", "--x", "Omega", "0.95", "1.25", "30", "--y", "gamma", "0.1", "0.3", "20"]
    words += ["--route", "floquet", "--tolerance", "1e-9"]
    for suffix, starts in (
        (".png", b"\x89PNG"),
        (".svg", b"<?xml"),
        (".npz", b"PK"),
        (".csv", b'# {"schema": 1, "made_by": "floquet-crosscheck'),
    ):
        target = tmp_path / f"chart{suffix}"
        assert main([*words, "--output", str(target)]) == 0
        assert target.read_bytes().startswith(starts)
    out = capsys.readouterr().out
    assert "30 x 20 points" in out
    first, *rest = (tmp_path / "chart.csv").read_text().splitlines()
    about = json.loads(first.removeprefix("# "))
    assert about["system"] == "hill.beams.UniformBeam"
    assert about["parameters"]["T0"] == 20.0
    assert about["forcing"] == {"eta": 0.0}
    assert "omega_1" in about["units"]
    assert rest[0] == "Omega,gamma,T,T_error,verdict"
    lines = list(csv.DictReader(rest))
    assert len(lines) == 600
    with np.load(tmp_path / "chart.npz") as content:
        assert content["T"].shape == (20, 30)
        assert float(lines[-1]["T"]) == pytest.approx(content["T"][-1, -1], abs=1e-11)
        assert json.loads(str(content["provenance"])) == about
        assert content["T_error"].shape == content["verdict"].shape == (20, 30)


def test_command_reads_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "mine.toml"
    source.write_text(
        'kind = "stepped"\n[system]\nT0 = 10.0\nK_theta = 1.0\nxi_G = 0.5\nxi_c = 0.6\n'
        "area_ratio = 0.6\ninertia_ratio = 0.6\n[forcing]\ngamma = 0.1\n"
        '[[axis]]\nname = "Omega"\nlow = 1.0\nhigh = 1.4\ncount = 7\n'
        '[[axis]]\nname = "xi_G"\nlow = 0.4\nhigh = 0.6\ncount = 5\n'
    )
    assert (
        main(["chart", str(source), "--route", "floquet", "--output", str(tmp_path / "c.npz")]) == 0
    )
    beam = SteppedBeam(T0=10.0, K_theta=1.0, xi_G=0.6, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6)
    with np.load(tmp_path / "c.npz") as content:
        assert content["T"][-1, -1] == pytest.approx(
            max(characteristic(beam.equation(1.4, 0.1)).T, 0.0), abs=1e-8
        )


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--x", "Omega", "1", "2", "x", "--y", "gamma", "0", "1", "5"], "not a whole number"),
        (["--x", "Omega", "1", "two", "5", "--y", "gamma", "0", "1", "5"], "not a number"),
        (["--x", "Omega", "1", "2", "5", "--set", "gamma"], "NAME=VALUE"),
        (["--x", "Omega", "1", "2", "5", "--output", "a.doc"], "must end in"),
        (["nowhere.toml"], "cannot be read"),
        ([], "at least one parameter"),
    ],
)
def test_command_refuses(
    words: list[str],
    says: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    line = refusal(["chart", *words], capsys)
    assert line.startswith("verify chart: ")
    assert says in line


def test_what_has_no_series_says_why() -> None:
    """Over gamma up to 50 P grows to 1e15: nothing is interpolated, and nothing can be checked."""
    seen: list[tuple[str, int, int]] = []
    steep = chart(
        BEAM,
        [("Omega", 0.9, 1.3, 6), ("gamma", 0.0, 50.0, 6)],
        route="hill",
        stage=lambda *what: seen.append(what),
    )
    assert steep.one_by_one == {"P is too steep for a series": 36}
    assert (steep.checked, steep.checks) == (None, 0)
    assert steep.direct == 36
    # what is known of each point is its own
    assert np.all(steep.unstable()[1:])
    nodes = [(done, of) for what, done, of in seen if what == "nodes"]
    assert nodes[-1][0] == nodes[-1][1] == steep.nodes
    assert all(done <= of for done, of in nodes)
    shares = [done for what, done, _ in seen if what != "nodes"]
    assert shares == sorted(shares)
    assert shares[-1] == 1000


def test_too_many_points_without_a_series_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compute, "MAX_DIRECT", 30)
    axes = [("Omega", 0.9, 1.3, 6), ("gamma", 0.0, 50.0, 6)]
    with pytest.raises(ValueError, match=r"axes: 36 points have no series \(P is too steep"):
        chart(BEAM, axes, route="hill")


def test_undecided_points_of_the_report_s_chart_are_few() -> None:
    """The series leaves 128 of a million undecided; asked again, the route itself leaves 4."""
    report = chart(BEAM, [("Omega", 0.35, 6.0, 1000), ("gamma", 0.0, 0.5, 1000)], route="floquet")
    assert report.undecided().sum() <= 10


def test_no_more_nodes_than_points_are_spent_where_all_is_steep() -> None:
    """P grows by powers of ten along gamma: no series is found, and not looked for in vain."""
    c = chart(BEAM, [("Omega", 0.9, 1.3, 8), ("gamma", 0.0, 50.0, 8)], route="hill")
    assert set(c.one_by_one) == {surface.STEEP}
    # a rectangle's nodes are begun before the points are passed
    assert c.surface.nodes <= 64 + 81
    assert c.nodes == c.surface.nodes + 64
