"""One route at a time: many points, no error bounds, no second run.

Bounds are the business of the tables. A figure shows curves by one route and marks by the other;
where a claim has a boundary, each route finds it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from compare.edges.field import PolynomialField
from floquet import weak_form
from floquet.unchecked import unchecked_growth, unchecked_polynomials
from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam, axial_force, characteristic
from hill.stability import arguments

Beam = UniformBeam | SteppedBeam
RouteName = Literal["hill", "floquet"]
Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]

ROUTES: tuple[RouteName, RouteName] = ("hill", "floquet")


@dataclass(frozen=True)
class Batched(PolynomialField):
    """A family solved by one route, many equations at a time."""

    route: RouteName = "floquet"

    def along(self, Omega: Float, y: float) -> Float:
        """Coefficients of P at many Omega, (k, n + 1)."""
        return solve(self.route, [self.equation(float(x), y) for x in Omega])


def family(
    route: RouteName,
    beam: Callable[[float], Beam],
    gamma: Callable[[float], float],
    eta: float = 0.0,
) -> Batched:
    """Beam and gamma as functions of the second parameter, by one route."""

    def equation_at(Omega: float, y: float) -> HillEquation:
        return equation(route, beam(y), Omega, gamma(y), eta)

    return Batched(equation_at, lambda e: solve(route, [e])[0], route)


def equation(
    route: RouteName, beam: Beam, Omega: float, gamma: float, eta: float = 0.0
) -> HillEquation:
    """In closed form, or by Galerkin's quadrature; a rigid bar's matrices are kept."""
    if np.isfinite(beam.omega_L):
        return (beam.equation if route == "hill" else partial(galerkin, beam))(Omega, gamma, eta)
    rigid = _rigid(route, beam)
    return HillEquation(F=rigid.F, G=rigid.G, gamma=gamma, Omega=Omega, eta=eta)


def out_of_phase(route: RouteName, beam: UniformBeam, Omega: float) -> Float:
    """What a damped bar's force adds to G a quarter of a period behind the thrust."""
    return (axial_force if route == "hill" else weak_form).out_of_phase(beam, Omega)


def integral_of_force(route: RouteName, beam: UniformBeam, Omega: float) -> complex:
    """Integral of Phi* over the beam (4.5.26), out of the route's matrices.

    G_(N+1,N+1) is 12 T0/lambda_1^4 times (1 + K_theta)/2 less the integral. Two values of K_theta
    give the factor, and with it the integral, without another formula.
    """
    bare, held = (
        equation(route, replace(beam, K_theta=K), Omega, 0.0).G[-1, -1] for K in (0.0, 1.0)
    )
    real = 0.5 - 0.5 * bare / (held - bare)
    if beam.g == 0.0:
        return complex(real)
    return complex(real, -0.5 * out_of_phase(route, beam, Omega)[-1, -1] / (held - bare))


def solve(route: RouteName, equations: Sequence[HillEquation]) -> Float:
    """Coefficients of P of each, (k, n + 1): from the infinite determinant, or in time."""
    return _by_hill(equations) if route == "hill" else unchecked_polynomials(equations)


def T_of(route: RouteName, P: Float, Omega: Float | float, eta: float = 0.0) -> Float:
    """T of (7.1.1) by the same route, for many P at once, (k, n + 1)."""
    return (arguments if route == "hill" else unchecked_growth)(P, Omega, eta)


def _by_hill(equations: Sequence[HillEquation]) -> Float:
    # solving for an edge ends where two z are equal, and its bound on T, not used here, is not one
    with np.errstate(invalid="ignore"):
        return np.array([characteristic(equation).polynomial for equation in equations])


@lru_cache(maxsize=512)
def _rigid(route: RouteName, beam: Beam) -> HillEquation:
    """A rigid bar's F and G do not depend on Omega."""
    return beam.equation(1.0, 0.0) if route == "hill" else galerkin(beam, 1.0, 0.0)
