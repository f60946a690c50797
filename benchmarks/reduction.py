"""From fundamental matrices, which is what an integrator gives, to P(z): the peers' last step."""

import numpy as np

from benchmarks.systems import Float

# Faddeev and LeVerrier's recurrence loses digits as n grows; at 4 it is still exact to rounding.
RECURRENCE = 4


def from_whole(Phi: Float, n: int) -> Float:
    """P(z) from n or more columns of monodromy matrices (k, 2n, columns): det(z I - A)."""
    return characteristic_polynomials(Phi[:, :n, :n])


def from_half(U: Float, n: int) -> Float:
    """P(z) from fundamental matrices (k, 2n, 2n) at half a period: Phi = S U^-1 S U."""
    inverse = np.linalg.inv(U)
    return characteristic_polynomials(2.0 * inverse[:, :n, :n] @ U[:, :n, :n] - np.eye(n))


def characteristic_polynomials(A: Float) -> Float:
    """Monic det(z I - A) of many matrices (k, n, n), the cheapest way that is accurate."""
    k, n = A.shape[:2]
    P = np.zeros((k, n + 1))
    P[:, 0] = 1.0
    if n > RECURRENCE:
        product = P.astype(complex)
        for z in np.linalg.eigvals(A).T:
            product[:, 1:] -= z[:, None] * product[:, :-1]
        return product.real
    B = np.broadcast_to(np.eye(n), A.shape)
    for j in range(1, n + 1):
        AB = A @ B
        P[:, j] = -np.trace(AB, axis1=1, axis2=2) / j
        B = AB + P[:, j, None, None] * np.eye(n)
    return P
