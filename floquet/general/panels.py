"""X' = A(t) X on panels of time: Picard's iteration on Chebyshev nodes, and SUNDIALS beside it.

Panels are halved until A is told by its Chebyshev series on each and is short of turning by more
than `MAX_TURN`; A is asked within a panel only, so that it may jump at the ends.
"""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import chebyshev

from floquet.arrays import EPS, Float
from floquet.integrate.cvodes import adams

NODES = 24

# Of a panel's length times A's norm: Picard's iteration falls like its powers over factorials.
MAX_TURN = 1.5
ITERATIONS = 36

# Last coefficients of A's series over its largest element.
RESOLVED = 64.0 * EPS

# Halvings of a stretch between breaks; a jump inside one is never resolved.
MAX_HALVINGS = 26
MAX_PANELS = 20_000


def panels(A: Any, edges: Sequence[float]) -> Float:
    """Ends (count, 2) of panels between the edges.

    Raises
    ------
    ValueError
        A is not finite somewhere, or not smooth between the edges.
    """
    found: list[Float] = []
    open_ = np.array(list(pairwise(edges)))
    for _ in range(MAX_HALVINGS):
        values = at_nodes(A, open_)
        series = _to_series() @ values.reshape(len(open_), NODES, -1)
        size = np.max(np.abs(values), axis=(1, 2, 3))
        tail = np.max(np.abs(series[:, -4:]), axis=(1, 2))
        norm = np.max(np.sum(np.abs(values), axis=3), axis=(1, 2))
        length = open_[:, 1] - open_[:, 0]
        done = (tail <= RESOLVED * max(float(np.max(size)), 0.0)) & (norm * length <= MAX_TURN)
        found.append(open_[done])
        rest = open_[~done]
        if not len(rest):
            every = np.concatenate(found)
            return every[np.argsort(every[:, 0])]
        if len(rest) + sum(map(len, found)) > MAX_PANELS:
            raise ValueError(
                f"period = {edges[-1]:g}: A turns too often in it, {MAX_PANELS} panels"
            )
        middle = rest.mean(axis=1)
        open_ = np.concatenate(
            [np.stack([rest[:, 0], middle], 1), np.stack([middle, rest[:, 1]], 1)]
        )
    where = float(open_[0].mean())
    raise ValueError(f"A: is not smooth near t = {where:.6g}; list where it jumps in breaks")


def at_nodes(A: Any, ends: Float) -> Float:
    """A at the nodes of panels: (count, NODES, m, m).

    Raises
    ------
    ValueError
        A is not finite.
    """
    nodes = chebyshev.chebpts1(NODES)
    t = (ends.mean(axis=1)[:, None] + 0.5 * np.ptp(ends, axis=1)[:, None] * nodes).ravel()
    values = evaluated(A, t)
    bad = ~np.all(np.isfinite(values), axis=(1, 2))
    if np.any(bad):
        raise ValueError(f"A: is not finite at t = {t[bad][0]:.6g}")
    return values.reshape(len(ends), NODES, *values.shape[1:])


def evaluated(A: Any, t: Float) -> Float:
    """A at many times, (count, m, m)."""
    m = A.size1_out(0)
    wide = np.asarray(A.map(len(t))(t[None, :]))
    return wide.reshape(m, len(t), m).transpose(1, 0, 2)


def by_picard(A: Any, ends: Float) -> Float:
    """Fundamental matrix of each panel, (count, m, m), from the identity."""
    values, half = at_nodes(A, ends), 0.5 * np.ptp(ends, axis=1)[:, None, None, None]
    start = np.eye(values.shape[-1])
    integrals, whole = _integrals()
    X = np.broadcast_to(start, values.shape)
    for _ in range(ITERATIONS):
        X = start + half * np.einsum("ij,kjrc->kirc", integrals, values @ X)
    end = np.einsum("j,kjrc->krc", whole, values @ X)
    return np.asarray(start + half[:, 0] * end)


def by_cvodes(A: Any, ends: Float, tolerance: float) -> Float:
    """The same by SUNDIALS' Adams method."""
    m = A.size1_out(0)
    integrator = _integrator(A, m, tolerance)
    found = np.empty((len(ends), m, m))
    for k, (a, b) in enumerate(ends):
        # never the ends themselves, at which A may jump
        inner = np.nextafter(a, b), np.nextafter(b, a)
        end = integrator(x0=np.eye(m).ravel(order="F"), p=[a, b, *inner])["xf"]
        found[k] = np.asarray(end).reshape((m, m), order="F")
    return found


def _integrator(A: Any, m: int, tolerance: float) -> Any:
    x, p, X = ca.MX.sym("x"), ca.MX.sym("p", 4), ca.MX.sym("X", m * m)
    t = ca.fmin(ca.fmax(p[0] + x * (p[1] - p[0]), p[2]), p[3])
    rise = (p[1] - p[0]) * (A(t) @ ca.reshape(X, m, m))
    return adams({"x": X, "t": x, "p": p, "ode": ca.vec(rise)}, tolerance)


@lru_cache(maxsize=1)
def _to_series() -> Float:
    """From values at the nodes to coefficients."""
    nodes = chebyshev.chebpts1(NODES)
    matrix = 2.0 / NODES * chebyshev.chebvander(nodes, NODES - 1).T
    matrix[0] *= 0.5
    return np.asarray(matrix)


@lru_cache(maxsize=1)
def _integrals() -> tuple[Float, Float]:
    """From values at the nodes to integrals from -1 to each node, and to 1."""
    nodes = chebyshev.chebpts1(NODES)
    primitive = np.array([chebyshev.chebint(row, lbnd=-1.0) for row in np.eye(NODES)])
    series = _to_series()
    to_nodes = chebyshev.chebvander(nodes, NODES) @ primitive.T @ series
    return to_nodes, np.sum(primitive, axis=1) @ series
