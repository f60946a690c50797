"""T, verdict and edges from polynomials of the multipliers themselves, of any linear equation.

Nothing is decided by a computed root alone. Whose roots they are is measured: their own polynomial
is multiplied out and differs from the given one by so much. Where the unit circle keeps clear of
them this, and the given one's error, are too small to matter on it, and then as many true
multipliers are beyond it as computed ones (Rouche). Elsewhere each has a disc that holds a true
one.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.stability.points import STABLE, UNDECIDED, UNSTABLE, VERDICTS, Codes, Points
from compare.stability.roots import CHUNK, companion_roots
from hill.stability import root_radii

Bool = NDArray[np.bool_]
Complex = NDArray[np.complexfloating[Any, Any]]
Float = NDArray[np.floating[Any]]
EPS = float(np.finfo(float).eps)

# What stands for the modulus of a multiplier that is 0.
TINY = 1e-300


def argument(P: Float, Omega: Float, eta: Float) -> Float:
    """T of many polynomials, (m + 1, k): twice the largest growth exponent, as (7.1.1)."""
    del eta  # is in the multipliers
    found = np.empty(P.shape[1])
    for start in range(0, len(found), CHUNK):
        part = slice(start, start + CHUNK)
        found[part] = _argument(companion_roots(P[:, part].T), Omega[part])
    return found


def growth(P: Float, Omega: Float | float, eta: float = 0.0) -> Float:
    """The same of a few, (k, m + 1)."""
    del eta
    return _argument(companion_roots(P), Omega)


def _argument(mu: Complex, Omega: Float | float) -> Float:
    return np.asarray(Omega / np.pi * np.log(np.maximum(np.abs(mu).max(axis=1), TINY)))


def verdicts(P: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Codes:
    """The verdict of many, (k, m + 1): which of `VERDICTS`."""
    del T, Omega, eta
    result = np.full(len(P), UNDECIDED, np.int8)
    for start in range(0, len(P), CHUNK):
        part = slice(start, start + CHUNK)
        result[part] = _verdicts(P[part], error[part], companion_roots(P[part]))
    return result


def _verdicts(P: Float, error: Float, mu: Complex) -> Codes:
    shown, beyond = _on_unit_circle(mu, error + _apart(P, mu))
    stable, unstable = shown & ~beyond, (shown & beyond) | _sign_shows(P, error)
    rest = np.flatnonzero(~stable & ~unstable)
    low, high = _largest(P[rest], error[rest], mu[rest])
    stable[rest], unstable[rest] = high < 1.0, low > 1.0
    found = np.where(stable, STABLE, np.where(unstable, UNSTABLE, UNDECIDED))
    return found.astype(np.int8)


def argument_errors(P: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Float:
    """Bounds on the errors of many T that were computed from P, (k, m + 1), as it is."""
    del eta
    result = np.empty(len(P))
    for start in range(0, len(P), CHUNK):
        part = slice(start, start + CHUNK)
        low, high = _bounds(P[part], error[part], companion_roots(P[part]), Omega[part])
        result[part] = _farther(T[part], low, high, Omega[part])
    return result


def solve(P: Float, error: Float, Omega: Float, eta: Float) -> Points:
    """Multipliers and growth of several, (k, m + 1), each with its own error and Omega."""
    del eta
    mu = companion_roots(P)
    mu = np.take_along_axis(mu, np.argsort(-np.abs(mu), axis=1, kind="stable"), axis=1)
    T = _argument(mu, Omega)
    low, high = _bounds(P, error, mu, Omega)
    return Points(
        polynomial=P,
        error=error,
        z=np.empty((len(P), 0), complex),
        multipliers=mu,
        R=np.abs(mu[:, 0]),
        T=T,
        T_error=_farther(T, low, high, Omega),
        verdict=np.array(VERDICTS)[_verdicts(P, error, mu)],
    )


def indicator(kind: str, P: Float, Omega: Float, eta: float = 0.0) -> Float:
    """What is negative within an instability of this kind near its resonance, zero on its edge.

    Parameters
    ----------
    kind : {"+1", "-1", "pair"}
        How far the real parts of all multipliers keep below 1, or above -1; how far the moduli of
        those that are not real keep below 1.
    P : (k, m + 1) ndarray
    Omega, eta
        Are of no matter.
    """
    del Omega, eta
    mu = companion_roots(P)
    if kind == "+1":
        return np.asarray(1.0 - mu.real.max(axis=1))
    if kind == "-1":
        return np.asarray(1.0 + mu.real.min(axis=1))
    return np.asarray(1.0 - np.max(np.where(mu.imag != 0.0, np.abs(mu), 0.0), axis=1))


def edge_function(kind: str, P: Float, Omega: Float, eta: float | Float = 0.0) -> Float:
    """A function that is smooth in P and vanishes on the edges of this kind.

    "+1", "-1": P(1) and P(-1). "pair": the product over all pairs of 1 - mu_i mu_j, which is zero
    where a complex pair is on the unit circle, symmetric in the multipliers and so a polynomial in
    P's coefficients.

    Parameters
    ----------
    kind : {"+1", "-1", "pair"}
    P : (k, m + 1) ndarray
    Omega, eta
        Are of no matter.
    """
    del Omega, eta
    if kind != "pair":
        at = 1.0 if kind == "+1" else -1.0
        powers = at ** np.arange(P.shape[1] - 1, -1, -1)
        return np.asarray(P @ powers)
    mu = companion_roots(P)
    i, j = np.triu_indices(mu.shape[1], 1)
    return np.asarray(np.prod(1.0 - mu[:, i] * mu[:, j], axis=1).real)


def _apart(P: Float, mu: Complex) -> Float:
    """How far each coefficient is from the computed roots' own at most, (k,)."""
    own = np.zeros(P.shape, complex)
    own[:, 0] = 1.0
    size = own.real.copy()
    for j, root in enumerate(mu.T, start=1):
        own[:, 1 : j + 1] -= root[:, None] * own[:, :j]
        size[:, 1 : j + 1] += np.abs(root)[:, None] * size[:, :j]
    # a complex product and a sum each round by less than 4 EPS of the moduli
    rounding = 4.0 * EPS * mu.shape[1] * size.max(axis=1)
    return np.asarray(np.abs(own - P).max(axis=1) + rounding)


def _on_unit_circle(mu: Complex, off: Float) -> tuple[Bool, Bool]:
    """Whether as many are beyond the unit circle as seem to be, and whether any seem to, (k,).

    On it the computed roots' polynomial is at least prod |1 - |mu||; one whose coefficients but the
    first are off by `off` differs from it by m off.
    """
    m, size = mu.shape[1], np.abs(mu)
    with np.errstate(over="ignore"):
        gap = np.prod(np.maximum(np.abs(1.0 - size) - 4.0 * EPS * (1.0 + size), 0.0), axis=1)
    return gap > (1.0 + 8.0 * m * EPS) * m * off, np.any(size > 1.0, axis=1)


def _largest(P: Float, error: Float, mu: Complex) -> tuple[Float, Float]:
    """Between which the largest modulus is, (k,), by discs each of which holds one."""
    errors = np.broadcast_to(error[:, None], P.shape).copy()
    errors[:, 0] = 0.0
    size = np.maximum(np.abs(mu), TINY)
    radius = root_radii(P, errors, mu, size)
    low = np.max(size - radius, axis=1) * (1.0 - 4.0 * EPS)
    # nor is it smaller than all in the mean (Liouville)
    product = np.maximum((1.0 - EPS) * np.abs(P[:, -1]) - error, 0.0)
    low = np.maximum(low, (1.0 - 4.0 * EPS) * product ** (1.0 / mu.shape[1]))
    return low, np.max(size + radius, axis=1) * (1.0 + 4.0 * EPS)


def _bounds(P: Float, error: Float, mu: Complex, Omega: Float) -> tuple[Float, Float]:
    """Between which T is, (k,)."""
    low, high = _largest(P, error, mu)
    with np.errstate(divide="ignore"):
        return Omega / np.pi * np.log(low), Omega / np.pi * np.log(high)


def _farther(T: Float, low: Float, high: Float, Omega: Float) -> Float:
    """The larger distance from T, with the roundings of the logarithms."""
    rounding = 8.0 * EPS * (Omega / np.pi + np.abs(T))
    return np.asarray(np.maximum(np.abs(high - T), np.abs(T - low)) + rounding)


def _sign_shows(P: Float, error: Float) -> Bool:
    """Whether the polynomial's sign at 1, or at -1, shows a real multiplier beyond."""
    m = P.shape[1] - 1
    margin = error * m + 2.0 * m * EPS * np.abs(P).sum(axis=1)
    signs = (-1.0) ** np.arange(m + 1)
    return np.asarray((P.sum(axis=1) < -margin) | (P @ signs < -margin))
