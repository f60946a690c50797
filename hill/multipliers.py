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


def multipliers(polynomial: Float, errors: Float, period: float, mean: float) -> Multipliers:
    """Roots, T and the verdict.

    Parameters
    ----------
    polynomial, errors : (m + 1,) ndarray
        Monic, highest power first; bounds on the absolute errors, the first one 0.
    period : float
    mean : float
        Lower bound on the mean of all ln |mu|, by Liouville's formula: the largest is no smaller.
    """
    mu = polynomial_roots(polynomial)
    mu = mu[np.argsort(-np.abs(mu), kind="stable")]
    size = np.abs(mu)
    radius = root_radii(polynomial[None], errors[None], mu[None], np.maximum(size, TINY)[None])[0]
    with np.errstate(divide="ignore"):
        high = float(np.max(np.log(size + radius)))
        low = max(float(np.max(np.log(np.maximum(size - radius, 0.0)))), mean)
        exponents: Complex = np.full(len(mu), -np.inf, complex)
        exponents[size > 0.0] = np.log(mu[size > 0.0]) / period
        share = np.divide(radius, size, out=np.ones_like(size), where=size > 0.0)
        off = -np.log1p(-np.minimum(share, 1.0)) / period
    rounding = 8.0 * EPS * 2.0 / period
    low, high = (
        2.0 / period * x for x in (low - 8.0 * EPS * abs(low), high + 8.0 * EPS * abs(high))
    )
    low, high = low - rounding, high + rounding
    T = float(np.clip(2.0 / period * np.log(size[0]), low, high))
    verdict: Verdict = "undecided"
    if high < 0.0:
        verdict = "stable"
    elif low > 0.0 or _beyond(polynomial, errors):
        verdict = "unstable"
    return Multipliers(mu, exponents, off + rounding, T, max(high - T, T - low), verdict)


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


def _beyond(p: Float, errors: Float) -> bool:
    """Whether a real root is shown to be beyond 1 or -1, by the sign of the monic polynomial."""
    margin = 1.01 * np.sum(errors) + HORNER * len(p) * EPS * np.sum(np.abs(p))
    signs = (-1.0) ** np.arange(len(p))
    return bool(np.sum(p) < -margin or np.sum(p * signs) < -margin)
