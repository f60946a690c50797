"""Where a band begins: the pulsation that opens it."""

from collections.abc import Callable

from compare.vehicle.near import NARROWER, Band, Near

# Secant steps in the power of gamma in which a band's excess is nearly linear.
MAX_STEPS = 8
# Change of that power at which they stop; what is left is smaller by another such factor.
CLOSE = 1e-5

# A thrust that pulsates by more than itself is turned round; twice that is looked at.
MAX_GAMMA = 2.0


def critical_gamma(
    near: Callable[[float], Near], band: Band, gamma: float, start: float | None = None
) -> float | None:
    """The pulsation at which a resonance's band opens; None where it does not up to `MAX_GAMMA`.

    Parameters
    ----------
    near : callable
        Of gamma: the resonance at that pulsation.
    band : Band
        At `gamma`.
    gamma : float
        Not 0.
    start : float, optional
        About where it is.
    """
    power = 2 * band.resonance.order
    before_u, before = 0.0, near(gamma).excess_at_rest
    if before >= 0.0:
        return 0.0
    # the excess is nearly linear in u = gamma^(2 k)
    u, value, middle = abs(gamma) ** power, band.excess, band.middle
    reach = sum(near(gamma).rates) / band.resonance.order
    guess, half = start, 1.0
    for _ in range(MAX_STEPS):
        slope = (value - before) / (u - before_u)
        if guess:
            following, guess = guess**power, None
        elif not slope > 0.0:
            return None
        else:
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
        value, middle = at.most(at.Omega + moved, half * max(reach, 1e-4 * at.Omega))
        half = NARROWER
    return float(u ** (1.0 / power))
