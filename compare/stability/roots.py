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
    # most of a chart does not grow: what may is gathered first, so that chunks are full of it
    index = np.flatnonzero(_may_grow(polynomials))
    result = np.zeros(polynomials.shape[1])
    for start in range(0, len(index), CHUNK):
        chosen = index[start : start + CHUNK]
        result[chosen] = _within_floats(polynomials[:, chosen])
    return result


def _may_grow(polynomials: Float) -> NDArray[np.bool_]:
    """False where R is shown to be 1 without its roots."""
    result = np.ones(polynomials.shape[1], bool)
    if len(polynomials) == 4:
        with np.errstate(over="ignore", invalid="ignore"):
            for start in range(0, len(result), CHUNK):
                part = slice(start, start + CHUNK)
                np.logical_not(all_within(*polynomials[1:, part]), out=result[part])
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
    if len(p) == 2:
        return _arccosh(_beyond(p[1]))
    if len(p) == 3:
        return _arccosh(_pair_beyond(p[1], p[2]))
    if len(p) == 4:
        return _cubic_growth(*p[1:])
    return np.asarray(log_R(companion_roots(p.T)).max(axis=1))


def _cubic_growth(a: Float, b: Float, c: Float) -> Float:
    lone = most_isolated_root(a, b, c)
    a = a + lone
    return _arccosh(np.maximum(_beyond(lone), _pair_beyond(a, b + lone * a)))


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
    # P, P', P''/2 at 1 and at -1: |a + c| <= 1 + b, 2 |a| <= 3 + b, |a| <= 3, in four arrays
    even, odd, size = 1.0 + b, a + c, np.abs(a)
    np.abs(odd, out=odd)
    inside = odd <= even
    inside &= size <= 3.0
    size *= 2.0
    np.add(b, 3.0, out=even)
    inside &= size <= even
    p, q = _depressed(a, b, c, a / 3.0, even, odd)
    # 4 p^3 + 27 q^2 <= 0
    np.multiply(p, 4.0, out=size)
    size *= p
    size *= p
    np.multiply(q, 27.0, out=p)
    p *= q
    size += p
    inside &= size <= 0.0
    return inside


def _depressed(
    a: Float, b: Float, c: Float, third: Float, p: Float, q: Float
) -> tuple[Float, Float]:
    """P and q of t^3 + p t + q, z = t - a/3, in the arrays p and q."""
    # b - a third
    np.multiply(a, third, out=p)
    np.subtract(b, p, out=p)
    # c + third (2 third^2 - b)
    np.multiply(third, 2.0, out=q)
    q *= third
    q -= b
    q *= third
    q += c
    return p, q


def most_isolated_root(a: Float, b: Float, c: Float) -> Float:
    """The real root of z^3 + a z^2 + b z + c that is farthest from the other two.

    With z = t - a/3 the roots t sum to zero: where all are real, the one of largest modulus lies
    opposite the other two; where two are complex, it is the real one. The rest divides out well.
    """
    third = a / 3.0
    p, q = _depressed(a, b, c, third, np.empty_like(third), np.empty_like(third))
    half = 0.5 * np.abs(q)
    cube = (p / 3.0) ** 3
    square = half * half + cube
    t = np.empty_like(third)
    one = np.flatnonzero(square > 0.0)
    three = np.flatnonzero(~(square > 0.0))
    t[one] = _one_real(p[one], half[one], square[one])
    t[three] = _three_real(p[three], half[three], cube[three])
    z = -np.copysign(t, q) - third
    for _ in range(2):  # Newton: the closed form loses digits where its terms cancel
        slope = (3.0 * z + 2.0 * a) * z + b
        value = ((z + a) * z + b) * z + c
        z -= np.divide(value, slope, out=np.zeros_like(z), where=slope != 0.0)
    return z


def _one_real(p: Float, half: Float, square: Float) -> Float:
    """|t| of the only real root (Cardano)."""
    u = np.cbrt(half + np.sqrt(square))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(u - p / (3.0 * np.where(u == 0.0, 1.0, u)))


def _three_real(p: Float, half: Float, cube: Float) -> Float:
    """|t| of the largest of three real roots (Viete)."""
    with np.errstate(invalid="ignore", divide="ignore"):
        radius = np.sqrt(np.maximum(-p / 3.0, 0.0))
        angle = np.arccos(np.clip(half / np.sqrt(np.maximum(-cube, 1e-300)), -1.0, 1.0))
    return np.asarray(2.0 * radius * np.cos(angle / 3.0))


def _arccosh(above: Float) -> Float:
    """Arccosh(1 + above), above >= 0: ln R of a half-axis 1 + above."""
    return np.log1p(above + np.sqrt(above * (above + 2.0)))


def _beyond(z: Float) -> Float:
    """By how much |z| of a real z exceeds 1."""
    return np.maximum(np.abs(z) - 1.0, 0.0)


def _pair_beyond(b: Float, c: Float) -> Float:
    """The larger half-axis of the two roots of z^2 + b z + c, real or conjugate, less 1."""
    x = -0.5 * b
    square = x * x - c
    root = np.sqrt(np.abs(square))
    result = _beyond(np.abs(x) + root)
    pair = np.flatnonzero(~(square >= 0.0))
    result[pair] = _conjugate_beyond(x[pair], root[pair])
    return result


def _conjugate(x: Float, y: Float) -> Float:
    """Ln R of x +- i y."""
    size = np.hypot(x, y)
    large = size > LARGE
    if not np.any(large):
        return _arccosh(_conjugate_beyond(x, y))
    # ln 2|z| to the last bit, where a square would leave the floats
    x, y = np.where(large, 1.0, x), np.where(large, 0.0, y)
    beyond = np.log(2.0) + np.log(np.where(large, size, 1.0))
    return np.where(large, beyond, _arccosh(_conjugate_beyond(x, y)))


def _conjugate_beyond(x: Float, y: Float) -> Float:
    """The major half-axis of the ellipse with foci +-1 through x + i y, less 1.

    (|z + 1| + |z - 1|)/2 - 1, written without cancellation.
    """
    plus, minus = np.abs(x + 1.0), np.abs(1.0 - x)
    far, near = np.hypot(plus, y), np.hypot(minus, y)
    with np.errstate(invalid="ignore", divide="ignore"):
        lift = np.where(y == 0.0, 0.0, y * y * (1.0 / (far + plus) + 1.0 / (near + minus)))
    return np.asarray(0.5 * (lift + (plus + minus - 2.0)))
