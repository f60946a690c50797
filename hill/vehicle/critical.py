"""Where steady thrust alone makes a vehicle unstable: by divergence (buckling) or by flutter."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.linalg import eig

from hill import checks
from hill.arrays import Complex, Float
from hill.vehicle.discs import Moved
from hill.vehicle.equations import elastic, modal_damping
from hill.vehicle.matrices import Structure, structure
from hill.vehicle.vehicle import Vehicle

Kind = Literal["divergence", "flutter", "none"]

# The thrust is looked for up to here, over EI/l^2 of the mean EI: uniform columns of all kinds are
# unstable below 60, a free uniform beam at 110, less than a quarter of its first lambda.
LEAST_SEARCHED = 80.0
SEARCHED = 3.0
"""Or up to this times the first lambda without thrust."""

FIRST = 1e-6
"""The first thrust that is tried, over the last: unstable there is unstable from the start."""

STEPS = 600
"""Steps of the search where nothing can be shown between two thrusts."""

RESOLUTION = 1e-6
"""Of the critical thrust: what is shown below it reaches so near, where it can be shown at all."""

# Over the size of an eigenvalue: roundings of a pair that is about to meet are its square root.
COMPLEX = 1e-6
GROWING = 1e-9
# Of a force that does not turn a coordinate, over the largest.
NOTHING = 1e-11
BISECTIONS = 60
BEYOND = 1.0 + 1e-6


@dataclass(frozen=True)
class CriticalThrust:
    """The lowest steady thrust that makes the mean system unstable.

    Attributes
    ----------
    thrust : float
        In the vehicle's unit of force, of its sign; 0 if every thrust does, infinite if none does
        up to `searched`.
    kind : {"divergence", "flutter", "none"}
    frequency : float
        Of what grows, cycles per unit of time; 0 for divergence, nan for none.
    searched : float
        The largest thrust that was tried.
    resolution : float
        Between thrusts that are shown to be safe the widest gap below `thrust`, in which what is
        unstable may have been missed.
    """

    thrust: float
    kind: Kind
    frequency: float
    searched: float
    resolution: float

    def margin(self, vehicle: Vehicle) -> float:
        """Over the vehicle's own mean thrust."""
        return self.thrust / vehicle.thrust.mean if vehicle.thrust.mean else math.inf


def critical_thrust(
    vehicle: Vehicle,
    most: float | None = None,
    *,
    least: float | None = None,
    resolution: float = RESOLUTION,
) -> CriticalThrust:
    """The lowest steady thrust that makes the vehicle unstable, with as many modes as it has.

    Its damping, rates and servo count. Without any of them the frequencies are looked at; a rigid
    rotation that nothing turns back is neutral and left out. `with_more_modes` has the limit of
    many modes.

    The thrusts below are shown to be safe interval by interval, by discs about the eigenvalues,
    except where two of them pass each other.

    Parameters
    ----------
    vehicle : Vehicle
    most : float, optional
        Where the search ends, a force.
    least : float, optional
        Where it begins; next to 0 by default. What is unstable below only is not looked for, and
        counts as a gap.
    resolution : float, optional
        Gap in what is shown, over the thrust, at which the search goes on without.

    Raises
    ------
    ValueError
        `most`, `least` or `resolution` is not greater than 0.
    """
    known = structure(vehicle)
    unit = known.modes.mesh.scales
    if most is None:
        searched = max(LEAST_SEARCHED, SEARCHED * float(known.modes.lam[0]))
    else:
        searched = checks.positive("most", most) / unit.force
    sign = -1.0 if vehicle.thrust.mean < 0.0 else 1.0
    mean = Mean.of(vehicle, known, sign)
    least = FIRST * searched if least is None else checks.positive("least", least) / unit.force
    found, gap = _first(mean, least, searched, checks.positive("resolution", resolution))
    if found is None:
        kind: Kind = "none"
        thrust, frequency = math.inf, math.nan
    else:
        # at the boundary itself rounding decides what it is
        thrust, frequency = found, mean.grows(found * BEYOND or FIRST * searched)
        kind = "flutter" if frequency > 0.0 else "divergence"
    return CriticalThrust(
        thrust=sign * thrust * unit.force + 0.0,
        kind=kind,
        frequency=frequency / (2.0 * math.pi * unit.time),
        searched=searched * unit.force,
        resolution=gap * unit.force,
    )


def _first(
    mean: "Mean", low: float, searched: float, resolution: float
) -> tuple[float | None, float]:
    """The first unstable thrust, 0 if all are, and the widest gap in what is shown below it."""
    first = FIRST * searched
    if mean.unstable(first):
        return 0.0, 0.0
    if low > first and mean.unstable(low):
        low = first
    gap, step, least = low, low, 0.0
    while low < searched:
        step = min(step, 2.0 * (searched - low))
        middle = low + step
        safe = mean.safe(middle, step)
        if safe >= step * (1.0 - 1e-9):
            low, step, least = middle + safe, 2.0 * safe, 0.0
            continue
        if mean.unstable(middle) or step > max(resolution * low, least):
            if step > max(resolution * low, least):
                step = max(0.25 * step, 0.9 * safe)
                continue
            return _crossing(mean, low, middle, gap)
        # nothing is shown here: on to where something is, or to where it is unstable
        reached = middle - safe if safe else middle
        gap = max(gap, reached - low)
        low = middle + safe
        least = min(2.0 * max(step, least), searched / STEPS)
        step = max(step, least)
    return None, gap


def _crossing(mean: "Mean", low: float, high: float, gap: float) -> tuple[float, float]:
    """Between a stable thrust and an unstable one, and the gap below it."""
    start = low
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if mean.unstable(middle) else (middle, high)
    return high, max(gap, high - start)


@dataclass(frozen=True, eq=False)
class Mean:
    """The mean system as it depends on the thrust T, dimensionless, of q'' + C q' + K q = 0.

    Attributes
    ----------
    elastic, damping : (n, n) ndarray
        Without thrust.
    pull, rate : (n, n) ndarray
        What a unit of thrust adds to K and to C.
    gimbal : (n,), (2n,) ndarray or None
        With a servo: the force of a unit angle and thrust, and what turns it, over its time.
    lag : float
        1 over the servo's time.
    """

    elastic: Float
    damping: Float
    pull: Float
    rate: Float
    gimbal: tuple[Float, Float] | None
    lag: float

    @classmethod
    def of(cls, vehicle: Vehicle, known: Structure, sign: float) -> "Mean":
        """Of a vehicle, its thrust in units of `sign`."""
        time = known.modes.mesh.scales.time
        gain, rate = known.gimbaled(vehicle)
        rate = rate / time
        served = vehicle.servo_time > 0.0 and bool(np.any(gain) or np.any(rate))
        followed = known.followed(vehicle)
        pull = sign * (np.outer(known.arm, followed if served else followed + gain) - known.mean)
        n = len(pull)
        damping = (modal_damping(vehicle, known) + vehicle.damping.eta * np.eye(n)) * time
        rates = np.zeros((n, n)) if served else sign * np.outer(known.arm, rate)
        lag = time / vehicle.servo_time if served else 0.0
        gimbal = (sign * known.arm, lag * np.concatenate([gain, rate])) if served else None
        own = cls(elastic(known), damping, pull, rates, gimbal, lag)
        return own if served else own._without_neutral()

    def _without_neutral(self) -> "Mean":
        """Without a rigid rotation that meets nothing but its own damping: left to itself."""
        apart = self.damping - np.diag(np.diag(self.damping))
        turns = np.abs(np.stack([self.elastic, apart, self.pull, self.rate])[:, :, -1])
        if turns.max() > NOTHING * np.abs(self.pull).max():
            return self
        elastic, damping, pull, rate = (
            x[:-1, :-1] for x in (self.elastic, self.damping, self.pull, self.rate)
        )
        return Mean(elastic, damping, pull, rate, None, 0.0)

    def unstable(self, thrust: float) -> bool:
        """Whether something grows."""
        return not math.isnan(self.grows(thrust))

    def safe(self, thrust: float, reach: float) -> float:
        """About a thrust, how far the others are shown to be stable too; 0 if it is not."""
        if self.gimbal is None and not (np.any(self.damping) or np.any(self.rate)):
            return Moved.of(self.elastic + thrust * self.pull, self.pull).stays_positive(reach)
        slope = self._states(1.0) - self._states(0.0)
        return Moved.of(self._states(thrust), slope).stays_left(reach)

    def grows(self, thrust: float) -> float:
        """Circular frequency of what grows, 0 if it does not oscillate; nan if nothing does."""
        if self.gimbal is None and not (np.any(self.damping) or np.any(self.rate)):
            return self._undamped(thrust)
        s = self._exponents(thrust)
        worst = s[np.argmax(s.real / np.maximum(np.abs(s), 1e-300))]
        if worst.real <= GROWING * abs(worst):
            return math.nan
        return 0.0 if abs(worst.imag) <= COMPLEX * abs(worst) else float(abs(worst.imag))

    def _undamped(self, thrust: float) -> float:
        # 1/omega^2, of which the low frequencies' are known to rounding beside the high ones'
        K = self.elastic + thrust * self.pull
        try:
            inverse = np.linalg.eigvals(np.linalg.inv(K))
        except np.linalg.LinAlgError:  # on the boundary to the last bit
            return 0.0
        found = inverse[np.argsort(-np.abs(inverse))]
        for one in found:
            if abs(one.imag) > COMPLEX * abs(one):
                return float(abs(np.sqrt(1.0 / one).real))
            if one.real < 0.0:
                return 0.0
        return math.nan

    def _exponents(self, thrust: float) -> Complex:
        return np.asarray(eig(self._states(thrust), right=False))

    def _states(self, thrust: float) -> Float:
        """A of x' = A x, x = (q, q') or (q, q', the gimbal's angle)."""
        n = len(self.pull)
        A = np.zeros((2 * n, 2 * n))
        A[:n, n:] = np.eye(n)
        A[n:, :n] = -self.elastic - thrust * self.pull
        A[n:, n:] = -self.damping - thrust * self.rate
        if self.gimbal is not None:
            push, turning = self.gimbal
            A = np.pad(A, (0, 1))
            A[n:-1, -1] = -thrust * push
            A[-1] = np.append(turning, -self.lag)
        return A
