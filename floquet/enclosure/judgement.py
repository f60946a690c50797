"""Roots of a polynomial in balls, T and what it means."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import Any, Literal

from flint import acb, acb_poly, arb, ctx, fmpz, fmpz_poly

from floquet.enclosure.balls import number

BITS = 1024
"""For all that follows from P."""

Truth = Literal["stable", "unstable", "boundary", "unknown"]


@dataclass(frozen=True, eq=False)
class Growth:
    """T as a ball, and what it means.

    Attributes
    ----------
    T : arb
        The characteristic argument.
    truth : {"stable", "unstable", "boundary", "unknown"}
        "stable": T < 0, or undamped and all z real, simple and within (-1, 1). "unstable": T > 0.
        "boundary": T is 0 to all digits there are. "unknown": the ball is not narrow.
    """

    T: Any
    truth: Truth


@dataclass(frozen=True, eq=False)
class Roots:
    """Balls about the roots.

    Attributes
    ----------
    balls : list of acb
    simple : bool
        Whether they are apart, each with one root.
    """

    balls: list[Any]
    simple: bool


def roots(truth: Sequence[Any]) -> list[complex]:
    """Roots z with their multiplicity, of the midpoints, which are exact dyadic numbers."""
    return [complex(z) for z in _midpoint_roots(truth)]


def judged(truth: Sequence[Any], Omega: Any, eta: Any) -> Growth:
    """T and the verdict from P; `eta` is None where P is the polynomial of the multipliers.

    Omega and eta are floats or fractions.
    """
    with ctx.workprec(BITS):
        found = enclosed(truth)
        scale = number(Omega) / arb.pi()
        if eta is None:
            largest = reduce(lambda a, b: a.max(b), (abs(z) for z in found.balls))
            T = scale * largest.log() if largest.lower() > 0 else arb.nan()
            return Growth(T, _sign(T))
        real = [found.simple and is_real(z, found.balls) for z in found.balls]
        inside = [r and bool(abs(z.real) < 1) for z, r in zip(found.balls, real, strict=True)]
        logs = [log_R(z, r) for z, r in zip(found.balls, real, strict=True)]
        T = scale * reduce(lambda a, b: a.max(b), logs) - number(eta)
        if eta == 0 and all(inside):
            return Growth(T, "stable")
        return Growth(T, _sign(T))


def _sign(T: Any) -> Truth:
    if not T.is_finite() or float(T.rad()) > 1e-25:
        return "unstable" if T > 0 else "stable" if T < 0 else "unknown"
    return "unstable" if T > 0 else "stable" if T < 0 else "boundary"


def is_real(z: Any, balls: Sequence[Any]) -> bool:
    """Whether the one root of a ball apart from the others is real, as P is.

    Its conjugate is a root, and where no other ball can hold that it is the same.
    """
    if not z.imag.contains(0):
        return False
    return not any(z.conjugate().overlaps(w) for w in balls if w is not z)


def log_R(z: Any, real: bool) -> Any:
    """Ln max |z +- (z^2 - 1)^(1/2)|, from the ellipse through z with foci +-1."""
    if real and abs(z.real) < 1:
        return arb(0)
    above = abs(z.real) - 1 if real else (abs(z - 1) + abs(z + 1)) / 2 - 1
    above = above.nonnegative_part()
    return (above + (above * (above + 2)).nonnegative_part().sqrt()).log1p()


def enclosed(truth: Sequence[Any]) -> Roots:
    """A ball about each root, and whether they are apart, each with one root.

    Within n |p/p'| of any point there is a root. Where such discs overlap, each ball about a root
    of the midpoints still holds a true root, and all true roots are in some ball: a true root has
    prod |zeta - z_j| <= what the radii can amount to, so it is within the n-th root of that of some
    z_j; and a set of such discs that hangs together, no more than n of them across, holds as many
    true roots as discs.
    """
    p = acb_poly(list(reversed(truth)))
    slope, n = p.derivative(), len(truth) - 1
    found = [acb(z.real.mid(), z.imag.mid()) for z in _midpoint_roots(truth)]
    if all(abs(slope(z)) > 0 for z in found):
        balls = [_about(z, n * abs(p(z) / slope(z)).upper()) for z in found]
        if not any(a.overlaps(b) for i, a in enumerate(balls) for b in balls[:i]):
            return Roots(balls, True)
    bound = 2 * (1 + reduce(lambda a, b: a.max(b), (abs(x).upper() for x in truth)))
    off = [(arb(t.rad()) + abs(t) * arb(2) ** -ctx.prec) * bound**k
           for k, t in enumerate(reversed(truth))]  # fmt: skip
    return Roots([_about(z, 2 * n * reduce(add, off).root(n).upper()) for z in found], False)


def _about(z: Any, radius: Any) -> Any:
    ball = arb(0, radius)
    return z + acb(ball, ball)


def _midpoint_roots(truth: Sequence[Any]) -> list[Any]:
    with ctx.workprec(BITS):
        parts = [t.mid().man_exp() for t in truth]
        shift = min(int(e) for m, e in parts if m)
        whole = [fmpz(m) * fmpz(2) ** (int(e) - shift) if m else fmpz(0) for m, e in parts]
        found = fmpz_poly(whole[::-1]).complex_roots()
        return [z for z, multiplicity in found for _ in range(multiplicity)]
