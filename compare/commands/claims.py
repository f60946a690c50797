"""``verify claims``: the report's conclusions, each with its numbers and a verdict."""

import argparse
import sys
from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from compare.commands.terminal import deliver, progress, terminal
from compare.console import as_file, bare_table, say
from compare.output import check_writable
from compare.provenance import in_words
from compare.report.claims import page
from compare.report.claims.both_routes import RoutesDisagree
from compare.report.claims.finding import VERDICTS
from compare.report.claims.run import JudgedClaim, judge, select

STYLES = {"confirmed": "green", "qualified": "yellow", "refuted": "red"}
SUMMARY = "the report's conclusions, each with numbers and a verdict"
EPILOG = """\
examples:
  verify claims                       every conclusion, one line each
  verify claims gap half-circles      these two, with their numbers and the rule
                                      of the verdict
  verify claims --verdict refuted     only those that do not hold
  verify claims --format md           all numbers, as in docs/claims.md

verdicts, which follow from the numbers by a rule stated with each claim:
  confirmed   it holds
  qualified   it holds with a restriction that the report does not make
  refuted     it does not hold

exit status: 0 the routes agree on every number and every verdict is the one on
record; 1 they do not; 2 wrong usage or input."""


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("claim", nargs="*", metavar="ID", help="a claim such as half-circles")
    p.add_argument("--verdict", choices=VERDICTS, help="list only claims with this verdict")
    p.add_argument(
        "--format",
        choices=page.FORMATS,
        help="text, or what the output's suffix says (.json, .md)",
    )
    p.add_argument(
        "--output", type=Path, metavar="FILE", help="write there instead of the terminal"
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    chosen = select(options.claim)
    if options.output is not None:
        check_writable(options.output)
    try:
        with progress("claims", len(chosen)) as advance:
            judged = judge([claim.id for claim in chosen], progress=advance)
    except RoutesDisagree as error:
        print(f"verify claims: {error}", file=sys.stderr)
        return 1
    content = _content(judged, options)
    if content is None:
        print_text(_shown(judged, options), judged, details=bool(options.claim), console=terminal())
    else:
        deliver(content, options.output)
    return 0 if all(one.as_expected for one in judged) else 1


def _shown(judged: tuple[JudgedClaim, ...], options: argparse.Namespace) -> tuple[JudgedClaim, ...]:
    wanted = options.verdict
    return tuple(one for one in judged if wanted in (None, one.finding.verdict))


def _content(judged: tuple[JudgedClaim, ...], options: argparse.Namespace) -> str | None:
    """What to write; None for text on the terminal."""
    kind = options.format
    if kind is None:
        suffix = options.output.suffix.lstrip(".") if options.output else "text"
        kind = suffix if suffix in page.FORMATS else "text"
    shown = _shown(judged, options)
    if kind == "json":
        return page.as_json(shown, judged)
    if kind == "md":
        return page.markdown(shown)
    if options.output is None:
        return None
    details = bool(options.claim)
    return as_file(lambda c: print_text(shown, judged, details=details, console=c))


def print_text(
    shown: Iterable[JudgedClaim], judged: Iterable[JudgedClaim], *, details: bool, console: Console
) -> None:
    """Print a table, with the numbers of each claim if asked, and the two lines."""
    listed = tuple(shown)
    table = bare_table()
    table.add_column("claim", no_wrap=True)
    table.add_column("section")
    table.add_column("verdict", no_wrap=True)
    table.add_column("what it says")
    for one in listed:
        table.add_row(one.claim.id, one.claim.section, _verdict(one), one.claim.title)
    if table.row_count:
        console.print(table)
        console.print()
    for one in listed if details else ():
        _details(one, console)
    say(console, in_words(page.ABOUT), "dim")
    console.print()
    for line in page.summary(judged):
        say(console, line, "bold", whole=True)


def _verdict(one: JudgedClaim) -> Text:
    mark = "" if one.as_expected else "!"
    return Text(one.finding.verdict + mark, style=STYLES[one.finding.verdict])


def _details(one: JudgedClaim, console: Console) -> None:
    console.print(Text(one.claim.id, style="bold"), _verdict(one))
    console.print(Padding(Text(one.claim.claim, style="italic"), (0, 2)))
    console.print(Padding(Text(one.finding.because), (0, 2)))
    console.print(Padding(Text(f"Rule: {one.claim.rule}", style="dim"), (0, 2)))
    table = bare_table()
    table.add_column("number")
    for route in ("Hill", "Floquet"):
        table.add_column(route, justify="right", no_wrap=True)
    for number in one.finding.numbers:
        table.add_row(number.label, *number.texts)
    console.print(Padding(table, (0, 2)))
    console.print()
