"""A vehicle's matrices on its own lowest modes, from one set of elements."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from floquet.arrays import Float
from floquet.vehicle.axial import Bar, bar
from floquet.vehicle.bending import Modes, modes
from floquet.vehicle.mesh import Mesh, mesh
from hill import Damping, Sensor, Thrust, Vehicle

# Sets of elements that are kept: two for a vehicle, and a few vehicles in turn.
KEPT = 16


@dataclass(frozen=True, eq=False)
class Elements:
    """A vehicle's elements, and what holds at every thrust and frequency.

    Attributes
    ----------
    mesh : Mesh
    modes : Modes
    bar : Bar
    tension : (n, n) ndarray
        Integral of P w' y' in steady acceleration, per thrust.
    """

    mesh: Mesh
    modes: Modes
    bar: Bar
    tension: Float


@dataclass(frozen=True, eq=False)
class Reduced:
    r"""A vehicle's equation in the modes' coordinates, time over ``mesh.scales.time``.

    .. math::

       \ddot q + (C + \eta) \dot q + K q + (1 + \gamma \cos \Omega t)\, p\, \beta
           + \gamma (K_c \cos \Omega t + K_s \sin \Omega t) q = 0,
       \qquad \beta = a q + b \dot q

    Attributes
    ----------
    K, C, cosine, sine : (n, n) ndarray
        K_c, K_s: what the pulsating axial force and the thrust's direction do.
    push, angle, rate : (n,) ndarray
        p, a, b: the force of a gimbal turned by 1, and what turns it.
    eta : float
        Damping of every coordinate alike.
    """

    K: Float
    C: Float
    cosine: Float
    sine: Float
    push: Float
    angle: Float
    rate: Float
    eta: float

    def turned(self, Q: Float) -> "Reduced":
        """The same in the coordinates Q q, Q orthogonal."""
        return Reduced(
            K=Q @ self.K @ Q.T,
            C=Q @ self.C @ Q.T,
            cosine=Q @ self.cosine @ Q.T,
            sine=Q @ self.sine @ Q.T,
            push=Q @ self.push,
            angle=Q @ self.angle,
            rate=Q @ self.rate,
            eta=self.eta,
        )


def rotation_between(fine: Elements, coarse: Elements) -> Float:
    """The orthogonal Q that takes the coarse modes' coordinates to the fine ones', same mesh.

    Of modes of almost one frequency, any mixture may be found.
    """
    cut, one, other = fine.mesh, fine.modes, coarse.modes
    weight = np.ravel(cut.weight)
    density, inertia = (np.ravel(cut.properties[k]) for k in ("mass", "rotary_inertia"))
    overlap = (one.y * (weight * density)) @ other.y.T
    overlap += (one.rotation * (weight * inertia)) @ other.rotation.T
    overlap += (one.y_node * cut.point_mass) @ other.y_node.T
    overlap += (one.rotation_node * cut.point_inertia) @ other.rotation_node.T
    left, _, right = np.linalg.svd(overlap)
    return np.asarray(left @ right)


def elements(vehicle: Vehicle, refinements: int, order: int) -> Elements:
    """Elements of a vehicle, halved so often, of an order."""
    return _elements(_bare(vehicle), refinements, order)


@lru_cache(maxsize=KEPT)
def _bare(vehicle: Vehicle) -> Vehicle:
    """What of a vehicle the elements depend on."""
    return replace(
        vehicle,
        thrust=Thrust(station=vehicle.thrust_station),
        sensors=tuple(Sensor(sensor.station) for sensor in vehicle.sensors),
        damping=Damping(),
        servo_time=0.0,
        g=0.0,
        axial_damping="report",
        quadrature_force=True,
    )


@lru_cache(maxsize=KEPT)
def _elements(vehicle: Vehicle, refinements: int, order: int) -> Elements:
    cut = mesh(vehicle, refinements)
    shapes, rod = modes(vehicle, cut, order), bar(vehicle, cut, order)
    return Elements(cut, shapes, rod, _tension(cut, shapes, rod.force(0.0).real))


def _tension(cut: Mesh, shapes: Modes, force: Float) -> Float:
    return np.asarray((shapes.slope * (force * np.ravel(cut.weight))) @ shapes.slope.T)


def reduced(vehicle: Vehicle, found: Elements, Omega: float, eta: float) -> Reduced:
    """The vehicle's matrices at a forcing frequency.

    Raises
    ------
    LongitudinalResonance
        Omega is one, and undamped.
    """
    unit, shapes = found.mesh.scales, found.modes
    T0 = vehicle.thrust.mean / unit.force
    aft = found.mesh.node(vehicle.thrust_station)
    push = T0 * shapes.y_node[:, aft]
    follow = np.outer(push, shapes.rotation_node[:, aft])
    follow *= vehicle.thrust.direction == "follower"
    real, imaginary = _pulsating(vehicle, found, Omega)
    seen = [shapes.rotation_node[:, found.mesh.node(s.station)] for s in vehicle.sensors]
    none = np.zeros(len(push))
    return Reduced(
        K=np.diag(shapes.square) + follow - T0 * found.tension,
        C=_damping(vehicle, shapes, unit.time),
        cosine=follow - T0 * real,
        sine=T0 * imaginary,
        push=push,
        angle=sum((s.K_theta * row for s, row in zip(vehicle.sensors, seen, strict=True)), none),
        rate=sum(
            (s.K_rate / unit.time * row for s, row in zip(vehicle.sensors, seen, strict=True)), none
        ),
        eta=(vehicle.damping.eta + eta) * unit.time,
    )


def _pulsating(vehicle: Vehicle, found: Elements, Omega: float) -> tuple[Float, Float]:
    """Integrals of Re P w' y' and of Im P w' y', P = Re[P exp(i Omega t)] per thrust."""
    nothing = np.zeros_like(found.tension)
    if vehicle.rigid_axially:
        return found.tension, nothing
    square = complex((Omega * found.mesh.scales.time) ** 2)
    if vehicle.g > 0.0:
        if vehicle.axial_damping == "report":
            square -= 1j * vehicle.g * found.bar.lowest
        else:
            square /= 1.0 + 1j * vehicle.g
    P = found.bar.force(square)
    real = _tension(found.mesh, found.modes, P.real)
    if not vehicle.quadrature_force or vehicle.g == 0.0:
        return real, nothing
    return real, _tension(found.mesh, found.modes, P.imag)


def _damping(vehicle: Vehicle, shapes: Modes, time: float) -> Float:
    """Modal ratios and a matrix, added up."""
    damping, n = vehicle.damping, len(shapes.square)
    every = [damping.ratios[min(k, len(damping.ratios) - 1)] for k in range(n) if damping.ratios]
    matrix = np.diag(2.0 * np.array(every or [0.0] * n) * np.sqrt(shapes.square))
    if damping.matrix is not None:
        matrix += time * np.array(damping.matrix)
    return matrix
