"""``verify simulate``: the motion itself, over many periods, beside T."""

import argparse
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from compare import publications
from compare.chart_picture import NO_PICTURES
from compare.charts.identity import known_values, type_name
from compare.charts.limits import own_equation
from compare.commands import asked
from compare.commands.terminal import deliver, terminal, working
from compare.console import as_file
from compare.output import check_writable, write_whole
from compare.report import row as of_report
from compare.simulation.files import as_csv, as_json
from compare.simulation.followed import Followed, Subject, follow
from compare.simulation.picture import picture
from compare.simulation.text import show
from compare.system_file import Described
from hill import SteppedBeam, UniformBeam, Vehicle, checks
from hill.system import parameter_values

SUMMARY = "the motion itself over many periods, beside T"
EPILOG = """\
examples:
  verify simulate --row T1-12
  verify simulate --row T1-07 --output bounded.png
  verify simulate mine.toml --set gamma=0.2 --periods 500 --output growth.csv
  verify simulate mine.toml --q0 0.01 0 --v0 0 0

One period is integrated, all others are powers of its matrix; each value has an
error bound. The motion begins in the fastest growing mode, or where none grows
in all modes alike, unless --q0 or --v0 say otherwise. It is followed over
2,000 periods, or until it has grown or decayed 50 times unless print has a
row's stability wrong. A picture has each coordinate under the envelope
exp(T tau/2); measured growth is the history's own.

A file is the one that `verify system` takes; kind = "vehicle" is told in its
own unit of time and in cycles.

exit status: 0 done; 2 wrong usage or input."""

PICTURES = ("png", "svg", "pdf")
FORMATS = ("text", "json", "csv")
COORDINATES = ("bending 1", "bending 2", "rotation")
"""Of the report's beams with two modes, in the order of their equation."""


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    asked.configure(p)
    p.add_argument("--row", metavar="ID", help="a row of the report's tables, T1-12 or T3-02b")
    p.add_argument("--periods", type=int, metavar="N", help="how many are followed")
    p.add_argument("--samples", type=int, metavar="M", help="in each period")
    for name, what in (("--q0", "coordinates"), ("--v0", "velocities")):
        p.add_argument(name, nargs="+", type=float, metavar="X", help=f"{what} to begin with")
    p.add_argument("--format", choices=FORMATS, help="text, or what --output's suffix says")
    p.add_argument(
        "--output",
        type=Path,
        metavar="FILE",
        help="write there: .png, .svg, .pdf a picture, .csv, .json; any other suffix text",
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    kind = _kind(options)
    if kind in PICTURES and find_spec("matplotlib") is None:
        raise ValueError(NO_PICTURES)
    if options.output is not None:
        check_writable(options.output)
    for name in ("periods", "samples"):
        if getattr(options, name) is not None:
            checks.count(f"--{name}", getattr(options, name), least=1)
    equation, subject, long = _of_row(options) if options.row is not None else _of_file(options)
    with working("following the motion"):
        found = follow(
            equation,
            subject,
            q0=options.q0,
            v0=options.v0,
            periods=options.periods,
            samples=options.samples,
            long=long,
        )
        content = _content(found, kind)
    if isinstance(content, bytes):
        write_whole(options.output, content)
    elif content or options.output is not None:
        deliver(content or as_file(lambda console: show(found, console)), options.output)
    # beside what goes into a file too, but for itself
    if bool(content) == (options.output is not None):
        show(found, terminal())
    return 0


def _kind(options: argparse.Namespace) -> str:
    suffix = options.output.suffix[1:].lower() if options.output is not None else ""
    if suffix in PICTURES and options.format is not None:
        raise ValueError(f"--format {options.format}: {options.output.name} is a picture")
    if suffix in PICTURES:
        return str(suffix)
    return str(options.format or (suffix if suffix in FORMATS else "text"))


def _content(found: Followed, kind: str) -> str | bytes:
    """Of a file but for text."""
    if kind in PICTURES:
        return picture(found, kind)
    if kind == "csv":
        return as_csv(found)
    return as_json(found) if kind == "json" else ""


def _of_row(options: argparse.Namespace) -> tuple[Any, Subject, bool]:
    """A row's equation as it was run, by the witness's matrices."""
    for name, given in (("FILE", options.file), ("--beam", options.beam), ("--set", options.set)):
        if given:
            raise ValueError(f"--row {options.row}: is a system of its own; leave out {name}")
    rows = publications.find(publications.FIRST).select(names=[options.row])
    if len(rows) > 1:
        raise ValueError(
            f"row = {options.row!r}: has two columns, say {' or '.join(r.id for r in rows)}"
        )
    (row,) = rows
    outcome = publications.find(publications.FIRST).check(row)
    run = row.run
    about = {
        "row": row.id,
        "beam": run["beam"],
        "parameters": {k: v for k, v in run.items() if isinstance(v, float)},
        "forcing": {"Omega": row.Omega, "gamma": row.gamma, "eta": run["eta"]},
    }
    title = (
        f"Row {row.id}: the {run['beam']} beam at Omega = {row.Omega:.7g}, gamma = {row.gamma:g}"
    )
    subject = Subject(title, COORDINATES, about, printed=row.T_printed or "0")
    return of_report.witness(row, 2), subject, outcome.flips


def _of_file(options: argparse.Namespace) -> tuple[Any, Subject, bool]:
    wanted = asked.asked(options)
    forcing: dict[str, Any] = {"eta": 0.0} | wanted.forcing
    for name in ("Omega", "gamma"):
        if name not in forcing:
            raise ValueError(f"{name}: has no value; give it in [forcing] or as --set {name}=")
    return own_equation(wanted.system, **forcing), _subject(wanted, forcing), False


def _subject(wanted: Described, forcing: Mapping[str, float]) -> Subject:
    system = wanted.system
    about: dict[str, Any] = {
        "title": wanted.title,
        "kind": wanted.kind,
        "system": type_name(system),
        "parameters": parameter_values(system),
        "values": known_values(system),
        "forcing": dict(forcing),
    }
    at = ", ".join(f"{name} = {forcing[name]:.7g}" for name in ("Omega", "gamma", "eta"))
    title = f"{wanted.title} at {at}"
    if isinstance(system, UniformBeam | SteppedBeam):
        names = (*(f"bending {k + 1}" for k in range(system.modes)), "rotation")
        return Subject(title, names, about)
    if isinstance(system, Vehicle):
        bending = tuple(f"bending {k + 1}" for k in range(system.modes))
        names = (*bending, *(("rotation",) if system.rotates else ()))
        units = system.units
        about |= {"units": f"time in {units.time or 'its unit'}, Omega in radians per unit of time"}
        return Subject(
            title, names, about, time=units.time, frequency=units.frequency, in_time=True
        )
    return Subject(title, (), about)
