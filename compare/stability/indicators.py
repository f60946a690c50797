"""What changes sign where a tongue begins, along a line on which P(z) is smooth.

An undamped system is stable while every z is real and within [-1, 1]. It ceases to be where a z
passes +1 or -1, a zero of P there (type I, near 2 omega_i/k), or where two z meet, a zero of the
discriminant of P (type II, near (omega_i +- omega_j)/k). The coefficients of P are smooth where z
and T are not, so a line is sampled once and P interpolated on it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from compare.charts import chebyshev
from compare.stability.roots import companion_roots, discriminant, growth_off_axis, real_range
from compare.stability.roots import growth as log_R

Complex = NDArray[np.complexfloating[Any]]
Float = NDArray[np.floating[Any]]
Function = Callable[[Float], Float]

# An interpolant is kept once its last two coefficients are this share of the largest: P itself is
# known to about 1e-14.
TAIL = 1e-12
DEGREES = (8, 16, 32, 64, 128, 256)
# Points of the grid on which sign changes are looked for.
GRID = 241


BESIDE_POLE = "a pole of the system is too near"
TOO_STEEP = "P cannot be interpolated about it"
"""Why P is not followed along a line."""


class NotSmooth(ValueError):
    """P cannot be interpolated on a line: a pole is on it or too near, or P is too steep.

    Attributes
    ----------
    why : str
        In a few words.
    """

    def __init__(self, message: str, why: str = TOO_STEEP) -> None:
        super().__init__(message)
        self.why = why


@dataclass(frozen=True, eq=False)
class Interpolant:
    """P along a line by Chebyshev polynomials, coefficient by coefficient."""

    lo: float
    hi: float
    coefficients: Float

    @property
    def _degrees(self) -> Float:
        return np.arange(len(self.coefficients), dtype=float)

    def __call__(self, s: Float) -> Float:
        """Coefficients of P at each s, shape (k, n + 1)."""
        t = (2.0 * np.atleast_1d(s) - self.lo - self.hi) / (self.hi - self.lo)
        # one product, where a recurrence takes as many steps as there are coefficients
        angle = np.arccos(np.clip(t, -1.0, 1.0))
        return np.asarray(np.cos(np.outer(angle, self._degrees)) @ self.coefficients)


def interpolate(P: Function, lo: float, hi: float, tail: float = TAIL) -> Interpolant:
    """Sample P on Chebyshev nodes, more of them until the last coefficients are below `tail`.

    Raises
    ------
    NotSmooth
        `DEGREES` do not suffice: the line is too long, or passes a pole of G.
    """
    known: Float | None = None
    for degree in DEGREES:
        every = chebyshev.lobatto(degree + 1)
        added = every if known is None else every[1::2]  # the others are of the last round
        found = P(0.5 * (lo + hi + (hi - lo) * added))
        values = found
        if known is not None:
            values = np.empty((degree + 1, found.shape[1]))
            values[::2], values[1::2] = known, found
        known = values
        c = chebyshev.coefficients(values, (0,))
        if np.abs(c[-2:]).max() <= tail * np.abs(c).max():
            return Interpolant(lo, hi, c)
    raise NotSmooth(f"from {lo:g} to {hi:g}: P is not smooth enough to be interpolated")


def interpolate_in_Omega(P: Function, lo: float, hi: float, tail: float = TAIL) -> Function:
    """P over lo <= Omega <= hi, interpolated in 1/Omega.

    With a rigid bar P depends on Omega through F/Omega^2 and G/Omega^2: it is entire in 1/Omega.
    """
    inner = interpolate(lambda s: P(1.0 / s), 1.0 / hi, 1.0 / lo, tail)
    return lambda Omega: inner(1.0 / Omega)


def growth(P: Float, Omega: Float | float, eta: float = 0.0) -> Float:
    """T of (7.1.1) for many P at once, shape (k, n + 1)."""
    return np.asarray(Omega / np.pi * log_R(P.T) - eta)


def indicator(kind: str, P: Float, Omega: Float, eta: float = 0.0) -> Float:
    """What is negative within an instability of this kind near its resonance, zero on its edge.

    At T = 0 R = exp(pi eta/Omega): a real z is at +-c, c = cosh(pi eta/Omega), or 1 undamped.

    "+1", "-1": how far the real parts of all z keep within c, or -c. Zero where P(c) is, but unlike
    it negative also where two z are beyond. "pair": the discriminant of P; with
    damping, -T of the complex pair of z alone.

    Parameters
    ----------
    kind : {"+1", "-1", "pair"}
    P : (k, n + 1) ndarray
    Omega : (k,) ndarray
    eta : float, optional
    """
    if kind == "pair":
        return eta - Omega / np.pi * growth_off_axis(P) if eta > 0.0 else discriminant(P)
    least, largest = real_range(P)
    return np.asarray(np.cosh(np.pi * eta / Omega) + (least if kind == "-1" else -largest))


def edge_function(kind: str, P: Float, Omega: Float, eta: float | Float = 0.0) -> Float:
    """A function that is smooth in P and Omega and vanishes on the edges of this kind.

    "+1", "-1": P(c) and P(-c), c = cosh(pi eta/Omega). "pair": over all pairs of z, the
    product of what is zero where x +- i y with x + i y + x - i y = z_i + z_j lie on the ellipse
    R = exp(pi eta/Omega), that is x^2/c^2 + y^2/s^2 = 1, s = sinh(pi eta/Omega). It is symmetric in
    the z, so a polynomial in P's coefficients; undamped it is the discriminant, up to a factor.

    Parameters
    ----------
    kind : {"+1", "-1", "pair"}
    P : (k, n + 1) ndarray
    Omega : (k,) ndarray
    eta : float or (k,) ndarray, optional
    """
    c, s = np.cosh(np.pi * eta / Omega), np.sinh(np.pi * eta / Omega)
    if kind != "pair":
        at = c if kind == "+1" else -c
        value = np.zeros_like(at)
        for coefficient in P.T:
            value = value * at + coefficient
        return np.asarray(value)
    z = companion_roots(P)
    i, j = np.triu_indices(z.shape[1], 1)
    x, y2 = 0.5 * (z[:, i] + z[:, j]), -0.25 * (z[:, i] - z[:, j]) ** 2
    return np.asarray(np.prod((s / c)[:, None] ** 2 * x**2 + y2 - s[:, None] ** 2, axis=1).real)


def deepest(f: Function, lo: float, hi: float) -> tuple[float, float]:
    """Where f is least in the window, and its value there; by ever finer grids."""
    centre, value, left, right = lo, np.inf, lo, hi
    for points in (GRID, 21, 21, 21):
        x = np.linspace(left, right, points)
        y = f(x)
        centre, value = float(x[y.argmin()]), float(y.min())
        left, right = max(lo, centre - x[1] + x[0]), min(hi, centre + x[1] - x[0])
    return centre, value


# How near a zero is found to a sign change: to the first and to the second's share of it.
ZERO_TO, ZERO_SHARE = 1e-13, 1e-14


def zero(
    f: Function, lo: float, hi: float, *, xtol: float = ZERO_TO, rtol: float = ZERO_SHARE
) -> float:
    """The sign change of f between lo and hi, to the larger of `xtol` and its share `rtol`."""
    return float(brentq(lambda x: f(np.array([x]))[0], lo, hi, xtol=xtol, rtol=rtol))


def crossings(f: Function, x: Float) -> tuple[list[float], list[float]]:
    """Where f falls below zero, and where it rises above it, between the points of a grid."""
    falls, rises = _changes(f, x)
    return [_between(f, x, i) for i in falls], [_between(f, x, i) for i in rises]


def _between(f: Function, x: Float, i: int) -> float:
    """The sign change between two points of a grid.

    Where f is 0 to rounding at one of them its sign may be another alone than on the grid: it is
    there.
    """
    first, last = (float(f(x[k : k + 1])[0]) for k in (i, i + 1))
    if (first < 0.0) == (last < 0.0):
        return float(x[i] if abs(first) < abs(last) else x[i + 1])
    return zero(f, x[i], x[i + 1])


def _changes(f: Function, x: Float) -> tuple[list[int], list[int]]:
    """Points of a grid after which f falls below zero, and after which it rises above it."""
    inside = f(x) < 0.0
    falls = np.flatnonzero(~inside[:-1] & inside[1:])
    rises = np.flatnonzero(inside[:-1] & ~inside[1:])
    return falls.tolist(), rises.tolist()


def edges(
    f: Function,
    lo: float,
    hi: float,
    guess: tuple[float, float],
    bottom: float,
    grows: Callable[[Float], NDArray[np.bool_]] | None = None,
) -> tuple[float, float] | None:
    """The pair of zeros between which f < 0 that is nearest to the guess, or None.

    Two instabilities that overlap may make f positive where they do, so the zeros need not follow
    one another; with `grows` given, the system must be unstable all the way between them. Zeros
    closer together than the grid's step, of a narrower tongue that crosses this one, pass
    unnoticed, unless they enclose `bottom`.
    """
    x = np.unique(np.append(np.linspace(lo, hi, GRID), bottom))
    falls, rises = _changes(f, x)
    if not (falls and rises):
        return None
    # how many points to the left are stable: none may be between a fall and a rise
    stable = np.cumsum(~grows(x)) if grows is not None else np.zeros(len(x), int)
    found = [(i, j) for i in falls for j in rises if i < j and stable[j] == stable[i]]
    at = {k: _between(f, x, k) for pair in found for k in pair}
    pairs = [(at[i], at[j]) for i, j in found]
    return min(pairs, key=lambda p: abs(p[0] - guess[0]) + abs(p[1] - guess[1]), default=None)
