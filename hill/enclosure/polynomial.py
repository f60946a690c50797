"""P(z) from values of the folded determinant, as narrow as one asks."""

from collections.abc import Callable
from functools import reduce
from typing import Any

from flint import acb, acb_mat, arb, ctx

from hill.enclosure.rows import Rows
from hill.enclosure.tail import Tail, TooWide, divided, eliminated, group, logarithm, tail

MAX_BITS = 1 << 12


def polynomial(make: Callable[[], Rows], bits: int) -> tuple[list[Any], Tail]:
    """Coefficients of P(z), monic, highest power first, to so many bits of the largest.

    Parameters
    ----------
    make : callable
        The rows at the precision of the moment.

    Raises
    ------
    TooWide
        `MAX_BITS` do not do, or too many harmonics.
    """
    work, asked = max(128, 2 * bits), bits + 16
    while work <= MAX_BITS:
        with ctx.workprec(work):
            try:
                rows = make()
                beyond = tail(rows, asked)
                found = _interpolated(rows, beyond)
            except ZeroDivisionError:
                found = None
            if found is not None and all(c.is_finite() for c in found):
                size = reduce(lambda a, b: a.max(b), (abs(c.mid()) for c in found))
                if all(arb(c.rad()) < size * arb(2) ** -bits for c in found):
                    return found, beyond
        work, asked = 2 * work, asked + bits // 2
    raise TooWide(f"P is not known to {bits} bits with {MAX_BITS} in the work")


def _interpolated(rows: Rows, beyond: Tail) -> list[Any]:
    """From values on |z| = 1 off the real axis; Liouville's theorem must hold."""
    n = rows.n
    count = n + 2 + n % 2
    points = [acb(arb(2 * k + 1) / count).exp_pi_i() for k in range(count // 2)]
    values = [_value(rows, beyond, z) for z in points]
    found = []
    for j in range(count):
        total = acb(0)
        for z, value in zip(points, values, strict=True):
            total += value / z**j
        # P is real on the real axis: the other half of the circle is the conjugate
        found.append(2 * total.real / count)
    one, nothing = found[n], found[n + 1 :]
    if not (one.contains(1) and all(c.contains(0) for c in nothing)):
        raise AssertionError("Liouville's theorem fails: a bound of the determinant is wrong")
    return [arb(1), *reversed(found[:n])]


def _value(rows: Rows, beyond: Tail, z: Any) -> Any:
    """P(z) = (z - 1)^n det (rows over -(m + alpha)^2), z = cos 2 pi alpha."""
    g, n = rows.reach, rows.n
    alpha = z.acos() / (2 * arb.pi())
    inner = g // 2
    first = inner + 1
    # middles of the groups are first + (g - 1)/2 + g k +- alpha, |Re alpha| <= 1/2
    groups = -(-(beyond.start - inner) // g) + 1
    U, L = rows.between(g, 1)
    to, back = rows.between(2 * inner + 1, first - inner)
    product = (z - 1) ** n
    centre = [alpha + m for m in range(-inner, inner + 1)]
    S_centre = rows.block(centre)
    for sign in (1, -1):
        x = first + arb(g - 1) / 2 + alpha * sign
        S = eliminated(rows, x + g * groups, beyond.steps)
        S = S + _unsure(n * g, beyond.unsure)
        total = logarithm(beyond, g, x + g * groups)
        for k in range(groups - 1, -1, -1):
            harmonics = group(rows, x + g * k)
            S = rows.block(harmonics) - U * S.inv() * L
            product = product * divided(rows, S, harmonics)
        product = product * total.exp()
        fold = to * S.inv() * back
        # from the other side harmonics count the other way round
        S_centre = S_centre - (fold if sign > 0 else _turned(fold, n))
    return product * divided(rows, S_centre, centre)


def _unsure(size: int, radius: Any) -> Any:
    ball = acb(arb(0, radius), arb(0, radius))
    return acb_mat(size, size, [ball] * size**2)


def _turned(matrix: Any, n: int) -> Any:
    """Blocks of n in the opposite order, rows and columns."""
    old = matrix.tolist()
    count = len(old) // n
    order = [n * i + k for i in reversed(range(count)) for k in range(n)]
    return acb_mat([[old[i][j] for j in order] for i in order])
