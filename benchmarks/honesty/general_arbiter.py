"""The arbiter of general periodic equations: the multipliers' polynomial in ball arithmetic.

x' = A(tau) x by Taylor steps over the whole period, every number a ball from the floats' exact
values on. What a step leaves out is bounded by Cauchy's estimate: on the disc |tau - tau_k| <= R
the solution is at most exp(R max |A|), and max |A| there at most the sum of the coefficients'
norms times cosh(k Omega R); so nothing has to be believed but the radius at the end. No code of the
two routes is used: an equation is read as data.
"""

from collections.abc import Callable
from functools import reduce
from math import ceil, inf, log, log1p
from operator import add
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

from benchmarks.honesty.arbiter import NARROW, narrowed
from benchmarks.honesty.balls import exact, identity, norm
from benchmarks.honesty.series import TooWide

REACH = 3.0
"""Length of a step times the largest norm of A on it."""

MOST_STEPS = 4000

# Of the bits in the work what a step leaves out takes this share; rounding takes the rest.
LEFT_OUT = 0.75


def reference(equation: Any, narrow: int = NARROW) -> list[Any]:
    """Det(mu I - Phi), monic, highest power first.

    Parameters
    ----------
    equation : PeriodicEquation
    narrow : int, optional
        Bits to which the coefficients are known, of the largest.

    Raises
    ------
    TooWide
        The equation is beyond the arbiter.
    """

    def polynomial() -> list[Any]:
        return list(reversed(monodromy(equation, int(LEFT_OUT * ctx.prec)).charpoly().coeffs()))

    return narrowed(polynomial, narrow)


def monodromy(equation: Any, bits: int) -> Any:
    """Phi of x, or of (q, q'); `bits` says how little a step may leave out."""
    mean, terms = _first_order(equation)
    Omega = arb(float(equation.Omega))
    norms = [(k, norm(a) + norm(b)) for k, a, b in terms]

    def largest(R: float) -> float:
        """Of |A| on a disc of radius R about a real point."""
        frequency = float(equation.Omega)
        with np.errstate(over="ignore"):
            return norm(mean) + sum(x * float(np.cosh(k * frequency * R)) for k, x in norms)

    period = 2.0 * np.pi / equation.Omega
    steps = ceil(period * largest(0.0) / REACH) + ceil(2.0 * max([k for k, _ in norms], default=0))
    if steps > MOST_STEPS:
        raise TooWide(f"takes {steps} Taylor steps")
    order, left = _order(largest, period / steps * 1.0001, bits)
    h = 2 * arb.pi() / (Omega * steps)
    size = mean.nrows()
    unsure = arb_mat(size, size, [arb(0, left)] * size**2)
    Phi = identity(size)
    for step in range(steps):
        A = _series(mean, terms, Omega * h, step, h, order)
        x = [identity(size)]
        for j in range(order):
            x.append(_sum([A[i] * x[j - i] for i in range(j + 1)]) * (arb(1) / (j + 1)))
        Phi = (_sum(x) + unsure) * Phi
    return Phi


def _first_order(equation: Any) -> tuple[Any, list[tuple[int, Any, Any]]]:
    """A_0, and each (k, A_k, B_k)."""
    if equation.A is not None:
        A = equation.A
        zero = np.zeros_like(A.mean)
        return exact(A.mean), [
            (k, exact(A.cos.get(k, zero)), exact(A.sin.get(k, zero))) for k in A.harmonics
        ]
    K, C, n = equation.K, equation.C, equation.K.n
    M, zero = exact(equation.M), np.zeros((n, n))

    def below(k: Any, c: Any, corner: Any) -> Any:
        left, right = (M.solve(exact(part)) * arb(-1) for part in (k, c))
        upper = np.hstack([zero, corner])
        rows = [list(a) + list(b) for a, b in zip(left.tolist(), right.tolist(), strict=True)]
        return arb_mat(exact(upper).tolist() + rows)

    return below(K.mean, C.mean, np.eye(n)), [
        (
            k,
            below(K.cos.get(k, zero), C.cos.get(k, zero), zero),
            below(K.sin.get(k, zero), C.sin.get(k, zero), zero),
        )
        for k in sorted({*K.harmonics, *C.harmonics})
    ]


def _series(mean: Any, terms: Any, angle: Any, step: int, h: Any, order: int) -> list[Any]:
    """Coefficients of h A in powers of the step's share."""
    A = [mean * h] + [mean * 0] * (order - 1)
    for k, cosine, sine in terms:
        s, c = (angle * (k * step)).sin_cos()
        factor = h
        for i in range(order):
            # derivatives of cos: c, -s, -c, s; of sin: s, c, -s, -c
            of_cos, of_sin = ((c, s), (-s, c), (-c, -s), (s, -c))[i % 4]
            A[i] = A[i] + cosine * (of_cos * factor) + sine * (of_sin * factor)
            factor = factor * (angle * k) / (i + 1)
    return A


def _order(largest: Callable[[float], float], h: float, bits: int) -> tuple[int, float]:
    """Terms to keep, and a bound on what the rest of a step adds to an element."""
    radii = [h * 1.25**i for i in range(1, 60)]
    growth = [R * largest(R) for R in radii]
    order = 8
    while order < 2000:
        logs = [
            g + (order + 1) * log(h / R) - log1p(-h / R) if g < 1e6 else inf
            for R, g in zip(radii, growth, strict=True)
        ]
        if min(logs) < -bits * log(2.0):
            return order, 1.001 * float(np.exp(max(min(logs), -700.0)))
        order += 4
    raise TooWide("a Taylor step takes more than 2000 terms")


def _sum(parts: list[Any]) -> Any:
    return reduce(add, parts)
