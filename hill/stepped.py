"""Stepped beam: A, B, C of chapter 5 in closed form, and F = A^-1 B, G = A^-1 C.

All three matrices are over lambda_1**4 and in the order q_1..q_N, q_B, q_A of Eq. (5.4.3).
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.integrals import integral, sine_integral
from hill.modes import UNIT, ZERO, Exponentials, curvature, eigenvalue, mode

Float = NDArray[np.floating[Any]]


def mass(modes: int, xi_c: float, area_ratio: float) -> Float:
    """A of Eq. (5.4.3), over lambda_1**4: integral of A(xi)/A_2 w_j w_k, symmetric."""
    shapes = [mode(n) for n in range(1, modes + 1)]
    return area_ratio * _mass_part(shapes, 0.0, xi_c) + _mass_part(shapes, xi_c, 1.0)


def _mass_part(shapes: list[Exponentials], a: float, b: float) -> Float:
    """Integrals of w_j w_k over [a, b] for w = phi_1..phi_N, xi, 1."""
    modes = len(shapes)
    table = np.empty((modes + 2, modes + 2))
    for j, f in enumerate(shapes):
        for k in range(j + 1):
            table[j, k] = table[k, j] = integral(f * shapes[k], a, b)
        table[j, -2] = table[-2, j] = sine_integral(f, 0.0, 0.0, a, b).real
        table[j, -1] = table[-1, j] = integral(f, a, b)
    table[-2, -2] = (b**3 - a**3) / 3.0
    table[-2, -1] = table[-1, -2] = (b**2 - a**2) / 2.0
    table[-1, -1] = b - a
    return table


def bending(modes: int, xi_c: float, inertia_ratio: float) -> Float:
    """First term of B, Eq. (5.4.4), over lambda_1**4: integral of I(xi)/I_2 w_j'' w_k''."""
    bends = [curvature(n) for n in range(1, modes + 1)]
    table = np.zeros((modes + 2, modes + 2))
    for j, f in enumerate(bends):
        for k in range(j + 1):
            both = f * bends[k]
            value = inertia_ratio * integral(both, 0.0, xi_c) + integral(both, xi_c, 1.0)
            table[j, k] = table[k, j] = value
    return table / eigenvalue(1) ** 4


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
    slopes = [f.derivative for f in shapes] + [UNIT, ZERO]
    nu = np.pi * sigma
    whole, step = force_distribution(nu, xi_c, area_ratio)
    axial = np.empty((modes + 2, modes + 2))
    for j, f in enumerate(slopes):
        for k in range(j + 1):
            both = f * slopes[k]
            value = whole * sine_integral(both, nu)
            value += step * sine_integral(both, nu, xi_c, xi_c, 1.0)
            axial[j, k] = axial[k, j] = value.real
    arm = np.array([f(1.0) for f in shapes] + [1.0, 1.0])
    side = np.array([f(1.0) + K_theta * f(xi_G) for f in slopes])
    return (T0 / eigenvalue(1) ** 4) * (np.outer(arm, side) - axial)


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


def reduce(mass_matrix: Float, load: Float) -> Float:
    """A^-1 B without the last row and column: the translation q_A is arbitrary (5.4.9)."""
    solved: Float = np.linalg.solve(mass_matrix, load)[:-1, :-1]
    return solved
