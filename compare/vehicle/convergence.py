"""How many modes are enough: what a study says with N, N + 2, ... of them, and where it goes."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from compare.vehicle.critical import critical_gamma
from compare.vehicle.near import Band, Near
from hill import CriticalThrust, Vehicle, critical_thrust
from hill.averaging import Resonance
from hill.errors import Refused
from hill.oscillations.steady import steady
from hill.vehicle.convergence import extrapolated
from hill.vehicle.vehicle import MAX_MODES

STEP = 2
"""Modes that are added at a time: the odd and the even ones of a like vehicle take turns."""

FEWEST = 3
"""Times that they are added at least: a limit is taken from four values."""

# Of the thrust that is too much with fewer modes: where the search for it with more begins.
FROM = 0.5
# A thrust with more modes is shown safe to this gap below, over it.
THRUST = 1e-3


@dataclass(frozen=True)
class Settling:
    """One answer with more and more modes.

    Attributes
    ----------
    of : Resonance or None
        None for what steady thrust does.
    what : {"critical thrust", "T", "width", "critical pulsation ratio"}
        A width in Omega, radians per unit of time.
    modes : tuple of int
    values : tuple of float or None
        None where there is no such answer.
    limit, error : float or None
        Extrapolated to all modes, and an estimate of its error; None where a value is missing.
    """

    of: Resonance | None
    what: str
    modes: tuple[int, ...]
    values: tuple[float | None, ...]
    limit: float | None
    error: float | None


def settling(
    vehicle: Vehicle,
    gamma: float,
    eta: float,
    loss: CriticalThrust | None,
    own: Sequence[tuple[Band, float | None]],
    more: int,
    progress: Callable[[int, int], None] = lambda *_: None,
) -> tuple[Settling, ...]:
    """What more modes change of the thrust that is too much and of some resonances.

    Parameters
    ----------
    vehicle : Vehicle
    gamma, eta : float
    loss : CriticalThrust or None
        With the vehicle's own modes; None without thrust.
    own : sequence of (Band, float or None)
        The resonances, and where they open, with the vehicle's own modes.
    more : int
        How often two modes are added, as far as a vehicle may have them.
    progress : callable, optional
        Called with how many are done, and how many there are.

    Returns
    -------
    tuple of Settling
        Empty where a damping matrix fixes the number of modes.
    """
    if vehicle.damping.matrix is not None:
        return ()
    most = min(vehicle.modes + STEP * more, MAX_MODES)
    numbers = tuple(range(vehicle.modes, most + 1, STEP))
    found: dict[tuple[Resonance | None, str], list[float | None]] = {}

    def told(of: Resonance | None, what: str, value: float | None) -> None:
        found.setdefault((of, what), []).append(value)

    last = own
    for done, number in enumerate(numbers):
        progress(done, len(numbers))
        other = replace(vehicle, modes=number)
        if number > vehicle.modes:
            last = _again(other, gamma, eta, last)
            loss = loss and _thrust(other, eta, loss)
        if loss is not None:
            told(None, "critical thrust", loss.thrust if math.isfinite(loss.thrust) else None)
        for band, critical in last:
            told(band.resonance, "T", band.T)
            told(band.resonance, "width", band.width if band.edges else None)
            told(band.resonance, "critical pulsation ratio", critical)
    return tuple(
        _settled(of, what, numbers, tuple(values))
        for (of, what), values in found.items()
        if any(x is not None for x in values)
    )


def _again(
    vehicle: Vehicle, gamma: float, eta: float, last: Sequence[tuple[Band, float | None]]
) -> list[tuple[Band, float | None]]:
    """The same bands of a vehicle that is much the same."""
    alone = steady(vehicle.equation(1.0, 0.0, eta))
    found = []
    for band, critical in last:

        def near(at: float, resonance: Resonance = band.resonance) -> Near:
            return Near(lambda Omega: vehicle.equation(Omega, at, eta), resonance, alone)

        try:
            again = near(gamma).band(band)
            found.append((again, critical_gamma(near, again, gamma, critical)))
        except Refused:
            lost = replace(band, T=math.nan, edges=None)
            found.append((lost, None))
    return found


def _thrust(vehicle: Vehicle, eta: float, last: CriticalThrust) -> CriticalThrust:
    damping = replace(vehicle.damping, eta=vehicle.damping.eta + eta)
    least = FROM * abs(last.thrust)
    return critical_thrust(
        replace(vehicle, damping=damping),
        least=least if 0.0 < least < math.inf else None,
        resolution=THRUST,
    )


def _settled(
    of: Resonance | None, what: str, modes: tuple[int, ...], values: tuple[float | None, ...]
) -> Settling:
    known = tuple(None if x is None or math.isnan(x) else x for x in values)
    if None in known or len(known) <= FEWEST:
        return Settling(of, what, modes, known, None, None)
    limit, error = extrapolated(np.array(modes, float), np.array(known, float))
    return Settling(of, what, modes, known, limit, error)
