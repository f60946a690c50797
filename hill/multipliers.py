"""From the polynomial of the multipliers to multipliers, exponents, T and a verdict.

Multipliers may differ by more powers of ten than a float has digits. Newton's polygon tells their
moduli from the coefficients' sizes, and where these are far apart they are found group by group.
As in `hill.stability` nothing is decided by a computed root alone: each has a disc that holds the
true one, all of them accounted for.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from hill.arrays import EPS, Bool, Complex, Float
from hill.stability import HORNER, Verdict, root_radii, roots

# Groups of roots whose moduli differ by such a factor are found apart, and then improved.
APART = 1e3

# Newton's steps, each of which doubles the digits; longer ones than this share are not taken.
STEPS, SHORT = 4, 0.1

# What stands for the modulus of a root that is 0.
TINY = 1e-300


@dataclass(frozen=True, eq=False)
class Multipliers:
    """The multipliers of one polynomial.

    Attributes
    ----------
    mu : (m,) complex ndarray
        By descending modulus.
    exponents : (m,) complex ndarray
        ln mu/period; minus infinity of a multiplier 0.
    exponent_errors : (m,) ndarray
        Bounds on their errors; infinite where 0 is not excluded.
    T, T_error : float
        Twice the largest growth exponent, and a bound on its error.
    verdict : {"stable", "unstable", "undecided"}
    """

    mu: Complex
    exponents: Complex
    exponent_errors: Float
    T: float
    T_error: float
    verdict: Verdict


def multipliers(polynomial: Float, errors: Float, period: float, log_scale: float) -> Multipliers:
    """Roots, T and the verdict.

    Parameters
    ----------
    polynomial, errors : (m + 1,) ndarray
        Monic in y, mu = y exp(log_scale), highest power first; bounds on the absolute errors, the
        first one 0. The product of all |y| is 1, as far as the last coefficient is.
    period, log_scale : float
    """
    y = polynomial_roots(polynomial)
    size = np.maximum(np.abs(y), TINY)
    radius = root_radii(polynomial[None], errors[None], y[None], size[None])[0]
    beyond = _beyond(polynomial, errors, log_scale)
    return in_discs(y, radius, period, log_scale, errors[-1], beyond)


def in_discs(
    y: Complex, radius: Float, period: float, log_scale: float, last: float, beyond: bool = False
) -> Multipliers:
    """From discs, each of which holds a root of its own.

    Parameters
    ----------
    y : (m,) complex ndarray
        The product of all |y| is 1, to within `last`: the largest is no smaller.
    radius : (m,) ndarray
    period, log_scale, last : float
    beyond : bool
        Whether growth is shown otherwise.
    """
    order = np.argsort(-np.abs(y), kind="stable")
    y, radius = y[order], radius[order]
    size = np.abs(y)
    least = (1.0 - last) ** (1.0 / len(y)) if last < 1.0 else 0.0
    with np.errstate(divide="ignore", over="ignore", under="ignore"):
        logs = [np.log(np.max(x)) for x in (np.append(size - radius, least), size, size + radius)]
        exponents: Complex = np.full(len(y), -np.inf, complex)
        exponents[size > 0.0] = (np.log(y[size > 0.0]) + log_scale) / period
        share = np.divide(radius, size, out=np.ones_like(size), where=size > 0.0)
        off = -np.log1p(-np.minimum(share, 1.0)) / period
        mu = y * np.exp(log_scale)
    rounding = 8.0 * EPS * (2.0 + abs(log_scale)) / period
    low, T, high = (2.0 / period * (log + log_scale) for log in logs)
    low, high = low - 8.0 * EPS * abs(low) - rounding, high + 8.0 * EPS * abs(high) + rounding
    T = float(np.clip(T, low, high))
    verdict: Verdict = "undecided"
    if high < 0.0:
        verdict = "stable"
    elif low > 0.0 or beyond:
        verdict = "unstable"
    return Multipliers(mu, exponents, off + rounding, T, float(max(high - T, T - low)), verdict)


def newton_polygon(sizes: Float, points: Bool) -> list[tuple[int, int, float]]:
    """Edges of the upper convex hull of ln |c_k| over k: (first k, last k, ln |mu| between).

    Parameters
    ----------
    sizes : (m + 1,) ndarray
        ln |c_k|, lowest power first.
    points : (m + 1,) bool ndarray
        Which of them to look at.
    """
    hull: list[int] = []
    for k in map(int, np.flatnonzero(points)):
        while len(hull) > 1:
            a, b = hull[-2:]
            if (sizes[b] - sizes[a]) * (k - b) > (sizes[k] - sizes[b]) * (b - a):
                break
            hull.pop()
        hull.append(k)
    return [(a, b, float(sizes[a] - sizes[b]) / (b - a)) for a, b in pairwise(hull)]


def polynomial_roots(polynomial: Float) -> Complex:
    """Roots of a monic real polynomial, of however different size."""
    c = polynomial[::-1]
    with np.errstate(divide="ignore"):
        sizes = np.log(np.abs(c))
    groups: list[list[tuple[int, int, float]]] = []
    for edge in newton_polygon(sizes, c != 0.0):
        if groups and edge[2] - groups[-1][-1][2] < np.log(APART):
            groups[-1].append(edge)
        else:
            groups.append([edge])
    found = [np.zeros(int(np.argmax(c != 0.0)), complex)]
    for group in groups:
        low, high = group[0][0], group[-1][1]
        log_r = (sizes[low] - sizes[high]) / (high - low)
        k = np.arange(low, high + 1)
        scaled = np.sign(c[k]) * np.exp(sizes[k] - sizes[high] + (k - high) * log_r)
        here = roots(np.sign(c[high]) * scaled[None, ::-1])[0] * np.exp(log_r)
        found.append(here if len(group) == 1 == len(groups) else _improved(c, sizes, here))
    return np.concatenate(found)


def _improved(c: Float, sizes: Float, mu: Complex) -> Complex:
    """By Newton's method, every power over the largest."""
    k = np.arange(len(c))
    for _ in range(STEPS):
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            log = sizes + k * np.log(np.abs(mu))[:, None]
            terms = np.sign(c) * np.exp(log - np.max(log, axis=1, keepdims=True))
            terms = terms * (mu / np.abs(mu))[:, None] ** k
            step = np.sum(terms, axis=1) / np.sum(k * terms, axis=1)
        mu = mu * np.where(np.abs(step) < SHORT, 1.0 - step, 1.0)
    return mu


def _beyond(p: Float, errors: Float, log_scale: float) -> bool:
    """Whether a real root is shown to be beyond mu = 1 or -1, by the monic polynomial's sign."""
    k = np.arange(len(p))
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        # over the leading power of y = exp(-log_scale)
        powers = np.exp(k * log_scale)
        off = HORNER * EPS * (len(p) + k * abs(log_scale)) * np.abs(p)
        margin = 1.01 * np.sum((errors + off) * powers)
        values = np.sum(p * powers), np.sum(p * powers * (-1.0) ** k)
        return bool(min(values) < -margin)
