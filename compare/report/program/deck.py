"""Decks as DRIVER reads them: constants, ranges to step through, and what to run with them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from math import prod
from typing import Any, cast

import numpy as np

from compare.report.program.cards import Cards, shipped
from compare.report.program.listing import Case, Stepped, Uniform

MAX_VALUES = 10_000
"""Values one range may take; the report's take eleven at most."""

SLACK = 0.001
"""DRIVER steps on while below the last value plus this, or above it less this."""

CONTROL, RANGE, STEP = "3I5", "3E12.0,36X", "9E6.1"


@dataclass(frozen=True)
class Range:
    """One variable that DRIVER steps through: its name in `Case`, and its values.

    Where `heading`, a new value starts a new table of natural frequencies.
    """

    name: str
    values: tuple[float, ...]
    heading: bool


@dataclass(frozen=True)
class DeckRun:
    """What one control card asks for.

    Attributes
    ----------
    format : int
        1 natural frequencies, 2 stability at each resonance, 3 with SWITCH around it.
    ranges : tuple of Range
        Innermost first.
    case : Case
        What is not stepped through.
    """

    format: int
    ranges: tuple[Range, ...]
    case: Case

    def cases(self) -> Iterator[tuple[Case, bool]]:
        """Every combination in DRIVER's order, and whether a table starts with it."""
        outermost_first = self.ranges[::-1]
        last: tuple[float, ...] | None = None
        for values in product(*(r.values for r in outermost_first)):
            heading = last is None
            if last is not None:
                changed = next(k for k, v in enumerate(values) if v != last[k])
                heading = outermost_first[changed].heading
            last = values
            named = zip((r.name for r in outermost_first), values, strict=True)
            case = replace(self.case, **cast(dict[str, Any], dict(named)))
            yield case, heading

    @property
    def count(self) -> int:
        """How many combinations."""
        return prod(len(r.values) for r in self.ranges)


@dataclass(frozen=True, eq=False)
class Deck:
    """A whole deck: the program's constants, and its runs."""

    program: str
    constants: Uniform | Stepped
    runs: tuple[DeckRun, ...]


def read_deck(cards: Cards, program: str) -> Deck:
    """All cards, up to the control card that stops the program.

    Parameters
    ----------
    cards : Cards
    program : {"uniform", "stepped"}

    Raises
    ------
    ValueError
        A malformed card, by its number and columns; increments that would never end.
    """
    constants: Uniform | Stepped
    if program == "uniform":
        constants, case, ranges = _uniform(cards)
    else:
        constants, case, ranges = _stepped(cards)
    if constants.N != 2:
        raise ValueError(
            f"{cards.name}, card 1: N = {constants.N}, must be 2: STAB expands (6.3.6) for it only"
        )
    runs = []
    while True:
        *switches, icount = _control(cards)
        itr, nat = switches
        runs.append(DeckRun(1 if nat else 3 if itr else 2, tuple(ranges), case))
        if icount == 2:
            return Deck(program, constants, tuple(runs))
        if icount == 0:
            ranges[0] = _range(cards, "TO", heading=False)


def _uniform(cards: Cards) -> tuple[Uniform, Case, list[Range]]:
    constants, XG, S1 = uniform_constants(cards)
    S = int(S1 + 0.5)
    if not 1 <= S <= 5:
        raise ValueError(f"{cards.name}, card 1, columns 18-24: S = {S1:g}, must be 1 to 5")
    FQ = cards.read(RANGE)[0]
    # its range is read and never used; 1 says that there are no initial conditions
    Q = int(FQ + 0.5)
    OMEGL, ETA, SPC, GAMMA, TO, GA = (
        _range(cards, name, heading)
        for name, heading in (
            ("OMEGL", False),
            ("ETA", True),
            ("SPC", True),
            ("GAMMA", False),
            ("TO", False),
            ("GA", True),
        )
    )
    case = Case(XG=XG, SPC=0.0, TO=0.0, GAMMA=0.0, Q=Q if Q > 1 else 0, S=S)
    return constants, case, [TO, OMEGL, ETA, SPC, GAMMA, GA]


def _stepped(cards: Cards) -> tuple[Stepped, Case, list[Range]]:
    constants = stepped_constants(cards)
    XG, OMEGL, ETA, SPC, GAMMA, TO = (
        _range(cards, name, heading)
        for name, heading in (
            ("XG", True),
            ("OMEGL", False),
            ("ETA", True),
            ("SPC", True),
            ("GAMMA", False),
            ("TO", False),
        )
    )
    numbers = cards.read(STEP)
    RC, RA, RI = (_down(cards, name, numbers, k) for k, name in enumerate(("RC", "RA", "RI")))
    case = Case(XG=0.0, SPC=0.0, TO=0.0, GAMMA=0.0)
    return constants, case, [TO, RC, RA, RI, OMEGL, ETA, SPC, GAMMA, XG]


def _control(cards: Cards) -> tuple[int, int, int]:
    numbers = cards.read(CONTROL)
    for k, (name, most) in enumerate((("ITR", 1), ("NAT", 1), ("ICOUNT", 2))):
        ok = 0 <= numbers[k] <= most
        cards.require(CONTROL, k, ok, f"{name} = {numbers[k]:g}, must be 0 to {most}")
    itr, nat, icount = (int(number) for number in numbers)
    return itr, nat, icount


def _range(cards: Cards, name: str, heading: bool) -> Range:
    """A card of a first value, a last one and an increment."""
    first, last, step = cards.read(RANGE)
    cards.require(RANGE, 2, first + step >= last + SLACK or step > 0.0, _endless(name, step))
    values = _values(first, last, step)
    cards.require(RANGE, 2, len(values) <= MAX_VALUES, f"DEL{name} = {step:g}: too many values")
    if name == "OMEGL":
        cards.require(RANGE, 0, first > 0.0, f"OMEGL = {first:g}, must be > 0")
    if name == "XG":
        inside = min(values) >= 0.0 and max(values) <= 1.0
        cards.require(RANGE, 0, inside, "XG: must stay between 0 and 1")
    return Range(name, values, heading)


def _down(cards: Cards, name: str, numbers: list[float], k: int) -> Range:
    """One of three such triples on one card, stepped downward."""
    first, last, step = numbers[3 * k : 3 * k + 3]
    ends = first - step <= last - SLACK or step > 0.0
    cards.require(STEP, 3 * k + 2, ends, _endless(name, step))
    values = tuple(-x for x in _values(-first, -last, step))
    cards.require(
        STEP, 3 * k + 2, len(values) <= MAX_VALUES, f"DEL{name} = {step:g}: too many values"
    )
    if name == "RC":
        inside = min(values) >= 0.0 and max(values) <= 1.0
        cards.require(STEP, 0, inside, "RC: must stay between 0 and 1")
    else:
        cards.require(STEP, 3 * k, min(values) > 0.0, f"{name}: must stay > 0")
    return Range(name, values, heading=True)


def _endless(name: str, step: float) -> str:
    return f"DEL{name} = {step:g} never ends: {name} would not reach its last value"


def _values(first: float, last: float, step: float) -> tuple[float, ...]:
    """The first value always, and more of them up to the last."""
    values = [first]
    while len(values) <= MAX_VALUES:
        # rounded, for no error to gather: cards have fewer decimals
        following = round(first + len(values) * step, 9)
        if not following < last + SLACK:
            break
        values.append(following)
    return tuple(values)


def uniform_constants(cards: Cards) -> tuple[Uniform, float, float]:
    """The first cards of the uniform deck: constants, and the XG and S1 among them."""
    N, XG, _, S1, PI = cards.read("I3,3E7.0,1E12.0")
    modes = np.array([cards.read("4E12.0") for _ in range(5)])
    R, B, PH, DPH = modes.T
    DPHG = np.array(cards.read("5E12.0"))
    return Uniform(int(N), PI, R, B, PH, DPH, DPHG), XG, S1


def stepped_constants(cards: Cards) -> Stepped:
    """The first cards of the stepped deck."""
    N, PI = cards.read("I5,E12.1")
    R, B = (np.array(cards.read("5E12.1")) for _ in range(2))
    tables = (np.reshape(cards.read("7E10.1", 50), (5, 10)).T for _ in range(4))
    return Stepped(int(N), PI, R, B, *tables)


def constants(name: str) -> Uniform | Stepped:
    """Constants of the shipped deck, "uniform" or "stepped"."""
    cards = shipped(name)
    return uniform_constants(cards)[0] if name == "uniform" else stepped_constants(cards)
