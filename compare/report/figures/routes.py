"""The two routes as the figures use them: many points, no error bounds, no second run.

Bounds are the business of the tables; a figure shows curves by one route and marks by the other.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from compare.tongues.boundaries import Family
from floquet.batch import polynomials
from floquet.integrate.ode import parameter_values, shape
from floquet.integrate.step_length import perron_root
from floquet.integrate.taylor import Taylor
from floquet.period import MAX_TERM_GROWTH, second_half
from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic

Beam = UniformBeam | SteppedBeam
Route = Literal["hill", "floquet"]
Float = NDArray[np.floating[Any]]


# Elements of the fundamental matrix beyond which its inverse is not even tried.
MUCH = 1e5


@dataclass(frozen=True)
class Batched(Family):
    """A family solved by one route, many equations at a time."""

    route: Route = "floquet"

    def along(self, Omega: Float, y: float) -> Float:
        """Coefficients of P at many Omega, (k, n + 1)."""
        return solve(self.route, [self.equation(float(x), y) for x in Omega])


def family(
    route: Route, beam: Callable[[float], Beam], gamma: Callable[[float], float], eta: float = 0.0
) -> Batched:
    """Beam and gamma as functions of the second parameter, by one route."""

    def equation_at(Omega: float, y: float) -> HillEquation:
        return equation(route, beam(y), Omega, gamma(y), eta)

    return Batched(equation_at, lambda e: solve(route, [e])[0], route)


def equation(
    route: Route, beam: Beam, Omega: float, gamma: float, eta: float = 0.0
) -> HillEquation:
    """In closed form, or by Galerkin's quadrature; a rigid bar's matrices are kept."""
    if np.isfinite(beam.omega_L):
        return (beam.equation if route == "hill" else partial(galerkin, beam))(Omega, gamma, eta)
    rigid = _rigid(route, beam)
    return HillEquation(F=rigid.F, G=rigid.G, gamma=gamma, Omega=Omega, eta=eta)


def solve(route: Route, equations: Sequence[HillEquation]) -> Float:
    """Coefficients of P of each, (k, n + 1): from the infinite determinant, or in time."""
    return by_hill(equations) if route == "hill" else by_floquet(equations)


def by_hill(equations: Sequence[HillEquation]) -> Float:
    """P from the infinite determinant, (k, n + 1)."""
    # solving for an edge ends where two z are equal, and its bound on T, not used here, is not one
    with np.errstate(invalid="ignore"):
        return np.array([characteristic(equation).polynomial for equation in equations])


def by_floquet(equations: Sequence[HillEquation]) -> Float:
    """P from half a period of the undamped equation in u, Eq. (6.1.2), (k, n + 1)."""
    if len(equations) > 1 and len({equation.G.tobytes() for equation in equations}) == 1:
        return polynomials(equations).coefficients
    return np.array([_half_period(equation) for equation in equations])


def _half_period(equation: HillEquation) -> Float:
    """One equation: quicker alone than in a batch of one.

    As in `floquet.monodromy`, much growth makes the half period's inverse a poor one.
    """
    run, size = parameter_values(equation, undamped=True), shape(equation)
    half = np.pi / equation.Omega
    U = Taylor()(run, size, half)
    Phi, scale = second_half(U) if np.abs(U).max() < MUCH else (U, np.full_like(U, np.inf))
    if np.isinf(scale).any() or perron_root(scale) >= MAX_TERM_GROWTH:
        Phi = Taylor()(run, size, 2.0 * half)
    return np.real(np.poly(Phi[: size.n, : size.n]))


@lru_cache(maxsize=512)
def _rigid(route: Route, beam: Beam) -> HillEquation:
    """A rigid bar's F and G do not depend on Omega."""
    return beam.equation(1.0, 0.0) if route == "hill" else galerkin(beam, 1.0, 0.0)
