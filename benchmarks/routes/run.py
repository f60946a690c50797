"""The trial of both routes on general systems, as a command."""

import argparse
import json
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from flint import arb, ctx
from rich.console import Console
from rich.table import Table

from benchmarks.honesty import symmetric
from benchmarks.honesty.arbiter import TooWide
from benchmarks.routes.systems import KINDS, system
from compare import CrossCheck, crosscheck
from compare.output import check_writable, write_whole
from floquet.enclosure import general
from floquet.enclosure.judgement import BITS
from hill import PeriodicEquation, characteristic

# Systems of a class.
COUNT = 64

# One in so many is held against the arbiter, which takes a second; every one of few coordinates
# where a symmetry decides the verdict.
SAMPLE, SAMPLE_OF_PAIRS = 8, 2

# Bits of the arbiter's polynomial, of the largest coefficient. Where multipliers are more powers of
# ten apart than that it does not tell T: more bits take minutes, and only P is judged.
BITS_OF_P = 140

# What is asked of the difference, over the largest coefficient.
ASKED = 1e-11

# Of the arbiter's T: far below every bound.
WIDE_T = 1e-25

EPS = float(np.finfo(float).eps)
WIDE = 100

LEGEND = f"""\
apart: the largest difference of a coefficient of the two polynomials, over the
largest coefficient; above: systems with more than {ASKED:.0e}. agree: every
coefficient within the sum of its two bounds, which are at most `bound` of the
largest. moves: by how much of itself P moves, of the systems above, if every
number of the equation is off by an ulp of its matrix's largest. judged: held
against ball arithmetic, and T and the verdict too where that tells them; wrong:
bounds of P or T too small, and wrong verdicts."""


@dataclass(frozen=True)
class Outcome:
    """One system by both routes.

    Attributes
    ----------
    apart, bound : float
        Largest difference of coefficients, and largest sum of bounds, over the largest coefficient.
    moves : float
        What an ulp of the data moves P by, over the largest coefficient, to first order; asked only
        where `apart` is above `ASKED`.
    judged, told : bool
        Whether the arbiter was asked, and had an answer; and one narrow enough for T and verdict.
    wrong : tuple of str
        What is wrong, the routes' own agreement apart.
    """

    kind: str
    seed: int
    order: int
    agree: bool
    verdict: str
    apart: float
    bound: float
    moves: float
    judged: bool
    told: bool
    wrong: tuple[str, ...]
    refused: str = ""


def outcome(kind: str, seed: int, *, judge: bool) -> Outcome:
    """Ask both routes, and the arbiter."""
    e = system(kind, seed)
    try:
        x = crosscheck(e)
    except (OverflowError, ValueError) as refused:
        return Outcome(
            kind, seed, e.order, True, "", 0.0, 0.0, 0.0, False, False, (), refused=str(refused)
        )
    size = float(np.max(np.abs(x.floquet.polynomial)))
    known = reference(e) if judge else None
    return Outcome(
        kind=kind,
        seed=seed,
        order=e.order,
        agree=x.routes_agree,
        verdict=x.verdict,
        apart=x.difference / size,
        bound=float(np.max(x.hill.errors + x.floquet.errors)) / size,
        moves=moved_by_an_ulp(e) / size if x.difference > ASKED * size else 0.0,
        judged=known is not None,
        told=known is not None and tells(symmetric.truth_of(e, known), e.Omega),
        wrong=() if known is None else wrong(x, e, known, paired=kind in symmetric.KINDS),
    )


def reference(e: PeriodicEquation) -> list[Any] | None:
    """The arbiter's polynomial; None where it takes too much."""
    try:
        return general.reference(e, narrow=BITS_OF_P)
    except TooWide:
        return None


def tells(truth: symmetric.Truth, Omega: float) -> bool:
    """Whether the arbiter's polynomial is narrow enough for T and a verdict."""
    T = truth.T
    return bool(truth.verdict != "unknown" and T.is_finite() and float(T.rad()) < WIDE_T * Omega)


def moved_by_an_ulp(e: PeriodicEquation) -> float:
    """What a coefficient of P moves by at most if all numbers of C and K, or A, are an ulp off."""
    if e.A is not None:
        off = PeriodicEquation.first_order(A=e.A, Omega=e.Omega, data_error=EPS)
    else:
        assert e.K is not None
        off = PeriodicEquation(M=e.M, C=e.C, K=e.K, Omega=e.Omega, data_error=EPS)
    return characteristic(off).data_error


def wrong(x: CrossCheck, e: PeriodicEquation, known: list[Any], *, paired: bool) -> tuple[str, ...]:
    """What the arbiter finds fault with."""
    truth = symmetric.truth_of(e, known)
    told = tells(truth, e.Omega)
    true = truth.verdict if paired or truth.verdict != "stable" else _by_sign(truth.T)
    found = []
    for name, route in (("hill", x.hill), ("floquet", x.floquet)):
        with ctx.workprec(BITS):
            pairs = zip(route.polynomial, route.errors, known, strict=True)
            if any(abs(arb(float(p)) - t) > arb(float(r)) for p, r, t in pairs):
                found.append(f"{name}: a bound of P")
            if told and abs(arb(route.T) - truth.T) > arb(route.T_error) + WIDE_T:
                found.append(f"{name}: the bound of T")
        if told and route.verdict not in (true, "undecided"):
            found.append(f"{name}: {route.verdict}, is {true}")
    return tuple(found)


def _by_sign(T: Any) -> str:
    return "stable" if T < 0 else "boundary"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run; 0 where the routes agree and nothing is wrong, else 1."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.routes",
        description="Random general systems by both routes, a sample against ball arithmetic.",
    )
    parser.add_argument("--count", type=int, default=COUNT, metavar="N", help="of a class")
    parser.add_argument("--classes", nargs="+", choices=KINDS, metavar="CLASS", default=KINDS,
                        help=f"of {'; '.join(KINDS)}")  # fmt: skip
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="the first")
    parser.add_argument("--json", type=Path, metavar="FILE", help="every system's outcome")
    options = parser.parse_args(arguments)
    if options.json is not None:
        try:
            check_writable(options.json)
        except (OSError, ValueError) as error:
            parser.error(f"--json {options.json}: {error}")
    console = Console(width=None if sys.stdout.isatty() else WIDE, highlight=False)
    started = time.perf_counter()
    found: list[Outcome] = []
    for kind in options.classes:
        every = SAMPLE_OF_PAIRS if kind in symmetric.KINDS else SAMPLE
        seeds = range(options.seed, options.seed + options.count)
        found += [outcome(kind, seed, judge=seed % every == 0) for seed in seeds]
        print(f"{kind}: {time.perf_counter() - started:.0f} s", file=sys.stderr)
    console.print(table(found))
    console.print(LEGEND)
    for x in found:
        if x.wrong or not x.agree:
            said = "; ".join(x.wrong) or "the routes do not agree"
            console.print(f"{x.kind} {x.seed} (m = {x.order}): {said}")
    if options.json is not None:
        write_whole(options.json, json.dumps([asdict(x) for x in found], indent=1) + "\n")
    return int(any(x.wrong or not x.agree for x in found))


def table(found: Sequence[Outcome]) -> Table:
    """A class a line."""
    made = Table(
        title="Both routes, class by class", title_justify="left", box=None, pad_edge=False,
        padding=(0, 1, 0, 0),
    )  # fmt: skip
    made.add_column("class", no_wrap=True)
    for head, _ in COLUMNS:
        made.add_column(head, justify="right", no_wrap=True)
    kinds = list(dict.fromkeys(x.kind for x in found))
    for name in (*kinds, "all"):
        some = [x for x in found if name in (x.kind, "all")]
        made.add_row(name, *(count(some) for _, count in COLUMNS))
    return made


def _most(values: Sequence[float]) -> str:
    return f"{max(values):.0e}" if values else ""


def _above(found: Sequence[Outcome]) -> list[Outcome]:
    return [x for x in found if x.apart > ASKED]


COLUMNS: tuple[tuple[str, Callable[[Sequence[Outcome]], str]], ...] = (
    ("systems", lambda s: str(len(s))),
    ("refused", lambda s: str(sum(bool(x.refused) for x in s))),
    ("agree", lambda s: str(sum(x.agree and not x.refused for x in s))),
    ("apart", lambda s: _most([x.apart for x in s])),
    ("bound", lambda s: _most([x.bound for x in s])),
    ("above", lambda s: str(len(_above(s)))),
    ("moves", lambda s: _most([x.moves for x in _above(s)])),
    ("judged", lambda s: str(sum(x.judged for x in s))),
    ("T too", lambda s: str(sum(x.told for x in s))),
    ("wrong", lambda s: str(sum(bool(x.wrong) for x in s))),
)
