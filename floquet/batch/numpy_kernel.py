"""Half a period for many points at once, in the phase theta = Omega tau: by numpy, or compiled.

    u'' = -(x F - shift) u - sum_i w_i cos(p_i theta) G_i u,     theta from 0 to pi

In the phase the period is 2 pi whatever Omega is, so all points share the steps and with them the
Taylor coefficients of the cosines. The points sit side by side as columns: a Taylor coefficient of
all of them is one array, and the recurrence for the next one is one product.
"""

from dataclasses import dataclass
from math import ceil, factorial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from floquet.arrays import Float
from floquet.charpoly import characteristic_polynomials
from floquet.integrate.step_length import Term, fastest_rate, longest_step
from floquet.integrate.taylor import Taylor

# as for one equation
ORDER, TOLERANCE = Taylor().order, Taylor().tolerance

# Points side by side in numpy: enough to hide Python's share, few enough for the cache.
CHUNK = 256

# Rounds of the power method in `growth_bound`; with 4 the bound is within a factor 1.1 of the root
# on the report's chart.
POWERS = 4
TINY = 1e-300


@dataclass(frozen=True, eq=False)
class Points:
    """Equations that differ in the factors before their matrices, and perhaps in these.

    Attributes
    ----------
    matrices : (1 + terms, n, n) or (1 + terms, k, n, n) ndarray
        F, then G and each H_s; shared, or each point's own.
    weights : (1 + terms, k) ndarray
        x, then w_i, for each of k points.
    shift : (k,) ndarray
        eta^2/(4 Omega^2).
    phases : tuple of int
        p_i, one a cosine.
    """

    matrices: Float
    weights: Float
    shift: Float
    phases: tuple[int, ...]

    def __getitem__(self, part: slice) -> "Points":
        shared = self.matrices.ndim == 3
        matrices = self.matrices if shared else self.matrices[:, part]
        return Points(matrices, self.weights[:, part], self.shift[part], self.phases)

    def own(self, index: NDArray[np.int_]) -> "Points":
        """Some of them, with matrices of their own."""
        shared = self.matrices.ndim == 3
        matrices = self.matrices[:, None] if shared else self.matrices[:, index]
        shape = (len(matrices), len(index), *matrices.shape[2:])
        matrices = np.broadcast_to(matrices, shape)
        return Points(matrices, self.weights[:, index], self.shift[index], self.phases)


@dataclass(frozen=True, eq=False)
class Found:
    """P(z) of the points, and what its error is made of.

    Attributes
    ----------
    P : (k, n + 1) ndarray
        det(z I - A), A = 2 p a - I with the first blocks p of U^-1 and a of U, U the fundamental
        matrix at theta = pi.
    sensitivity : (k,) ndarray
        How far a coefficient moves for a unit of relative rounding in the terms of U^-1 U, as
        `characteristic_polynomials` says.
    growth : (k,) ndarray
        Bound on the Perron root of |U^-1| |U|; infinite where U has no inverse.
    rate : (k,) ndarray
        Bound on the fastest motion, radians a radian of theta.
    """

    P: Float
    sensitivity: Float
    growth: Float
    rate: Float


class March(Protocol):
    """A way to run all points through half a period; quickest where neighbours have like Omega."""

    def __call__(self, points: Points) -> Found:
        """Take as many Taylor steps of `ORDER` as leave out less than `TOLERANCE` each."""
        ...


def by_numpy(points: Points) -> Found:
    """`March` without a compiler."""
    found = []
    for start in range(0, points.weights.shape[1], CHUNK):
        chunk = points[start : start + CHUNK]
        worst, nothing = terms_of(chunk), np.zeros(points.matrices.shape[-2:])
        steps = ceil(np.pi / longest_step(worst, nothing, ORDER, TOLERANCE))
        A, scale, growth = _folded(*fundamental(chunk, steps))
        fastest = np.full(len(A), fastest_rate(worst, nothing))
        found.append((*characteristic_polynomials(A, scale), growth, fastest))
    return Found(*(np.concatenate(values) for values in zip(*found, strict=True)))


def terms_of(points: Points) -> list[Term]:
    """Moduli of the stiffness matrices, the largest of each, with their cosines' frequencies."""
    weights, matrices = np.abs(points.weights), np.abs(points.matrices)
    if matrices.ndim == 4:
        matrices = np.max(weights[:, :, None, None] * matrices, axis=1)
    else:
        matrices = weights.max(axis=1)[:, None, None] * matrices
    matrices[0] += points.shift.max() * np.eye(len(matrices[0]))
    return list(zip(matrices, (0.0, *map(float, points.phases)), strict=True))


def fundamental(points: Points, steps: int, end: float = np.pi) -> tuple[Float, Float]:
    """Fundamental matrices of (u, du/dtheta) at theta = `end`, shape (k, 2n, 2n).

    And the largest that each element has been at the steps' ends: rounding there is of that size,
    whatever is left of it at the end.
    """
    n, k = points.matrices.shape[-1], points.weights.shape[1]
    h = end / steps
    shared = points.matrices.ndim == 3
    # side by side for one product, or with the points last, as everything else is
    matrices = np.hstack(list(points.matrices)) if shared else np.moveaxis(points.matrices, 1, -1)
    matrices = np.ascontiguousarray(matrices)
    weights, shift = -h * h * points.weights, h * h * points.shift

    a = np.zeros((ORDER + 1, n, 2 * n, k))
    flat = a.reshape(ORDER + 1, -1)
    force = np.empty((len(weights), n, 2 * n, k))
    powers = np.arange(ORDER + 1.0)
    a[0, np.arange(n), np.arange(n)] = 1.0
    a[1, np.arange(n), np.arange(n, 2 * n)] = h
    top = np.abs(flat[:2])
    for step in range(steps):
        cosines = [_reversed_cosine(p, p * h, step * h) for p in points.phases]
        for j in range(ORDER - 1):
            np.multiply(a[j], weights[0], out=force[0])
            for i, cosine in enumerate(cosines, start=1):
                product = (cosine[ORDER - 1 - j :] @ flat[: j + 1]).reshape(a[0].shape)
                np.multiply(product, weights[i], out=force[i])
            if shared:
                stacked = force.reshape(len(weights) * n, -1)
                np.matmul(matrices, stacked, out=a[j + 2].reshape(n, -1))
            else:
                np.einsum("irqk,iqck->rck", matrices, force, out=a[j + 2])
            if np.any(shift):
                a[j + 2] += shift * a[j]
            a[j + 2] /= (j + 1) * (j + 2)
        flat[0], flat[1] = np.ones(ORDER + 1) @ flat, powers @ flat
        np.maximum(top, np.abs(flat[:2]), out=top)
    return _stacked(a[0], a[1] / h), _stacked(*(top.reshape(2, n, 2 * n, k) / [[[[1.0]]], [[[h]]]]))


def _stacked(u: Float, du: Float) -> Float:
    """Points first, positions above velocities."""
    return np.ascontiguousarray(np.moveaxis(np.concatenate([u, du]), -1, 0))


def _reversed_cosine(frequency: int, turn: float, theta: float) -> Float:
    """Taylor coefficients of cos(frequency (theta + x h)) in x, last one first."""
    c, s = np.cos(frequency * theta), np.sin(frequency * theta)
    cycle = (c, -s, -c, s)
    series = [cycle[j % 4] * turn**j / factorial(j) for j in range(ORDER)]
    return np.array(series[::-1])


def _folded(U: Float, top: Float) -> tuple[Float, Float, Float]:
    """A, the first block of |U^-1| top, and a bound on the latter's Perron root."""
    k, n = len(U), U.shape[1] // 2
    sound = np.all(np.isfinite(top), axis=(1, 2))
    sound[sound] = np.linalg.slogdet(U[sound])[0] != 0.0
    A, scale, growth = np.zeros((k, n, n)), np.zeros((k, n, n)), np.full(k, np.inf)
    inverse = np.linalg.inv(U[sound])
    whole = np.abs(inverse) @ top[sound]
    A[sound] = 2.0 * inverse[:, :n, :n] @ U[sound, :n, :n] - np.eye(n)
    scale[sound] = whole[:, :n, :n]
    growth[sound] = growth_bound(whole)
    return A, scale, growth


def growth_bound(matrices: Float) -> Float:
    """Collatz and Wielandt: for any v > 0, max (S v)_i / v_i bounds the Perron root of S >= 0."""
    v, bound = np.ones(matrices.shape[:2]), np.full(len(matrices), np.inf)
    for _ in range(POWERS):
        moved = np.einsum("kij,kj->ki", matrices, v)
        bound = np.minimum(bound, np.max(moved / v, axis=1))
        v = moved / np.sum(moved, axis=1, keepdims=True) + TINY
    return bound
