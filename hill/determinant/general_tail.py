r"""What lies beyond the rows kept of a general infinite determinant, as series in 1/z.

Eliminated from infinity down, the group of rows that starts at z becomes

    S(z) = D(z) - U(z) S(z + c)^-1 L(z),     c = i g Omega,

D, U and L the blocks of T: on the diagonal, after it and before it, g harmonics together. They are
polynomials in z, so S(z)/z^d is a power series in x = 1/z, which begins with the identity; z + c is
x/(1 + c x). Term by term the equation gives the next coefficient from those before, as U and L are
of lower degree in z than D. What the rows beyond add to ln det T over that of z^d alone,

    sum_(t>=0) l(z + c t),     l = ln det S(z)/prod_a (z + i a Omega)^(n d),

is a series too: the h with h(x) - h(x/(1 + c x)) = l(x). Its first term is a logarithm, whose part
that grows without limit the rows at the other end take away. Towards the other end all is the
complex conjugate. Where |z| exceeds the frequencies a few times, the series are exact to rounding:
`kept` says from which group on.
"""

from bisect import bisect_left
from dataclasses import dataclass
from functools import lru_cache
from math import comb
from typing import Any

import numpy as np

from hill.arrays import Complex, Float
from hill.determinant.pencil import Pencil

TERMS = 40
"""Of the series: at 2.6 times what the coefficients grow by they end at 1e-17."""

REMAINDER = 1e-17
"""What the last terms may still add."""

LAST = 4
"""Terms by which the end of a series is judged: some may be zero by symmetry."""

MAX_GROUPS = 10_000
"""Groups that may be kept at most, on either side."""


@dataclass(frozen=True, eq=False)
class Tail:
    """The two series.

    Attributes
    ----------
    S : (TERMS + 1, b, b) complex ndarray
        Of S(z)/z^d in powers of 1/z, b = g n.
    first : float
        Coefficient of 1/z in l.
    h : (TERMS,) complex ndarray
        Of h but for its logarithm, in powers of 1/z.
    """

    S: Complex
    first: float
    h: Complex

    def matrix(self, z: Complex, degree: int) -> Complex:
        """S(z) at many z, (k, b, b)."""
        found: Any = np.zeros((len(z), *self.S.shape[1:]), complex)
        for coefficient in self.S[::-1]:
            found = found / z[:, None, None] + coefficient
        return found * (z**degree)[:, None, None]

    def matrix_slope(self, z: Complex, degree: int) -> Complex:
        """dS/dz."""
        found: Any = np.zeros((len(z), *self.S.shape[1:]), complex)
        for k in range(TERMS, -1, -1):
            found = found / z[:, None, None] + (degree - k) * self.S[k]
        return found * (z ** (degree - 1))[:, None, None]

    def log(self, z: Complex) -> Complex:
        """h(1/z) but for its logarithm."""
        return np.polyval(self.h[::-1], 1.0 / z)


def tail(p: Pencil) -> Tail:
    """The series of an equation."""
    c = 1j * p.reach * p.Omega
    D, U, L = _polynomials(p, c)
    b, degree = len(D[0]), p.degree
    S = np.zeros((TERMS + 1, b, b), complex)
    inverse, after = np.zeros_like(S), np.zeros_like(S)
    S[0] = inverse[0] = after[0] = np.eye(b)
    shift = _shifts(degree) * _powers(-c)
    between = [(i, j) for i in range(1, degree + 1) for j in range(1, degree + 1)]
    between = [(i, j) for i, j in between if np.any(U[i]) and np.any(L[j])]
    for k in range(1, TERMS + 1):
        if k <= degree:
            S[k] = D[k]
        for i, j in between:
            if k >= i + j:
                S[k] -= U[i] @ after[k - i - j] @ L[j]
        # S times its inverse is 1
        earlier = inverse[k - 1 :: -1] if k > 1 else inverse[:1]
        inverse[k] = -np.concatenate(S[1 : k + 1], axis=1) @ earlier.reshape(-1, b)
        # x^i becomes x^i (1 + c x)^-i, and once more (1 + c x)^-d of S itself
        after[k] = np.tensordot(shift[: k + 1, k], inverse[: k + 1], 1)
    return Tail(S, *_summed(_log_det(S, inverse, p), c))


def kept(p: Pencil, t: Tail) -> int:
    """Groups to keep on either side.

    Raises
    ------
    ValueError
        More than `MAX_GROUPS`.
    """
    size, powers = np.max(np.sum(np.abs(t.S), axis=2), axis=1), np.arange(TERMS + 1)
    with np.errstate(divide="ignore"):
        log_S, log_h = np.log(size), np.log(np.abs(t.h))

    def enough(K: int) -> bool:
        # the first harmonic beyond, on the side where it is nearer
        z = p.Omega * ((K + 1) * p.reach - p.reach // 2 - 0.5)
        with np.errstate(over="ignore"):
            of_S = np.exp(log_S - powers * np.log(z))
            of_h = np.exp(log_h - powers[:-1] * np.log(z))
        last = max(np.max(of_S[-LAST:]), np.max(of_h[-LAST:]))
        # and the rows beyond are far from singular
        return bool(last < REMAINDER and np.sum(of_S[1:]) < 1.0)

    if not enough(MAX_GROUPS):
        highest = float(np.max(size[-LAST:] ** (1.0 / powers[-LAST:]))) / p.Omega
        raise ValueError(
            f"too small for the determinant, which would need more than {MAX_GROUPS * p.reach:,} "
            f"harmonics of it: something moves {highest:.3g} times as fast"
        )
    return bisect_left(range(1, MAX_GROUPS), True, key=enough) + 1


def _polynomials(p: Pencil, c: complex) -> list[Complex]:
    """D, U and L over z^d: coefficients of powers of 1/z, (d + 1, b, b) each."""
    column = np.repeat(1j * p.Omega * np.arange(p.reach), p.n)
    found = []
    for off, start in ((1, 0.0), (0, c), (2, 0.0)):
        # X_d (z + start + column)^d
        coefficients = np.zeros((p.degree + 1, *p.stacks.shape[2:]), complex)
        for d, X in enumerate(p.stacks[off]):
            for i in range(d + 1):
                coefficients[p.degree - d + i] += X * (comb(d, i) * (start + column) ** i)
        found.append(coefficients)
    return found


@lru_cache
def _shifts(degree: int) -> Float:
    """|coefficient| of x^k in (x/(1 + x))^i (1 + x)^-degree, [i, k]; signs are (-1)^(k - i)."""
    found = np.zeros((TERMS + 1, TERMS + 1))
    for i in range(TERMS + 1):
        for k in range(i, TERMS + 1):
            found[i, k] = comb(k + degree - 1, k - i) if k > i else 1.0
    found.flags.writeable = False
    return found


def _powers(c: complex) -> Complex:
    """C^(k - i), [i, k]; 0 below the diagonal."""
    difference = np.arange(TERMS + 1) - np.arange(TERMS + 1)[:, None]
    return np.where(difference >= 0, c ** np.maximum(difference, 0), 0.0)


def _log_det(S: Complex, inverse: Complex, p: Pencil) -> Complex:
    """Coefficients of l: k l_k = sum_i i tr S_i (S^-1)_(k-i), less the rows' own z^d."""
    k = np.arange(1, TERMS + 1)
    products = np.einsum("iab,jba->ij", S, inverse)
    found = np.zeros(TERMS + 1, complex)
    for j in k:
        i = np.arange(1, j + 1)
        found[j] = np.sum(i * products[i, j - i]) / j
    own = sum((1j * p.Omega * a) ** k for a in range(p.reach))
    found[1:] -= p.order * (-1.0) ** (k + 1) * own / k
    return found


def _summed(ell: Complex, c: complex) -> tuple[float, Complex]:
    """The coefficient of 1/z, and h: h(x) - h(x/(1 + c x)) = l(x) - ell_1/c ln(1 + c x)."""
    first, k = float(ell[1].real), np.arange(1, TERMS + 1)
    rest = ell.copy()
    rest[1:] += first / c * (-c) ** k / k
    h = np.zeros(TERMS, complex)
    shift = _shifts(0) * _powers(-c)
    for j in range(1, TERMS):
        h[j] = rest[j + 1] / (j * c)
        # x^j - (x/(1 + c x))^j
        rest[j + 1 :] += h[j] * shift[j, j + 1 :]
    return first, h
