"""The trial's tables: a class a line, and a class and route a cell."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.table import Table

from benchmarks.honesty.trial import ROUTES, Judged

KINDS = ("P", "T", "verdict", "NaN", "other")

# Reported over true: beyond it a bound says nothing any more.
INFLATED = 1e6


@dataclass(frozen=True)
class Line:
    """What is counted over some answers."""

    systems: int
    answers: int
    violations: dict[str, int]
    refused: int
    undecided: float
    T_skipped: int
    P_ratio: tuple[float, float, float]
    T_ratio: tuple[float, float, float]
    P_slack: float
    T_slack: float
    P_inflated: int
    T_inflated: int


def line(found: Sequence[Judged]) -> Line:
    """Count."""
    answered = [x for x in found if x.status == "answered"]
    return Line(
        systems=len({(x.kind, x.number) for x in found}),
        answers=len(found),
        violations={kind: sum(kind in x.violations for x in found) for kind in KINDS},
        refused=sum(x.status == "refused" for x in found),
        undecided=sum(x.undecided for x in answered) / max(len(answered), 1),
        T_skipped=sum(x.T_skipped for x in answered),
        P_ratio=_quantiles(x.P_ratio for x in answered),
        T_ratio=_quantiles(x.T_ratio for x in answered),
        P_slack=_quantiles(x.P_slack for x in answered)[0],
        T_slack=_quantiles(x.T_slack for x in answered)[0],
        P_inflated=sum((x.P_slack or 0.0) > INFLATED for x in answered),
        T_inflated=sum((x.T_slack or 0.0) > INFLATED for x in answered),
    )


def _quantiles(values: Iterable[float | None]) -> tuple[float, float, float]:
    """Median, 99 % and largest."""
    some = np.array([x for x in values if x is not None])
    if not len(some):
        return (0.0, 0.0, 0.0)
    middle, high = np.quantile(some, [0.5, 0.99], method="higher")
    return float(middle), float(high), float(np.max(some))


def by(found: Iterable[Judged], *names: str) -> dict[Any, list[Judged]]:
    """Grouped by fields, in the order they come in."""
    groups: dict[Any, list[Judged]] = defaultdict(list)
    for x in found:
        key = tuple(getattr(x, name) for name in names)
        groups[key if len(names) > 1 else key[0]].append(x)
    return groups


def lines(found: Sequence[Judged], name: str, first: str) -> Table:
    """A line a class, or a route."""
    table = Table(title=f"The bounds, {first} by {first}", box=None, pad_edge=False)
    table.add_column(first, no_wrap=True)
    heads = ("systems", "answers", "P", "T", "verdict", "NaN", "other", "refused", "undecided",
             "P true/reported", "T true/reported", "P rep./true", "T rep./true",
             "P > 1e6", "T > 1e6", "T unjudged")  # fmt: skip
    for head in heads:
        table.add_column(head, justify="right")
    groups = list(by(found, name).items())
    for key, some in [*groups, ("all", list(found))]:
        one = line(some)
        table.add_row(
            key, str(one.systems), str(one.answers), *map(str, one.violations.values()),
            str(one.refused), f"{one.undecided:.1%}", _three(one.P_ratio), _three(one.T_ratio),
            f"{one.P_slack:.3g}", f"{one.T_slack:.3g}", str(one.P_inflated), str(one.T_inflated),
            str(one.T_skipped),
        )  # fmt: skip
    return table


def _three(values: tuple[float, float, float]) -> str:
    return " ".join(f"{x:.2g}" for x in values)


def cells(found: Sequence[Judged]) -> Table:
    """Violations of P / T / verdict / NaN and other, a class a line and a route a column."""
    table = Table(
        title="Violations of P/T/verdict/NaN and other; a dot where there are none",
        box=None,
        pad_edge=False,
    )
    table.add_column("class", no_wrap=True)
    for route in ROUTES:
        table.add_column(route, justify="right")
    groups = by(found, "kind", "route")
    for kind in by(found, "kind"):
        table.add_row(kind, *(_cell(groups.get((kind, route), [])) for route in ROUTES))
    return table


def _cell(some: list[Judged]) -> str:
    if not some:
        return ""
    counts = line(some).violations
    rest = counts["NaN"] + counts["other"]
    if not sum(counts.values()):
        return "."
    return f"{counts['P']}/{counts['T']}/{counts['verdict']}/{rest}"
