"""The report's conclusions: every one computed, its verdict on record, the page up to date."""

import json
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from commands import refusal
from rich.console import Console
from scipy.integrate import solve_ivp

import compare.commands.claims as command
from compare.__main__ import main
from compare.report.claims import JudgedClaim, RoutesDisagree, claims, judge, page
from compare.report.claims.finding import CHECKS, Finding, Number, graded
from compare.report.claims.run import check_of
from compare.report.one_route import integral_of_force
from floquet import weak_form
from hill import UniformBeam, axial_force

cases = import_module("compare.report.claims.cases")
initial = import_module("compare.report.claims.initial")
out_of_phase = import_module("compare.report.claims.out_of_phase")
resonance = import_module("compare.report.claims.resonance")
comparison = import_module("compare.both_routes")
both_routes = import_module("compare.report.claims.both_routes")
tongues = import_module("compare.report.claims.tongues")
damping = import_module("compare.report.claims.damping")
compliance = import_module("compare.report.claims.compliance")

IDS = [claim.id for claim in claims()]
PAGE = Path(__file__).parents[1] / "docs" / "claims.md"
QUICK = "integrals"


@pytest.fixture(scope="module")
def judged() -> dict[str, JudgedClaim]:
    return {one.claim.id: one for one in judge()}


@pytest.fixture
def afresh() -> Iterator[None]:
    """No number from an earlier test, and none of this one's left behind."""
    saved = both_routes.both
    both_routes.both.cache_clear()
    cases.regions.cache_clear()
    yield
    saved.cache_clear()
    cases.regions.cache_clear()


# ---- the claims ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", IDS)
def test_verdict_is_the_one_on_record(name: str, judged: dict[str, JudgedClaim]) -> None:
    one = judged[name]
    assert one.as_expected, one.finding


@pytest.mark.parametrize("name", IDS)
def test_both_routes_print_the_same(name: str, judged: dict[str, JudgedClaim]) -> None:
    for number in judged[name].finding.numbers:
        assert np.isfinite(number.hill)
        hill, floquet = number.texts
        assert floquet in ("", hill), number


def test_page_is_up_to_date(judged: dict[str, JudgedClaim]) -> None:
    assert page.whole_page(judged.values()) == PAGE.read_text()


def test_every_claim_has_one_check_and_every_check_its_claim() -> None:
    check_of(IDS[0])
    assert len(set(IDS)) == len(IDS)
    assert set(CHECKS) == set(IDS)
    assert 30 <= len(IDS) <= 45


def test_data_are_complete() -> None:
    text = (files("compare") / "report/data/claims.toml").read_text()
    fields = {"id", "section", "title", "claim", "computed", "rule", "expected"}
    for entry in tomllib.loads(text)["claim"]:
        assert set(entry) == fields
        assert all(entry.values())
        assert "onfirmed if" in entry["rule"]
        assert "else refuted" in entry["rule"] or "else qualified" in entry["rule"]
        assert len(entry["title"]) <= 40


def test_becauses_are_sentences(judged: dict[str, JudgedClaim]) -> None:
    for one in judged.values():
        assert one.finding.because[0].isupper() or one.finding.because[0].isdigit()
        assert one.finding.because.endswith(".")


# ---- the verdicts follow from the numbers -------------------------------------------------------


def test_graded_takes_the_first_that_holds() -> None:
    assert graded(True, True) == "confirmed"
    assert graded(False, True) == "qualified"
    assert graded(False, False) == "refuted"


def test_numbers_round_alike_everywhere() -> None:
    assert Number("", -1e-9, 1e-9, 5).texts == ("0.00000", "0.00000")
    assert Number("", -0.25, None, 1).texts == ("-0.2", "")


@pytest.mark.parametrize(
    ("module", "constant", "value", "name", "verdict"),
    [
        (tongues, "VISIBLE", 0.3, "half-circles", "confirmed"),
        (tongues, "VISIBLE", 0.001, "half-circles", "refuted"),
        (tongues, "VISIBLE", 0.3, "boundary-rule", "confirmed"),
        (tongues, "VISIBLE", 0.01, "linear-width", "qualified"),
        (damping, "PRINTED", 1e-3, "shift", "confirmed"),
        (damping, "VISIBLE", 0.01, "shift", "refuted"),
        (compliance, "PRINTED", 1e-3, "above-fifty", "confirmed"),
        (compliance, "GROWTH", 1e3, "integrals", "refuted"),
        (resonance, "BROAD", 100.0, "broad", "qualified"),
        (resonance, "SLIGHTLY", 0.5, "narrowed", "confirmed"),
    ],
)
def test_another_threshold_is_another_verdict(
    module: object,
    constant: str,
    value: float,
    name: str,
    verdict: str,
    judged: dict[str, JudgedClaim],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert judged[name].finding.verdict != verdict
    monkeypatch.setattr(module, constant, value)
    assert check_of(name)().verdict == verdict


def test_a_gap_without_the_force_out_of_phase_would_be_confirmed(
    judged: dict[str, JudgedClaim], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert judged["gap"].finding.verdict == "qualified"
    nothing = replace(out_of_phase.sine_alone(resonance.bar(0.04), 2.0), hill=0.0, stable=True)
    monkeypatch.setattr(resonance, "sine_alone", lambda *_: nothing)
    assert check_of("gap")().verdict == "confirmed"


def test_the_slip_of_table_3_would_keep_more_verdicts(monkeypatch: pytest.MonkeyPatch) -> None:
    # without any terms "with" is "without", and nothing changes
    initial._table.cache_clear()
    monkeypatch.setattr(initial, "TERMS", 0)
    assert check_of("table-3")().verdict == "confirmed"
    initial._table.cache_clear()


def test_more_terms_change_no_verdict_of_table_3() -> None:
    for name, (_, five) in initial._table().items():
        twelve = initial._point(cases.resonances(cases.uniform())[name], 12)
        assert twelve.stable == five.stable, name


@pytest.mark.usefixtures("afresh")
def test_routes_that_disagree_are_loud(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(equation: object, **options: object) -> object:
        right = routes_monodromy(equation, **options)
        return replace(right, T=right.T + 1e-3)

    routes_monodromy = comparison.monodromy
    monkeypatch.setattr(comparison, "monodromy", wrong)
    with pytest.raises(RoutesDisagree, match=r"the routes disagree: .* at Omega = 1\.1"):
        both_routes.both(cases.uniform(), 1.1)
    with pytest.raises(RoutesDisagree):
        check_of("broad")()


def test_boundaries_that_disagree_are_loud(monkeypatch: pytest.MonkeyPatch) -> None:
    beam = cases.uniform()
    found = both_routes.boundary(beam, 1.1, 1.2)
    assert abs(found.hill - found.floquet) < 1e-10
    assert not both_routes.both(beam, found.hill - 1e-5).stable
    assert both_routes.both(beam, found.hill + 1e-5).stable
    right = both_routes.solve
    # P(z) of z a little larger: an edge a little farther out
    moved = np.array([0.0, 1e-7, 0.0, 0.0])
    monkeypatch.setattr(
        both_routes, "solve", lambda route, e: right(route, e) + moved * (route == "floquet")
    )
    with pytest.raises(RoutesDisagree, match="boundaries disagree"):
        both_routes.boundary(beam, 1.1, 1.2)


def whole_force(g: float, Omega: float, parts: tuple[float, float] = (1.0, 1.0)) -> float:
    """T with Re Phi* cos - Im Phi* sin, integrated over one period."""
    beam = resonance.bar(g)
    equation, sine = beam.equation(Omega, 0.1), axial_force.out_of_phase(beam, Omega)
    n, period = equation.n, 2.0 * np.pi / Omega

    def rate(tau: float, flat: np.ndarray) -> np.ndarray:
        state = flat.reshape(2 * n, 2 * n)
        pulse = parts[0] * np.cos(Omega * tau) * equation.G - parts[1] * np.sin(Omega * tau) * sine
        return np.vstack([state[n:], -(equation.F + 0.1 * pulse) @ state[:n]]).ravel()

    start = np.eye(2 * n).ravel()
    run = solve_ivp(rate, (0.0, period), start, method="DOP853", rtol=1e-11, atol=1e-12)
    multipliers = np.linalg.eigvals(run.y[:, -1].reshape(2 * n, 2 * n))
    return float(2.0 / period * np.log(np.abs(multipliers).max()))


@pytest.mark.parametrize(
    ("g", "Omega", "T"),
    [(0.04, 2.0, 0.6753), (0.08, 2.0, 0.3105), (0.08, 2.05, 0.2104), (0.08, 4.0, 0.1476)],
)
def test_the_whole_force_is_unstable_where_the_report_s_is_not(
    g: float, Omega: float, T: float
) -> None:
    assert both_routes.both(resonance.bar(g), Omega).stable
    assert whole_force(g, Omega) == pytest.approx(T, abs=1e-4)
    alone = out_of_phase.sine_alone(resonance.bar(g), Omega).hill
    assert whole_force(g, Omega, (0.0, 1.0)) == pytest.approx(alone, abs=1e-8)


def test_the_report_s_part_alone_is_the_report_s_equation() -> None:
    T = both_routes.both(resonance.bar(0.04), 1.95).hill
    assert whole_force(0.04, 1.95, (1.0, 0.0)) == pytest.approx(T, abs=1e-8)


def test_an_undamped_bar_has_no_force_out_of_phase() -> None:
    for module in (axial_force, weak_form):
        assert np.max(np.abs(module.out_of_phase(resonance.bar(0.0), 1.9))) < 1e-15


def test_the_integral_of_the_force_is_tan_over_its_argument() -> None:
    """Closed form, (1 - cos z)/(z sin z) = tan(z/2)/z; both routes take it out of their G."""
    beam = UniformBeam(T0=1.0, K_theta=0.0, xi_G=0.0, omega_L=1.0, g=0.04)
    for sigma in (0.5, 0.98, 1.0, 1.5):
        z = np.pi * np.sqrt(sigma**2 - 0.04j)
        for route in ("hill", "floquet"):
            found = integral_of_force(route, beam, sigma)
            # rounding of G: 2e-14 measured
            assert abs(found - np.tan(0.5 * z) / z) < 1e-12


def test_sine_part_by_two_ways_and_at_resonance() -> None:
    beam = resonance.bar(0.04)
    for Omega in (0.5, 1.95, 2.0, 4.0):
        one, other = (f(beam, Omega) for f in (axial_force.out_of_phase, weak_form.out_of_phase))
        assert np.max(np.abs(one - other)) < 1e-12 * np.max(np.abs(one))
    # there Phi* is nearly -2i/(pi g) sin(pi xi), so that the sine part is the larger by far
    ratio = np.max(np.abs(axial_force.out_of_phase(beam, 2.0))) / np.max(
        np.abs(beam.equation(2.0, 0.1).G)
    )
    assert ratio > 10.0


# ---- the command --------------------------------------------------------------------------------


def test_json_holds_everything(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["claims", QUICK, "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["summary"] == {
        "claims": 1,
        "confirmed": 0,
        "qualified": 1,
        "refuted": 0,
        "ok": True,
    }
    (one,) = content["claims"]
    assert {"id", "section", "claim", "rule", "expected", "verdict", "because"} <= set(one)
    assert set(one["numbers"][0]) == {"label", "hill", "floquet", "digits"}


def test_text_fits_80_columns(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    judged: dict[str, JudgedClaim],
) -> None:
    monkeypatch.setattr(command, "terminal", lambda: Console(width=80))
    monkeypatch.setattr(command, "judge", lambda *_, **__: tuple(judged.values()))
    for words in ([], IDS):
        assert main(["claims", *words]) == 0
        lines = capsys.readouterr().out.splitlines()
        assert all(len(line) <= 80 for line in lines[:-2])
        assert not any("\N{HORIZONTAL ELLIPSIS}" in line for line in lines)
        assert lines[-2].startswith(f"{len(IDS)} claims: ")


def test_a_verdict_selects_what_is_listed(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    judged: dict[str, JudgedClaim],
) -> None:
    monkeypatch.setattr(command, "judge", lambda *_, **__: tuple(judged.values()))
    assert main(["claims", "--verdict", "refuted", "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    refuted = [name for name, one in judged.items() if one.finding.verdict == "refuted"]
    assert [one["id"] for one in content["claims"]] == refuted
    assert content["summary"]["claims"] == len(IDS)


def test_output_goes_to_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, start in (("c.md", "1 claim: "), ("c.json", "{"), ("c.txt", "claim ")):
        assert main(["claims", QUICK, "--output", str(tmp_path / name)]) == 0
        assert (tmp_path / name).read_text().lstrip().startswith(start)
    assert capsys.readouterr().out == ""


def test_exit_status_1_where_a_verdict_is_new(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    judged: dict[str, JudgedClaim],
) -> None:
    new = JudgedClaim(judged[QUICK].claim, Finding((), "refuted", "Changed."))
    monkeypatch.setattr(command, "judge", lambda *_, **__: (new,))
    assert main(["claims", QUICK]) == 1
    assert f"differ from the record: {QUICK}" in capsys.readouterr().out


def test_exit_status_1_where_the_routes_disagree(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def disagree(*_: object, **__: object) -> None:
        raise RoutesDisagree("the routes disagree at Omega = 1")

    monkeypatch.setattr(command, "judge", disagree)
    assert main(["claims", QUICK]) == 1
    captured = capsys.readouterr()
    assert captured.err == "verify claims: the routes disagree at Omega = 1\n"
    assert captured.out == ""


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["nonsense"], "claim = 'nonsense'"),
        ([QUICK, "--output", "nowhere/at/all.md"], "nowhere/at/all.md"),
    ],
)
def test_bad_input_is_one_line(
    words: list[str],
    says: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    line = refusal(["claims", *words], capsys)
    assert line.startswith("verify claims: ")
    assert says in line
