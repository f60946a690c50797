"""The arbiter: P(z) and T of a Hill equation in ball arithmetic, as narrow as one asks.

An undamped equation, or one whose damping is one number, is summed as a power series in
sin^2(Omega tau/2) (`series`); with a damping matrix Taylor steps go over the whole period
(`steps`). Every number is a ball from the floats' exact values on, and what a series leaves out is
bounded and part of the ball, so nothing has to be believed but the radius at the end; where that is
wide, all is done again with twice the bits. No code of the two routes is used: `equation` is read
as data.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from typing import Any

from flint import arb, ctx

from benchmarks.honesty import enclosures, series, steps
from benchmarks.honesty.balls import Problem, exact, identity, problem
from benchmarks.honesty.enclosures import Growth, judged, roots
from benchmarks.honesty.series import Singular, TooWide

__all__ = [
    "Growth", "TooWide", "errors", "exact", "growth", "identity", "judged", "largest_error",
    "narrowed", "reference", "roots", "square",
]  # fmt: skip

BITS = 256
"""To start with; `narrowed` doubles them until the balls are narrow enough."""

MOST_BITS = 1 << 13

# Of P's balls, over the largest coefficient: 2**-140, or 7e-43.
NARROW = 140


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


def narrowed(compute: Callable[[], list[Any]], narrow: int, refine: int = 1) -> list[Any]:
    """What `compute` returns, with as many bits as make its balls `narrow`, of the largest number.

    Raises
    ------
    TooWide
        `MOST_BITS` do not.
    """
    bits = max(BITS, 2 * narrow) * refine
    while bits <= MOST_BITS:
        with ctx.workprec(bits):
            try:
                found = compute()
            except Singular:
                found = [arb.nan()]
            if _finite(found):
                widest = max((x.rad() for x in found), key=float)
                size = reduce(lambda a, b: a.max(b), (abs(x.mid()) for x in found))
                if widest < size * arb(2) ** -narrow or not size > 0:
                    return found
        bits *= 2
    raise TooWide(f"not known to {narrow} bits with {MOST_BITS} in the work")


def square(given: Problem, refine: int = 1) -> Any:
    """The matrix whose characteristic polynomial is P."""
    return series.first_block(given) if given.D is None else steps.monodromy(given, refine)


def largest_error(polynomial: Sequence[float], truth: Sequence[Any]) -> float:
    """Upper bound on max |p_k - true p_k|."""
    return max(errors(polynomial, truth))


def errors(polynomial: Sequence[float], truth: Sequence[Any]) -> list[float]:
    """Upper bounds on |p_k - true p_k|."""
    assert len(polynomial) == len(truth)
    with ctx.workprec(enclosures.BITS):
        pairs = zip(polynomial, truth, strict=True)
        return [float((arb(float(p)) - t).abs_upper()) for p, t in pairs]


def growth(truth: Sequence[Any], Omega: float, eta: float) -> float:
    """T = (Omega/pi) ln max |z +- (z^2 - 1)^(1/2)| - eta."""
    return float(judged(truth, Omega, eta).T)


def _finite(numbers: Iterable[Any]) -> bool:
    return all(x.is_finite() for x in numbers)
