r"""What lies beyond the harmonics that are folded, as a series with a bounded remainder.

A group of g harmonics about x, g the highest in the coefficients, couples with the next one only,
and eliminated from infinity it is S(x) = D(x) - U S(x + g)^-1 L. Divide its rows by their -(m +
alpha)^2; the determinant of what lies beyond is the product of the det S~ there. With L steps of
the elimination in the place of all,

    h(x) = log det S~_L(x)

is analytic for |x| >= r, where every D within the steps is dominated by its squares, and is at most
C there. So h = sum_j c_j x^-j, |c_j| <= C r^j (Cauchy), and the c_j are found from samples on a
wider circle, but for aliases that the same estimate bounds. c_0 = c_1 = 0. Then

    sum_k h(x + g k) = sum_j c_j g^-j zeta(j, x/g),

and what the terms left out, and the steps left out, amount to is bounded by geometric series.
Everything is in row sums of moduli; the theory is in docs/theory.md, section 12.
"""

from dataclasses import dataclass
from typing import Any

from flint import acb, arb

from hill.enclosure.rows import Rows

# Of the tail's beginning over r, the circle of the samples over r: each term gains two bits.
WIDER = 4

# Steps of the elimination tried, and harmonics: a system that takes more is beyond it.
MAX_STEPS, MAX_HARMONICS = 60, 6000


class TooWide(ValueError):
    """More harmonics or digits than the proof is ready to spend."""


@dataclass(frozen=True, eq=False)
class Tail:
    """The series, and where it holds.

    Attributes
    ----------
    coefficients : tuple of acb
        c_j g^-j with their aliases' balls.
    start : int
        Least real part of x.
    steps : int
        L.
    left_out : arb
        Bound on the sum of what the series' end and the steps left out amount to.
    unsure : arb
        Bound on each element of S(x) - S_L(x).
    """

    coefficients: tuple[Any, ...]
    start: int
    steps: int
    left_out: Any
    unsure: Any


def tail(rows: Rows, bits: int) -> Tail:
    """The series of a system's tail, known to about so many bits.

    Raises
    ------
    TooWide
        It takes more than `MAX_HARMONICS`.
    """
    terms = bits // 2 + 12
    steps = 1
    while True:
        r, C = _disc(rows, steps)
        start = int(WIDER * r)
        unsure, moved = _steps_left_out(rows, start, steps)
        if moved < arb(2) ** -bits:
            break
        steps += 1
        if steps > MAX_STEPS:
            raise TooWide(f"the determinant takes more than {MAX_STEPS} steps beyond its harmonics")
    if start > MAX_HARMONICS:
        raise TooWide(f"the determinant takes more than {MAX_HARMONICS} harmonics")
    share = arb(r) / start
    g = rows.reach
    # sum over k of (start + g k)^-j is at most start^-j (1 + start/(g (j - 1)))
    end = C * share**terms / (1 - share) * (1 + arb(start) / (g * (terms - 1)))
    coefficients = _coefficients(rows, steps, r, start, C, terms)
    return Tail(coefficients, start, steps, (end + moved).upper(), unsure)


def logarithm(given: Tail, reach: int, x: Any) -> Any:
    """Sum over k >= 0 of log det S~(x + reach k), for Re x >= `start`."""
    total, at = acb(0), x / reach
    for j, c in enumerate(given.coefficients):
        if j >= 2:
            total += c * acb(j).zeta(at)
    ball = arb(0, given.left_out)
    return total + acb(ball, ball)


def group(rows: Rows, x: Any) -> list[Any]:
    """The harmonics of the group about x."""
    g = rows.reach
    return [x + arb(2 * i - g + 1) / 2 for i in range(g)]


def eliminated(rows: Rows, x: Any, steps: int) -> Any:
    """S_L(x)."""
    g = rows.reach
    U, L = rows.between(g, 1)
    S = rows.block(group(rows, x + g * steps))
    for k in range(steps - 1, -1, -1):
        S = rows.block(group(rows, x + g * k)) - U * S.inv() * L
    return S


def divided(rows: Rows, S: Any, harmonics: list[Any]) -> Any:
    """Det S with each harmonic's rows over -s^2."""
    det = S.det()
    for s in harmonics:
        det = det / (-s * s) ** rows.n
    return det


def _disc(rows: Rows, steps: int) -> tuple[int, Any]:
    """Radius r beyond which h is analytic, and a bound C < 3 on it there.

    With |log det| < pi the principal logarithm of the determinant is h.
    """
    size, coupling, g = rows.size, rows.coupling, rows.reach
    r = int(float(size.upper()) ** 0.5) + g * (steps + 1) + 2
    while r <= MAX_HARMONICS:
        # the nearest harmonic of the group k steps ahead is (g - 1)/2 nearer than its middle
        squares = [(arb(r) - g * k - arb(g - 1) / 2) ** 2 - size for k in range(steps + 1)]
        if all(q > 0 for q in squares):
            inverse, sound = 1 / squares[steps], True
            for k in range(steps - 1, 0, -1):
                left = squares[k] - coupling**2 * inverse
                sound = sound and bool(left > 0)
                if not sound:
                    break
                inverse = 1 / left
            if sound:
                e = (size + coupling**2 * inverse) / (squares[0] + size)
                if e < 1:
                    C = -(rows.n * g) * (1 - e).log()
                    if C < 3:
                        return r, C.upper()
        r += 1 + r // 16
    raise TooWide(f"the determinant takes more than {MAX_HARMONICS} harmonics")


def _steps_left_out(rows: Rows, start: int, steps: int) -> tuple[Any, Any]:
    """Bounds on the norm of S - S_L at `start` and on the sum of what that moves log det by.

    With d = 1/(x^2 - size) the norm of D^-1 and b that of U and L, S^-1 is at most 2 d where
    2 b^2 d^2 <= 1/2; one more step of the elimination moves S by b^2 d, and each of the others by
    b^2 (2 d)^2 of what it moved the one outside. All of it falls at least like x^-4.
    """
    g = rows.reach
    nearest = arb(start) - arb(g - 1) / 2
    d = 1 / (nearest**2 - rows.size)
    b2 = rows.coupling**2
    share = b2 * (2 * d) ** 2
    if not (d > 0 and share < arb(1) / 2):
        return arb.pos_inf(), arb.pos_inf()
    unsure = b2 * d * share**steps / (1 - share)
    if not 2 * d * unsure < arb(1) / 2:
        return arb.pos_inf(), arb.pos_inf()
    # |log(1 - y)| <= 2 y for y <= 1/2, for each of the n g eigenvalues
    first = rows.n * g * 2 * (2 * d * unsure)
    return unsure.upper(), (first * (1 + nearest / (3 * g))).upper()


def _coefficients(rows: Rows, steps: int, r: int, wide: int, C: Any, terms: int) -> tuple[Any, ...]:
    """c_j g^-j, j < terms, from samples on the circle |x| = wide."""
    # real on the real axis: the lower half circle is the upper one's conjugate
    count = terms + terms % 2
    samples: list[Any] = []
    for k in range(count // 2):
        x = acb(arb(2 * k + 1) / count).exp_pi_i() * wide
        samples.append(divided(rows, eliminated(rows, x, steps), group(rows, x)).log())
    share = arb(r) / wide
    alias = C * share**count / (1 - share**count)
    found = []
    for j in range(terms):
        total = acb(0)
        for k, value in enumerate(samples):
            total += value * acb(arb(j * (2 * k + 1)) / count).exp_pi_i()
        # both halves; c_j is real
        c = total.real * 2 / count * arb(wide) ** j
        off = arb(0, (alias * arb(r) ** j).upper())
        found.append((c + off) / arb(rows.reach) ** j)
    return tuple(found)
