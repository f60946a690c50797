"""Every number by both routes; they must agree within their own error bounds, or nothing counts."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.both_routes import compare_routes
from compare.report.claims.finding import Number
from compare.report.one_route import ROUTES, Beam, RouteName, equation, solve
from compare.report.steady import natural_frequencies
from compare.report.tables import GAMMA
from compare.stability.indicators import indicator, zero
from floquet.weak_form import galerkin
from hill import HillEquation, PeriodicEquation

Complex = NDArray[np.complexfloating[Any, Any]]
Float = NDArray[np.floating[Any]]

# Natural frequencies: eigenvalues of F, closed form against quadrature, differ by 1e-13 at most.
FREQUENCY_TOLERANCE = 1e-9
# Boundaries have no bounds of their own: of the 102 that the claims have, the two routes' are 3e-12
# apart at most.
BOUNDARY_TOLERANCE = 1e-9
# All the claims together ask for 1,600 points.
KEPT = 8192


class RoutesDisagree(ValueError):
    """The two routes differ by more than their error bounds allow."""


@dataclass(frozen=True, eq=False)
class Both:
    """T by either route at one point; zero where it is shown to be stable undamped."""

    hill: float
    floquet: float
    stable: bool
    z: Complex

    def number(self, label: str, digits: int = 5) -> Number:
        """T as a number of a finding."""
        return Number(label, self.hill, self.floquet, digits)


@dataclass(frozen=True)
class Boundary:
    """A forcing frequency at which stability begins, by either route."""

    hill: float
    floquet: float

    def number(self, label: str, digits: int = 3) -> Number:
        """The frequency as a number of a finding."""
        return Number(label, self.hill, self.floquet, digits)


def by_both(label: str, value: Callable[[RouteName], float], digits: int) -> Number:
    """A number of a finding from a function of the route."""
    return Number(label, value("hill"), value("floquet"), digits)


@lru_cache(maxsize=KEPT)
def both(
    beam: Beam, Omega: float, gamma: float = GAMMA, eta: float = 0.0, initial_terms: int = 0
) -> Both:
    """Solve by both routes.

    Raises
    ------
    RoutesDisagree
        P(z) or T differ by more than the sum of the two error bounds.
    """
    closed = beam.equation(Omega, gamma, eta, initial_terms)
    return solve_both(closed, galerkin(beam, Omega, gamma, eta, initial_terms), str(beam))


def solve_both(
    closed: HillEquation | PeriodicEquation, summed: HillEquation | PeriodicEquation, what: str
) -> Both:
    """The same for an equation given twice, its matrices found in two ways."""
    x = compare_routes(closed, summed)
    h, f = x.hill, x.floquet
    at, damping = f"at Omega = {closed.Omega:.9g}", float("nan")
    if isinstance(closed, HillEquation):
        damping = closed.damping
        at += f", gamma = {closed.gamma:g}, eta = {damping:g}"
    at += f"; {what}"
    if not x.routes_agree or abs(h.T - f.T) > h.T_error + f.T_error:
        raise RoutesDisagree(
            f"the routes disagree: P(z) by {x.difference:.1e} where {x.bound:.1e} is allowed, "
            f"T by {abs(h.T - f.T):.1e} where {h.T_error + f.T_error:.1e} is, {at}"
        )
    if x.verdict == "undecided":
        raise ValueError(
            f"undecided: T = {h.T:.2e} and {f.T:.2e}, error bounds {h.T_error:.1e} and "
            f"{f.T_error:.1e}, {at}"
        )
    neutral = x.stable and damping == 0.0
    return Both(0.0 if neutral else h.T, 0.0 if neutral else f.T, x.stable, h.z)


@lru_cache(maxsize=512)
def frequencies(beam: Beam) -> tuple[tuple[complex, ...], tuple[complex, ...]]:
    """Natural frequencies under the constant thrust, from both routes' F.

    Raises
    ------
    RoutesDisagree
        They differ.
    """
    squares = [natural_frequencies(route, beam) ** 2 for route in ROUTES]
    h, f = (np.sort_complex(np.round(w, 12) + 0.0) for w in squares)
    scale = float(np.max(np.abs(h)))
    if not np.allclose(h, f, rtol=0.0, atol=FREQUENCY_TOLERANCE * scale):
        raise RoutesDisagree(f"the routes' natural frequencies disagree: {beam}")
    roots = [tuple(complex(w) for w in np.sqrt(squared)) for squared in (h, f)]
    return roots[0], roots[1]


def real_frequencies(beam: Beam) -> tuple[float, ...]:
    """omega_(B), omega_(1), ... of a beam that is stable under the constant thrust."""
    found = frequencies(beam)[0]
    if any(abs(w.imag) > 0.0 for w in found):
        raise ValueError(f"{beam}: unstable under the constant thrust alone")
    return tuple(sorted(w.real for w in found))


def boundary(
    beam: Beam, unstable: float, stable: float, gamma: float = GAMMA, eta: float = 0.0
) -> Boundary:
    """The forcing frequency between an unstable and a stable one where stability begins.

    Raises
    ------
    RoutesDisagree
        Each route finds another.
    """
    between = sorted((unstable, stable))
    h, f = (zero(_margin(route, beam, gamma, eta), between[0], between[1]) for route in ROUTES)
    if abs(h - f) > BOUNDARY_TOLERANCE:
        raise RoutesDisagree(f"the routes' boundaries disagree: {h:.12g} and {f:.12g}; {beam}")
    return Boundary(h, f)


def _margin(route: RouteName, beam: Beam, gamma: float, eta: float) -> Any:
    """A function of Omega, negative where a system of three coordinates is unstable."""

    def least(Omega: Float) -> Float:
        P = solve(route, [equation(route, beam, float(x), gamma, eta) for x in Omega])
        kinds = ("+1", "-1", "pair")
        return np.min([indicator(kind, P, Omega, eta) for kind in kinds], axis=0)

    return least


def edge(
    beam: Beam, start: float, step: float, gamma: float = GAMMA, eta: float = 0.0, most: int = 60
) -> Boundary:
    """From an unstable `start` outward by `step` to the first stable point, and the zero before it.

    Raises
    ------
    ValueError
        `start` is stable, or `most` steps meet no stable point.
    """
    if both(beam, start, gamma, eta).stable:
        raise ValueError(f"Omega = {start:g} is stable, no region of instability to measure")
    at = start
    for _ in range(most):
        if both(beam, at + step, gamma, eta).stable:
            return boundary(beam, at, at + step, gamma, eta)
        at += step
    raise ValueError(f"no stable point within {most} steps of {step:g} from Omega = {start:g}")


def severest(
    beam: Beam, Omegas: NDArray[np.float64], gamma: float = GAMMA, eta: float = 0.0
) -> Both:
    """The largest T among some forcing frequencies."""
    found = [both(beam, float(Omega), gamma, eta) for Omega in Omegas]
    return max(found, key=lambda point: point.hill)
