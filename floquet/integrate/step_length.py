"""How long a Taylor step may be, from Cauchy's estimate of what it leaves out."""

from collections.abc import Sequence

import numpy as np

from floquet.arrays import Float

Term = tuple[Float, float]
"""A matrix and the frequency of the cosine that multiplies it (0 for the constant stiffness)."""

RADII = np.geomspace(0.3, 40.0, 48)
"""Circles tried, in units of one over the fastest rate; the best lies near order + 1 of them."""

MAX_EXPONENT = 600.0


def perron_root(matrices: Float) -> Float:
    """Largest eigenvalue of matrices without negative elements, in whatever units."""
    return np.asarray(np.max(np.abs(np.linalg.eigvals(matrices)), axis=-1))


def fastest_rate(terms: Sequence[Term], damping: Float) -> float:
    """A bound on how fast anything in the equation oscillates or grows."""
    stiffness = sum((np.abs(matrix) for matrix, _ in terms), np.zeros_like(damping))
    forcing = max(frequency for _, frequency in terms)
    return float(np.sqrt(perron_root(stiffness)) + perron_root(np.abs(damping)) + forcing)


def longest_step(terms: Sequence[Term], damping: Float, order: int, tolerance: float) -> float:
    """Longest h with which a Taylor step of this order leaves out less than `tolerance`.

    On the circle |t| = R about the step's start a cosine is at most cosh(frequency R), so the
    solution grows at most by exp(R rho(R)), rho^2 the Perron root of the stiffness there. Cauchy:
    the terms beyond the order sum to less than exp(R rho) (h/R)^(order + 1)/(1 - h/R). Any R will
    do; the one that allows the longest step is taken.
    """
    R = RADII * (order + 1) / 25.0 / fastest_rate(terms, damping)
    stiffness = np.zeros((len(R), *damping.shape))
    for matrix, frequency in terms:
        swell = np.cosh(np.minimum(frequency * R, MAX_EXPONENT / 2))
        stiffness += swell[:, None, None] * np.abs(matrix)
    growth = R * (np.sqrt(perron_root(stiffness)) + perron_root(np.abs(damping)))
    # 1 - h/R exceeds 1/2 wherever the bound is of any use
    share = np.exp((np.log(0.5 * tolerance) - np.minimum(growth, MAX_EXPONENT)) / (order + 1))
    return float(np.max(R * np.minimum(share, 0.5)))
