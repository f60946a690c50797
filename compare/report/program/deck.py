"""Card images of the report's programs, read by the FORMATs of their DRIVERs."""

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

import numpy as np

from compare.report.program.listing import Stepped, Uniform


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
        """Numbers of one FORMAT, which starts anew on the next card until `count` are read."""
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
        for field in layout:
            text = line[column : column + field.width].strip()
            try:
                if not text.isascii():
                    raise ValueError
                # FORTRAN reads an empty field as zero
                numbers.append(float(int(text or "0") if field.kind == "I" else text or "0"))
            except ValueError:
                raise ValueError(
                    f"{self.name}, card {self.next}, columns {column + 1}-{column + field.width}: "
                    f"{text!r} is not {'a whole number' if field.kind == 'I' else 'a number'}"
                ) from None
            column += field.width
        return numbers


def shipped(name: str) -> Cards:
    """The report's own deck, "uniform" or "stepped"."""
    return Cards(
        f"deck_{name}.txt", (files("compare") / f"report/data/deck_{name}.txt").read_text()
    )


def from_file(path: Path) -> Cards:
    """Any deck of the same form."""
    return Cards(path.name, path.read_text())


def uniform_constants(cards: Cards) -> tuple[Uniform, float, float]:
    """The first cards of the uniform deck: constants, and the XG and S1 among them."""
    N, XG, _, S1, PI = cards.read("I3,3E7.0,1E12.0")
    modes = np.array([cards.read("4E12.0") for _ in range(5)])
    R, B, PH, DPH = modes.T
    DPHG = np.array(cards.read("5E12.0"))
    return Uniform(int(N), PI, R, B, PH, DPH, DPHG), XG, S1


def stepped_constants(cards: Cards) -> Stepped:
    """The first cards of the stepped deck."""
    N, PI = cards.read("I5,E12.1")
    R, B = (np.array(cards.read("5E12.1")) for _ in range(2))
    tables = (np.reshape(cards.read("7E10.1", 50), (5, 10)).T for _ in range(4))
    return Stepped(int(N), PI, R, B, *tables)


def constants(name: str) -> Uniform | Stepped:
    """Constants of the shipped deck, "uniform" or "stepped"."""
    cards = shipped(name)
    return uniform_constants(cards)[0] if name == "uniform" else stepped_constants(cards)
