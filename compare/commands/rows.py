"""``verify``: every printed row of the report's tables, by both routes."""

import argparse
import io
import sys
from collections.abc import Callable
from pathlib import Path

from rich.console import Console

from compare.commands.terminal import progress, terminal
from compare.output import check_writable, write_whole
from compare.report import render
from compare.report.run import Report, select, verify
from compare.report.tables import TABLES

SUMMARY = "check every printed row of the report's tables by two independent routes"
EPILOG = """\
examples:
  verify                              every printed row of Tables 1, 2 and 3
  verify --show differs               only the rows that differ from print
  verify --row T1-07 --row T3-02      single rows; T3-02 is both of its columns
  verify --format md --output t1.md --table 1
  verify --method cvodes --workers 2  SUNDIALS as the witness, on two processes

columns:
  T printed   the report's characteristic argument, twice the growth exponent; 0 is stable
  T as run    the report's program, truncation and slips included, at the Omega it was run at
  T Hill      the determinant with its tail summed;  T Floquet  the monodromy matrix
  |dP|        largest difference between the coefficients of the two characteristic polynomials;
  bound       the sum of the two error bounds, which |dP| must not exceed
  cause       why print differs: agrees, truncation, listing-slip, misprint (and what its
              corrected cell is), unexplained

exit status: 0 the routes agree on every row and every difference from print has its known cause;
1 they do not; 2 wrong usage or input."""


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument(
        "--table", type=int, action="append", metavar="N", help="a table, 1 to 3; may be repeated"
    )
    p.add_argument("--row", action="append", metavar="ID", help="a row such as T1-07; repeatable")
    p.add_argument(
        "--show",
        choices=render.SHOWN,
        default="all",
        help="which rows to list: that differ from print, whose printed verdict is wrong, or that "
        "fail (default all)",
    )
    p.add_argument(
        "--format",
        choices=render.FORMATS,
        help="text, or what the output's suffix says (.json, .md, .csv)",
    )
    p.add_argument(
        "--output", type=Path, metavar="FILE", help="write there instead of the terminal"
    )
    p.add_argument(
        "--method",
        choices=("taylor", "cvodes"),
        default="taylor",
        help="how the time domain integrates (default taylor)",
    )
    p.add_argument(
        "--modes",
        type=int,
        default=2,
        metavar="N",
        help="bending modes of both routes (default 2, the report's)",
    )
    p.add_argument(
        "--workers", type=int, default=1, metavar="N", help="processes, -1 for one a core"
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    report = _compute(options)
    _write(report, options)
    return 0 if report.ok else 1


def _compute(options: argparse.Namespace) -> Report:
    tables = tuple(sorted(set(options.table or TABLES)))
    rows = select(tables, options.row)
    if options.output is not None:
        check_writable(options.output)
    with progress("rows", len(rows)) as advance:
        return verify(
            tables,
            rows=options.row,
            method=options.method,
            modes=options.modes,
            workers=options.workers,
            progress=advance,
        )


def _write(report: Report, options: argparse.Namespace) -> None:
    kind = options.format
    if kind is None:
        suffix = options.output.suffix.lstrip(".") if options.output else "text"
        kind = suffix if suffix in render.FORMATS else "text"
    writers: dict[str, Callable[[Report, str], str]] = {
        "json": render.as_json,
        "md": render.markdown,
        "csv": render.as_csv,
    }
    if kind in writers:
        content = writers[kind](report, options.show)
    elif options.output is None:
        render.text(report, options.show, console=terminal())
        return
    else:
        buffer = io.StringIO()
        render.text(report, options.show, console=Console(file=buffer, width=140))
        content = buffer.getvalue()
    if options.output is None:
        sys.stdout.write(content)
        sys.stdout.flush()
    else:
        write_whole(options.output, content)
