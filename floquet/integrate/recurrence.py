"""The power series of a linear equation's solution, coefficient by coefficient, in CasADi."""

from collections.abc import Sequence
from math import factorial
from typing import Any

Term = tuple[Any, list[Any]]
"""A matrix and the power series of the cosine or sine that multiplies it."""


def second_order(
    Q: Any, V: Any, h: Any, order: int, stiffness: tuple[Any, Sequence[Term]], damping: Any
) -> tuple[Any, Any]:
    """(q, q') a step h after (Q, V), by q'' = -C q' - K q.

    Parameters
    ----------
    Q, V : (n, columns) expression
    h : expression
    order : int
        Highest power kept.
    stiffness, damping : tuple of (n, n) expression and sequence of Term
        The mean and what pulsates, in the powers of the step's own fraction x, tau + x h; no
        damping is None.
    """
    # q(tau + x h) = sum_k a_k x^k, so power by power
    # (k+1)(k+2) a_(k+2) = -h sum_j C_j (k+1-j) a_(k+1-j) - h^2 sum_j K_j a_(k-j)
    mean, pulsating = stiffness
    a = [Q, h * V]
    for k in range(order - 1):
        force = mean @ a[k]
        for matrix, series in pulsating:
            force += matrix @ sum(series[j] * a[k - j] for j in range(k + 1))
        force = h * h * force
        if damping is not None:
            force = h * (k + 1) * (damping[0] @ a[k + 1]) + force
            for matrix, series in damping[1]:
                moved = sum(series[j] * ((k + 1 - j) * a[k + 1 - j]) for j in range(k + 1))
                force += h * (matrix @ moved)
        a.append(-force / ((k + 1) * (k + 2)))
    return sum(reversed(a)), sum(k * a[k] for k in reversed(range(1, order + 1))) / h


def first_order(X: Any, h: Any, order: int, system: tuple[Any, Sequence[Term]]) -> Any:
    """X a step h later, by x' = A x; the mean of A and what pulsates, as for the second order."""
    mean, pulsating = system
    a = [X]
    for k in range(order):
        rise = mean @ a[k]
        for matrix, series in pulsating:
            rise += matrix @ sum(series[j] * a[k - j] for j in range(k + 1))
        a.append(h * rise / (k + 1))
    return sum(reversed(a))


def cosine(c: Any, s: Any, turn: Any, order: int) -> list[Any]:
    """Taylor coefficients of cos(phase + x turn) in x; c and s are cosine and sine of the phase."""
    cycle = [c, -s, -c, s]
    return [cycle[j % 4] * turn**j / factorial(j) for j in range(order)]


def sine(c: Any, s: Any, turn: Any, order: int) -> list[Any]:
    """The same of sin(phase + x turn)."""
    cycle = [s, c, -s, -c]
    return [cycle[j % 4] * turn**j / factorial(j) for j in range(order)]
