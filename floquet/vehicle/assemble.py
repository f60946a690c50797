"""From a vehicle's matrices to an equation: what kind it is, and in the vehicle's unit of time."""

import numpy as np

from floquet.arrays import Float
from floquet.vehicle.mesh import Scales
from floquet.vehicle.reduce import Reduced
from hill import Fourier, HillEquation, PeriodicEquation, Vehicle

Equation = HillEquation | PeriodicEquation


def assembled(
    vehicle: Vehicle,
    own: Reduced,
    unit: Scales,
    Omega: float,
    gamma: float,
    data_error: float,
) -> Equation:
    """The equation of a vehicle's matrices, in the vehicle's units.

    With a servo one of first order, of q, q' and the gimbal's angle; Hill's where nothing but one
    number damps it and the axial force has no sine; else one of second order.
    """
    time = unit.time
    if vehicle.servo_time > 0.0 and (np.any(own.angle) or np.any(own.rate)):
        A = _with_servo(own, unit, vehicle.servo_time, gamma)
        return PeriodicEquation.first_order(A=A, Omega=Omega, data_error=data_error)
    turn = np.outer(own.push, own.angle)
    turn_rate = np.outer(own.push, own.rate)
    K, C = (own.K + turn) / time**2, (own.C + turn_rate) / time
    G, sine = (own.cosine + turn) / time**2, own.sine / time**2
    if not (np.any(C) or np.any(sine)):
        return HillEquation(K, G, gamma, Omega, own.eta / time, data_error=data_error)
    return PeriodicEquation(
        K=_pulsating(K, gamma * G, gamma * sine),
        C=_pulsating(C + own.eta / time * np.eye(len(C)), gamma * turn_rate / time),
        Omega=Omega,
        data_error=data_error,
    )


def _with_servo(own: Reduced, unit: Scales, servo_time: float, gamma: float) -> Fourier:
    """A of x' = A x, x = (q, q', beta), servo_time beta' = a q + b q' - beta.

    beta is the gimbal's angle itself, so that q is in the vehicle's units, mass^(1/2) length.
    """
    n, time = len(own.push), unit.time
    coordinate = (unit.mass * unit.length) ** 0.5 * unit.length
    push = coordinate * own.push
    mean, cosine, sine = (np.zeros((2 * n + 1, 2 * n + 1)) for _ in range(3))
    mean[:n, n : 2 * n] = np.eye(n)
    mean[n : 2 * n, :n] = -own.K / time**2
    mean[n : 2 * n, n : 2 * n] = -(own.C + own.eta * np.eye(n)) / time
    mean[n : 2 * n, -1] = -push / time**2
    turned = np.concatenate([own.angle, own.rate * time]) / coordinate
    mean[-1] = np.append(turned, -1.0) / servo_time
    cosine[n : 2 * n, :n] = -gamma * own.cosine / time**2
    cosine[n : 2 * n, -1] = -gamma * push / time**2
    sine[n : 2 * n, :n] = -gamma * own.sine / time**2
    return _pulsating(mean, cosine, sine)


def _pulsating(mean: Float, cosine: Float, sine: Float | None = None) -> Fourier:
    return Fourier(
        mean,
        cos={1: cosine} if np.any(cosine) else {},
        sin={1: sine} if sine is not None and np.any(sine) else {},
    )
