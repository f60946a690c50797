"""Roots, T and the verdict from P's balls, by the definitions of `hill.stability`."""

from functools import reduce
from itertools import pairwise
from operator import mul
from typing import Any, Literal

import numpy as np
from flint import acb, arb, ctx

BITS = 512
"""For all that follows from P."""

Verdict = Literal["stable", "unstable", "undecided"]

# Newton's steps on the roots, from floats: each doubles the digits of a simple one.
STEPS = 8


def judged(P: list[Any], Omega: Any, eta: Any) -> tuple[tuple[Any, ...], Any, Verdict]:
    """Balls about the roots, T, and what is proven.

    Stable: P changes its sign n times within (-c, c), c = cosh(pi eta/Omega), with eta >= 0; or T <
    0. Unstable: P(c) < 0 or (-1)^n P(-c) < 0, which leaves a real root beyond; or T > 0.
    """
    with ctx.workprec(BITS):
        roots = _roots(P)
        T = Omega / arb.pi() * _growth(roots) - eta
        inside, beyond = _signs(P, roots, arb.pi() * eta / Omega)
        undamped = bool(eta == 0)
        if inside and undamped:
            return roots, arb(0), "stable"
        if (inside and bool(eta > 0)) or T < 0:
            return roots, T, "stable"
        if beyond or T > 0:
            return roots, T, "unstable"
        return roots, T, "undecided"


def _roots(P: list[Any]) -> tuple[Any, ...]:
    """Smith's discs: of radius n |P(v_i)/prod (v_i - v_j)| about any different v_i."""
    n = len(P) - 1
    with np.errstate(all="ignore"):
        start = np.roots([float(c) for c in P])
    v = [acb(float(z.real), float(z.imag)) for z in start]
    middle = [arb(c.mid()) for c in P]
    for _ in range(STEPS):
        for i in range(n):
            step = _value(middle, v[i]) / _gaps(v, i)
            if step.is_finite():
                moved = v[i] - step
                v[i] = acb(moved.real.mid(), moved.imag.mid())
    found = []
    for i in range(n):
        radius = abs(n * _value(P, v[i]) / _gaps(v, i)).upper()
        if not radius.is_finite():
            # all roots are within 1 + the largest coefficient
            radius = 2 * (1 + reduce(lambda a, b: a.max(b), (abs(c).upper() for c in P)))
        ball = arb(0, radius.upper())
        found.append(v[i] + acb(ball, ball))
    return tuple(found)


def _gaps(v: list[Any], i: int) -> Any:
    return reduce(mul, (v[i] - w for j, w in enumerate(v) if j != i), acb(1))


def _value(P: list[Any], z: Any) -> Any:
    total = acb(0)
    for c in P:
        total = total * z + c
    return total


def _growth(roots: tuple[Any, ...]) -> Any:
    """Ln max R as a ball: each connected set of discs has as many roots as discs."""
    single = [_alone(roots, i) for i in range(len(roots))]
    # P is real: a root's conjugate is a root, and where no other disc can hold it it is the same
    bounds = [
        _log_R(z, real=alone and bool(z.imag.contains(0)))
        for z, alone in zip(roots, single, strict=True)
    ]
    high = reduce(lambda a, b: a.max(b), (high for _, high in bounds))
    low = arb(0)
    for connected in _connected(roots):
        least = reduce(lambda a, b: a.min(b), (bounds[i][0] for i in connected))
        low = low.max(least)
    return low.union(high)


def _alone(roots: tuple[Any, ...], i: int) -> bool:
    """Whether neither a disc nor its conjugate meets any other."""
    z, others = roots[i], (w for j, w in enumerate(roots) if j != i)
    return not any(z.overlaps(w) or z.conjugate().overlaps(w) for w in others)


def _connected(roots: tuple[Any, ...]) -> list[list[int]]:
    left, found = set(range(len(roots))), []
    while left:
        reached, ahead = set(), [left.pop()]
        while ahead:
            i = ahead.pop()
            reached.add(i)
            near = {j for j in left if roots[i].overlaps(roots[j])}
            left -= near
            ahead += near
        found.append(sorted(reached))
    return found


def _log_R(z: Any, *, real: bool) -> tuple[Any, Any]:
    """Bounds of arccosh of the major half-axis of the ellipse through z with foci +-1."""
    axis = abs(z.real) if real else (abs(z - 1) + abs(z + 1)) / 2
    low, high = axis.lower().max(arb(1)), axis.upper().max(arb(1))
    return low.acosh().lower(), high.acosh().upper()


def _signs(P: list[Any], roots: tuple[Any, ...], decay: Any) -> tuple[bool, bool]:
    """Whether signs show all roots to be within the edges, or one to be beyond."""
    n = len(P) - 1
    edge = decay.cosh() if decay > 0 else arb(1)
    x = sorted((z.real.mid() for z in roots), key=float, reverse=True)
    points = [edge, *((arb(a) + arb(b)) / 2 for a, b in pairwise(x)), -edge]
    signs = [_value(P, acb(p)).real for p in points]
    ordered = all(a > b for a, b in pairwise(points))
    inside = ordered and all(
        (value > 0) if k % 2 == 0 else (value < 0) for k, value in enumerate(signs)
    )
    last = signs[-1] if n % 2 == 0 else -signs[-1]
    return bool(inside), bool(signs[0] < 0 or last < 0)
