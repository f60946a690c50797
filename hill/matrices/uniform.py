"""Uniform beam: F, G and H_s in closed form, Eqs. (4.5.19) to (4.5.30) as corrected.

Rows and columns 0..N-1 are the bending modes phi_1..phi_N, row and column N is the rotation q_B.
The corrections are argued one by one in ``compare/report/data/errata.toml``.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hill.arrays import Float, frozen
from hill.matrices.integrals import sine_integral
from hill.matrices.modes import UNIT, Exponentials, eigenvalue, mode, slope


@lru_cache(maxsize=512)
def steady(modes: int, T0: float, K_theta: float, xi_G: float) -> Float:
    """F of Eqs. (4.5.19) to (4.5.22), shape (modes + 1, modes + 1)."""
    return frozen(stiffness(modes) + _thrust(modes, T0, K_theta, xi_G, nu=0.0))


def pulsating(modes: int, T0: float, K_theta: float, xi_G: float, sigma: complex) -> Float:
    """G of Eqs. (4.5.23) to (4.5.26) for the force distribution Phi of (4.4.16).

    `sigma` is Omega/omega_L, or (sigma**2 - i g)**0.5 of (4.4.17) with structural damping.
    """
    return _thrust(modes, T0, K_theta, xi_G, nu=np.pi * sigma)


def out_of_phase(modes: int, T0: float, sigma: complex) -> Float:
    """The same of Im Phi in place of Re Phi; the thrust itself has no such part."""
    nu = np.pi * sigma
    return -_scale(modes, T0) * np.imag(_pairs(modes, nu) / np.sinc(nu / np.pi))


def free_vibration(modes: int, T0: float, gamma: float, sigma: float, s: int) -> Float:
    """H_s of Eqs. (4.5.27) to (4.5.30) for zero initial displacement and velocity."""
    nu = s * np.pi
    weight = np.real(_pairs(modes, nu)) * nu
    return -_scale(modes, T0) * start_amplitude(gamma, sigma, s) * weight


def start_amplitude(gamma: float, sigma: float, s: int) -> float:
    """C_s of Eq. (4.6.6) as corrected: the bar starts unstrained,

    xi + gamma Phi(xi) + sum_s C_s sin(s pi xi) = 0 for every xi.
    """
    return float(2 * s * (-1) ** s / np.pi * (1 / s**2 + gamma / (s**2 - sigma**2)))


def stiffness(modes: int) -> Float:
    """(lambda_j/lambda_1)**4 on the diagonal, 0 for the rotation: the first term of (4.5.19)."""
    first = eigenvalue(1)
    return np.diag([(eigenvalue(n) / first) ** 4 for n in range(1, modes + 1)] + [0.0])


def _thrust(modes: int, T0: float, K_theta: float, xi_G: float, nu: complex) -> Float:
    """All terms in T0, for the axial force Phi(xi) = sin(nu xi)/sin(nu) (xi where nu = 0)."""
    shapes = [mode(n) for n in range(1, modes + 1)]
    slopes = _slopes(modes)
    phi_1 = np.array([f(1.0) for f in shapes])
    # the follower thrust, along the tangent at the end, and its gimbal angle K_theta psi_G
    side = np.array([f(1.0) + K_theta * f(xi_G) for f in slopes])
    axial = np.real(_pairs(modes, nu) / np.sinc(nu / np.pi))  # integral of Phi w_j' w_k'

    # bending rows (4.5.19, 4.5.20, 4.5.23, 4.5.24), in which phi_j(1) carries the side force;
    # rotation row (4.5.21, 4.5.22, 4.5.25, 4.5.26), in which 1/2 is left of xi = 1 once the
    # translation q_A is eliminated
    arm = np.append(phi_1, 0.5)
    return _scale(modes, T0) * (np.outer(arm, side) - axial)


def _slopes(modes: int) -> list[Exponentials]:
    return [slope(n) for n in range(1, modes + 1)] + [UNIT]


@lru_cache(maxsize=64)
def _products(modes: int) -> dict[tuple[int, int], Exponentials]:
    """w_j' w_k' for j >= k."""
    slopes = _slopes(modes)
    return {(j, k): slopes[j] * slopes[k] for j in range(modes + 1) for k in range(j + 1)}


@lru_cache(maxsize=512)
def _pairs(modes: int, nu: complex) -> NDArray[np.complex128]:
    """Integrals of sin(nu xi)/nu w_j' w_k', a symmetric matrix; T0, K_theta and xi_G share it."""
    table = np.empty((modes + 1, modes + 1), complex)
    for (j, k), both in _products(modes).items():
        table[j, k] = table[k, j] = sine_integral(both, nu)
    return frozen(table)


def _scale(modes: int, T0: float) -> Float:
    """T0/lambda_1**4 for bending rows, 12 T0/lambda_1**4 for the rotation, as a column."""
    rows = np.append(np.ones(modes), 12.0)[:, None]
    return rows * (T0 / eigenvalue(1) ** 4)
