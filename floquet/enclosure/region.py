"""A rectangle of Omega and gamma, strip by strip in gamma, every Omega of it at once.

P's coefficients are entire functions of k = 1/Omega^2 and of gamma. On a block of Omega they are
polynomials of both through Chebyshev's points, with the remainder of `interval` in each variable;
interpolation in the first multiplies that of the second by Lebesgue's constant at most, which is
below 1 + (2/pi) ln N. Within a strip they are expanded about its middle, and parts of it in Omega
are halved until they are decided.
"""

from fractions import Fraction
from functools import partial, reduce
from math import acosh, ceil, comb, log, pi, sqrt
from operator import add
from typing import Any

from flint import acb, arb, arb_mat, arb_poly, ctx

from floquet.enclosure import beams
from floquet.enclosure.balls import Problem, number
from floquet.enclosure.interval import (
    BITS,
    RADII,
    decided,
    merged,
    norm_in_units,
    polynomial_of,
)
from floquet.enclosure.result import RegionProof
from hill import SteppedBeam, UniformBeam
from hill.decimals import Number, exact_beam, fraction

LEFT_OUT = 40
"""Bits: each remainder is 2**-40, or 9e-13."""

BITS_OF_STRIPS = 192
"""For polynomials of degree 70 about other middles."""

WIDEST = Fraction(7, 5)
"""Largest over least Omega of a block."""


def prove(
    beam: UniformBeam | SteppedBeam,
    Omega: tuple[Number, Number],
    gamma: tuple[Number, Number],
    strips: int,
    halvings: int,
) -> RegionProof:
    """As `floquet.enclosure.enclose_region`."""
    (low, high), (least, most) = (
        (fraction(name, a), fraction(name, b))
        for name, (a, b) in (("Omega", Omega), ("gamma", gamma))
    )
    if not (0 < low < high and least < most):
        raise ValueError(
            f"Omega = {Omega}, gamma = {gamma}: must be two numbers each, ascending, Omega > 0"
        )
    found: list[list[tuple[float, float, str]]] = [[] for _ in range(strips)]
    while low < high:
        end = min(high, low * WIDEST)
        with ctx.workprec(BITS):
            block = Block(beam, low, end, least, most)
        with ctx.workprec(BITS_OF_STRIPS):
            for i in range(strips):
                found[i] += block.parts(i, strips, halvings)
        low = end
    edges = [float(least + (most - least) * Fraction(i, strips)) for i in range(strips + 1)]
    return RegionProof(
        Omega=(float(fraction("Omega", Omega[0])), float(high)),
        gamma=(float(least), float(most)),
        strips=tuple(
            (a, b, merged(parts)) for a, b, parts in zip(edges, edges[1:], found, strict=False)
        ),
    )


class Block:
    """P's coefficients on a block as polynomials of x and y in [-1, 1]."""

    def __init__(
        self, beam: Any, low: Fraction, high: Fraction, least: Fraction, most: Fraction
    ) -> None:
        given, _ = exact_beam(beam, high, most)
        if given.sigma:
            raise ValueError(f"omega_L = {beam.omega_L:g}: must be infinite, or G moves with Omega")
        self.middle, self.half = (1 / low**2 + 1 / high**2) / 2, (1 / low**2 - 1 / high**2) / 2
        centre, reach = (least + most) / 2, (most - least) / 2

        def at(k: Any, gamma: Any) -> Problem:
            F, G, _ = beams.matrices(given, ctx.prec)
            return Problem(F * k, ((1, G * (gamma * k)),), None)

        one = at(arb(1), arb(1))
        self.n = one.n
        nothing = one.K * 0
        steady = norm_in_units(Problem(one.K, ((1, nothing),), None), one)
        pulsating = norm_in_units(Problem(nothing, one.pulses, None), one)

        def size(a: float, b: float) -> float:
            """Logarithm of a bound on the coefficients where |x| <= a and |y| <= b."""
            k = float(self.middle) + float(self.half) * a
            S = k * (steady + (abs(float(centre)) + float(reach) * b) * pulsating)
            return self.n * 2.0 * pi * sqrt(S) + log(comb(self.n, self.n // 2))

        first, left = _count(lambda a: size(a, 1.0))
        second, other = _count(lambda b: size(1.0, b))
        self.nodes = first, second
        self.remainder = left + other * (1 + 2 * arb(first).log() / arb.pi())

        def place(i: int, count: int) -> Any:
            return (arb(2 * i + 1) / (2 * count)).cos_pi()

        def equation(i: int, j: int) -> Problem:
            k = number(self.middle) + number(self.half) * place(i, first)
            return at(k, number(centre) + number(reach) * place(j, second))

        values = [
            [polynomial_of(partial(equation, i, j)) for j in range(second)] for i in range(first)
        ]
        in_x, in_y = _to_powers(first), _to_powers(second).transpose()
        self.powers = [
            in_x * arb_mat([[values[i][j][c] for j in range(second)] for i in range(first)]) * in_y
            for c in range(self.n + 1)
        ]

    def parts(self, i: int, strips: int, halvings: int) -> list[tuple[float, float, str]]:
        """Of a strip, ascending in Omega."""
        shift = arb_poly([arb(2 * i + 1) / strips - 1, arb(1) / strips])
        count = self.nodes[1]
        rows, power = [], arb_poly([1])
        for _ in range(count):
            rows.append((power.coeffs() + [arb(0)] * count)[:count])
            power = power * shift
        moved = [(W * arb_mat(rows)).tolist() for W in self.powers]
        local = [[arb_poly([row[d] for row in W]) for d in range(3)] for W in moved]
        beyond = (reduce(add, (abs(x) for row in W for x in row[3:]), arb(0)) for W in moved)
        off = self.remainder + reduce(lambda a, b: a.max(b), beyond)
        found, ahead = [], [(-1.0, 1.0)]
        while ahead:
            a, b = ahead.pop()
            kind = self._verdict(local, off, a, b)
            if kind == "undecided" and b - a > 2.0 ** (1 - halvings):
                ahead += [((a + b) / 2, b), (a, (a + b) / 2)]
            else:
                found.append((self._Omega(b), self._Omega(a), kind))
        return found[::-1]

    def _Omega(self, x: float) -> float:
        return float(self.middle + self.half * Fraction(x)) ** -0.5

    def _verdict(self, local: Any, off: Any, a: float, b: float) -> str:
        part = arb_poly([(a + b) / 2, (b - a) / 2])
        near = [[p(part) for p in three] for three in local]
        n = self.n

        def value(z: Any) -> Any:
            powers = [z ** (n - j) for j in range(n + 1)]
            left = off * reduce(add, (abs(w) for w in powers))
            return acb(
                _range(near, [w.real for w in powers], left),
                _range(near, [w.imag for w in powers], left),
            )

        return decided(value, [float(three[0][0]) for three in near], arb(0))


def _range(near: Any, weights: list[Any], left: Any) -> Any:
    """Of a sum of polynomials in Omega's and gamma's places, and what was left out."""
    steady, *moving = (
        reduce(add, (three[d] * w for three, w in zip(near, weights, strict=True))).coeffs()
        for d in range(3)
    )
    middle, *rest = steady or [arb(0)]
    total = reduce(add, (abs(c) for part in (rest, *moving) for c in part), left)
    return middle + arb(0, total.upper())


def _count(size: Any) -> tuple[int, Any]:
    """How many nodes, and a bound on what the polynomial through them leaves out."""
    wanted = LEFT_OUT * log(2.0)
    count, a = min((ceil((wanted + size(a) + 3.0) / acosh(a)) + 2, a) for a in map(float, RADII))
    rho = arb(a) + (arb(a) ** 2 - 1).sqrt()
    return count, 4 * arb(size(a) * (1.0 + 1e-9)).exp() * rho ** (1 - count) / (rho - 1)


def _to_powers(count: int) -> Any:
    """From values at Chebyshev's points to coefficients of powers."""
    chebyshev = [arb_poly([1]), arb_poly([0, 1])]
    while len(chebyshev) < count:
        chebyshev.append(arb_poly([0, 2]) * chebyshev[-1] - chebyshev[-2])
    columns = [(p.coeffs() + [arb(0)] * count)[:count] for p in chebyshev[:count]]
    series = [
        [
            (arb(k * (2 * i + 1)) / (2 * count)).cos_pi() * (1 if k == 0 else 2) / count
            for i in range(count)
        ]
        for k in range(count)
    ]
    return arb_mat(columns).transpose() * arb_mat(series)
