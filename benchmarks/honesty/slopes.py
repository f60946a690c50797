"""How z and T move with an equation, in balls."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from flint import acb, acb_poly, arb, arb_mat, ctx

from benchmarks.honesty.arbiter import NARROW, narrowed, square
from benchmarks.honesty.balls import moved
from floquet.enclosure import judgement
from floquet.enclosure.balls import identity


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives in one direction.

    Attributes
    ----------
    z : list of complex
        The roots of P; multipliers with a damping matrix.
    dz : list of acb or None
        Of each root; None where it is not simple as far as the balls tell.
    dT : arb or None
        None where T has no derivative, or none that the balls show: two roots may lead, or the one
        that leads is at an edge.
    """

    z: list[complex]
    dz: list[Any]
    dT: Any | None


def slopes(equation: Any, direction: Mapping[str, Any], narrow: int = NARROW) -> Slopes:
    """Of the roots of P and of T, by the solution of an equation twice as large.

    Parameters
    ----------
    equation : HillEquation
    direction : mapping of str to array_like
        As for `balls.moved`.
    narrow : int, optional
        Bits to which P and its derivative are known.

    Raises
    ------
    TooWide
        The equation is beyond the arbiter.
    """
    n = len(equation.F)
    matrix = np.ndim(equation.eta) > 0
    size = 2 * n if matrix else n

    def both() -> list[Any]:
        A, dA = _halves(square(moved(equation, direction)), n)
        p, dp = _polynomials(A, dA)
        return p + dp

    numbers = narrowed(both, narrow)
    p, dp = numbers[: size + 1], numbers[size + 1 :]
    with ctx.workprec(judgement.BITS):
        found = judgement.enclosed(p)
        z = [complex(b.mid()) for b in found.balls]
        if not found.simple:
            return Slopes(z, [None] * size, None)
        P, dP = acb_poly(p[::-1]), acb_poly(dp[::-1])
        slope = P.derivative()
        dz = [-dP(b) / slope(b) for b in found.balls]
        scale = arb(float(equation.Omega)) / arb.pi()
        faster = arb(float(direction.get("Omega", 0.0))) / arb(float(equation.Omega))
        rates = [_rate(b, d, matrix) for b, d in zip(found.balls, dz, strict=True)]
        dT = _leading(rates, scale, faster)
        if dT is not None and not matrix:
            dT = dT - arb(float(direction.get("eta", 0.0)))
        return Slopes(z, dz, dT)


def _halves(whole: Any, n: int) -> tuple[Any, Any]:
    """The matrix and its derivative, from the solution of the equation with doubled blocks."""
    blocks = whole.nrows() // (2 * n)
    here = [2 * n * b + i for b in range(blocks) for i in range(n)]
    rows = whole.tolist()
    A = arb_mat([[rows[i][j] for j in here] for i in here])
    dA = arb_mat([[rows[i][j + n] for j in here] for i in here])
    return A, dA


def _polynomials(A: Any, dA: Any) -> tuple[list[Any], list[Any]]:
    """det(x I - A), highest power first, and its derivative: - tr(B_k dA), B_k of the adjugate."""
    n = A.nrows()
    p = list(reversed(A.charpoly().coeffs()))
    dp, B = [arb(0)], identity(n)
    for k in range(1, n + 1):
        product = B * dA
        dp.append(-reduce(lambda a, b: a + b, (product[i, i] for i in range(n))))
        B = A * B + identity(n) * p[k]
    return p, dp


def _rate(root: Any, moved: Any, multiplier: bool) -> tuple[Any, Any | None]:
    """Ln R of a root, and its derivative; None at an edge."""
    if multiplier:
        return abs(root).log(), (moved / root).real
    real = root.imag.contains(0)
    if real:
        # between the edges R = 1, however it moves
        if abs(root.real) < 1:
            return arb(0), arb(0)
        root = acb(root.real)
    away = (root - 1).sqrt() * (root + 1).sqrt()
    if not abs(away) > 0:
        return judgement.log_R(root, real), None
    outer = away if abs(root + away) > abs(root - away) else -away
    return abs(root + outer).log(), (moved / outer).real


def _leading(rates: list[tuple[Any, Any | None]], scale: Any, faster: Any) -> Any | None:
    """Derivative of scale max ln R, where one root, or a pair that moves alike, leads."""
    highest = reduce(lambda a, b: a.max(b), (size for size, _ in rates))
    slopes: list[Any] = []
    for size, slope in rates:
        if size.overlaps(highest):
            if slope is None or (slopes and not slope.overlaps(slopes[0])):
                return None
            slopes.append(slope)
    return scale * (faster * highest + reduce(lambda a, b: a.union(b), slopes))
