"""Characteristic polynomials of many small matrices, and how rounding in those moves them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.floating[Any]]

BY_MINORS = 3
"""Up to this size the minors are written out; `floquet/march.c` has the same."""


def characteristic_polynomials(A: Float, scale: Float) -> tuple[Float, Float]:
    """As `floquet.monodromy.characteristic_polynomial`, for many matrices (k, n, n).

    Returns
    -------
    (k, n + 1) ndarray
        Monic, highest power first.
    (k,) ndarray
        How far a coefficient moves, at most, for a unit of relative change of `scale`.
    """
    k, n = A.shape[:2]
    P = _minors(A) if n <= BY_MINORS else _from_eigenvalues(A)
    B, largest = np.broadcast_to(np.eye(n), A.shape), np.zeros(k)
    for j in range(n):
        moved = np.einsum("kij,kji->k", np.abs(B), scale)
        largest = np.maximum(largest, moved)
        if j + 1 < n:
            B = A @ B + P[:, j + 1, None, None] * np.eye(n)
    return P, largest


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
