"""The arbiter: P(z) and T of a Hill equation to more than 40 digits, in ball arithmetic.

Taylor steps of the second-order equation over the whole period, every number a ball of `BITS` bits
from the floats' exact values on. No symmetry is used, and no code of the two routes: `equation` is
read as data. What the truncation of the series adds is seen by taking twice the steps (`refine`).
"""

from collections.abc import Iterable, Sequence
from functools import reduce
from math import ceil, factorial
from operator import add
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx, fmpz, fmpz_poly

# A ball's radius grows like exp(rate * period), up to 1e90 here, where the solution itself does
# not: 180 digits leave twice what is needed.
BITS = 600
# A step of REACH over the fastest rate leaves reach**(order + 1) / (order + 1)! = 4**61 / 61!, or
# 1e-47. The forcing counts more than once: for imaginary time its cosine grows exponentially, and
# the series of the solution falls off later than that of an exponential.
ORDER = 60
REACH = 4.0


def exact(matrix: Any) -> arb_mat:
    """Floats as balls of radius zero."""
    rows = np.atleast_2d(np.asarray(matrix, float))
    return arb_mat(*rows.shape, [arb(float(x)) for x in rows.ravel()])


def identity(n: int) -> arb_mat:
    return exact(np.eye(n))


def reference(equation: Any, refine: int = 1) -> list[arb]:
    """P(z), monic, highest power first; of the multipliers where eta is a matrix."""
    with ctx.workprec(BITS):
        n = len(equation.F)
        if np.ndim(equation.eta) > 0:
            start = identity(2 * n).tolist()
            Q, V = arb_mat(start[:n]), arb_mat(start[n:])
            Q, V = _integrate(equation, exact(equation.F), exact(equation.eta), Q, V, refine)
            square = arb_mat(Q.tolist() + V.tolist())
        else:
            eta = arb(float(equation.eta))
            F = exact(equation.F) - identity(n) * (eta * eta / 4)
            Q, V = identity(n), exact(np.zeros((n, n)))
            square, _ = _integrate(equation, F, None, Q, V, refine)
        return list(reversed(square.charpoly().coeffs()))


def largest_error(polynomial: Sequence[float], truth: Sequence[arb]) -> float:
    """Upper bound on max |p_k - true p_k|."""
    assert len(polynomial) == len(truth)
    with ctx.workprec(BITS):
        pairs = zip(polynomial, truth, strict=True)
        return max(float((arb(float(p)) - t).abs_upper()) for p, t in pairs)


def roots(truth: Sequence[arb]) -> list[complex]:
    """Roots z with their multiplicity, of the midpoints, which are exact dyadic numbers."""
    return [complex(z) for z in _roots(truth)]


def growth(truth: Sequence[arb], Omega: float, eta: float) -> float:
    """T = (Omega/pi) ln max |z +- (z^2 - 1)^(1/2)| - eta."""
    with ctx.workprec(BITS):
        worst = arb(0)
        for z in _roots(truth):
            root = (z - 1).sqrt() * (z + 1).sqrt()
            for mu in (z + root, z - root):
                worst = worst.max(abs(mu).log())
        return float(arb(Omega) / arb.pi() * worst - arb(eta))


def _roots(truth: Sequence[arb]) -> list[Any]:
    with ctx.workprec(BITS):
        parts = [t.mid().man_exp() for t in truth]
        shift = min(int(e) for m, e in parts if m)
        whole = [fmpz(m) * fmpz(2) ** (int(e) - shift) if m else fmpz(0) for m, e in parts]
        found = fmpz_poly(whole[::-1]).complex_roots()
        return [z for z, multiplicity in found for _ in range(multiplicity)]


def _integrate(
    equation: Any, F: arb_mat, C: arb_mat | None, Q: arb_mat, V: arb_mat, refine: int
) -> tuple[arb_mat, arb_mat]:
    """(q, q') after one period of q'' + C q' + F q + sum M_p cos(p Omega t) q = 0."""
    Omega = arb(float(equation.Omega))
    terms = [(1, exact(equation.G) * arb(float(equation.gamma)))]
    for s, H in enumerate(equation.H, start=1):
        terms.append((s * round(equation.omega_L / equation.Omega), exact(H)))
    moduli = np.abs(equation.F) + abs(equation.gamma) * np.abs(equation.G)
    moduli = moduli + sum(np.abs(H) for H in equation.H)
    rate = (
        np.sqrt(np.abs(np.linalg.eigvals(moduli)).max()) + (2 + 1.5 * terms[-1][0]) * equation.Omega
    )
    rate += np.max(np.abs(equation.eta))
    steps = refine * ceil(2 * np.pi * float(rate) / equation.Omega / REACH)

    h = 2 * arb.pi() / (Omega * steps)
    stiffness, pulses = F * (h * h), [(p, M * (h * h)) for p, M in terms]
    for k in range(steps):
        cosines = [(M, _cosine(p * Omega * h, k)) for p, M in pulses]
        a = [Q, V * h]
        for j in range(ORDER - 1):
            total = stiffness * a[j]
            for M, c in cosines:
                total = total + M * _sum(a[j - i] * c[i] for i in range(j + 1))
            if C is not None:
                total = total + C * a[j + 1] * (h * (j + 1))
            a.append(total * arb(-1) / ((j + 1) * (j + 2)))
        Q, V = _sum(a), _sum(a[j] * j for j in range(1, ORDER + 1)) / h
    return Q, V


def _sum(parts: Iterable[Any]) -> Any:
    return reduce(add, parts)


def _cosine(angle: arb, k: int) -> list[arb]:
    """Coefficients of cos(angle (k + x)) in powers of x."""
    s, c = (angle * k).sin_cos()
    turn = [c, -s, -c, s]
    return [turn[i % 4] * angle**i / factorial(i) for i in range(ORDER)]
