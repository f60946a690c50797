"""A Hill equation in balls, from the floats' exact values on.

In theta = Omega tau, and for a damping that is one number in u = exp(eta tau/2) q,

    u'' + D u' + (K + sum_p M_p cos p theta) u = 0.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb, arb_mat, fmpq


@dataclass(frozen=True, eq=False)
class Problem:
    """The equation above.

    Attributes
    ----------
    K : (n, n) arb_mat
    pulses : tuple of (int, arb_mat)
        Each (p, M_p).
    D : arb_mat or None
        None where there is no such term.
    """

    K: Any
    pulses: tuple[tuple[int, Any], ...]
    D: Any | None

    @property
    def n(self) -> int:
        """Coordinates."""
        return int(self.K.nrows())


def exact(matrix: Any) -> Any:
    """Floats as balls of radius zero."""
    rows = np.atleast_2d(np.asarray(matrix, float))
    return arb_mat(*rows.shape, [arb(float(x)) for x in rows.ravel()])


def number(value: Any) -> Any:
    """A fraction, a float or a ball, as a ball."""
    if isinstance(value, Fraction):
        return arb(fmpq(value.numerator, value.denominator))
    return arb(value)


def identity(n: int) -> Any:
    """The unit matrix."""
    return exact(np.eye(n))


def norm(matrix: Any) -> float:
    """Upper bound on the largest row sum of moduli."""
    return 1.0001 * max(sum(float(x.abs_upper()) for x in row) for row in matrix.tolist())


def problem(equation: Any) -> Problem:
    """The equation, read as data, at the precision of the moment."""
    Omega = arb(float(equation.Omega))
    per = 1 / Omega**2
    pulses = [(1, exact(equation.G) * (arb(float(equation.gamma)) * per))]
    for s, H in enumerate(equation.H, start=1):
        pulses.append((s * round(equation.omega_L / equation.Omega), exact(H) * per))
    F = exact(equation.F)
    if np.ndim(equation.eta) > 0:
        return Problem(F * per, tuple(pulses), exact(equation.eta) / Omega)
    eta = arb(float(equation.eta))
    return Problem((F - identity(len(equation.F)) * (eta * eta / 4)) * per, tuple(pulses), None)
