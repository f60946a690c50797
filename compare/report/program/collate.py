"""Printed output held against computed output, line by line, and the list of known differences."""

import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import permutations
from typing import Literal, NamedTuple

from compare.report.tables import DATA

State = Literal["same", "order", "unit", "differs"]
KINDS = ("scan", "lost", "arithmetic", "path")

NUMBER = re.compile(r"[+-]?\d*\.\d+")
COLUMN = 10
"""Width of the numbers of ROOTR and ROOTI."""
FIRST = 35
"""Where they start."""

ROOTS = ("ROOTR", "ROOTI")


class Place(NamedTuple):
    """Where a line stands: run, block, evaluation (0 before the first), and which of its lines."""

    format: int
    block: str
    step: int
    line: str


@dataclass(frozen=True)
class LineComparison:
    """One line, printed and computed; None where there is no such line.

    `state` is "same"; "order", where it is the same once the roots stand in the same order;
    "unit", where no number is further off than one unit of its last digit; or "differs".
    """

    place: Place
    printed: str | None
    computed: str | None
    state: State


@dataclass(frozen=True)
class Difference:
    """One entry of ``listing_differences.toml``.

    Attributes
    ----------
    kind : str
        "scan", a misread character; "lost", a number that the scan lost; "arithmetic", 27 bits;
        "path", a step that SWITCH took because of another difference.
    corrected : str
        The line as it is believed to stand in the report; empty for the last two kinds.
    """

    program: str
    place: Place
    OMEGB: str
    printed: str
    computed: str
    kind: str
    cause: str
    corrected: str = ""


@cache
def differences() -> tuple[Difference, ...]:
    """Printed lines that do not come back to one unit of their last digit, with their causes."""
    listed = tomllib.loads((DATA / "listing_differences.toml").read_text())["difference"]
    found = []
    for entry in listed:
        common = {key: entry[key] for key in ("program", "OMEGB", "kind", "cause")}
        for line in entry["lines"]:
            place = Place(entry["format"], entry["block"], entry["step"], line.pop("line"))
            found.append(Difference(place=place, **common, **line))
    return tuple(found)


def printed_output(program: str) -> list[str]:
    """The printed output under the listing of one program."""
    return (DATA / f"listing_{program}.txt").read_text().splitlines()


def collate(printed: Sequence[str], computed: Sequence[str]) -> list[LineComparison]:
    """Every line of either, in the order of print."""
    there, here = dict(_placed(printed)), dict(_placed(computed))
    judged = []
    for place in [*there, *(p for p in here if p not in there)]:
        was, now = there.get(place), here.get(place)
        if was is None or now is None:
            judged.append(LineComparison(place, was, now, "differs"))
            continue
        state = compare_lines(was, now)
        if state != "same" and place.line in ROOTS:
            names = [place._replace(line=name) for name in ROOTS]
            pairs = [there.get(name, "") for name in names], [here.get(name, "") for name in names]
            ordered = _in_printed_order(*pairs)[ROOTS.index(place.line)]
            again = compare_lines(was, ordered)
            if again != "differs" and state == "differs":
                state, now = ("order" if again == "same" else again), ordered
        judged.append(LineComparison(place, was, now, state))
    return judged


def compare_lines(printed: str, computed: str) -> State:
    """Whether a line comes back, its roots taken in the order in which they stand."""
    if printed == computed:
        return "same"
    was, now = NUMBER.findall(printed), NUMBER.findall(computed)
    words = [NUMBER.sub("#", line).split() for line in (printed, computed)]
    same_form = words[0] == words[1] and len(printed) == len(computed)
    if not same_form or any(_units(a, b) > 1 for a, b in zip(was, now, strict=True)):
        return "differs"
    return "unit"


def _units(printed: str, computed: str) -> int:
    """Units of the last printed digit between two numbers of equally many digits."""
    decimals = len(printed.partition(".")[2])
    return abs(round((float(printed) - float(computed)) * 10**decimals))


def _in_printed_order(printed: Sequence[str], computed: Sequence[str]) -> list[str]:
    """Computed ROOTR and ROOTI with their columns in the order closest to the printed ones."""
    was, now = ([_columns(line) for line in pair] for pair in (printed, computed))

    def miss(order: tuple[int, ...]) -> float:
        return sum(
            abs(float(value) - float(now[part][k]))
            for part in (0, 1)
            for value, k in zip(was[part], order, strict=False)
        )

    best = min(permutations(range(len(now[0]))), key=miss)
    return [
        line[:FIRST] + "".join(cells[k].rjust(COLUMN) for k in best)
        for line, cells in zip(computed, now, strict=True)
    ]


def _columns(line: str) -> list[str]:
    return line[FIRST:].split()


def _placed(lines: Sequence[str]) -> Iterator[tuple[Place, str]]:
    """Each line with its place; a doubtful determinant belongs to the evaluation after it."""
    number, block, step, count, doubtful = 0, "", 0, 0, 0
    seen: dict[tuple[int, str], int] = {}
    for line in lines:
        word = line.split("=")[0].split()[0] if line.strip() else ""
        if line.startswith("FORMAT ("):
            number, block, step, count = int(line[8]), "", 0, 0
        elif "IN VICINITY OF " in line:
            # the two blank lines above it have been given to the block before
            block, step, count = line.split(" OF ")[1], 0, 0
            seen[number, block] = seen.get((number, block), 0) + 1
            if seen[number, block] > 1:
                block += f" ({seen[number, block]})"
        elif word == "CONVERGENCE":
            doubtful += 1
            yield Place(number, block, step + 1, f"doubtful {doubtful}"), line
            continue
        elif word == "OMEGB":
            step, count, doubtful = step + 1, 0, 0
        count += 1
        name = word if step and word in ("OMEGB", *ROOTS, "STAB1") else f"line {count}"
        yield Place(number, block, step, name), line
