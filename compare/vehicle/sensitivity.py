"""Which of a vehicle's numbers move the growth in a band the most."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from compare.vehicle.near import Band
from hill import Vehicle
from hill.errors import Refused
from hill.oscillations.pair import pair
from hill.oscillations.steady import steady
from hill.system import varied

# Share of a number by which it is changed. T comes to 1e-11, so that the slope has five digits.
STEP = 1e-5

MOST = 3
"""Effects that are told of a band."""


@dataclass(frozen=True)
class Effect:
    """What one number does to T at a band's worst Omega.

    Attributes
    ----------
    name : str
    value : float
    slope : float
        dT/d(number); where T is at its peak, the peak's own too.
    """

    name: str
    value: float
    slope: float

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
        high = parameters[name].high
        changed = value * (1.0 + STEP) if value * (1.0 + STEP) <= high else value * (1.0 - STEP)
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
    return [tuple(sorted(own, key=lambda e: -abs(e.relative))[:MOST]) for own in found]
