"""The two integrals from which every coefficient matrix of the report is made."""

import numpy as np

from hill.arrays import Complex
from hill.matrices.modes import Exponentials


def _moment(f: Exponentials, a: float, b: float, extra: complex = 0.0) -> Complex:
    """Integrals over [a, b] of exp(kappa xi + o + extra xi), one for each term of f."""
    mu = f.kappa + extra
    left, right = np.exp(mu * a + f.o), np.exp(mu * b + f.o)
    # (right - left)/mu, from the larger end so that expm1 never overflows
    width = b - a
    grows = mu.real > 0
    step = np.where(grows, -mu, mu) * width
    nonzero = np.where(mu == 0, 1.0, mu)
    rise = np.where(mu == 0, width, np.expm1(step) / np.where(grows, -nonzero, nonzero))
    return np.where(grows, right, left) * rise


def integral(f: Exponentials, a: float = 0.0, b: float = 1.0) -> float:
    """Integral of f over [a, b]."""
    return float(np.real(f.c @ _moment(f, a, b)))


def sine_integral(
    f: Exponentials, nu: complex, origin: float = 0.0, a: float = 0.0, b: float = 1.0
) -> complex:
    """Integral over [a, b] of f(xi) sin(nu (xi - origin)) / nu; nu = 0 weighs by xi - origin.

    One formula serves the steady thrust (nu = 0), the pulsating one (nu = pi sigma, complex with
    structural damping) and the free longitudinal vibration (nu = s pi), Eq. (4.5.36).
    """
    mu, square = f.kappa, f.kappa**2 + nu**2
    total = np.empty(len(mu), complex)

    # generic: [e^(mu xi) (mu sin(nu x)/nu - cos(nu x))] / (mu^2 + nu^2), x = xi - origin
    # It cancels where mu is near +-i nu; a small nu only does so with mu = 0, treated below.
    near = np.abs(square) < 0.1 * np.maximum(np.abs(nu) ** 2, 1.0)
    generic = ~near & (mu != 0)

    def primitive(xi: float) -> Complex:
        x = xi - origin
        return np.exp(mu * xi + f.o) * (mu * x * _sinc(nu * x) - np.cos(nu * x))

    total[generic] = ((primitive(b) - primitive(a))[generic]) / square[generic]

    # mu = 0: (cos nu x_a - cos nu x_b)/nu^2 as a product of sines, no cancellation
    centre, half = 0.5 * (a + b) - origin, 0.5 * (b - a)
    flat = 2.0 * centre * _sinc(nu * centre) * half * _sinc(nu * half)
    total[mu == 0] = flat * np.exp(f.o[mu == 0])

    # mu near +-i nu: the two exponentials of the sine apart, each by expm1
    resonant = near & (mu != 0)
    if np.any(resonant):
        turn = np.exp(1j * nu * origin)
        split = _moment(f, a, b, 1j * nu) / turn - _moment(f, a, b, -1j * nu) * turn
        total[resonant] = (split / (2j * nu))[resonant]
    return complex(f.c @ total)


def _sinc(x: complex) -> complex:
    """sin(x)/x."""
    return complex(np.sin(x) / x) if x != 0 else 1.0 + 0j
