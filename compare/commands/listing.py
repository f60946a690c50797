"""``verify listing``: a data deck in, the output of the report's programs out."""

import argparse
import sys
from collections import Counter
from hashlib import sha256
from pathlib import Path
from typing import Any

from compare.commands.terminal import deliver, progress
from compare.output import check_writable
from compare.provenance import as_comment
from compare.report.program.cards import Cards, from_file, shipped
from compare.report.program.collate import (
    Difference,
    LineComparison,
    State,
    collate,
    compare_lines,
    differences,
    printed_output,
)
from compare.report.program.deck import Deck, read_deck
from compare.report.program.driver import FrequencyLine, Note, ResonanceHeading, blocks, events
from compare.report.program.evaluators import EVALUATORS, Evaluator
from compare.report.program.formats import lines

SUMMARY = "a data deck of the report's programs in, their output out"
EPILOG = """\
examples:
  verify listing uniform                 the report's deck, as the 7094 ran it
  verify listing stepped --route hill    the same, by the converged determinant
  verify listing uniform --deck mine.txt --output mine.lst
  verify listing uniform --compare       what differs from the printed output

A deck has the card images that DRIVER reads, in the same columns (appendix B-5
and B-6). FORMAT 1 is natural frequencies against thrust (NAT = 1), 2 the
stability at each parametric resonance (ITR = 0), 3 the search of SWITCH around
it (ITR = 1).

routes:
  as-run   the report's program: its constants, truncation and slips
  hill     the beam's exact constants and the determinant with its tail summed
  floquet  matrices by quadrature and the monodromy matrix

exit status: 0 done; 1 where a resonance could not be computed, which its line
says, or, with --compare, where a line differs that is not in the list of known
differences (it holds for the report's deck as run); 2 wrong usage or input,
such as a malformed card, named with its columns."""

STATES: dict[State, str] = {
    "same": "to the last character",
    "order": "with its roots in another order",
    "unit": "to one unit of the last digit, or but for the sign of a zero",
    "differs": "not",
}


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("program", choices=("uniform", "stepped"), help="which of the two programs")
    p.add_argument("--deck", type=Path, metavar="FILE", help="data cards (default: the report's)")
    p.add_argument(
        "--route", choices=tuple(EVALUATORS), default="as-run", help="who computes (default as-run)"
    )
    p.add_argument(
        "--compare", action="store_true", help="print what differs from the report's output instead"
    )
    p.add_argument(
        "--output", type=Path, metavar="FILE", help="write there instead of the terminal"
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    cards = shipped(options.program) if options.deck is None else _opened(options.deck)
    deck = read_deck(cards, options.program)
    if options.output is not None:
        check_writable(options.output)
    written, failed = regenerate(deck, EVALUATORS[options.route])
    status = 1 if failed else 0
    if options.compare:
        judged = collate(printed_output(deck.program), written)
        written, known = report(deck.program, judged)
        status = 0 if known and not failed else 1
    # the terminal has the report's output to the last character
    made = "" if options.output is None else as_comment(_about(cards, options))
    deliver("\n".join(written) + "\n" + made, options.output)
    if failed:
        print(f"verify listing: not computed: {failed} of the resonances", file=sys.stderr)
    return status


def regenerate(deck: Deck, evaluator: Evaluator) -> tuple[list[str], int]:
    """The whole output, and how many resonances could not be computed; with a bar meanwhile."""
    written, failed = [], 0
    with progress("blocks", blocks(deck)) as advance:
        for event in events(deck, evaluator):
            written += lines(event)
            failed += isinstance(event, Note) and event.failed
            if isinstance(event, FrequencyLine | ResonanceHeading):
                advance(event)
    return written, failed


def report(program: str, judged: list[LineComparison]) -> tuple[list[str], bool]:
    """Lines that say what differs and why, and whether everything that differs is known."""
    known = {d.place: d for d in differences() if d.program == program}
    written, last, strangers = [], None, 0
    for found in (j for j in judged if j.state == "differs"):
        listed = known.get(found.place)
        if listed is not None and not _as_listed(listed, found):
            listed = None
        strangers += listed is None
        if found.place[:3] != last:
            last = found.place[:3]
            step = f", evaluation {found.place.step}" if found.place.step else ""
            written += ["", f"FORMAT ({found.place.format}) {found.place.block}{step}".rstrip()]
            written += [f"  {listed.kind}: {listed.cause}" if listed else "  not in the list"]
        written += [f"  printed   {found.printed or '(no such line)'}"]
        written += [f"  computed  {found.computed or '(no such line)'}"]
        if listed and listed.corrected:
            written += [f"  believed  {listed.corrected}"]
    return [*written[1:], "", *_summary(judged, strangers)], not strangers


def _as_listed(listed: Difference, found: LineComparison) -> bool:
    """Whether a line differs just as the list says; to one unit, for other arithmetic than ours."""
    return (
        listed.printed == found.printed
        and found.computed is not None
        and compare_lines(listed.computed, found.computed) != "differs"
    )


def _summary(judged: list[LineComparison], strangers: int) -> list[str]:
    """Counts, blank lines left out."""
    counts = Counter(j.state for j in judged if j.printed and j.printed.strip())
    total = sum(counts.values())
    written = [f"{total} printed lines come back:"]
    written += [f"{counts[state]:6}  {words}" for state, words in STATES.items() if counts[state]]
    extra = sum(j.printed is None for j in judged)
    written += [f"{extra:6}  lines more than printed"] if extra else []
    return [*written, f"{strangers:6}  differences without a known cause"]


def _about(cards: Cards, options: argparse.Namespace) -> dict[str, Any]:
    """Whose program, by which route, and a name for the deck's cards."""
    return {
        "program": options.program,
        "route": options.route,
        "deck": "the report's" if options.deck is None else "one's own",
        "cards": sha256("\n".join(cards.lines).encode()).hexdigest()[:16],
        "compared_with_print": options.compare,
    }


def _opened(path: Path) -> Cards:
    try:
        return from_file(path)
    except OSError as error:
        raise ValueError(
            f"deck = {str(path)!r}: {(error.strerror or str(error)).lower()}"
        ) from None
    except UnicodeDecodeError:
        raise ValueError(f"deck = {str(path)!r}: is not text") from None
