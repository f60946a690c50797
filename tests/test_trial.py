"""The trial of the bounds on a sample, its arbiter against closed forms, and what it catches."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh_tridiagonal

from hill import HillEquation

# last, so that what is installed comes before what lies beside it
sys.path.append(str(Path(__file__).parents[1]))

arbiter = import_module("benchmarks.honesty.arbiter")
run = import_module("benchmarks.honesty.run")
systems = import_module("benchmarks.honesty.systems")
trial = import_module("benchmarks.honesty.trial")


def test_the_arbiter_on_constant_coefficients() -> None:
    """z = cos(2 pi w/Omega), w^2 = F - eta^2/4."""
    w = np.array([0.7, 1.9])
    equation = HillEquation(np.diag(w**2), np.eye(2), 0.0, 1.3)
    truth = arbiter.reference(equation)
    expected = np.poly(np.cos(2.0 * np.pi * w / 1.3))
    # the squares and the cosines are rounded: ten ulps of w^2 and of z
    assert arbiter.largest_error(expected, truth) < 1e-14


def test_the_arbiter_on_mathieu() -> None:
    """At a characteristic value a_0(q) of x'' + (a - 2 q cos 2t) x = 0 z is 1."""
    q, size = 3.0, 40
    # Fourier's matrix of the even solutions of period pi, made symmetric
    off = np.full(size - 1, q)
    off[0] *= np.sqrt(2.0)
    a = eigh_tridiagonal((2.0 * np.arange(size)) ** 2, off, eigvals_only=True)[0]
    truth = arbiter.reference(HillEquation([[a]], [[1.0]], -2.0 * q, 2.0))
    # dz/da is 18 there, and a is known to 2e-14
    assert arbiter.largest_error([1.0, -1.0], truth) < 1e-12


@pytest.mark.parametrize("seed", [1, 2])
def test_no_bound_is_too_small(seed: int, capsys: pytest.CaptureFixture[str]) -> None:
    assert run.main(["--count", "160", "--seed", str(seed), "--jobs", "1"]) == 0
    assert "ill-conditioned" in capsys.readouterr().out


def test_a_bound_that_was_shrunk_is_caught(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--count", "32", "--jobs", "1", "--classes", "ordinary", "growth"]
    assert run.main([*words, "--shrink", "1e-3"]) == 1
    assert "off by" in capsys.readouterr().out


SKEW = np.array([[0.0, 0.4], [-0.4, 0.0]])


@pytest.mark.parametrize(
    "equation",
    [
        HillEquation([[1.7]], [[1.0]], 0.1, 2.1, np.zeros((1, 1))),
        HillEquation(np.diag([1.0, 2.3]), [[1.0, 0.2], [0.2, -1.0]], 0.1, 1.37, SKEW),
    ],
    ids=["none", "gyroscopic"],
)
def test_what_truncation_leaves_is_no_verdict(equation: HillEquation) -> None:
    """Reversible, with all multipliers on the circle: T is 0, the series only near it."""
    found = trial.truth(equation).growth
    assert found.truth == "boundary"
    assert found.T.contains(0)


@pytest.mark.parametrize("kind", ["ordinary", "growth", "nonnormal", "damping matrices"])
def test_twice_the_work_says_the_same(kind: str) -> None:
    """Balls of the true P overlap, whatever was spent on them."""
    equation = systems.members(kind, 3, 1)[0]
    once, twice = arbiter.reference(equation), arbiter.reference(equation, refine=2)
    assert all(a.overlaps(b) for a, b in zip(once, twice, strict=True))


def test_the_series_and_the_steps_agree() -> None:
    """A damping matrix eta I goes by Taylor steps, eta itself by the series: T is the same."""
    equation = systems.members("ordinary", 3, 1)[0]
    e = HillEquation(equation.F, equation.G, equation.gamma, equation.Omega, 0.2)
    same = HillEquation(e.F, e.G, e.gamma, e.Omega, 0.2 * np.eye(e.n))
    series, steps = trial.truth(e).growth, trial.truth(same).growth
    assert series.T.overlaps(steps.T)
    assert series.truth == steps.truth


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
