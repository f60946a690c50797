"""Numbers that vary over rectangles within a patch, many at once, in floats with their rounding.

About a rectangle's middle P's coefficients are moved to second order; what is beyond is bounded,
and so is every sum and product of them.
"""

from dataclasses import dataclass
from math import comb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.enclosure.surface import Patch

Float = NDArray[np.floating[Any]]

ROUNDING = 2.0**-45
"""Of the sum of the moduli of all terms: each is rounded less than 128 times by 2**-53."""

WIDER = 2.0**-50
"""Halves of widths are widened by it: ends and middles are rounded by 2**-53 of a patch."""

# 1, x, y, x^2, xy, y^2
LOW = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))


@dataclass(frozen=True, eq=False)
class Local:
    """Numbers that vary over each of m rectangles, x and y from -1 to 1 in each.

    Attributes
    ----------
    terms : (m, ..., 6) ndarray
        Coefficients of `LOW`.
    rest : (m, ...) ndarray
        Bound on what else there is, rounding included.
    """

    terms: Float
    rest: Float

    @property
    def size(self) -> Float:
        """Bound on the modulus."""
        return np.asarray((np.abs(self.terms).sum(axis=-1) + self.rest) * (1.0 + ROUNDING))

    @property
    def real(self) -> "Local":
        """Of complex numbers that are real but for what is rounded."""
        return Local(np.real(self.terms), self.rest)

    @property
    def ends(self) -> tuple[Float, Float]:
        """Bounds from below and above."""
        c = self.terms
        # a square is in [0, 1]
        middle = c[..., 0] + 0.5 * (c[..., 3] + c[..., 5])
        reach = np.abs(c[..., [1, 2, 4]]).sum(axis=-1) + 0.5 * np.abs(c[..., [3, 5]]).sum(axis=-1)
        reach = reach + self.rest + ROUNDING * self.size
        return middle - reach, middle + reach


def about(patch: Patch, ends: Float) -> Local:
    """P's coefficients on rectangles (m, 4): ends in x, then in y, all within the patch."""
    a, b = patch.powers.shape[1:]
    X, Y = _moved(ends[:, 0], ends[:, 1], a), _moved(ends[:, 2], ends[:, 3], b)
    moved = np.swapaxes(X, 1, 2)[:, None] @ patch.powers @ Y[:, None]
    terms = np.stack([_term(moved, i, j) for i, j in LOW], axis=-1)
    size = np.abs(patch.powers).sum(axis=(1, 2))
    beyond = np.maximum(np.abs(moved).sum(axis=(2, 3)) - np.abs(terms).sum(axis=2), 0.0)
    return Local(terms, beyond + patch.rest * (1.0 + ROUNDING) + ROUNDING * size)


def _term(moved: Float, i: int, j: int) -> Float:
    inside = i < moved.shape[2] and j < moved.shape[3]
    return moved[:, :, i, j] if inside else np.zeros(moved.shape[:2])


def _moved(low: Float, high: Float, count: int) -> Float:
    """x**k as powers of a rectangle's own coordinate: C(k, a) middle**(k - a) half**a."""
    middle, half = 0.5 * (low + high), 0.5 * (high - low) + WIDER
    k = np.arange(count)
    binomial = np.array([[comb(i, j) for j in k] for i in k], float)
    powers, halves = middle[:, None] ** k, half[:, None] ** k
    return np.asarray(binomial * powers[:, np.maximum(k[:, None] - k, 0)] * halves[:, None, :])


def weighed(p: Local, weights: Float) -> Local:
    """Sum of w_0 and w_j times the j-th coefficient; weights (m, n + 1)."""
    w, size = weights[:, 1:], np.abs(weights)
    terms = np.einsum("mj,mjt->mt", w, p.terms)
    terms[:, 0] += weights[:, 0]
    rest = np.einsum("mj,mj->m", size[:, 1:], p.rest)
    total = size[:, 0] + np.einsum("mj,mj->m", size[:, 1:], p.size)
    return Local(terms, rest + ROUNDING * total)


def at(p: Local, z: Float, derivative: int = 0) -> Local:
    """P or a derivative at points z (m,), one a rectangle."""
    n = p.rest.shape[1]
    k = n - np.arange(n + 1)
    factor = np.ones(n + 1)
    for d in range(derivative):
        factor = factor * (k - d)
    return weighed(p, factor * z[:, None] ** np.maximum(k - derivative, 0))


def product(f: Local, g: Local) -> Local:
    """Of two numbers that vary, to second order."""
    a, b = f.terms, g.terms
    terms = a[:, :1] * b + b[:, :1] * a
    terms[:, 0] = a[:, 0] * b[:, 0]
    terms[:, 3] += a[:, 1] * b[:, 1]
    terms[:, 4] += a[:, 1] * b[:, 2] + a[:, 2] * b[:, 1]
    terms[:, 5] += a[:, 2] * b[:, 2]
    first, second = (np.abs(c[:, 1:3]).sum(axis=1) for c in (a, b))
    f2, g2 = (np.abs(c[:, 3:]).sum(axis=1) for c in (a, b))
    beyond = first * g2 + second * f2 + f2 * g2
    size = f.size * g.size
    return Local(terms, beyond + f.size * g.rest + g.size * f.rest + ROUNDING * size)
