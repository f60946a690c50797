r"""How far a matrix that is linear in one number may be moved before an eigenvalue crosses a line.

With the eigenvectors V of A, the eigenvalues of A + d B are those of S + d W, W = V^-1 B V. By
Gershgorin one alone is in the disc about s_i + d W_ii whose radius is the row's sum, where that
disc meets no other. A row may be scaled by any a, its disc shrinks by a, and what it adds to the
others grows by 1/a. So the discs of eigenvalues that are apart move like d and widen like d^2 only.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hill.arrays import Complex, Float, frozen

Booleans = NDArray[np.bool_]

# Distances that are tried, over the one asked about, the largest first.
SHARES = frozen(2.0 ** np.arange(3.0, -13.0, -1.0))


@dataclass(frozen=True, eq=False)
class Moved:
    """S + d W of a matrix, and what rounding leaves beside it.

    Attributes
    ----------
    values : (n,) ndarray
        S; complex where one of them is.
    speed : (n, n) ndarray
        W.
    rest : (n, n) ndarray
        Sizes of the elements of V^-1 A V - S.
    """

    values: Complex
    speed: Complex
    rest: Float

    @classmethod
    def of(cls, matrix: Float, slope: Float) -> "Moved":
        """Of ``matrix + d slope``."""
        values, V = np.linalg.eig(matrix)
        both = np.linalg.solve(V, np.hstack([matrix @ V, slope @ V]))
        at, speed = np.hsplit(both, 2)
        return cls(values, speed, np.abs(at - np.diag(values)))

    def stays_positive(self, reach: float) -> float:
        """A distance within which every eigenvalue is real and positive; 0 where none is shown.

        Up to eight times `reach`.
        """
        if np.iscomplexobj(self.values) or not np.all(self.values > 0.0):
            return 0.0
        for h in SHARES * reach:
            radius, alone = self._discs(float(h))
            radius += h * np.abs(np.diag(self.speed))
            # of a real matrix one alone is real
            if np.all(alone) and np.all(self.values - radius > 0.0):
                return float(h)
        return 0.0

    def stays_left(self, reach: float) -> float:
        """A distance within which every real part is negative; 0 where none is shown.

        Up to eight times `reach`.
        """
        if not np.all(self.values.real < 0.0):
            return 0.0
        for h in SHARES * reach:
            radius, alone = self._discs(float(h))
            # alone or not, all are in the discs of rows as they are
            whole = h * np.abs(self.speed - np.diag(np.diag(self.speed))).sum(axis=1)
            whole += self.rest.sum(axis=1)
            centre = self.values.real + h * np.abs(np.diag(self.speed).real)
            for size in (np.where(alone, radius, np.inf), whole):
                if np.all(centre + size < 0.0):
                    return float(h)
        return 0.0

    def _discs(self, h: float) -> tuple[Float, Booleans]:
        """Radii of the scaled discs for distances up to h, and which are alone in theirs."""
        off = h * np.abs(self.speed) + self.rest
        np.fill_diagonal(off, 0.0)
        row = off.sum(axis=1)
        centre = np.diag(self.speed)
        apart = np.abs(self.values[:, np.newaxis] - self.values)
        # what is left between two for the scaled disc, and for what it adds to the other's
        room = apart - h * np.abs(centre[:, np.newaxis] - centre) - row
        room -= np.diag(self.rest)[:, np.newaxis] + np.diag(self.rest)
        np.fill_diagonal(room, np.inf)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 2.0 * np.max(np.where(room > 0.0, off.T / room, np.inf), axis=1)
            radius = np.where(row > 0.0, scale * row, 0.0)
            alone = np.all(room > 0.0, axis=1) & (2.0 * radius < np.min(room, axis=1))
        return np.diag(self.rest) + radius, alone
