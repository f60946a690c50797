"""Taylor steps over the whole period, with or without symmetry; what they leave out is bounded.

The coefficients are entire, so the solution is. On the disc |t| <= R about a step's start
|cos p(theta + t)| <= cosh p R, and in the norm max(|u_i|, |u'_i|/rho) the solution grows there at
most by exp(R r), r = max(rho, S/rho + |D|), S the norm of the stiffness on the disc. Cauchy: the
terms of u beyond the order N sum to less than exp(R r) (h/R)^(N + 1)/(1 - h/R), those of u'/rho
beyond N - 1 to (h/R)^N in the place of (h/R)^(N + 1). Any R and any rho will do.

A step's matrix is found by itself and then multiplied on: a ball grows with the moduli of matrices
that hardly grow, not with those of a series.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import reduce
from math import ceil, cosh, exp, factorial, log, pi, sqrt
from operator import add
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

from floquet.arrays import frozen
from floquet.enclosure.balls import Problem, identity, norm
from floquet.enclosure.series import TooWide

MAX_STEPS = 20000

# exp and cosh of it are floats; a disc on which more is needed is not chosen.
MAX_EXPONENT = 300.0

# Of the bits in the work what is left out of a step takes this share; rounding takes the rest.
LEFT_OUT = 0.75

# Orders tried, a digit of the bits each, and radii R of the disc by which they are judged.
ORDERS = (0.15, 0.2, 0.25, 0.3, 0.4, 0.5)
RADII = frozen(np.geomspace(1e-4, 1e3, 400))


@dataclass(frozen=True)
class Plan:
    """How to go: `steps` of order `order`, each judged on a disc of radius `R`, with rho."""

    order: int
    steps: int
    R: float
    rho: float


def monodromy(problem: Problem, refine: int = 1) -> Any:
    """Phi of (u, du/dtheta) over the whole period.

    Parameters
    ----------
    problem : Problem
    refine : int, optional
        Times the steps that would do.

    Raises
    ------
    TooWide
        It takes more than `MAX_STEPS`.
    """
    n, plan = problem.n, _plan(problem, refine)
    h = 2 * arb.pi() / plan.steps
    unsure = _remainder(problem, plan, h)
    Phi = identity(2 * n)
    for k in range(plan.steps):
        Phi = (_step(problem, plan.order, h, k) + unsure) * Phi
    return Phi


def _sizes(problem: Problem) -> tuple[float, list[tuple[int, float]], float]:
    """Norms of K, of each M_p, and of D."""
    D = 0.0 if problem.D is None else norm(problem.D)
    return norm(problem.K), [(p, norm(M)) for p, M in problem.pulses], D


def _plan(problem: Problem, refine: int) -> Plan:
    """The order and the steps with the least work, by floats: `_remainder` judges."""
    K, pulses, D = _sizes(problem)
    wanted = LEFT_OUT * ctx.prec * log(2.0)
    best, least = None, float("inf")
    for R in map(float, RADII):
        if R * max(p for p, _ in pulses) > MAX_EXPONENT:
            break
        swell = [cosh(p * R) for p, _ in pulses]
        S = K + sum(c * M for c, (_, M) in zip(swell, pulses, strict=True))
        rho = sqrt(S) if S > 0.0 else 1.0
        for share in ORDERS:
            order = ceil(share * ctx.prec)
            exponent = (wanted + R * (rho + D)) / order
            if exponent > MAX_EXPONENT:
                continue
            h = R * min(0.5, exp(-exponent))
            work = order**2 * ceil(2.0 * pi / h)
            if work < least:
                least, best = work, Plan(order, refine * ceil(2.0 * pi / h), R, rho)
    if best is None or best.steps > MAX_STEPS:
        raise TooWide(f"takes more than {MAX_STEPS} Taylor steps")
    return best


def _remainder(problem: Problem, plan: Plan, h: Any) -> Any:
    """Balls for what a step's matrix leaves out."""
    K, pulses, D = _sizes(problem)
    R, rho, n = arb(plan.R), arb(plan.rho), problem.n
    S = arb(K) + reduce(add, (arb(M) * (p * R).cosh() for p, M in pulses), arb(0))
    rate = rho.max(S / rho + arb(D))
    share = h / R
    left = (R * rate).exp() / (1 - share) * share**plan.order
    # columns that start from u are 1 in the norm, those from u' 1/rho
    rows = [[left * share, left * share / rho], [left * rho, left]]
    cells = [[arb(0, rows[i >= n][j >= n].upper()) for j in range(2 * n)] for i in range(2 * n)]
    return arb_mat(cells)


def _step(problem: Problem, order: int, h: Any, k: int) -> Any:
    """The matrix of step k, cut off after the order."""
    n = problem.n
    start = identity(2 * n).tolist()
    stiffness = problem.K * (h * h)
    pulses = [(M * (h * h), _cosine(p * h, k, order)) for p, M in problem.pulses]
    a = [arb_mat(start[:n]), arb_mat(start[n:]) * h]
    for j in range(order - 1):
        total = stiffness * a[j]
        for M, c in pulses:
            total = total + M * _sum(a[j - i] * c[i] for i in range(j + 1))
        if problem.D is not None:
            total = total + problem.D * a[j + 1] * (h * (j + 1))
        a.append(total * arb(-1) / ((j + 1) * (j + 2)))
    u, du = _sum(a), _sum(a[j] * j for j in range(1, order + 1)) / h
    return arb_mat(u.tolist() + du.tolist())


def _sum(parts: Iterable[Any]) -> Any:
    return reduce(add, parts)


def _cosine(angle: Any, k: int, order: int) -> list[Any]:
    """Coefficients of cos(angle (k + x)) in powers of x."""
    s, c = (angle * k).sin_cos()
    turn = [c, -s, -c, s]
    return [turn[i % 4] * angle**i / factorial(i) for i in range(order)]
