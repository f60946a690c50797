"""The arbiter of general periodic equations: the multipliers' polynomial in ball arithmetic.

x' = A(theta) x, theta = Omega tau, by Taylor steps over the whole period, every number a ball from
the floats' exact values on. What a step leaves out is bounded by Cauchy's estimate: on the disc
|theta - theta_k| <= R the solution is at most exp(R max |A|), and max |A| there at most the sum of
the coefficients' norms times cosh(k R); so nothing has to be believed but the radius at the end. No
code of the two routes is used: an equation is read as data.
"""

from collections.abc import Callable
from functools import reduce
from math import ceil, cosh, exp, inf, log, log1p, pi
from operator import add
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx
from scipy.linalg import matrix_balance

from floquet.enclosure.balls import exact, identity, norm
from floquet.enclosure.narrow import NARROW, narrowed
from floquet.enclosure.series import TooWide

REACH = 3.0
"""Length of a step times the largest norm of A on it."""

MAX_STEPS = 4000

# exp and cosh of it are floats.
MAX_EXPONENT = 700.0

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
    """Phi of x, or of (q, q'), in other units; `bits` says how little a step may leave out."""
    mean, terms = _balanced(*_first_order(equation))
    norms = [(k, norm(a) + norm(b)) for k, a, b in terms]
    highest = max((k for k, _ in norms), default=0)

    def largest(R: float) -> float:
        """Of |A| on a disc of radius R about a real point."""
        swell = [cosh(min(k * R, MAX_EXPONENT)) for k, _ in norms]
        return norm(mean) + sum(c * x for c, (_, x) in zip(swell, norms, strict=True))

    steps = ceil(2.0 * pi * largest(0.0) / REACH) + 2 * highest
    if steps > MAX_STEPS:
        raise TooWide(f"takes {steps} Taylor steps")
    order, left = _order(largest, 2.0 * pi / steps * 1.0001, bits)
    h = 2 * arb.pi() / steps
    size = mean.nrows()
    unsure = arb_mat(size, size, [arb(0, left)] * size**2)
    Phi = identity(size)
    for step in range(steps):
        A = _series(mean, terms, step, h, order)
        x = [identity(size)]
        for j in range(order):
            x.append(_sum([A[i] * x[j - i] for i in range(j + 1)]) * (arb(1) / (j + 1)))
        Phi = (_sum(x) + unsure) * Phi
    return Phi


def _first_order(equation: Any) -> tuple[Any, list[tuple[int, Any, Any]]]:
    """A_0, and each (k, A_k, B_k), in the time Omega tau."""
    per = 1 / arb(float(equation.Omega))
    if equation.A is not None:
        A, zero = equation.A, np.zeros_like(equation.A.mean)
        return exact(A.mean) * per, [
            (k, exact(A.cos.get(k, zero)) * per, exact(A.sin.get(k, zero)) * per)
            for k in A.harmonics
        ]
    K, C, n = equation.K, equation.C, equation.K.n
    M, zero = exact(equation.M), np.zeros((n, n))

    def below(k: Any, c: Any, corner: Any) -> Any:
        left, right = M.solve(exact(k)) * (-per * per), M.solve(exact(c)) * -per
        rows = [list(a) + list(b) for a, b in zip(left.tolist(), right.tolist(), strict=True)]
        return arb_mat(exact(np.hstack([zero, corner])).tolist() + rows)

    return below(K.mean, C.mean, np.eye(n)), [
        (
            k,
            below(K.cos.get(k, zero), C.cos.get(k, zero), zero),
            below(K.sin.get(k, zero), C.sin.get(k, zero), zero),
        )
        for k in sorted({*K.harmonics, *C.harmonics})
    ]


def _balanced(mean: Any, terms: Any) -> tuple[Any, list[tuple[int, Any, Any]]]:
    """In units, powers of two, that make rows and columns alike in size: no eigenvalue moves."""
    every = [mean, *(x for _, a, b in terms for x in (a, b))]
    sizes = sum(
        np.array([[float(x.abs_upper()) for x in row] for row in M.tolist()]) for M in every
    )
    _, (scale, _) = matrix_balance(sizes, permute=False, separate=True)
    there, back = exact(np.diag(1.0 / scale)), exact(np.diag(scale))
    return there * mean * back, [(k, there * a * back, there * b * back) for k, a, b in terms]


def _series(mean: Any, terms: Any, step: int, h: Any, order: int) -> list[Any]:
    """Coefficients of h A in powers of the step's share."""
    A = [mean * h] + [mean * 0] * (order - 1)
    for k, cosine, sine in terms:
        s, c = (h * (k * step)).sin_cos()
        factor = h
        for i in range(order):
            # derivatives of cos: c, -s, -c, s; of sin: s, c, -s, -c
            of_cos, of_sin = ((c, s), (-s, c), (-c, -s), (s, -c))[i % 4]
            A[i] = A[i] + cosine * (of_cos * factor) + sine * (of_sin * factor)
            factor = factor * (h * k) / (i + 1)
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
            return order, 1.001 * exp(max(min(logs), -MAX_EXPONENT))
        order += 4
    raise TooWide("a Taylor step takes more than 2000 terms")


def _sum(parts: list[Any]) -> Any:
    return reduce(add, parts)
