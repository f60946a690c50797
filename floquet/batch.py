"""Many equations at once: P(z) of each, without Python in the inner loop.

In the phase theta = Omega tau the period is 2 pi for every equation, so they share the steps, and
with them the Taylor coefficients of the cosines. Equations with the same matrices sit side by side
as columns: a Taylor coefficient of all of them is one array, and the recurrence for the next one is
two matrix products.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.monodromy import WELL, monodromy
from floquet.steps import Term, longest_step, perron, rate
from hill import HillEquation

Float = NDArray[np.floating[Any]]
EPS = float(np.finfo(float).eps)

ORDER, TOLERANCE = 24, 1e-17
"""As for `floquet.propagate.Taylor`."""

CHUNK = 256
"""Equations side by side: enough to hide Python's share, few enough for the cache."""

# Rounding, in ulps of the terms summed, for each radian of the fastest motion; the largest seen is
# a sixth of it (tests/test_batch.py, against `monodromy`).
ULPS = 4.0


@dataclass(frozen=True, eq=False)
class Polynomials:
    """P(z) of several equations.

    Attributes
    ----------
    coefficients : (k, n + 1) float ndarray
        Monic, highest power first.
    errors : (k,) float ndarray
        Bound on the absolute error of every coefficient: truncation is below an ulp, rounding
        is bounded by a model that the tests hold against the arbiter.
    """

    coefficients: Float
    errors: Float


def polynomials(equations: Sequence[HillEquation]) -> Polynomials:
    """P(z) of many equations of one size, over half a period each.

    Quickest where many equations share F, G and H and differ in `Omega`, `gamma` and `eta`.

    Parameters
    ----------
    equations : sequence of HillEquation
        All with the same number of coordinates; `eta` one number.

    Raises
    ------
    ValueError
        Equations of different sizes; `eta` a matrix.
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    if not equations:
        return Polynomials(np.empty((0, 0)), np.empty(0))
    n = equations[0].n
    if any(equation.n != n for equation in equations):
        raise ValueError("equations: must all have the same number of coordinates")
    coefficients, errors = np.empty((len(equations), n + 1)), np.empty(len(equations))
    for members in _alike(equations):
        for chunk in _by_rate(equations, members):
            own = [equations[i] for i in chunk]
            coefficients[chunk], errors[chunk] = _chunk(own)
    return Polynomials(coefficients, errors)


def _alike(equations: Sequence[HillEquation]) -> list[list[int]]:
    """Indices of equations with the same matrices and the same harmonics."""
    groups: dict[Any, list[int]] = {}
    for i, e in enumerate(equations):
        harmonics = tuple(matrix.tobytes() for matrix in e.H), e.ratio if e.H else 0
        groups.setdefault((e.F.tobytes(), e.G.tobytes(), harmonics), []).append(i)
    return list(groups.values())


def _by_rate(equations: Sequence[HillEquation], members: list[int]) -> list[list[int]]:
    """Chunks of similar rates, so that no equation takes many more steps than it needs."""
    ordered = sorted(members, key=lambda i: equations[i].Omega)
    return [ordered[k : k + CHUNK] for k in range(0, len(ordered), CHUNK)]


def _chunk(equations: Sequence[HillEquation]) -> tuple[Float, Float]:
    first = equations[0]
    n, ratio = first.n, first.ratio if first.H else 1
    x = np.array([1.0 / e.Omega**2 for e in equations])
    y = np.array([e.gamma / e.Omega**2 for e in equations])
    shift = np.array([0.25 * e.damping**2 for e in equations]) * x
    # moduli only: the largest of each bounds them all
    worst = _terms(first, x.max(), np.abs(y).max(), shift.max(), ratio)
    nothing = np.zeros((n, n))
    steps = ceil(np.pi / longest_step(worst, nothing, ORDER, TOLERANCE))
    U = _half_period(first, x, y, shift, ratio, steps)
    if not np.all(np.isfinite(U)):
        raise OverflowError("the solution grows beyond what a float can hold within one period")

    inverse = np.linalg.inv(U)
    A = 2.0 * inverse[:, :n, :n] @ U[:, :n, :n] - np.eye(n)
    scale = np.abs(inverse) @ np.abs(U)
    P, sensitivity = characteristic_polynomials(A, scale[:, :n, :n])
    errors = ULPS * EPS * (2.0 + 2.0 * np.pi * rate(worst, nothing)) * sensitivity
    # as in `monodromy`: much growth makes the half period's inverse a poor one
    for i in map(int, np.flatnonzero(perron(scale) >= WELL)):
        m = monodromy(equations[i])
        P[i], errors[i] = m.polynomial, m.error
    return P, errors


def _terms(e: HillEquation, x: float, y: float, shift: float, ratio: int) -> list[Term]:
    """Stiffness matrices in the phase, with the frequencies of their cosines."""
    free = [(x * H_s, float(s * ratio)) for s, H_s in enumerate(e.H, start=1)]
    return [(x * np.abs(e.F) + shift * np.eye(e.n), 0.0), (y * e.G, 1.0), *free]


def _half_period(
    e: HillEquation, x: Float, y: Float, shift: Float, ratio: int, steps: int
) -> Float:
    """Fundamental matrices of (u, du/dtheta) at theta = pi, shape (k, 2n, 2n).

    u'' = -(x F - shift) u - y cos(theta) G u - x sum_s cos(s r theta) H_s u.
    """
    n, k = e.n, len(x)
    h = np.pi / steps
    matrices = np.hstack([e.F, e.G, *e.H])
    weights = -h * h * np.array([x, y] + [x] * len(e.H))
    phases = [1] + [s * ratio for s in range(1, len(e.H) + 1)]

    a = np.zeros((ORDER + 1, n, 2 * n, k))
    flat = a.reshape(ORDER + 1, -1)
    force = np.empty((len(weights), n, 2 * n, k))
    powers = np.arange(ORDER + 1.0)
    a[0, np.arange(n), np.arange(n)] = 1.0
    a[1, np.arange(n), np.arange(n, 2 * n)] = h
    for step in range(steps):
        cosines = [_reversed_cosine(p, p * h, step * h) for p in phases]
        for j in range(ORDER - 1):
            np.multiply(a[j], weights[0], out=force[0])
            for i, cosine in enumerate(cosines, start=1):
                product = (cosine[ORDER - 1 - j :] @ flat[: j + 1]).reshape(a[0].shape)
                np.multiply(product, weights[i], out=force[i])
            np.matmul(matrices, force.reshape(len(weights) * n, -1), out=a[j + 2].reshape(n, -1))
            if np.any(shift):
                a[j + 2] += (h * h * shift) * a[j]
            a[j + 2] /= (j + 1) * (j + 2)
        position, velocity = np.ones(ORDER + 1) @ flat, powers @ flat
        flat[0], flat[1] = position, velocity
    result = np.concatenate([a[0], a[1] / h])
    return np.ascontiguousarray(np.moveaxis(result, -1, 0))


def _reversed_cosine(frequency: int, turn: float, theta: float) -> Float:
    """Taylor coefficients of cos(frequency (theta + x h)) in x, last one first."""
    c, s = np.cos(frequency * theta), np.sin(frequency * theta)
    cycle = (c, -s, -c, s)
    series = [cycle[j % 4] * turn**j / factorial(j) for j in range(ORDER)]
    return np.array(series[::-1])


def characteristic_polynomials(A: Float, scale: Float) -> tuple[Float, Float]:
    """As `floquet.monodromy.characteristic_polynomial`, for many matrices (k, n, n)."""
    k, n = A.shape[:2]
    z = np.linalg.eigvals(A)
    p = np.zeros((k, n + 1), complex)
    p[:, 0] = 1.0
    for j in range(n):
        p[:, 1:] -= z[:, j, None] * p[:, :-1]
    real = np.ascontiguousarray(p.real)
    B, largest = np.broadcast_to(np.eye(n), A.shape), np.zeros(k)
    for j in range(n):
        moved = np.sum(np.abs(np.swapaxes(B, 1, 2)) * scale, axis=(1, 2))
        largest = np.maximum(largest, moved)
        B = A @ B + real[:, j + 1, None, None] * np.eye(n)
    return real, largest
