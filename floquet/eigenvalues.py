"""Discs that hold the eigenvalues of a matrix which is known to within an error."""

from dataclasses import dataclass

import numpy as np

from floquet.arrays import EPS, Bool, Complex, Float, frozen

RADII = frozen(2.0 ** np.arange(-54.0, 3.5, 0.5))
"""Radii tried about an eigenvalue, in units of 1 + its modulus."""


@dataclass(frozen=True, eq=False)
class Discs:
    """Discs about computed eigenvalues.

    Attributes
    ----------
    centre : (n,) complex ndarray
        By descending real part.
    radius : (n,) ndarray
        Where nothing better is known, of a disc about the centre that holds all of them.
    together : (n, n) bool ndarray
        Which discs form one region; it holds as many true eigenvalues as it has discs.
    """

    centre: Complex
    radius: Float
    together: Bool

    @property
    def real(self) -> Bool:
        """Which hold one eigenvalue alone, that is real as the matrix is."""
        return (self.centre.imag == 0.0) & (np.sum(self.together, axis=1) == 1)


def sorted_eigenvalues(A: Float) -> Complex:
    """Computed eigenvalues, by descending real part."""
    values = np.linalg.eigvals(A).astype(complex)
    return values[np.lexsort((values.imag, -values.real))]


def discs_from_matrix(A: Float, error: Float) -> Discs:
    """Discs from the matrix itself: Gershgorin's, in the basis of its eigenvectors.

    With X the computed eigenvectors and W their inverse, |W| (|A X - X L| + error |X|) bounds what
    X^-1 A' X - L can be for every A' within `error` of A. As good for eigenvalues that meet with
    eigenvectors of their own as for simple ones; useless near a defective one.
    """
    values, apart = beside_diagonal(A, error)
    # a norm of A bounds every eigenvalue
    everything = 1.01 * float(np.max(np.sum(np.abs(A) + error, axis=1))) + np.abs(values)
    if apart is None:
        return Discs(values, everything, np.ones(A.shape, bool))
    radius = np.minimum(np.sum(apart, axis=1), everything)
    between = np.abs(values[:, None] - values)
    return Discs(values, radius, connected(between <= radius[:, None] + radius))


def beside_diagonal(A: Float, error: Float) -> tuple[Complex, Float | None]:
    """Computed eigenvalues, and bounds on the elements of X^-1 A' X - L, where there are any.

    X are the computed eigenvectors, A' is any matrix within `error` of A.
    """
    n = len(A)
    values, X = np.linalg.eig(A)
    order = np.lexsort((values.imag, -values.real))
    values, X = values[order].astype(complex), X[:, order]
    try:
        W = np.linalg.inv(X)
    except np.linalg.LinAlgError:
        return values, None
    rounding = 4.0 * (n + 2) * EPS
    size_W, size_X = np.abs(W), np.abs(X)
    summed = np.abs(A) @ size_X + size_X * np.abs(values)
    residual = np.abs(A @ X - X * values) + rounding * summed
    apart = size_W @ (residual + error @ size_X)
    # W is the inverse but for this much
    defect = float(np.max(np.sum(np.abs(W @ X - np.eye(n)) + rounding * (size_W @ size_X), axis=1)))
    if not defect < 0.5:
        return values, None
    return values, 1.01 * (apart + defect / (1.0 - defect) * np.max(apart, axis=0))


def discs_from_polynomial(values: Complex, p: Float, errors: Float) -> Discs:
    """Discs about eigenvalues from the characteristic polynomial and the error of each coefficient.

    Where on a circle about a root the computed polynomial exceeds all that its error can amount to,
    no root crosses the circle while the error grows from nothing to all of it (Rouche): each true
    root is in the disc about its own computed one, also in a cluster.

    Parameters
    ----------
    values : (n,) complex ndarray
    p, errors : (n + 1,) ndarray
        Monic, highest power first.
    """
    n = len(values)
    size = 1.0 + np.abs(values)
    with np.errstate(over="ignore", invalid="ignore"):
        # values are the roots of a polynomial that is not quite p
        again, moduli = _from_roots(values), _from_roots(-np.abs(values))
        unsure = errors + np.abs(p - again) + 4.0 * n * EPS * np.abs(moduli)
        unsure[0] = 0.0
        radii = RADII * size[:, None]
        apart = np.abs(values[:, None] - values)
        gap = np.abs(apart[:, None, :] - radii[:, :, None])
        gap -= 4.0 * EPS * (size[:, None] + size)[:, None, :]
        farthest, moved = np.abs(values)[:, None] + radii, np.zeros_like(radii)
        for coefficient in unsure:
            moved = moved * farthest + coefficient
        clear = np.prod(np.maximum(gap, 0.0), axis=2) > 1.01 * moved
    # Cauchy: every root is within 1 + max |p_k|
    everything = 1.0 + float(np.max(np.abs(p[1:]) + errors[1:])) + size
    radius = np.where(clear.any(axis=1), radii[np.arange(n), clear.argmax(axis=1)], everything)
    # a circle that holds no other computed root holds no other true one
    return Discs(values, radius, (apart <= radius[:, None]) | np.eye(n, dtype=bool))


def _from_roots(values: Complex | Float) -> Float:
    """Coefficients of prod (x - z_j), real as the roots of a real matrix come in pairs."""
    p = np.zeros(len(values) + 1, complex)
    p[0] = 1.0
    for j, value in enumerate(values, start=1):
        p[1 : j + 1] -= value * p[:j]
    return p.real


def connected(together: Bool) -> Bool:
    """What hangs together, directly or through others."""
    for _ in range(int(np.ceil(np.log2(len(together) + 1)))):
        together = together @ together
    return np.asarray(together | np.eye(len(together), dtype=bool))
