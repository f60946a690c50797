"""``verify vehicle``: what the thrust's pulsation does to one's own vehicle."""

import argparse
import math
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from compare import system_file
from compare.chart_picture import NO_PICTURES
from compare.commands.asked import settings
from compare.commands.terminal import deliver, stages, terminal
from compare.console import as_file
from compare.output import check_apart, check_writable, write_whole
from compare.vehicle.charted import check_charted, drawn
from compare.vehicle.convergence import FEWEST
from compare.vehicle.study import (
    CLOSELY,
    FEW_MODES,
    MORE,
    MORE_MANY,
    NO_PULSATION,
    WITNESSED,
    study,
)
from compare.vehicle.write import as_json, markdown, text
from hill import Vehicle, checks

SUMMARY = "what pulsating thrust does to a vehicle of one's own"
EPILOG = """\
examples:
  verify vehicle mine.toml
  verify vehicle mine.toml --range 2 40 --set gamma=0.2
  verify vehicle mine.toml --format json
  verify vehicle mine.toml --chart mine.png

The first line says whether the vehicle is safe at the file's operating
pulsation (forcing.Omega, in radians per unit of time), the second what the
nearest danger is. Bands, growth and critical pulsation ratios come from Hill's
matrix on the vehicle's exact modes; the column "both" has the verdict of the
time domain on finite elements of the vehicle, where it agrees with them.

exit status: 0 the routes agree; 1 they do not; 2 wrong usage or input."""

FORMATS = ("text", "json", "md")


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("file", type=Path, metavar="FILE.toml", help='a file of kind = "vehicle"')
    p.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="a number; repeatable"
    )
    p.add_argument(
        "--range",
        nargs=2,
        type=float,
        metavar=("LOW", "HIGH"),
        help="cycles per unit of time (Hz) between which resonances are looked for",
    )
    p.add_argument(
        "--order", type=int, default=2, metavar="K", help="of resonances, up to K (default 2)"
    )
    p.add_argument(
        "--closely",
        type=int,
        default=CLOSELY,
        metavar="N",
        help=f"resonances that are solved for, the most dangerous (default {CLOSELY})",
    )
    p.add_argument(
        "--both",
        type=int,
        default=WITNESSED,
        metavar="N",
        help=f"and those of them that the time domain is asked about (default {WITNESSED})",
    )
    p.add_argument(
        "--chart",
        type=Path,
        metavar="FILE",
        help="draw T over the frequency and the ratio of the pulsation there, as .png or .svg",
    )
    p.add_argument(
        "--more-modes",
        type=int,
        metavar="K",
        help=f"add two modes K times and see what changes (default {MORE}, or {MORE_MANY} with "
        f"more than {FEW_MODES} modes)",
    )
    p.add_argument(
        "--format", choices=FORMATS, help="text, or what the output's suffix says (.json, .md)"
    )
    p.add_argument(
        "--output", type=Path, metavar="FILE", help="write there instead of the terminal"
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    given = settings(options.set)
    found = system_file.with_settings(system_file.read(options.file), given)
    vehicle = found.system
    if not isinstance(vehicle, Vehicle):
        raise ValueError(f"{options.file}: kind = {found.kind!r}: must be 'vehicle'")
    if "gamma" not in found.forcing:
        raise ValueError("gamma: has no value; give it in [forcing] or as --set gamma=")
    if "Omega" in found.forcing:
        where = "--set Omega" if "Omega" in given else f"{options.file}: forcing.Omega"
        checks.positive(where, found.forcing["Omega"])
    span = None
    if options.range:
        low, high = (checks.number("--range", x) for x in options.range)
        if not 0.0 <= low < high:
            raise ValueError(f"--range {low:g} {high:g}: must ascend, from 0 on")
        span = (2.0 * math.pi * low, 2.0 * math.pi * high)
    _check_files(options, vehicle, found.forcing)
    with stages() as stage:
        result = study(
            vehicle,
            gamma=found.forcing["gamma"],
            eta=found.forcing.get("eta", 0.0),
            Omega=found.forcing.get("Omega"),
            span=span,
            orders=checks.count("--order", options.order, least=1, most=10),
            closely=checks.count("--closely", options.closely, least=1),
            witness=checks.count("--both", options.both, least=0),
            more=None
            if options.more_modes is None
            else checks.count("--more-modes", options.more_modes, least=FEWEST, most=20),
            stage=stage,
        )
        if options.chart is not None:
            picture = drawn(found.title, result, options.chart.suffix[1:], stage)
            write_whole(options.chart, picture)
    kind = options.format or (options.output.suffix[1:] if options.output else "text")
    if kind in ("json", "md"):
        content = (as_json if kind == "json" else markdown)(found.title, result)
    elif options.output is None:
        text(found.title, result, terminal())
        return int(not result.routes_agree)
    else:
        content = as_file(lambda console: text(found.title, result, console), 120)
    deliver(content, options.output)
    return int(not result.routes_agree)


def _check_files(
    options: argparse.Namespace, vehicle: Vehicle, forcing: Mapping[str, float]
) -> None:
    """Refuse what could not be written or drawn, before anything is computed."""
    for name, path in (("output", options.output), ("chart", options.chart)):
        if path is not None:
            check_writable(path, name)
    check_apart(output=options.output, chart=options.chart)
    if options.chart is not None:
        if options.chart.suffix != ".html" and find_spec("matplotlib") is None:
            raise ValueError(NO_PICTURES)
        if forcing["gamma"] == 0.0:
            raise ValueError(NO_PULSATION)
        check_charted(vehicle, forcing["gamma"], forcing.get("eta", 0.0), options.chart)
