"""How large P's coefficients can be where 1/Omega and gamma are complex.

In theta = Omega tau, with s = 1/Omega and eta^2/4 taken from F, the equation is

    u'' + s^2 (F + gamma cos theta G) u = 0.

With F = V (W^2 + E) V^-1, W a diagonal of positive numbers and E what it leaves, v = V^-1 u and the
state (v', |s| W v), the right-hand side has the Hermitian part

    (1/2) [0 B; B* 0],  B = |s| W - (s^2/|s|) (W + (E + gamma cos theta V^-1 G V) W^-1).

Its j largest eigenvalues sum to half of B's trace norm at most; the modulus of |s| - s^2/|s| is
2 |Im s|. The j-th compound of the solution grows no faster than that sum says, so over the period,
|cos theta| having the integral 4, every minor of the monodromy matrix is at most

    exp(2 pi |Im s| tr W + |s| (pi |E W^-1| + 2 |gamma| |V^-1 G V W^-1|)),

in trace norms. The j-th coefficient of P is the sum of C(n, j) principal minors of the block whose
eigenvalues are z.
"""

from dataclasses import dataclass
from functools import reduce
from math import comb, log, pi
from operator import add
from typing import Any

import numpy as np
from flint import arb

from floquet.enclosure.balls import exact

SAFE = 1.0 + 1e-9
"""Times what floats make of the bound: a few roundings of 1e-16."""


@dataclass(frozen=True)
class Bound:
    """The numbers of the bound.

    Attributes
    ----------
    n : int
    swing : float
        tr W.
    left, pulsating : float
        Trace norms of E W^-1 and of V^-1 G V W^-1.
    """

    n: int
    swing: float
    left: float
    pulsating: float

    def log(self, s: float, imaginary: float, gamma: float) -> float:
        """Logarithm of a bound on all coefficients where |s|, |Im s| and |gamma| are no more."""
        grown = 2.0 * pi * imaginary * self.swing
        grown += s * (pi * self.left + 2.0 * gamma * self.pulsating)
        return SAFE * (grown + log(comb(self.n, self.n // 2)))


def bound_on(F: Any, G: Any) -> Bound:
    """Of matrices in balls.

    Raises
    ------
    ValueError
        F's eigenvalues are not real and positive: with T0 at buckling, say.
    """
    squares, V = np.linalg.eig(_floats(F))
    if np.any(squares.imag) or not np.all(squares.real > 0.0):
        raise ValueError(
            "F: must have real, positive eigenvalues, that is natural frequencies without growth; "
            f"has {', '.join(f'{x:.4g}' for x in squares)}"
        )
    w = np.sqrt(squares.real)
    into, W = exact(V.real), exact(np.diag(w))
    left, over = into.solve(F * into) - W * W, W.inv()
    return Bound(
        n=len(w),
        swing=SAFE * float(np.sum(w)),
        left=_trace_norm(left * over),
        pulsating=_trace_norm(into.solve(G * into) * over),
    )


def _floats(matrix: Any) -> Any:
    return np.array([[float(x) for x in row] for row in matrix.tolist()])


def _trace_norm(matrix: Any) -> float:
    """An upper bound: a matrix is the sum of its columns, of rank one each, and of its rows."""
    sums = []
    for lines in (matrix.tolist(), matrix.transpose().tolist()):
        lengths = (reduce(add, (arb(x.abs_upper()) ** 2 for x in line)).sqrt() for line in lines)
        sums.append(float(reduce(add, lengths).upper()))
    return SAFE * min(sums)
