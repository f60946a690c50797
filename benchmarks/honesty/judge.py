"""An answer held against the truth: what is wrong with it, and how its bounds compare."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from benchmarks.honesty import arbiter
from benchmarks.honesty.symmetric import truth_of
from floquet.enclosure.judgement import BITS
from hill import HillEquation

EPS = float(np.finfo(float).eps)

# T of the arbiter must be this much narrower than the bound it judges.
NARROWER = 1e-3

# Of the arbiter's T, over Omega: beyond it, as where roots meet, it is asked for more digits.
WIDE = 1e-25

# Below it no T is told from another.
NOTHING = 1e-100

# Reported over true: beyond it a bound says nothing any more.
INFLATED = 1e6


@dataclass(frozen=True, eq=False)
class Answer:
    """One route's word on one system; `refused` or `failed` say why there is none.

    `poor` are the numbers that the result itself says are poorly known, "P" and "T".
    """

    polynomial: NDArray[Any] | None = None
    errors: NDArray[Any] | None = None
    T: float = 0.0
    T_error: float = 0.0
    verdict: str = "undecided"
    others: tuple[Any, ...] = ()
    poor: frozenset[str] = frozenset()
    refused: str = ""
    failed: str = ""
    warned: str = ""


@dataclass(frozen=True)
class Measured:
    """One number of an answer.

    Attributes
    ----------
    ratio : float
        The true error over the reported one.
    slack : float
        The reported error over the true one, which counts as an ulp of the result at least.
    told : bool
        Whether the answer itself says that the number is poorly known, or its verdict is
        "undecided".
    """

    ratio: float
    slack: float
    told: bool

    @property
    def inflated(self) -> bool:
        """Whether the bound is far too large, and no word said so."""
        return bool(self.slack > INFLATED and not self.told)


@dataclass(frozen=True)
class Judged:
    """One answer, judged.

    Attributes
    ----------
    kind, number, n, route
        Which system, and who answers.
    status : {"answered", "refused", "failed"}
    violations : dict
        What is wrong, by the number it is wrong with, "verdict", "NaN" or "other".
    measured : dict of str to Measured
        By number.
    unjudged : tuple of str
        Numbers that the arbiter does not know narrowly enough to judge by.
    undecided : bool
    truth : str
    beyond : bool
        The system is beyond the arbiter: nothing is judged.
    """

    kind: str
    number: int
    n: int
    route: str
    status: str
    violations: dict[str, str] = field(default_factory=dict)
    measured: dict[str, Measured] = field(default_factory=dict)
    unjudged: tuple[str, ...] = ()
    undecided: bool = False
    truth: str = "unknown"
    beyond: bool = False


@dataclass(frozen=True, eq=False)
class Truth:
    """The arbiter's P and T of one system; None where it is beyond the arbiter."""

    equation: HillEquation
    P: list[Any] | None
    growth: arbiter.Growth | None


def truth(equation: HillEquation, narrow: int = arbiter.NARROW) -> Truth:
    """Ask the arbiter; where T is not narrow, with more digits."""
    try:
        P = arbiter.reference(equation, narrow=narrow)
        found = _growth(P, equation)
        wide = not found.T.rad() < arb(WIDE) * max(1.0, equation.Omega)
        if wide and narrow == arbiter.NARROW:
            return truth(equation, narrow=6 * narrow)
    except arbiter.TooWide:
        return Truth(equation, None, None)
    return Truth(equation, P, found)


def _growth(P: list[Any], equation: HillEquation) -> arbiter.Growth:
    if np.ndim(equation.eta) == 0:
        return arbiter.judged(P, equation.Omega, float(equation.eta))
    if not np.any(equation.eta):  # multipliers in pairs
        known = truth_of(equation.general(), P)
        return arbiter.Growth(known.T, known.verdict)
    return arbiter.judged(P, equation.Omega, None)


def judged(
    kind: str, number: int, route: str, answer: Answer, known: Truth, shrink: float = 1.0
) -> Judged:
    """Hold an answer against the truth; `shrink` multiplies every bound."""
    wrong: dict[str, str] = {}
    if answer.warned:
        wrong["other"] = answer.warned
    if answer.failed:
        wrong["other"] = answer.failed
    found: dict[str, Any] = {
        "kind": kind,
        "number": number,
        "n": known.equation.n,
        "route": route,
        "violations": wrong,
        "truth": known.growth.truth if known.growth else "unknown",
        "beyond": known.P is None,
    }
    if answer.polynomial is None or answer.errors is None:
        return Judged(**found, status="failed" if answer.failed else "refused")
    numbers = (answer.polynomial, answer.errors, answer.T, answer.T_error, *answer.others)
    if not all(np.all(np.isfinite(x)) for x in numbers):
        wrong["NaN"] = f"T = {answer.T} +- {answer.T_error}, P +- {np.max(answer.errors)}"
    if answer.verdict not in ("stable", "unstable", "undecided"):
        wrong["verdict"] = f"{answer.verdict!r}"
    undecided = answer.verdict == "undecided"
    measured: dict[str, Measured] = {}
    unjudged: tuple[str, ...] = ()
    if known.P is not None and "NaN" not in wrong:
        measured["P"] = _judge_P(answer, known.P, shrink, wrong)
        T = _judge_T(answer, known, shrink, wrong)
        if T is None:
            unjudged = ("T",)
        else:
            measured["T"] = T
    return Judged(
        **found, status="answered", measured=measured, unjudged=unjudged, undecided=undecided
    )


def _judge_P(
    answer: Answer, truth: Sequence[Any], shrink: float, wrong: dict[str, str]
) -> Measured:
    assert answer.polynomial is not None
    assert answer.errors is not None
    reported = shrink * answer.errors
    with ctx.workprec(BITS):
        pairs = zip(answer.polynomial, truth, strict=True)
        off = [abs(arb(float(p)) - t) for p, t in pairs]
        beyond = [k for k, (d, r) in enumerate(zip(off, reported, strict=True)) if d > arb(r)]
        true = np.array([float(d.mid()) for d in off])
    size = float(np.max(np.abs(answer.polynomial)))
    known_errors = np.maximum(true, EPS * size)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = np.where(reported > 0.0, true / reported, np.where(true > 0.0, np.inf, 0.0))
        slack = float(np.max(reported[1:])) / float(np.max(known_errors[1:]))
    told = "P" in answer.poor
    if beyond:
        k = max(beyond, key=lambda k: ratio[k])
        wrong["P"] = f"p_{k} off by {true[k]:.3g}, reported {reported[k]:.3g}: {ratio[k]:.3g} times"
        return Measured(float(np.max(ratio[beyond])), slack, told)
    # a coefficient that is exact to the last digit is known to more than the arbiter's
    return Measured(float(np.max(np.minimum(ratio, 1.0))), slack, told)


def _judge_T(answer: Answer, known: Truth, shrink: float, wrong: dict[str, str]) -> Measured | None:
    growth = known.growth
    assert growth is not None
    if growth.truth != "unknown" and answer.verdict not in (growth.truth, "undecided"):
        T = growth.T.str(6)
        wrong["verdict"] = f"said to be {answer.verdict}, is {growth.truth}, T = {T}"
    reported = shrink * answer.T_error
    narrow = growth.T.is_finite() and float(growth.T.rad()) <= max(NARROWER * reported, NOTHING)
    if not narrow:
        # what is off by more than a wide ball is off all the same
        if growth.T.is_finite() and abs(arb(answer.T) - growth.T) > arb(reported) + NOTHING:
            off = float((arb(answer.T) - growth.T).abs_lower())
            wrong["T"] = f"off by {off:.3g}, reported {reported:.3g}"
        return None
    e = known.equation
    size = max(e.Omega / np.pi, abs(answer.T), float(np.max(np.abs(e.eta))))
    told = "T" in answer.poor or answer.verdict == "undecided"
    return one_number("T", answer.T, growth.T, reported, size, told, wrong)


def one_number(
    name: str,
    value: float | complex,
    truth: Any,
    reported: float,
    size: float,
    told: bool,
    wrong: dict[str, str],
) -> Measured:
    """Hold one number against its ball; what is wrong goes into `wrong`.

    Parameters
    ----------
    value : float or complex
    truth : arb or acb
    reported : float
        The bound on its error.
    size : float
        An ulp of it is no error.
    told : bool
        As in `Measured`.
    """
    with ctx.workprec(BITS):
        off = abs(truth - value)
        true, beyond = float(off.mid()), bool(off > arb(reported) + NOTHING)
    ratio = true / reported if reported > 0.0 else float("inf") if beyond else 0.0
    if beyond:
        wrong[name] = f"off by {true:.3g}, reported {reported:.3g}: {ratio:.3g} times"
    return Measured(ratio, float(reported) / max(true, EPS * size), bool(told))
