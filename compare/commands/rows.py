"""``verify``: every printed row of the report's tables, by both routes."""

import argparse
from pathlib import Path

from compare import publications
from compare.commands.terminal import WIDE, deliver, progress, terminal
from compare.console import as_file
from compare.output import check_writable
from compare.verification import METHODS, Report, check_more_terms, verify
from compare.verification_text import FORMATS, SHOWN, WRITERS, text

SUMMARY = "check every printed row of a paper's tables by two independent routes"
EPILOG = """\
examples:
  verify                              every printed row of Tables 1, 2 and 3
  verify --show differs               only the rows that differ from print
  verify --row T1-07 --row T3-02      single rows; T3-02 is both of its columns
  verify --format md --output t1.md --table 1
  verify --method cvodes --workers 2  SUNDIALS as the witness, two processes
  verify --table 3 --more-terms       beside the five terms that are printed,
                                      eight and the limit
  verify --publication mathieu        another paper: Mathieu's characteristic
                                      values

columns of the report:
  T printed  the report's characteristic argument, twice the growth exponent;
             0 is stable
  as run     the report's program, truncation and slips included, at the Omega
             it was run at
  Hill       the determinant with its tail summed
  Floquet    the monodromy matrix
  T +-       the larger of the two routes' bounds on the error of their T
  |dP|       largest difference between the coefficients of the two
             characteristic polynomials
  bound      the sum of the two error bounds of P, which |dP| must not exceed
  cause      why print differs: agrees, truncation, listing-slip, misprint (and
             what its corrected cell is), unexplained
A narrow terminal leaves out |dP|, bound and the Omega that was run at. JSON and
CSV have every digit, and of each route T_error, which bounds T's error, and
error, which bounds P's.

columns of mathieu: P(1) or P(-1) at the printed value by both routes, the
bound on it, and which routes show it to change its sign within half a unit of
the last digit.

exit status: 0 the routes agree on every row and every difference from print
has its known cause; 1 they do not; 2 wrong usage or input."""


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument(
        "--publication",
        default=publications.FIRST,
        metavar="NAME",
        help=f"whose tables: {', '.join(publications.names())} (default {publications.FIRST})",
    )
    p.add_argument(
        "--table",
        type=int,
        action="append",
        metavar="N",
        help="a table; may be repeated",
    )
    p.add_argument("--row", action="append", metavar="ID", help="a row such as T1-07; repeatable")
    p.add_argument(
        "--show",
        choices=SHOWN,
        default="all",
        help="which rows to list: that differ from print, whose printed verdict is wrong, or that "
        "fail (default all)",
    )
    p.add_argument(
        "--format",
        choices=FORMATS,
        help="text, or what the output's suffix says (.json, .md, .csv)",
    )
    p.add_argument(
        "--output", type=Path, metavar="FILE", help="write there instead of the terminal"
    )
    p.add_argument(
        "--method",
        choices=METHODS,
        default="taylor",
        help="how the time domain integrates (default taylor)",
    )
    p.add_argument(
        "--modes",
        type=int,
        metavar="N",
        help="bending modes of both routes (default: the publication's, 2 for the report)",
    )
    p.add_argument(
        "--more-terms",
        action="store_true",
        help="where a printed value sums a series (Table 3, with initial conditions), sum more of "
        "it and estimate the limit too",
    )
    p.add_argument(
        "--workers",
        type=int,
        default=1,
        metavar="N",
        help="processes, -1 for one a core, if worth starting",
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    report = _compute(options)
    _write(report, options)
    return 0 if report.ok else 1


def _compute(options: argparse.Namespace) -> Report:
    paper = publications.find(options.publication)
    tables = tuple(sorted(set(options.table or paper.tables)))
    rows = paper.select(tables, options.row)
    if options.more_terms:
        check_more_terms(paper, rows)
    if options.output is not None:
        check_writable(options.output)
    with progress("rows", len(rows)) as advance:
        return verify(
            tables,
            publication=paper,
            rows=options.row,
            method=options.method,
            modes=options.modes,
            more_terms=options.more_terms,
            workers=options.workers,
            progress=advance,
        )


def _write(report: Report, options: argparse.Namespace) -> None:
    kind = options.format
    if kind is None:
        suffix = options.output.suffix.lstrip(".") if options.output else "text"
        kind = suffix if suffix in FORMATS else "text"
    if kind in WRITERS:
        content = WRITERS[kind](report, options.show)
    elif options.output is None:
        text(report, options.show, console=terminal())
        return
    else:
        content = as_file(lambda console: text(report, options.show, console=console), WIDE)
    deliver(content, options.output)
