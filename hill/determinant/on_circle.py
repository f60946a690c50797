"""That all multipliers are on one circle, where they come in pairs about it.

With pairs mu, r^2/mu the polynomial of the 2 n multipliers is palindromic in y = mu/r, and real at
y = exp(i theta) once divided by y^n: 2^n prod (cos theta - z_j), z = (y + 1/y)/2. Where it changes
its sign n times between 0 and pi all z are real, simple and within (-1, 1), so that all multipliers
are on the circle and none meets another.
"""

from dataclasses import replace
from fractions import Fraction

import numpy as np

from hill.arrays import EPS, Float
from hill.determinant.general_polynomial import SAFETY
from hill.determinant.general_values import Determinant, values
from hill.equation import HillEquation
from hill.multipliers import Multipliers
from hill.periodic import PeriodicEquation
from hill.stability import Verdict
from hill.symmetry import damping_of_pairs


def judged(
    equation: HillEquation | PeriodicEquation, d: Determinant, m: Multipliers
) -> Multipliers:
    """T and the verdict, where undecided, if a symmetry puts all multipliers on one circle."""
    if m.verdict != "undecided":
        return m
    own = equation.general() if isinstance(equation, HillEquation) else equation
    eta = damping_of_pairs(own)
    if eta is None or not all_on_circle(d, m.exponents.imag * own.period, eta, own.Omega):
        return m
    known = 8.0 * EPS * (own.Omega / np.pi + abs(float(eta)))
    verdict: Verdict = "stable" if eta >= 0 else "unstable"
    return replace(m, T=0.0 - float(eta), T_error=known, verdict=verdict)


def all_on_circle(d: Determinant, angles: Float, eta: Fraction, Omega: float) -> bool:
    """Whether the determinant changes its sign between every two angles of roots.

    Parameters
    ----------
    angles : (m,) ndarray
        Of the computed multipliers; where they are wrong nothing is shown.
    eta, Omega : Fraction and float
        The circle has the radius exp(-pi eta/Omega).
    """
    n = d.order // 2
    upper = np.sort(angles[(angles > 0.0) & (angles < np.pi)])
    if len(upper) != n or d.order != 2 * n:
        return False
    edges = 0.5 * upper[0], 0.5 * (upper[-1] + np.pi)
    between = 0.5 * (upper[:-1] + upper[1:])
    for first, last in ((0.0, np.pi), edges):
        theta = np.concatenate([[first], between, [last]])
        try:
            sign = _signs(d, theta, eta, Omega)
        except np.linalg.LinAlgError:
            # a group of rows is singular just there
            continue
        return bool(np.all(sign == (-1.0) ** np.arange(n + 1)))
    return False


def _signs(d: Determinant, theta: Float, eta: Fraction, Omega: float) -> Float:
    """Of the polynomial over y^n at y = exp(i theta); 0 where rounding leaves it open."""
    # ln r/2 pi
    level = float(-eta / (2 * Fraction(Omega)))
    found = values(d, level - d.mean + 1j * theta / (2.0 * np.pi))
    turned = found.mantissa * np.exp(-0.5j * d.order * theta)
    # the circle, and the angle, are known to some ulps
    moved = 8.0 * EPS * (1.0 + abs(level) + abs(d.mean)) * (np.abs(found.slope) + d.order)
    share = found.rounding + EPS * (8.0 + d.order) + moved
    unsure = 1.01 * share * np.abs(turned) + SAFETY * np.abs(turned.imag)
    return np.where(np.abs(turned.real) > unsure, np.sign(turned.real), 0.0)
