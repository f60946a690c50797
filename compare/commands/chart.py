"""``verify chart``: stability over any two parameters."""

import argparse
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from compare import chart_files
from compare.chart_picture import PICTURES, QUANTITIES, SIZE, Mark
from compare.chart_saving import check_saved, content, edges_of, has_tongues
from compare.chart_text import describe, ended, told, tongue_table
from compare.charts.compute import chart
from compare.charts.nodes import ROUTES
from compare.charts.result import Chart
from compare.commands import asked
from compare.commands.terminal import stages, terminal
from compare.console import say, show
from compare.edges.curves import Curve
from compare.edges.instabilities import Instability, instabilities
from compare.edges.interpolated import axes_of
from compare.edges.on_chart import ORDERS
from compare.edges.tongue import Tongue
from compare.edges.unnamed import Region, unnamed
from compare.jobs.cluster import connect
from compare.output import check_apart, check_writable, write_whole
from compare.report.tables import all_rows
from hill import UniformBeam, checks

SUMMARY = "chart the argument T over two parameters or more"
EPILOG = """\
examples:
  verify chart --x Omega 0.35 6 1000 --y gamma 0 0.5 1000 --output chart.png
  verify chart --x Omega 1.7 1.95 500 --y T0 0 25 500 --set gamma=0.1 \\
    --output chart.svg
  verify chart --x Omega 0.35 6 1000 --y gamma 0 0.5 1000 --set eta=0.01 \\
    --tongues tongues.csv
  verify chart --x Omega 0.35 6 200 --y gamma 0 0.5 200 --certify
  verify chart mine.toml --workers 2 --resume nodes.dat --output chart.npz
  verify chart --x Omega 0.9 1.3 200 --y gamma 0 0.3 150 --also T0 5 20 16 \\
    --route floquet --output explore.html

A page (.html) evaluates the chart by itself, without a network: a map, sliders
for the third and fourth axes, T, the verdict and the multipliers of any point.
A chart of Omega and one other parameter has tongues: --tongues lists them, and
a picture draws and lists them. On a picture of two others the boundaries are
drawn.

Without a file the system is the report's beam (Table 1, or Table 2 with --beam
stepped) but for what --set changes. A file is the one that `verify system`
takes, of anybody's system, and may have the axes too:

  kind = "matrices"
  [system]
  F = [[2.0, -1.0], [-1.0, 2.0]]
  G = [[1.0, 0.0], [0.0, 1.0]]
  [forcing]
  eta = 0.01
  [[axis]]
  name = "Omega"
  low = 0.5
  high = 6.0
  count = 1000
  [[axis]]
  name = "gamma"
  low = 0.0
  high = 0.5
  count = 1000

exit status: 0 done; 1 the routes disagree beyond the chart's error, or a
verdict contradicts what is proven of its cell; 2 wrong usage or input."""


BESIDE: dict[str, Any] = {
    "action": "append",
    "default": [],
    "help": "a further axis, repeatable: a slider of a page (.html); or for .npz",
}


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    asked.configure(p)
    for axis in ("x", "y", "also"):
        p.add_argument(
            f"--{axis}",
            nargs=4,
            metavar=("NAME", "LOW", "HIGH", "COUNT"),
            **(BESIDE if axis == "also" else {"help": "an axis"}),
        )
    p.add_argument(
        "--output",
        type=Path,
        metavar="FILE",
        help="chart.png, .svg, .pdf, .html, .npz, .json, .csv",
    )
    p.add_argument(
        "--show",
        choices=QUANTITIES,
        default="T",
        help="what a picture shows: T, or how far the routes differ at the nodes (default T)",
    )
    p.add_argument(
        "--certify",
        action="store_true",
        help="prove the verdict of every cell, of a chart of Omega and gamma (extra proof)",
    )
    p.add_argument(
        "--size",
        nargs=2,
        type=float,
        metavar=("WIDTH", "HEIGHT"),
        help=f"of a picture, in inches (default {SIZE[0]} {SIZE[1]})",
    )
    p.add_argument(
        "--log",
        action="append",
        default=[],
        metavar="NAME",
        help="an axis of a picture that is logarithmic; repeatable",
    )
    p.add_argument("--tongues", type=Path, metavar="FILE", help="edges of the tongues, as .csv")
    p.add_argument(
        "--order",
        type=int,
        default=ORDERS,
        metavar="K",
        help=f"tongues up to this order, 2 omega_i/K, (omega_i +- omega_j)/K (default {ORDERS})",
    )
    p.add_argument("--route", choices=ROUTES, default="both", help="who evaluates (default both)")
    p.add_argument("--tolerance", type=float, default=1e-11, help="of P (default 1e-11)")
    p.add_argument(
        "--workers",
        type=int,
        default=1,
        metavar="N",
        help="processes, -1 for one a core, if worth starting",
    )
    p.add_argument("--cluster", metavar="ADDRESS", help="a Dask scheduler instead (extra cluster)")
    p.add_argument("--resume", type=Path, metavar="FILE", help="keep finished nodes there")


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    typed = [axis for axis in (options.x, options.y, *options.also) if axis]
    wanted = asked.with_axes(asked.asked(options), typed, options.set)
    if not wanted.axes and options.file:
        raise ValueError(f"{options.file}: has no [[axis]]; write axes there, or give --x and --y")
    _check_files(options, wanted.axes)
    _check_wanted(options, [name for name, *_ in wanted.axes])
    suffix = options.output.suffix if options.output else ""
    with stages() as stage, _workers(options) as workers:
        result = chart(
            wanted.system,
            wanted.axes,
            forcing=wanted.forcing,
            route=options.route,
            tolerance=options.tolerance,
            workers=workers,
            resume=options.resume,
            certify=options.certify,
            stage=stage,
        )
        stage("the verdict of every point", 0, 0)
        result.verdict()
        edges, found, nameless = _edges(result, options, suffix, stage)
        if options.output is not None:
            stage("writing", 0, 0)
            words: dict[str, Any] = {"show": options.show, "title": wanted.title}
            words |= {"size": _size(options), "log": options.log}
            made = content(result, suffix, edges, found, marks=_printed(result), **words)
            write_whole(options.output, made)
        if options.tongues is not None:
            other = axes_of(result)[1].name
            write_whole(options.tongues, chart_files.tongues_csv(result, found, other))
    lines, console = [*describe(result), *map(told, nameless)], terminal()
    if found:
        other = axes_of(result)[1].name
        show(console, tongue_table(found, other, console.width))
        console.print()
        lines += ended(found, other)
    for line in lines:
        say(console, line, whole=True)
    return int(not result.routes_agree or result.contradicted > 0)


def _edges(
    result: Chart, options: argparse.Namespace, suffix: str, stage: Callable[[str, int, int], None]
) -> tuple[Sequence[Tongue | Curve], tuple[Instability, ...], tuple[Region, ...]]:
    """Lines to draw, the instabilities that they are of, and what has no name."""
    if options.show != "T" and not options.tongues:
        return (), (), ()
    order = checks.count("order", options.order, least=1)
    # a table of tongues has them, whatever else is written
    kind = ".json" if options.tongues else suffix
    edges = edges_of(result, kind, order, stage)
    if not has_tongues(result, kind):
        return edges, (), ()
    own = tuple(edge for edge in edges if isinstance(edge, Tongue))
    stage("their widths", 0, 0)
    return edges, instabilities(result, own), unnamed(result, own)


def _check_files(
    options: argparse.Namespace, axes: Sequence[tuple[str, float, float, int]]
) -> None:
    """Refuse what could not be written, before anything is computed."""
    if options.output is not None:
        lows = [(name, low) for name, low, *_ in axes]
        check_saved(options.output, lows, _size(options), options.log)
    if options.tongues is not None and options.tongues.suffix != ".csv":
        raise ValueError(f"tongues = {str(options.tongues)!r}: must end in .csv")
    for name, path in (("tongues", options.tongues), ("resume", options.resume)):
        if path is not None:
            check_writable(path, name)
    check_apart(output=options.output, tongues=options.tongues, resume=options.resume)


def _check_wanted(options: argparse.Namespace, axes: list[str]) -> None:
    """Refuse pictures and tongues that there will be none of, before anything is computed."""
    checks.count("order", options.order, least=1)
    drawn = options.output is not None and options.output.suffix in PICTURES
    for name, given in (
        ("show", options.show != "T"),
        ("size", options.size),
        ("log", options.log),
    ):
        if given and not drawn:
            raise ValueError(f"--{name}: needs a picture, --output NAME.png, .svg or .pdf")
    if options.show == "disagreement" and len(axes) != 2:
        raise ValueError("--show disagreement: needs two axes")
    if options.show == "disagreement" and options.route != "both":
        raise ValueError(f"--show disagreement: needs --route both, not {options.route}")
    if options.tongues is not None and (len(axes) != 2 or "Omega" not in axes):
        raise ValueError(f"--tongues {options.tongues}: needs a chart of Omega and one other")


def _size(options: argparse.Namespace) -> tuple[float, float]:
    return tuple(options.size) if options.size else SIZE


@contextmanager
def _workers(options: argparse.Namespace) -> Iterator[Any]:
    if options.cluster is None:
        yield options.workers
    else:
        with connect(options.cluster) as cluster:
            yield cluster


def _printed(result: Chart) -> list[Mark]:
    """The printed rows of Table 1 or 2 that lie on a chart of the report's own beam."""
    if set(result.scenario.names) != {"Omega", "gamma"} or result.scenario.forcing.get("eta"):
        return []
    table = 1 if isinstance(result.system, UniformBeam) else 2
    printed = all_rows((table,))
    modes = getattr(result.system, "modes", 2)
    if any(row.beam(modes) != result.system for row in printed):
        return []
    at = [[float(getattr(row, axis.name)) for axis in result.axes] for row in printed]
    return [Mark(x, y, row.T > 0.0) for (x, y), row in zip(at, printed, strict=True)]
