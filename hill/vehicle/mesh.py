"""A vehicle cut into elements, dimensionless: short and even enough for a power series each.

Lengths are over the vehicle's, masses over its mass, stiffnesses over the harmonic mean of EI. A
frequency's square is then ``lambda = omega^2 M l^3/EI``, and a thrust is over ``EI/l^2``.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from hill.arrays import Float
from hill.errors import Refused
from hill.vehicle.parts import Section
from hill.vehicle.vehicle import Vehicle

# A property's change over half an element, over its value in the middle: a series about the middle
# falls like this to the n-th.
MAX_TAPER = 0.2

# lambda m h^4/EI of an element. One that is clamped at both ends has no frequency below lambda: by
# Wirtinger's inequality, (h/pi)^2 |f'|^2 >= |f|^2, that holds while 2 lambda m h^4/(pi^4 EI)
# + lambda r h^2/(pi^2 EI) < 1 and 2 lambda m h^2/(pi^2 kGA) < 1, and here they are .02 + .1 and .2.
MAX_BENDING = 1.0
MAX_SHEAR = 1.0

MAX_ELEMENTS = 20_000

MAX_RANGE = 1e12
"""Largest over smallest EI, or mass per length, of a vehicle: beyond it there is only rounding."""


@dataclass(frozen=True, eq=False)
class Scales:
    """What lengths, masses and stiffnesses are measured in.

    Attributes
    ----------
    length, mass, EI : float
        In the vehicle's units.
    """

    length: float
    mass: float
    EI: float

    @property
    def time(self) -> float:
        """A frequency is sqrt(lambda)/time."""
        return math.sqrt(self.mass / self.EI * self.length) * self.length

    @property
    def force(self) -> float:
        """A thrust's measure, EI/l^2."""
        return self.EI / self.length / self.length


@dataclass(frozen=True, eq=False)
class Mesh:
    """Elements from the nose to the aft end and rigid masses at their nodes.

    A property of an element is ``middle + half t``, t from -1 to 1 along it.

    Attributes
    ----------
    scales : Scales
    nodes : (elements + 1,) ndarray
        From 0 to 1.
    m, r, flexibility, shear, EA : (elements, 2) ndarray
        (middle, half) of mass and rotary inertia per length and of axial stiffness; of EI, and of
        kGA, the middle's inverse and half/middle. Infinite stiffnesses: (0, 0), for EA (inf, 0).
    mass, inertia : (elements + 1,) ndarray
        Rigid masses and their rotary inertia.
    most : float
        The largest lambda that the elements are short enough for.
    """

    scales: Scales
    nodes: Float
    m: Float
    r: Float
    flexibility: Float
    shear: Float
    EA: Float
    mass: Float
    inertia: Float
    most: float

    @property
    def elements(self) -> int:
        """How many there are."""
        return len(self.m)

    @cached_property
    def half(self) -> Float:
        """Half lengths."""
        return np.asarray(0.5 * np.diff(self.nodes))

    def node(self, x: float) -> int:
        """The node at a station that is one."""
        return int(np.argmin(np.abs(self.nodes - x)))


def scales(vehicle: Vehicle) -> Scales:
    """The vehicle's length, mass and harmonic mean of EI."""
    for name in ("EI", "mass_per_length"):
        values = [x for s in vehicle.sections for x in getattr(s, name)]
        if max(values) > MAX_RANGE * min(values):
            raise Refused(
                f"sections: {name} from {min(values):g} to {max(values):g}, it must not change by "
                f"more than {MAX_RANGE:g}"
            )
    mass = sum(s.length * 0.5 * sum(s.mass_per_length) for s in vehicle.sections)
    mass += sum(p.mass for p in vehicle.masses)
    bends = sum(s.length * _mean_inverse(*s.EI) for s in vehicle.sections)
    return Scales(vehicle.length, mass, vehicle.length / bends)


def mesh(vehicle: Vehicle, most: float) -> Mesh:
    """Elements short enough for every lambda up to `most`.

    Raises
    ------
    Refused
        The vehicle is too uneven: more elements than are worth while.
    """
    unit = scales(vehicle)
    starts, ends = np.array(vehicle.edges[:-1]), np.array(vehicle.edges[1:])
    breaks = {vehicle.thrust_station, *(p.station for p in vehicle.masses)}
    nodes, owner, t0, t1 = [0.0], [], [], []
    for k, section in enumerate(vehicle.sections):
        inner = sorted(x for x in breaks if starts[k] < x < ends[k])
        cuts = [(x - starts[k]) / section.length for x in inner]
        for a, b in zip([0.0, *cuts], [*cuts, 1.0], strict=True):
            grid = _cut(section, a, b, unit, most)
            owner += [k] * (len(grid) - 1)
            t0 += grid[:-1].tolist()
            t1 += grid[1:].tolist()
            nodes += ((starts[k] + section.length * grid[1:]) / unit.length).tolist()
        nodes[-1] = ends[k] / unit.length
        if len(nodes) > MAX_ELEMENTS:
            raise Refused(
                f"sections[{k + 1}]: the vehicle needs more than {MAX_ELEMENTS:,} elements, its "
                "properties change too much or too many modes are asked for"
            )
    made = Mesh(
        scales=unit,
        nodes=np.array(nodes),
        **_properties(vehicle.sections, np.array(owner), np.array(t0), np.array(t1), unit),
        mass=np.zeros(len(nodes)),
        inertia=np.zeros(len(nodes)),
        most=most,
    )
    for point in vehicle.masses:
        at = made.node(point.station / unit.length)
        made.mass[at] += point.mass / unit.mass
        made.inertia[at] += point.rotary_inertia / (unit.mass * unit.length**2)
    return made


def _properties(
    sections: tuple[Section, ...], owner: Float, t0: Float, t1: Float, unit: Scales
) -> dict[str, Any]:
    """m, r, flexibility, shear and EA of `Mesh`."""

    def linear(name: str, over: float) -> Float:
        pairs = np.array([getattr(s, name) for s in sections])[owner] / over
        finite = np.where(np.isinf(pairs), 0.0, pairs)
        slope = finite[:, 1] - finite[:, 0]
        return np.stack([pairs[:, 0] + slope * 0.5 * (t0 + t1), slope * 0.5 * (t1 - t0)], axis=1)

    def inverse(pair: Float) -> Float:
        return np.stack([1.0 / pair[:, 0], pair[:, 1] / pair[:, 0]], axis=1)

    per_length = unit.mass / unit.length
    return {
        "m": linear("mass_per_length", per_length),
        "r": linear("rotary_inertia", per_length * unit.length**2),
        "flexibility": inverse(linear("EI", unit.EI)),
        "shear": inverse(linear("kGA", unit.force)),
        "EA": linear("EA", unit.force),
    }


def _cut(section: Section, a: float, b: float, unit: Scales, most: float) -> Float:
    """Where part [a, b] of a section is cut, in shares of its length."""
    found = [a]
    while found[-1] < b:
        found.append(min(_next(section, found[-1], unit, most), b))
        if b - found[-1] < 1e-9 * (b - a):
            found[-1] = b
        if len(found) > MAX_ELEMENTS:
            raise Refused(
                f"a section of EI = {list(section.EI)} needs more than {MAX_ELEMENTS:,} elements: "
                "its properties change too much, or too many modes are asked for"
            )
    # equal parts where the section is uniform
    count = len(found) - 1
    uniform = all(
        p[0] == p[1]
        for p in (section.EI, section.mass_per_length, section.kGA, section.rotary_inertia)
    )
    return np.linspace(a, b, count + 1) if uniform and _even(section.EA) else np.array(found)


def _even(pair: tuple[float, float]) -> bool:
    return pair[0] == pair[1]


def _next(section: Section, t: float, unit: Scales, most: float) -> float:
    """The farthest end of an element that starts at t."""

    def at(name: str, t: float) -> float:
        start, end = getattr(section, name)
        return start if start == end else start + (end - start) * t

    step = 1.0 - t
    for name in ("EI", "kGA", "EA"):
        start, end = getattr(section, name)
        if start != end:
            # half/middle is MAX_TAPER where the value has changed by 2 MAX_TAPER/(1 -+ it)
            here, slope = at(name, t), end - start
            change = 2.0 * MAX_TAPER / (1.0 - math.copysign(MAX_TAPER, slope))
            step = min(step, change * here / abs(slope))
    stop = t + step
    length = section.length / unit.length
    EI = min(at("EI", t), at("EI", stop)) / unit.EI
    kGA = min(at("kGA", t), at("kGA", stop)) / unit.force
    m = max(at("mass_per_length", t), at("mass_per_length", stop)) * unit.length / unit.mass
    r = max(at("rotary_inertia", t), at("rotary_inertia", stop)) / unit.mass / unit.length
    step = min(step, (MAX_BENDING * EI / (most * m)) ** 0.25 / length)
    for inertia, stiffness in ((m, kGA), (r, EI)):
        if inertia > 0.0 and math.isfinite(stiffness):
            step = min(step, math.sqrt(MAX_SHEAR * stiffness / (most * inertia)) / length)
    return t + step


def _mean_inverse(start: float, end: float) -> float:
    """Mean of 1/(start + (end - start) t) for t from 0 to 1."""
    ratio = (end - start) / start
    return float(np.log1p(ratio) / ratio if abs(ratio) > 1e-8 else 1.0 - 0.5 * ratio) / start
