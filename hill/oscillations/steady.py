"""A system without pulsation: its oscillations, what each grows or decays by, its vectors."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig

from hill.arrays import Complex, Float
from hill.equation import HillEquation
from hill.periodic import PeriodicEquation

# An exponent whose imaginary part is a smaller share of it is of no oscillation.
OSCILLATES = 1e-9

# A rigid rotation's two exponents are 0, and rounding makes about the square root of an ulp of the
# largest one of them, of any phase: that is no oscillation.
RIGID = 1e-7


@dataclass(frozen=True, eq=False)
class Steady:
    """Exponents of x' = A x, the mean of an equation in states (q, q') or x, and their vectors.

    Attributes
    ----------
    exponents : (m,) complex ndarray
        All of them.
    right, left : (m, m) complex ndarray
        Columns; ``left.T @ right`` is diagonal where the exponents are simple.
    oscillations : tuple of int
        Which exponents are of an oscillation, one of each conjugate pair, the one with a positive
        imaginary part, ascending by it.
    """

    exponents: Complex
    right: Complex
    left: Complex
    oscillations: tuple[int, ...]

    @property
    def growth(self) -> float:
        """The largest growth exponent."""
        return float(np.max(self.exponents.real))

    @property
    def frequencies(self) -> Float:
        """Imaginary parts of the oscillations, ascending."""
        return np.asarray(self.exponents.imag[list(self.oscillations)])


def mean_frequencies(equation: HillEquation | PeriodicEquation) -> Complex:
    """Frequencies of an equation without its pulsation, ascending, one for two multipliers.

    Real where an oscillation decays or stays, complex where it grows, -i times its exponent; 0 of
    what does not oscillate and does not grow.
    """
    exponents = np.linalg.eigvals(mean_matrix(equation))
    # one of each pair; of real exponents every second one, descending
    turning = np.abs(exponents.imag) > OSCILLATES * np.abs(exponents)
    real = np.sort(exponents[~turning].real)[::-1][: (len(exponents) - np.sum(turning)) // 2]
    own = np.append(exponents[turning & (exponents.imag > 0.0)], real)
    grows = own.real > OSCILLATES * np.abs(own)
    found = np.where(grows, -1j * own, own.imag)
    return np.asarray(found[np.lexsort((found.imag, found.real))])


def steady(equation: HillEquation | PeriodicEquation) -> Steady:
    """What an equation does without its pulsation."""
    exponents, left, right = eig(mean_matrix(equation), left=True, right=True)
    size = np.abs(exponents)
    own = np.flatnonzero(
        (exponents.imag > OSCILLATES * size) & (size > RIGID * np.max(size, initial=0.0))
    )
    order = own[np.argsort(exponents.imag[own], kind="stable")]
    return Steady(exponents, right, left.conj(), tuple(int(k) for k in order))


def mean_matrix(equation: HillEquation | PeriodicEquation) -> Float:
    """A of x' = A x: of an equation of second order in the states (q, q')."""
    e = equation.general() if isinstance(equation, HillEquation) else equation
    if e.A is not None:
        return np.asarray(e.A.mean)
    assert e.M is not None
    assert e.K is not None
    assert e.C is not None
    n = e.K.n
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:] = np.eye(n)
    A[n:] = -np.linalg.solve(e.M, np.hstack([e.K.mean, e.C.mean]))
    return A
