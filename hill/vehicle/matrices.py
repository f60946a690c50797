"""What the thrust does to a vehicle's modes: its matrices, by exact integration on each element."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from hill.arrays import EPS, Float
from hill.errors import LongitudinalResonance
from hill.vehicle.axial import Axial, axial, lowest
from hill.vehicle.modes import Modes, modes
from hill.vehicle.parts import Damping, Thrust
from hill.vehicle.shapes import PSI, Shapes, Y
from hill.vehicle.units import Units
from hill.vehicle.vehicle import MAX_MODES, Vehicle

# Rounding of an element of a matrix, over the largest; measured against the report's closed forms
# and against other meshes of the same vehicles.
MATRIX_ERROR = 64.0 * EPS


TOGETHER = 8
"""Modes are found so many, or twice, four times ... so many, at a time: those of N, N + 2, ... are
the same ones, found once."""


@dataclass(frozen=True, eq=False)
class Pull:
    """Matrices of a unit thrust, dimensionless; the lateral force is ``-T (matrix q)``.

    Attributes
    ----------
    steady : (n, n) ndarray
        Of P in steady acceleration, and of the force that follows or is turned at the thrust.
    cos, sin : (n, n) ndarray
        The same of a thrust cos(Omega t): what of it is with cos(Omega t) and with sin(Omega t).
    error : float
        Estimate of an element's error, over the largest element.
    """

    steady: Float
    cos: Float
    sin: Float
    error: float


@dataclass(frozen=True, eq=False)
class Structure:
    """A vehicle's modes, and what the thrust and the sensors do to them; dimensionless.

    Attributes
    ----------
    modes : Modes
    thrust_node : int
    mean : (n, n) ndarray
        Integrals of P y_i' y_j' of a unit thrust in steady acceleration.
    """

    modes: Modes
    thrust_node: int
    ends: tuple[str, str]
    mean: Float

    def of_the_lowest(self, number: int) -> "Structure":
        """The same with fewer elastic modes."""
        rows = [*range(number), *range(len(self.modes.lam), len(self.modes.shapes))]
        return replace(
            self,
            modes=replace(
                self.modes,
                lam=self.modes.lam[:number],
                shapes=Shapes(self.modes.mesh, self.modes.shapes.coefficients[rows]),
            ),
            mean=self.mean[np.ix_(rows, rows)],
        )

    @property
    def arm(self) -> Float:
        """Deflection at the thrust, (n,)."""
        x = float(self.modes.mesh.nodes[self.thrust_node])
        return np.asarray(self.modes.shapes.nodes[:, self.thrust_node, Y] * (not self.held(x, Y)))

    def rotation(self, x: float) -> Float:
        """Rotation at a station over the length, (n,)."""
        return np.asarray(self.modes.shapes.at(x)[:, PSI] * (not self.held(x, PSI)))

    def held(self, x: float, what: int) -> bool:
        """Whether an end at x holds y or psi; what is left of it there is rounding."""
        holds = {Y: ("pinned", "clamped"), PSI: ("clamped",)}[what]
        return any(end in holds and x == at for end, at in zip(self.ends, (0.0, 1.0), strict=True))

    def followed(self, vehicle: Vehicle) -> Float:
        """Direction of the thrust against the axis, (n,), as it turns with the vehicle."""
        follows = vehicle.thrust.direction == "follower"
        return np.asarray(follows * self.rotation(float(self.modes.mesh.nodes[self.thrust_node])))

    def gimbaled(self, vehicle: Vehicle) -> tuple[Float, Float]:
        """Turn of the gimbal by the coordinates and by their rates (times a time), (n,) each."""
        found = np.zeros((2, len(self.modes.shapes)))
        for sensor in vehicle.sensors:
            rotation = self.rotation(sensor.station / vehicle.length)
            found += np.outer([sensor.K_theta, sensor.K_rate], rotation)
        return found[0], found[1]


# a vehicle of 200 sections takes longer to be made anew than its matrices do
@lru_cache(maxsize=32)
def structure(vehicle: Vehicle) -> Structure:
    """Of a vehicle; remembered, for it does not depend on the thrust's size nor on the control."""
    return _structure(
        replace(
            vehicle,
            thrust=Thrust(0.0, vehicle.thrust_station),
            sensors=(),
            servo_time=0.0,
            damping=Damping(),
            g=0.0,
            axial_damping="report",
            quadrature_force=True,
            units=Units(),
        )
    )


@lru_cache(maxsize=32)
def _structure(vehicle: Vehicle) -> Structure:
    number = vehicle.modes
    together = TOGETHER
    while together < number:
        together *= 2
    together = min(together, MAX_MODES)
    if number < together:
        return _structure(replace(vehicle, modes=together)).of_the_lowest(number)
    found = modes(vehicle, number)
    node = found.mesh.node(vehicle.thrust_station / vehicle.length)
    steady = axial(found.mesh, vehicle.ends, node, 0.0)
    return Structure(found, node, vehicle.ends, found.shapes.slope_products(np.real(steady.force)))


@lru_cache(maxsize=32)
def _lowest_axial(known: Structure) -> float:
    return lowest(known.modes.mesh, known.ends)


def pulsating_force(known: Structure, vehicle: Vehicle, Omega: float) -> Axial:
    """The axial force of a unit thrust exp(i Omega t).

    Raises
    ------
    LongitudinalResonance
        It is infinite.
    """
    s: complex = (Omega * known.modes.mesh.scales.time) ** 2
    if vehicle.rigid_axially:
        s = 0.0
    elif vehicle.g > 0.0 and vehicle.axial_damping == "report":
        s = s - 1j * vehicle.g * _lowest_axial(known)
    elif vehicle.g > 0.0:
        s = s / (1.0 + 1j * vehicle.g)
    try:
        return axial(known.modes.mesh, known.ends, known.thrust_node, s)
    except LongitudinalResonance:
        raise LongitudinalResonance(
            f"Omega = {Omega:g} is a longitudinal resonance: the undamped axial force is infinite"
        ) from None


def pulls(known: Structure, vehicle: Vehicle, Omega: float, direction: Float) -> Pull:
    """Matrices of a unit thrust, steady and pulsating with Omega, turned by `direction`, (n,)."""
    side = np.outer(known.arm, direction)
    base = MATRIX_ERROR + 4.0 * known.modes.defect
    if vehicle.rigid_axially:
        steady = side - known.mean
        return Pull(steady, steady, np.zeros_like(steady), min(base, 1.0))
    pulsating = pulsating_force(known, vehicle, Omega)
    force, panels = pulsating.force, pulsating.panels
    shapes = known.modes.shapes
    # Re (p exp(i Omega t)) = Re p cos - Im p sin
    products = shapes.slope_products(np.asarray(force.real), panels)
    quadrature = np.zeros_like(products)
    if vehicle.quadrature_force and np.iscomplexobj(force):
        quadrature = shapes.slope_products(np.asarray(force.imag), panels)
    return Pull(
        side - known.mean,
        side - products,
        quadrature,
        min(base + MATRIX_ERROR * pulsating.amplified, 1.0),
    )
