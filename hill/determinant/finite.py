r"""Hill's infinite determinant Delta(alpha), times what makes it a polynomial in z.

Written out, the harmonics c_m of Eq. (6.2.6) obey T(alpha) c = 0 with the blocks

    T_mm = Fbar - (alpha + m)^2,     T_m,m+-p = B_p,     Fbar = (F - eta^2/4)/Omega^2,

where B_1 = gamma G/(2 Omega^2) and B_(s r) gains H_s/(2 Omega^2), r = omega_L/Omega. Dividing each
row by its diagonal element gives Delta(alpha) of (6.2.8), with poles where Fbar_jj = (alpha+m)^2.
The poles belong to the division, not to the problem: with z = cos 2 pi alpha the product
Delta(alpha) prod_j (z - zeta_j) has none, because z - zeta_j is the product of the divisors,

    z - zeta_j = 2 pi^2 (w^2 - alpha^2) prod_(m>=1) [(m+alpha)^2 - w^2] [(m-alpha)^2 - w^2] / m^4,

w^2 = Fbar_jj. So the finite determinant is left undivided, and what lies beyond |m| = M is summed:
the product of the blocks' own determinants exactly (`log_block_tail`), the coupling to second
order (`log_pair_tail`). What is left falls like M^-5 or faster, and is extrapolated away in
`hill.characteristic`.
"""

from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import zgbtrf
from scipy.special import zeta

from hill.arrays import Complex, Float, frozen
from hill.determinant.products import products
from hill.equation import HillEquation

# Gauss nodes for the tail's integral. Its integrand is analytic to twice the interval's length
# (M >= 2 w below), so 12 nodes leave 6**-24 = 2e-19.
NODES = 12
# The tail of the coupling is taken by modes where that loses no more than three digits of it; it
# is a correction of 2e-4 and less for the report's beams.
MAX_INVERSE = 1e3
# Series terms of the block tail: (w + |alpha|)/M <= 0.6 makes 0.6**(2*40) = 2e-18.
SERIES = 40
OVERFLOW = "the solution grows beyond what a float can hold within one period"

# Its powers M**(2*SERIES) must stay below 1e308, at the finest level 1.5 M.
MAX_HARMONICS = 4000


@dataclass(frozen=True, eq=False)
class Blocks:
    """Fbar (6.2.10), as a whole matrix, and B_p of the harmonics p = 1, 2, ... present."""

    Fbar: Float
    B: dict[int, Float]

    @property
    def n(self) -> int:
        """Rows of a block."""
        return len(self.Fbar)

    @property
    def reach(self) -> int:
        """The highest harmonic."""
        return max(self.B, default=0)

    @cached_property
    def squares(self) -> Complex:
        """The squares w^2 of the constant system's frequencies: eigenvalues of Fbar."""
        return np.asarray(np.linalg.eigvals(self.Fbar), complex)

    @cached_property
    def modes(self) -> tuple[Complex, Complex, Complex] | None:
        """X^-1 Fbar X = diag(w^2): w^2, X and X^-1, if X^-1 is no larger than `MAX_INVERSE`."""
        values, X = np.linalg.eig(self.Fbar)
        try:
            inverse = np.linalg.inv(X)
        except np.linalg.LinAlgError:
            return None
        return (values, X, inverse) if np.max(np.abs(inverse)) < MAX_INVERSE else None

    @property
    def highest(self) -> float:
        """The largest |w|."""
        return float(np.sqrt(np.max(np.abs(self.squares))))


def blocks(equation: HillEquation) -> Blocks:
    """The blocks of T, Eqs. (6.2.6) to (6.2.10), in the time Omega tau."""
    Omega2 = equation.Omega**2
    damping = 0.25 * equation.damping**2 * np.eye(equation.n)
    terms = {1: 0.5 * equation.gamma * equation.G / Omega2}
    for s, H_s in enumerate(equation.H, start=1):
        p = s * equation.ratio
        terms[p] = terms.get(p, 0.0) + 0.5 * H_s / Omega2
    return Blocks(
        Fbar=(equation.F - damping) / Omega2,
        B={p: term for p, term in terms.items() if np.any(term)},
    )


def determinants(system: Blocks, alpha: Complex, M: int, squares: Complex) -> Complex:
    """prod_j (z - zeta_j) Delta(alpha) from |m| <= M, with the uncoupled rows beyond it exact.

    Parameters
    ----------
    alpha : (k,) complex ndarray
        Any points, poles of Delta included.
    M : int
        The harmonics kept; must exceed the frequencies (see `least_truncation`).
    squares : (n,) complex ndarray
        w^2 for the tail: the diagonal of Fbar is the report's Delta, the eigenvalues of Fbar make
        the tail exact where there is no coupling.

    Raises
    ------
    OverflowError
        P(z) is too large for a float.
    """
    log_tail = log_block_tail(squares, alpha, M)
    shift = np.round(log_tail.real / np.log(2.0))
    tail = np.exp(log_tail - shift * np.log(2.0))
    mantissa, exponent = _finite(system, alpha, M)
    value = (2.0 * np.pi**2) ** system.n * mantissa * tail
    power = exponent + shift.astype(int)
    if np.any(power > 1000):
        raise OverflowError(OVERFLOW)
    return np.asarray(value * np.ldexp(1.0, power))


# Over 39 systems, nine of them Table 3's with initial conditions, the error that is reported was
# 5e-11 of P in the median with no more harmonics, 7e-13 with 10 more, 1e-13 with 20 and with 60;
# for the strongest of Table 3 it is 2e-10, 2e-11, 4e-12 with the factors 0, 8 and 16.
COUPLING_HARMONICS, EXTRA_HARMONICS = 16.0, 30


def least_truncation(system: Blocks) -> int:
    """M from which the tails' expansions hold: w/M <= 1/2, clear of the couplings' reach.

    A strong coupling moves the blocks' own frequencies by the square root of its strength.

    Raises
    ------
    ValueError
        More than `MAX_HARMONICS` harmonics are needed.
    """
    coupling = sum((np.abs(B) for B in system.B.values()), np.zeros_like(system.Fbar))
    strength = float(np.max(np.abs(np.linalg.eigvals(coupling)))) if system.B else 0.0
    couplings = COUPLING_HARMONICS * np.sqrt(strength)
    M = int(2.0 * system.highest + couplings) + 2 * system.reach + EXTRA_HARMONICS
    if M > MAX_HARMONICS:
        raise ValueError(
            f"too small for the determinant, which needs {M:.7g} harmonics of it "
            f"(at most {MAX_HARMONICS}): the highest frequency is {system.highest:.3g} Omega"
        )
    return M


def _finite(system: Blocks, alpha: Complex, M: int) -> tuple[Complex, NDArray[np.int_]]:
    """Det T over |m| <= M, each row divided by m^2 (m = 0: by 1), by banded LU with pivoting.

    As mantissas and powers of two.
    """
    n, reach = system.n, min(system.reach, 2 * M)
    m = np.arange(-M, M + 1)
    scale = np.where(m == 0, 1.0, m * m)
    size, width = n * len(m), (reach + 1) * n - 1
    # block column, column, diagonal of T: columns one after the other, as LAPACK has them
    band = np.zeros((len(m), n, 3 * width + 1), complex)

    j, k = np.indices((n, n)).reshape(2, -1)

    def put(p: int, block: Float) -> None:
        rows = slice(max(0, -p), len(m) - max(0, p))
        columns = slice(max(0, p), len(m) - max(0, -p))
        band[columns, k, 2 * width + j - k - p * n] = block.ravel() / scale[rows, None]

    put(0, system.Fbar)
    for p, B in system.B.items():
        if p <= reach:
            put(p, B)
            put(-p, B)
    unmoved, first = np.arange(size), 2 * width
    diagonal = band[..., first] - (((alpha[:, None] + m) ** 2) / scale)[..., None]
    pivots, signs = np.empty((len(alpha), size), complex), np.ones(len(alpha))
    for i in range(len(alpha)):
        table = band.copy()
        table[..., first] = diagonal[i]
        lu, rows, _ = zgbtrf(table.reshape(size, -1).T, width, width, overwrite_ab=True)
        pivots[i] = lu[first]
        signs[i] = (-1.0) ** np.count_nonzero(rows != unmoved)
    mantissa, exponent = products(pivots)
    return signs * mantissa, exponent


def log_block_tail(squares: Complex, alpha: Complex, M: int) -> Complex:
    """Log of prod_(m>M) [(m+alpha)^2 - w^2][(m-alpha)^2 - w^2]/m^4, summed over the w.

    The bracket factors into 1 - x^2/m^2 with x = w + alpha and w - alpha; its logarithm is a
    series in x^2 whose sums over m are Hurwitz zeta functions. Where M is below the frequencies, as
    a finite determinant's may be, the first factors are multiplied out.
    """
    w = np.sqrt(squares)
    x2 = np.concatenate([np.add.outer(w, alpha), np.subtract.outer(w, alpha)]) ** 2
    enough = int(2.0 * np.max(np.sqrt(np.abs(x2)))) + 1
    if enough > M:
        m = np.arange(M + 1, enough + 1)
        first = np.sum(np.log(1.0 - x2[..., None] / m**2), axis=(0, -1))
        return np.asarray(first + log_block_tail(squares, alpha, enough))
    k = np.arange(1, SERIES + 1)
    terms = (x2[..., None] / M**2) ** k * _zetas(M)
    return np.asarray(-np.sum(terms, axis=(0, -1)))


@lru_cache(maxsize=256)
def _zetas(M: int) -> Float:
    """Sum of (M/m)^2k/k over m > M, k from 1 to `SERIES`."""
    k = np.arange(1, SERIES + 1)
    return frozen(zeta(2 * k, M + 1) * float(M) ** (2 * k) / k)


@cache
def _gauss() -> tuple[Float, Float]:
    """Gauss and Legendre's nodes and weights on [0, 1]."""
    node, weight = np.polynomial.legendre.leggauss(NODES)
    return frozen(0.5 * (node + 1.0)), frozen(0.5 * weight)


def log_pair_tail(system: Blocks, alpha: Complex, M: int) -> Complex:
    """The coupling beyond |m| = M, to second order in B: -1/2 tr K^2 of log det(1 + K).

    A pair of blocks (m, m + p) contributes -tr[R(s) B_p R(s + p) B_p], R(s) = (Fbar - s^2)^-1,
    s = alpha + m, to all orders in F. The pairs with a block outside are summed over both ends by
    Euler and Maclaurin's midpoint rule; the first term it drops is (7/5760) f''', less than
    1e-13 |B|^2 for every M of `least_truncation`, and it too is extrapolated away.
    """
    total = np.zeros(2 * len(alpha), complex)
    t, weight = _gauss()
    ends = np.concatenate([alpha, -alpha])
    for p, B in system.B.items():
        edge = ends + (M + 0.5 - 0.5 * p)  # halfway between the last pair kept and the next
        # centres of pairs: the integral from the edge to infinity, and the edge's two neighbours
        y = np.column_stack([np.divide.outer(edge, t), edge + 0.5, edge - 0.5])
        f = _pairs(system, B, (y - 0.5 * p) ** 2, (y + 0.5 * p) ** 2)
        total -= f[:, :NODES] / t**2 @ weight * edge + (f[:, -2] - f[:, -1]) / 24.0
    return total[: len(alpha)] + total[len(alpha) :]


def _pairs(system: Blocks, B: Float, first: Any, second: Any) -> Complex:
    """tr[R(s) B R(t) B] of pairs of squares s^2 and t^2."""
    if system.modes is None:
        squares = np.array([first, second])[..., None, None]
        left, right = np.linalg.inv(system.Fbar - squares * np.eye(system.n)) @ B
        return np.asarray(np.einsum("...jk,...kj->...", left, right))
    values, X, inverse = system.modes
    coupling = inverse @ B @ X
    left, right = (1.0 / (values - squares[..., None]) for squares in (first, second))
    return np.asarray(np.sum((left @ (coupling * coupling.T)) * right, axis=-1))
