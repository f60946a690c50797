"""The witness's equation of a vehicle: finite elements, refined until they know enough."""

from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np

from floquet.arrays import EPS, Float
from floquet.vehicle.assemble import Equation, assembled
from floquet.vehicle.reduce import Reduced, elements, reduced, rotation_between
from hill import Vehicle, checks

TOLERANCE = 1e-11
"""Of each matrix, over its largest element."""

# Orders of the elements, each tried against the one before; the higher of the two is kept.
ORDERS = (6, 8, 10, 12, 14)

# Halvings of every element before the best that was found is taken.
MAX_REFINEMENTS = 4

# A refinement that brings less than this factor is up against rounding.
PROGRESS = 0.5

# On the difference of two discretisations.
SAFETY = 4.0

# What two discretisations have in common, the rounding of the vehicle's own numbers, in ulps.
ROUNDING = 64.0 * EPS

# Over it is divided.
SMALLEST = 1e-300

NO_ELEMENTS = (
    "a vehicle's finite elements need scikit-fem: pip install 'floquet-crosscheck[vehicle]'"
)


@dataclass(frozen=True, eq=False)
class Discretised:
    """A vehicle's equation by finite elements.

    Attributes
    ----------
    best : HillEquation or PeriodicEquation
        In the vehicle's own units. Its `data_error` is an estimate of the discretisation's.
    rougher : HillEquation or PeriodicEquation
        From elements of the order before: how far it is off bounds how far the other is. Its
        `data_error` is what the two have in common, the rounding of the vehicle's own numbers.
    """

    best: Equation
    rougher: Equation


def discretised(vehicle: Vehicle, Omega: float, gamma: float, eta: float = 0.0) -> Equation:
    """A vehicle's equation by finite elements, on as many of its own modes as it asks for.

    As `discretise`.
    """
    return discretise(vehicle, Omega, gamma, eta).best


def rougher(vehicle: Vehicle, Omega: float, gamma: float, eta: float = 0.0) -> Equation:
    """The same from the elements before the last refinement."""
    return discretise(vehicle, Omega, gamma, eta).rougher


def discretise(
    vehicle: Vehicle,
    Omega: float,
    gamma: float,
    eta: float = 0.0,
    tolerance: float = TOLERANCE,
) -> Discretised:
    """Refine the elements until their own estimate is below a tolerance.

    Parameters
    ----------
    vehicle : Vehicle
    Omega : float
        Forcing frequency, radians over the vehicle's unit of time.
    gamma : float
        Thrust ratio.
    eta : float, optional
        Damping of every coordinate beside the vehicle's own, over the unit of time.
    tolerance : float, optional
        Or until rounding stops them.

    Raises
    ------
    LongitudinalResonance
        `Omega` is one, and undamped.
    ValueError
        A forcing out of range; scikit-fem is not installed.
    """
    if find_spec("skfem") is None:
        raise ValueError(NO_ELEMENTS)
    Omega = checks.positive("Omega", Omega)
    gamma, eta = checks.number("gamma", gamma), checks.number("eta", eta)
    best, kept = np.inf, None
    for refinements in range(MAX_REFINEMENTS + 1):
        before = best
        for order, lower in zip(ORDERS[1:], ORDERS, strict=False):
            fine, coarse = (elements(vehicle, refinements, p) for p in (order, lower))
            own = reduced(vehicle, fine, Omega, eta)
            other = reduced(vehicle, coarse, Omega, eta).turned(rotation_between(fine, coarse))
            apart = _apart(own, other, vehicle.servo_time > 0.0)
            if apart < best:
                best, kept = apart, (own, other, fine.mesh.scales)
            if SAFETY * best <= tolerance:
                break
        if SAFETY * best <= tolerance or best > PROGRESS * before:
            break
    assert kept is not None
    own, other, unit = kept
    error = min(SAFETY * best + ROUNDING, 1.0)
    return Discretised(
        assembled(vehicle, own, unit, Omega, gamma, error),
        assembled(vehicle, other, unit, Omega, gamma, ROUNDING),
    )


def _apart(one: Reduced, other: Reduced, servo: bool) -> float:
    """Largest difference of an element, over the largest of its kind in the equation."""
    return max(
        max(float(np.max(np.abs(a - b))) for a, b in zip(kind, same, strict=True))
        / max(max(float(np.max(np.abs(a))) for a in kind), SMALLEST)
        for kind, same in zip(_kinds(one, servo), _kinds(other, servo), strict=True)
    )


def _kinds(own: Reduced, servo: bool) -> list[list[Float]]:
    """What the equation is made of, by kinds over the largest of which an error is."""
    if servo:
        alone = [[own.K], [own.C], [own.push], [own.angle], [own.rate]]
        return [*alone, [own.cosine, own.sine]]
    turn, turn_rate = np.outer(own.push, own.angle), np.outer(own.push, own.rate)
    return [[own.K + turn], [own.cosine + turn, own.sine], [own.C + turn_rate, turn_rate]]
