"""The period in equal parts, each integrated from the identity: nothing that decays is lost."""

from dataclasses import dataclass, replace
from math import ceil, floor, log2
from typing import Protocol

from floquet.arrays import Float
from floquet.integrate.normal_form import NormalForm

# Beyond, a part is that many steps more.
MAX_PARTS = 128


@dataclass(frozen=True)
class Grid:
    """How the period is divided.

    Attributes
    ----------
    parts : int
    steps : int
        Of a method of fixed order, in each part.
    unit : float
        Of time, a power of two: the state is (q, unit q').
    first : int
        Only so many of the parts are integrated, from the start.
    """

    parts: int
    steps: int
    unit: float
    first: int

    @classmethod
    def of(cls, form: NormalForm, parts: int, steps: int, *, half: bool = False) -> "Grid":
        """With a unit near the length of a step; of an even number of parts perhaps only half."""
        unit = 2.0 ** floor(log2(form.period / parts / steps))
        return cls(parts, steps, unit, parts // 2 if half else parts)

    def again(self, steps: int) -> "Grid":
        """The same parts in another number of steps."""
        return replace(self, steps=steps)


@dataclass(frozen=True, eq=False)
class Parts:
    """Fundamental matrices of the parts of the period, in time's order.

    Attributes
    ----------
    matrices : (parts, m, m) ndarray
        In the units of the grid and of the normal form.
    rounding : (parts, m, m) ndarray
        Some ulps of it are what rounding may do: the moduli of all that is summed.
    data : (parts, m, m) ndarray or None
        What errors of the equation's own numbers may do, where it has any.
    """

    matrices: Float
    rounding: Float
    data: Float | None


class PartsMethod(Protocol):
    """A way to integrate each part of the period from the identity."""

    def __call__(self, form: NormalForm, grid: Grid) -> Float:
        """The fundamental matrix of each part, (parts, m, m)."""
        ...


def parts_needed(steps: int, each: int) -> tuple[int, int]:
    """How many parts of `each` steps the period has, and by which power of two steps are more.

    There are no more than `MAX_PARTS`.
    """
    needed, times = max(ceil(steps / each), 1), 1
    while needed > MAX_PARTS * times:
        times *= 2
    return ceil(needed / times), times
