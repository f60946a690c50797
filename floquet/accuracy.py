"""How well two integrations of the same equation know its matrix and characteristic polynomial."""

from dataclasses import dataclass

import numpy as np

from floquet.arrays import EPS, Float
from floquet.charpoly import MAX_EXACT, characteristic_polynomial

OVERFLOW = "the solution grows beyond what a float can hold within one period"

# On the difference of two runs. With 4 one of 1,569 hostile systems of `benchmarks.honesty` was off
# by 1.4 of its bound: two runs that were alike by chance.
SAFETY = 8.0
# On the ulps that a run may lose beside, which such a chance does not touch. Without them one of 63
# random systems was 7.5 bounds off; with 1 the largest was .16 of its bound, with 3 it is .08.
ROUNDING_SAFETY = 3.0

# Ulps of a run, whatever its length: the products that make P of it. Beside the radians of its
# fastest motion, 2 pi at least, they count little: over 372 systems of `benchmarks.honesty` 99 % of
# the true errors were below .09 of the bound, with 2 in their place .11; .58 at most with both.
BASE_ULPS = 8.0


@dataclass(frozen=True, eq=False)
class Bounded:
    """The characteristic polynomial of a matrix, and bounds on the errors of both.

    Attributes
    ----------
    p, errors : (n + 1,) ndarray
        Monic, highest power first.
    matrix_error : (n, n) ndarray
    """

    p: Float
    errors: Float
    matrix_error: Float


def bounded(
    A: Float,
    check: Float,
    scale: Float,
    ulps: float,
    floor: float,
    given: tuple[Float, float] | None = None,
) -> Bounded:
    """What two runs know of A, each element of which sums terms of size `scale`.

    Where the runs differ by chance in nothing, they may still both be off: the largest difference
    over its scale is taken for all elements, and for all coefficients. It is that of the
    coefficients; where these are not exact, no more than that of the elements.

    Parameters
    ----------
    A, check : (n, n) ndarray
        By one run and by the other.
    scale : (n, n) ndarray
    ulps : float
        Rounding of a run, in ulps of `scale`.
    floor : float
        What a run may be off without the other's showing it, over `scale`.
    given : (n, n) ndarray and float, optional
        What the run's data were off already: in A, and in P over its size; whichever says less.

    Raises
    ------
    OverflowError
        A coefficient, or its error, is beyond a float.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        try:
            p, sensitivity, rounding = characteristic_polynomial(A, scale)
            other, _, also = characteristic_polynomial(check, scale)
        except OverflowError:
            raise OverflowError(OVERFLOW) from None
        apart = largest_share(np.abs(p - other), sensitivity)
        if len(A) > MAX_EXACT:
            apart = min(apart, largest_share(np.abs(A - check), scale))
        own = floor + ROUNDING_SAFETY * EPS * ulps
        errors = (SAFETY * apart + own) * sensitivity + rounding + also
        matrix_error = SAFETY * np.maximum(np.abs(A - check), apart * scale) + own * scale
        if given is not None:
            alone, share = given
            of_P = share * np.sum(np.abs(p))
            errors[1:] += np.minimum(characteristic_polynomial(A, alone)[1], of_P)[1:]
            matrix_error = matrix_error + np.minimum(alone, share * scale)
    if not (np.all(np.isfinite(errors)) and np.all(np.isfinite(matrix_error))):
        raise OverflowError(OVERFLOW)
    return Bounded(p, errors, matrix_error)


def largest_share(difference: Float, scale: Float) -> float:
    """The largest difference over its scale, where there is one."""
    return float(np.max(np.divide(difference, scale, out=np.zeros_like(scale), where=scale > 0.0)))


def moved_by_data(F: Float, x: Float, shift: Float) -> tuple[Float, Float]:
    """How far P moves, over its size, with the data of x F - shift.

    A square w^2 moves by what l dF r says, l and r the eigenvectors of F, and cos 2 pi w by at most
    pi/w times that, or 2 pi^2.

    Parameters
    ----------
    F : (n, n) or (k, n, n) ndarray
    x, shift : (k,) ndarray
        1/Omega^2 and eta^2/(4 Omega^2).

    Returns
    -------
    rounding : (k,) ndarray
        Per unit of relative rounding of the terms.
    every : (k,) ndarray
        Per unit of change in every element of a matrix over Omega^2. Both are infinite where F is
        defective to the last bit.
    """
    F = F if F.ndim == 3 else F[None]
    values, right = np.linalg.eig(F)
    try:
        left = np.abs(np.linalg.inv(right))
    except np.linalg.LinAlgError:
        return np.full(len(x), np.inf), np.full(len(x), np.inf)
    right = np.abs(right)
    of_F = np.einsum("kij,kjl,kli->ki", left, np.abs(F), right) * x[:, None]
    of_shift = np.einsum("kij,kji->ki", left, right) * shift[:, None]
    of_every = left.sum(axis=2) * right.sum(axis=1)
    w = np.sqrt(np.abs(values * x[:, None] - shift[:, None]))
    moved = np.pi / np.maximum(w, 0.5 / np.pi)
    return np.sum(moved * (of_F + of_shift), axis=1), np.sum(moved * of_every, axis=1)


def moved_by_diagonal(F: Float, change: Float, shift: float, Omega: float) -> float:
    """How far P moves, over its size, with the diagonal of F - shift, as `moved_by_data`.

    Infinite where F is defective.
    """
    values, right = np.linalg.eig(F)
    try:
        left = np.abs(np.linalg.inv(right))
    except np.linalg.LinAlgError:
        return float("inf")
    w = np.sqrt(np.abs(values - shift)) / Omega
    of_change = left @ (change[:, None] * np.abs(right)) / Omega**2
    return float(np.sum(np.pi / np.maximum(w, 0.5 / np.pi) * np.diag(of_change)))


def amplitudes(Phi: Float, fastest: float) -> Float:
    """Sizes of what swings: an element near a zero of its phase has been larger a moment before.

    Positions are as large as the velocities over the fastest rate at least, velocities no larger
    than positions times it.
    """
    n = len(Phi) // 2
    moduli = np.abs(Phi)
    positions = np.maximum(moduli[:n], moduli[n:] / fastest)
    return np.vstack([positions, np.maximum(moduli[n:], moduli[:n] * fastest)])
