"""Where something begins: the pulsation that opens a band, the steady thrust that is too much."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from compare.vehicle.near import Band, Near
from hill.oscillations.steady import Steady, steady

# Secant steps in the power of gamma in which a band's excess is nearly linear.
MAX_STEPS = 8
# Change of that power at which they stop; what is left is smaller by another such factor.
CLOSE = 1e-5

# A thrust that pulsates by more than itself is turned round; twice that is looked at.
MAX_GAMMA = 2.0

# Growth, over a low frequency, that the rounding of two equal exponents may show.
ROUNDING = 1e-6

# Thrusts over the vehicle's own at which steady stability is looked at.
SHARES = (*np.linspace(0.0, 1.0, 21), *np.geomspace(1.05, 50.0, 80))

# Between the two thrusts that enclose the critical one, over it.
ENCLOSED = 1e-10


def critical_gamma(near: Callable[[float], Near], band: Band, gamma: float) -> float | None:
    """The pulsation at which a resonance's band opens; None where it does not up to `MAX_GAMMA`.

    Parameters
    ----------
    near : callable
        Of gamma: the resonance at that pulsation.
    band : Band
        At `gamma`.
    gamma : float
        Not 0.
    """
    power = 2 * band.resonance.order
    before_u, before = 0.0, near(gamma).excess_at_rest
    if before >= 0.0:
        return 0.0
    # the excess is nearly linear in u = gamma^(2 k)
    u, value, middle = abs(gamma) ** power, band.excess, band.middle
    reach = sum(near(gamma).rates) / band.resonance.order
    for _ in range(MAX_STEPS):
        slope = (value - before) / (u - before_u)
        if not slope > 0.0:
            return None
        following = u - value / slope
        if not 0.0 < following <= MAX_GAMMA**power:
            return None
        if abs(following - u) <= CLOSE * u:
            return float(following ** (1.0 / power))
        before_u, before = u, value
        u = following
        at = near(float(u ** (1.0 / power)))
        # the middle moves like gamma^2; the excess falls by a b over a width of a + b
        moved = (middle - at.Omega) * (u / before_u) ** (2.0 / power)
        value, middle = at.most(at.Omega + moved, max(reach, 1e-4 * at.Omega))
    return float(u ** (1.0 / power))


@dataclass(frozen=True)
class Loss:
    """The smallest thrust on the way up at which steady stability is lost.

    Attributes
    ----------
    thrust : float
    kind : {"buckling", "flutter"}
        Without oscillation, or with.
    frequency : float
        Of the flutter, radians per unit of time; 0 for buckling.
    """

    thrust: float
    kind: Literal["buckling", "flutter"]
    frequency: float


def steady_loss(equation: Callable[[float], Any], thrust: float) -> Loss | None:
    """Where the steady thrust alone is too much, looked for on a grid and then enclosed.

    Parameters
    ----------
    equation : callable
        Of the mean thrust, without pulsation.
    thrust : float
        The vehicle's own; not 0.
    """

    def at(share: float) -> Steady:
        return steady(equation(share * thrust))

    def lost(share: float) -> bool:
        found = at(share)
        return found.growth > ROUNDING * _scale(found)

    below = None
    for share in SHARES:
        if lost(float(share)):
            break
        below = float(share)
    else:
        return None
    above = float(share)
    if below is None:
        return _loss(at(above), 0.0)
    while above - below > ENCLOSED * above:
        middle = 0.5 * (below + above)
        below, above = (below, middle) if lost(middle) else (middle, above)
    return _loss(at(above), above * thrust)


def _scale(found: Steady) -> float:
    """The second lowest frequency: the lowest may be a rotation's, and next to nothing."""
    frequencies = found.frequencies
    return float(frequencies[min(1, len(frequencies) - 1)]) if len(frequencies) else 1.0


def _loss(found: Steady, thrust: float) -> Loss:
    worst = complex(found.exponents[int(np.argmax(found.exponents.real))])
    oscillates = abs(worst.imag) > abs(worst.real)
    return Loss(
        thrust, "flutter" if oscillates else "buckling", abs(worst.imag) if oscillates else 0.0
    )
