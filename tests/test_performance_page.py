"""docs/performance.md is what benchmarks/results/ says; the arithmetic between them."""

import copy
import json
import platform
import re
import sys
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
# last, so that what is installed comes before what lies beside it
sys.path.append(str(ROOT))

claims = import_module("benchmarks.claims")
compete = import_module("benchmarks.compete")
general = import_module("benchmarks.general")
limits = import_module("benchmarks.limits")
machine = import_module("benchmarks.machine")
measure = import_module("benchmarks.measure")
page = import_module("benchmarks.page")
peers = import_module("benchmarks.peers")
plots = import_module("benchmarks.plots")
reduction = import_module("benchmarks.reduction")
systems = import_module("benchmarks.systems")
text = import_module("benchmarks.text")

RUNS = page.read()
RESULTS = RUNS[0]


# ---- the page ------------------------------------------------------------------------------------


def test_page_is_up_to_date() -> None:
    """If not: python -m benchmarks.page."""
    assert page.page(*RUNS) == page.PAGE.read_text(encoding="utf-8")
    assert page.PAGE == ROOT / "docs" / "performance.md"


@pytest.fixture(scope="module")
def figures() -> dict[str, bytes]:
    return plots.figures(RESULTS)


def test_page_shows_every_figure_there_is(figures: dict[str, bytes]) -> None:
    linked = set(re.findall(r"\((performance-[\w-]+\.svg)\)", page.page(RESULTS)))
    assert linked == set(figures)
    for name in linked:
        assert (page.PAGE.parent / name).exists()


def test_figures_are_the_same_every_time(figures: dict[str, bytes]) -> None:
    assert plots.figures(RESULTS) == figures
    for content in figures.values():
        assert ElementTree.fromstring(content).tag.endswith("svg")


def test_without_a_reference_there_is_no_figure_of_errors() -> None:
    curves = copy.deepcopy(RESULTS["tolerance"]["curves"])
    for curve in curves.values():
        for point in curve:
            point["error"] = None
    part = {key: RESULTS[key] for key in page.KEYS} | {"tolerance": {"curves": curves}}
    assert plots.figures(part) == {}
    assert "(-)" in page.page(part)
    assert ".svg" not in page.page(part)


def test_figures_show_the_numbers() -> None:
    points = [{"points": 10, "modes": 2, "seconds": [1e-6, 3e-6, 2e-6], "error": 1e-9}]
    points += [{"points": 100, "modes": 3, "seconds": [4e-6], "error": None}]
    assert plots.curve("number", points) == ([10, 100], [2.0, 4.0])
    assert plots.curve("modes", points) == ([2, 3], [2.0, 4.0])
    # an error that was not measured has no place
    assert plots.curve("tolerance", points) == ([2.0], [1e-9])


def test_every_contender_has_a_look_of_its_own() -> None:
    for section in plots.LABELS:
        if section in RESULTS:
            names = list(RESULTS[section]["curves"])
            looks = [plots.look(name) for name in names]
            assert len(set(looks)) == len(names)


def test_command_writes_page_and_figures(
    figures: dict[str, bytes],
    tmp_path: Path,
    capsys: pytest.CaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(page, "figures", lambda _: figures)
    target = tmp_path / "performance.md"
    page.main([str(page.RESULTS), "--output", str(target)])
    assert target.read_text(encoding="utf-8") == page.page(*RUNS)
    assert {p.name: p.read_bytes() for p in tmp_path.glob("performance-*.svg")} == figures
    assert len(capsys.readouterr().out.splitlines()) == 1 + len(figures) * len(RUNS)


def test_a_part_of_a_run_says_what_is_not_there() -> None:
    part = {key: RESULTS[key] for key in (*page.KEYS, "verify")}
    written = page.page(part | {"missing": {"heyoka": "not installed"}})
    assert "Not measured in this run: contenders, chart, number" in written
    assert "- heyoka: not installed" in written
    assert "LSODA" not in written


def test_two_widths_stand_side_by_side() -> None:
    other = copy.deepcopy(RESULTS)
    other["machine"]["vectors"] = "sse2"
    for entry in other["chart"]["lines"]:
        if entry["name"].startswith("chart"):  # ours ten times slower there
            entry["seconds"] = [10.0 * s for s in entry["seconds"]]
    written = page.page(RESULTS, other)
    assert [line for line in written.splitlines() if re.match("## [A-Z]+.*vector", line)] == [
        "## AVX-512, 8 numbers in a vector",
        "## SSE2, 2 numbers in a vector",
    ]
    (row,) = (line for line in written.splitlines() if line.startswith("| chart of 1e6 points at")
              and "than heyoka" in line)  # fmt: skip
    wide, narrow = (float(cell.split()[-1]) for cell in row.strip("| ").split(" | ")[1:])
    assert narrow == pytest.approx(0.1 * wide, rel=0.05)
    assert "(performance-avx512-number.svg)" in written
    assert "(performance-sse2-number.svg)" in written


def test_a_run_replaces_its_own_and_no_other(tmp_path: Path) -> None:
    for name in ("sse2", "avx512"):
        of = copy.deepcopy(RESULTS)
        of["machine"]["vectors"] = name
        (tmp_path / f"{name}.json").write_text(json.dumps(of), encoding="utf-8")
    assert [of["machine"]["vectors"] for of in page.read(tmp_path)] == ["avx512", "sse2"]
    assert machine.vectors() in machine.VECTORS
    with pytest.raises(ValueError, match="vectors = None: must be one of avx512, avx2"):
        page.check(without("machine", "vectors"))


# ---- the results ---------------------------------------------------------------------------------


def test_results_say_nothing_of_whose_machine_it_was() -> None:
    content = "".join(p.read_text(encoding="utf-8") for p in page.RESULTS.iterdir())
    assert str(Path.home()) not in content
    assert str(ROOT) not in content
    assert platform.node() == "" or platform.node() not in content
    assert set(RESULTS["machine"]) == {
        *("processor", "vectors", "cores", "system", "python", "threads", "versions")
    }


def test_every_contender_computed_the_same_thing() -> None:
    """A contender that solves another problem would be quick, too."""
    for entry in RESULTS["contenders"]["lines"]:
        # the loosest is SUNDIALS' BDF at 1e-12: 4e-9; a wrong equation gives 0.1 and more
        assert entry["error"] < 1e-7
        assert entry["error_median"] <= entry["error"]
    assert RESULTS["contenders"]["reference"]["digits"] >= 30


def without(*keys: str) -> dict[str, Any]:
    broken = copy.deepcopy(RESULTS)
    where = broken
    for key in keys[:-1]:
        where = where[key]
    del where[keys[-1]]
    return broken


@pytest.mark.parametrize("key", page.KEYS)
def test_refuses_what_lacks_a_key(key: str) -> None:
    with pytest.raises(ValueError, match=f"must have '{key}'"):
        page.check(without(key))


def test_refuses_another_schema_and_other_sections() -> None:
    with pytest.raises(ValueError, match="schema = 0: must be 1"):
        page.page(RESULTS | {"schema": 0})
    with pytest.raises(ValueError, match="'chrat' must be one of contenders, chart"):
        page.page(RESULTS | {"chrat": {}})


@pytest.mark.parametrize("seconds", [[], [1.0, 0.0], [float("nan")], [-1.0]], ids=str)
@pytest.mark.parametrize("section", ["contenders", "chart", "number", "single"])
def test_refuses_times_that_are_none(section: str, seconds: list[float]) -> None:
    broken = copy.deepcopy(RESULTS)
    if section == "number":
        broken["number"]["curves"]["chart"][0]["seconds"] = seconds
    elif section == "single":
        broken["contenders"]["single"][0]["lines"][0]["seconds"] = seconds
    else:
        broken[section]["lines"][0]["seconds"] = seconds
    with pytest.raises(ValueError, match="seconds must be positive"):
        page.page(broken)


# ---- times ---------------------------------------------------------------------------------------


def test_spread_of_known_numbers() -> None:
    assert measure.spread([5.0, 1.0, 4.0, 2.0, 3.0]) == measure.Spread(1.0, 2.0, 3.0, 4.0, 5.0)
    assert measure.spread([7.0]) == measure.Spread(7.0, 7.0, 7.0, 7.0, 7.0)
    with pytest.raises(ValueError, match="at least one"):
        measure.spread([])


def test_ratios_are_taken_round_by_round() -> None:
    # the machine was ten times slower in the second round: the ratios do not see it
    assert measure.ratios([2.0, 30.0, 4.0], [1.0, 10.0, 1.0]) == measure.spread([2.0, 3.0, 4.0])
    with pytest.raises(ValueError, match="2 of theirs, 1 of ours"):
        measure.ratios([1.0, 2.0], [1.0])


def test_rounds_are_interleaved(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    monkeypatch.setattr(measure, "timed", lambda job: job() or float(len(done)))
    jobs = {name: lambda name=name: done.append(name) for name in "abcd"}
    seconds = measure.rounds(jobs, 6, seed=1)
    orders = ["".join(done[k : k + 4]) for k in range(0, 24, 4)]
    assert len(done) == 24
    assert {"".join(sorted(order)) for order in orders} == {"abcd"}
    assert len(set(orders)) > 1
    assert seconds["a"] == [float(k + 1) for k, name in enumerate(done) if name == "a"]


def test_short_calls_are_repeated() -> None:
    calls: list[int] = []
    # 10 ms are filled; a call takes a fraction of a microsecond
    assert 0.0 < measure.timed(lambda: calls.append(1)) < measure.LEAST
    assert len(calls) > 10


@pytest.mark.parametrize(("target", "count"), [(0.9, 8), (16.0, 16), (33.0, 32), (1e9, 100)])
def test_sample_fills_its_target(
    target: float, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(measure, "timed", lambda job: job())
    assert measure.sample(lambda k: float(k), target, most=100) == count


# ---- claims --------------------------------------------------------------------------------------


def chart_results(heyoka: float, LSODA: float, error: float) -> dict[str, Any]:
    def line(name: str, seconds: float, error: float) -> dict[str, Any]:
        return {"name": name, "seconds": [seconds, seconds], "error": error}

    lines = [
        line("chart, floquet", 1.0, 1e-13),
        line("heyoka batch of 8", heyoka, 1e-15),
        line("SciPy LSODA", LSODA, error),
        line("SciPy LSODA, tight", 5000.0, 1e-12),
    ]
    return {"points": 10**6, "tolerance": 1e-10, "lines": lines}


@pytest.mark.parametrize(("heyoka", "verdict"), [(39.9, "does not hold"), (40.1, "holds")])
def test_chart_claims_follow_the_ratio(heyoka: float, verdict: str) -> None:
    first, second = claims.chart(chart_results(heyoka, 999.0, 1e-11))
    assert first.startswith(f"- **{verdict}**")
    assert second.startswith("- **does not hold**")


def test_inaccurate_rivals_do_not_count() -> None:
    _, second = claims.chart(chart_results(30.0, 999.0, 1e-9))
    assert second.startswith("- **holds**")
    assert "5,000 (5,000 to 5,000) times (SciPy LSODA, tight" in second
    assert "the quickest of those as accurate" in second
    assert second.endswith("; SciPy LSODA 1,000.")


def test_unknown_accuracy_is_not_claimed() -> None:
    found = chart_results(30.0, 2000.0, 1e-11)
    for line in found["lines"]:
        line["error"] = None
    assert "error -, the quickest, accurate or not" in claims.chart(found)[1]


def test_both_routes_are_set_against_the_same_rival() -> None:
    found = chart_results(30.0, 2000.0, 1e-11)
    found["lines"].append({"name": "chart, both", "seconds": [2.0, 2.0], "error": 1e-13})
    assert "; the chart by both routes 15." in claims.chart(found)[0]


def test_missing_rivals_are_named() -> None:
    found = chart_results(30.0, 2000.0, 1e-11)
    found["lines"] = [line for line in found["lines"] if "heyoka" not in line["name"]]
    assert claims.chart(found)[0] == "- **not measured**: chart of 1e6 points against heyoka."


@pytest.mark.parametrize("slower", [False, True])
def test_batch_claim_and_its_reason_where_it_fails(slower: bool) -> None:
    def line(name: str, seconds: float) -> dict[str, Any]:
        return {"name": name, "seconds": [seconds], "error": 1e-15, "ours": "floquet" in name}

    mine = 3.0 if slower else 1.0
    lines = [line("floquet batch", mine), line("floquet", 0.1), line("heyoka batch of 4", 4.0)]
    found = claims.batch([*lines, line("heyoka batch of 8", 2.0)])
    assert found[0].startswith("- **does not hold**" if slower else "- **holds**")
    assert ("1.5 (1.5 to 1.5)" if slower else "0.5 (0.5 to 0.5)") in found[0]
    part = {"contenders": {"lines": [*lines, line("heyoka batch of 8", 2.0)]}}
    assert (claims.REASON in claims.section(part)) == slower


def test_modes_where_heyoka_is_quicker_are_named() -> None:
    def curve(*seconds: float) -> list[dict[str, Any]]:
        return [{"modes": k, "seconds": [s]} for k, s in enumerate(seconds, 2)]

    curves = {"floquet batch, numpy": curve(9.0, 9.0), "floquet batch, compiled": curve(1.0, 3.0)}
    curves |= {"floquet": curve(0.1, 0.1), "heyoka batch of 8": curve(2.0, 2.0)}
    (found,) = claims.with_modes(curves)
    assert found.startswith("- **does not hold**")
    assert found.endswith("0.5 with 2, 1.5 with 3; slower with 3.")
    assert claims.REASON in claims.section({"modes": {"curves": curves}})
    curves["heyoka batch of 8"] = curve(2.0, 4.0)
    assert claims.with_modes(curves)[0].startswith("- **holds**")
    assert claims.with_modes({"heyoka batch of 8": curve(1.0)}) == []


def test_cost_that_rises_is_found() -> None:
    def curve(*costs: float) -> dict[str, list[dict[str, Any]]]:
        return {"chart": [{"nominal": 10**k, "seconds": [c]} for k, c in enumerate(costs, 2)]}

    assert claims.falling(curve(3e-6, 2e-6, 1e-6))[0].startswith("- **holds**")
    risen = claims.falling(curve(3e-6, 1e-6, 2e-6))[0]
    assert risen.startswith("- **does not hold**")
    assert "rises at 1e4." in risen


@pytest.mark.parametrize(
    ("ours", "verdict"), [([3.0, 4.0, 5.0], "holds"), ([4.1, 4.1, 5.0], "does not hold")]
)
def test_command_against_before(ours: list[float], verdict: str) -> None:
    found = claims.verify({"seconds": ours, "before": [4.0, 4.0, 6.0]})[0]
    assert found.startswith(f"- **{verdict}**")
    assert claims.verify({"seconds": ours})[0].startswith("- **not measured**")


# ---- numbers as written --------------------------------------------------------------------------


def test_numbers_as_written() -> None:
    assert [text.digits(v) for v in (0.01234, 1.0, 99.94, 123.4, 12345.0)] == [
        *("0.0123", "1.00", "99.9", "123", "12,300")
    ]
    assert [text.factor(v) for v in (0.634, 1.0, 19.6, 12345.0)] == ["0.63", "1", "20", "12,000"]
    assert [text.size(v) for v in (100, 1024, 10**4, 10**7)] == ["100", "1,024", "1e4", "1e7"]
    assert text.micro(2e-6) == "2.00"
    assert [text.error(v) for v in (None, 4.4e-13)] == ["-", "4e-13"]


# ---- what is measured ----------------------------------------------------------------------------


def test_points_are_spread_whatever_their_number() -> None:
    many = systems.points(4096)
    for count in (16, 200, 4096):
        part = many.first(count)
        # the mean of k such points is off by less than 1/k^(1/2); .9 of that is seen
        assert abs(part.Omega.mean() - 3.175) < 5.65 / count**0.5
        assert abs(part.gamma.mean() - 0.25) < 0.5 / count**0.5
        assert part.Omega.min() >= 0.35
        assert part.Omega.max() <= 6.0
        assert [e.Omega for e in part.equations] == list(part.Omega)


def test_charts_have_the_points_they_say() -> None:
    x, y = systems.grid(10**6)
    assert (x, y) == (1000, 1000)
    assert all(abs(np.prod(systems.grid(10**k)) - 10**k) < 10 ** (k / 2) for k in range(2, 8))
    where = systems.grid_points(10**4)
    assert len(np.unique(where.Omega)) == len(np.unique(where.gamma)) == 100


@pytest.mark.parametrize("n", [1, 3, 4, 5, 8])
def test_polynomials_of_known_roots(n: int) -> None:
    rng = np.random.default_rng(n)
    roots = rng.integers(-3, 4, (20, n)).astype(float)
    V = rng.standard_normal((20, n, n)) + 3.0 * np.eye(n)
    A = V @ (roots[:, :, None] * np.linalg.inv(V))
    known = np.array([np.poly(r) for r in roots])
    # the similarity's own rounding, its condition below 1e3: 1e-12 of the largest is seen
    assert np.abs(reduction.characteristic_polynomials(A) - known).max() < 1e-9 * abs(known).max()


def test_half_and_whole_period_of_an_oscillator() -> None:
    """u'' + w^2 u = 0: z = cos 2 pi w."""
    w = np.array([0.3, 0.8, 1.7])

    def U(theta: float) -> np.ndarray:
        c, s = np.cos(w * theta), np.sin(w * theta)
        return np.moveaxis(np.array([[c, s / w], [-w * s, c]]), -1, 0)

    known = -np.cos(2.0 * np.pi * w)
    for P in (reduction.from_half(U(np.pi), 1), reduction.from_whole(U(2.0 * np.pi), 1)):
        # two products of numbers of size one: a few ulps
        assert np.abs(P[:, 1] - known).max() < 1e-14


POINTS = systems.points(3)


@pytest.mark.parametrize("half", [False, True], ids=["whole", "half"])
@pytest.mark.parametrize("method", peers.TIGHT)
def test_peers_solve_our_problem(method: str, half: bool) -> None:
    from floquet.batch import polynomials

    ours = polynomials(POINTS.equations).coefficients
    theirs = peers.make(method, 1e-10, half).build(POINTS)(POINTS)
    # at 1e-10 the worst, SUNDIALS' BDF, is off by 3e-7 of the largest coefficient
    assert np.abs(theirs - ours).max() < 1e-5 * np.abs(ours).max()


@pytest.mark.parametrize(("modes", "lanes"), [(2, 0), (2, 4), (6, 4)])
@pytest.mark.parametrize("half", [False, True], ids=["whole", "half"])
def test_heyoka_solves_our_problem(modes: int, lanes: int, half: bool) -> None:
    heyoka = pytest.importorskip("benchmarks.heyoka_peer")
    pytest.importorskip("heyoka")
    from floquet.batch import polynomials

    where = systems.points(3, modes, (4.5, 5.5))
    formulation = heyoka.Formulation(lanes, half, tolerance=1e-12)
    ours = polynomials(where.equations).coefficients
    theirs = heyoka.make("", formulation).build(where)(where)
    # 1e-13 is seen: Taylor steps of 1e-12 whose errors do not add up
    assert np.abs(theirs - ours).max() < 1e-10 * np.abs(ours).max()


def test_operations_are_counted() -> None:
    P = np.ones((2, 50))
    found = limits.elementwise(lambda p: np.sqrt(p[1] * p[1] + 1.0), P)
    # a product of two arrays, a sum with a number, a root: 3 + 2 + 2 arrays of 8 bytes
    assert found == {"roots_operations": 3.0, "roots_slow": 1.0, "roots_bytes": 56.0}
    chosen = limits.elementwise(lambda p: np.where(p[0] > 0.5, p[0], -p[1]), P)
    assert chosen["roots_operations"] == 3.0


def test_work_of_a_batch_grows_with_the_period() -> None:
    slow, quick = (limits.batch_work(systems.one(Omega)) for Omega in (0.38, 5.0))
    # half a period is 13 times as long, and has 14 steps for 4: the forcing takes its share
    assert slow["steps"] > 3 * quick["steps"]
    assert slow["flops"] / slow["steps"] == pytest.approx(quick["flops"] / quick["steps"])
    assert slow["bytes"] == quick["bytes"] == 64.0


# ---- general equations ---------------------------------------------------------------------------


@pytest.mark.parametrize("n", [1, 2])
@pytest.mark.parametrize("peer", ["DOP853", "LSODA", "heyoka"])
def test_peers_solve_the_same_general_equation(peer: str, n: int) -> None:
    e = general.pulsating(n)
    if peer == "heyoka":
        pytest.importorskip("heyoka")
        run = general._heyoka(e, 0.0)
    else:
        run = general._scipy(e, general.TOLERANCES[peer][-1], method=peer)
    known = general._polynomial(general.monodromy, e)
    # Measured 4e-12, LSODA's.
    assert general._error(run(), known) < 1e-10


def test_the_reference_of_a_general_equation_is_there() -> None:
    """Where python-flint is; else it is told, and errors are not measured."""
    field = compete.Field()
    truth = general._truth(general.pulsating(1), field)
    assert field.missing == {}
    assert (
        general._error(general._polynomial(general.characteristic, general.pulsating(1)), truth)
        < 1e-13
    )


def test_general_equations_have_a_section() -> None:
    def line(name: str, n: int, ours: bool, built: float) -> dict[str, Any]:
        return {
            "name": name, "system": "damping pulsates", "n": n, "ours": ours, "error": 3e-14,
            "settings": "tolerance 1e-12", "build_seconds": built, "seconds": [2e-4, 3e-4, 4e-4],
        }  # fmt: skip

    found = {
        "lines": [
            line(*x) for n in (1, 8) for x in (("hill", n, True, 0.0), ("heyoka", n, False, 2.0))
        ]
    }
    told = text.general(found)
    assert "| heyoka | damping pulsates | 300 | 3e-14 | 300 | 3e-14 |" in told
    assert "heyoka, n = 8: tolerance 1e-12, compiled in 2 s" in told
    assert "hill, n" not in told
    with_it = copy.deepcopy(RESULTS) | {"general": found}
    assert "## General equations" in page.page(with_it)
    found["lines"][0]["seconds"] = []
    with pytest.raises(ValueError, match="hill: seconds must be positive"):
        page.check(with_it)
