"""The monodromy matrix of a general periodic equation in ball arithmetic, by plain Taylor steps.

Of the first-order system over Omega in theta = Omega tau, from the floats' exact values on. On the
disc |t| <= R about a step's start a solution grows at most by exp(R sum |A_k| cosh k R), so by
Cauchy the terms beyond the order N sum to less than that times (h/R)^(N + 1)/(1 - h/R).
"""

from collections.abc import Sequence
from math import ceil, cosh, log, pi
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

MAX_BITS = 4096

Key = tuple[int, bool]


class TooMuch(ValueError):
    """More work than a test is worth."""


def reference(equation: Any, work: float = 2e6) -> tuple[list[arb], list[list[arb]]]:
    """P(mu), monic, highest power first, and Phi of (q, q') or x: both to 30 digits.

    `work` limits what it may take; 2e6 is about a second.
    """
    bits = 192
    while bits <= MAX_BITS:
        with ctx.workprec(bits):
            Phi = _monodromy(equation, work)
            p = list(reversed(Phi.charpoly().coeffs()))
            size = max(float(abs(x).mid()) for x in p)
            if np.isfinite(size) and max(float(x.rad()) for x in p) < 1e-30 * size:
                return p, _given_units(equation, Phi)
        bits *= 2
    raise TooMuch("bits")


def _given_units(equation: Any, Phi: arb_mat) -> list[list[arb]]:
    """Of (q, q') from that of (q, dq/dtheta)."""
    m, Omega = Phi.nrows(), arb(float(equation.Omega))
    units = [Omega if equation.A is None and i >= m // 2 else arb(1) for i in range(m)]
    rows = enumerate(Phi.tolist())
    return [[x * units[i] / units[j] for j, x in enumerate(row)] for i, row in rows]


def off(found: Any, true: Sequence[arb]) -> Any:
    """Upper bounds on |found - true|."""
    with ctx.workprec(600):
        pairs = zip(np.asarray(found).ravel(), true, strict=True)
        return np.array([float(abs(arb(float(x)) - t).upper()) for x, t in pairs])


def _exact(matrix: Any) -> arb_mat:
    return arb_mat(*np.shape(matrix), [arb(float(x)) for x in np.ravel(matrix)])


def _series(matrix: Any) -> dict[Key, arb_mat]:
    found = {(0, False): _exact(matrix.mean)}
    for is_sine, given in ((False, matrix.cos), (True, matrix.sin)):
        found |= {(k, is_sine): _exact(part) for k, part in given.items()}
    return found


def _first_order(equation: Any) -> dict[Key, arb_mat]:
    Omega = arb(float(equation.Omega))
    if equation.A is not None:
        return {key: part / Omega for key, part in _series(equation.A).items()}
    n, M = equation.K.n, _exact(equation.M)
    K, C = _series(equation.K), _series(equation.C)
    nothing = _exact(np.zeros((n, n)))
    found = {}
    for key in {*K, *C}:
        stiffness = M.solve(K.get(key, nothing)) / (Omega * Omega)
        damping = M.solve(C.get(key, nothing)) / Omega
        top = np.hstack([np.zeros((n, n)), np.eye(n) * (key[0] == 0)])
        rows = [a + b for a, b in zip((-stiffness).tolist(), (-damping).tolist(), strict=True)]
        found[key] = arb_mat(_exact(top).tolist() + rows)
    return found


def _monodromy(equation: Any, work: float) -> arb_mat:
    A = _first_order(equation)
    m = A[0, False].nrows()
    sizes = {k: max(sum(float(abs(x).upper()) for x in row) for row in part.tolist()) * 1.0001
             for k, part in A.items()}  # fmt: skip
    wanted, plans = 0.8 * ctx.prec * log(2.0), []
    for R in np.geomspace(1e-3, 50.0, 200):
        rate = sum(size * cosh(min(k * R, 300.0)) for (k, _), size in sizes.items())
        for order in (ctx.prec // 6, ctx.prec // 4, ctx.prec // 3):
            exponent = (wanted + R * rate) / (order + 1)
            if exponent < 60.0:
                steps = ceil(2.0 * pi / (R * min(0.5, np.exp(-exponent))))
                cost = steps * order * m * m * (m + 0.5 * order * len(A))
                plans.append((cost, steps, order, float(R)))
    cost, steps, order, R = min(plans)
    if cost > work:
        raise TooMuch(f"{cost:.0e}")
    h, radius = 2 * arb.pi() / steps, arb(R)
    rate = sum((arb(size) * (k * radius).cosh() for (k, _), size in sizes.items()), arb(0))
    rest = (radius * rate).exp() * (h / radius) ** (order + 1) / (1 - h / radius)
    unsure = arb_mat(m, m, [arb(0, rest.upper())] * (m * m))
    Phi = one = _exact(np.eye(m))
    for step in range(steps):
        mean, pulses = (
            A[0, False] * h,
            [
                (part * h, _wave(h * k, step, order, is_sine))
                for (k, is_sine), part in A.items()
                if k
            ],
        )
        terms = [one]
        for j in range(order):
            total = mean * terms[j]
            for part, wave in pulses:
                total = total + part * _sum([terms[j - i] * wave[i] for i in range(j + 1)])
            terms.append(total / (j + 1))
        Phi = (_sum(terms) + unsure) * Phi
    return Phi


def _sum(parts: list[arb_mat]) -> arb_mat:
    total = parts[-1]
    for part in reversed(parts[:-1]):
        total = total + part
    return total


def _wave(turn: arb, step: int, order: int, is_sine: bool) -> list[arb]:
    """Coefficients of cos or sin of turn (step + x) in powers of x."""
    s, c = (turn * step).sin_cos()
    cycle, factor, found = ([s, c, -s, -c] if is_sine else [c, -s, -c, s]), arb(1), []
    for i in range(order):
        found.append(cycle[i % 4] * factor)
        factor = factor * turn / (i + 1)
    return found
