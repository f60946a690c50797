"""Every number by both routes; they must agree within their own error bounds, or nothing counts."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.report.claims.finding import Number
from floquet import monodromy
from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic

Beam = UniformBeam | SteppedBeam
Complex = NDArray[np.complexfloating[Any, Any]]

# Natural frequencies: eigenvalues of F, closed form against quadrature, differ by 1e-13 at most.
FREQUENCY_TOLERANCE = 1e-9
# Boundaries are bisected so often, then a parabola finds them; nine more would move them by 3e-5 of
# the region's radius at most, measured over Tables 1 and 2, damped and not.
BISECTIONS = 4


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


@cache
def both(
    beam: Beam, Omega: float, gamma: float = 0.1, eta: float = 0.0, initial_terms: int = 0
) -> Both:
    """Solve by both routes.

    Raises
    ------
    RoutesDisagree
        P(z) or T differ by more than the sum of the two error bounds.
    """
    closed = beam.equation(Omega, gamma, eta, initial_terms)
    return solve(closed, galerkin(beam, Omega, gamma, eta, initial_terms), str(beam))


def solve(closed: HillEquation, summed: HillEquation, what: str) -> Both:
    """The same for an equation given twice, its matrices found in two ways."""
    h, f = characteristic(closed), monodromy(summed)
    at = (
        f"at Omega = {closed.Omega:.9g}, gamma = {closed.gamma:g}, eta = {closed.damping:g}; {what}"
    )
    apart = float(np.max(np.abs(h.polynomial - f.polynomial)))
    if apart > h.error + f.error or abs(h.T - f.T) > h.T_error + f.T_error:
        raise RoutesDisagree(
            f"the routes disagree: P(z) by {apart:.1e} where {h.error + f.error:.1e} is allowed, "
            f"T by {abs(h.T - f.T):.1e} where {h.T_error + f.T_error:.1e} is, {at}"
        )
    shown = {h.verdict, f.verdict} - {"undecided"}
    if len(shown) != 1:
        raise ValueError(
            f"undecided: T = {h.T:.2e} and {f.T:.2e}, error bounds {h.T_error:.1e} and "
            f"{f.T_error:.1e}, {at}"
        )
    stable = shown == {"stable"}
    neutral = stable and closed.damping == 0.0
    return Both(0.0 if neutral else h.T, 0.0 if neutral else f.T, stable, h.z)


@cache
def frequencies(beam: Beam) -> tuple[tuple[complex, ...], tuple[complex, ...]]:
    """Natural frequencies under the constant thrust, from both routes' F.

    Raises
    ------
    RoutesDisagree
        They differ.
    """
    squares = np.linalg.eigvals(galerkin(beam, 1.0, 0.0).F).astype(complex)
    own = np.linalg.eigvals(beam.equation(1.0, 0.0).F).astype(complex)
    h, f = (np.sort_complex(np.round(w, 12) + 0.0) for w in (own, squares))
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
    beam: Beam,
    unstable: float,
    stable: float,
    gamma: float = 0.1,
    eta: float = 0.0,
    *,
    farther: tuple[float, ...] = (),
) -> float:
    """The forcing frequency between an unstable and a stable one where stability begins.

    By halves, and then where (T + eta)**2, nearly a parabola in Omega, comes down to eta**2; it is
    laid through the three innermost unstable points known. `farther` are some that lie farther in.
    """
    inside = [*farther, unstable]
    for _ in range(BISECTIONS):
        middle = 0.5 * (unstable + stable)
        if both(beam, middle, gamma, eta).stable:
            stable = middle
        else:
            unstable = middle
            inside.append(middle)
    middle = 0.5 * (unstable + stable)
    x = np.array(inside[-3:])
    above = [(both(beam, float(at), gamma, eta).hill + eta) ** 2 - eta**2 for at in x]
    roots = middle + np.roots(np.polyfit(x - middle, above, len(x) - 1))
    between = [
        float(root.real)
        for root in roots
        if root.imag == 0.0 and min(unstable, stable) <= root.real <= max(unstable, stable)
    ]
    return between[0] if between else middle


def edge(
    beam: Beam, start: float, step: float, gamma: float = 0.1, eta: float = 0.0, most: int = 60
) -> float:
    """From an unstable `start` outward by `step` to the first stable point, then back by halves.

    Raises
    ------
    ValueError
        `start` is stable, or `most` steps meet no stable point.
    """
    if both(beam, start, gamma, eta).stable:
        raise ValueError(f"Omega = {start:g} is stable, no region of instability to measure")
    at = start
    farther: tuple[float, ...] = ()
    for _ in range(most):
        if both(beam, at + step, gamma, eta).stable:
            return boundary(beam, at, at + step, gamma, eta, farther=farther)
        at, farther = at + step, (*farther, at)
    raise ValueError(f"no stable point within {most} steps of {step:g} from Omega = {start:g}")


def severest(beam: Beam, Omegas: NDArray[np.float64], gamma: float = 0.1, eta: float = 0.0) -> Both:
    """The largest T among some forcing frequencies."""
    found = [both(beam, float(Omega), gamma, eta) for Omega in Omegas]
    return max(found, key=lambda point: point.hill)
