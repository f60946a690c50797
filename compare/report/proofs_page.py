"""Writes ``docs/proofs.md``: what is proven of the report's rows and chart, and how to check it.

``python -m compare.report.proofs_page``
"""

from collections.abc import Iterable
from functools import partial
from math import ceil, log10
from pathlib import Path
from typing import Any

import numpy as np

from compare.charts.compute import chart
from compare.charts.result import Chart
from compare.jobs.workers import ALL_CORES, mapper
from compare.output import check_writable, write_whole
from compare.provenance import in_words
from compare.report.proofs import RowProof, lines, prove_row
from compare.report.tables import UNIFORM, all_rows
from floquet.enclosure.result import IntervalProof
from hill import UniformBeam

CHART = [("Omega", 0.35, 6.0, 200), ("gamma", 0.0, 0.5, 200)]
"""Where all rows of Table 1 are."""

PAGE = Path("docs/proofs.md")
"""From the root of a clone."""

ABOUT = {
    "of": "rows of Tables 1 to 3, a chart; two modes, equations as corrected, decimals as written"
}

INTRODUCTION = """\
# What is proven

<!-- Written by python -m compare.report.proofs_page from the computation. -->

Floating-point arithmetic rounds, and the bounds of `verify` are partly estimates
([theory.md](theory.md), section 9). Here nothing is rounded without being counted: every number
is a ball that holds the true one, from the decimals of the beam's parameters to the verdict.
Both routes enclose P(z), each by its own code (`hill/enclosure/`, `floquet/enclosure/`):"""

SUMMARY = """\
- **hill**: matrices in closed form; the determinant folded from outside, all that lies beyond a
  finite number of harmonics as a series of Hurwitz's zeta functions with a bounded remainder;
  roots by Smith's discs, stable by n changes of sign.
- **floquet**: matrices by rigorous quadrature of the weak form; a power series over the period
  with a bounded remainder; roots by discs.

[theory.md](theory.md), section 12, has the bounds."""

REASONS = """\
## Where the printed Omega does not tell

These rows are proven at the Omega that they were run at. Three decimals leave both verdicts open:
an edge of instability lies between two numbers that are printed the same."""

CHARTED = """\
## Every point of a chart

Table 1's beam without damping, Omega from .35 to 6 and gamma up to .5, which is where all of its
rows are. The chart has 200 times 200 cells, each what is nearest to one point of its grid, and a
cell counts as proven where one verdict is proven of all of its points. A cell that an edge of
instability crosses has none; parts of it have. P is enclosed at nodes and bounded between them
([theory.md](theory.md), section 12).

    verify chart --x Omega .35 6 200 --y gamma 0 .5 200 --certify --workers 2"""

ASSUMPTIONS = """\
## Under which assumptions

- The beam has two bending modes, as in the report: a verdict is one of the reduced equation,
  and says nothing of the modes left out.
- The equations are the report's as [errata.md](errata.md) corrects them.
- Parameters are the decimals of the tables' headings, as run: T0 = 20, not a number near it.
  Omega is the decimal that the row was run at, as recovered; in Table 3 omega_L is exactly
  twice Omega, and the vibration from an unstrained start has five terms, as run.
- "Every Omega" is every number within half a unit of the last printed digit, ends included.
  Where print is wrong for all of them it is wrong whatever the report's true Omega was.
- Stable: without damping, all z are real, simple and within (-1, 1). Unstable: T > 0. T is
  enclosed too.
- python-flint, that is Arb, and the code of this project work as they say. The two routes share
  neither matrices nor methods, only Arb, the exact parameters and the statement of the problem."""

CHECK = """\
## How to check it

    verify prove                        # every row at its Omega
    verify prove --interval --workers 2 # and for every Omega that is printed so
    verify prove T2-27 --format json    # the balls, as decimal strings

The balls of one route may be checked by any other means: integrate a row's equation over one
period with as many digits as one likes; P's coefficients must lie in the balls that `--format
json` prints. The tests break a bound on purpose, in each route, and see that the balls then no
longer meet."""

TABLE = """\
## Row by row

P +-: the radii of P's coefficients, no more than these. An arrow: print has it wrong. Parts of
an interval are given where there is more than one."""


def page(rows: Iterable[RowProof] | None = None, charted: Chart | None = None) -> str:
    """The page as Markdown.

    Parameters
    ----------
    rows : iterable of RowProof, optional
        All rows of the three tables with their intervals; computed where not given.
    charted : Chart, optional
        Certified; computed where not given.
    """
    if rows is None:
        with mapper(ALL_CORES, long_jobs=True) as over:
            rows = tuple(over(partial(prove_row, interval=True), all_rows()))
    if charted is None:
        uniform: dict[str, Any] = dict(UNIFORM)
        charted = chart(UniformBeam(**uniform), CHART, certify=True, workers=ALL_CORES)
    found = tuple(rows)
    table = [
        "| row | Omega printed | run at | printed | hill: P +- | floquet: P +- | T | proven "
        "| every Omega |",
        "| --- | ---: | ---: | --- | ---: | ---: | ---: | --- | --- |",
        *map(line, found),
    ]
    told = "\n".join(f"> {text}" for text in lines(found))
    open_rows = [reason(one) for one in found if one.interval and not one.everywhere]
    reasons = [REASONS, "\n".join(open_rows)] if open_rows else []
    share = f"> {proven_share(charted)}"
    parts = [INTRODUCTION, SUMMARY, told, *reasons, CHARTED, share, ASSUMPTIONS, CHECK, TABLE]
    parts += ["\n".join(table)]
    return "\n\n".join([*parts, in_words(ABOUT)]) + "\n"


def reason(one: RowProof) -> str:
    """Why a row has not one verdict for every Omega that is printed so."""
    found = one.interval
    assert found is not None
    edges = [f"{0.5 * (a + b):.7f}" for a, b, kind in found.parts if kind == "undecided"]
    (low, high), left = found.Omega, found.share("undecided")
    return (
        f"- **{one.row.id}**, printed {one.row.Omega_printed}, from {low:.4f} to {high:.4f}: "
        f"an edge at {' and '.join(edges)}, {left:.0e} of the interval undecided about it; "
        f"{one.proof.verdict} at {one.row.Omega:.6f}, where it was run."
    )


def proven_share(charted: Chart) -> str:
    """What is proven of a chart, in two sentences."""
    found = charted.certified
    assert found is not None
    return (
        f"{1.0 - found.undecided:.2%} of the area is proven, {found.stable:.2%} stable and "
        f"{found.unstable:.2%} unstable; of the {found.cells.size:,} cells "
        f"{np.sum(found.cells == 'stable'):,} are proven stable, "
        f"{np.sum(found.cells == 'unstable'):,} unstable, {found.whole:.1%} in all. "
        f"{charted.contradicted} verdicts of the floats contradict it."
    )


def line(one: RowProof) -> str:
    """A row of the table."""
    proof, interval = one.proof, one.interval
    cells = [
        one.row.id,
        one.row.Omega_printed,
        f"{one.row.Omega:.6f}",
        one.printed,
        *(_power(route.radius) if route else "" for route in (proof.hill, proof.floquet)),
        _T(one),
        _arrow(proof.verdict, one.flips),
        _everywhere(interval, one.flips_everywhere) if interval else "",
    ]
    return f"| {' | '.join(cells)} |"


def _arrow(verdict: str, wrong: bool) -> str:
    return f"**-> {verdict.upper()}**" if wrong else verdict


def _T(one: RowProof) -> str:
    """Ten decimals of the middle of the time domain's ball."""
    found = one.proof.floquet or one.proof.hill
    if found is None or found.T == "0":
        return "0"
    return f"{float(found.T.strip('[]').split(' +/- ')[0]):.10f}"


def _everywhere(found: IntervalProof, wrong: bool) -> str:
    if found.verdict != "both":
        return _arrow(found.verdict, wrong)
    parts = [f"{kind} from {low:.7f} to {high:.7f}" for low, high, kind in found.parts
             if kind != "undecided"]  # fmt: skip
    return "both: " + ", ".join(parts)


def _power(radius: float) -> str:
    """The next power of ten."""
    return f"1e{ceil(log10(radius)):+03d}" if radius > 0.0 else "0"


def main() -> None:
    """Write the page."""
    check_writable(PAGE)
    write_whole(PAGE, page())
    print(f"written: {PAGE}")


if __name__ == "__main__":
    main()
