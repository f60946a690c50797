"""How many modes are enough: a value with more and more of them, and what it tends to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hill import checks
from hill.arrays import EPS, Float
from hill.vehicle.vehicle import MAX_MODES, Vehicle

STEP = 2
"""Modes that are added at a time: the odd and the even ones of a like vehicle take turns."""

VALUES = 6
"""How many numbers of modes are asked by default; a limit is taken from the last `WINDOW`."""

WINDOW = 4

ALONE = 5.0
"""On the error where there are no values before: of 126 answers it was too small by up to 4.7."""

# What a thrust leaves out falls like N^-3 or faster where cross-sections stay normal to the axis,
# and like 1/N where they shear.
POWERS = (1, 2, 3, 4, 5)


@dataclass(frozen=True)
class Convergence:
    """A value with N, N + 2, ... modes, and its extrapolation to all of them.

    Attributes
    ----------
    modes : tuple of int
    values : tuple of float
    limit : float
        Of a power law through the last values, by least squares.
    error : float
        Estimate of the limit's error: how far it is from the last value, from the limits of one
        power less and one more and from that of the values before, and how the law misses the
        values. Of 126 answers of random vehicles, six values each, two were off by more, by up to
        1.8 times; two more were thrusts that rates make smaller with modes beyond those asked of,
        which no fewer modes can tell.
    """

    modes: tuple[int, ...]
    values: tuple[float, ...]
    limit: float
    error: float

    def apart(self, modes: int) -> float:
        """How far the value with so many modes is from the limit, in units of the limit."""
        return self.values[self.modes.index(modes)] / self.limit - 1.0


def with_more_modes(
    vehicle: Vehicle,
    of: Callable[[Vehicle], float],
    *,
    modes: Sequence[int] | None = None,
) -> Convergence:
    """A number of a vehicle with more and more modes.

    Parameters
    ----------
    vehicle : Vehicle
    of : callable
        ``of(vehicle)``, asked of the vehicle with other `modes`.
    modes : sequence of int, optional
        Ascending, at least four; the vehicle's own number and two more at a time by default, six in
        all.

    Returns
    -------
    Convergence
        The limit and its error are nan where a value is not finite.

    Raises
    ------
    ValueError
        Fewer than four numbers of modes; a damping matrix, which fixes the number.
    """
    if vehicle.damping.matrix is not None:
        raise ValueError("damping.matrix: fixes the number of modes; give ratios or eta instead")
    asked = modes or range(vehicle.modes, vehicle.modes + VALUES * STEP, STEP)
    numbers = tuple(checks.count("modes", n, least=1, most=MAX_MODES) for n in asked)
    if len(numbers) < 4 or list(numbers) != sorted(set(numbers)):
        raise ValueError(f"modes = {numbers}: must be four numbers or more, ascending")
    values = tuple(float(of(replace(vehicle, modes=n))) for n in numbers)
    limit, error = extrapolated(np.array(numbers, float), np.array(values))
    return Convergence(numbers, values, limit, error)


def extrapolated(modes: Float, values: Float) -> tuple[float, float]:
    """Limit of a power law through the last values, and an estimate of its error."""
    if not np.all(np.isfinite(values)):
        return float("nan"), float("nan")
    limit, error = _window(modes[-WINDOW:], values[-WINDOW:])
    if len(values) > WINDOW:
        before, _ = _window(modes[-WINDOW - 1 : -1], values[-WINDOW - 1 : -1])
        error += abs(limit - before)
    else:
        error *= ALONE
    return limit, error + abs(limit - float(values[-1])) + 8.0 * EPS * abs(limit)


def _window(modes: Float, values: Float) -> tuple[float, float]:
    """Limit of the power that fits best; how far it misses, and its neighbours' limits are."""
    limits, misses = np.array([_law(modes, values, p) for p in POWERS]).T
    best = int(np.argmin(misses))
    beside = [k for k in (best - 1, best + 1) if 0 <= k < len(POWERS)]
    apart = max(abs(limits[k] - limits[best]) for k in beside)
    return float(limits[best]), float(misses[best] + apart)


def _law(modes: Float, values: Float, power: int) -> tuple[float, float]:
    """L of L + c N^-power by least squares, and the largest miss."""
    table = np.stack([np.ones_like(modes), (modes / modes[0]) ** -power], axis=1)
    found, *_ = np.linalg.lstsq(table, values, rcond=None)
    return float(found[0]), float(np.max(np.abs(table @ found - values)))
