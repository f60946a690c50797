"""Which of a vehicle's numbers move the growth in a band the most."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from compare.vehicle.near import Band
from compare.vehicle.witnessed import Witnessed
from floquet import monodromy
from floquet.witness import maker
from hill import Vehicle
from hill.errors import Refused
from hill.oscillations.pair import pair
from hill.oscillations.steady import steady
from hill.system import varied

# Share of a number by which it is changed. T comes to 1e-11, so that the slope has five digits.
STEP = 1e-5

EFFECTS_TOLD = 3
"""Effects that are told of a band."""

# Two slopes by the same difference are the same within this share of the largest effect of the
# band, and what both values of T may be off by.
SAME = 1e-3


@dataclass(frozen=True)
class Effect:
    """What one number does to T at a band's worst Omega.

    Attributes
    ----------
    name : str
    value : float
    slope : float
        dT/d(number); where T is at its peak, the peak's own too.
    witness : float or None
        The same by the time domain, on its own matrices; None where it was not asked.
    allowed : float
        What the errors of T leave of the difference of both.
    """

    name: str
    value: float
    slope: float
    witness: float | None = None
    allowed: float = 0.0

    @property
    def relative(self) -> float:
        """By how much T moves with a change by the number itself."""
        return self.value * self.slope


def effects(
    vehicle: Vehicle,
    gamma: float,
    eta: float,
    bands: Sequence[Band],
    progress: Callable[[int, int], None] = lambda *_: None,
) -> list[tuple[Effect, ...]]:
    """The three numbers that matter most to each band, by one-sided differences.

    A number that is 0 has no share to change by and is left out.
    """
    found: list[list[Effect]] = [[] for _ in bands]
    values = {name: x for name, x in vehicle.values.items() if x != 0.0 and math.isfinite(x)}
    parameters = {p.name: p for p in vehicle.parameters}
    for done, (name, value) in enumerate(values.items()):
        progress(done, len(values))
        changed = _changed(value, parameters[name].high)
        try:
            other = varied(vehicle, {name: changed})
            alone = steady(other.equation(1.0, 0.0, eta))
        except ValueError:
            continue
        for band, own in zip(bands, found, strict=True):
            try:
                moved = pair(other.equation(band.Omega, gamma, eta), band.resonance, alone).T
            except Refused:
                continue
            own.append(Effect(name, value, (moved - band.T) / (changed - value)))
    return [tuple(sorted(own, key=lambda e: -abs(e.relative))[:EFFECTS_TOLD]) for own in found]


def _changed(value: float, high: float) -> float:
    """A number a little larger; or smaller, where it is as large as it may be."""
    return value * (1.0 + STEP) if value * (1.0 + STEP) <= high else value * (1.0 - STEP)


def witnessed_effects(
    vehicle: Vehicle, gamma: float, eta: float, band: Band, at: Witnessed, own: Sequence[Effect]
) -> tuple[Effect, ...]:
    """The same effects with what the time domain says of them, by the same differences.

    Its T is that of the whole vehicle: it is to be asked where the band's two oscillations are the
    ones that grow the most.
    """
    make = maker(vehicle)
    assert make is not None
    high = {p.name: p.high for p in vehicle.parameters}
    found = []
    for effect in own:
        changed = _changed(effect.value, high[effect.name])
        other = varied(vehicle, {effect.name: changed})
        moved = monodromy(make(other, band.Omega, gamma, eta))
        step = changed - effect.value
        error = band.T_error + at.T_error + moved.T_error + 2.0 * at.discretisation
        found.append(
            replace(effect, witness=(moved.T - at.T) / step, allowed=float(error / abs(step)))
        )
    return tuple(found)


def same_effects(own: Sequence[Effect]) -> bool:
    """Whether the routes agree on every effect that both were asked of."""
    largest = max((abs(e.relative) for e in own), default=0.0)
    return all(
        abs(e.value * (e.slope - e.witness)) <= SAME * largest + abs(e.value) * e.allowed
        for e in own
        if e.witness is not None
    )
