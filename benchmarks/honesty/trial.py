"""What every route says of a system, held against the arbiter."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

import floquet.batch
import hill.batch
from benchmarks.honesty.judge import Answer, Judged, judged, truth
from benchmarks.honesty.systems import GROUP, SHARED, members
from floquet import monodromy
from floquet.batch import c_kernel
from hill import HillEquation, characteristic
from hill.stability import stabilities

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
NUMBERS = ("P", "T")


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
    return Answer(c.polynomial, errors, c.T, c.T_error, c.verdict, (c.z,), _named(c.remark))


def _monodromy(e: HillEquation, method: Any) -> Answer:
    m = monodromy(e, method=method)
    others = (m.z, m.multipliers, m.matrix, m.matrix_error)
    return Answer(m.polynomial, m.errors, m.T, m.T_error, m.verdict, others, _named(m.remark))


def _named(remark: str) -> frozenset[str]:
    """Which numbers a result's remark says are poorly known."""
    return frozenset(name for name in NUMBERS if f"{name} is known to" in remark)


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
                frozenset(n for n, p in (("P", found.poor[i]), ("T", judgement.poor[i])) if p),
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
    said = caught(question)
    wrong = said.wrong.get("other", "")
    if said.found is not None:
        return [Answer(**(vars(answer) | {"warned": wrong})) for answer in said.found]
    if said.refused:
        return [Answer(refused=said.refused, warned=wrong)] * count
    return [Answer(failed=wrong)] * count


@dataclass(frozen=True, eq=False)
class Said:
    """What came of a question: what was found, or a refusal; and what should not have been."""

    found: Any = None
    refused: str = ""
    wrong: dict[str, str] = field(default_factory=dict)


def caught(question: Callable[[], Any]) -> Said:
    """Ask; a refusal explains itself, everything else that is raised or warned of is wrong."""
    found, refused = None, ""
    wrong: dict[str, str] = {}
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        try:
            found = question()
        except (OverflowError, ValueError) as error:
            refused = str(error)
            if not refused:
                wrong["other"] = f"{error!r}, unexplained"
        except Exception as error:  # whatever it is, it is what the trial is after
            wrong["other"] = repr(error)
    if heard:
        wrong.setdefault("other", f"{heard[0].category.__name__}: {heard[0].message}")
    return Said(found, refused, wrong)
