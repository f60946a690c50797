"""From P(z) to R, T and a verdict, with what the error of P allows (sections 6.4 and 7.1).

Nothing here is decided by a computed root alone. Each root has a disc that holds the true one; T
lies between what the discs allow; and the verdict is "stable" or "unstable" where that is shown,
"undecided" everywhere else. Many polynomials go at once: the last axis is the coefficient or root.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hill.arrays import EPS, Bool, Complex, Float, frozen
from hill.precision import poor_T

Verdict = Literal["stable", "unstable", "undecided"]

# Radii tried for a root's disc, in units of 1 + |z|: from below an ulp to beyond every other root.
RADII = frozen(2.0 ** np.arange(-54.0, 3.5, 0.5))

# Polynomials at a time: the discs' candidates stay in the cache.
CHUNK = 1024

# A polynomial of degree n at a point, by Horner: 2 n roundings of the sum of its terms' moduli; and
# as many again for the point's powers in those moduli.
HORNER = 4.0


@dataclass(frozen=True, eq=False)
class Stability:
    """Roots z of one P and their discs' radii, T and its error, and the verdict."""

    z: Complex
    radius: Float
    T: float
    T_error: float
    verdict: Verdict


@dataclass(frozen=True, eq=False)
class Stabilities:
    """The same for k polynomials.

    Attributes
    ----------
    z : (k, n) complex ndarray
        By descending real part.
    radius : (k, n) ndarray
        The true root is within it of z.
    T, T_error : (k,) ndarray
        Characteristic argument (7.1.1), and a bound on its error.
    verdict : (k,) ndarray of str
        "stable", "unstable" or "undecided".
    poor : (k,) bool ndarray
        Whether T is known to less than nine digits: `hill.precision`.
    """

    z: Complex
    radius: Float
    T: Float
    T_error: Float
    verdict: NDArray[np.str_]
    poor: Bool


def stability_of(polynomial: Float, error: ArrayLike, Omega: float, eta: float) -> Stability:
    """Roots of P, the characteristic argument T = (Omega/pi) ln R - eta (7.1.1), the verdict.

    Parameters
    ----------
    polynomial : (n + 1,) ndarray
        Monic, highest power first.
    error : float or (n + 1,) array_like
        Bound on the absolute error of each coefficient but the leading 1.
    Omega, eta : float
        Forcing frequency and transverse damping, over ``omega_1``.
    """
    errors = np.broadcast_to(np.asarray(error, float), polynomial.shape)
    found = stabilities(polynomial[None], errors[None], np.array([Omega]), np.array([eta]))
    return _first(found)


def stabilities(polynomials: Float, errors: Float, Omega: Float, eta: Float) -> Stabilities:
    """As `stability`, for many polynomials (k, n + 1), errors (k, n + 1), Omega and eta (k,)."""
    parts = [
        _stabilities(*(x[start : start + CHUNK] for x in (polynomials, errors, Omega, eta)))
        for start in range(0, max(len(polynomials), 1), CHUNK)
    ]
    fields = ("z", "radius", "T", "T_error", "verdict", "poor")
    return Stabilities(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in fields)
    )


def stability_in_discs(z: Complex, radius: Float, Omega: float, eta: float) -> Stability:
    """T and the verdict from discs, each of which holds a root z of its own; of one P.

    Parameters
    ----------
    z, radius : (n,) ndarray
    """
    order = np.lexsort((z.imag, -z.real))
    z, radius = z[None, order], radius[None, order]
    real = _is_real(z, radius)
    inside = np.all(real & (np.abs(z.real) + radius < 1.0), axis=1)
    nothing = np.zeros(1, bool)
    return _first(_judged(z, radius, (inside, nothing), np.array([Omega]), np.array([eta])))


def _first(found: Stabilities) -> Stability:
    verdict: Any = str(found.verdict[0])
    T, T_error = float(found.T[0]), float(found.T_error[0])
    return Stability(found.z[0], found.radius[0], T, T_error, verdict)


def _stabilities(p: Float, errors: Float, Omega: Float, eta: Float) -> Stabilities:
    errors = errors.copy()
    errors[:, 0] = 0.0
    z = roots(p)
    between = 0.5 * (z.real[:, :-1] + z.real[:, 1:])
    shown = by_signs(p, errors, between, np.pi * eta / Omega)
    return _judged(z, root_radii(p, errors, z), shown, Omega, eta)


def _judged(
    z: Complex, radius: Float, shown: tuple[Bool, Bool], Omega: Float, eta: Float
) -> Stabilities:
    """From discs, and what is shown otherwise: that all z are inside the edges, or one beyond."""
    inside, beyond = shown
    real = _is_real(z, radius)
    x, y = np.abs(z.real), np.abs(z.imag)
    outer = log_R(x + radius, np.where(real, 0.0, y + radius))
    inner = log_R(np.maximum(x - radius, 0.0), np.where(real, 0.0, np.maximum(y - radius, 0.0)))
    to_T = Omega / np.pi
    rounding = 8.0 * EPS * (to_T + np.abs(eta))
    high = to_T * outer.max(axis=1) * (1.0 + 8.0 * EPS) - eta + rounding
    low = to_T * inner.max(axis=1) * (1.0 - 8.0 * EPS) - eta - rounding
    T = np.clip(to_T * log_R(x, np.where(real, 0.0, y)).max(axis=1) - eta, low, high)

    stable = (high < 0.0) | (inside & (eta >= 0.0))
    unstable = ((low > 0.0) | beyond) & ~stable
    # all z are shown to be real and within [-1, 1]: R is 1
    still = inside & (eta == 0.0)
    T = np.where(still, 0.0, T)
    T_error = np.where(still, rounding, np.maximum(high - T, T - low))
    verdict = np.where(stable, "stable", np.where(unstable, "unstable", "undecided"))
    return Stabilities(z, radius, T, T_error, verdict, poor_T(T, T_error, Omega))


def arguments(polynomials: Float, Omega: Float | float, eta: Float | float = 0.0) -> Float:
    """T of (7.1.1) of many P, (k, n + 1), without a bound: for curves."""
    z = roots(polynomials)
    growth = log_R(np.abs(z.real), np.abs(z.imag)).max(axis=-1)
    return np.asarray(Omega / np.pi * growth - eta)


def roots(polynomials: Float) -> Complex:
    """Roots of monic polynomials (k, n + 1): (k, n), by descending real part."""
    n = polynomials.shape[1] - 1
    companion = np.zeros((len(polynomials), n, n))
    companion[:, 0] = -polynomials[:, 1:]
    companion[:, np.arange(1, n), np.arange(n - 1)] = 1.0
    z = np.linalg.eigvals(companion).astype(complex)
    order = np.lexsort((z.imag, -z.real), axis=-1)
    return np.asarray(np.take_along_axis(z, order, axis=1))


def root_radii(p: Float, errors: Float, z: Complex, size: Float | None = None) -> Float:
    """A radius about each computed root z that holds a true one, all of them accounted for.

    On a circle about z_j on which the computed polynomial exceeds whatever its error can amount to,
    no root passes while the error is turned up from nothing to its full size: the root that starts
    at z_j stays inside (Rouche). So each true root is in its own disc, cluster or not, and in a
    cluster of m the discs are no larger than the m-th root of the error. On |z - z_j| = r the
    polynomial prod (z - z_k) is at least prod ||z_j - z_k| - r|: nothing is sampled.

    Parameters
    ----------
    p, errors : (k, n + 1) ndarray
        Monic; ``errors[:, 0]`` is 0.
    z : (k, n) complex ndarray
    size : (k, n) ndarray, optional
        Unit of the radii that are tried, no less than the modulus of z: 1 + |z| by default.

    Returns
    -------
    (k, n) ndarray
        Where no circle is clear, one about z_j that holds all roots there are.
    """
    n = z.shape[1]
    size = 1.0 + np.abs(z) if size is None else size
    with np.errstate(over="ignore", invalid="ignore"):
        again, moduli = _from_roots(z), _from_roots(-np.abs(z).astype(complex)).real
        unsure = errors + np.abs(p - again) + 4.0 * n * EPS * np.abs(moduli)
        unsure[:, 0] = 0.0
        radii = RADII * size[:, :, None]
        distance = np.abs(z[:, :, None] - z[:, None, :])
        rounding = 4.0 * EPS * (size[:, :, None] + size[:, None, :])
        gap = np.abs(distance[..., None] - radii[:, :, None]) - rounding[..., None]
        value = np.prod(np.maximum(gap, 0.0), axis=2)
        farthest = np.abs(z)[:, :, None] + radii
        moved = np.zeros_like(farthest)
        for k in range(n + 1):
            moved = moved * farthest + unsure[:, k, None, None]
        clear = value > 1.01 * moved
        # Cauchy: every root is within 1 + max |p_k|
        everything = 1.0 + np.max(np.abs(p[:, 1:]) + errors[:, 1:], axis=1, keepdims=True)
        first = np.take_along_axis(radii, clear.argmax(axis=2)[..., None], axis=2)[..., 0]
        return np.where(clear.any(axis=2), np.minimum(first, everything + size), everything + size)


def _from_roots(z: Complex) -> Any:
    """Coefficients of prod (x - z_j), (k, n + 1), highest power first."""
    p = np.zeros((len(z), z.shape[1] + 1), complex)
    p[:, 0] = 1.0
    for j in range(z.shape[1]):
        p[:, 1:] -= z[:, j, None] * p[:, :-1]
    return p


def _is_real(z: Complex, radius: Float) -> Bool:
    """Whether a disc about a real z holds no other root: then its root is real, as P is."""
    apart = np.abs(z[:, :, None] - z[:, None, :])
    n = z.shape[1]
    apart[:, np.arange(n), np.arange(n)] = np.inf
    return np.asarray((z.imag == 0.0) & np.all(apart > radius[:, :, None], axis=2))


def by_signs(p: Float, errors: Float, between: Float, decay: Float) -> tuple[Bool, Bool]:
    """Whether P's signs alone show all z to be inside the edges, or one to be beyond.

    At T = 0 a real z is at an edge +-c, c = cosh(pi eta/Omega), or 1 undamped. P that changes sign
    n times within (-c, c) has all its roots there, real and simple. P(c) < 0 or (-1)^n P(-c) < 0
    leaves a real root beyond, since P is monic.

    Parameters
    ----------
    p, errors : (k, n + 1) ndarray
        Monic; ``errors[:, 0]`` is 0.
    between : (k, n - 1) ndarray
        Descending; where the signs are looked at, best between the roots.
    decay : (k,) ndarray
        pi eta/Omega.
    """
    k, n = len(p), p.shape[1] - 1
    with np.errstate(over="ignore", invalid="ignore"):
        c = np.where(decay > 0.0, np.cosh(decay), 1.0)[:, None]
        x = np.hstack([c, between, -c])
        size = np.abs(x)
        value, moduli, unsure = (np.zeros((k, n + 1)) for _ in range(3))
        for j in range(n + 1):
            value = value * x + p[:, j, None]
            moduli = moduli * size + np.abs(p[:, j, None])
            unsure = unsure * size + errors[:, j, None]
        # the edge itself is known to a few ulps of the exponent
        margin = 1.01 * unsure + HORNER * (n + 1) * (2.0 + np.abs(decay[:, None])) * EPS * moduli
        sign = np.where(np.abs(value) > margin, np.sign(value), 0.0)
    expected = (-1.0) ** np.arange(n + 1)
    ordered = np.all(np.diff(x, axis=1) < 0.0, axis=1)
    inside = np.all(sign == expected, axis=1) & ordered
    beyond = (sign[:, 0] < 0.0) | (sign[:, -1] * expected[-1] < 0.0)
    return inside, beyond


def separators(p: Float) -> Float:
    """Points between the roots of P, descending (k, n - 1): where P' is zero, if that is cheap."""
    n = p.shape[1] - 1
    if n == 1:
        return np.empty((len(p), 0))
    if n == 2:
        return -0.5 * p[:, 1:2]
    if n == 3:
        spread = np.sqrt(np.maximum(p[:, 1] ** 2 - 3.0 * p[:, 2], 0.0))
        return np.stack([-p[:, 1] + spread, -p[:, 1] - spread], axis=1) / 3.0
    z = roots(p).real
    return np.asarray(0.5 * (z[:, :-1] + z[:, 1:]))


def log_R(x: Float, y: Float) -> Float:
    """Ln |z + (z^2 - 1)^(1/2)| of z = x + iy, the larger, for x, y >= 0, Eq. (7.1.2).

    It is arccosh of the major half-axis (|z + 1| + |z - 1|)/2 of the ellipse through z with foci
    +-1, written without cancellation; so it grows with x and with y.
    """
    plus, minus = x + 1.0, np.abs(1.0 - x)
    far, near = np.hypot(plus, y), np.hypot(minus, y)
    rest = near + minus
    lift = y * (y / (far + plus) + np.divide(y, rest, out=np.zeros_like(y), where=rest > 0.0))
    above = 0.5 * (lift + (plus + minus - 2.0))
    # above 1e150 its square would overflow, and the root is above + 1
    small = np.minimum(above, 1e150)
    wide = np.log(2.0) + np.log(np.maximum(above, 1.0))
    return np.where(above < 1e150, np.log1p(small + np.sqrt(small * (small + 2.0))), wide)
