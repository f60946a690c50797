r"""A corner of Hill's infinite matrix, with what solves it about one exponent.

With q = exp(lambda t) sum_m q_m exp(i m Omega t) the harmonics obey, for every m,

.. math::

   (s_m^2 + s_m C_0 + K_0) q_m + \sum_{k \ne 0} (s_{m-k} C_k + K_k) q_{m-k} = 0,
   \qquad s_m = \lambda + i m \Omega .

In the states (q_m, v_m) that is (H - lambda) x = 0 with a constant H. An equation of first order
has s_m q_m - sum A_k q_(m-k) = 0, and no v.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg.lapack import zgbtrf, zgbtrs, zgetrf, zgetrs

from hill.arrays import Complex
from hill.errors import Refused
from hill.periodic import Fourier, PeriodicEquation

# A matrix that is wider than its half band by this factor is eliminated by the band: its own
# storage is that of three half bands, which its filling costs a small matrix more than it saves.
NARROW = 4


@dataclass(frozen=True, eq=False)
class Corner:
    """Harmonics of an equation from one to another.

    Attributes
    ----------
    equation : PeriodicEquation
    low, high : int
    """

    equation: PeriodicEquation
    low: int
    high: int

    @property
    def n(self) -> int:
        """Coordinates."""
        e = self.equation
        return e.A.n if e.A is not None else e.order // 2

    @property
    def of_first_order(self) -> bool:
        """Whether the states are the coordinates alone."""
        return self.equation.A is not None

    @cached_property
    def harmonics(self) -> Any:
        """M of every row, (n * harmonics,)."""
        return np.repeat(np.arange(self.low, self.high + 1), self.n)

    @cached_property
    def stiffness(self) -> Complex:
        """K_(m-m') in block (m, m'); -A of an equation of first order."""
        e = self.equation
        return -self._toeplitz(e.A) if e.A is not None else self._toeplitz(e.K)

    @cached_property
    def damping(self) -> Complex:
        """C_(m-m') in block (m, m')."""
        return self._toeplitz(self.equation.C)

    def _toeplitz(self, matrix: Fourier | None) -> Complex:
        assert matrix is not None
        M = self.equation.M
        terms: dict[int, Complex] = {0: matrix.mean + 0j}
        for parts, unit in ((matrix.cos, 0.5), (matrix.sin, -0.5j)):
            for k, part in parts.items():
                for p, factor in ((k, unit), (-k, np.conj(unit))):
                    terms[p] = np.asarray(terms.get(p, 0.0) + factor * part)
        count, n = self.high - self.low + 1, self.n
        whole = np.zeros((count, n, count, n), complex)
        for p, term in terms.items():
            over = term if M is None else np.linalg.solve(M, term)
            for m in range(max(p, 0), min(count + p, count)):
                whole[m, :, m - p] = over
        return whole.reshape(count * n, count * n)

    def state(self, vector: Complex, harmonic: int) -> Complex:
        """A steady state's vector, in one harmonic of this corner."""
        n, count = self.n, self.high - self.low + 1
        found = np.zeros((len(vector) // n, count, n), complex)
        found[:, harmonic - self.low] = vector.reshape(-1, n)
        return found.ravel()

    def widened(self, block: Complex) -> Complex:
        """Columns of states of a smaller corner about the same harmonics, 0 in the others."""
        n, count, columns = self.n, self.high - self.low + 1, block.shape[1]
        parts = 1 if self.of_first_order else 2
        inner = block.reshape(parts, -1, n, columns)
        found = np.zeros((parts, count, n, columns), complex)
        beyond = (count - inner.shape[1]) // 2
        found[:, beyond : count - beyond] = inner
        return found.reshape(-1, columns)

    @cached_property
    def band(self) -> int:
        """Diagonals on either side of the matrix's own beyond which all elements are 0."""
        e = self.equation
        parts = [e.A] if e.A is not None else [e.K, e.C]
        farthest = max((k for part in parts if part for k in part.harmonics), default=0)
        return int((farthest + 1) * self.n - 1)

    @property
    def Omega_m(self) -> Any:
        """M Omega of every row, a column."""
        return (self.equation.Omega * self.harmonics)[:, None]

    def about(self, exponent: complex) -> "Inverse":
        """What applies (H - exponent)^-1."""
        s = exponent + 1j * self.Omega_m
        if self.of_first_order:
            matrix = np.diag(s[:, 0]) + self.stiffness
        else:
            matrix = np.diag(s[:, 0] ** 2) + self.damping * s[:, 0] + self.stiffness
        return Inverse(self, s, _eliminated(matrix, self.band, exponent))


Solve = Callable[[Complex], Complex]


def _eliminated(matrix: Complex, band: int, exponent: complex) -> Solve:
    """What solves with a matrix, by its band where that is narrower; of several columns."""
    size = len(matrix)
    if NARROW * band < size:
        diagonals = np.zeros((3 * band + 1, size), complex)
        for d in range(-band, band + 1):
            diagonals[2 * band - d, max(d, 0) : size + min(d, 0)] = matrix.diagonal(d)
        factors, pivots, singular = zgbtrf(diagonals, band, band, overwrite_ab=True)

        def solve(column: Complex) -> Complex:
            return np.asarray(zgbtrs(factors, band, band, column, pivots)[0])
    else:
        factors, pivots, singular = zgetrf(matrix, overwrite_a=True)

        def solve(column: Complex) -> Complex:
            return np.asarray(zgetrs(factors, pivots, column)[0])

    if singular:
        raise Refused(f"an exponent is {exponent:g} to the last bit")
    # column by column: a library of several threads wakes them for two, a hundred times slower
    return lambda load: np.stack([solve(x) for x in np.atleast_2d(load.T)], axis=1)


@dataclass(frozen=True, eq=False)
class Inverse:
    """(H - exponent)^-1 of a corner, by the elimination of the velocities."""

    corner: Corner
    s: Complex
    solve: Solve

    def right(self, x: Complex) -> Complex:
        """(H - exponent)^-1 x."""
        if self.corner.of_first_order:
            return -self.solve(x)
        f, g = np.split(x, 2)
        load = g + self.s * f + self.corner.damping @ f
        q = -self.solve(load)
        return np.concatenate([q, f + self.s * q])
