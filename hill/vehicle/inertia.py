"""A vehicle as a rigid body: mass, centre of mass, moment of inertia."""

import math
from dataclasses import dataclass

from hill.vehicle.vehicle import Vehicle


@dataclass(frozen=True)
class RigidBody:
    """In the vehicle's units.

    Attributes
    ----------
    mass : float
    centre : float
        Station of the centre of mass.
    inertia : float
        About it, lateral.
    """

    mass: float
    centre: float
    inertia: float


def rigid_body(vehicle: Vehicle) -> RigidBody:
    """The sums over sections, whose mass is linear between their ends, and masses."""
    mass, moment, second = [], [], []
    for start, s in zip(vehicle.edges, vehicle.sections, strict=False):
        a, b = s.mass_per_length
        own = 0.5 * s.length * (a + b)
        # from the section's start: integrals of m x and m x^2
        first = s.length**2 * (a + 2.0 * b) / 6.0
        square = s.length**3 * (a + 3.0 * b) / 12.0
        mass.append(own)
        moment.append(own * start + first)
        second.append(own * start**2 + 2.0 * start * first + square)
        second.append(0.5 * s.length * sum(s.rotary_inertia))
    for point in vehicle.masses:
        mass.append(point.mass)
        moment.append(point.mass * point.station)
        second.append(point.mass * point.station**2 + point.rotary_inertia)
    whole = math.fsum(mass)
    centre = math.fsum(moment) / whole
    return RigidBody(whole, centre, math.fsum([*second, -whole * centre**2]))
