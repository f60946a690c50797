"""``verify report``: what was found as a set of HTML pages."""

import argparse
import math
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from compare import system_file
from compare.both_routes import crosscheck
from compare.commands.asked import settings
from compare.commands.figures import FORMATS, drawn
from compare.commands.system import subject_of
from compare.commands.terminal import stages
from compare.jobs.workers import mapper
from compare.output_folder import check_folder, write_folder
from compare.pages import own, printed
from compare.pages.motion import Motion, let_go
from compare.pages.own_chart import charted, vehicle_charted
from compare.pages.printed_row import COORDINATES
from compare.pages.render import rendered
from compare.pages.render import require as require_templates
from compare.pages.site import Site
from compare.proofs import prove
from compare.publications.kincaid import PUBLICATION
from compare.report.claims.both_routes import RoutesDisagree
from compare.report.claims.run import JudgedClaim, claims, judge
from compare.report.figures.catalogue import FIGURES
from compare.report.figures.compute import tasks
from compare.report.figures.draw import require as require_pictures
from compare.report.proofs import proof_record, prove_row
from compare.report.row import equation
from compare.system_file import Described
from compare.vehicle.study import NO_PULSATION, study
from compare.verification import verify
from hill import Vehicle, checks

SUMMARY = "write what was found as a set of HTML pages"
EPILOG = """\
examples:
  verify report --output pages        index, tables, a page a row, conclusions,
                                      errata: open pages/index.html
  verify report --output pages --figures figures
                                      with the figures that `verify figures`
                                      wrote into ./figures
  verify report --output pages --draw --prove --workers 2
                                      compute and draw the figures too, and
                                      prove every row (extra `proof`)
  verify report mine.toml --set gamma=0.2 --output pages
                                      the same of a system of one's own: both
                                      routes, its chart, its resonances

The pages need no network and no server, and link to each other relatively: the
directory can be copied, packed and handed on. It is replaced as a whole, and
only if every file in it is this command's. It needs the extra `pages`.

exit status: 0 the routes agree, and every printed value has its known cause;
1 they do not; 2 wrong usage or input."""

DRAWN = ("svg", "csv")
Stage = Callable[[str, int, int], None]


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("file", nargs="?", type=Path, metavar="FILE.toml", help="a system of one's own")
    p.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a number of it; repeatable",
    )
    p.add_argument("--output", type=Path, metavar="DIR", required=True, help="where to write")
    p.add_argument(
        "--figures", type=Path, metavar="DIR", help="take the figures that are there, svg or png"
    )
    p.add_argument("--draw", action="store_true", help="compute and draw them (extra plot)")
    p.add_argument("--prove", action="store_true", help="prove every verdict (extra proof)")
    p.add_argument(
        "--no-claims", action="store_true", help="leave out the conclusions, which take longest"
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
    require_templates()
    check_folder(options.output)
    described = _described(options)
    figures = _found(options.figures) if options.figures else {}
    with stages() as stage:
        try:
            if described is None:
                site, ok = _of_the_report(options, figures, stage)
            else:
                site, ok = _of_ones_own(described, options.prove, stage)
        except RoutesDisagree as error:
            print(f"verify report: {error}", file=sys.stderr)
            return 1
        files = rendered(site, lambda done, of: stage("pages", done, of))
        stage("writing", 0, 0)
        write_folder(options.output, files, site.about)
    print(f"written: {options.output / 'index.html'}, {len(site.pages)} pages")
    return 0 if ok else 1


def _described(options: argparse.Namespace) -> Described | None:
    """The file's system; None of the report. Refuses what is of the other."""
    if options.draw and options.figures:
        raise ValueError(f"--figures {options.figures}: leave it out, --draw draws them")
    if options.draw:
        require_pictures()
    if options.file is None:
        if options.set:
            raise ValueError(f"--set {options.set[0]}: is for a file's system; rows have their own")
        return None
    of_the_report = {
        "--figures": options.figures,
        "--draw": options.draw,
        "--no-claims": options.no_claims,
    }
    for name, given in of_the_report.items():
        if given:
            raise ValueError(f"{name}: is of the report; leave it out, or {options.file}")
    found = system_file.with_settings(system_file.read(options.file), settings(options.set))
    vehicle = isinstance(found.system, Vehicle)
    for name in ("gamma",) if vehicle else ("Omega", "gamma"):
        if name not in found.forcing:
            raise ValueError(f"{name}: has no value; give it in [forcing] or as --set {name}=")
    if "Omega" in found.forcing:
        checks.positive("Omega", found.forcing["Omega"])
    if vehicle and found.forcing["gamma"] == 0.0:
        raise ValueError(NO_PULSATION)
    return found


def _of_ones_own(found: Described, prove_it: bool, stage: Stage) -> tuple[Site, bool]:
    forcing: dict[str, Any] = dict(found.forcing)
    studied, x, proof, edge = None, None, None, None
    moving: Motion | str = ""
    if isinstance(found.system, Vehicle):
        studied = study(found.system, stage=stage, **forcing)
        x = studied.operating
    else:
        stage("both routes", 0, 0)
        x = crosscheck(found.system, **forcing)
    if x is not None:
        own_equation = found.system.equation(**forcing)
        if len(x.hill.z):
            edge = math.cosh(math.pi * own_equation.damping / own_equation.Omega)
        stage("motion", 0, 0)
        moving = let_go(own_equation, x.T)
        if prove_it:
            stage("proof", 0, 0)
            proof = proof_record(prove(found.system, forcing))
    if studied is not None:
        drawn_chart = vehicle_charted(found.title, studied, stage)
    else:
        drawn_chart = charted(found, stage)
    site = own.site(
        found.title,
        subject_of(found, "taylor"),
        x,
        study=studied,
        charted=drawn_chart,
        motion=moving,
        edge=edge,
        proof=proof,
    )
    agree = studied.routes_agree if studied is not None else x is None or x.routes_agree
    return site, agree


def _of_the_report(
    options: argparse.Namespace, figures: dict[str, bytes], stage: Stage
) -> tuple[Site, bool]:
    rows = PUBLICATION.all_rows()
    counted = _counter(stage, "rows", len(rows))
    report = verify(publication=PUBLICATION, workers=options.workers, progress=counted)
    motions = {}
    for done, outcome in enumerate(report.outcomes):
        stage("motions", done, len(rows))
        own_equation = equation(outcome.row, outcome.modes)
        motions[outcome.row.id] = let_go(own_equation, outcome.floquet.T, COORDINATES)
    proofs = []
    with mapper(options.workers) as each:
        if options.prove:
            counted = _counter(stage, "proofs", len(rows))
            for proof in each(prove_row, rows):
                proofs.append(proof)
                counted(proof)
        if options.draw:
            counted = _counter(stage, "figures", len(FIGURES))
            for group in each(partial(drawn, formats=DRAWN), tasks(tuple(FIGURES))):
                for number, files, _ in group:
                    figures |= {f"figure{number:02d}.{kind}": data for kind, data in files.items()}
                    counted(number)
    judged: tuple[JudgedClaim, ...] = ()
    if not options.no_claims:
        judged = judge(progress=_counter(stage, "claims", len(claims())))
    site = printed.site(report, motions=motions, claims=judged, proofs=proofs, figures=figures)
    return site, report.ok and all(one.as_expected for one in judged)


def _counter(stage: Stage, what: str, total: int) -> Callable[[object], None]:
    """What moves the bar of a stage on by one."""
    done = 0

    def advance(_: object) -> None:
        nonlocal done
        done += 1
        stage(what, done, total)

    stage(what, 0, total)
    return advance


def _found(folder: Path) -> dict[str, bytes]:
    """The pictures and numbers of figures that a folder has."""
    try:
        found = {
            name: (folder / name).read_bytes()
            for number in FIGURES
            for name in (f"figure{number:02d}.{kind}" for kind in FORMATS)
            if (folder / name).is_file()
        }
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ValueError(f"--figures {folder}: cannot be read ({reason})") from None
    if not any(name.endswith((".png", ".svg")) for name in found):
        raise ValueError(f"--figures {folder}: has no figure03.svg or .png, or any other")
    # one picture a figure is enough
    return {
        name: data
        for name, data in found.items()
        if not (name.endswith(".png") and name.replace(".png", ".svg") in found)
    }
