r"""Coefficients of det(mu I - Phi) from its values on circles about 0.

All is over the size r that the multipliers have in the mean, ln r = -2 pi trace/(m Omega) by
Liouville's formula: in y = mu/r the polynomial begins with 1, ends with (-1)^m, and has no other
powers. By how much the values fail to say so is a measured error.

On |y| = s a coefficient c_k is a mean of the values over s^k, so that it is known to what the
values are, over s^k. Circles of several s, where the coefficients' sizes ask for them, make each
known as well as it can be: c_k on the circle where c_k s^k is among the largest.
"""

from dataclasses import dataclass

import numpy as np

from hill.arrays import EPS, Float
from hill.determinant.finite import OVERFLOW
from hill.determinant.general_values import Determinant, values
from hill.multipliers import newton_polygon

# On the measured defect.
SAFETY = 4.0

# Samples on a circle beyond the coefficients there are.
SPARE_POINTS = 3

# Another circle is worth its time where it makes a coefficient so much better known.
GAIN = 30.0
MAX_CIRCLES = 8

# Where a group of rows is singular at a sample, or nearly, another circle is tried.
SHIFTS = (0.0, 0.011, -0.017, 0.029)
GOOD = 1e-11

# exp of it is still a float.
MAX_EXPONENT = 690.0


@dataclass(frozen=True, eq=False)
class Polynomial:
    """Det(r y I - Phi)/r^m, monic in y, highest power first.

    Attributes
    ----------
    coefficients, errors, data_errors : (m + 1,) ndarray
        And bounds on the absolute errors: of the equation as given, and by the errors it came with.
    log_scale : float
        ln r.
    M : tuple of int
        Harmonics kept on either side.
    """

    coefficients: Float
    errors: Float
    data_errors: Float
    log_scale: float
    M: tuple[int, ...]

    def unscaled(self) -> tuple[Float, Float, Float]:
        """Coefficients, errors and data errors of det(mu I - Phi).

        Raises
        ------
        OverflowError
            One is too large for a float.
        """
        log = self.log_scale * np.arange(len(self.coefficients))
        with np.errstate(over="ignore", under="ignore"):
            scale = np.exp(log)
            c = self.coefficients * scale
            errors = self.errors * scale + 2.0 * EPS * (1.0 + np.abs(log)) * np.abs(c)
            data = self.data_errors * scale
        # what is too small for a float is not known to be 0
        errors = np.where(self.log_scale == 0.0, self.errors, errors + np.finfo(float).tiny)
        errors[0] = 0.0
        if not (np.all(np.isfinite(c)) and np.all(np.isfinite(errors + data))):
            raise OverflowError(OVERFLOW)
        return c, errors, data


@dataclass(frozen=True, eq=False)
class _Circle:
    """By one circle: coefficients and errors, lowest power first, and what the samples lose."""

    c: Float
    errors: Float
    data: Float
    relative: float


def polynomial(d: Determinant) -> Polynomial:
    """The polynomial of the multipliers.

    Raises
    ------
    OverflowError
        A coefficient is too large for a float.
    """
    found = [_circle(d, 0.0)]
    while len(found) < MAX_CIRCLES and (shift := _better(d, found)) is not None:
        found.append(_circle(d, shift))
    c, errors, data = _combined(d, found)
    if not (np.all(np.isfinite(c)) and np.all(np.isfinite(errors + data))):
        raise OverflowError(OVERFLOW)
    return Polynomial(c[::-1], errors[::-1], data[::-1], 2.0 * np.pi * d.mean, (d.harmonics,))


def _circle(d: Determinant, shift: float) -> _Circle:
    """By samples at about |y| = exp(2 pi shift)."""
    best = None
    for more in SHIFTS:
        try:
            found = _samples(d, shift + more)
        except np.linalg.LinAlgError:
            continue
        if best is None or found.relative < best.relative:
            best = found
        if best.relative < GOOD:
            break
    if best is None:
        raise OverflowError(OVERFLOW)
    return best


def _samples(d: Determinant, shift: float) -> _Circle:
    """By samples at |y| = exp(2 pi shift)."""
    m = d.order
    count = m + 1 + SPARE_POINTS + (m + SPARE_POINTS + 1) % 2
    half = np.arange(count // 2 + 1)
    found = values(d, shift + 1j * half / count)
    top = int(np.max(found.exponent))
    sampled = found.mantissa * np.ldexp(1.0, np.maximum(found.exponent - top, -1000))
    means = np.fft.irfft(sampled.conj(), count)
    share = np.where((half == 0) | (half == count // 2), 1.0, 2.0) / count
    size = share * np.abs(sampled)

    # means = c_k exp(weight_k)
    k = np.arange(m + 1)
    weight = np.pi * shift * (2.0 * k - m) - top * np.log(2.0)
    expected = np.zeros(len(means))
    expected[[0, m]] = np.exp(np.minimum(weight[[0, m]], MAX_EXPONENT)) * [(-1.0) ** m, 1.0]
    defect = float(np.max(np.abs((means - expected)[[0, *range(m, len(means))]])))
    lost = float(np.sum(size * found.rounding))
    own = 2.0 * EPS * (np.abs(weight) + np.pi * m * abs(shift)) + d.mean_error
    error = SAFETY * defect + lost + own * np.abs(means[: m + 1])
    data = float(np.sum(size * found.data))
    relative = float(np.max(error)) / float(np.max(np.abs(sampled)))
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        back = np.exp(-weight)
        return _Circle(means[: m + 1] * back, error * back, data * back, relative)


def _combined(d: Determinant, circles: list[_Circle]) -> tuple[Float, Float, Float]:
    """Each coefficient by the circle that knows it best, lowest power first."""
    every = np.nan_to_num([circle.errors for circle in circles], nan=np.inf)
    best = np.argmin(every, axis=0), np.arange(d.order + 1)
    c, errors, data = (
        np.array([getattr(circle, name) for circle in circles])[best]
        for name in ("c", "errors", "data")
    )
    c[[0, -1]], errors[[0, -1]] = [(-1.0) ** d.order, 1.0], [d.mean_error, 0.0]
    return c, errors, data


def _better(d: Determinant, circles: list[_Circle]) -> float | None:
    """The circle that would add most to what is known, as ln s/2 pi; None if it is not much."""
    c, errors, _ = _combined(d, circles)
    k = np.arange(d.order + 1)
    with np.errstate(divide="ignore"):
        size, known = np.log(np.maximum(np.abs(c), errors)), np.log(errors)
    level = np.log(min(circle.relative for circle in circles))
    best, most = None, np.log(GAIN)
    for _, _, log_s in newton_polygon(size, np.abs(c) > 2.0 * errors):
        reached = level + np.max(size + log_s * k) - log_s * k
        gain = float(np.max((known - reached)[1 : d.order], initial=-np.inf))
        if gain > most:
            best, most = log_s / (2.0 * np.pi), gain
    return best
