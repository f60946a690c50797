"""Stepped beam: A, B, C of chapter 5 in closed form, and F = A^-1 B, G = A^-1 C.

All three matrices are over lambda_1**4 and in the order q_1..q_N, q_B, q_A of Eq. (5.4.3).
"""

from functools import lru_cache

import numpy as np
from scipy.optimize import brentq

from hill.arrays import Float, frozen
from hill.matrices.integrals import integral, sine_integral
from hill.matrices.modes import UNIT, ZERO, Exponentials, curvature, eigenvalue, mode


def mass(modes: int, xi_c: float, area_ratio: float) -> Float:
    """A of Eq. (5.4.3), over lambda_1**4: integral of A(xi)/A_2 w_j w_k, symmetric."""
    return area_ratio * _mass_part(modes, 0.0, xi_c) + _mass_part(modes, xi_c, 1.0)


@lru_cache(maxsize=512)
def _mass_part(modes: int, a: float, b: float) -> Float:
    """Integrals of w_j w_k over [a, b] for w = phi_1..phi_N, xi, 1."""
    shapes = [mode(n) for n in range(1, modes + 1)]
    table = np.empty((modes + 2, modes + 2))
    for j, f in enumerate(shapes):
        for k in range(j + 1):
            table[j, k] = table[k, j] = integral(f * shapes[k], a, b)
        table[j, -2] = table[-2, j] = sine_integral(f, 0.0, 0.0, a, b).real
        table[j, -1] = table[-1, j] = integral(f, a, b)
    table[-2, -2] = (b**3 - a**3) / 3.0
    table[-2, -1] = table[-1, -2] = (b**2 - a**2) / 2.0
    table[-1, -1] = b - a
    return frozen(table)


def bending(modes: int, xi_c: float, inertia_ratio: float) -> Float:
    """First term of B, Eq. (5.4.4), over lambda_1**4: integral of I(xi)/I_2 w_j'' w_k''."""
    ahead, behind = _bends(modes, 0.0, xi_c), _bends(modes, xi_c, 1.0)
    return (inertia_ratio * ahead + behind) / eigenvalue(1) ** 4


def bending_size(modes: int, xi_c: float, inertia_ratio: float) -> float:
    """Size of what an element of it sums: a short section is what is left of the whole beam."""
    whole = np.max(np.abs(bending(modes, xi_c, 1.0)))
    return float((1.0 + inertia_ratio) * whole)


@lru_cache(maxsize=512)
def _bends(modes: int, a: float, b: float) -> Float:
    """Integrals of w_j'' w_k'' over [a, b]."""
    bends = [curvature(n) for n in range(1, modes + 1)]
    table = np.zeros((modes + 2, modes + 2))
    for j, f in enumerate(bends):
        for k in range(j + 1):
            table[j, k] = table[k, j] = integral(f * bends[k], a, b)
    return frozen(table)


def thrust(
    modes: int,
    T0: float,
    K_theta: float,
    xi_G: float,
    xi_c: float,
    area_ratio: float,
    sigma: float,
) -> Float:
    """The T0 terms of B (sigma = 0) and C, Eqs. (5.4.4) and (5.4.5), over lambda_1**4."""
    shapes = [mode(n) for n in range(1, modes + 1)]
    slopes = _slopes(modes)
    nu = np.pi * sigma
    whole, step = force_distribution(nu, xi_c, area_ratio)
    axial = whole * _pairs(modes, nu, 0.0) + step * _pairs(modes, nu, xi_c)
    arm = np.array([f(1.0) for f in shapes] + [1.0, 1.0])
    side = np.array([f(1.0) + K_theta * f(xi_G) for f in slopes])
    return (T0 / eigenvalue(1) ** 4) * (np.outer(arm, side) - axial)


def _slopes(modes: int) -> list[Exponentials]:
    return [mode(n).derivative for n in range(1, modes + 1)] + [UNIT, ZERO]


@lru_cache(maxsize=64)
def _products(modes: int) -> dict[tuple[int, int], Exponentials]:
    """w_j' w_k' for j >= k."""
    slopes = _slopes(modes)
    return {(j, k): slopes[j] * slopes[k] for j in range(modes + 2) for k in range(j + 1)}


@lru_cache(maxsize=512)
def _pairs(modes: int, nu: float, start: float) -> Float:
    """Integrals over [start, 1] of sin(nu (xi - start))/nu w_j' w_k'."""
    table = np.empty((modes + 2, modes + 2))
    for (j, k), both in _products(modes).items():
        table[j, k] = table[k, j] = sine_integral(both, nu, start, start, 1.0).real
    return frozen(table)


def force_distribution(nu: float, xi_c: float, area_ratio: float) -> tuple[float, float]:
    """Amplitudes (d, e) of P_x/T_1 = d sin(nu xi)/nu + e sin(nu (xi - xi_c))/nu h(xi - xi_c).

    Eq. (5.3.12), simplified: d = nu area_ratio beta_e, e = nu (1 - area_ratio) beta_e cos(nu xi_c).
    At nu = 0 it is P_0 of (5.3.10).
    """
    stiffness = force_stiffness(nu, xi_c, area_ratio)
    d = area_ratio / stiffness
    e = (1.0 - area_ratio) * np.cos(nu * xi_c) / stiffness
    return float(d), float(e)


def force_stiffness(nu: float, xi_c: float, area_ratio: float) -> float:
    """1/(nu beta_e) of Eq. (5.3.13): zero at a longitudinal resonance, M_T/(m_2 l) at nu = 0."""
    rest = 1.0 - xi_c
    return float(
        np.cos(nu * xi_c) * rest * np.sinc(nu * rest / np.pi)
        + area_ratio * xi_c * np.sinc(nu * xi_c / np.pi) * np.cos(nu * rest)
    )


def force_resonances(least: float, most: float, xi_c: float, area_ratio: float) -> Float:
    """Where the axial force is infinite: sigma > 0 from `least` to `most`, ascending.

    With r the area ratio, 2 nu times `force_stiffness` is (1 + r) sin nu + (1 - r) sin (1 - 2 xi_c)
    nu. On the lines sigma = k + 1/2 + i y the first term is (1 + r) cosh pi y in modulus, more than
    the second can be, so by Rouche there is one root between neighbouring lines, as sin nu has; it
    is real, since the sign changes between their real points.
    """

    def stiffness(sigma: float) -> float:
        nu = np.pi * sigma
        return nu * force_stiffness(nu, xi_c, area_ratio)

    whole = range(max(round(least), 1), round(most) + 1)
    found = [brentq(stiffness, k - 0.5, k + 0.5, xtol=1e-14) for k in whole]
    return np.array([sigma for sigma in found if least <= sigma <= most])


def amplification(mass: tuple[Float, float], load: tuple[Float, float]) -> float:
    """What A^-1 B is off, over its largest element, if A and B are off by an ulp of their sizes.

    To first order |A^-1| (|dA| |A^-1 B| + |dB|). With A and B their sizes: of what their elements
    sum, and so more than they are where one section is light, weak or short.
    """
    (A, size), (B, load_size) = mass, load
    whole = np.abs(np.linalg.solve(A, B))
    moved = size * whole.sum(axis=0) + load_size
    rows = np.abs(np.linalg.inv(A)).sum(axis=1)
    largest = np.max(whole[:-1, :-1])
    return float(np.max(rows[:-1]) * np.max(moved[:-1]) / largest) if largest else 0.0


def reduce(mass_matrix: Float, load: Float) -> Float:
    """A^-1 B without the last row and column: the translation q_A is arbitrary (5.4.9)."""
    solved: Float = np.linalg.solve(mass_matrix, load)[:-1, :-1]
    return solved
