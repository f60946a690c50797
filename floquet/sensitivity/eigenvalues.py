"""How eigenvalues move, and where they have no derivative."""

from dataclasses import dataclass

import numpy as np

from floquet.accuracy import SAFETY
from floquet.arrays import EPS, Complex, Float
from floquet.sensitivity.matrices import MatrixGradient

# A step turns the fastest motion by up to 2.3 rad, over which a term that swings twice as fast
# averages to a third and hides what it is made of.
CANCELLATION = 4.0

# Roots are told apart, from each other and from an edge, at this many of the radii that the error
# of P leaves them. At the limit the eigenvectors are uncertain by a tenth.
APART = 8.0


@dataclass(frozen=True, eq=False)
class Roots:
    """The eigenvalues of a run's matrix, what they are called, and how far each may be off."""

    name: str
    values: Complex
    radius: Float

    def text(self, j: int) -> str:
        """One of them as a reader wants it."""
        value = self.values[j]
        return f"{self.name} = {value if value.imag else value.real:.9g}"


@dataclass(frozen=True, eq=False)
class EigenvalueGradients:
    """Flat gradients of some eigenvalues, and bounds on the moduli of their errors: (k, count)."""

    slope: Complex
    error: Float


def eigenvalue_gradients(
    run: MatrixGradient, check: MatrixGradient, roots: Roots, wanted: list[int], ulps: float
) -> EigenvalueGradients:
    """Gradients ``l dA r`` of the eigenvalues `wanted` of ``run.matrix``.

    Parameters
    ----------
    run, check : MatrixGradient
        The matrix twice.
    roots : Roots
        All its eigenvalues.
    wanted : list of int
        Which of them; of a conjugate pair the first or both.
    ulps : float
        Rounding of the integration, in ulps of the terms summed.

    Raises
    ------
    ValueError
        One of those wanted cannot be told apart from another: it has no derivative.
    """
    for j in wanted:
        _refuse_multiple(roots, j)
    here, there = _Basis(run, roots.values), _Basis(check, roots.values)
    pulled: dict[complex, tuple[Complex, Complex, Float]] = {}
    for j in wanted:
        z = complex(roots.values[j])
        if z.conjugate() in pulled:
            slope, other, size = pulled[z.conjugate()]
            pulled[z] = slope.conj(), other.conj(), size
        else:
            slope, size = here.gradient(j)
            pulled[z] = slope, there.gradient(j)[0], size
    slope, other, size = map(np.array, zip(*pulled.values(), strict=True))
    size *= CANCELLATION
    # first order: the eigenvectors turn by the error of A over the distance of the eigenvalues,
    # which adds what belongs to pairs of them; that is taken to be as large as the largest
    turn = here.mixing(EPS * ulps * run.scale)[wanted, None] * size.max(axis=0)
    return EigenvalueGradients(slope, SAFETY * np.abs(slope - other) + EPS * ulps * size + turn)


class _Basis:
    """Left and right eigenvectors of a run's matrix, in the order of `values`."""

    def __init__(self, run: MatrixGradient, values: Complex) -> None:
        found, right = np.linalg.eig(run.matrix)
        nearest = np.argmin(np.abs(values[:, None] - found), axis=1)
        left = np.linalg.inv(right)[nearest]
        right = right[:, nearest]
        balance = np.sqrt(np.linalg.norm(left, axis=1) / np.linalg.norm(right, axis=0))
        self.run, self.values = run, values
        self.left, self.right = left / balance[:, None], right * balance

    def gradient(self, j: int) -> tuple[Complex, Float]:
        """Flat gradient of eigenvalue j, and the sum of the moduli of its terms."""
        seed = np.outer(self.left[j], self.right[:, j])
        slope, size = self.run.pull(seed.real)
        if self.values[j].imag == 0.0:
            return slope.astype(complex), size
        imaginary, more = self.run.pull(seed.imag)
        return slope + 1j * imaginary, size + more

    def mixing(self, error: Float) -> Float:
        """How much of the other eigenvectors an error of the matrix mixes into each, (m,)."""
        # the library's own error is one of the whole matrix, and small elements feel it: measured
        diagonal = self.left @ self.run.matrix @ self.right
        lost = np.abs(self.left @ self.right - np.eye(len(self.values))).sum(axis=1)
        coupled = np.abs(self.left) @ error @ np.abs(self.right) + np.abs(diagonal)
        gap = np.abs(self.values[:, None] - self.values)
        np.fill_diagonal(gap, np.inf)
        return np.asarray(np.sum((coupled + coupled.T) / gap, axis=1) + lost)


def _refuse_multiple(roots: Roots, j: int) -> None:
    gap = np.abs(roots.values - roots.values[j])
    gap[j] = np.inf
    k = int(np.argmin(gap / (roots.radius + roots.radius[j])))
    known = roots.radius[j] + roots.radius[k]
    if gap[k] <= APART * known:
        raise ValueError(
            f"{roots.text(j)} and {roots.text(k)} are {gap[k]:.2g} apart and known to {known:.1g}: "
            "as good as a double root, which has no derivative"
        )


def leader(roots: Roots, least: Float, most: Float) -> int:
    """Index of the root of the largest growth; the first of a conjugate pair, which grows alike.

    Parameters
    ----------
    roots : Roots
    least, most : (m,) ndarray
        Between which the growth of each lies.

    Raises
    ------
    ValueError
        Another one may grow as much.
    """
    values = roots.values
    lead = int(np.argmax(least + most))
    twins = (values == values[lead]) | (values == values[lead].conj())
    rivals = np.flatnonzero(~twins & (most >= least[lead]))
    if len(rivals):
        raise ValueError(
            f"{roots.text(lead)} and {roots.text(int(rivals[0]))} tie for the largest growth as "
            "far as the error of P tells: T has no derivative there"
        )
    return int(np.flatnonzero(twins)[0])
