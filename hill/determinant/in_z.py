"""P(z) and its roots by the general determinant, for equations of many coordinates.

Where multipliers come in pairs y r, r/y, det(r y I - Phi)/r^m is (2 y)^n P((y + 1/y)/2). With many
coordinates the tail as series and blocks side by side take a tenth of the time of three banded
determinants.
"""

from dataclasses import replace

import numpy as np

from hill.arrays import EPS, Complex, Float
from hill.determinant.general_polynomial import SAFETY, polynomial
from hill.determinant.general_values import Determinant, values
from hill.determinant.roots import WELL_KNOWN, discs, improved, larger_of_pair, monic_in_z
from hill.multipliers import polynomial_roots
from hill.stability import Stability, stability_in_discs

PolynomialInZ = tuple[Float, float, float, tuple[int, ...]]
"""P(z), monic, highest power first; a bound on the absolute error of every coefficient, what the
data's errors may add; the harmonics kept."""


def polynomial_in_z(d: Determinant) -> PolynomialInZ | None:
    """From values on the circle |z| = 1, more of them than coefficients: it checks itself.

    None where a group of rows is singular at a point.
    """
    n = d.order // 2
    half = np.arange(n + 2)
    y = larger_of_pair(np.exp(1j * np.pi * half / (n + 1)))
    try:
        found = values(d, np.asarray(np.log(y) / (2.0 * np.pi), complex))
    except np.linalg.LinAlgError:
        return None
    # the values have y^n over its modulus
    P = found.mantissa * np.exp(-1j * n * np.angle(y)) * np.ldexp(1.0, found.exponent - n)
    means = np.fft.irfft(P.conj(), 2 * (n + 1))
    defect = max(abs(means[n] - 1.0), abs(means[n + 1]))
    size = np.where((half == 0) | (half == n + 1), 0.5, 1.0) / (n + 1) * np.abs(P)
    # n ulps of the angle's multiple, and few of the exponential, the product and the transform
    lost = float(np.sum(size * (found.rounding + EPS * (8.0 + n))))
    coefficients = np.append(1.0, means[:n][::-1])
    data_error = float(np.sum(size * found.data))
    return coefficients, SAFETY * float(defect) + lost, data_error, (d.harmonics,)


def by_discs(d: Determinant, s: Stability, Omega: float, eta: float) -> Stability:
    """What the determinant says at the roots themselves, where that is better known."""
    evaluate = monic_in_z(d)
    for improve in (False, True):
        if s.T_error < WELL_KNOWN * Omega / np.pi and s.verdict != "undecided":
            break
        found = discs(evaluate, improved(evaluate, _half_sums(d)) if improve else s.z)
        other = stability_in_discs(found.centre, found.radius, Omega, eta)
        verdict = s.verdict if other.verdict == "undecided" else other.verdict
        s = replace(other if other.T_error < s.T_error else s, verdict=verdict)
    return s


def _half_sums(d: Determinant) -> Complex:
    """Z of the pairs y, 1/y: of many coordinates y are better known from their polynomial than z.

    On |y| = 1 the powers of y are as independent as can be; those of z within (-1, 1) are not.
    """
    y = polynomial_roots(polynomial(d).coefficients)
    every = list(0.5 * (y + 1.0 / y))
    found = []
    while every:
        z = every.pop()
        found.append(0.5 * (z + every.pop(int(np.argmin(np.abs(np.array(every) - z))))))
    return np.array(found)
