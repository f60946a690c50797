"""T and the verdict from discs about z, or about the multipliers themselves."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from floquet.arrays import EPS, Float
from floquet.eigenvalues import Discs

Verdict = Literal["stable", "unstable", "undecided"]


@dataclass(frozen=True)
class Growth:
    """T, a bound on its error, and what is shown about stability."""

    T: float
    T_error: float
    verdict: Verdict


def growth_from_z(
    families: Sequence[Discs], p: Float, errors: Float, period: float, eta: float
) -> Growth:
    """T = (2/period) ln max |mu| - eta of mu = z +- (z^2 - 1)^(1/2), Eq. (7.1.1).

    Parameters
    ----------
    families : sequence of Discs
        Sets of discs, each of which holds all z; what any of them shows is shown.
    p, errors : (n + 1,) ndarray
        P(z) and the error of its coefficients.
    """
    least, most, inside = 0.0, np.inf, False
    for discs in families:
        x, y = np.abs(discs.centre.real), np.abs(discs.centre.imag)
        r, real = discs.radius, discs.real
        outer = ln_mu(x + r, np.where(real, 0.0, y + r))
        inner = ln_mu(np.maximum(x - r, 0.0), np.where(real, 0.0, np.maximum(y - r, 0.0)))
        least = max(least, _least(discs, inner))
        most = min(most, float(outer.max()))
        inside |= bool(np.all(real & (x + r < 1.0)))
    z = families[0].centre
    value = float(ln_mu(np.abs(z.real), np.abs(z.imag)).max())
    if inside:
        least = most = value = 0.0  # |mu| = 1, exactly
    beyond = _beyond(p, errors, 0.5 * period * eta)
    return _growth(value, least, most, period, eta, bounded=inside, beyond=beyond)


def growth_from_multipliers(families: Sequence[Discs], period: float, mean: float) -> Growth:
    """T = (2/period) ln max |mu|, the damping being in mu; `mean` is the mean of all ln |mu|."""
    least, most = mean, np.inf
    with np.errstate(divide="ignore"):
        for discs in families:
            size, r = np.abs(discs.centre), discs.radius
            least = max(least, _least(discs, np.log(np.maximum(size - r, 0.0))))
            most = min(most, float(np.log(np.max(size + r))))
        value = float(np.log(np.max(np.abs(families[0].centre))))
    return _growth(value, least, most, period, 0.0)


def ln_mu(x: Float, y: Float) -> Float:
    """Ln |mu| of z = x + iy = cosh(a + ib), the larger: a, with sinh^2 a from |z|^2 - 1 and y.

    x, y >= 0; it grows with both.
    """
    large = np.hypot(x, y)
    # beyond 1e8 the next term of cosh is lost to rounding
    scale = np.where(large > 1e8, 1e8 / np.maximum(large, 1.0), 1.0)
    x, y = x * scale, y * scale
    beyond = (x - 1.0) * (x + 1.0) + y * y
    root = np.hypot(beyond, 2.0 * y)
    below = root - np.minimum(beyond, 0.0)
    sum_ = np.divide(4.0 * y * y, below, out=np.zeros_like(y), where=below > 0.0)
    square = 0.5 * np.where(beyond >= 0.0, beyond + root, sum_)
    return np.asarray(np.arcsinh(np.sqrt(square)) - np.log(scale))


def _least(discs: Discs, inner: Float) -> float:
    """What the largest is at least: of the discs of one region one is known to be filled."""
    return float(np.min(np.where(discs.together, inner[None, :], np.inf), axis=1).max())


def _beyond(p: Float, errors: Float, decay: float) -> bool:
    """Whether a real z is shown to be beyond c = cosh(eta period/2), or below -c, by P's sign."""
    with np.errstate(over="ignore", invalid="ignore"):
        c = float(np.cosh(max(decay, 0.0)))
        # cosh of a rounded argument: a few ulps of the argument
        unsure = errors + 4.0 * len(p) * (2.0 + abs(decay)) * EPS * np.abs(p)
        margin = 1.01 * np.polyval(unsure, c)
        below = (-1.0) ** (len(p) - 1) * np.polyval(p, -c)
        return bool(np.polyval(p, c) < -margin or below < -margin)


def _growth(
    value: float,
    least: float,
    most: float,
    period: float,
    eta: float,
    *,
    bounded: bool = False,
    beyond: bool = False,
) -> Growth:
    to_T = 2.0 / period
    rounding = 8.0 * EPS * (to_T + abs(eta))
    low = to_T * least * (1.0 - 8.0 * EPS) - eta - rounding
    high = to_T * most * (1.0 + 8.0 * EPS) - eta + rounding
    T = min(max(to_T * value - eta, low), high)
    verdict: Verdict = "undecided"
    if high < 0.0 or (bounded and eta >= 0.0):
        verdict = "stable"
    elif low > 0.0 or beyond:
        verdict = "unstable"
    return Growth(T, max(high - T, T - low), verdict)
