"""P(z) of general equations whose multipliers come in pairs, mu and r^2/mu, r = exp(-pi eta/Omega).

Over r their polynomial reads the same from both ends, and mu^-n P(mu) is one of
z = (mu/r + r/mu)/2: the sum of mu^k and mu^-k is 2 T_k(z), Chebyshev's.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import cheb2poly
from numpy.typing import NDArray

from hill import PeriodicEquation
from hill.symmetry import damping_of_pairs

Float = NDArray[np.floating[Any]]
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Folded:
    """P(z) of several equations.

    Attributes
    ----------
    coefficients : (k, n + 1) float ndarray
        Monic, highest power first.
    errors : (k,) float ndarray
        Bound on the absolute error of every coefficient.
    """

    coefficients: Float
    errors: Float


def has_pairs(equation: PeriodicEquation, eta: float) -> bool:
    """Whether an equation has them at exactly this eta."""
    return equation.order % 2 == 0 and damping_of_pairs(equation) == Fraction(eta)


def folded(
    polynomials: Callable[[Sequence[Any]], Any], equations: Sequence[PeriodicEquation]
) -> Folded:
    """P(z) of equations that have pairs, from a route's polynomials of their multipliers."""
    found = polynomials(equations)
    decay = np.array([float(damping_of_pairs(e) or 0) * np.pi / e.Omega for e in equations])
    m = found.coefficients.shape[1] - 1
    with np.errstate(over="ignore", invalid="ignore"):
        over = np.exp(np.outer(decay, np.arange(m + 1)))
        P, errors = found.coefficients * over, found.errors[:, None] * over
    errors += EPS * (2.0 + m * np.abs(decay))[:, None] * np.abs(P)
    # either end says the same
    P, errors = 0.5 * (P + P[:, ::-1]), 0.5 * (errors + errors[:, ::-1])
    P[:, 0], errors[:, 0] = 1.0, 0.0
    n = m // 2
    to_powers = _to_powers(n)
    P, errors = P[:, : n + 1], errors[:, : n + 1]
    rounding = 2.0 * n * EPS * np.abs(P) @ np.abs(to_powers).T
    bound = errors @ np.abs(to_powers).T + rounding
    return Folded(P @ to_powers.T, np.max(bound[:, 1:], axis=1))


def _to_powers(n: int) -> Float:
    """From coefficients of mu^(n - k) + mu^(k - n), k = 0 .. n, to those of z^n .. z^0, monic."""
    columns = []
    for k in range(n, -1, -1):
        chebyshev = np.zeros(n + 1)
        chebyshev[k] = 2.0 if k else 1.0
        powers = cheb2poly(chebyshev)
        columns.append(np.pad(powers, (0, n + 1 - len(powers)))[::-1] / 2.0**n)
    return np.array(columns).T
