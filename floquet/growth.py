"""T and the verdict from discs about z, or about the multipliers themselves."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from floquet.arrays import EPS, Bool, Complex, Float
from floquet.eigenvalues import Discs

# What a modulus of 0 counts as: the smallest float.
TINY = 5e-324

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
        least = max(least, _least(discs.together, inner))
        most = min(most, float(outer.max()))
        inside |= bool(np.all(real & (x + r < 1.0)))
    z = families[0].centre
    value = float(ln_mu(np.abs(z.real), np.abs(z.imag)).max())
    if inside:
        least = most = value = 0.0  # |mu| = 1, exactly
    beyond = _beyond(p, errors, 0.5 * period * eta)
    return _growth(value, least, most, period, eta, bounded=inside, beyond=beyond)


@dataclass(frozen=True, eq=False)
class LogDiscs:
    """Where the multipliers are, by their logarithms.

    Attributes
    ----------
    value : (m,) complex ndarray
        ln mu.
    radius : (m,) ndarray
        Of a disc about mu, over |mu|.
    least, most : (m,) ndarray
        Bounds on ln |mu|.
    together : (m, m) bool ndarray
        Which discs form one region; it holds as many true multipliers as it has discs.
    """

    value: Complex
    radius: Float
    least: Float
    most: Float
    together: Bool

    @classmethod
    def of(cls, discs: Discs) -> "LogDiscs":
        """Discs about the multipliers themselves."""
        # one that has underflowed is not known
        size, r = np.maximum(np.abs(discs.centre), TINY), discs.radius
        with np.errstate(divide="ignore", over="ignore"):
            return cls(
                value=np.log(size) + 1j * np.angle(discs.centre),
                radius=r / size,
                least=np.log(np.maximum(size - r, 0.0)),
                most=np.log(size + r),
                together=discs.together,
            )


def growth_from_multipliers(
    families: Sequence[LogDiscs], period: float, mean: float, decay: float | None = None
) -> Growth:
    """T = (2/period) ln max |mu|, the damping being in mu; `mean` is the mean of all ln |mu|.

    With `decay` the multipliers come in pairs about |mu| = exp(-decay period/2).
    """
    least, most = mean, np.inf
    for discs in families:
        least = max(least, _least(discs.together, discs.least))
        most = min(most, float(np.max(discs.most)))
    value = float(np.max(families[0].value.real))
    if decay is not None and any(_on_circle(discs, -0.5 * decay * period) for discs in families):
        return _growth(0.0, 0.0, 0.0, period, decay, bounded=True)
    return _growth(value, least, most, period, 0.0)


def _on_circle(discs: LogDiscs, level: float) -> bool:
    """Whether all multipliers are shown to be on the circle about which they pair.

    A multiplier alone in its disc whose partner cannot be in any other disc is its own partner.
    """
    off = _log_radius(discs)
    partner = 2.0 * level - discs.value.conj()
    unsure = off + 8.0 * EPS * (abs(level) + np.abs(discs.value))
    apart = _wrapped(partner[:, None] - discs.value) > 1.01 * (unsure[:, None] + off)
    alone = np.sum(discs.together, axis=1) == 1
    return bool(np.all(alone) and np.all(apart | np.eye(len(off), dtype=bool)))


def logarithm_error(z: Complex, families: Sequence[Discs]) -> Float:
    """How far ln mu of each z = cosh ln mu is from a true one at most.

    cosh a - cosh b = 2 sinh((a + b)/2) sinh((a - b)/2), and of a and -a, that is nearer for which
    the second factor is the smaller one: |sinh((a - b)/2)|^2 <= r/2. Away from z = 1 and z = -1 the
    slope (z^2 - 1)^(-1/2), the largest within the disc, says less.
    """
    r = np.full(len(z), np.inf)
    for discs in families:
        c = discs.centre
        # a region has as many as it has discs, but they may be in any of them
        region = np.where(discs.together, np.abs(c[:, None] - c) + discs.radius, 0.0).max(axis=1)
        r = np.minimum(r, np.min(np.abs(z[:, None] - c) + region, axis=1))
    clear = (np.abs(z - 1.0) > r) & (np.abs(z + 1.0) > r)
    # roots first: the product of the distances may be beyond a float
    inner = [np.sqrt(np.where(clear, np.abs(z - edge) - r, 1.0)) for edge in (1.0, -1.0)]
    straight = np.where(clear, r / (inner[0] * inner[1]), np.inf)
    half = np.sqrt(0.5 * r)
    bent = np.where(half < 1.0, 2.0 * np.arcsin(np.minimum(half, 1.0)), np.inf)
    return np.asarray(np.minimum(straight, bent) + 8.0 * EPS)


def logarithms(families: Sequence[LogDiscs]) -> tuple[Complex, Float]:
    """Ln mu by descending modulus, by the first family, and how far a true one is at most.

    The imaginary part is between -pi and pi, and so is that of a difference.
    """
    value = families[0].value
    value = value[np.argsort(-value.real, kind="stable")]
    off = np.full(len(value), np.inf)
    for discs in families:
        own = _log_radius(discs)
        # a region has as many as it has discs, but they may be in any of them
        between = _wrapped(discs.value[:, None] - discs.value)
        region = np.max(np.where(discs.together, between + own, 0.0), axis=1)
        away = _wrapped(value[:, None] - discs.value)
        off = np.minimum(off, np.min(away + region, axis=1))
    return value, off


def _log_radius(discs: LogDiscs) -> Float:
    """How far ln mu is from its value at most."""
    with np.errstate(divide="ignore"):
        return np.asarray(
            -np.log1p(-np.minimum(discs.radius, 1.0)) + 4.0 * EPS * np.abs(discs.value)
        )


def _wrapped(difference: Complex) -> Float:
    """Moduli, the imaginary part less its whole turns."""
    turn = 2.0 * np.pi
    return np.hypot(difference.real, difference.imag - turn * np.round(difference.imag / turn))


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


def _least(together: Bool, inner: Float) -> float:
    """What the largest is at least: of the discs of one region one is known to be filled."""
    return float(np.min(np.where(together, inner[None, :], np.inf), axis=1).max())


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
