"""Power series in s = sin^2(theta/2), in which the undamped equation has polynomial coefficients.

Its solutions even and odd in theta are power series in s whose coefficients follow from the few
before, about s = 0 and, for the middle of the period, about s = 1. They meet at s = 1/2, where both
fall off like 2**-k; what is left out is bounded.
"""

from math import comb
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

from floquet.enclosure.balls import Problem, exact, identity, norm

# A system that takes more terms than this is none that a float can hold.
MAX_TERMS = 20000


class TooWide(ValueError):
    """More bits, terms or steps than the arbiter is ready to spend."""


class Singular(ArithmeticError):
    """A ball holds a singular matrix: it takes more bits."""


def first_block(problem: Problem) -> Any:
    """The block A of the monodromy matrix, whose eigenvalues are z; D must be None."""
    n = problem.n
    near, far = (_quarter(_stiffness(problem, end), n) for end in (1, -1))
    S = exact(np.diag(np.repeat([1.0, -1.0], n)))
    # from 0 and from pi to the quarter period; the second half is the first run backwards
    try:
        Phi = S * near.solve(S * far * S * far.solve(S * near))
    except ZeroDivisionError:
        raise Singular from None
    return arb_mat([row[:n] for row in Phi.tolist()[:n]])


def _stiffness(problem: Problem, end: int) -> list[Any]:
    """Coefficients W_j of s**j of the stiffness.

    `end` is -1 for s counted from the middle of the period, where cos p theta has (-1)**p.
    """
    W = [problem.K]
    for p, M in problem.pulses:
        # cos p x = T_p(1 - 2 s) = sum_j (-4)^j p/(p + j) C(p + j, 2 j) s^j
        for j in range(p + 1):
            number = (-4) ** j * p * comb(p + j, 2 * j) // (p + j)
            part = M * arb(number * end**p)
            if j < len(W):
                W[j] = W[j] + part
            else:
                W.append(part)
    return W


def _quarter(W: list[Any], n: int) -> Any:
    """(u, du/dx) at x = theta = pi/2 from unit (u, du/dx) at x = 0."""
    norms = [norm(M) for M in W]
    even, d_even = _series(W, norms, n, 0)
    odd, d_odd = _series(W, norms, n, 1)
    # odd ones begin with 2 s^(1/2), or x; ds/dx is 1/2 at s = 1/2
    root = arb(2).sqrt()
    odd, d_odd = odd * root, d_odd * root
    rows = [a + b for a, b in zip(even.tolist(), odd.tolist(), strict=True)]
    rows += [a + b for a, b in zip(d_even.tolist(), d_odd.tolist(), strict=True)]
    return arb_mat(rows)


def _series(W: list[Any], norms: list[float], n: int, odd: int) -> tuple[Any, Any]:
    """Sum t_k and sum (k + nu) t_k, t_k = a_k 2**-k, nu = odd/2.

    (k + nu + 1)(k + nu + 1/2) a_(k+1) = (k + nu)^2 a_k - sum_j W_j a_(k-j).
    """
    # where k^2 is above, a term is at most 3/4 of the largest of the few before
    least = 2.0 * sum(size * 0.5**j for j, size in enumerate(norms))
    depth = len(W)
    # t_(k+1) = 2 ((2k + odd)^2 t_k - sum_j 4 W_j 2^-j t_(k-j)) / ((2k + 2 + odd)(2k + 1 + odd)) / 2
    scaled = [M * (arb(4) * arb(2) ** -j) for j, M in enumerate(W)]
    last = [identity(n)]
    total, slope = identity(n), identity(n) * (arb(odd) / 2)
    k = 0
    while True:
        step = last[0] * (2 * k + odd) ** 2
        for M, t in zip(scaled, last, strict=False):
            step = step - M * t
        k += 1
        step = step / (2 * (2 * k + odd) * (2 * k - 1 + odd))
        last = [step, *last[: depth - 1]]
        total = total + step
        slope = slope + step * (arb(2 * k + odd) / 2)
        if k % 16 == 0 and k > 2 * depth and k * k > least:
            m = max(map(norm, last))
            # sum over k beyond of (k + 1/2) t_k, in blocks of `depth`, each 3/4 of the one before
            tail = 8.0 * depth * (k + 4 * depth + 2) * m
            if tail < 2.0 ** -min(ctx.prec, 1000) or not np.isfinite(m):
                break
        if k > MAX_TERMS:
            raise TooWide(f"the series takes more than {MAX_TERMS} terms")
    ball = arb(0, tail)
    unsure = arb_mat(n, n, [ball] * (n * n))
    return total + unsure, slope + unsure
