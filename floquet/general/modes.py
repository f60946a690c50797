"""Multipliers of a product of factors that is never multiplied out: small ones are not lost.

The factors of one period are known each to a small part of its smallest singular value, which their
product is not: one period of x'' + 24 x' takes exp(-150) of the velocity. The product of the
factors from the right, turned by a QR decomposition after each, settles on spaces that grow alike
(Bojanczyk, Golub and Van Dooren's periodic QR, without shifts); so does that of the transposed from
the left, and where both meet is a basis in which every factor is nearly diagonal.
"""

from itertools import pairwise

import numpy as np

from floquet.arrays import EPS, Complex, Float
from floquet.general.mode_bounds import by_rows, nearly_diagonal, one_by_one
from floquet.growth import TINY, LogDiscs
from floquet.products import grouped

# Factors are multiplied together while the singular values of what they make are no further apart:
# it is what rounding is magnified by. With 16 bounds are as good, and there is more to do.
MAX_CONDITION = 300.0

# A group whose multipliers are no further apart is treated as one matrix.
MAX_SPREAD = 1e4

# A space is settled when a period more turns it by less.
SETTLED = 1e-14

MAX_SWEEPS = 200
"""Spaces whose multipliers are 1.2 apart are settled by then."""


def condition(matrix: Float) -> float:
    """Ratio of the singular values; infinite where there is none."""
    values = np.linalg.svd(matrix, compute_uv=False)
    return float(values[0] / values[-1]) if values[-1] > 0.0 else float("inf")


def merged(factors: Float, errors: Float) -> tuple[Float, Float]:
    """Fewer factors, of a condition of at most `MAX_CONDITION` where they were."""
    while len(factors) > 1:
        joined, apart = grouped(2, factors, errors)
        if max(map(condition, joined)) > MAX_CONDITION:
            break
        m = factors.shape[-1]
        size = grouped(2, np.abs(factors))[0]
        factors, errors = joined, apart + m * EPS * size
    return factors, errors


def periodic_discs(factors: Float, errors: Float) -> tuple[LogDiscs, ...]:
    """Sets of discs, each of which holds the eigenvalues of P_p ... P_1; perhaps none.

    Parameters
    ----------
    factors, errors : (p, m, m) ndarray
        Each within its error.
    """
    modes = nearly_diagonal(factors, errors, *modal_bases(factors))
    if modes is None:
        return ()
    alone = one_by_one(modes)
    return by_rows(modes) if alone is None else (alone, *by_rows(modes))


def modal_bases(factors: Float) -> tuple[Complex, Complex]:
    """X_k with P_k X_(k-1) = X_k D_k nearly, (p, m, m) from k = 1, and ln of the D's product."""
    m = factors.shape[-1]
    right, cuts = _settled(factors)
    left, also = _settled(factors[::-1].transpose(0, 2, 1))
    # of the transposed, what comes after factor k: left[j] after factors p .. p - j
    left = np.roll(left[::-1], -1, axis=0)
    edges = [0, *sorted(set(cuts) & set(also)), m]
    # within a group only a period's product can tell
    columns, logs = [], []
    for a, b in pairwise(edges):
        part, log = _group(factors, right, left, a, b)
        columns.append(part)
        logs.append(log)
    return np.concatenate(columns, axis=2), np.concatenate(logs)


def _settled(factors: Float) -> tuple[Float, list[int]]:
    """Orthonormal columns after each factor, and where spaces of different growth part."""
    p, m = factors.shape[:2]
    start = np.linalg.qr(np.random.default_rng(0).standard_normal((m, m)))[0]
    Q = np.empty((p, m, m))
    for _ in range(MAX_SWEEPS):
        last, growth = start, np.zeros(m)
        for k in range(p):
            last, R = np.linalg.qr(factors[k] @ last)
            growth += np.log(np.maximum(np.abs(np.diag(R)), TINY))
            Q[k] = last
        turned = np.abs(start.T @ last)
        cuts = [i for i in range(1, m) if np.max(turned[i:, :i]) < SETTLED * m]
        edges = [0, *cuts, m]
        spread = max(float(np.ptp(growth[a:b])) for a, b in pairwise(edges))
        start = last
        if not spread > np.log(MAX_SPREAD):
            break
    return Q, cuts


def _group(factors: Float, right: Float, left: Float, a: int, b: int) -> tuple[Complex, Complex]:
    """Columns a to b of the basis, and the logarithms of their multipliers."""
    p, m = factors.shape[:2]
    # in the span of what grows as fast, orthogonal to the left of what grows faster
    X, V = right[:, :, a:b], left[:, :, :a].transpose(0, 2, 1)
    if a:
        X = X - right[:, :, :a] @ np.linalg.solve(V @ right[:, :, :a], V @ X)
    # least squares; X' X is 1 and more
    across = X.transpose(0, 2, 1)
    step = np.linalg.solve(across @ X, across @ factors @ np.roll(X, 1, axis=0))
    whole, scale = np.eye(b - a), 0.0
    for k in range(p):
        step[k] = np.linalg.lstsq(X[k], factors[k] @ X[k - 1], rcond=None)[0]
        whole = step[k] @ whole
        size = float(np.max(np.abs(whole))) or 1.0
        whole, scale = whole / size, scale + np.log(size)
    values, vectors = np.linalg.eig(whole)
    with np.errstate(divide="ignore"):
        logs = np.log(values.astype(complex)) + scale
    d = np.exp(logs / p)
    found = np.empty((p, m, b - a), complex)
    for k in range(p):
        vectors = step[k] @ vectors / np.where(d == 0.0, 1.0, d)
        found[k] = X[k] @ vectors
    return found, logs
