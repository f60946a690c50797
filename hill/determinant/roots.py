r"""Roots of det(mu I - Phi), or of P(z), from the determinant itself.

The coefficients of a polynomial of high degree are the ill-conditioned way to its roots: with
thirty coordinates they know none of them. The determinant's own values near a root, and its
derivative, know it to rounding. All roots are improved together, by Ehrlich's and Aberth's method

    v_i <- v_i - N_i/(1 - N_i sum_(j != i) 1/(v_i - v_j)),     N = P/P',

and then the discs of radius n |W_i| about v_i,

    W_i = P(v_i)/prod_(j != i) (v_i - v_j),

hold all roots of a monic P of degree n, and those that hang together as many as they are (Smith).
None is missing, wherever the v_i came from.

References
----------
O. Aberth, Math. Comp. 27 (1973) 339; B. T. Smith, J. ACM 17 (1970) 661.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import connected_components

from hill.arrays import EPS, Complex, Float
from hill.determinant.finite import OVERFLOW
from hill.determinant.general_values import Determinant, values

# Of ln |mu|: where T is known less well from a polynomial, the roots themselves are looked at.
WELL_KNOWN = 1e-11

MAX_SWEEPS = 24

# Sweeps after which the symmetry of roots about the real axis is given up.
SYMMETRIC = 3

# Within it, over its modulus, a root is done when its steps get no smaller than by this factor.
NEAR, SLOW = 1e-6, 0.8

# Ulps by which a point, or its logarithm, is off for being a float.
BLUR = 8.0 * EPS

# Moves a point off one where nothing can be evaluated, a root or where a group of rows is singular.
ASIDE, MAX_ASIDE = 1.0 + 2.0**-46, 8


@dataclass(frozen=True, eq=False)
class At:
    """A monic polynomial at k points.

    Attributes
    ----------
    log : (k,) ndarray
        ln |P|.
    slope : (k,) complex ndarray
        P'/P.
    blur : (k,) ndarray
        How far the points are off for being floats.
    unit : (k,) ndarray
        A length on which P changes: |y|, or 1 for z.
    rounding : (k,) ndarray
        What rounding may have moved ln P by; empty if not asked.
    """

    log: Float
    slope: Complex
    blur: Float
    unit: Float
    rounding: Float


Evaluate = Callable[[Complex, bool], At]
"""Points, and whether `rounding` is asked for."""


def monic_in_y(d: Determinant) -> Evaluate:
    """Det(r y I - Phi)/r^m as a polynomial in y."""

    def evaluate(y: Complex, bounds: bool) -> At:
        log_y = np.asarray(np.log(y) / (2.0 * np.pi), complex)
        found = values(d, log_y, bounds=bounds)
        log = np.log(np.abs(found.mantissa)) + found.exponent * np.log(2.0)
        log = log + np.pi * d.order * log_y.real
        blur = BLUR * np.abs(y) * (1.0 + np.abs(np.log(y)))
        return At(log, found.slope / (2.0 * np.pi * y), blur, np.abs(y), found.rounding)

    return _by_halves(evaluate)


def monic_in_z(d: Determinant) -> Evaluate:
    """P(z), z = (y + 1/y)/2, of an equation whose multipliers y r come in pairs y, 1/y."""
    n = d.order // 2

    def evaluate(z: Complex, bounds: bool) -> At:
        y = larger_of_pair(z)
        found = values(d, np.asarray(np.log(y) / (2.0 * np.pi), complex), bounds=bounds)
        # det(y r I - Phi)/r^m = (2 y)^n P(z)
        log = np.log(np.abs(found.mantissa)) + (found.exponent - n) * np.log(2.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = 2.0 * (found.slope / (2.0 * np.pi) - n) / (y - 1.0 / y)
        # at z = 1 and -1 there is no telling
        slope = np.where(np.isfinite(slope), slope, 0.0)
        return At(log, slope, BLUR * (1.0 + np.abs(z)), np.ones(len(z)), found.rounding)

    return _by_halves(evaluate)


def larger_of_pair(z: Complex) -> Complex:
    """Y with z = (y + 1/y)/2, |y| >= 1."""
    root = np.sqrt(z - 1.0) * np.sqrt(z + 1.0)
    return np.where(np.abs(z + root) >= np.abs(z - root), z + root, z - root)


def _by_halves(evaluate: Evaluate) -> Evaluate:
    """Each of two conjugate points once."""

    def both(v: Complex, bounds: bool) -> At:
        upper = np.where(v.imag < 0.0, v.conj(), v)
        once, back = np.unique(upper, return_inverse=True)
        found = evaluate(once, bounds)
        slope = np.where(v.imag < 0.0, found.slope[back].conj(), found.slope[back])
        rounding = found.rounding[back] if bounds else found.rounding
        return At(found.log[back], slope, found.blur[back], found.unit[back], rounding)

    return both


def improved(evaluate: Evaluate, v: Complex) -> Complex:
    """All roots, from approximations that may be rough, by Ehrlich's and Aberth's method."""
    v = apart(v)
    moving = np.arange(len(v))
    last = np.full(len(v), np.inf)
    for sweep in range(MAX_SWEEPS):
        try:
            slope = evaluate(v[moving], False).slope
        except np.linalg.LinAlgError:
            # on a root, or where a group of rows is singular
            v = v * ASIDE
            continue
        difference = v[moving, None] - v
        difference[np.arange(len(moving)), moving] = np.inf
        step = 1.0 / (slope - np.sum(1.0 / difference, axis=1))
        step = np.where(np.isfinite(step), step, 0.0)
        size, before, unit = np.abs(step), last[moving], np.abs(v[moving])
        if sweep == SYMMETRIC:
            # conjugate points cannot become two real ones, nor real ones conjugate
            turn = 1.0 + 0.5 * np.exp(1j * np.arange(len(step)))
            step = step * np.where(size > NEAR * unit, turn, 1.0)
        v[moving] = v[moving] - step
        last[moving] = size
        # until it is a rounding error, or no longer gets smaller; to a double root it goes slowly
        on = (size > 8.0 * EPS * unit) & ((size < SLOW * before) | (size > NEAR * unit))
        moving = moving[on]
        if len(moving) == 0:
            break
    return apart(symmetrised(v))


def symmetrised(v: Complex) -> Complex:
    """Roots of a real polynomial that are nearly conjugate made so; nearly real ones real."""
    found = v.copy()
    partner = np.argmin(np.abs(v[:, None] - v.conj()), axis=1)
    mutual = partner[partner] == np.arange(len(v))
    found[mutual] = 0.5 * (v[mutual] + v[partner[mutual]].conj())
    return found


def apart(v: Complex) -> Complex:
    """The same points, none twice."""
    v = v.astype(complex)
    for i in range(len(v)):
        while np.any(v[:i] == v[i]):
            v[i] = v[i] * ASIDE if v[i] != 0.0 else EPS
    return v


@dataclass(frozen=True, eq=False)
class Discs:
    """A disc about each of n points that holds a root of its own.

    Attributes
    ----------
    centre : (n,) complex ndarray
    radius : (n,) ndarray
    """

    centre: Complex
    radius: Float


def at(evaluate: Evaluate, v: Complex) -> tuple[At, Complex]:
    """With bounds, at the points or a few ulps aside; and at which."""
    for _ in range(MAX_ASIDE):
        try:
            return evaluate(v, True), v
        except np.linalg.LinAlgError:
            v = v * ASIDE
    raise OverflowError(OVERFLOW)


def discs(evaluate: Evaluate, v: Complex) -> Discs:
    """From points near all n roots, and what rounding leaves of the polynomial's values there."""
    n = len(v)
    here, v = at(evaluate, apart(v))
    distance = np.abs(v[:, None] - v)
    np.fill_diagonal(distance, 1.0)
    with np.errstate(over="ignore", divide="ignore"):
        log_W = here.log + np.log1p(here.rounding) - np.sum(np.log(distance), axis=1)
        radius = n * np.exp(log_W) + here.blur
    np.fill_diagonal(distance, 0.0)
    _, region = connected_components(distance <= 1.01 * (radius[:, None] + radius))
    together = region[:, None] == region
    # one of a region's roots may be anywhere in it
    return Discs(v, np.max(np.where(together, distance + radius, 0.0), axis=1))
