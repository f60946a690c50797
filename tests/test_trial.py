"""The trial of the bounds on a sample, and what it catches."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.honesty import edges, judge, run, systems, table, trial
from hill import HillEquation


def test_no_bound_is_too_small(capsys: pytest.CaptureFixture[str]) -> None:
    """A sample of every part, and tables that fit into 80 columns."""
    # a chart takes some seconds: one
    classes = [*systems.NAMES, "matrices, gamma"]
    words = ["--count", "160", "--seed", "1", "--jobs", "1", "--classes", *classes]
    assert run.main(words) == 0
    told = capsys.readouterr().out
    assert all(told.count(f"\n{name} ") >= 2 for name in systems.CLASSES)
    assert all(f"\n{route} " in told for route in trial.ROUTES)
    assert "\nmatrices, gamma " in told
    assert all(len(line.rstrip()) <= 80 for line in told.splitlines())


@pytest.mark.parametrize(
    ("part", "classes"),
    [
        ("bounds", ["growth", "tongue edges"]),
        ("sensitivities", ["growth", "defective"]),
        ("edges", ["matrices, gamma"]),
    ],
)
def test_all_that_was_counted_is_in_the_file(
    part: str, classes: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "trial.json"
    words = ["--part", part, "--count", "32", "--jobs", "1", "--json", str(path)]
    assert run.main([*words, "--classes", *classes]) == 0
    found = json.loads(path.read_text())[part]
    assert {line["class"] for line in found["lines"]} == set(classes)
    assert found["violations"] == []
    assert "refused" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("part", "classes"),
    [
        ("bounds", ["ordinary", "growth"]),
        ("sensitivities", ["ordinary", "growth"]),
        ("edges", ["matrices, gamma"]),
    ],
)
def test_a_bound_that_was_shrunk_is_caught(
    part: str, classes: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--part", part, "--count", "32", "--jobs", "1", "--classes", *classes]
    # a chart's error is far above what its series are off by
    assert run.main([*words, "--shrink", "1e-6" if part == "edges" else "1e-3"]) == 1
    assert ("none at" if part == "edges" else "off by") in capsys.readouterr().out


@pytest.fixture(scope="module")
def known() -> Any:
    """Mathieu's equation on a tongue: T is above 0."""
    found = judge.truth(HillEquation([[1.0]], [[1.0]], 0.3, 2.0))
    assert found.growth.truth == "unstable"
    return found


def _answer(known: Any, **changed: Any) -> Any:
    T = float(known.growth.T)
    polynomial = np.array([float(p) for p in known.P])
    right = {"polynomial": polynomial, "errors": np.array([0.0, 1e-12]), "T": T}
    return judge.Answer(**(right | {"T_error": 1e-12, "verdict": "unstable"} | changed))


def _found(known: Any, answer: Any) -> set[str]:
    return set(judge.judged("ordinary", 0, "hill", answer, known).violations)


def test_what_is_right_is_no_violation(known: Any) -> None:
    assert _found(known, _answer(known)) == set()
    assert _found(known, _answer(known, verdict="undecided")) == set()


@pytest.mark.parametrize(
    ("changed", "wrong"),
    [
        ({"verdict": "stable"}, "verdict"),
        ({"verdict": "safe"}, "verdict"),
        ({"T": 1.0}, "T"),
        ({"polynomial": np.array([1.0, 0.5])}, "P"),
        ({"T_error": float("nan")}, "NaN"),
        ({"errors": np.array([0.0, np.inf])}, "NaN"),
        ({"others": (np.array([np.nan]),)}, "NaN"),
        ({"warned": "RuntimeWarning: overflow"}, "other"),
    ],
)
def test_each_wrong_answer_is_told(known: Any, changed: dict[str, Any], wrong: str) -> None:
    assert _found(known, _answer(known, **changed)) == {wrong}


def _raise(error: Exception) -> Any:
    raise error


@pytest.mark.parametrize(
    ("error", "status"),
    [
        (OverflowError("growth beyond a float"), "refused"),
        (ValueError("eta: must be finite"), "refused"),
        (ValueError(), "failed"),
        (IndexError("index 3"), "failed"),
        (FloatingPointError("overflow"), "failed"),
    ],
    ids=repr,
)
def test_only_what_is_explained_is_a_refusal(known: Any, error: Exception, status: str) -> None:
    answer = trial.ask(lambda: _raise(error))
    found = judge.judged("ordinary", 0, "hill", answer, known)
    assert found.status == status
    assert ("other" in found.violations) == (status == "failed")


def test_one_system_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert run.main(["--show", "known", "0"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("HillEquation(")
    assert all(f"\n{route}:" in said for route in ("hill", "taylor", "cvodes", "numpy"))


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["--count", "0"], "--count"),
        (["--shrink", "nan"], "--shrink"),
        (["--classes", "ordinaire"], "ordinaire"),
        (["--show", "ordinary", "-1"], "--show"),
        (["--show", "known", "99"], "no such number"),
        (["--json", "/no/such/folder/x.json"], "--json"),
    ],
)
def test_bad_usage_is_refused(
    words: list[str], named: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        run.main(words)
    assert ended.value.code == 2
    assert named in capsys.readouterr().err


# ---- what is counted -----------------------------------------------------------------------------


def test_a_bound_inflated_in_silence_is_counted(known: Any) -> None:
    """Far too large, small beside the number itself, with a verdict: no word says so."""
    P = known.P[1]
    close = np.array([1.0, float(P)])

    def measured(**changed: Any) -> Any:
        return judge.judged("ordinary", 0, "hill", _answer(known, **changed), known).measured

    silent = measured(polynomial=close, errors=np.array([0.0, 1e-9]), T_error=1e-9)
    assert silent["P"].inflated
    assert silent["P"].slack == pytest.approx(1e-9 / (2.0**-52 * abs(float(P))), rel=0.1)
    said = measured(polynomial=close, errors=np.array([0.0, 1e-5]), poor=frozenset("PT"))
    assert said["P"].slack > silent["P"].slack
    assert not said["P"].inflated
    assert not said["T"].inflated


def test_what_a_line_counts(known: Any) -> None:
    good = judge.judged("ordinary", 0, "hill", _answer(known), known)
    wrong = judge.judged("ordinary", 0, "taylor", _answer(known, T=1.0), known)
    refused = judge.judged("ordinary", 1, "hill", judge.Answer(refused="eta: no"), known)
    lost = judge.judged(
        "growth", 2, "hill", _answer(known), judge.Truth(known.equation, None, None)
    )
    one = table.line([good, wrong, refused, lost], ("P", "T"))
    assert (one.systems, one.beyond, one.answers, one.refused) == (3, 1, 4, 1)
    assert one.violations == {"P": 0, "T": 1, "verdict": 0, "NaN": 0, "other": 0}
    assert one.numbers["P"].ratio[2] == pytest.approx(good.measured["P"].ratio)
    assert one.numbers["T"].ratio[2] == wrong.measured["T"].ratio > 1e6


def test_edges_are_zeros_of_the_arbiters_functions() -> None:
    """A z at 1, at -1, and two that meet, with eta = 0 and, on the ellipse, without."""
    w = np.array([0.7, 1.6])
    at = HillEquation(np.diag(w**2), np.zeros((2, 2)), 0.0, 1.4)  # w_1/Omega is 1/2
    assert abs(float(edges.edge_function("-1", at))) < 1e-15
    assert abs(float(edges.edge_function("+1", at))) > 0.1
    # the squares are rounded: z_1 and z_2 are an ulp or two apart
    meet = HillEquation(np.diag(w**2), np.zeros((2, 2)), 0.0, 2.3)  # w_1 + w_2 = Omega
    assert abs(float(edges.edge_function("pair", meet))) < 1e-28
    assert abs(float(edges.edge_function("pair", at))) > 1e-3
    # with damping the edge moves from z = -1 to z = -c, where T is 0: P(-c) = -c - z
    for gamma, verdict in ((0.1, "stable"), (0.4, "unstable")):
        own = HillEquation([[1.0025]], [[1.0]], gamma, 2.0, 0.1)
        growth = judge.truth(own).growth
        assert growth is not None
        assert growth.truth == verdict
        assert (float(edges.edge_function("-1", own)) < 0.0) == (verdict == "stable")


@pytest.mark.parametrize("eta", [0.0, 0.03])
def test_pairs_that_leave_the_ellipse(eta: float) -> None:
    """The determinant over pairs changes its sign where T does, where w_1 + w_2 is Omega."""
    F, G = np.diag([1.0, 4.0]), [[0.3, 1.0], [1.0, -0.2]]
    signs = {}
    for Omega in (2.7, 3.0):  # w_1 + w_2 = 3
        own = HillEquation(F, G, 0.4, Omega, eta)
        growth = judge.truth(own).growth
        assert growth is not None
        signs[growth.truth] = float(edges.edge_function("pair", own))
    assert set(signs) == {"stable", "unstable"}
    assert signs["stable"] * signs["unstable"] < 0.0


def test_an_edge_that_another_instability_has_taken_has_no_bound() -> None:
    """Two edges of this chart were where a complex pair's real part passes -1, said to 4e-9."""
    found = edges.trial("matrices, gamma", 71, 15)
    assert len(found) > 5
    assert not any(one.violations for one in found)
