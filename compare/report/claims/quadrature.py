"""The part of a damped bar's axial force that the report's equation leaves out.

The report asks for the real portion of a motion that goes like exp(i Omega t) (4.2.34) and takes
Re Phi* cos(Omega t) (4.2.39). The real portion is Re Phi* cos(Omega t) - Im Phi* sin(Omega t): at a
longitudinal resonance the first part passes through zero and the second is nearly the whole force.

Neither route takes a cosine and a sine together, which are not even in time. The sine alone is a
cosine a quarter of a period later, and both routes take that. Both parts together are integrated in
``tests/test_claims.py``: unstable at every point that the claims rest on.
"""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.report.claims.routes import Both, solve
from floquet.weak_form import galerkin
from hill import HillEquation, UniformBeam
from hill.matrices.integrals import sine_integral
from hill.matrices.modes import UNIT, eigenvalue, slope

Float = NDArray[np.floating[Any]]
GAUSS = 60


@cache
def sine_alone(beam: UniformBeam, Omega: float, gamma: float = 0.1) -> Both:
    """T with nothing but the part of the pulsating force in quadrature with the thrust."""
    closed = HillEquation(beam.equation(Omega, gamma).F, sine_part(beam, Omega), gamma, Omega)
    F = galerkin(beam, Omega, gamma).F
    summed = HillEquation(F, sine_part_by_quadrature(beam, Omega), gamma, Omega)
    return solve(closed, summed, f"Im Phi* alone of {beam}")


def wave(beam: UniformBeam, Omega: float) -> complex:
    """Pi (sigma**2 - i g)**(1/2) of (4.4.17)."""
    return complex(np.pi * np.sqrt((Omega / beam.omega_L) ** 2 - 1j * beam.g))


def sine_part(beam: UniformBeam, Omega: float) -> Float:
    """Im of the complex G, in closed form; the side forces have none."""
    nu, slopes = wave(beam, Omega), _slopes(beam)
    pairs = np.array([[sine_integral(a * b, nu) for b in slopes] for a in slopes])
    found: Float = -_scale(beam) * np.imag(pairs * nu / np.sin(nu))
    return found


def sine_part_by_quadrature(beam: UniformBeam, Omega: float) -> Float:
    """The same by Gauss-Legendre quadrature of Im Phi* w_j' w_k'."""
    node, weight = np.polynomial.legendre.leggauss(GAUSS)
    xi, nu = 0.5 * (1.0 + node), wave(beam, Omega)
    force = 0.5 * weight * np.imag(np.sin(nu * xi) / np.sin(nu))
    values = np.array([[float(w(x)) for x in xi] for w in _slopes(beam)])
    found: Float = -_scale(beam) * ((values * force) @ values.T)
    return found


def _slopes(beam: UniformBeam) -> list[Any]:
    return [slope(n) for n in range(1, beam.modes + 1)] + [UNIT]


def _scale(beam: UniformBeam) -> Float:
    """T0/lambda_1**4, twelve times that for the rotation, as a column."""
    rows = np.append(np.ones(beam.modes), 12.0)[:, None]
    return rows * (beam.T0 / eigenvalue(1) ** 4)
