"""The arbiter: P(z) and T of a Hill equation in ball arithmetic, as narrow as one asks.

An undamped equation, or one whose damping is one number, is summed as a power series in
sin^2(Omega tau/2) (`series`); with a damping matrix Taylor steps go over the whole period
(`steps`). Every number is a ball from the floats' exact values on, and what a series leaves out is
bounded and part of the ball, so nothing has to be believed but the radius at the end; where that is
wide, all is done again with twice the bits. No code of the two routes is used: `equation` is read
as data.
"""

from collections.abc import Sequence
from typing import Any

from flint import arb, ctx

from floquet.enclosure import judgement
from floquet.enclosure.balls import exact, identity, problem
from floquet.enclosure.judgement import Growth, judged, roots
from floquet.enclosure.narrow import NARROW, narrowed, square
from floquet.enclosure.series import TooWide

__all__ = [
    "NARROW", "Growth", "TooWide", "errors", "exact", "growth", "identity", "judged",
    "largest_error", "narrowed", "reference", "roots", "square",
]  # fmt: skip


def reference(equation: Any, refine: int = 1, narrow: int = NARROW) -> list[Any]:
    """P(z), monic, highest power first; of the multipliers where eta is a matrix.

    Parameters
    ----------
    equation : HillEquation
    refine : int, optional
        Times the bits and the steps that would do.
    narrow : int, optional
        Bits to which the coefficients are known, of the largest.

    Raises
    ------
    TooWide
        The equation is beyond the arbiter.
    """

    def polynomial() -> list[Any]:
        return list(reversed(square(problem(equation), refine).charpoly().coeffs()))

    return narrowed(polynomial, narrow, refine)


def largest_error(polynomial: Sequence[float], truth: Sequence[Any]) -> float:
    """Upper bound on max |p_k - true p_k|."""
    return max(errors(polynomial, truth))


def errors(polynomial: Sequence[float], truth: Sequence[Any]) -> list[float]:
    """Upper bounds on |p_k - true p_k|."""
    assert len(polynomial) == len(truth)
    with ctx.workprec(judgement.BITS):
        pairs = zip(polynomial, truth, strict=True)
        return [float((arb(float(p)) - t).abs_upper()) for p, t in pairs]


def growth(truth: Sequence[Any], Omega: float, eta: float) -> float:
    """T = (Omega/pi) ln max |z +- (z^2 - 1)^(1/2)| - eta."""
    return float(judged(truth, Omega, eta).T)
