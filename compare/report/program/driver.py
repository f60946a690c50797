"""PROGRAM DRIVER as a generator: a deck in, one event for every WRITE out, nothing printed here."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np

from compare.report.program.deck import Deck, DeckRun
from compare.report.program.evaluators import Evaluator
from compare.report.program.listing import Case, NoBoundary, Stab, search
from compare.report.program.muller import in_order

# sqrt, log and the roots themselves leave log R of a stable beam at 1e-16 or so of either sign.
NOISE = 1e-12

# Below half a unit of the three decimals that OMEGB is printed with.
LEAST_OMEGB = 0.0005


@dataclass(frozen=True)
class Start:
    """A control card has been read: a run of FORMAT 1, 2 or 3 begins."""

    format: int


@dataclass(frozen=True)
class TableHeading:
    """Heading of a table of natural frequencies."""

    case: Case
    modes: int
    count: int


@dataclass(frozen=True)
class FrequencyLine:
    """Natural frequencies at one thrust."""

    TO: float
    frequencies: tuple[float, ...]


@dataclass(frozen=True)
class ResonanceHeading:
    """Heading of a parametric resonance: 2 FREQ(high), or FREQ(high) + or - FREQ(low).

    Attributes
    ----------
    sign : {"2", "+", "-"}
    high, low : int
        Counted from 1.
    line : FrequencyLine
    case : Case or None
        None where the stepped program does not write its parameters.
    """

    sign: str
    high: int
    low: int
    line: FrequencyLine
    case: Case | None
    modes: int


@dataclass(frozen=True)
class Evaluation:
    """What STAB writes: one forcing frequency, the three z in MULLER's order, T."""

    OMEGB: float
    roots: tuple[complex, ...]
    STAB1: float
    unstable: bool
    doubtful: int


@dataclass(frozen=True)
class Note:
    """A line of our own: a search that SWITCH would not end; or, `failed`, nothing to compute."""

    why: str
    failed: bool


Event = Note | Start | TableHeading | FrequencyLine | ResonanceHeading | Evaluation


def events(deck: Deck, evaluator: Evaluator) -> Iterator[Event]:
    """All that a deck makes DRIVER write.

    Parameters
    ----------
    deck : Deck
    evaluator : Evaluator
        Who computes frequencies and z.

    Yields
    ------
    Event

    Raises
    ------
    ValueError
        STAB without control (SPC = 0). What goes wrong at a single resonance is a `Note` instead.
    """
    for run in deck.runs:
        yield Start(run.format)
        yield from _run(deck, run, evaluator)


def blocks(deck: Deck) -> int:
    """How many frequency lines and resonances `events` goes through."""
    return sum(run.count * (1 if run.format == 1 else 9) for run in deck.runs)


def _run(deck: Deck, run: DeckRun, evaluator: Evaluator) -> Iterator[Event]:
    N = deck.constants.N
    # DRIVER drops the rotation here, once, by the first SPC of its range
    count = N if next(run.cases())[0].SPC == 0.0 else N + 1
    for case, heading in run.cases():
        if run.format != 1 and (count == N or case.SPC == 0.0):
            raise ValueError(
                "SPC = 0: the listing drops the rotation, which leaves two coordinates, and STAB "
                "wants three roots; FORMATs 2 and 3 need SPC other than 0 (FORMAT 1 does not)"
            )
        with _named(f"TO = {case.TO:g}"):
            found = evaluator.frequencies(deck.constants, case, count)
        line = FrequencyLine(case.TO, found)
        if run.format == 1:
            if heading:
                yield TableHeading(case, N, count)
            yield line
        else:
            yield from _resonances(deck, run, evaluator, case, line)


def _resonances(
    deck: Deck, run: DeckRun, evaluator: Evaluator, case: Case, line: FrequencyLine
) -> Iterator[Event]:
    evaluate = partial(_evaluate, partial(evaluator.stab, deck.constants, case))
    for sign, high, low, OMEGB in places(line.frequencies):
        # the stepped DRIVER has no WRITE (6,27) among the sums
        silent = deck.program == "stepped" and sign == "+"
        yield ResonanceHeading(sign, high, low, line, None if silent else case, deck.constants.N)
        try:
            if run.format == 2:
                yield _evaluation(evaluate(OMEGB))
            else:
                yield from map(_evaluation, search(evaluate, OMEGB, case.ETA))
        except NoBoundary as error:
            yield Note(str(error), failed=False)
        except ValueError as error:
            yield Note(f"not computed: {error}", failed=True)


def places(frequencies: tuple[float, ...]) -> Iterator[tuple[str, int, int, float]]:
    """The resonances in DRIVER's order: 2 omega_i, then the sums, then the differences."""
    numbered = list(enumerate(frequencies, start=1))
    for k, f in numbered:
        yield "2", k, k, 2.0 * f
    for sign, way in (("+", 1.0), ("-", -1.0)):
        for (low, f), (high, g) in combinations(numbered, 2):
            yield sign, high, low, g + way * f


def _evaluate(stab: Callable[[float], Stab], OMEGB: float) -> Stab:
    if OMEGB < LEAST_OMEGB:
        raise ValueError(
            f"OMEGB = {OMEGB:.3g} is no forcing frequency (without thrust the lowest natural "
            "frequency is zero; in flutter two are equal)"
        )
    with _named(f"OMEGB = {OMEGB:.6g}"):
        return stab(OMEGB)


def _evaluation(found: Stab) -> Evaluation:
    T = 0.0 if abs(found.STAB1) < NOISE else found.STAB1
    roots = in_order([complex(z) for z in found.roots])
    return Evaluation(found.OMEGB, roots, T, found.unstable, found.doubtful)


@contextmanager
def _named(where: str) -> Iterator[None]:
    """What numpy would warn of is an error here, and says where it happened."""
    try:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            yield
    except (ArithmeticError, ValueError) as error:
        raise ValueError(f"{where}: {error}") from None
