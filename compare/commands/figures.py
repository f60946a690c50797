"""``verify figures``: the report's Figures 3 to 29, drawn from both routes."""

import argparse
from functools import partial
from pathlib import Path

from compare.commands.terminal import progress
from compare.jobs.workers import ALL_CORES, mapper
from compare.output import check_writable, write_whole
from compare.report.figures.catalogue import FIGURES
from compare.report.figures.compute import compute, named, tasks
from compare.report.figures.data import as_csv
from compare.report.figures.draw import draw, require

FORMATS = ("png", "svg", "csv")
SUMMARY = "draw the report's figures, 3 to 29, from both routes"
EPILOG = """\
examples:
  verify figures                      every figure, into ./figures
  verify figures 8 17 --output plots  two of them
  verify figures 27 --format csv      the data behind one

figures:
  3-7             natural frequencies under thrust
  8, 17, 28       T against Omega, with damping dashed
  9, 10, 18, 19   boundaries in Omega and T0, or gamma
  11-14, 20-23    T_x against gamma; critical T0 and gamma
  15, 16, 24, 25  regions with damping
  26, 27, 29      longitudinal compliance

Curves are one route's, circles the other's, diamonds printed; the caption has
the largest disagreement of the routes and what was assumed. PNG and SVG need
the extra: plot.

exit status: 0 done; 2 wrong usage or input."""


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    p.add_argument("number", type=int, nargs="*", metavar="NUMBER", help="3 to 29 (default all)")
    p.add_argument(
        "--output", type=Path, default=Path("figures"), metavar="DIR", help="(default ./figures)"
    )
    p.add_argument(
        "--format", choices=FORMATS, action="append", help="repeatable (default all three)"
    )
    p.add_argument(
        "--no-captions", action="store_true", help="pictures without the captions below them"
    )
    p.add_argument(
        "--workers",
        type=int,
        default=ALL_CORES,
        metavar="N",
        help="processes, -1 for one a core (default)",
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    numbers = tuple(sorted(set(options.number or FIGURES)))
    for number in numbers:
        named(number)
    formats = tuple(options.format or FORMATS)
    if set(formats) - {"csv"}:
        require()
    _prepare(options.output)
    job = partial(drawn, formats=formats, captioned=not options.no_captions)
    lines: list[tuple[int, str]] = []
    with (
        progress("figures", len(numbers)) as advance,
        mapper(options.workers, long_jobs=True) as each,
    ):
        for group in each(job, tasks(numbers)):
            for number, files, line in group:
                # here and not there: who computes may be ended at any time
                for kind, content in files.items():
                    write_whole(options.output / f"figure{number:02d}.{kind}", content)
                lines.append((number, line))
                advance(line)
    for _, text in sorted(lines):
        print(text)
    return 0


def _prepare(folder: Path) -> None:
    """The folder, made where its parent is there."""
    if not folder.is_dir():
        check_writable(folder)
        try:
            folder.mkdir()
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise ValueError(f"output = {str(folder)!r}: cannot be made ({reason})") from None
    check_writable(folder / "figure")


def drawn(
    group: tuple[int, ...], formats: tuple[str, ...], captioned: bool = True
) -> list[tuple[int, dict[str, bytes], str]]:
    """Figures of one group, computed and drawn: files by format, and a line about each."""
    found = []
    for number in group:
        data = compute(number)
        content: dict[str, bytes] = {}
        pictures = tuple(kind for kind in formats if kind != "csv")
        if pictures:
            content |= draw(data, pictures, captioned=captioned)
        if "csv" in formats:
            content["csv"] = as_csv(data).encode()
        kinds = ", ".join(sorted(content))
        found.append(
            (
                number,
                content,
                f"Figure {number:2d}  {kinds}  the routes differ by {data.disagreement:.0e} "
                f"in {data.quantity} at most",
            )
        )
    return found
