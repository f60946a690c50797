r"""Coefficients of det(mu I - Phi) from its values on circles about 0.

On |mu| = r a coefficient c_k is a mean of the values over r^k, so that it is known to what the
values are, over r^k. Circles of several r, where the coefficients' sizes ask for them, make each
known as well as it can be: c_k on the circle where c_k r^k is among the largest.

The leading coefficient is 1, the constant one (-1)^m exp(-2 pi trace/Omega) by Liouville's formula,
and there are no higher ones: by how much the values fail to say so is a measured error.
"""

from dataclasses import dataclass

import numpy as np

from hill.arrays import EPS, Float
from hill.determinant.finite import OVERFLOW
from hill.determinant.general import folded
from hill.determinant.general_rounding import motion
from hill.determinant.general_tail import LEFT, Tail, kept, tail
from hill.determinant.pencil import Pencil, pencil
from hill.multipliers import newton_polygon
from hill.periodic import PeriodicEquation

# On the measured defect.
SAFETY = 4.0

# Samples on a circle beyond the coefficients there are.
SPARE = 3

# Another circle is worth its time where it makes a coefficient so much better known.
GAIN = 30.0
MOST_CIRCLES = 8

# Where a group of rows is singular at a sample, or nearly, another circle is tried.
SHIFTS = (0.0, 0.011, -0.017, 0.029)
GOOD = 1e-11

# exp of it is still a float.
MOST_EXPONENT = 690.0


@dataclass(frozen=True, eq=False)
class Polynomial:
    """Det(mu I - Phi), monic, highest power first.

    Attributes
    ----------
    coefficients, errors, data_errors : (m + 1,) ndarray
        And bounds on the absolute errors: of the equation as given, and by the errors it came with.
    mean : float
        Of ln |mu|, by Liouville's formula, less what it may be off.
    M : tuple of int
        Harmonics kept on either side.
    """

    coefficients: Float
    errors: Float
    data_errors: Float
    mean: float
    M: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class _Circle:
    """By one circle: coefficients and errors, lowest power first, and what the samples lose."""

    c: Float
    errors: Float
    data: Float
    relative: float


def polynomial(equation: PeriodicEquation) -> Polynomial:
    """The polynomial of the multipliers.

    Raises
    ------
    ValueError
        Omega is too small for the determinant.
    OverflowError
        A coefficient is too large for a float.
    """
    p = pencil(equation)
    t = tail(p)
    try:
        K = kept(p, t)
    except ValueError as refused:
        raise ValueError(f"Omega = {equation.Omega:g}: {refused}") from None
    m = p.order
    # where the product of all multipliers is 1
    found = [_circle(p, t, K, -p.trace / (m * p.Omega))]
    while len(found) < MOST_CIRCLES and (rho := _better(p, found)) is not None:
        found.append(_circle(p, t, K, rho))
    c, errors, data = _combined(p, found)
    if not (np.all(np.isfinite(c)) and np.all(np.isfinite(errors + data))):
        raise OverflowError(OVERFLOW)
    harmonics = (K + 1) * p.reach - p.reach // 2 - 1
    off = p.trace_error + 4.0 * EPS * abs(p.trace)
    mean = -2.0 * np.pi / (m * p.Omega) * (p.trace + off)
    return Polynomial(c[::-1], errors[::-1], data[::-1], mean, (harmonics,))


def _circle(p: Pencil, t: Tail, K: int, rho: float) -> _Circle:
    """By samples at about |mu| = exp(2 pi rho)."""
    best = None
    for shift in SHIFTS:
        try:
            found = _samples(p, t, K, rho + shift)
        except np.linalg.LinAlgError:
            continue
        if best is None or found.relative < best.relative:
            best = found
        if best.relative < GOOD:
            break
    if best is None:
        raise OverflowError(OVERFLOW)
    return best


def _samples(p: Pencil, t: Tail, K: int, rho: float) -> _Circle:
    """By samples at |mu| = exp(2 pi rho)."""
    m = p.order
    count = m + 1 + SPARE + (m + SPARE + 1) % 2
    half = np.arange(count // 2 + 1)
    f = folded(p, t, K, rho + 1j * half / count)
    moved = motion(p, t, f)
    top = int(np.max(f.exponent))
    with np.errstate(under="ignore"):
        values = f.mantissa * np.ldexp(1.0, f.exponent - top)
    means = np.fft.irfft(values.conj(), count)
    share = np.where((half == 0) | (half == count // 2), 1.0, 2.0) / count

    # means = c_k exp(weight_k)
    k = np.arange(m + 1)
    own = np.pi * (m * rho - p.trace / p.Omega)
    weight = 2.0 * np.pi * rho * k - own
    sizes = np.abs(weight) + np.pi * (m * abs(rho) + abs(p.trace) / p.Omega)
    weight = weight - top * np.log(2.0)
    leading = np.exp(min(weight[m], MOST_EXPONENT))
    last = (-1.0) ** m * np.exp(weight[0] - 2.0 * np.pi * p.trace / p.Omega)
    defect = max(
        abs(means[m] - leading), abs(means[0] - last), float(np.max(np.abs(means[m + 1 :])))
    )
    lost = float(np.sum(share * np.abs(values) * (moved.rounding + 10.0 * LEFT)))
    error = SAFETY * defect + lost + 2.0 * EPS * sizes * np.abs(means[: m + 1])
    data = float(np.sum(share * np.abs(values) * moved.data))
    size = float(np.max(np.abs(values)))
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        back = np.exp(-weight)
        return _Circle(
            means[: m + 1] * back, error * back, data * back, float(np.max(error)) / size
        )


def _combined(p: Pencil, circles: list[_Circle]) -> tuple[Float, Float, Float]:
    """Each coefficient by the circle that knows it best, lowest power first."""
    every = np.array([circle.errors for circle in circles])
    best = np.nanargmin(every, axis=0), np.arange(p.order + 1)
    c = np.array([circle.c for circle in circles])[best]
    data = np.array([circle.data for circle in circles])[best]
    errors = every[best]
    log = -2.0 * np.pi * p.trace / p.Omega
    with np.errstate(over="ignore", under="ignore"):
        constant = np.exp(log)
    error = constant * (2.0 * EPS * (2.0 + abs(log)) + 2.0 * np.pi * p.trace_error / p.Omega)
    if error <= errors[0]:
        c[0], errors[0] = (-1.0) ** p.order * constant, error
    c[p.order], errors[p.order] = 1.0, 0.0
    return c, errors, data


def _better(p: Pencil, circles: list[_Circle]) -> float | None:
    """The circle that would add most to what is known, as ln r/2 pi; None if it is not much."""
    c, errors, _ = _combined(p, circles)
    k = np.arange(p.order + 1)
    with np.errstate(divide="ignore"):
        size, known = np.log(np.maximum(np.abs(c), errors)), np.log(errors)
    certain = np.abs(c) > 2.0 * errors
    level = np.log(min(circle.relative for circle in circles))
    best, most = None, np.log(GAIN)
    for _, _, log_r in newton_polygon(size, certain):
        if abs(log_r) > MOST_EXPONENT / max(p.order, 1) * 2.0:
            continue
        reached = level + np.max(size + log_r * k) - log_r * k
        gain = np.max((known - reached)[1 : p.order], initial=-np.inf)
        if gain > most:
            best, most = log_r / (2.0 * np.pi), gain
    return best
