"""``verify chart``: stability over any two parameters."""

import argparse
import csv
import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from compare.charts import specification
from compare.charts.compute import Chart, chart
from compare.charts.draw import picture
from compare.charts.nodes import ROUTES
from compare.charts.tongues import tongues
from compare.output import check_writable, write_whole

SUMMARY = "chart the characteristic argument T over two parameters or more"
EPILOG = """\
examples:
  verify chart --x Omega 0.35 6 1000 --y gamma 0 0.5 1000 --output chart.png
  verify chart --x Omega 1.7 1.95 500 --y T0 0 25 500 --set gamma=0.1 --output chart.svg
  verify chart mine.toml --workers 2 --resume nodes.npz --output chart.npz

The beam is the report's (Table 1, or Table 2 with --beam stepped) but for what --set changes.
mine.toml:

  [beam]
  kind = "uniform"
  T0 = 15.0
  [forcing]
  eta = 0.01
  [[axis]]
  name = "Omega"
  low = 0.35
  high = 6.0
  count = 1000
  [[axis]]
  name = "gamma"
  low = 0.0
  high = 0.5
  count = 1000

exit status: 0 done; 1 the routes disagree beyond the chart's error; 2 wrong usage or input."""

SUFFIXES = (".png", ".svg", ".npz", ".csv")


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("file", nargs="?", type=Path, metavar="FILE.toml", help="what to chart")
    p.add_argument("--beam", choices=tuple(specification.BEAMS), default="uniform")
    p.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="a parameter; repeatable"
    )
    for axis in ("x", "y", "also"):
        p.add_argument(
            f"--{axis}",
            nargs=4,
            metavar=("NAME", "LOW", "HIGH", "COUNT"),
            help="an axis" if axis != "also" else "a third axis (for .npz)",
        )
    p.add_argument("--output", type=Path, metavar="FILE", help="chart.png, .svg, .npz or .csv")
    p.add_argument("--route", choices=ROUTES, default="both", help="who evaluates (default both)")
    p.add_argument("--tolerance", type=float, default=1e-11, help="of P (default 1e-11)")
    p.add_argument("--workers", type=int, default=1, metavar="N", help="processes (default 1)")
    p.add_argument("--resume", type=Path, metavar="FILE", help="keep finished nodes there")


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    base = specification.from_file(options.file) if options.file else None
    axes = [axis for axis in (options.x, options.y, options.also) if axis]
    wanted = specification.from_words(options.beam, options.set, axes, base)
    if options.output is not None:
        if options.output.suffix not in SUFFIXES:
            raise ValueError(f"output = {str(options.output)!r}: must end in {', '.join(SUFFIXES)}")
        check_writable(options.output)
    if options.resume is not None:
        check_writable(options.resume)
    console = Console(stderr=True)
    with Progress(
        SpinnerColumn(),
        TextColumn("{task.completed:.0f} nodes"),
        TimeElapsedColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    ) as bar:
        task = bar.add_task("nodes", total=None)
        result = chart(
            wanted.beam,
            wanted.axes,
            forcing=wanted.forcing,
            route=options.route,
            tolerance=options.tolerance,
            workers=options.workers,
            resume=options.resume,
            progress=lambda count: bar.advance(task, count),
        )
    if options.output is not None:
        write_whole(options.output, _content(result, options.output.suffix))
    for line in describe(result):
        print(line)
    # P's error is absolute, the disagreement relative to P's largest coefficient, 1 or more
    return int(options.route == "both" and result.disagreement > max(result.error, 1e-11))


def describe(result: Chart) -> list[str]:
    """What was found, in a few lines."""
    unstable = float(np.mean(result.T > 1e-6))
    size = " x ".join(str(axis.count) for axis in result.axes)
    lines = [
        f"{size} points from {result.nodes} evaluations of P in {result.seconds:.1f} s"
        + (f" ({result.resumed} of them were on disk)" if result.resumed else "")
        + f"; {unstable:.1%} unstable, T at most {np.nanmax(result.T):.5f}.",
        f"P is known to {result.error:.0e}; at random points it is off by {result.checked:.0e} "
        "at most.",
    ]
    if result.direct:
        lines.append(f"{result.direct} points, near a longitudinal resonance, one by one.")
    if result.route == "both":
        lines.append(f"The two routes differ by {result.disagreement:.0e} of P at the nodes.")
    return lines


def _content(result: Chart, suffix: str) -> bytes:
    writers: dict[str, Callable[[Chart], bytes]] = {".npz": _npz, ".csv": _csv}
    if suffix in writers:
        return writers[suffix](result)
    two = len(result.axes) == 2 and result.axes[0].name == "Omega"
    return picture(result, tongues(result) if two else (), suffix[1:])


def _npz(result: Chart) -> bytes:
    buffer = io.BytesIO()
    named = {axis.name: axis.points for axis in result.axes}
    extra = {"error": result.error, "disagreement": result.disagreement}
    np.savez_compressed(buffer, T=result.T, **named, **extra)  # type: ignore[arg-type]
    return buffer.getvalue()


def _csv(result: Chart) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = [axis.name for axis in result.axes]
    writer.writerow([*names, "T"])
    mesh = np.meshgrid(*(axis.points for axis in result.axes), indexing="ij")
    columns = [m.ravel() for m in mesh] + [np.transpose(result.T).ravel()]
    np.savetxt(text, np.column_stack(columns), fmt="%.12g", delimiter=",")
    return text.getvalue().encode()
