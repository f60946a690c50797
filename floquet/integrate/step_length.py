"""How long a Taylor step may be, from Cauchy's estimate of what it leaves out."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np

from floquet.arrays import Float, frozen

Term = tuple[Float, float]
"""A matrix and the frequency of the cosine that multiplies it (0 for the constant stiffness)."""

MAX_STEPS = 1_000_000
"""In one period: 35 s for three coordinates, and an answer takes two or three such runs."""

RADII = frozen(np.geomspace(0.3, 40.0, 48))
"""Circles tried, in units of one over the fastest rate; the best lies near order + 1 of them."""

RADII_ORDER = 25.0
"""The order + 1 that they are for; for others they are longer or shorter by as much."""

# exp of it is still a float, and so is its product with what it bounds.
MAX_EXPONENT = 600.0


# Of the circles every so many are tried, then all about the best: log(h/R) is concave in log R
# (Kingman: the Perron root of elements that are log-convex is so too), so no other is better.
STRIDE = 7


def perron_root(matrices: Float) -> Float:
    """Largest eigenvalue of matrices without negative elements, in whatever units."""
    if not np.any(matrices):
        return np.zeros(matrices.shape[:-2])
    return np.asarray(np.max(np.abs(np.linalg.eigvals(matrices)), axis=-1))


def fastest_rate(terms: Sequence[Term], damping: Float | Sequence[Term]) -> float:
    """A bound on how fast anything in the equation oscillates or grows."""
    drag = _as_terms(damping)
    forcing = max(frequency for _, frequency in (*terms, *drag))
    return float(np.sqrt(perron_root(_together(terms))) + perron_root(_together(drag)) + forcing)


def longest_step(
    terms: Sequence[Term], damping: Float | Sequence[Term], order: int, tolerance: float
) -> float:
    """Longest h with which a Taylor step of this order leaves out less than `tolerance`.

    On the circle |t| = R about the step's start a cosine is at most cosh(frequency R), so the
    solution grows at most by exp(R rho(R)), rho the Perron root of the damping there and the square
    root of that of the stiffness. Cauchy: the terms beyond the order sum to less than
    exp(R rho) (h/R)^(order + 1)/(1 - h/R). Any R will do; the one that allows the longest step is
    taken. Infinite where nothing moves.

    Parameters
    ----------
    terms : sequence of Term
        Stiffness.
    damping : (n, n) ndarray or sequence of Term
        Constant, or pulsating; of an equation of first order its whole matrix, with no stiffness.
    order : int
    tolerance : float
        Over the solution's size.
    """
    rate = fastest_rate(terms, damping)
    if rate == 0.0:
        return float("inf")
    circles, drag = RADII * (order + 1) / RADII_ORDER / rate, _as_terms(damping)
    constant = all(frequency == 0.0 for _, frequency in drag)
    always = perron_root(_together(drag)) if constant else None

    def steps(R: Float) -> Float:
        dragged = perron_root(_swollen(drag, R)) if always is None else always
        growth = R * (np.sqrt(perron_root(_swollen(terms, R))) + dragged)
        # 1 - h/R exceeds 1/2 wherever the bound is of any use
        share = np.exp((np.log(0.5 * tolerance) - np.minimum(growth, MAX_EXPONENT)) / (order + 1))
        return np.asarray(R * np.minimum(share, 0.5))

    near = STRIDE // 2 + STRIDE * int(np.argmax(steps(circles[STRIDE // 2 :: STRIDE])))
    return float(np.max(steps(circles[max(near - STRIDE + 1, 0) : near + STRIDE])))


def _as_terms(damping: Float | Sequence[Term]) -> Sequence[Term]:
    return [(damping, 0.0)] if isinstance(damping, np.ndarray) else damping


def _together(terms: Sequence[Term]) -> Float:
    return sum((np.abs(matrix) for matrix, _ in terms), np.zeros_like(terms[0][0]))


def _swollen(terms: Sequence[Term], R: Float) -> Float:
    """The sum of moduli on circles of radius R in complex time."""
    total = np.zeros((len(R), *terms[0][0].shape))
    for matrix, frequency in terms:
        swell = np.cosh(np.minimum(frequency * R, MAX_EXPONENT / 2))
        total += swell[:, None, None] * np.abs(matrix)
    return total


@dataclass(frozen=True)
class TaylorSteps:
    """Taylor steps of fixed order.

    Parameters
    ----------
    order : int
        Highest power of the step kept.
    tolerance : float
        What a step may leave out, of the solution's size; the default is below an ulp.
    """

    order: int = 24
    tolerance: float = 1e-17

    def count(
        self, terms: Sequence[Term], damping: Float | Sequence[Term], time: float, Omega: float
    ) -> int:
        """How many `time` takes.

        Raises
        ------
        ValueError
            More than `MAX_STEPS`.
        """
        needed = time / longest_step(terms, damping, self.order, self.tolerance)
        if not needed <= MAX_STEPS:
            raise ValueError(
                f"Omega = {Omega:g}: too small, one period needs {needed:.3g} Taylor steps "
                f"(at most {MAX_STEPS:,})"
            )
        return max(ceil(needed), 1)
