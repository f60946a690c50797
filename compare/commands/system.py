"""``verify system``: any system from a file, by both routes."""

import argparse
from pathlib import Path
from typing import Any

from compare import system_file
from compare.both_routes import Method, crosscheck
from compare.charts.identity import known_values, type_name
from compare.commands.asked import settings
from compare.commands.terminal import deliver, terminal, working
from compare.console import as_file
from compare.crosscheck_text import FORMATS, WRITERS, Subject, text
from compare.output import check_writable
from compare.system_file import Described
from hill.system import frequency_names, natural_frequencies, parameter_values

SUMMARY = "cross-check a system of one's own, given in a file"
EPILOG = """\
examples:
  verify system mine.toml
  verify system mine.toml --set Omega=2.1 --set gamma=0.3 --format json
  verify system mine.toml --output mine.md

mine.toml, in its simplest form:

  kind = "matrices"
  [system]
  F = [[2.0, -1.0], [-1.0, 2.0]]
  G = [[1.0, 0.0], [0.0, 1.0]]
  [forcing]
  gamma = 0.15
  Omega = 2.0

F, G and a mass matrix M may be files: "mine.npz:F", "mine.mat:F", "mine.mtx".
A term F_terms.name = [[...]] (or G_terms.name) makes a parameter `name` of
which F gains so much; its value is values.name.

In general form, M q'' + C q' + K q = 0 with harmonics (or A of x' = A x
alone); gamma scales them all, and is 1 where it is not given:

  kind = "matrices"
  [system]
  M = [[1.0, 0.0], [0.0, 2.0]]
  C = "mine.npz:C"
  K.mean = [[2.0, -1.0], [-1.0, 2.0]]
  K.cos.1 = "mine.npz:K1"
  K.sin.2 = [[0.1, 0.0], [0.0, 0.0]]
  [forcing]
  Omega = 2.0

kind = "uniform" and "stepped" are the report's beams, with T0, K_theta, ...

exit status: 0 the routes agree; 1 they do not; 2 wrong usage or input."""


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("file", type=Path, metavar="FILE.toml", help="the system and its forcing")
    p.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="a number; repeatable"
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
        choices=("taylor", "cvodes"),
        default="taylor",
        help="how the time domain integrates (default taylor)",
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    found = system_file.with_settings(system_file.read(options.file), settings(options.set))
    for name in ("Omega", "gamma"):
        if name not in found.forcing:
            raise ValueError(f"{name}: has no value; give it in [forcing] or as --set {name}=")
    if options.output is not None:
        check_writable(options.output)
    with working("both routes"):
        forcing: dict[str, Any] = dict(found.forcing)
        result = crosscheck(found.system, **forcing, method=options.method)
    subject = subject_of(found, options.method)
    kind = options.format or (options.output.suffix[1:] if options.output else "text")
    if kind in WRITERS:
        content = WRITERS[kind](subject, result)
    elif options.output is None:
        text(subject, result, terminal())
        return int(not result.routes_agree)
    else:
        content = as_file(lambda console: text(subject, result, console))
    deliver(content, options.output)
    return int(not result.routes_agree)


def subject_of(found: Described, method: Method) -> Subject:
    """What a file describes, as a cross-check's text calls it."""
    frequencies = natural_frequencies(found.system)
    return Subject(
        title=found.title,
        kind=found.kind,
        values=parameter_values(found.system),
        forcing={"eta": 0.0} | found.forcing,
        frequencies=tuple(
            zip(
                frequency_names(found.system, len(frequencies)),
                map(complex, frequencies),
                strict=True,
            )
        ),
        system=type_name(found.system),
        fingerprint=known_values(found.system),
        method=method,
    )
