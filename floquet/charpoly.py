"""Characteristic polynomials of small matrices, and how errors of those move them."""

from math import comb, frexp
from operator import mul

import numpy as np

from floquet.arrays import EPS, Float

MAX_MINORS = 3
"""Up to this size the minors are written out, here and in `floquet/batch/kernel.c`."""


MAX_EXACT = 12
"""Up to this size one matrix is dealt with in whole numbers: 10 ms, n^4 products."""

# The eigenvalues of LAPACK are those of a matrix within a modest multiple of n ulps, of its norm:
# over 180 matrices of 13 to 20 rows, normal or not, P was off by .05 of what this allows at most.
BACKWARD = 4.0
# The sum of the products in a minor is rounded by an ulp a product, three and less.
PRODUCTS = 3.0
# Ulps by which `characteristic_polynomials`' second result is multiplied at least: its two parts
# that are no sensitivity are given over these. (8 sqrt(2 + 2 pi), the slowest motion, no growth.)
LEAST_ULPS = 23.0
PRODUCTS_SHARE = PRODUCTS / LEAST_ULPS


def characteristic_polynomial(A: Float, scale: Float) -> tuple[Float, Float, Float]:
    """Monic det(zI - A), and how far its coefficients move.

    d p_(k+1) = -tr(B_k dA), where sum_k B_k z^(n-1-k) is the adjugate of zI - A. Up to `MAX_EXACT`
    rows p and B are those of the floats A exactly, rounded once: Leverrier and Faddeev's recursion
    in whole numbers. Beyond, p is multiplied out from the eigenvalues.

    Parameters
    ----------
    A, scale : (n, n) ndarray

    Returns
    -------
    p : (n + 1,) ndarray
        Highest power first.
    sensitivity : (n + 1,) ndarray
        How much each moves, at most and to first order, per unit of |dA| <= scale.
    rounding : (n + 1,) ndarray
        How far each is from the polynomial of the floats A.

    Raises
    ------
    OverflowError
        A coefficient is beyond a float.
    """
    n = len(A)
    p, sensitivity, rounding = np.ones(n + 1), np.zeros(n + 1), np.zeros(n + 1)
    if n <= MAX_EXACT:
        whole, bits = _whole_numbers(A)
        rows, c = [[int(i == j) for j in range(n)] for i in range(n)], 1
        for k in range(1, n + 1):
            unit = 1 << bits * (k - 1)
            moved = np.array([[abs(b) / unit for b in row] for row in rows], float)
            sensitivity[k] = np.sum(moved.T * scale)
            columns = list(zip(*rows, strict=True))
            rows = [[sum(map(mul, row, column)) for column in columns] for row in whole]
            c = -sum(rows[i][i] for i in range(n)) // k
            for i in range(n):
                rows[i][i] += c
            p[k] = c / (1 << bits * k)
        rounding[1:] = 0.5 * EPS * np.abs(p[1:])
        return p, sensitivity, rounding
    p = np.real(np.poly(A))
    values = np.linalg.eigvals(A)
    norm, B = float(np.linalg.norm(A)), np.eye(n)
    for k in range(n):
        sensitivity[k + 1] = np.sum(np.abs(B.T) * scale)
        rounding[k + 1] = BACKWARD * n * EPS * norm * np.linalg.norm(B)
        B = A @ B + p[k + 1] * np.eye(n)
    rounding[1:] += 4.0 * n * EPS * np.abs(np.poly(-np.abs(values)))[1:]
    return p, sensitivity, rounding


def beyond_first_order(A: Float, off: float) -> Float:
    """What errors of A move p by beyond the first order, at most: (n + 1,), highest power first.

    p_k moves by C(n, k) sum_i s_(k-i) off^i over i = 1 .. k, s_j the elementary symmetric function
    of the k largest singular values (Ipsen and Rehman, 2008, Theorem 3.5). Where A has several
    small ones the later terms are the larger.

    Parameters
    ----------
    A : (n, n) ndarray
    off : float
        Bound on the 2-norm of the errors.
    """
    n = len(A)
    sigma = np.linalg.svd(A, compute_uv=False)
    moved, s = np.zeros(n + 1), np.zeros(n + 1)
    s[0] = 1.0
    for k in range(1, n + 1):
        s[1 : k + 1] += sigma[k - 1] * s[:k]
        moved[k] = comb(n, k) * sum(float(s[k - i]) * off**i for i in range(2, k + 1))
    return moved


def _whole_numbers(A: Float) -> tuple[list[list[int]], int]:
    """The floats as whole numbers over 2**bits."""
    rows = A.tolist()
    least = min((frexp(x)[1] for row in rows for x in row if x), default=0)
    bits = max(53 - least, 0)
    ratios = [[x.as_integer_ratio() for x in row] for row in rows]
    # every denominator is a power of two, 2**bits at most
    return [[top * ((1 << bits) // bottom) for top, bottom in row] for row in ratios], bits


def characteristic_polynomials(A: Float, scale: Float) -> tuple[Float, Float]:
    """As `characteristic_polynomial`, for many matrices (k, n, n).

    Returns
    -------
    (k, n + 1) ndarray
        Monic, highest power first.
    (k,) ndarray
        How far a coefficient moves, the most of them, where every element of A is off by `scale`
        and none of these errors knows of another: the root of the sum of squares. With it, over
        `LEAST_ULPS`, what the way from A to the coefficients is rounded by.
    """
    k, n = A.shape[:2]
    P = _minors(A) if n <= MAX_MINORS else _from_eigenvalues(A)
    B, largest = np.broadcast_to(np.eye(n), A.shape), np.zeros(k)
    # a minor's rounding is of the size of its products, whatever they cancel
    summed = _products(np.abs(A)) * PRODUCTS_SHARE if n == MAX_MINORS else np.zeros(k)
    normwise = BACKWARD / LEAST_ULPS * n * np.linalg.norm(A, axis=(1, 2))
    # what overflows has no bound, and is not used
    with np.errstate(over="ignore", invalid="ignore"):
        for j in range(n):
            moved = np.linalg.norm(B * scale.transpose(0, 2, 1), axis=(1, 2))
            if n > MAX_MINORS:
                moved = moved + normwise * np.linalg.norm(B, axis=(1, 2))
            largest = np.maximum(largest, moved)
            if j + 1 < n:
                B = A @ B + P[:, j + 1, None, None] * np.eye(n)
    return P, largest + summed


def _products(a: Float) -> Float:
    """The larger of the sums of all products in the minors of order 2 and 3, for |A|."""
    d = np.einsum("kii->ki", a)
    mixed = a * a.transpose(0, 2, 1)
    pairs = [(0, 1, 2), (0, 2, 1), (1, 2, 0)]
    second = sum(d[:, i] * d[:, j] + mixed[:, i, j] for i, j, _ in pairs)
    third = d[:, 0] * d[:, 1] * d[:, 2] + sum(mixed[:, i, j] * d[:, k] for i, j, k in pairs)
    third = third + a[:, 0, 1] * a[:, 1, 2] * a[:, 2, 0] + a[:, 0, 2] * a[:, 2, 1] * a[:, 1, 0]
    return np.asarray(np.maximum(second, third))


def _minors(A: Float) -> Float:
    """Coefficients as sums of principal minors: no cancellation but the polynomial's own."""
    k, n = A.shape[:2]
    a = np.moveaxis(A, 0, -1)
    P = np.ones((k, n + 1))
    P[:, 1] = -sum(a[i, i] for i in range(n))
    pairs = [(i, j) for i in range(n) for j in range(i + 1, n)]
    minor = {(i, j): a[i, i] * a[j, j] - a[i, j] * a[j, i] for i, j in pairs}
    if n > 1:
        P[:, 2] = sum(minor.values())
    if n > 2:
        P[:, 3] = -(
            a[0, 0] * minor[1, 2]
            - a[0, 1] * (a[1, 0] * a[2, 2] - a[1, 2] * a[2, 0])
            + a[0, 2] * (a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0])
        )
    return P


def _from_eigenvalues(A: Float) -> Float:
    k, n = A.shape[:2]
    z = np.linalg.eigvals(A)
    p = np.zeros((k, n + 1), complex)
    p[:, 0] = 1.0
    for j in range(n):
        p[:, 1:] -= z[:, j, None] * p[:, :-1]
    return np.ascontiguousarray(p.real)
