"""A matrix divided by another, each element to an ulp, with what is not known of it."""

import math

import numpy as np

from hill.arrays import EPS, Float

# Splits a float into two halves whose products are exact (Veltkamp).
SPLITTER = 2.0**27 + 1.0

STEPS = 2
"""Of refinement: the first brings the quotient to an ulp, the second says so."""


def divided(M: Float, X: Float) -> tuple[Float, Float]:
    """M^-1 X and a bound on the error of each element, to first order.

    The residual X - M Q is summed without error, so that what a refinement adds says how far off
    the quotient was; twice the last one is what may be left.

    Parameters
    ----------
    M : (n, n) ndarray
        Not singular.
    X : (n, n) ndarray
    """
    if np.array_equal(M, np.eye(len(M))):
        return X, np.zeros_like(X)
    inverse = np.linalg.inv(M)
    Q = inverse @ X
    for _ in range(STEPS):
        correction = inverse @ _residual(M, Q, X)
        Q = Q + correction
    left = np.max(np.abs(correction), axis=0) * (np.count_nonzero(Q, axis=0) > 0)
    return Q, EPS * np.abs(Q) + 2.0 * left


def _residual(M: Float, Q: Float, X: Float) -> Float:
    """X - M Q, each element rounded once."""
    product, rest = _exact_products(M[:, None, :], Q.T[None, :, :])
    terms = np.concatenate([X[..., None], -product, -rest], axis=2)
    sums = [math.fsum(row) for row in terms.reshape(-1, terms.shape[2]).tolist()]
    return np.array(sums).reshape(X.shape)


def _exact_products(a: Float, b: Float) -> tuple[Float, Float]:
    """Rounded products and what the rounding took (Dekker)."""
    product = a * b
    (a1, a2), (b1, b2) = _split(a), _split(b)
    return product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2


def _split(a: Float) -> tuple[Float, Float]:
    scaled = SPLITTER * a
    upper = scaled - (scaled - a)
    return upper, a - upper
