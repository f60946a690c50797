"""The printed values, and what cannot be shown of them."""

import tomllib
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files

from compare.erratum import Erratum, errata_from

DATA = files("compare") / "publications" / "mathieu" / "table.toml"
EVEN, ODD = 1, 2
"""The two parts of the table: a_r of even solutions, b_r of odd ones."""


@dataclass(frozen=True)
class Row:
    """One characteristic value.

    Attributes
    ----------
    id : str
        "a5-q10".
    table : int
    r : int
    q : float
    printed : str
        To as many decimals as the handbook has.
    """

    id: str
    table: int
    r: int
    q: float
    printed: str

    @property
    def half_unit(self) -> float:
        """Half a unit of the last printed digit."""
        return 0.5 * float(Decimal(1).scaleb(int(Decimal(self.printed).as_tuple().exponent)))

    @property
    def z(self) -> int:
        """Where P vanishes: the multiplier over pi, (-1)^r."""
        return (-1) ** self.r


@cache
def rows(table: int) -> tuple[Row, ...]:
    """The values of one part of the table, by r and q."""
    data, letter = tomllib.loads(DATA.read_text()), {EVEN: "a", ODD: "b"}[table]
    unit = Decimal(1).scaleb(-data["decimals"])
    return tuple(
        Row(f"{letter}{r}-q{q}", table, r, float(q), str(Decimal(value).quantize(unit)))
        for r, q, value in data[letter]
    )


@cache
def errata() -> tuple[Erratum, ...]:
    """What cannot be shown."""
    return errata_from(DATA)
