"""The rows of Hill's determinant in balls, and the groups of them that couple neighbours only."""

from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from operator import add
from typing import Any

from flint import acb, acb_mat, arb, arb_mat, fmpq


@dataclass(frozen=True, eq=False)
class Rows:
    """Blocks T_mm = Fbar - (m + alpha)^2, T_m,m+-p = B_p.

    Attributes
    ----------
    Fbar : (n, n) arb_mat
        (F - eta^2/4)/Omega^2.
    B : mapping of int to (n, n) arb_mat
        Halves of the pulsating terms over Omega^2, by harmonic.
    """

    Fbar: Any
    B: dict[int, Any]

    @property
    def n(self) -> int:
        """Coordinates."""
        return int(self.Fbar.nrows())

    @property
    def reach(self) -> int:
        """Harmonics in a group: the highest in the coefficients."""
        return max(self.B)

    @property
    def coupling(self) -> Any:
        """Bound on the row sums of the coupling of a group with the next one."""
        return reduce(add, (norm(B) for B in self.B.values()))

    @property
    def size(self) -> Any:
        """Bound on the row sums of T but for (m + alpha)^2."""
        return norm(self.Fbar) + 2 * self.coupling

    def block(self, harmonics: list[Any]) -> Any:
        """Rows and columns of some neighbouring harmonics, each (m + alpha)."""
        n, count = self.n, len(harmonics)
        total = [[acb(0)] * (n * count) for _ in range(n * count)]
        for i, s in enumerate(harmonics):
            for j in range(count):
                part = self.Fbar if i == j else self.B.get(abs(i - j))
                if part is not None:
                    put(total, part, n * i, n * j)
            for k in range(n * i, n * (i + 1)):
                total[k][k] = total[k][k] - s * s
        return acb_mat(total)

    def between(self, count: int, first: int) -> tuple[Any, Any]:
        """Coupling of `count` harmonics to a group outside, and back.

        The group's first harmonic is `first` steps outside the outermost of them.
        """
        n, g = self.n, self.reach
        out = [[arb(0)] * (n * g) for _ in range(n * count)]
        back = [[arb(0)] * (n * count) for _ in range(n * g)]
        for i in range(count):
            for j in range(g):
                # the outermost is the last: i = count - 1
                part = self.B.get(first + j + (count - 1 - i))
                if part is not None:
                    put(out, part, n * i, n * j)
                    put(back, part, n * j, n * i)
        return acb_mat(arb_mat(out)), acb_mat(arb_mat(back))


def put(table: list[list[Any]], part: Any, row: int, column: int) -> None:
    """A block into its place."""
    for i, line in enumerate(part.tolist()):
        for j, value in enumerate(line):
            table[row + i][column + j] = table[row + i][column + j] + value


def norm(matrix: Any) -> Any:
    """Upper bound on the largest row sum of moduli."""
    sums = (reduce(add, (abs(x).upper() for x in row)) for row in matrix.tolist())
    return reduce(lambda a, b: a.max(b), sums).upper()


def number(value: Any) -> Any:
    """A fraction or a float as a ball."""
    if isinstance(value, Fraction):
        return arb(fmpq(value.numerator, value.denominator))
    return arb(value)


def floats(matrix: Any) -> Any:
    """Floats as balls of radius zero."""
    return arb_mat([[arb(float(x)) for x in row] for row in matrix])


def rows(F: Any, pulses: dict[int, Any], Omega: Any, eta: Any) -> Rows:
    """From F and the pulsating matrices by harmonic, all in balls."""
    per = 1 / Omega**2
    n = F.nrows()
    shift = arb_mat([[eta * eta / 4 if i == j else arb(0) for j in range(n)] for i in range(n)])
    return Rows((F - shift) * per, {p: M * (per / 2) for p, M in pulses.items()})
