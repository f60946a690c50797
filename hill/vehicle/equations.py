"""A vehicle's equation: in the report's form where it has it, else general, or of first order."""

import numpy as np

from hill import checks
from hill.arrays import Complex, Float
from hill.equation import HillEquation
from hill.periodic import Fourier, PeriodicEquation
from hill.vehicle.matrices import Structure, pulls, structure
from hill.vehicle.vehicle import Vehicle


def equation(
    vehicle: Vehicle, Omega: float, gamma: float, eta: float = 0.0
) -> HillEquation | PeriodicEquation:
    """The equation under a forcing, as `Vehicle.equation`."""
    Omega = checks.positive("Omega", Omega)
    gamma = checks.number("gamma", gamma)
    eta = checks.number("eta", eta) + vehicle.damping.eta
    known = structure(vehicle)
    gain, rate = known.gimbaled(vehicle)
    servo = vehicle.servo_time > 0.0 and bool(np.any(gain) or np.any(rate))
    follows = known.followed(vehicle)
    pull = pulls(known, vehicle, Omega, follows if servo else follows + gain)
    per_time = known.modes.mesh.scales.time**-2
    size = _thrust(vehicle, known) * per_time
    F = elastic(known) * per_time + size * pull.steady
    G, S = size * pull.cos, size * pull.sin
    C, number = modal_damping(vehicle, known), eta * np.eye(len(F))
    if servo:
        # deflections and rotations of unit coordinates, in the vehicle's units
        unit = known.modes.mesh.scales
        push = vehicle.thrust.mean * known.arm / unit.mass**0.5
        seen = (x / (unit.mass**0.5 * unit.length) for x in (gain, rate))
        A = _with_servo(
            (F, gamma * G, gamma * S), C + number, (push, *seen), vehicle.servo_time, gamma
        )
        return PeriodicEquation.first_order(A=A, Omega=Omega, data_error=pull.error)
    rates = size * np.outer(known.arm, rate)
    if not (np.any(rates) or np.any(C) or np.any(S)):
        return HillEquation(F, G, gamma, Omega, eta, data_error=pull.error)
    return PeriodicEquation(
        K=_pulsating("K", F, gamma * G, gamma * S),
        C=_pulsating("C", C + number + rates, gamma * rates),
        Omega=Omega,
        data_error=pull.error,
    )


def natural_frequencies(vehicle: Vehicle) -> Float | Complex:
    """Under the mean thrust, undamped, the gimbal following at once; 1/time, ascending."""
    known = structure(vehicle)
    turned = known.followed(vehicle) + known.gimbaled(vehicle)[0]
    steady = np.outer(known.arm, turned) - known.mean
    F = elastic(known) + _thrust(vehicle, known) * steady
    roots = np.sqrt(np.linalg.eigvals(F).astype(complex)) / known.modes.mesh.scales.time
    roots = roots[np.lexsort((roots.imag, roots.real))]
    return roots if np.any(roots.imag) else roots.real.copy()


def unloaded_frequencies(vehicle: Vehicle) -> Float:
    """Of the elastic modes without thrust, 1/time, ascending."""
    known = structure(vehicle)
    return np.sqrt(known.modes.lam) / known.modes.mesh.scales.time


def _thrust(vehicle: Vehicle, known: Structure) -> float:
    """The mean thrust, dimensionless."""
    return vehicle.thrust.mean / known.modes.mesh.scales.force


def elastic(known: Structure) -> Float:
    """Squares of the frequencies without thrust on the diagonal, 0 for a rotation."""
    lam = known.modes.lam
    return np.diag(np.append(lam, np.zeros(len(known.modes.shapes) - len(lam))))


def modal_damping(vehicle: Vehicle, known: Structure) -> Float:
    """Modal ratios and the matrix, 1/time."""
    n = len(known.modes.shapes)
    found = np.zeros((n, n))
    ratios = vehicle.damping.ratios
    if ratios:
        each = [ratios[min(k, len(ratios) - 1)] for k in range(vehicle.modes)]
        elastic = np.arange(vehicle.modes)
        found[elastic, elastic] = 2.0 * np.array(each) * unloaded_frequencies(vehicle)
    if vehicle.damping.matrix is not None:
        found += np.array(vehicle.damping.matrix)
    return found


def _pulsating(name: str, mean: Float, cos: Float, sin: Float | None = None) -> Fourier:
    """A mean and one harmonic, left out where it is 0."""
    return Fourier(
        mean,
        cos={1: cos} if np.any(cos) else None,
        sin={1: sin} if sin is not None and np.any(sin) else None,
        name=name,
    )


def _with_servo(
    stiffness: tuple[Float, Float, Float],
    damping: Float,
    gimbal: tuple[Float, ...],
    servo_time: float,
    gamma: float,
) -> Fourier:
    """A of x' = A x for x = (q, q', theta), theta the gimbal's angle.

    q'' + C q' + K q + push (1 + gamma cos Omega t) theta = 0 and
    servo_time theta' + theta = gain q + rate q'.
    """
    n = len(damping)
    push, gain, rate = gimbal

    def lower(K: Float, force: Float) -> Float:
        A = np.zeros((2 * n + 1, 2 * n + 1))
        A[n:-1, :n], A[n:-1, -1] = -K, -force
        return A

    mean = lower(stiffness[0], push)
    mean[:n, n:-1] = np.eye(n)
    mean[n:-1, n:-1] = -damping
    mean[-1] = np.concatenate([gain, rate, [-1.0]]) / servo_time
    return _pulsating("A", mean, lower(stiffness[1], gamma * push), lower(stiffness[2], 0.0 * push))
