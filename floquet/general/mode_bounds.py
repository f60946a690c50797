"""Bounds on the multipliers of a product of factors that are nearly diagonal in some bases.

Factor k is D_k + E_k there, with a bound on the moduli of E_k that counts what the factors are off.

* One by one: the coordinates c_k of an eigenvector near the i-th are y_j = c_j/c_i times it, and
  go round the period as y_j -> (d_j/d_i) y_j + g, where g is small, of E and y. That has one
  periodic solution for each periodic g, as mu_j/mu_i is not 1, and if all y within some bounds lead
  to new ones within them, there is an eigenvector there (Brouwer). Its multiplier is the product of
  d_i + sum_j E_ij y_j. Where all bounds are so small that the eigenvectors are independent, these
  are all multipliers.
* By rows: let all D_k be the same D and v_k the steps of an eigenvector, l v_k = (D + E_k) v_(k-1)
  with l^p = mu. Where row i of some v_k is the largest of all elements, ||l| - |d_i|| <= r_i, the
  largest row sum of |E_k|, and going round once |mu - d_i^p| <= p r_i (|d_i| + r_i)^(p-1). This is
  Gershgorin's theorem for p = 1; it bears multipliers that meet.
"""

from dataclasses import dataclass

import numpy as np

from floquet.arrays import EPS, Complex, Float
from floquet.eigenvalues import Discs, beside_diagonal, connected
from floquet.growth import LogDiscs

# Rounds in which the bounds of an eigenvector settle; each adds a power of what is small.
MAX_ROUNDS = 30

# The bounds are widened by this much before they are tried.
WIDENED = 1.01


@dataclass(frozen=True, eq=False)
class NearlyDiagonal:
    """Factors in bases of columns of length 1.

    Attributes
    ----------
    value : (m,) complex ndarray
        ln of the product of the d of each mode.
    d : (p, m) complex ndarray
    off : (p, m, m) ndarray
        Bound on the moduli of E_k.
    growth : (p, m) ndarray
        ln of how long a column would be with the same d in all factors.
    """

    value: Complex
    d: Complex
    off: Float
    growth: Float


def nearly_diagonal(
    factors: Float, errors: Float, bases: Complex, value: Complex
) -> NearlyDiagonal | None:
    """The factors in given bases; None where these are none.

    Parameters
    ----------
    factors, errors : (p, m, m) ndarray
    bases : (p, m, m) complex ndarray
        X_k, with P_k X_(k-1) = X_k D nearly, the same D for all.
    value : (m,) complex ndarray
        ln of D^p.
    """
    p, m = factors.shape[:2]
    length = np.linalg.norm(bases, axis=1)
    if not (np.all(np.isfinite(bases)) and np.all(length > 0.0) and np.all(np.isfinite(value))):
        return None
    X = bases / length[:, None, :]
    d = np.exp(value / p) * length / np.roll(length, 1, axis=0)
    try:
        inverse = np.linalg.inv(X)
    except np.linalg.LinAlgError:
        return None
    before, W = np.roll(X, 1, axis=0), np.abs(inverse)
    rounding = 4.0 * (m + 2) * EPS
    summed = np.abs(factors) @ np.abs(before) + np.abs(X) * np.abs(d)[:, None, :]
    residual = np.abs(factors @ before - X * d[:, None, :])
    apart = W @ (residual + rounding * summed + errors @ np.abs(before))
    # W is the inverse but for this much
    gone = np.abs(inverse @ X - np.eye(m)) + rounding * (W @ np.abs(X))
    defect = np.max(np.sum(gone, axis=2), axis=1)
    if not np.all(defect < 0.5):
        return None
    apart += (defect / (1.0 - defect))[:, None, None] * np.max(apart, axis=1)[:, None, :]
    return NearlyDiagonal(value, d, 1.01 * apart, np.log(length))


def one_by_one(modes: NearlyDiagonal) -> LogDiscs | None:
    """Each multiplier by its own eigenvector; None where some may not have one."""
    p, m = modes.d.shape
    size = np.abs(modes.d)
    # of row i, column j: mode j in the eigenvector near mode i
    other = np.eye(m) == 0.0
    ratio = size[:, None, :] / size[:, :, None]
    period = modes.value - modes.value[:, None]
    rounding = 8.0 * (p + m) * EPS * (1.0 + np.abs(period))
    turn = np.exp(np.minimum(period.real, 0.0) + 1j * period.imag)
    back = np.exp(-np.maximum(period.real, 0.0))
    # |1 - mu_j/mu_i|, over |mu_j/mu_i| where that is large
    gap = np.where(other, np.abs(turn - back) - rounding, np.inf)
    if not np.all(gap > 0.0):
        return None
    Y = np.zeros((p, m, m))
    for _ in range(MAX_ROUNDS):
        tried = WIDENED * Y + np.eye(m)
        before = np.roll(tried, 1, axis=0)
        # sum_l |E_jl| |y_l|, over |d_i|
        moved = np.einsum("kjl,kil->kij", modes.off, before) / size[:, :, None]
        own = np.einsum("kii->ki", moved)
        if not np.all(own < 0.5):
            return None
        g = (moved + ratio * before * own[:, :, None]) / (1.0 - own)[:, :, None]
        new = _periodic(ratio, np.where(other, g, 0.0), period.real) / gap
        if not np.all(np.isfinite(new)):
            return None
        if np.all(new <= WIDENED * Y):
            if np.max(np.sum(new[0], axis=1)) >= 1.0:
                return None
            total = -np.sum(np.log1p(-own), axis=0) + 4.0 * p * EPS
            return _alone(modes.value, total)
        Y = new
    return None


def discs_one_by_one(A: Float, error: Float) -> Discs | None:
    """Discs about the eigenvalues of one matrix, each by its own eigenvector.

    To first order a disc has only what is in its own place on the diagonal, where Gershgorin's has
    a whole row: of many coordinates far less.

    Parameters
    ----------
    A, error : (n, n) ndarray
    """
    values, apart = beside_diagonal(A, error)
    if apart is None:
        return None
    # an eigenvalue near 0 is not known to a part of itself: all are moved away from it
    moved = values + 2.0 * (1.0 + np.max(np.abs(values)))
    nothing = np.zeros((1, len(values)))
    discs = one_by_one(NearlyDiagonal(np.log(moved), moved[None], apart[None], nothing))
    if discs is None:
        return None
    return Discs(values, discs.radius * np.abs(moved), discs.together)


def _periodic(ratio: Float, g: Float, whole: Float) -> Float:
    """Bounds on the periodic y with y -> ratio y + g, times `gap`, as the sum of a period's terms.

    Where the ratio grows over a period it is run backwards, y -> (y - g)/ratio.
    """
    p = len(g)
    forward = whole <= 0.0
    rest = -np.expm1(-np.abs(whole))
    found = np.empty_like(g)
    # what runs the other way may overflow, and is not used
    with np.errstate(over="ignore", invalid="ignore"):
        y, z = np.zeros_like(whole), np.zeros_like(whole)
        for k in range(p):
            y = ratio[k] * y + g[k]
        for k in reversed(range(p)):
            z = (z + g[k]) / ratio[k]
        for k in range(p):
            y = ratio[k] * y + g[k] * rest
            found[k] = np.where(forward, y, 0.0)
        for k in reversed(range(p)):
            # z is the one before factor k, that is after factor k - 1
            z = (z + g[k] * rest) / ratio[k]
            found[k - 1] = np.where(forward, found[k - 1], z)
    return found


def _alone(value: Complex, off: Float) -> LogDiscs:
    with np.errstate(over="ignore"):
        radius = np.expm1(off)
    return LogDiscs(value, radius, value.real - off, value.real + off, np.eye(len(off), dtype=bool))


def by_rows(modes: NearlyDiagonal) -> tuple[LogDiscs, ...]:
    """All multipliers by row sums, as they are and weighed so that all are alike."""
    p, m = modes.d.shape
    # columns as long as leaves the same d in all factors
    length = np.exp(modes.growth)
    off = np.max(modes.off * np.roll(length, 1, axis=0)[:, None, :] / length[:, :, None], axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = off / np.exp(modes.value.real / p)[:, None]
    if not np.all(np.isfinite(relative)):
        return ()
    sizes, vectors = np.linalg.eig(relative + EPS * np.max(relative) / m)
    weight = np.abs(vectors[:, np.argmax(np.abs(sizes))])
    shares = [np.sum(relative, axis=1)]
    if np.all(weight > 0.0):
        shares.append(relative @ weight / weight)
    return tuple(_discs(modes.value, share, p) for share in shares)


def _discs(value: Complex, share: Float, p: int) -> LogDiscs:
    with np.errstate(over="ignore", divide="ignore"):
        radius = p * share * np.exp((p - 1) * np.log1p(share))
        least = np.where(share < 1.0, value.real + p * np.log1p(-np.minimum(share, 1.0)), -np.inf)
    most = value.real + p * np.log1p(share)
    top = np.maximum(value.real[:, None], value.real)
    one, other = np.exp(value[:, None] - top), np.exp(value - top)
    with np.errstate(over="ignore", invalid="ignore"):
        reach = radius[:, None] * np.abs(one) + radius * np.abs(other)
        together = ~(np.abs(one - other) > reach)
    return LogDiscs(value, radius, least, most, connected(together))
