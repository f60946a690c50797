"""What every route says of a system, held against the arbiter."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

import floquet.batch
import hill.batch
from benchmarks.honesty import arbiter
from benchmarks.honesty.enclosures import BITS
from benchmarks.honesty.systems import GROUP, SHARED, members
from floquet import monodromy
from floquet.batch import c_kernel
from hill import HillEquation, characteristic
from hill.stability import stabilities

Float = NDArray[np.float64]
EPS = float(np.finfo(float).eps)

ROUTES = (
    "hill",
    "taylor",
    "cvodes",
    "hill.batch",
    "hill.batch shared",
    "numpy",
    "numpy shared",
    "compiled",
)

# T of the arbiter must be this much narrower than the bound it judges.
NARROWER = 1e-3

# Of the arbiter's T, over Omega: beyond it, as where roots meet, it is asked for more digits.
WIDE = 1e-25

# Below it no T is told from another.
NOTHING = 1e-100


@dataclass(frozen=True, eq=False)
class Answer:
    """One route's word on one system; `refused` or `failed` say why there is none."""

    polynomial: NDArray[Any] | None = None
    errors: NDArray[Any] | None = None
    T: float = 0.0
    T_error: float = 0.0
    verdict: str = "undecided"
    others: tuple[Any, ...] = ()
    refused: str = ""
    failed: str = ""
    warned: str = ""


@dataclass(frozen=True)
class Judged:
    """One answer, judged.

    Attributes
    ----------
    kind, number, n, route
        Which system, and who answers.
    status : {"answered", "refused", "failed"}
    violations : dict
        By "P", "T", "verdict", "NaN" or "other": what is wrong.
    P_ratio, T_ratio : float or None
        True error over the reported one.
    P_slack, T_slack : float or None
        Reported error over the true one, which counts as an ulp of the result at least.
    undecided : bool
    truth : str
    T_skipped : bool
        The arbiter's T is not narrow enough to judge by.
    """

    kind: str
    number: int
    n: int
    route: str
    status: str
    violations: dict[str, str] = field(default_factory=dict)
    P_ratio: float | None = None
    T_ratio: float | None = None
    P_slack: float | None = None
    T_slack: float | None = None
    undecided: bool = False
    truth: str = "unknown"
    T_skipped: bool = False


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
    eta = None if np.ndim(equation.eta) > 0 else float(equation.eta)
    return arbiter.judged(P, equation.Omega, eta)


def trial(
    kind: str, seed: int, group: int, *, cvodes: bool = True, shrink: float = 1.0
) -> list[Judged]:
    """Judge one group of systems by every route.

    Parameters
    ----------
    kind, seed, group
        As for `systems.members`.
    cvodes : bool, optional
        Ask SUNDIALS too, for the first system of the group: it is slow.
    shrink : float, optional
        Multiplies every bound: below 1 the trial must find fault.
    """
    equations = members(kind, seed, group)
    truths = [truth(e) for e in equations]
    found = []
    for route, places, answers in _answers(equations, shared=kind != "known", cvodes=cvodes):
        for place, answer in zip(places, answers, strict=True):
            number = GROUP * group + place
            found.append(judged(kind, number, route, answer, truths[place], shrink))
    return found


def answers_of(equations: Sequence[HillEquation], place: int, shared: bool) -> dict[str, Answer]:
    """Every route's answer to one of a group."""
    return {
        route: answers[places.index(place)]
        for route, places, answers in _answers(equations, shared=shared, cvodes=True, every=True)
        if place in places
    }


def _answers(
    equations: Sequence[HillEquation], *, shared: bool, cvodes: bool, every: bool = False
) -> list[tuple[str, list[int], list[Answer]]]:
    """Each route, the places it is asked about, and its answers."""
    everyone = list(range(len(equations)))
    time_only = np.ndim(equations[0].eta) > 0
    found = [("taylor", everyone, [ask(partial(_monodromy, e, "taylor")) for e in equations])]
    if cvodes:
        asked = everyone if every else everyone[:1]
        own = [ask(partial(_monodromy, equations[i], "cvodes")) for i in asked]
        found.append(("cvodes", asked, own))
    if time_only:
        return found
    found.append(("hill", everyone, [ask(partial(_characteristic, e)) for e in equations]))
    batches: list[tuple[str, list[int], Callable[[Sequence[HillEquation]], Any]]] = [
        ("hill.batch", everyone, hill.batch.polynomials),
        ("numpy", everyone, lambda es: floquet.batch.polynomials(es, kernel="numpy")),
    ]
    if shared and not equations[0].H:
        some = everyone[:SHARED]
        batches.append(("hill.batch shared", some, hill.batch.polynomials))
        batches.append(("numpy shared", some, _sweep))
    if c_kernel.march(equations[0].n, 1 + len(equations[0].H)) is not None:
        batches.append(
            ("compiled", everyone, lambda es: floquet.batch.polynomials(es, kernel="compiled"))
        )
    for route, places, batch in batches:
        found.append((route, places, _batch(batch, [equations[i] for i in places])))
    return found


def _sweep(equations: Sequence[HillEquation]) -> Any:
    return floquet.batch.sweep(
        equations[0],
        Omega=[e.Omega for e in equations],
        gamma=[e.gamma for e in equations],
        eta=[e.damping for e in equations],
        kernel="numpy",
    )


def _characteristic(e: HillEquation) -> Answer:
    c = characteristic(e)
    errors = np.append(0.0, np.full(e.n, c.error))
    return Answer(c.polynomial, errors, c.T, c.T_error, c.verdict, (c.z,))


def _monodromy(e: HillEquation, method: Any) -> Answer:
    m = monodromy(e, method=method)
    others = (m.z, m.multipliers, m.matrix, m.matrix_error)
    return Answer(m.polynomial, m.errors, m.T, m.T_error, m.verdict, others)


def _batch(run: Callable[[Sequence[HillEquation]], Any], es: list[HillEquation]) -> list[Answer]:
    """All in one call; one by one where one of them is refused."""

    def together(some: Sequence[HillEquation]) -> list[Answer]:
        found = run(some)
        errors = np.repeat(found.errors[:, None], some[0].n + 1, axis=1)
        errors[:, 0] = 0.0
        Omega, eta = np.array([e.Omega for e in some]), np.array([e.damping for e in some])
        judgement = stabilities(found.coefficients, errors, Omega, eta)
        return [
            Answer(
                found.coefficients[i], errors[i], float(judgement.T[i]),
                float(judgement.T_error[i]), str(judgement.verdict[i]), (judgement.z[i],),
            )
            for i in range(len(some))
        ]  # fmt: skip

    answers = _asked(lambda: together(es), len(es))
    if len(es) > 1 and answers[0].refused:
        return [_asked(partial(together, [e]), 1)[0] for e in es]
    return answers


def ask(question: Callable[[], Answer]) -> Answer:
    """The answer, a refusal, or what went wrong."""
    return _asked(lambda: [question()], 1)[0]


def _asked(question: Callable[[], list[Answer]], count: int) -> list[Answer]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            answers = question()
        except (OverflowError, ValueError) as refused:
            said = str(refused)
            answer = Answer(refused=said) if said else Answer(failed=f"{refused!r}, unexplained")
            answers = [answer] * count
        except Exception as error:  # whatever it is, it is what the trial is after
            answers = [Answer(failed=repr(error))] * count
    if caught:
        warned = f"{caught[0].category.__name__}: {caught[0].message}"
        answers = [Answer(**(vars(answer) | {"warned": warned})) for answer in answers]
    return answers


def judged(
    kind: str, number: int, route: str, answer: Answer, known: Truth, shrink: float = 1.0
) -> Judged:
    """Hold an answer against the truth."""
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
    }
    if answer.polynomial is None or answer.errors is None:
        return Judged(**found, status="failed" if answer.failed else "refused")
    numbers = (answer.polynomial, answer.errors, answer.T, answer.T_error, *answer.others)
    if not all(np.all(np.isfinite(x)) for x in numbers):
        wrong["NaN"] = f"T = {answer.T} +- {answer.T_error}, P +- {np.max(answer.errors)}"
    if answer.verdict not in ("stable", "unstable", "undecided"):
        wrong["verdict"] = f"{answer.verdict!r}"
    found["undecided"] = answer.verdict == "undecided"
    if known.P is not None and "NaN" not in wrong:
        found |= _judge_P(answer, known, shrink, wrong) | _judge_T(answer, known, shrink, wrong)
    return Judged(**found, status="answered")


def _judge_P(
    answer: Answer, known: Truth, shrink: float, wrong: dict[str, str]
) -> dict[str, float | None]:
    assert answer.polynomial is not None
    assert answer.errors is not None
    assert known.P is not None
    reported = shrink * answer.errors
    with ctx.workprec(BITS):
        pairs = zip(answer.polynomial, known.P, strict=True)
        off = [abs(arb(float(p)) - t) for p, t in pairs]
        beyond = [k for k, (d, r) in enumerate(zip(off, reported, strict=True)) if d > arb(r)]
        true = np.array([float(d.mid()) for d in off])
    size = float(np.max(np.abs(answer.polynomial)))
    known_errors = np.maximum(true, EPS * size)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = np.where(reported > 0.0, true / reported, np.where(true > 0.0, np.inf, 0.0))
        slack = float(np.max(reported[1:])) / float(np.max(known_errors[1:]))
    if beyond:
        k = max(beyond, key=lambda k: ratio[k])
        wrong["P"] = f"p_{k} off by {true[k]:.3g}, reported {reported[k]:.3g}: {ratio[k]:.3g} times"
        return {"P_ratio": float(np.max(ratio[beyond])), "P_slack": slack}
    # a coefficient that is exact to the last digit is known to more than the arbiter's
    return {"P_ratio": float(np.max(np.minimum(ratio, 1.0))), "P_slack": slack}


def _judge_T(answer: Answer, known: Truth, shrink: float, wrong: dict[str, str]) -> dict[str, Any]:
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
            wrong["T"] = f"off by {_off(answer.T, growth.T):.3g}, reported {reported:.3g}"
        return {"T_skipped": True}
    with ctx.workprec(BITS):
        off = abs(arb(answer.T) - growth.T)
        true, beyond = float(off.mid()), bool(off > arb(reported) + NOTHING)
    e = known.equation
    size = max(e.Omega / np.pi, abs(answer.T), float(np.max(np.abs(e.eta))))
    ratio = true / reported if reported > 0.0 else float("inf") if beyond else 0.0
    if beyond:
        wrong["T"] = f"off by {true:.3g}, reported {reported:.3g}: {ratio:.3g} times"
    return {"T_ratio": ratio, "T_slack": reported / max(true, EPS * size)}


def _off(T: float, known: Any) -> float:
    return float((arb(T) - known).abs_lower())
