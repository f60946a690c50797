"""The arbiter: P(z) and T of a Hill equation in ball arithmetic, as narrow as one asks.

In s = sin^2(Omega tau/2) the undamped equation has polynomial coefficients: its solutions even and
odd in tau are power series in s whose coefficients follow from the few before, about s = 0 and, for
the middle of the period, about s = 1. They meet at s = 1/2, where both fall off like 2**-k; what is
left out is bounded. A damping matrix spoils this, and Taylor steps go over the whole period; what
their truncation adds is seen by taking twice as many, not proven, and is part of the ball.

Every number is a ball from the floats' exact values on, so nothing has to be believed but the
radius at the end; where that is wide, all is done again with twice the bits. No code of the two
routes is used: `equation` is read as data.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from math import ceil, comb, factorial, log2
from operator import add
from typing import Any, Literal

import numpy as np
from flint import acb, acb_poly, arb, arb_mat, ctx, fmpz, fmpz_poly

BITS = 256
"""To start with; `reference` doubles them until P's balls are `NARROW`."""

MOST_BITS = 1 << 13

# Of P's balls, over the largest coefficient: 2**-140, or 7e-43.
NARROW = 140

# A system that takes more terms than this is none that a float can hold.
MOST_TERMS = 20000

# A Taylor step of REACH over the fastest rate leaves reach**(order + 1) / (order + 1)!, which the
# order makes less than half the bits can tell. The forcing counts more than once: for imaginary
# time its cosine grows exponentially, and the series of the solution falls off later than that of
# an exponential.
REACH = 4.0

Truth = Literal["stable", "unstable", "boundary", "unknown"]


class TooWide(ValueError):
    """More bits or terms than the arbiter is ready to spend."""


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


def exact(matrix: Any) -> Any:
    """Floats as balls of radius zero."""
    rows = np.atleast_2d(np.asarray(matrix, float))
    return arb_mat(*rows.shape, [arb(float(x)) for x in rows.ravel()])


def identity(n: int) -> Any:
    """The unit matrix."""
    return exact(np.eye(n))


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
    bits = max(BITS, 2 * narrow) * refine
    while bits <= MOST_BITS:
        with ctx.workprec(bits):
            try:
                p = _polynomial(equation, refine)
                if np.ndim(equation.eta) > 0 and _finite(p):
                    # each of twice the steps leaves 2**-order of what one left
                    again = _polynomial(equation, 2 * refine)
                    p = [b + arb(0, abs(a - b).upper()) for a, b in zip(p, again, strict=True)]
            except ZeroDivisionError:  # a ball that holds a singular matrix
                p = [arb.nan()]
            widest = max((x.rad() for x in p), key=float) if _finite(p) else arb.pos_inf()
            size = reduce(lambda a, b: a.max(b), (abs(x.mid()) for x in p)) if _finite(p) else 1
            if widest < size * arb(2) ** -narrow:
                return p
        bits *= 2
    raise TooWide(f"P is not known to {narrow} bits with {MOST_BITS} in the work")


def largest_error(polynomial: Sequence[float], truth: Sequence[Any]) -> float:
    """Upper bound on max |p_k - true p_k|."""
    return max(errors(polynomial, truth))


def errors(polynomial: Sequence[float], truth: Sequence[Any]) -> list[float]:
    """Upper bounds on |p_k - true p_k|."""
    assert len(polynomial) == len(truth)
    with ctx.workprec(4 * BITS):
        pairs = zip(polynomial, truth, strict=True)
        return [float((arb(float(p)) - t).abs_upper()) for p, t in pairs]


def roots(truth: Sequence[Any]) -> list[complex]:
    """Roots z with their multiplicity, of the midpoints, which are exact dyadic numbers."""
    return [complex(z) for z in _midpoint_roots(truth)]


def growth(truth: Sequence[Any], Omega: float, eta: float) -> float:
    """T = (Omega/pi) ln max |z +- (z^2 - 1)^(1/2)| - eta."""
    return float(judged(truth, Omega, eta).T)


def judged(truth: Sequence[Any], Omega: float, eta: float | None) -> Growth:
    """T and the verdict from P; `eta` is None where P is the polynomial of the multipliers."""
    with ctx.workprec(4 * BITS):
        found, simple = _enclosures(truth)
        scale = arb(Omega) / arb.pi()
        if eta is None:
            largest = reduce(lambda a, b: a.max(b), (abs(z) for z in found))
            T = scale * largest.log() if largest.lower() > 0 else arb.nan()
            return Growth(T, _sign(T))
        real = [simple and bool(z.imag.contains(0)) for z in found]
        inside = [r and bool(abs(z.real) < 1) for z, r in zip(found, real, strict=True)]
        logs = [_log_R(z, r) for z, r in zip(found, real, strict=True)]
        T = scale * reduce(lambda a, b: a.max(b), logs) - arb(float(eta))
        if eta == 0 and all(inside):
            return Growth(T, "stable")
        return Growth(T, _sign(T))


def _sign(T: Any) -> Truth:
    if not T.is_finite() or float(T.rad()) > 1e-25:
        return "unstable" if T > 0 else "stable" if T < 0 else "unknown"
    return "unstable" if T > 0 else "stable" if T < 0 else "boundary"


def _log_R(z: Any, real: bool) -> Any:
    """Ln max |z +- (z^2 - 1)^(1/2)|, from the ellipse through z with foci +-1."""
    if real and abs(z.real) < 1:
        return arb(0)
    above = abs(z.real) - 1 if real else (abs(z - 1) + abs(z + 1)) / 2 - 1
    above = above.nonnegative_part()
    return (above + (above * (above + 2)).nonnegative_part().sqrt()).log1p()


def _enclosures(truth: Sequence[Any]) -> tuple[list[Any], bool]:
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
            return balls, True
    bound = 2 * (1 + reduce(lambda a, b: a.max(b), (abs(x).upper() for x in truth)))
    off = [(arb(t.rad()) + abs(t) * arb(2) ** -ctx.prec) * bound**k
           for k, t in enumerate(reversed(truth))]  # fmt: skip
    return [_about(z, 2 * n * reduce(add, off).root(n).upper()) for z in found], False


def _about(z: Any, radius: Any) -> Any:
    ball = arb(0, radius)
    return z + acb(ball, ball)


def _midpoint_roots(truth: Sequence[Any]) -> list[Any]:
    with ctx.workprec(4 * BITS):
        parts = [t.mid().man_exp() for t in truth]
        shift = min(int(e) for m, e in parts if m)
        whole = [fmpz(m) * fmpz(2) ** (int(e) - shift) if m else fmpz(0) for m, e in parts]
        found = fmpz_poly(whole[::-1]).complex_roots()
        return [z for z, multiplicity in found for _ in range(multiplicity)]


def _finite(numbers: Iterable[Any]) -> bool:
    return all(x.is_finite() for x in numbers)


def _polynomial(equation: Any, refine: int) -> list[Any]:
    return list(reversed(_square(equation, refine).charpoly().coeffs()))


def _square(equation: Any, refine: int) -> Any:
    """The matrix whose characteristic polynomial is asked for."""
    n = len(equation.F)
    if np.ndim(equation.eta) > 0:
        return monodromy_by_steps(equation, refine)
    near, far = (_quarter(*_stiffness(equation, end), n) for end in (1, -1))
    S = exact(np.diag(np.repeat([1.0, -1.0], n)))
    # from 0 and from pi/Omega to the quarter period; the second half is the first run backwards
    Phi = S * near.solve(S * far * S * far.solve(S * near))
    return arb_mat([row[:n] for row in Phi.tolist()[:n]])


def monodromy_by_steps(equation: Any, refine: int = 1) -> Any:
    """Phi of (q, q') over the whole period, by Taylor steps that know of no symmetry."""
    n = len(equation.F)
    eta = equation.eta
    C = exact(eta) if np.ndim(eta) > 0 else identity(n) * arb(float(eta))
    start = identity(2 * n).tolist()
    Q, V = _integrate(equation, C, arb_mat(start[:n]), arb_mat(start[n:]), refine)
    return arb_mat(Q.tolist() + V.tolist())


def _terms(equation: Any) -> list[tuple[int, Any]]:
    """Each (p, M) of M cos(p Omega tau)."""
    terms = [(1, exact(equation.G) * arb(float(equation.gamma)))]
    for s, H in enumerate(equation.H, start=1):
        terms.append((s * round(equation.omega_L / equation.Omega), exact(H)))
    return terms


def _stiffness(equation: Any, end: int) -> tuple[list[Any], list[float]]:
    """Coefficients W_j of s**j of the stiffness over Omega^2, and their norms.

    `end` is -1 for s counted from the middle of the period, where cos p Omega tau has (-1)**p.
    """
    n, per = len(equation.F), 1 / arb(float(equation.Omega)) ** 2
    eta = arb(float(equation.eta))
    W = [(exact(equation.F) - identity(n) * (eta * eta / 4)) * per]
    for p, M in _terms(equation):
        # cos p x = T_p(1 - 2 s) = sum_j (-4)^j p/(p + j) C(p + j, 2 j) s^j
        for j in range(p + 1):
            number = (-4) ** j * p * comb(p + j, 2 * j) // (p + j)
            part = M * (per * number * end**p)
            if j < len(W):
                W[j] = W[j] + part
            else:
                W.append(part)
    return W, [_norm(M) for M in W]


def _norm(matrix: Any) -> float:
    """Upper bound on the largest row sum."""
    return 1.0001 * max(sum(float(x.abs_upper()) for x in row) for row in matrix.tolist())


def _quarter(W: list[Any], norms: list[float], n: int) -> Any:
    """(u, du/dx) at x = Omega tau = pi/2 from unit (u, du/dx) at x = 0."""
    even, d_even = _series(W, norms, n, 0)
    odd, d_odd = _series(W, norms, n, 1)
    # odd ones begin with 2 s^(1/2), or x; ds/dx is 1/2 at s = 1/2
    root = arb(2).sqrt()
    odd, d_odd = odd * root, d_odd * root
    rows = [a + b for a, b in zip(even.tolist(), odd.tolist(), strict=True)]
    rows += [a + b for a, b in zip(d_even.tolist(), d_odd.tolist(), strict=True)]
    return arb_mat(rows)


def _series(W: list[Any], norms: list[float], n: int, odd: int) -> tuple[Any, Any]:
    """Sum t_k and sum (k + nu) t_k, t_k = a_k 2**-k, nu = odd/2.

    (k + nu + 1)(k + nu + 1/2) a_(k+1) = (k + nu)^2 a_k - sum_j W_j a_(k-j).
    """
    # where k^2 is above, a term is at most 3/4 of the largest of the few before
    least = 2.0 * sum(norm * 0.5**j for j, norm in enumerate(norms))
    depth = len(W)
    # t_(k+1) = 2 ((2k + odd)^2 t_k - sum_j 4 W_j 2^-j t_(k-j)) / ((2k + 2 + odd)(2k + 1 + odd)) / 2
    scaled = [M * (arb(4) * arb(2) ** -j) for j, M in enumerate(W)]
    last = [identity(n)]
    total, slope = identity(n), identity(n) * (arb(odd) / 2)
    k = 0
    while True:
        step = last[0] * (2 * k + odd) ** 2
        for M, t in zip(scaled, last, strict=False):
            step = step - M * t
        k += 1
        step = step / (2 * (2 * k + odd) * (2 * k - 1 + odd))
        last = [step, *last[: depth - 1]]
        total = total + step
        slope = slope + step * (arb(2 * k + odd) / 2)
        if k % 16 == 0 and k > 2 * depth and k * k > least:
            m = max(map(_norm, last))
            # sum over k beyond of (k + 1/2) t_k, in blocks of `depth`, each 3/4 of the one before
            tail = 8.0 * depth * (k + 4 * depth + 2) * m
            if tail < 2.0 ** -min(ctx.prec, 1000) or not np.isfinite(m):
                break
        if k > MOST_TERMS:
            raise TooWide(f"the series takes more than {MOST_TERMS} terms")
    ball = arb(0, tail)
    unsure = arb_mat(n, n, [ball] * (n * n))
    return total + unsure, slope + unsure


def _integrate(equation: Any, C: Any, Q: Any, V: Any, refine: int) -> tuple[Any, Any]:
    """(q, q') after one period of q'' + C q' + F q + sum M_p cos(p Omega t) q = 0."""
    Omega, F, terms = arb(float(equation.Omega)), exact(equation.F), _terms(equation)
    moduli = np.abs(equation.F) + abs(equation.gamma) * np.abs(equation.G)
    moduli = moduli + sum(np.abs(H) for H in equation.H)
    fastest = np.sqrt(np.abs(np.linalg.eigvals(moduli)).max())
    rate = fastest + (2 + 1.5 * terms[-1][0]) * equation.Omega + np.max(np.abs(equation.eta))
    steps = refine * ceil(2 * np.pi * float(rate) / equation.Omega / REACH)
    if steps > MOST_TERMS:
        raise TooWide(f"takes {steps} Taylor steps")

    order = _order()
    h = 2 * arb.pi() / (Omega * steps)
    stiffness, pulses = F * (h * h), [(p, M * (h * h)) for p, M in terms]
    for k in range(steps):
        cosines = [(M, _cosine(p * Omega * h, k, order)) for p, M in pulses]
        a = [Q, V * h]
        for j in range(order - 1):
            total = stiffness * a[j]
            for M, c in cosines:
                total = total + M * _sum(a[j - i] * c[i] for i in range(j + 1))
            total = total + C * a[j + 1] * (h * (j + 1))
            a.append(total * arb(-1) / ((j + 1) * (j + 2)))
        Q, V = _sum(a), _sum(a[j] * j for j in range(1, order + 1)) / h
    return Q, V


def _order() -> int:
    """The least with REACH**(order + 1) / (order + 1)! below 2**(-bits/2 - 16): 61 at 280 bits."""
    order, log = 0, 0.0
    while log > -(ctx.prec / 2 + 16) or order < REACH:
        order += 1
        log += log2(REACH / order)
    return order


def _sum(parts: Iterable[Any]) -> Any:
    return reduce(add, parts)


def _cosine(angle: Any, k: int, order: int) -> list[Any]:
    """Coefficients of cos(angle (k + x)) in powers of x."""
    s, c = (angle * k).sin_cos()
    turn = [c, -s, -c, s]
    return [turn[i % 4] * angle**i / factorial(i) for i in range(order)]
