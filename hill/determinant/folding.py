r"""Hill's determinant of many equations, folded block by block, with what lies beyond it summed.

The same infinite determinant as in `hill.determinant`, taken another way. Where T couples
neighbours only, it folds from both ends towards the middle: with s = m + alpha,

    D(s) = Fbar - s^2,     S(s) = D(s) - C(s + 1),     C(s) = B S(s)^-1 B,
    det T = det [D(alpha) - C(1 + alpha) - C(1 - alpha)] prod_(m>=1) det S(m + alpha) S(m - alpha).

No rows are exchanged, so that many equations go side by side. It is safe off the real axis: with z
= cos 2 pi alpha not real, no D(s) is singular where w^2 is real, and no S(s) where the system is
stable.

What lies beyond |m| = M is summed: the uncoupled rows exactly; and of the coupling, which adds

    g(s) = log det S(s) - log det D(s)

to each, the values at s = M + 1 + alpha, M + 2 + alpha, ... by Euler and Maclaurin's midpoint rule,
as S(s) is defined between them too. No second and third M are needed.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import zeta

from hill.arrays import Complex, Float, frozen

# Steps that bring S(s) from D(s) to its limit: each gains a factor (|B|/s^2)^2 in log det.
RUN_IN = 2

# Gauss nodes for the integral of g from M + 1/2 on, where it is analytic to twice the interval's
# length and more (M >= 2 w + 20): 5.8**-14 of it is left.
NODES, REMAINDER = 7, 2e-11
_node, _weight = map(frozen, np.polynomial.legendre.leggauss(NODES))
GAUSS = frozen(0.5 * (_node + 1.0)), frozen(0.5 * _weight)

# Series terms of the uncoupled rows: (w + |alpha|)/M < 1/2 leaves 4**-28 = 1e-17.
SERIES = 28

# Edges M + 1/2 +- alpha lie about [M, M + 1]; there the coupling's tail, which falls like the cube
# of the distance s from w or faster, is a polynomial of degree 5 through Chebyshev's points: what
# is left of it is C(8, 2)/s^6 times prod (s - s_i), or 0.05/s^6, s > M - w >= 10 + M/2.
EDGES = frozen(0.5 + 0.5 * np.cos(np.pi * (np.arange(6) + 0.5) / 6))


@dataclass(frozen=True, eq=False)
class BlockBatch:
    """Blocks of k equations: the last axis; points s are the one before.

    Attributes
    ----------
    Fbar : (n, n, 1, k) float or complex ndarray
        (F - eta^2/4)/Omega^2, Eq. (6.2.10).
    G : (n, n) float ndarray, or (n, n, 1, k)
        Shared, or each equation's own.
    b2 : (k,) float ndarray
        Square of gamma/(2 Omega^2), the factor that makes B of G.
    squares : (n, 1, k) complex ndarray
        Eigenvalues w^2 of Fbar.
    data : (k,) ndarray
        What the rounding of Fbar moves P by, over the largest value of P.
    """

    Fbar: Any
    G: Any
    b2: Float
    squares: Complex
    data: Float

    def take(self, part: NDArray[np.int_]) -> "BlockBatch":
        """Some of the equations."""
        G = self.G if self.G.ndim == 2 else self.G[..., part]
        return BlockBatch(
            self.Fbar[..., part], G, self.b2[part], self.squares[..., part], self.data[part]
        )


def samples(system: BlockBatch, alpha: Complex, M: int) -> tuple[Complex, Float]:
    """prod_j (z - zeta_j) Delta(alpha) of every equation, and its relative truncation error.

    Parameters
    ----------
    system : BlockBatch
    alpha : (c,) complex ndarray
        Points off the real axis, with abs(Re alpha) <= 1/2.
    M : int
        The harmonics kept: 2 w + 20 and more.

    Returns
    -------
    values : (c, k) complex ndarray
    truncation : (k,) float ndarray
        What the sums beyond M may be wrong by.
    """
    points = alpha[:, None]
    coupling, truncation = _coupling_tail(system, points, M)
    tail = np.exp(_block_tail(system.squares, points, M) + coupling)
    values = (2.0 * np.pi**2) ** len(system.Fbar) * _determinants(system, points, M) * tail
    return values, truncation


def _determinants(system: BlockBatch, alpha: Complex, M: int) -> Complex:
    """Product of the folded blocks |m| <= M, each divided by m^2n (m = 0: by 1)."""
    n, count = len(system.Fbar), len(alpha)
    system = replace(system, Fbar=system.Fbar.astype(complex))
    ends = np.concatenate([alpha, -alpha])
    C: Any = 0.0
    product: Any = 1.0
    for m in range(M + RUN_IN, 0, -1):
        C, det = _fold(system, ends + m, C)
        if m <= M:
            product = product * (det / float(m) ** (2 * n))
    _, middle = _fold(system, alpha, C[:, :, :count] + C[:, :, count:])
    return np.asarray(middle * product[:count] * product[count:])


# ---- what lies beyond M --------------------------------------------------------------------------


def _block_tail(squares: Complex, alpha: Complex, M: int) -> Complex:
    """As `finite.log_block_tail`, the series summed by Horner's rule."""
    w = np.sqrt(squares)
    x2 = (np.concatenate([w + alpha, w - alpha]) / M) ** 2
    k = np.arange(SERIES, 0, -1)
    total: Any = 0.0
    for factor in zeta(2 * k, M + 1) * float(M) ** (2 * k) / k:
        total = (total + factor) * x2
    return -np.asarray(total).sum(axis=0)


def _coupling_tail(system: BlockBatch, alpha: Complex, M: int) -> tuple[Complex, Float]:
    """Sum of g(m + alpha) + g(m - alpha) over m > M, and a bound on its error."""
    edge = (M + EDGES)[:, None]
    correction, last = _differences(system, edge)
    integral, third = _integral(system, edge)
    powers = np.arange(len(EDGES))
    # the polynomial through the values at the edges, taken at M + 1/2 +- alpha
    wanted = (0.5 + alpha) ** powers + (0.5 - alpha) ** powers
    to_wanted = wanted @ np.linalg.inv(EDGES[:, None] ** powers)
    left = REMAINDER + 0.05 / (10.0 + 0.5 * M) ** 6
    error = np.max(last + third + left * np.abs(integral), axis=0)
    # two ends, and twice what was left out
    return to_wanted @ (integral + correction), 4.0 * error


def _integral(system: BlockBatch, edge: Float) -> tuple[Float, Float]:
    """Integral of g from the edge to infinity by s = edge/t; and of the first term left out of g.

    log det (1 - X), X = D(s)^-1 C(s + 1), is -tr X - tr X^2/2 - ...; X falls like s^-4.
    """
    total: Any = 0.0
    third: Any = 0.0
    for t, share in zip(*GAUSS, strict=True):
        s, ds = edge / t, share * edge / t**2
        C: Any = 0.0
        for ahead in range(RUN_IN, 0, -1):
            C, _ = _fold(system, s + ahead, C)
        inverse, _ = _invert(_block(system, s, 0.0))
        X = _product(inverse, C)
        first, second = np.einsum("jj...", X), np.einsum("jk...,kj...", X, X)
        total = total - ds * (first + 0.5 * second)
        third = third + ds * np.einsum("jk...,jk...", X, X) ** 1.5
    return total, third


def _differences(system: BlockBatch, edge: Float) -> tuple[Float, Float]:
    """What the midpoint rule adds to the integral, and the modulus of its last term.

    (1/24) d - (17/5760) d^3 + (367/967680) d^5, in central differences of g at the edge; the next
    term is much smaller than the last.
    """
    g = []
    C: Any = 0.0
    for ahead in np.arange(2.5 + RUN_IN, -3.0, -1.0):
        s = edge + ahead
        C, det = _fold(system, s, C)
        uncoupled = np.real(np.prod(system.squares - s * s, axis=0))
        g.append(np.log(det / uncoupled))
    first, third, fifth = (-np.diff(g[RUN_IN:], order, axis=0) for order in (1, 3, 5))
    last = 367.0 / 967680.0 * fifth[0]
    return first[2] / 24.0 - 17.0 / 5760.0 * third[1] + last, np.abs(last)


# ---- matrices side by side -----------------------------------------------------------------------


def _block(system: BlockBatch, s: Any, C: Any) -> Any:
    """D(s) - C."""
    shape = np.broadcast_shapes(system.Fbar.shape, s.shape)
    S = np.subtract(system.Fbar, C, out=np.empty(shape, system.Fbar.dtype))
    s2 = s * s
    for j in range(len(S)):
        S[j, j] -= s2
    return S


def _fold(system: BlockBatch, s: Any, C: Any) -> tuple[Any, Any]:
    """C(s) and det S(s) from C(s + 1)."""
    inverse, det = _invert(_block(system, s, C))
    inverse *= system.b2
    return _sandwich(system.G, inverse), det


def _sandwich(G: Any, X: Any) -> Any:
    """G X G; where G is shared, by real products of large matrices."""
    if G.ndim > 2:
        return _product(_product(G, X), G)
    n = len(G)
    left = (G @ X.view(float).reshape(n, -1)).reshape(n, n, -1)
    return (G.T @ left).view(X.dtype).reshape(X.shape)


def _product(A: Any, B: Any) -> Any:
    """A B."""
    total = A[:, 0, None] * B[None, 0]
    for j in range(1, len(A)):
        total += A[:, j, None] * B[None, j]
    return total


def _invert(S: Any) -> tuple[Any, Any]:
    """Inverses, which may take the place of S, and determinants: elimination without pivots."""
    if len(S) == 3:
        return _cofactors(S)
    det: Any = 1.0
    for j in range(len(S)):
        pivot = S[j, j].copy()
        det = det * pivot
        row, column = S[j] / pivot, S[:, j].copy()
        row[j], column[j] = 1.0 / pivot, 0.0
        S[j], S[:, j] = 0.0, 0.0
        S -= column[:, None] * row
        S[j] = row
    return S, det


def _cofactors(S: Any) -> tuple[Any, Any]:
    """The same by Cramer's rule, for three rows: half the work."""
    turned = np.concatenate([S, S[:, :2]], axis=1)
    following, last = turned[:, 1:4], turned[:, 2:5]
    transposed = np.empty_like(S)
    for j, (a, b) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.multiply(following[a], last[b], out=transposed[j])
        transposed[j] -= last[a] * following[b]
    det = S[0, 0] * transposed[0, 0] + S[0, 1] * transposed[0, 1] + S[0, 2] * transposed[0, 2]
    transposed *= 1.0 / det
    return np.ascontiguousarray(transposed.swapaxes(0, 1)), det
