"""Balls as narrow as one asks: all is done again with twice the bits until they are."""

from collections.abc import Callable, Iterable
from functools import reduce
from typing import Any

from flint import arb, ctx

from floquet.enclosure import series, steps
from floquet.enclosure.balls import Problem
from floquet.enclosure.series import Singular, TooWide

BITS = 256
"""To start with; `narrowed` doubles them until the balls are narrow enough."""

MAX_BITS = 1 << 13

NARROW = 140
"""Bits to which P's balls are known, of the largest coefficient: 2**-140 is 7e-43."""


def narrowed(
    compute: Callable[[], list[Any]], narrow: int, refine: int = 1, *, begin: int = BITS
) -> list[Any]:
    """What `compute` returns, with as many bits as make its balls `narrow`, of the largest number.

    Raises
    ------
    TooWide
        `MAX_BITS` do not.
    """
    bits = max(begin, 2 * narrow) * refine
    while bits <= MAX_BITS:
        with ctx.workprec(bits):
            try:
                found = compute()
            except Singular:
                found = [arb.nan()]
            if _finite(found):
                widest = max((x.rad() for x in found), key=float)
                size = reduce(lambda a, b: a.max(b), (abs(x.mid()) for x in found))
                if widest < size * arb(2) ** -narrow or not size > 0:
                    return found
        bits *= 2
    raise TooWide(f"not known to {narrow} bits with {MAX_BITS} in the work")


def square(given: Problem, refine: int = 1) -> Any:
    """The matrix whose characteristic polynomial is P."""
    return series.first_block(given) if given.D is None else steps.monodromy(given, refine)


def _finite(numbers: Iterable[Any]) -> bool:
    return all(x.is_finite() for x in numbers)
