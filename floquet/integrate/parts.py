"""The period in equal parts, each integrated from the identity: nothing that decays is lost."""

from dataclasses import dataclass
from math import ceil, floor, log2
from typing import Protocol

from floquet.arrays import Float
from floquet.integrate.normal_form import NormalForm


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
    """

    parts: int
    steps: int
    unit: float

    @classmethod
    def of(cls, form: NormalForm, parts: int, steps: int) -> "Grid":
        """With a unit near the length of a step."""
        return cls(parts, steps, 2.0 ** floor(log2(form.period / parts / steps)))


@dataclass(frozen=True, eq=False)
class Parts:
    """Fundamental matrices of the parts of the period, in time's order.

    Attributes
    ----------
    matrices : (parts, m, m) ndarray
        In the units of the grid and of the normal form.
    rounding : (parts, m, m) ndarray
        Some ulps of it are what rounding may do: the moduli of all that is summed.
    data : (parts, m, m) ndarray
        What errors of the equation's own numbers may do.
    """

    matrices: Float
    rounding: Float
    data: Float


class PartsMethod(Protocol):
    """A way to integrate each part of the period from the identity."""

    def __call__(self, form: NormalForm, grid: Grid) -> Float:
        """The fundamental matrix of each part, (parts, m, m)."""
        ...


def parts_needed(steps: int, each: int) -> int:
    """How many parts of `each` steps the period has."""
    return max(ceil(steps / each), 1)
