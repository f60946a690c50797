"""Many equations at once: P(z) of each from Hill's determinant, without Python in the inner loop.

As in `hill.determinant.converged` P is sampled on the circle |z| = 1, but clear of z = +-1 and of
the real axis, so that the determinant needs no pivots (`hill.determinant.folding`). Each sample is
worth two of P's real coefficients, and three or four are to spare: by Liouville's theorem the
leading one is 1 and there are no higher ones, and how much they fail to say so measures what
rounding has done. Where that is too much, `hill.characteristic` is asked, which pivots.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.arrays import EPS, Bool, Float
from hill.determinant.converged import characteristic
from hill.determinant.folding import BlockBatch, samples
from hill.determinant.general_polynomial import polynomial
from hill.determinant.general_values import determinant
from hill.equation import HillEquation
from hill.periodic import PeriodicEquation
from hill.precision import poor_P

CHUNK = 1152
"""Matrix elements side by side: enough to hide Python's share, few enough for the cache."""

# Equations that share their matrices by fewer than this, on average, go together unshared: 16 alike
# take .33 ms each, 256 that are not .13 ms.
MIN_GROUP = 32

# M = 2 w + COUPLING_HARMONICS sqrt|B| + EXTRA_HARMONICS: the tails' own error bound is then about
# the rounding's.
COUPLING_HARMONICS, EXTRA_HARMONICS = 8.0, 20

# Largest n w, and M: the product over m comes to exp(2 n w) on its way, and M**56 is needed.
MAX_EXPONENT, MAX_HARMONICS = 100.0, 500

# (F - eta^2/4)/Omega^2 takes four roundings of half an ulp; doubled, since the first order at
# gamma = 0 stands for what the couplings make of it.
DATA_ULPS = 4.0

# Relative error bound above which `characteristic` is asked: fifty times the largest on the
# report's chart, so that only what grows, or is nearly singular on the way, is asked again.
REFINE_ABOVE = 1e-10

# Against 600-bit arithmetic the true error was 0.20 of the bound at most over 450 systems of
# tests/systems.py, 0.13 over the chart range, and 0.41 over 200 with coefficients of up to 1e25.
SAFETY = 4.0


@dataclass(frozen=True, eq=False)
class Polynomials:
    """P(z) of several equations, or P(mu).

    Attributes
    ----------
    coefficients : (k, n + 1) or (k, m + 1) float ndarray
        Monic, highest power first.
    errors : (k,) float ndarray
        Bound on the absolute error of every coefficient, for the matrices as given: their own
        `data_error` is left out.
    """

    coefficients: Float
    errors: Float

    @property
    def poor(self) -> Bool:
        """Whose coefficients are known to less than nine digits, (k,): `hill.precision`."""
        return poor_P(self.coefficients, self.errors)


def polynomials(equations: Sequence[HillEquation | PeriodicEquation]) -> Polynomials:
    """P(z) of many equations of one size, by Hill's determinant.

    Quickest where many equations share F and G and differ in `Omega`, `gamma` and `eta`. Those
    with `H`, those with frequencies beyond ``100/n`` Omega and those that turn out to need pivots
    are handed to `characteristic`, one by one.

    Parameters
    ----------
    equations : sequence of HillEquation or PeriodicEquation
        All with the same number of coordinates; `eta` one number. Where one is a
        `PeriodicEquation`, all are taken as such, one by one: the polynomials are those of the
        multipliers, (k, m + 1).

    Raises
    ------
    ValueError
        Equations of different sizes; `eta` a matrix; an `Omega` too small for the determinant.
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    if not equations:
        return Polynomials(np.empty((0, 0)), np.empty(0))
    if any(isinstance(equation, PeriodicEquation) for equation in equations):
        return _general(equations)
    return _special([e for e in equations if isinstance(e, HillEquation)])


def _general(equations: Sequence[HillEquation | PeriodicEquation]) -> Polynomials:
    orders = [2 * e.n if isinstance(e, HillEquation) else e.order for e in equations]
    if any(order != orders[0] for order in orders):
        raise ValueError("equations: must all have the same number of multipliers")
    found = [polynomial(determinant(e)).unscaled() for e in equations]
    return Polynomials(
        np.array([c for c, _, _ in found]), np.array([np.max(errors) for _, errors, _ in found])
    )


def _special(equations: Sequence[HillEquation]) -> Polynomials:
    n, count = equations[0].n, len(equations)
    if any(equation.n != n for equation in equations):
        raise ValueError("equations: must all have the same number of coordinates")
    coefficients, errors = np.ones((count, n + 1)), np.full(count, np.inf)
    for members in _alike(equations):
        system, M = _system([equations[i] for i in members])
        for part in _by_size(M, max(1, CHUNK // n**2)):
            chunk = np.array(members)[part]
            coefficients[chunk], errors[chunk] = _solve(system.take(part), int(M[part].max()))
    poor = ~(errors <= REFINE_ABOVE * np.max(np.abs(coefficients), axis=1))
    for i in map(int, np.flatnonzero(poor)):
        c = characteristic(equations[i])
        coefficients[i], errors[i] = c.polynomial, c.error
    return Polynomials(coefficients, errors)


def _alike(equations: Sequence[HillEquation]) -> list[list[int]]:
    """Indices of equations with the same matrices; all together where few have the same."""
    groups: dict[Any, list[int]] = {}
    for i, e in enumerate(equations):
        if not e.H:
            groups.setdefault((e.F.tobytes(), e.G.tobytes()), []).append(i)
    together = [i for members in groups.values() for i in members]
    few = len(together) < MIN_GROUP * len(groups)
    return [together] if few else list(groups.values())


def _system(equations: list[HillEquation]) -> tuple[BlockBatch, Float]:
    """Blocks, and the M that each equation needs: infinite where it had better go alone."""
    n = equations[0].n
    per_Omega2 = np.array([1.0 / e.Omega**2 for e in equations])
    b = 0.5 * per_Omega2 * np.array([e.gamma for e in equations])
    shift = 0.25 * np.array([e.damping for e in equations]) ** 2
    F, G = _stack([e.F for e in equations]), _stack([e.G for e in equations])
    Fbar = (F - shift * np.eye(n)[:, :, None]) * per_Omega2
    of_F, moved = _spectrum(F, shift, np.abs(G) * np.array([abs(e.gamma) for e in equations]))
    squares = (of_F - shift) * per_Omega2
    highest = np.sqrt(np.max(np.abs(squares), axis=0))
    strength = np.abs(b) * np.max(np.abs(_eigenvalues(np.abs(G))), axis=0)
    M = 2.0 * highest + COUPLING_HARMONICS * np.sqrt(strength) + EXTRA_HARMONICS
    shared = G[:, :, 0] if G.shape[-1] == 1 else G[:, :, None]
    # z_j moves by pi sin(2 pi w)/w times what w_j^2 does, or 2 pi^2 where w is small
    w = np.maximum(np.sqrt(np.abs(squares)), 0.5 / np.pi)
    data = DATA_ULPS * EPS * np.sum(np.pi / w * moved * per_Omega2, axis=0)
    system = BlockBatch(Fbar[:, :, None], shared, b * b, squares[:, None], data)
    fast = (n * highest <= MAX_EXPONENT) & (M <= MAX_HARMONICS) & (data <= REFINE_ABOVE)
    return system, np.where(fast, M, np.inf)


def _spectrum(F: Float, shift: Float, coupling: Float) -> tuple[Any, Float]:
    """Eigenvalues of F, (n, k), and how far each moves when F - shift and the coupling are rounded.

    To first order an eigenvalue moves by l dF r, l and r its left and right eigenvectors. Rounding
    on the way, which F's zeros do not keep out where G has none, moves it likewise.
    """
    stacked = np.moveaxis(F, -1, 0)
    values, right = np.linalg.eig(stacked)
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:  # defective to the last bit
        return values.T.astype(complex), np.full((F.shape[0], len(shift)), np.inf)
    left, right = np.abs(left), np.abs(right)
    rounded = np.abs(stacked) + np.moveaxis(coupling, -1, 0)
    of_F = np.einsum("kij,kjl,kli->ik", left, rounded, right)
    of_shift = np.einsum("kij,kji->ik", left, right)
    return values.T.astype(complex), of_F + of_shift * shift


def _stack(matrices: list[Float]) -> Float:
    """Matrices side by side, (n, n, k); k = 1 where all are the same."""
    stacked = np.moveaxis(np.array(matrices), 0, -1)
    same = np.all(stacked == stacked[..., :1])
    return np.ascontiguousarray(stacked[..., :1] if same else stacked)


def _eigenvalues(stacked: Float) -> Any:
    """Of each matrix: (n, k) complex."""
    return np.linalg.eigvals(np.moveaxis(stacked, -1, 0)).T.astype(complex)


def _by_size(M: Float, count: int) -> Iterator[NDArray[np.int_]]:
    """Chunks of similar finite M, so that no equation takes many more blocks than it needs."""
    order = np.argsort(M)
    order = order[np.isfinite(M[order])]
    yield from (order[k : k + count] for k in range(0, len(order), count))


def _solve(system: BlockBatch, M: int) -> tuple[Float, Float]:
    """Coefficients (k, n + 1) and errors (k,)."""
    n = len(system.Fbar)
    count = n // 2 + 2
    angle = np.pi * (np.arange(count) + 0.5) / count
    alpha = np.arccos(np.exp(1j * angle)) / (2.0 * np.pi)
    # what overflows has no error bound, and is left to `characteristic`
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        values, truncation = samples(system, alpha, M)
        # values = sum_j c_j z^j with 2 count real c_j, by Fourier's transform at half steps
        back = np.exp(-1j * np.outer(np.arange(2 * count), angle)) / count
        c = np.real(back @ values)
        higher = c[n:].copy()
        higher[0] -= 1.0  # Liouville: the leading coefficient is 1, and there are no others
        size = np.max(np.abs(values), axis=0)
        highest = np.sqrt(np.max(np.abs(system.squares), axis=(0, 1)))
        rounding = np.max(np.abs(higher), axis=0) + EPS * (8 + 2 * np.pi * highest) * size
        errors = truncation * size + SAFETY * rounding + system.data * size
    return np.vstack([np.ones_like(size), c[:n][::-1]]).T, errors
