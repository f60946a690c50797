"""``verify prove``: the rows' verdicts, or a file's system, proven in ball arithmetic."""

import argparse
import json
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.text import Text

from compare import publications, system_file
from compare.commands.asked import settings
from compare.commands.terminal import deliver, progress, terminal, working
from compare.console import as_file, bare_table, say, show
from compare.jobs.workers import mapper
from compare.output import check_writable
from compare.proofs import Proof, prove
from compare.provenance import in_words, provenance
from compare.report.proofs import RowProof, counts, lines, proof_record, prove_row, record

SUMMARY = "prove verdicts, by both routes in ball arithmetic"
EPILOG = """\
examples:
  verify prove                        every row of Tables 1, 2 and 3
  verify prove T1-07 T3-02            single rows; T3-02 is both of its columns
  verify prove --interval --workers 2 and for every Omega that rounds to the
                                      printed one
  verify prove mine.toml              a system of one's own
  verify prove --format json          the balls, as decimal strings

columns:
  Hill +-     largest radius of P's coefficients by the determinant, whose tail
              is bounded
  Floquet +-  the same by the time domain, whose remainders are bounded
  meet        whether the two routes' balls meet
  proven      the verdict; "->" where print has it wrong
  every Omega with --interval: what is proven of every Omega that rounds to the
              printed one; "both": stable at some and unstable at others, with
              the stable share; "->" where print is wrong at all of them

A beam is taken with its parameters as they are written in decimals, anything
else with the floats of its matrices. It needs the extra `proof`.

exit status: 0 every verdict that `verify` shows is proven; 1 one is not; 2
wrong usage or input."""

FORMATS = ("text", "json")
ABOUT = {"of": "rows of Tables 1 to 3, two modes, equations as corrected, decimals as written"}


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("what", nargs="*", metavar="ROW | FILE.toml", help="rows, or one file")
    p.add_argument(
        "--interval",
        action="store_true",
        help="also for every Omega that rounds to the printed one",
    )
    p.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a number of a file's system; repeatable",
    )
    p.add_argument(
        "--format", choices=FORMATS, help="text, or what the output's suffix says (.json)"
    )
    p.add_argument(
        "--output", type=Path, metavar="FILE", help="write there instead of the terminal"
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
    files = [word for word in options.what if word.endswith(".toml")]
    if files:
        return _file(files, options)
    if options.set:
        raise ValueError(f"--set {options.set[0]}: is for a file's system; rows have their own")
    rows = publications.find(publications.FIRST).select(None, options.what or None)
    if options.output is not None:
        check_writable(options.output)
    found = []
    job = partial(prove_row, interval=options.interval)
    with progress("rows", len(rows)) as advance, mapper(options.workers) as over:
        for one in over(job, rows):
            found.append(one)
            advance(one)
    proven = tuple(found)
    content = provenance(ABOUT) | {
        "summary": counts(proven),
        "rows": [record(one) for one in proven],
    }
    _write(content, partial(print_rows, proven), options)
    return 0 if all(one.proven for one in proven) else 1


def _file(files: list[str], options: argparse.Namespace) -> int:
    if len(options.what) > 1:
        raise ValueError(f"{files[0]}: must stand alone, without rows or other files")
    if options.interval:
        raise ValueError("--interval: is for printed rows, a file's Omega is what it says")
    described = system_file.with_settings(system_file.read(Path(files[0])), settings(options.set))
    for name in ("Omega", "gamma"):
        if name not in described.forcing:
            raise ValueError(f"{name}: has no value; give it in [forcing] or as --set {name}=")
    if options.output is not None:
        check_writable(options.output)
    with working("both routes"):
        proof = prove(described.system, {"eta": 0.0} | described.forcing)
    about = {"of": described.title or described.kind, "forcing": described.forcing}
    content = provenance(about) | proof_record(proof)
    _write(content, partial(print_proof, proof, about), options)
    return 0 if proof.verdict != "undecided" else 1


def _write(content: dict[str, Any], text: Any, options: argparse.Namespace) -> None:
    kind = options.format
    if kind is None:
        kind = "json" if options.output and options.output.suffix == ".json" else "text"
    if kind == "json":
        deliver(json.dumps(content, indent=1, allow_nan=False) + "\n", options.output)
    elif options.output is None:
        text(terminal())
    else:
        deliver(as_file(text), options.output)


def print_rows(proven: tuple[RowProof, ...], console: Console) -> None:
    """The table and two lines."""
    asked = any(one.interval is not None for one in proven)
    table = bare_table()
    for name in ("row", "Omega"):
        table.add_column(name, no_wrap=True)
    for name in ("Hill +-", "Floquet +-"):
        table.add_column(name, justify="right", no_wrap=True)
    for name in ("meet", "proven", *(["every Omega"] if asked else [])):
        table.add_column(name, no_wrap=True)
    for one in proven:
        cells: list[Any] = [one.row.id, f"{one.row.Omega:.6f}"]
        cells += [
            "" if route is None else f"{route.radius:.0e}"
            for route in (one.proof.hill, one.proof.floquet)
        ]
        cells += ["yes" if one.proof.meet else Text("no", style="bold red"), _verdict(one)]
        table.add_row(*cells, *([_everywhere(one)] if asked else []))
    show(console, table)
    console.print()
    for one in proven:
        if one.proof.reason:
            say(console, f"{one.row.id}: {one.proof.reason}", whole=True)
    say(console, in_words(ABOUT), "dim")
    console.print()
    good = all(one.proven for one in proven)
    for line in lines(proven):
        say(console, line, "bold" if good else "bold red", whole=True)


def print_proof(proof: Proof, about: dict[str, Any], console: Console) -> None:
    """Of a file's system."""
    of = "decimals as written" if proof.decimals else "its matrices' floats"
    say(console, f"{about['of']}, {of}", "bold")
    console.print()
    for name, route in (("Hill", proof.hill), ("Floquet", proof.floquet)):
        if route is not None:
            say(console, f"{name}: T in {route.T}", whole=True)
            say(console, f"  P known to {route.radius:.0e}, {route.verdict}", whole=True)
    if proof.hill is not None and proof.floquet is not None:
        say(console, f"the routes' balls {'meet' if proof.meet else 'do not meet'}", whole=True)
    if proof.reason:
        say(console, proof.reason)
    console.print()
    say(console, in_words(about), "dim")
    console.print()
    proven = proof.verdict != "undecided"
    say(console, f"{proof.verdict}{', proven' if proven else ''}", "bold" if proven else "bold red")


def _verdict(one: RowProof) -> Text:
    if one.proof.verdict == "undecided":
        return Text("undecided", style="bold red")
    return Text("-> " + one.proof.verdict.upper(), "bold") if one.flips else Text(one.proof.verdict)


def _everywhere(one: RowProof) -> Text:
    found = one.interval
    if found is None:
        return Text("")
    if one.flips_everywhere:
        return Text("-> " + found.verdict.upper(), "bold")
    if found.verdict == "both":
        return Text(f"both, {100 * found.share('stable'):.0f}% stable")
    return Text(found.verdict)
