r"""The rows of the infinite determinant of a general periodic equation, in groups.

With q = exp(lambda tau) sum_j q_j exp(i j Omega tau) the harmonics q_j obey T q = 0 with

    T_jk = sum_d X_(j-k),d z_k^d,     z_k = lambda + i k Omega,

X_p,0 and X_p,1 the Fourier coefficients of M^-1 K and M^-1 C, X_0,2 the identity; or, of first
order, X_p,0 those of -A and X_0,1 the identity. As many harmonics as the coefficients reach make a
group, and T is block tridiagonal in groups.

Only the division by M rounds: time and coordinates are scaled by powers of two, so that
1 <= Omega < 2 and rows and columns are alike in size.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import matrix_balance

from hill.arrays import EPS, Complex, Float
from hill.determinant.division import divided
from hill.periodic import Fourier, PeriodicEquation

Terms = dict[int, Any]
"""A matrix for each harmonic p, of either sign."""


@dataclass(frozen=True, eq=False)
class Pencil:
    """T of one equation, in scaled time and coordinates.

    Attributes
    ----------
    Omega : float
        Forcing frequency in the scaled time, in [1, 2).
    terms : tuple of dict of int to (n, n) complex ndarray
        ``terms[d][p]`` is X_p,d; the last d has the identity alone.
    rounded, given : tuple of dict of int to (n, n) ndarray
        Bounds on the errors of `terms`: by the division by M, and as the data came.
    trace, trace_error : float
        Of X_0 of the last power but one: the sum of all exponents is -trace.
    """

    Omega: float
    terms: tuple[Terms, ...]
    rounded: tuple[Terms, ...]
    given: tuple[Terms, ...]
    trace: float
    trace_error: float

    @property
    def n(self) -> int:
        """Rows of a block."""
        return len(self.terms[-1][0])

    @property
    def degree(self) -> int:
        """Order of the equation: 1 or 2."""
        return len(self.terms) - 1

    @property
    def order(self) -> int:
        """Number of multipliers."""
        return self.n * self.degree

    @property
    def reach(self) -> int:
        """Harmonics in a group: the highest of the coefficients, or 1."""
        return max((abs(p) for part in self.terms for p in part), default=0) or 1

    @cached_property
    def stacks(self) -> Complex:
        """`stacked` of the terms."""
        return stacked(self.terms, self.reach, self.n)


def stacked(terms: tuple[Terms, ...], reach: int, n: int) -> Any:
    """X by groups, (3, d, reach n, reach n).

    The first index is 0 for columns in the group after the rows', 1 for the same, 2 for the one
    before.
    """
    whole = np.zeros((3, len(terms), reach, n, reach, n), complex)
    for off in (-1, 0, 1):
        for d, part in enumerate(terms):
            for a in range(reach):
                for b in range(reach):
                    if (p := off * reach + a - b) in part:
                        whole[off + 1, d, a, :, b] = part[p]
    return whole.reshape(3, len(terms), reach * n, reach * n)


def pencil(equation: PeriodicEquation, ulps: float = 0.0) -> Pencil:
    """T of an equation, whose pulsating coefficients were rounded by so many ulps already."""
    shift = 1 - int(np.frexp(equation.Omega)[1])
    if equation.A is not None:
        M, coefficients = np.eye(equation.A.n), [(-1.0, equation.A)]
    else:
        # of second order all three are there
        M, K, C = (np.asarray(equation.M), equation.K, equation.C)
        coefficients = [(1.0, K), (1.0, C)]  # type: ignore[list-item]
    n, powers = len(M), range(len(coefficients), 0, -1)
    found = [
        _terms(M, matrix, sign, power * shift, ulps)
        for power, (sign, matrix) in zip(powers, coefficients, strict=True)
    ]
    spread = np.abs(np.linalg.inv(M)) @ np.ones((n, n))
    given = tuple(
        {p: np.ldexp(equation.data_error * _largest(matrix), power * shift) * spread for p in part}
        for power, (_, matrix), (part, _) in zip(powers, coefficients, found, strict=True)
    )
    mean = found[-1][0][0].real
    sizes = sum(np.abs(x) for part, _ in found for x in part.values())
    _, (scale, _) = matrix_balance(sizes, permute=False, separate=True)

    def balanced(part: Terms) -> Terms:
        every = {p: x * (scale / scale[:, None]) for p, x in part.items()}
        return {p: x for p, x in every.items() if np.any(x)}

    return Pencil(
        Omega=float(np.ldexp(equation.Omega, shift)),
        terms=(*(balanced(part) for part, _ in found), {0: np.eye(n, dtype=complex)}),
        rounded=tuple(balanced(error) for _, error in found),
        given=tuple(balanced(part) for part in given),
        trace=math.fsum(np.diag(mean)),
        trace_error=float(np.trace(found[-1][1][0])) + EPS * abs(math.fsum(np.diag(mean))),
    )


def _terms(M: Float, matrix: Fourier, sign: float, shift: int, ulps: float) -> tuple[Terms, Terms]:
    """X_p and the errors of its elements, in scaled time."""

    def over(x: Float, ulps: float = ulps) -> tuple[Float, Float]:
        quotient, error = divided(M, np.ldexp(sign * x, shift))
        return quotient, error + EPS * ulps * np.abs(quotient)

    mean, error = over(matrix.mean, 0.0)
    terms, errors = {0: mean.astype(complex)}, {0: error}
    zero = np.zeros_like(mean)
    for p in matrix.harmonics:
        (a, of_a), (b, of_b) = over(matrix.cos.get(p, zero)), over(matrix.sin.get(p, zero))
        terms[p], terms[-p] = 0.5 * (a - 1j * b), 0.5 * (a + 1j * b)
        errors[p] = errors[-p] = 0.5 * (of_a + of_b)
    return terms, errors


def _largest(matrix: Fourier) -> float:
    """The largest element of all coefficients."""
    every = (matrix.mean, *matrix.cos.values(), *matrix.sin.values())
    return max(float(np.max(np.abs(x))) for x in every)
