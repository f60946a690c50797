"""Both routes' enclosures of seeded systems: ``python -m benchmarks.enclosures``.

The systems are those of the trial of the bounds, class by class, made to be difficult. The balls of
P and of T must meet, no verdict may be the opposite of another, neither of the other route's nor of
what double precision shows.
"""

import argparse
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import Console

import floquet
import hill
from benchmarks.honesty.systems import CLASSES, members
from compare import crosscheck
from compare.console import bare_table
from hill import HillEquation

# A damping matrix has no z, and so no determinant to enclose.
NAMES = tuple(name for name in CLASSES if name != "damping matrices")

# Bits of the determinant's P.
BITS = 60

# Rows of a group, coordinates times harmonics: with more a system takes a minute.
MAX_ROWS = 24


@dataclass(frozen=True)
class Outcome:
    """One system.

    Attributes
    ----------
    refused : str
        Why a route has no enclosure; empty where both have one.
    meet : bool
        Whether all balls of P, and those of T, meet.
    opposed : bool
        Whether any two verdicts, double precision's too, are opposite.
    proven, shown : bool
        Whether the balls decide, and whether double precision does.
    """

    refused: str
    meet: bool
    opposed: bool
    proven: bool
    shown: bool


def outcome(equation: HillEquation) -> Outcome:
    """Enclose a system by both routes, and hold double precision against that."""
    try:
        shown = crosscheck(equation).verdict
    except OverflowError:
        shown = "undecided"
    decided = shown != "undecided"
    try:
        by_time, by_determinant = floquet.enclose(equation), hill.enclose(equation, bits=BITS)
    except ValueError as error:
        return Outcome(str(error), True, False, False, decided)
    pairs = zip(by_time.polynomial, by_determinant.polynomial, strict=True)
    meet = all(a.overlaps(b) for a, b in pairs) and bool(by_time.T.overlaps(by_determinant.T))
    verdicts = {by_time.verdict, by_determinant.verdict, shown} - {"undecided"}
    proven = {by_time.verdict, by_determinant.verdict} != {"undecided"}
    return Outcome("", meet, len(verdicts) > 1, proven, decided)


def systems(name: str, count: int, seed: int) -> list[HillEquation]:
    """So many of a class, those that take a minute left out."""
    found: list[HillEquation] = []
    while len(found) < count:
        for e in members(name, seed, 1):
            reach = 1 if not e.H else e.ratio * len(e.H)
            if e.n * reach <= MAX_ROWS and np.ndim(e.eta) == 0:
                found.append(e)
        seed += 1
    return found[:count]


def main(argv: Sequence[str] | None = None) -> int:
    """Run the classes; 1 where balls do not meet or verdicts are opposite."""
    p = argparse.ArgumentParser(prog="python -m benchmarks.enclosures")
    p.add_argument("--count", type=int, default=36, help="systems of a class (default 36)")
    p.add_argument("--seed", type=int, default=1, help="the first (default 1)")
    options = p.parse_args(argv)
    console, table = Console(width=100), bare_table()
    for head in ("class", "systems", "refused", "meet", "opposed", "undecided, double", "proof"):
        table.add_column(head, justify="left" if head == "class" else "right")
    start, everything = time.process_time(), []
    for name in NAMES:
        found = [outcome(e) for e in systems(name, options.count, options.seed)]
        everything += found
        table.add_row(name, *_counts(found))
    table.add_row("all", *_counts(everything))
    console.print(table)
    console.print(f"{time.process_time() - start:.0f} s of processor time")
    return int(any(o.opposed or not o.meet for o in everything))


def _counts(found: Sequence[Outcome]) -> list[str]:
    both = [o for o in found if not o.refused]
    counts = (
        len(found),
        len(found) - len(both),
        sum(o.meet for o in both),
        sum(o.opposed for o in both),
        sum(not o.shown for o in found),
        sum(not o.proven for o in found),
    )
    return [str(n) for n in counts]


if __name__ == "__main__":
    sys.exit(main())
