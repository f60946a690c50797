"""The state once a period, by powers of the monodromy matrix, and how far that is known.

In a basis in which that matrix is diagonal, or nearly, an error is multiplied each period by what
the motion is multiplied by: it grows in step with it, and by what the matrix is off each period.
In the coordinates as given bounds by moduli would grow without end where the motion does not.

The first 2^k states give the next 2^k by one power, which is the square of the one before.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import schur

from floquet.arrays import EPS, Complex, Float

# Multipliers nearer than this, over the largest, are left together: where two meet they have one
# eigenvector between them. 0 is every one by itself, infinity a Schur form.
NEAR = (0.0, 1e-5, 1e-2, np.inf)

# What is left of a state that underflows, over the first one.
UNDERFLOW = 1e-300

# Of the inverse of a basis; no bound on a worse one is of use.
WORST_DEFECT = 0.5


@dataclass(frozen=True, eq=False)
class Basis:
    """The monodromy matrix in a basis, x = X y.

    Attributes
    ----------
    X : (m, m) complex ndarray
    inverse, inverse_error : (m, m) ndarray
        Of X.
    power, error : (m, m) ndarray
        X^-1 Phi X, and a bound on what it is off.
    """

    X: Complex
    inverse: Complex
    inverse_error: Float
    power: Complex
    error: Float


@dataclass(frozen=True, eq=False)
class Strobes:
    """States after 0, 1, 2, ... periods in the coordinates of a basis.

    Attributes
    ----------
    X : (m, m) complex ndarray
        The basis; the state is the real part of X y.
    y : (k, m) complex ndarray
    error : (k, m) ndarray
        Bounds on the moduli of what y is off.
    """

    X: Complex
    y: Complex
    error: Float


def strobes(Phi: Float, error: Float, x: Float, periods: int) -> Strobes:
    """Powers of Phi, known within `error`, times x: as many as a float can hold.

    Parameters
    ----------
    Phi, error : (m, m) ndarray
    x : (m,) ndarray
        Near 1 in size.
    periods : int
    """
    basis = _best(Phi, error, periods)
    m, count = len(x), periods + 1
    y, e = np.empty((count, m), complex), np.empty((count, m))
    y[0] = basis.inverse @ x
    rounding = _ulps(m) * np.abs(basis.inverse) @ np.abs(x)
    e[0] = basis.inverse_error @ np.abs(x) + rounding
    B, E, known = basis.power, basis.error, 1
    with np.errstate(over="ignore", invalid="ignore"):
        while known < count:
            more = min(known, count - known)
            size, last = np.abs(B), np.abs(y[:more])
            y[known : known + more] = y[:more] @ B.T
            moved = e[:more] @ (size + E).T + last @ (E + _ulps(m) * size).T
            e[known : known + more] = moved + UNDERFLOW
            known += more
            if known < count:
                B, E = _squared(B, E)
    # all that follows what is too large is too large
    finite = np.all(np.isfinite(y), axis=1)
    held = count if np.all(finite) else int(np.argmin(finite))
    return Strobes(basis.X, y[:held], np.where(np.isnan(e[:held]), np.inf, e[:held]))


def _best(Phi: Float, error: Float, periods: int) -> Basis:
    """The basis in which the highest power is known best."""
    found = [b for near in NEAR if (b := _basis(Phi, error, near)) is not None]
    return min(found, key=lambda b: _unsure(b, periods))


def _unsure(b: Basis, periods: int) -> float:
    """What the power near the last is off, over the growth of the motion."""
    size = max(float(np.max(np.abs(np.diag(b.power)))), np.finfo(float).tiny)
    B, E = b.power / size, b.error / size
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(periods.bit_length()):
            B, E = _squared(B, E)
        unsure = float(np.max(np.abs(b.X) @ E @ np.abs(b.inverse)))
    return unsure if np.isfinite(unsure) else np.inf


def _squared(B: Complex, E: Float) -> tuple[Complex, Float]:
    size = np.abs(B)
    return B @ B, size @ E + E @ (size + E) + _ulps(len(B)) * size @ size


def _basis(Phi: Float, error: Float, near: float) -> Basis | None:
    """The matrix in a basis of the invariant spaces of multipliers that are near each other."""
    m = len(Phi)
    X = _columns(Phi, near)
    try:
        W = np.linalg.inv(X)
    except np.linalg.LinAlgError:
        return None
    if not np.all(np.isfinite(W)):
        return None
    defect = np.abs(np.eye(m) - W @ X) + _ulps(m) * np.abs(W) @ np.abs(X)
    share = float(np.max(np.sum(defect, axis=1)))
    if not share < WORST_DEFECT:
        return None
    # X^-1 = (1 - D)^-1 W, D what W X is short of 1
    off = 1.01 * (defect + defect @ defect / (1.0 - share) * m)
    size = np.abs(W)
    within = size + off @ size
    B = W @ (Phi @ X)
    moved = error + _ulps(m) * np.abs(Phi)
    unsure = within @ (2.0 * moved @ np.abs(X)) + off @ np.abs(B)
    return Basis(X, W, off @ size, B, unsure)


def _columns(Phi: Float, near: float) -> Complex:
    values, vectors = np.linalg.eig(Phi)
    if near == 0.0:
        return vectors.astype(complex)
    if not np.isfinite(near):
        return np.asarray(schur(Phi, output="complex")[1])
    columns = []
    for group in _groups(values, near):

        def within(z: complex, group: list[int] = group) -> bool:
            return int(np.argmin(np.abs(values - z))) in group

        _, Q, size = schur(Phi, output="complex", sort=within)
        columns.append(Q[:, : len(group)] if size == len(group) else vectors[:, group])
    return np.hstack(columns).astype(complex)


def _groups(values: Complex, near: float) -> list[list[int]]:
    """Indices of values that are joined by short distances."""
    close = np.abs(values[:, None] - values) <= near * np.max(np.abs(values))
    left, groups = list(range(len(values))), []
    while left:
        group = [left.pop(0)]
        for i in group:
            for j in [j for j in left if close[i, j]]:
                group.append(j)
                left.remove(j)
        groups.append(group)
    return groups


def _ulps(m: int) -> float:
    """Of a product of complex matrices, over that of the moduli."""
    return 4.0 * (m + 2) * EPS
