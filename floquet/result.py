"""What one period does to the state, and what follows from it."""

from dataclasses import dataclass

import numpy as np

from floquet.arrays import Complex, Float
from floquet.growth import Verdict
from hill.notebook import of_route


@dataclass(frozen=True, eq=False)
class Monodromy:
    """What one period does to (q, q'), or to x, and what follows from it.

    With a damping matrix, or for any `PeriodicEquation`, there is no z, and the polynomial is that
    of the m multipliers themselves.

    Attributes
    ----------
    matrix : (m, m) float ndarray
        Phi: the state at tau + 2 pi/Omega is Phi times the state at tau = 0; m = 2n for (q, q').
    multipliers : (m,) complex ndarray
        Eigenvalues of Phi, by descending modulus; one that is too small for a float is 0.
    exponents : (m,) complex ndarray
        ln mu over the period, in the same order, the imaginary part up to +-Omega/2.
    exponent_errors : (m,) float ndarray
        How far each is from a true one at most; infinite where nothing is known.
    polynomial : (n + 1,) or (m + 1,) float ndarray
        P(z) = det(z I - A), monic, highest power first; or det(mu I - Phi).
    errors : (n + 1,) or (m + 1,) float ndarray
        Bound on the absolute error of each coefficient of `polynomial`, for the equation's numbers
        to the last bit as they are given.
    matrix_error : (n, n) or (m, m) float ndarray
        Bound on the error of each element of A; or of `matrix`.
    data_error : float
        What the equation's own `data_error` may add to `errors`; 0 where it has none. An estimate
        with a safety factor, to first order: the rounding of 66 random beams moved P by .007 of it
        at most.
    z : (n,) complex ndarray
        cos 2 pi alpha, by descending real part; empty where there is none.
    T : float
        Characteristic argument (7.1.1): twice the largest growth exponent.
    T_error : float
        Bound on the error of `T` that `errors` and `matrix_error` allow.
    verdict : {"stable", "unstable", "undecided"}
        What is shown: all z real, simple and within (-1, 1), or decay; growth; or neither.
    liouville_defect : float
        `|det Phi / exp(-period tr C) - 1|`, or exp(period tr A), of the run that checks, which
        takes no symmetry for granted.
    reversibility_defect : float
        Largest element of (S Phi_u)^2 - I of that run, over the square of the largest of Phi_u;
        nan where there is no z.
    method : str
        The CasADi method.
    half_period : bool
        Whether reversibility was used.
    remark : str
        What of all this is known to less than nine digits, or not shown, in a sentence
        (`hill.precision`); empty where nothing is.
    """

    matrix: Float
    multipliers: Complex
    exponents: Complex
    exponent_errors: Float
    polynomial: Float
    errors: Float
    matrix_error: Float
    data_error: float
    z: Complex
    T: float
    T_error: float
    verdict: Verdict
    liouville_defect: float
    reversibility_defect: float
    method: str
    half_period: bool
    remark: str

    @property
    def error(self) -> float:
        """Bound on the absolute error of every coefficient of `polynomial`: largest of `errors`."""
        return float(np.max(self.errors))

    @property
    def stable(self) -> bool:
        """Whether the system is shown to be stable."""
        return self.verdict == "stable"

    def _repr_html_(self) -> str:
        return of_route(f"By one period ({self.method})", self)
