"""Card images of the report's programs, read by the FORMATs of their DRIVERs."""

import re
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

NUMBER = {
    "I": (re.compile(r" *([+-]?\d+)?"), "a whole number at the right end of its field"),
    "E": (
        re.compile(r" *([+-]?(\d+\.\d*|\.\d+)(E[+-]?\d+)? *)?"),
        "a number with a decimal point",
    ),
}
"""What FORTRAN would read otherwise, by position or with blanks for zeros, is refused."""


@dataclass(frozen=True)
class Field:
    """One numeric field of a card: I or E, and its width."""

    kind: str
    width: int


def fields(pattern: str) -> tuple[Field, ...]:
    """Fields of a FORMAT such as "I3,3E7.0,1E12.0,36X"; skips (X) at the end are dropped."""
    found = []
    for item in pattern.split(","):
        kind = next(letter for letter in item if letter.isalpha())
        repeat, width = item.split(kind)
        if kind != "X":
            found += [Field(kind, int(width.split(".")[0]))] * int(repeat or 1)
    return tuple(found)


class Cards:
    """Cards read one after another; an error names the card and the columns."""

    def __init__(self, name: str, text: str) -> None:
        self.name, self.lines, self.next = name, text.splitlines(), 0

    def read(self, pattern: str, count: int | None = None) -> list[float]:
        """Numbers of one FORMAT, which starts anew on the next card until `count` are read.

        Raises
        ------
        ValueError
            No card is left, or a field cannot be read in one way only.
        """
        layout = fields(pattern)
        wanted = len(layout) if count is None else count
        numbers: list[float] = []
        while len(numbers) < wanted:
            numbers += self._card(layout[: wanted - len(numbers)])
        return numbers

    def _card(self, layout: tuple[Field, ...]) -> list[float]:
        if self.next >= len(self.lines):
            raise ValueError(f"{self.name}: ends after card {self.next}, more are needed")
        line = self.lines[self.next]
        self.next += 1
        column, numbers = 0, []
        for k, field in enumerate(layout):
            text = line[column : column + field.width]
            pattern, wanted = NUMBER[field.kind]
            if not (text.isascii() and pattern.fullmatch(text)):
                self.fail(layout, k, f"{text.strip()!r} is not {wanted}")
            # FORTRAN reads an empty field as zero
            numbers.append(float(text.strip() or "0"))
            column += field.width
        return numbers

    def fail(self, layout: tuple[Field, ...], k: int, why: str) -> None:
        """Raise an error that names the card read last and the columns of its k-th field."""
        start = sum(field.width for field in layout[:k])
        columns = f"{start + 1}-{start + layout[k].width}"
        raise ValueError(f"{self.name}, card {self.next}, columns {columns}: {why}")

    def require(self, pattern: str, k: int, ok: bool, why: str) -> None:
        """Fail at the k-th field of the card read last, unless `ok`."""
        if not ok:
            self.fail(fields(pattern), k, why)


def shipped(name: str) -> Cards:
    """The report's own deck, "uniform" or "stepped"."""
    text = (files("compare") / f"report/data/deck_{name}.txt").read_text()
    return Cards(f"deck_{name}.txt", text)


def from_file(path: Path) -> Cards:
    """Any deck of the same form."""
    return Cards(path.name, path.read_text())
