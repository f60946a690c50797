"""Every Omega of an interval at once: P's coefficients as polynomials, with a bounded remainder.

With theta = Omega tau the equation depends on k = 1/Omega^2 only, through the product of k and the
stiffness, and P's coefficients are entire functions of k. In the norm max(|u_i|, |u_i'|/r) the
solution grows at most by exp(2 pi sqrt(|k| S)), S the norm of the stiffness, so that the j-th
coefficient is at most C(n, j) exp(2 pi j sqrt(|k| S)) for complex k. On Bernstein's ellipse of the
interval that bounds what the polynomial through Chebyshev's points leaves out (Trefethen,
Approximation Theory and Approximation Practice, theorem 8.2). On parts of the interval, halved
until they are decided, the polynomial is enclosed about their middles.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import partial, reduce
from itertools import groupby, pairwise
from math import acosh, ceil, comb, log, pi, sqrt
from operator import add, mul
from typing import Any

import numpy as np
from flint import acb, arb, arb_poly, ctx
from scipy.linalg import matrix_balance

from floquet.arrays import frozen
from floquet.enclosure import beams
from floquet.enclosure.balls import Problem, exact, norm, number
from floquet.enclosure.judgement import is_real, log_R
from floquet.enclosure.narrow import narrowed, square
from floquet.enclosure.result import IntervalProof
from hill import SteppedBeam, UniformBeam
from hill.decimals import ExactBeam, ExactForcing, Number, exact_beam, fraction

BITS = 320
"""In the work: 2 x 50 for Chebyshev's polynomials of degree 100 in powers, and then some."""

LEFT_OUT = 70
"""Bits: the remainder is 2**-70, or 8e-22."""

HALVINGS = 40
"""A part of 2**-40 of the interval that is not decided is left so."""

# Radii of the ellipse over the interval's half width that are tried.
RADII = frozen(np.geomspace(2.0, 1e7, 300))


def prove(
    beam: UniformBeam | SteppedBeam,
    Omega: tuple[Number, Number],
    gamma: Number,
    eta: Number,
    initial_terms: int,
    ratio: int | None,
) -> IntervalProof:
    """As `floquet.enclosure.enclose_interval`."""
    low, high = (fraction("Omega", x) for x in Omega)
    if not 0 < low < high:
        raise ValueError(f"Omega = {Omega}: must be two numbers, 0 < low < high")
    given, under = exact_beam(beam, high, gamma, eta, initial_terms, ratio)
    if given.sigma and ratio is None:
        raise ValueError(
            f"omega_L = {beam.omega_L:g}: F and G move with Omega; give the ratio omega_L/Omega, "
            "or leave omega_L infinite"
        )
    with ctx.workprec(BITS):
        series = Series(given, under, low, high)
        damped = under.eta != 0
        parts = _parts(series, number(under.eta) if damped else None)
    ends = [(series.Omega(b), series.Omega(a), kind) for a, b, kind in reversed(parts)]
    return IntervalProof(
        Omega=(float(low), float(high)),
        parts=merged(ends),
        nodes=series.nodes,
        remainder=float(series.remainder.upper()),
    )


class Series:
    """P's coefficients on [low, high] as polynomials of x in [-1, 1], k = middle + half x."""

    def __init__(self, beam: ExactBeam, under: ExactForcing, low: Fraction, high: Fraction) -> None:
        least, most = 1 / high**2, 1 / low**2
        self.middle, self.half = (least + most) / 2, (most - least) / 2

        def at(k: Any) -> Problem:
            F, G, H = beams.matrices(beam, ctx.prec)
            return beams.forced(F, G, H, beam.gamma, under, k)

        unit = at(arb(1))
        self.n = unit.n
        self.nodes, self.remainder = _remainder(
            norm_in_units(unit), self.n, float(self.middle), float(self.half)
        )
        self.coefficients = self._interpolated(at)

    def Omega(self, x: float) -> float:
        """Of a place."""
        return float(self.middle + self.half * Fraction(x)) ** -0.5

    def k(self, x: Any) -> Any:
        """1/Omega^2 of a place, which may be a ball."""
        return number(self.middle) + number(self.half) * x

    def _interpolated(self, at: Callable[[Any], Problem]) -> list[Any]:
        count = self.nodes

        def equation(i: int) -> Problem:
            return at(self.k((arb(2 * i + 1) / (2 * count)).cos_pi()))

        values = [polynomial_of(partial(equation, i)) for i in range(count)]
        # the sum over k of (2/N) sum_i f(x_i) T_k(x_i) T_k(x), half of it for k = 0
        chebyshev = [arb_poly([1]), arb_poly([0, 1])]
        while len(chebyshev) < count:
            chebyshev.append(arb_poly([0, 2]) * chebyshev[-1] - chebyshev[-2])
        found = []
        for j in range(self.n + 1):
            total = arb_poly([0])
            for k in range(count):
                a = reduce(
                    add,
                    (
                        values[i][j] * (arb(k * (2 * i + 1)) / (2 * count)).cos_pi()
                        for i in range(count)
                    ),
                )
                total += chebyshev[k] * (a * (1 if k == 0 else 2) / count)
            found.append(total)
        return found

    def near(self, a: float, b: float) -> list[Any]:
        """The coefficients as polynomials of y in [-1, 1] on a part."""
        return [p(arb_poly([(a + b) / 2, (b - a) / 2])) for p in self.coefficients]


def polynomial_of(make: Callable[[], Problem]) -> list[Any]:
    """P's balls, monic, highest power first."""
    return narrowed(lambda: list(reversed(square(make()).charpoly().coeffs())), LEFT_OUT + 30)


def norm_in_units(given: Problem, of: Problem | None = None) -> float:
    """Norm of all of it, in units in which `of`, or it itself, is small."""
    whole = given if of is None else of
    every = [whole.K, *(M for _, M in whole.pulses)]
    sizes = sum(
        np.array([[float(x.abs_upper()) for x in row] for row in M.tolist()]) for M in every
    )
    _, (scale, _) = matrix_balance(sizes, permute=False, separate=True)
    there, back = exact(np.diag(1.0 / scale)), exact(np.diag(scale))
    own = [given.K, *(M for _, M in given.pulses)]
    return float(sum(norm(there * M * back) for M in own))


def _remainder(S: float, n: int, middle: float, half: float) -> tuple[int, Any]:
    """How many nodes, and what the polynomial through them leaves out."""

    def size(a: float) -> float:
        """Logarithm of a bound on the coefficients where |x| <= a."""
        growth = 2.0 * pi * sqrt((middle + half * a) * S)
        return float(n * growth + log(comb(n, n // 2)))

    wanted = LEFT_OUT * log(2.0)
    # the ellipse with the half-axis a has rho = a + sqrt(a^2 - 1)
    count, a = min((ceil((wanted + size(a) + 3.0) / acosh(a)) + 2, a) for a in map(float, RADII))
    rho = arb(a) + (arb(a) ** 2 - 1).sqrt()
    M = arb(size(a) * (1.0 + 1e-9)).exp()
    return count, 4 * M * rho ** (1 - count) / (rho - 1)


def _parts(series: Series, eta: Any) -> list[tuple[float, float, str]]:
    """Parts of [-1, 1], ascending, halved until they are decided."""
    found, ahead = [], [(-1.0, 1.0)]
    while ahead:
        a, b = ahead.pop()
        kind = _verdict(series, a, b, eta)
        if kind == "undecided" and b - a > 2.0 ** (1 - HALVINGS):
            middle = (a + b) / 2
            ahead += [(middle, b), (a, middle)]
        else:
            found.append((a, b, kind))
    return found


def _verdict(series: Series, a: float, b: float, eta: Any) -> str:
    """Of all of a part, by signs, and by Smith's discs about the roots of its middle."""
    n, local = series.n, series.near(a, b)
    off = series.remainder

    def value(z: Any) -> Any:
        """P(z) for all of the part."""
        powers = [z ** (n - j) for j in range(n + 1)]
        real = reduce(add, (p * w.real for p, w in zip(local, powers, strict=True)))
        imag = reduce(add, (p * w.imag for p, w in zip(local, powers, strict=True)))
        left = off * reduce(add, (abs(w) for w in powers))
        return acb(_range(real, left), _range(imag, left))

    decay = arb(0)
    if eta is not None:
        # of all Omega = k^(-1/2) of the part
        decay = arb.pi() * eta * series.k(arb((a + b) / 2, (b - a) / 2)).sqrt()
    return decided(value, [float(p[0]) for p in local], decay)


def decided(value: Callable[[Any], Any], middle: list[float], decay: Any) -> str:
    """Stable, unstable or undecided, from balls that hold P(z) for all of a part.

    Parameters
    ----------
    value : callable
        z to that ball.
    middle : list of float
        P's coefficients at some place of the part, as far as floats tell.
    decay : arb
        pi eta/Omega for all of it.
    """
    with np.errstate(all="ignore"):
        v = sorted(np.roots(middle), key=lambda z: -z.real)
    edge = decay.cosh() if decay > 0 else arb(1)
    between = [arb(float(x.real + y.real) / 2) for x, y in pairwise(v)]
    points = [edge, *between, -edge]
    signs = [value(acb(x)).real * (-1) ** k for k, x in enumerate(points)]
    ordered = all(x > y for x, y in pairwise(points))
    if signs[0] < 0 or signs[-1] < 0:
        return "unstable"
    if ordered and all(s > 0 for s in signs) and not decay < 0:
        return "stable"
    return _by_discs([acb(complex(z)) for z in v], value, decay)


def _by_discs(v: list[Any], value: Callable[[Any], Any], decay: Any) -> str:
    """Each connected set of the discs |z - v_i| <= n |P(v_i)/prod (v_i - v_j)| has its roots."""
    n, discs = len(v), []
    for i, z in enumerate(v):
        gaps = reduce(mul, (z - w for j, w in enumerate(v) if j != i), acb(1))
        radius = abs(n * value(z) / gaps).upper()
        if not radius.is_finite():
            return "undecided"
        ball = arb(0, radius)
        discs.append(z + acb(ball, ball))
    apart = [not any(z.overlaps(w) for j, w in enumerate(discs) if j != i)
             for i, z in enumerate(discs)]  # fmt: skip
    growth = [log_R(z, alone and is_real(z, discs)) for z, alone in zip(discs, apart, strict=True)]
    # an isolated disc has a root of its own
    if any(alone and bool(g > decay) for g, alone in zip(growth, apart, strict=True)):
        return "unstable"
    if all(bool(g < decay) for g in growth):
        return "stable"
    return "undecided"


def _range(p: Any, left: Any) -> Any:
    """Of a polynomial on [-1, 1], and what was left out."""
    coefficients = p.coeffs()
    if not coefficients:
        return arb(0, left.upper())
    total = reduce(add, (abs(c) for c in coefficients[1:]), arb(0)) + left
    return coefficients[0] + arb(0, total.upper())


def merged(parts: list[tuple[float, float, str]]) -> tuple[tuple[float, float, str], ...]:
    """Neighbours of one kind as one."""
    found = []
    for kind, group in groupby(parts, key=lambda part: part[2]):
        same = list(group)
        found.append((same[0][0], same[-1][1], kind))
    return tuple(found)
