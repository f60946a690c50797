"""The trial of the bounds on a sample, and what it catches."""

from typing import Any

import numpy as np
import pytest

from benchmarks.honesty import run, trial
from hill import HillEquation


@pytest.mark.parametrize("seed", [1, 2])
def test_no_bound_is_too_small(seed: int, capsys: pytest.CaptureFixture[str]) -> None:
    assert run.main(["--count", "160", "--seed", str(seed), "--jobs", "1"]) == 0
    assert "ill-conditioned" in capsys.readouterr().out


def test_a_bound_that_was_shrunk_is_caught(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--count", "32", "--jobs", "1", "--classes", "ordinary", "growth"]
    assert run.main([*words, "--shrink", "1e-3"]) == 1
    assert "off by" in capsys.readouterr().out


@pytest.fixture(scope="module")
def known() -> Any:
    """Mathieu's equation on a tongue: T is above 0."""
    found = trial.truth(HillEquation([[1.0]], [[1.0]], 0.3, 2.0))
    assert found.growth.truth == "unstable"
    return found


def _answer(known: Any, **changed: Any) -> Any:
    T = float(known.growth.T)
    polynomial = np.array([float(p) for p in known.P])
    right = {"polynomial": polynomial, "errors": np.array([0.0, 1e-12]), "T": T}
    return trial.Answer(**(right | {"T_error": 1e-12, "verdict": "unstable"} | changed))


def _found(known: Any, answer: Any) -> set[str]:
    return set(trial.judged("ordinary", 0, "hill", answer, known).violations)


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
    found = trial.judged("ordinary", 0, "hill", answer, known)
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
