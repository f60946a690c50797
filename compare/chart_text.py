"""A chart in words: a few lines, and a table of its tongues."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from rich.table import Table

from compare.charts.certified import Certified
from compare.charts.compute import CHECKS
from compare.charts.result import Chart
from compare.console import bare_table
from compare.edges.instabilities import Instability
from compare.edges.tongue import RANGE, TIP, UNSEEN
from compare.edges.unnamed import Region


def describe(result: Chart) -> list[str]:
    """What was found, in a few lines."""
    unstable, undecided = float(np.mean(result.unstable())), float(np.mean(result.undecided()))
    size = " x ".join(str(axis.count) for axis in result.axes)
    lines = [
        f"{size} points from {result.nodes} evaluations of P in {result.seconds:.1f} s"
        + (f" ({result.resumed} of them were on disk)" if result.resumed else "")
        + f"; {_share(unstable)} unstable, {_share(undecided)} undecided, T at most "
        f"{_largest(result)}.",
        f"P is known to {result.relative_error:.0e} of its largest coefficient at worst; "
        f"{_checked(result)}.",
    ]
    lines += [f"{count} points went one by one: {why}." for why, count in result.one_by_one.items()]
    if result.route == "both":
        lines.append(
            f"The two routes differ by {result.disagreement:.0e} of P at the nodes"
            + (", with the same matrices." if result.shared_matrices else ".")
        )
    if result.certified is not None:
        lines.append(_certified(result, result.certified))
    return lines


def _certified(result: Chart, found: Certified) -> str:
    """What is proven, and whether the verdicts of the points are with it."""
    against = result.contradicted
    return (
        f"Proven: {1.0 - found.undecided:.1%} of the area, {found.stable:.1%} stable and "
        f"{found.unstable:.1%} unstable, and {found.whole:.1%} of the {found.cells.size:,} cells "
        f"as a whole, from {found.enclosures:,} enclosures of P in {found.seconds:.0f} s; "
        + (f"{against} verdicts CONTRADICT it." if against else "no verdict contradicts it.")
    )


def _largest(result: Chart) -> str:
    """The largest T, and what is known of it."""
    k = np.unravel_index(np.argmax(result.T), result.T.shape)
    if not np.isfinite(result.T[k]):
        return "beyond a float"
    # the last axis comes first in T
    at = zip(result.axes, reversed(k), strict=True)
    there = result.at(**{axis.name: axis.points[index] for axis, index in at})
    return f"{result.T[k]:.5f} +- {there.T_error[0]:.0e}"


def _checked(result: Chart) -> str:
    """What the random points say of the series."""
    if result.checked is not None:
        few = f"at {result.checks} of {CHECKS}" if result.checks < CHECKS else f"at {CHECKS}"
        return f"{few} random points the series is off by {result.checked:.0e} at most"
    if result.one_by_one and result.direct == result.T.size:
        return "there is no series to be checked"
    return f"the series could be checked at none of {CHECKS} random points"


def ended(found: Sequence[Instability], other: str) -> Iterator[str]:
    """The tongues that go no further, and why, where that is not plain.

    Those whose edges come too near each other to be seen are told together.
    """
    unseen: dict[str, list[str]] = {}
    for i in found:
        ends = ((i.tongue.begins, "from", 0), (i.tongue.ends, "up to", -1))
        for why, word, at in ends:
            y = f"{i.tongue.y[at]:.3g}"
            if why == UNSEEN:
                unseen.setdefault(f"{word} {other} = {y}", []).append(i.resonance.name)
            elif why not in (RANGE, TIP):
                reach = "begins" if word == "from" else "ends"
                yield f"{i.resonance.name} {reach} at {other} = {y}: {why}."
    if unseen:
        parts = (f"{where}, {', '.join(names)}" for where, names in unseen.items())
        yield f"Followed only where edges are seen, beyond the error of P: {'; '.join(parts)}."


def told(region: Region) -> str:
    """An unstable region without a name, in a line."""
    where = ", ".join(f"{name} {low:.5g} to {high:.5g}" for name, low, high in region.extent)
    return f"Unstable without a tongue's name: {where}, T up to {region.T:.5f}."


def _share(value: float) -> str:
    """Per cent; what is more than nothing is not called 0."""
    return f"{value:.1%}" if value == 0.0 or value >= 5e-4 else f"{value:.0e}".join(("", " of it"))


NARROW = 110
"""Columns below which the list of tongues leaves out what the others imply."""


def tongue_table(found: Sequence[Instability], other: str, width: int) -> Table:
    """The tongues, widest first; on a narrow terminal without types, tips and Hsu's values."""
    table = bare_table()
    narrow = width < NARROW
    heads, rows = tongue_cells(found, other, narrow=narrow)
    for k, head in enumerate(heads):
        number = k >= (1 if narrow else 3)
        table.add_column(
            head,
            justify="right" if number else "left",
            no_wrap=head in ("resonance", "crossing"),
        )
    for row in rows:
        table.add_row(*row)
    return table


def tongue_cells(
    found: Sequence[Instability], other: str, *, narrow: bool = False
) -> tuple[list[str], list[list[str]]]:
    """Heads and rows of that table; the first column has names, and types follow if not narrow."""
    columns = _numbers(found, other, narrow)
    words = ["resonance", *([] if narrow else ["type", "crossing"])]
    rows = []
    for i in found:
        numbers = [(value(i), digits) for _, value, digits, _ in columns]
        shown = [f"{v:.{digits}f}" if np.isfinite(v) else "-" for v, digits in numbers]
        rows.append(
            [i.resonance.name, i.resonance.type, i.resonance.crossing][: len(words)] + shown
        )
    return [*words, *(head for head, *_ in columns)], rows


def _numbers(
    found: Sequence[Instability], other: str, narrow: bool
) -> list[tuple[str, Callable[[Instability], float], int, bool]]:
    """Columns of numbers: head, value, digits, and whether a narrow terminal has it."""
    columns: list[tuple[str, Callable[[Instability], float], int, bool]] = [
        ("tip at Omega", lambda i: i.tips[0][0] if i.tips else np.nan, 6, False),
        (f"tip at {other}", lambda i: i.tips[0][1] if i.tips else np.nan, 5, False),
        (f"at {other}", lambda i: i.y, 4, True),
        ("width", lambda i: i.width, 5, True),
        ("Hsu's", lambda i: i.width_Hsu or np.nan, 5, False),
        ("largest T", lambda i: i.T, 5, True),
        ("at Omega", lambda i: i.Omega, 5, True),
    ]
    if other == "gamma" and any(np.isfinite(i.critical_gamma) for i in found):
        columns.append(("critical gamma", lambda i: i.critical_gamma, 5, True))
        columns.append(("Hsu's", lambda i: i.critical_gamma_Hsu, 5, False))
    return [c for c in columns if c[3] or not narrow]
