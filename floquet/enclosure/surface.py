"""P's coefficients over a rectangle of s = 1/Omega and gamma, as polynomials with a bounded rest.

They are entire functions of both. Through Chebyshev's points in x and y, both in [-1, 1], they are
known to what `bound` says on Bernstein's ellipses (Trefethen, Approximation Theory and
Approximation Practice, chapter 8), the second remainder times Lebesgue's constant of the first
interpolation, below 1 + (2/pi) ln N. That is restricted, without an error, to patches on which a
polynomial of low degree is left: it is kept in floats, and all that is cut off is counted.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, reduce
from math import acosh, ceil, log, sqrt
from operator import add
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx, fmpz
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from floquet.arrays import frozen
from floquet.enclosure.balls import Problem, number
from floquet.enclosure.bound import Bound
from floquet.enclosure.narrow import narrowed, square

Float = NDArray[np.floating[Any]]
Packed = tuple[int, int, int, int]

BITS = 192
"""In the work with the polynomials: Chebyshev's of degree 100 at balls cost some 14 bits."""

NODE_BITS = 128
"""In the work at a node, to begin with."""

LEFT_OUT = 40
"""Bits: each remainder is 2**-40, or 9e-13. Cells are no narrower than 1e-4 in P."""

KNOWN = 60
"""Bits to which P is known at the nodes."""

PHASE = 1.0
"""Radians, by `bound`, that P may turn over half a patch: its series falls off like 1/(2^k k!)."""

TERMS = 10
"""Of the series along each side of a patch."""

# Half-axes of the ellipse that are tried.
RADII = frozen(np.geomspace(1.05, 1e4, 300))


@dataclass(frozen=True)
class Rectangle:
    """Middle and half width of s = 1/Omega and of gamma."""

    s: Fraction
    half_s: Fraction
    gamma: Fraction
    half_gamma: Fraction


@dataclass(frozen=True, eq=False)
class Patch:
    """A part of the rectangle and P's coefficients in it.

    Attributes
    ----------
    x, y : (Fraction, Fraction)
        Its ends, of [-1, 1].
    powers : (n, a, b) ndarray
        Coefficients of x**i y**j, x and y from -1 to 1 over the patch; P's own as in P, from the
        second highest power of z on.
    rest : (n,) ndarray
        Bound on what `powers` leave out.
    """

    x: tuple[Fraction, Fraction]
    y: tuple[Fraction, Fraction]
    powers: Float
    rest: Float


def counts(bound: Bound, over: Rectangle) -> tuple[tuple[int, int], Any]:
    """How many nodes along s and gamma, and a bound on what the polynomial leaves out."""
    s, half_s = float(over.s), float(over.half_s)
    gamma, reach = abs(float(over.gamma)), float(over.half_gamma)

    def along_s(a: float) -> float:
        return bound.log(s + half_s * a, half_s * sqrt(a * a - 1.0), gamma + reach)

    def along_gamma(b: float) -> float:
        return bound.log(s + half_s, 0.0, gamma + reach * b)

    first, left = _count(along_s)
    second, other = _count(along_gamma)
    return (first, second), left + other * (1 + 2 * arb(first).log() / arb.pi())


def _count(size: Callable[[float], float]) -> tuple[int, Any]:
    wanted = LEFT_OUT * log(2.0)
    count, a = min((ceil((wanted + size(a) + 3.0) / acosh(a)) + 2, a) for a in map(float, RADII))
    rho = arb(a) + (arb(a) ** 2 - 1).sqrt()
    return count, 4 * arb(size(a) * (1.0 + 1e-9)).exp() * rho ** (1 - count) / (rho - 1)


def _place(i: int, count: int) -> Any:
    return (arb(2 * i + 1) / (2 * count)).cos_pi()


def column(
    matrices: Callable[[int], tuple[Any, Any]], over: Rectangle, nodes: tuple[int, int], i: int
) -> list[list[Packed]]:
    """P's coefficients at the i-th s and every gamma: packed, for they may come from afar."""
    first, second = nodes

    def polynomial(j: int) -> list[Any]:
        def compute() -> list[Any]:
            F, G = matrices(ctx.prec)
            k = (number(over.s) + number(over.half_s) * _place(i, first)) ** 2
            gamma = number(over.gamma) + number(over.half_gamma) * _place(j, second)
            block = square(Problem(F * k, ((1, G * (gamma * k)),), None))
            return list(reversed(block.charpoly().coeffs()))[1:]

        return narrowed(compute, KNOWN, begin=NODE_BITS)

    return [[_packed(p) for p in polynomial(j)] for j in range(second)]


def _packed(ball: Any) -> Packed:
    (m, e), (r, f) = ball.mid().man_exp(), ball.rad().man_exp()
    return int(m), int(e), int(r), int(f)


def _unpacked(four: Packed) -> Any:
    m, e, r, f = four
    return arb(fmpz(m)) * arb(2) ** e + arb(0, (arb(fmpz(r)) * arb(2) ** f).upper())


class Surface:
    """The polynomials of a rectangle."""

    def __init__(
        self,
        over: Rectangle,
        bound: Bound,
        nodes: tuple[int, int],
        remainder: Any,
        values: list[list[list[Packed]]],
    ) -> None:
        self.over, self.bound, self.remainder = over, bound, remainder
        first, second = nodes
        into_x, into_y = _to_series(first), _to_series(second).transpose()
        self.series = [
            into_x
            * arb_mat([[_unpacked(values[i][j][c]) for j in range(second)] for i in range(first)])
            * into_y
            for c in range(bound.n)
        ]

    def cuts(self) -> tuple[int, int]:
        """Patches along s and gamma."""
        over, bound = self.over, self.bound
        most = float(over.s + over.half_s)
        swing = 2.0 * np.pi * bound.swing * float(over.half_s)
        pulse = 2.0 * most * bound.pulsating * float(over.half_gamma)
        return ceil(swing / PHASE), ceil(pulse / PHASE)

    def patches(self) -> Iterator[Patch]:
        """All of them."""
        across, up = self.cuts()
        for i in range(across):
            x = (Fraction(2 * i, across) - 1, Fraction(2 * i + 2, across) - 1)
            strips, lost = zip(*(_cut(_restricted(x, W.nrows()) * W) for W in self.series),
                               strict=True)  # fmt: skip
            for j in range(up):
                y = (Fraction(2 * j, up) - 1, Fraction(2 * j + 2, up) - 1)
                parts = [
                    _cut((W * _restricted(y, W.ncols()).transpose()).transpose()) for W in strips
                ]
                made = [_to_floats(W.transpose()) for W, _ in parts]
                rest = [
                    float((self.remainder + before + after + rounding).upper())
                    for before, (_, after), (_, rounding) in zip(lost, parts, made, strict=True)
                ]
                # to the next float: python-flint rounds to the nearest one
                yield Patch(x, y, np.array([p for p, _ in made]), np.nextafter(rest, np.inf))


def _to_series(count: int) -> Any:
    """From values at Chebyshev's points to coefficients of his polynomials."""
    return arb_mat(
        [
            [
                (arb(k * (2 * i + 1)) / (2 * count)).cos_pi() * (1 if k == 0 else 2) / count
                for i in range(count)
            ]
            for k in range(count)
        ]
    )


@lru_cache(maxsize=256)
def _restricted(part: tuple[Fraction, Fraction], count: int) -> Any:
    """From Chebyshev's polynomials on [-1, 1] to those of a part."""
    middle, half = number(sum(part) / 2), number((part[1] - part[0]) / 2)
    places = [middle + half * _place(i, count) for i in range(count)]
    return _to_series(count) * arb_mat([[x.chebyshev_t(k) for k in range(count)] for x in places])


def _cut(series: Any) -> tuple[Any, Any]:
    """The first rows, and a bound on what the others can add."""
    rows = series.tolist()
    beyond = (abs(x) for row in rows[TERMS:] for x in row)
    return arb_mat(rows[:TERMS]), reduce(add, beyond, arb(0))


def _to_floats(series: Any) -> tuple[Float, Any]:
    """Coefficients of powers, and what rounding them leaves out."""
    a, b = _powers(series.nrows()), _powers(series.ncols())
    rows = (a * series * b.transpose()).tolist()
    floats = np.array([[float(x) for x in row] for row in rows])
    off = (abs(x - arb(y)) for row, own in zip(rows, floats.tolist(), strict=True)
           for x, y in zip(row, own, strict=True))  # fmt: skip
    return floats, reduce(add, off)


@lru_cache(maxsize=8)
def _powers(count: int) -> Any:
    """From Chebyshev's polynomials to powers: whole numbers."""
    rows = np.zeros((count, count))
    for k in range(count):
        rows[: k + 1, k] = chebyshev.cheb2poly([0.0] * k + [1.0])
    return arb_mat(rows.tolist())
