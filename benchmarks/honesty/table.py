"""The trial's tables: a class a line, or a route; each fits into 80 columns."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from rich.table import Table

from benchmarks.honesty.judge import INFLATED, Judged

LEGEND = """\
beyond: systems that the arbiter gives up. median, 99%, most: of the true error
over the reported one; above 1 is a violation. worth: the median of the reported
error over the true one, which counts as an ulp at least. >1e6: bounds so many
times too large; silent: those of them with a verdict, where the result does not
say that the number is poorly known. unjudged: the arbiter's ball is too wide."""


@dataclass(frozen=True)
class Number:
    """What is counted of one number over some answers.

    Attributes
    ----------
    ratio : tuple of float
        True error over the reported one: median, 99 %, largest.
    slack : float
        Reported over true, the median.
    inflated, silent : int
        Bounds more than `INFLATED` times too large; and those without a word that says so.
    unjudged : int
        Answers where the arbiter's own number is too wide.
    """

    ratio: tuple[float, float, float]
    slack: float
    inflated: int
    silent: int
    unjudged: int


@dataclass(frozen=True)
class Line:
    """What is counted over some answers; `beyond` are systems, the rest are answers."""

    systems: int
    beyond: int
    answers: int
    violations: dict[str, int]
    refused: int
    undecided: float
    numbers: dict[str, Number]


def line(found: Sequence[Judged], names: Sequence[str]) -> Line:
    """Count."""
    answered = [x for x in found if x.status == "answered"]
    return Line(
        systems=len({(x.kind, x.number) for x in found}),
        beyond=len({(x.kind, x.number) for x in found if x.beyond}),
        answers=len(found),
        violations={kind: sum(kind in x.violations for x in found) for kind in wrongs(names)},
        refused=sum(x.status == "refused" for x in found),
        undecided=sum(x.undecided for x in answered) / max(len(answered), 1),
        numbers={name: _number(answered, name) for name in names},
    )


def wrongs(names: Sequence[str]) -> tuple[str, ...]:
    """What can be wrong with an answer that has these numbers."""
    return (*names, "verdict", "NaN", "other")


def _number(answered: Sequence[Judged], name: str) -> Number:
    measured = [x.measured[name] for x in answered if name in x.measured]
    return Number(
        ratio=_quantiles(m.ratio for m in measured),
        slack=_quantiles(m.slack for m in measured)[0],
        inflated=sum(bool(m.slack > INFLATED) for m in measured),
        silent=sum(m.inflated for m in measured),
        unjudged=sum(name in x.unjudged for x in answered),
    )


def _quantiles(values: Iterable[float]) -> tuple[float, float, float]:
    """Median, 99 % and the largest."""
    known = np.sort(np.fromiter(values, float))
    if not len(known):
        return (0.0, 0.0, 0.0)
    # not interpolated: one of them may be infinite
    middle, last = (known[int(q * (len(known) - 1))] for q in (0.5, 0.99))
    return float(middle), float(last), float(known[-1])


def by(found: Iterable[Judged], *names: str) -> dict[Any, list[Judged]]:
    """Grouped by fields, in the order they come in."""
    groups: dict[Any, list[Judged]] = defaultdict(list)
    for x in found:
        key = tuple(getattr(x, name) for name in names)
        groups[key if len(names) > 1 else key[0]].append(x)
    return groups


def tables(found: Sequence[Judged], names: Sequence[str], field: str, first: str) -> list[Table]:
    """What is wrong, and what the bounds are worth; a line a class, or a route.

    Parameters
    ----------
    names : sequence of str
        The numbers of an answer.
    field, first : str
        By which of an answer's fields, and what that is called.
    """
    lines = {key: line(some, names) for key, some in by(found, field).items()}
    lines["all"] = line(found, names)
    return [_counts(lines, names, first), *(_worth(lines, name, first) for name in names)]


def _counts(lines: dict[str, Line], names: Sequence[str], first: str) -> Table:
    heads = ("systems", "beyond", "asked", *wrongs(names), "refused", "undecided")
    table = _table(f"Violations, {first} by {first}", first, heads)
    for key, one in lines.items():
        counts = (one.systems, one.beyond, one.answers, *one.violations.values(), one.refused)
        table.add_row(key, *map(str, counts), f"{one.undecided:.1%}")
    return table


def _worth(lines: dict[str, Line], name: str, first: str) -> Table:
    heads = ("median", "99%", "most", "worth", ">1e6", "silent", "unjudged")
    table = _table(f"{name}: true over reported error, and reported over true", first, heads)
    for key, one in lines.items():
        n = one.numbers[name]
        shares = (f"{x:.1g}" if x < 0.095 else f"{x:.2f}" for x in n.ratio)
        counts = map(str, (n.inflated, n.silent, n.unjudged))
        table.add_row(key, *shares, f"{n.slack:.3g}", *counts)
    return table


def _table(title: str, first: str, heads: Iterable[str]) -> Table:
    table = Table(title=title, title_justify="left", box=None, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column(first, no_wrap=True)
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    return table


def cells(found: Sequence[Judged], names: Sequence[str], routes: Sequence[str]) -> Table:
    """Violations, a class a line and a route a column."""
    table = _table("Violations, class by route; a dot where there are none", "class", routes)
    groups = by(found, "kind", "route")
    for kind in by(found, "kind"):
        row = []
        for route in routes:
            some = groups.get((kind, route), [])
            count = sum(bool(x.violations) for x in some)
            row.append(str(count or ".") if some else "")
        table.add_row(kind, *row)
    return table


def content(found: Sequence[Judged], names: Sequence[str]) -> dict[str, Any]:
    """What JSON holds: every class and route, every violation, every bound inflated in silence."""
    groups = by(found, "kind", "route").items()
    silent = [x for x in found if any(m.inflated for m in x.measured.values())]
    return {
        "lines": [{"class": k, "route": r} | asdict(line(g, names)) for (k, r), g in groups],
        "violations": [asdict(x) for x in found if x.violations],
        "silent": [asdict(x) for x in silent],
    }
