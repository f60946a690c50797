"""z, R and T of many polynomials at once, in closed form up to the third degree."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]

CHUNK = 8192
"""Polynomials at a time: the dozen arrays of the closed form stay in the cache."""

LARGE = 1e50
"""Coefficients beyond which the closed forms, with their third powers, may leave the floats."""


def growth(polynomials: Float) -> Float:
    """Largest ln R of each polynomial, Eq. (7.1.2).

    Parameters
    ----------
    polynomials : (n + 1, k) float ndarray
        Monic coefficients, highest power first, one column a polynomial.

    Returns
    -------
    (k,) float ndarray
        ln R >= 0; T is (Omega/pi) ln R - eta.
    """
    count = polynomials.shape[1]
    result = np.empty(count)
    for start in range(0, count, CHUNK):
        part = slice(start, start + CHUNK)
        result[part] = _within_floats(polynomials[:, part])
    return result


def _within_floats(p: Float) -> Float:
    far = np.any(np.abs(p) > LARGE, axis=0)
    if not np.any(far):
        return _growth(p)
    result = np.empty(p.shape[1])
    result[~far] = _growth(p[:, ~far])
    result[far] = log_R(companion_roots(p[:, far].T)).max(axis=1)
    return result


def _growth(p: Float) -> Float:
    degree = len(p) - 1
    if degree == 1:
        return _real(-p[1])
    if degree == 2:
        return _pair(p[1], p[2])
    if degree == 3:
        result = np.zeros(p.shape[1])
        grows = np.flatnonzero(~all_within(p[1], p[2], p[3]))
        a, b, c = (p[k, grows] for k in (1, 2, 3))
        lone = most_isolated_root(a, b, c)
        result[grows] = np.maximum(_real(lone), _pair(a + lone, b + lone * (a + lone)))
        return result
    return np.asarray(log_R(companion_roots(p.T)).max(axis=1))


def companion_roots(polynomials: Float) -> Complex:
    """All roots of monic polynomials (k, n + 1), (k, n): eigenvalues of companion matrices."""
    n = polynomials.shape[1] - 1
    companion = np.zeros((len(polynomials), n, n))
    companion[:, 0] = -polynomials[:, 1:]
    companion[:, np.arange(1, n), np.arange(n - 1)] = 1.0
    return np.asarray(np.linalg.eigvals(companion), complex)


def lone_and_pair(polynomials: Float) -> tuple[Float, Float, Float] | None:
    """Roots of monic polynomials of the second or third degree, (k, n + 1), in closed form.

    Returns
    -------
    (k,) ndarray, three times, or None
        A real root, nan in the second degree; x and s of the other two, x +- sqrt(s). None of
        another degree.
    """
    p = polynomials.T
    if len(p) == 3:
        lone, b, c = np.full(p.shape[1], np.nan), p[1], p[2]
    elif len(p) == 4:
        lone = most_isolated_root(p[1], p[2], p[3])
        b = p[1] + lone
        c = p[2] + lone * b
    else:
        return None
    x = -0.5 * b
    return lone, x, x * x - c


def real_range(polynomials: Float) -> tuple[Float, Float]:
    """The least and the largest real part of the roots of monic polynomials, (k, n + 1)."""
    closed = lone_and_pair(polynomials)
    if closed is None:
        real = companion_roots(polynomials).real
        return real.min(axis=1), real.max(axis=1)
    lone, x, square = closed
    apart = np.sqrt(np.maximum(square, 0.0))
    return np.fmin(x - apart, lone), np.fmax(x + apart, lone)


def growth_off_axis(polynomials: Float) -> Float:
    """Largest ln R of the roots that are not real, 0 where all are, (k, n + 1) to (k,)."""
    closed = lone_and_pair(polynomials)
    if closed is None:
        z = companion_roots(polynomials)
        return np.asarray(log_R(np.where(z.imag != 0.0, z, 0.0)).max(axis=1))
    _, x, square = closed
    return np.where(square < 0.0, _conjugate(x, np.sqrt(np.maximum(-square, 0.0))), 0.0)


def discriminant(polynomials: Float) -> Float:
    """The product of (z_i - z_j)^2 over pairs of roots of monic polynomials, (k, n + 1)."""
    closed = lone_and_pair(polynomials)
    if closed is None:
        z = companion_roots(polynomials)
        j, k = np.triu_indices(z.shape[1], 1)
        return np.asarray(np.prod((z[:, j] - z[:, k]) ** 2, axis=1).real)
    lone, x, square = closed
    others = 1.0 if polynomials.shape[1] == 3 else ((lone - x) ** 2 - square) ** 2
    return np.asarray(4.0 * square * others)


def log_R(z: Complex) -> Float:
    """Ln |z + (z^2 - 1)^(1/2)|, the larger, Eq. (7.1.2)."""
    return _conjugate(z.real, np.abs(z.imag))


def all_within(a: Float, b: Float, c: Float) -> NDArray[np.bool_]:
    """Whether all roots of z^3 + a z^2 + b z + c are real and within [-1, 1]: R is 1, no growth.

    Real where the discriminant is not negative; none is beyond 1, or below -1, where no derivative
    changes its sign there (Budan and Fourier, exact for real roots).
    """
    # P, P', P''/2 at 1 and at -1
    even, odd = 1.0 + b, a + c
    inside = (np.abs(odd) <= even) & (np.abs(a) <= 3.0)
    inside &= 2.0 * np.abs(a) <= 3.0 + b
    third = a / 3.0
    p = b - a * third
    q = c + third * (2.0 * third * third - b)
    return inside & (4.0 * p * p * p + 27.0 * q * q <= 0.0)


def most_isolated_root(a: Float, b: Float, c: Float) -> Float:
    """The real root of z^3 + a z^2 + b z + c that is farthest from the other two.

    With z = t - a/3 the roots t sum to zero: where all are real, the one of largest modulus lies
    opposite the other two; where two are complex, it is the real one. The rest divides out well.
    """
    third = a / 3.0
    p = b - a * third
    q = c + third * (2.0 * third * third - b)
    half = 0.5 * np.abs(q)
    cube = (p / 3.0) ** 3
    square = half * half + cube
    with np.errstate(invalid="ignore", divide="ignore"):
        radius = np.sqrt(np.maximum(-p / 3.0, 0.0))
        angle = np.arccos(np.clip(half / np.sqrt(np.maximum(-cube, 1e-300)), -1.0, 1.0))
        three = 2.0 * radius * np.cos(angle / 3.0)
        u = np.cbrt(half + np.sqrt(np.maximum(square, 0.0)))
        one = u - p / (3.0 * np.where(u == 0.0, 1.0, u))
    t = -np.copysign(np.where(square > 0.0, one, three), q)
    z = t - third
    for _ in range(2):  # Newton: the closed form loses digits where its terms cancel
        slope = (3.0 * z + 2.0 * a) * z + b
        value = ((z + a) * z + b) * z + c
        z = z - np.divide(value, slope, out=np.zeros_like(z), where=slope != 0.0)
    return z


def _real(z: Float) -> Float:
    """Ln R of a real z: arccosh |z| outside [-1, 1], else 0."""
    above = np.maximum(np.abs(z) - 1.0, 0.0)
    return np.log1p(above + np.sqrt(above * (above + 2.0)))


def _pair(b: Float, c: Float) -> Float:
    """Largest ln R of the two roots of z^2 + b z + c, real or conjugate."""
    x = -0.5 * b
    square = x * x - c
    root = np.sqrt(np.abs(square))
    real = _real(np.abs(x) + root)
    return np.where(square >= 0.0, real, _conjugate(x, root))


def _conjugate(x: Float, y: Float) -> Float:
    """Ln R of x +- i y: ln R is arccosh of the major half-axis of the ellipse through z.

    (|z + 1| + |z - 1|)/2 - 1, written without cancellation.
    """
    size = np.hypot(x, y)
    if np.any(size > LARGE):  # ln 2|z| to the last bit, where a square would leave the floats
        large = size > LARGE
        x, y = np.where(large, 1.0, x), np.where(large, 0.0, y)
        beyond = np.log(2.0) + np.log(np.where(large, size, 1.0))
        return np.where(large, beyond, _conjugate(x, y))
    plus, minus = np.abs(x + 1.0), np.abs(1.0 - x)
    far, near = np.hypot(plus, y), np.hypot(minus, y)
    with np.errstate(invalid="ignore", divide="ignore"):
        lift = np.where(y == 0.0, 0.0, y * y * (1.0 / (far + plus) + 1.0 / (near + minus)))
    above = 0.5 * (lift + (plus + minus - 2.0))
    return np.log1p(above + np.sqrt(above * (above + 2.0)))
