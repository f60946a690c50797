"""P(z) and T of many equations for curves: integrated once, without the check and its bound.

What is shown with a bound is `floquet.monodromy` or `floquet.batch.polynomials`.
"""

from collections.abc import Sequence

import numpy as np

from floquet.arrays import Float
from floquet.batch import polynomials
from floquet.growth import ln_mu
from floquet.integrate.ode import parameter_values, shape
from floquet.integrate.step_length import perron_root
from floquet.integrate.taylor import Taylor
from floquet.period import MAX_TERM_GROWTH, second_half
from hill import HillEquation

# From so many on a batch is quicker than one after the other, each with matrices of its own: 1.3
# times with four of two modes, 5 times with seventeen.
TOGETHER = 4

# Elements of the fundamental matrix beyond which its inverse is not even tried.
MAX_INVERTED = 1e5


def unchecked_polynomials(equations: Sequence[HillEquation]) -> Float:
    """Coefficients of P of each, from half a period of the undamped equation in u, Eq. (6.1.2).

    Parameters
    ----------
    equations : sequence of HillEquation
        All with the same number of coordinates; `eta` one number.

    Returns
    -------
    (k, n + 1) ndarray
        Monic, highest power first.
    """
    if len(equations) >= TOGETHER:
        return polynomials(equations).coefficients
    return np.array([_half_period(equation) for equation in equations])


def _half_period(equation: HillEquation) -> Float:
    """One equation.

    As in `floquet.monodromy`, much growth makes the half period's inverse a poor one.
    """
    run, size = parameter_values(equation, undamped=True), shape(equation)
    half = np.pi / equation.Omega
    U = Taylor()(run, size, half)
    well = np.abs(U).max() < MAX_INVERTED
    Phi, scale = second_half(U) if well else (U, np.full_like(U, np.inf))
    if np.isinf(scale).any() or perron_root(scale) >= MAX_TERM_GROWTH:
        Phi = Taylor()(run, size, 2.0 * half)
    return np.real(np.poly(Phi[: size.n, : size.n]))


def unchecked_growth(polynomials: Float, Omega: Float | float, eta: float = 0.0) -> Float:
    """T = (Omega/pi) max ln |mu| - eta of many P, mu the larger of z +- (z^2 - 1)^(1/2), (7.1.1).

    Parameters
    ----------
    polynomials : (k, n + 1) ndarray
        Monic, highest power first.
    Omega : float or (k,) ndarray
    eta : float, optional

    Returns
    -------
    (k,) ndarray
    """
    n = polynomials.shape[1] - 1
    companion = np.zeros((len(polynomials), n, n))
    companion[:, 0] = -polynomials[:, 1:]
    companion[:, np.arange(1, n), np.arange(n - 1)] = 1.0
    z = np.linalg.eigvals(companion).astype(complex)
    growth = ln_mu(np.abs(z.real), np.abs(z.imag)).max(axis=-1)
    return np.asarray(Omega / np.pi * growth - eta)
