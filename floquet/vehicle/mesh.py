"""Elements along a vehicle: where they end, and what the vehicle is like within them.

Everything is over the vehicle's length, its mean mass per length and a mean bending stiffness, so
that frequencies are over sqrt(EI/(m l^4)): the elements' matrices are then of one size.
"""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from floquet.arrays import Float
from hill import Vehicle

if TYPE_CHECKING:
    from skfem import MeshLine

# Bending waves of the highest mode asked for, in radians an element. At 2 elements of order 10 know
# the highest of ten modes of a uniform beam to 1e-14 (`tests/test_vehicle_elements.py`).
PHASE = 2.0

# Gauss points an element: exact for two modes of order 14 and an axial force of order 18.
POINTS = 24

# Stations closer than this share of the length are one: sums of lengths are rounded.
SAME_STATION = 1e-12


@dataclass(frozen=True)
class Scales:
    """Units in which the elements compute.

    Attributes
    ----------
    length, mass, stiffness : float
        The vehicle's length, its mean mass per length, and EI.
    """

    length: float
    mass: float
    stiffness: float

    @property
    def time(self) -> float:
        """Sqrt(m l^4/EI)."""
        return math.sqrt(self.mass / self.stiffness) * self.length**2

    @property
    def force(self) -> float:
        """EI/l^2."""
        return self.stiffness / self.length**2


@dataclass(frozen=True, eq=False)
class Mesh:
    """Elements of a vehicle, dimensionless.

    Attributes
    ----------
    nodes : (k + 1,) ndarray
        From 0 to 1. Every station of the vehicle is one.
    line : skfem.MeshLine
        The same.
    x : (k, POINTS) ndarray
        Gauss points.
    weight : (k, POINTS) ndarray
    properties : dict of str to (k, POINTS) ndarray
        mass, flexibility (1/EI), rotary_inertia, shear_flexibility, axial_flexibility.
    point_mass, point_inertia : (k + 1,) ndarray
        Rigid masses at the nodes and their rotary inertia.
    scales : Scales
    """

    nodes: Float
    line: "MeshLine"
    x: Float
    weight: Float
    properties: dict[str, Float]
    point_mass: Float
    point_inertia: Float
    scales: Scales

    def node(self, station: float) -> int:
        """The node at a station, in the vehicle's units."""
        return int(np.argmin(np.abs(self.nodes - station / self.scales.length)))


def scales(vehicle: Vehicle) -> Scales:
    """Units that make the vehicle's numbers of order 1."""
    length = math.fsum(s.length for s in vehicle.sections)
    mass = math.fsum(0.5 * s.length * sum(s.mass_per_length) for s in vehicle.sections)
    mean = math.fsum(0.5 * s.length * sum(map(math.log, s.EI)) for s in vehicle.sections)
    return Scales(length, mass / length, math.exp(mean / length))


def mesh(vehicle: Vehicle, refinements: int = 0) -> Mesh:
    """Elements short enough for the modes that the vehicle asks for.

    Mode N has about N pi radians over the whole vehicle (WKB), spread like (m/EI)^(1/4).

    Parameters
    ----------
    vehicle : Vehicle
    refinements : int, optional
        How often each element is halved.

    Raises
    ------
    ModuleNotFoundError
        scikit-fem is not there.
    """
    from skfem import MeshLine

    unit = scales(vehicle)
    edges = np.cumsum([0.0, *(s.length / unit.length for s in vehicle.sections)])
    edges[-1] = 1.0
    joints = _joints(vehicle, edges, unit.length)
    owner = np.searchsorted(edges, 0.5 * (joints[1:] + joints[:-1])) - 1
    slowness = np.array([_slowness(vehicle, int(k)) for k in owner])
    waves = slowness * np.diff(joints)
    phase = (vehicle.modes + 2) * np.pi * waves / waves.sum()
    counts = np.maximum(np.ceil(phase / PHASE), 1).astype(int) * 2**refinements
    parts = [
        np.linspace(a, b, n + 1)[:-1] for (a, b), n in zip(pairwise(joints), counts, strict=True)
    ]
    nodes = np.append(np.concatenate(parts), 1.0)
    node, weight = rule()
    h = np.diff(nodes)[:, None]
    x = nodes[:-1, None] + h * node
    made = Mesh(
        nodes=nodes,
        line=MeshLine(nodes),
        x=x,
        weight=h * weight,
        properties=_properties(vehicle, x, edges, np.repeat(owner, counts), unit),
        point_mass=np.zeros(len(nodes)),
        point_inertia=np.zeros(len(nodes)),
        scales=unit,
    )
    whole = unit.mass * unit.length
    for part in vehicle.masses:
        k = made.node(part.station)
        made.point_mass[k] += part.mass / whole
        made.point_inertia[k] += part.rotary_inertia / (whole * unit.length**2)
    return made


def rule() -> tuple[Float, Float]:
    """Gauss's nodes and weights on [0, 1]."""
    node, weight = np.polynomial.legendre.leggauss(POINTS)
    return 0.5 * (1.0 + node), 0.5 * weight


def _joints(vehicle: Vehicle, edges: Float, length: float) -> Float:
    """Every station over the length, ascending; an edge stands for what is as good as on it."""
    stations = [vehicle.thrust_station]
    stations += [mass.station for mass in vehicle.masses]
    stations += [sensor.station for sensor in vehicle.sensors]
    found = list(edges)
    for station in sorted(x / length for x in stations):
        if np.min(np.abs(np.array(found) - station)) > SAME_STATION:
            found.append(station)
    return np.sort(np.array(found))


def _slowness(vehicle: Vehicle, section: int) -> float:
    """(m/EI)^(1/4) of a section, at its softer end."""
    s = vehicle.sections[section]
    return float((max(s.mass_per_length) / min(s.EI)) ** 0.25)


def _properties(
    vehicle: Vehicle, x: Float, edges: Float, owner: NDArray[np.intp], unit: Scales
) -> dict[str, Float]:
    share = (x - edges[owner, None]) / (edges[owner + 1] - edges[owner])[:, None]

    def linear(name: str) -> Float:
        ends = {
            "mass_per_length": [s.mass_per_length for s in vehicle.sections],
            "rotary_inertia": [s.rotary_inertia for s in vehicle.sections],
            "EI": [s.EI for s in vehicle.sections],
            "kGA": [s.kGA for s in vehicle.sections],
            "EA": [s.EA for s in vehicle.sections],
        }[name]
        start, end = np.array(ends)[owner].T[:, :, None]
        rise = np.where(np.isinf(start), 0.0, np.where(np.isinf(end), 0.0, end) - start)
        return np.asarray(start + share * rise)

    return {
        "mass": linear("mass_per_length") / unit.mass,
        "flexibility": unit.stiffness / linear("EI"),
        "rotary_inertia": linear("rotary_inertia") / (unit.mass * unit.length**2),
        "shear_flexibility": unit.force / linear("kGA"),
        "axial_flexibility": unit.force / linear("EA"),
    }
