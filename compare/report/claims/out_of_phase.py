"""The part of a damped bar's axial force that the report's equation leaves out.

The report asks for the real portion of a motion that goes like exp(i Omega t) (4.2.34) and takes
Re Phi* cos(Omega t) (4.2.39). The real portion is Re Phi* cos(Omega t) - Im Phi* sin(Omega t): at a
longitudinal resonance the first part passes through zero and the second is nearly the whole force.

The sine alone is a cosine a quarter of a period later. Both parts together are an equation in
general form, `UniformBeam(quadrature_force=True)`: unstable at every point that the claims rest on,
by both routes and by another solver (``tests/test_claims.py``).
"""

from dataclasses import replace
from functools import lru_cache

from compare.report.claims.both_routes import Both, solve_both
from compare.report.one_route import ROUTES, equation, out_of_phase
from compare.report.tables import GAMMA
from floquet.weak_form import galerkin
from hill import HillEquation, UniformBeam


@lru_cache(maxsize=64)
def sine_alone(beam: UniformBeam, Omega: float, gamma: float = GAMMA) -> Both:
    """T with only the part of the pulsating force a quarter of a period behind the thrust."""
    closed, summed = (
        HillEquation(
            equation(route, beam, Omega, gamma).F, out_of_phase(route, beam, Omega), gamma, Omega
        )
        for route in ROUTES
    )
    return solve_both(closed, summed, f"Im Phi* alone of {beam}")


@lru_cache(maxsize=64)
def whole_force(beam: UniformBeam, Omega: float, gamma: float = GAMMA) -> Both:
    """T with both parts, each route with its own matrices."""
    whole = replace(beam, quadrature_force=True)
    closed, summed = whole.equation(Omega, gamma), galerkin(whole, Omega, gamma)
    return solve_both(closed, summed, f"the whole force of {beam}")
