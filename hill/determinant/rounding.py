r"""What rounding of the data and of the elimination does to P(z), by its derivative.

d log det T = tr(T^-1 dT), and T^-1 is needed only where T is not zero. With as many harmonics
together as the couplings reach, T is block tridiagonal, constant along its diagonals but for the
squares (alpha + m)^2; the blocks of its inverse come from eliminating from both ends,

    S_g = D_g - L S_(g-1)^-1 U,    S'_g = D_g - U S'_(g+1)^-1 L,
    (T^-1)_gg = (S_g + S'_g - D_g)^-1.

What is rounded once and stands in every row, Fbar and B_p, moves P by the sum of these blocks; what
is rounded in each row anew, the squares and the elimination, by their root mean square.
"""

from typing import Any

import numpy as np

from hill.arrays import EPS, Complex, Float
from hill.determinant.finite import Blocks

# (F - eta^2/4)/Omega^2 takes four roundings of half an ulp each, B_p three.
DATA_ULPS = 2.0

# A row's own roundings, in ulps of its elements: the square, the subtraction, the elimination of
# the rows before it.
ROW_ULPS = 2.0

# Harmonics beyond the highest frequency. Of the rows left out the inverses are -1/m^2; without them
# the first order comes out .93 to 4.3 times what it is over 45 random systems of one to three
# coordinates, and .67 times at least over 200 of one without pulsation: an estimate, no bound.
EXTRA_HARMONICS = 6


def coefficient_shifts(
    system: Blocks, size: Blocks, given: Blocks, alpha: Complex, values: Complex
) -> tuple[float, float]:
    """How far rounding moves any coefficient of P(z), to first order.

    Parameters
    ----------
    system : Blocks
    size : Blocks
        Size of what Fbar and B_p sum.
    given : Blocks
        Errors that Fbar and B_p came with.
    alpha : (c,) complex ndarray
        Points with z on the upper half of |z| = 1; more than half as many as P has coefficients.
    values : (c,) complex ndarray
        P(z) there.

    Returns
    -------
    rounding, data : float
        By rounding, and by the errors given. A coefficient of P is a mean over the circle, so it
        moves by no more than the mean of what P moves by.
    """
    n, reach = system.n, max(system.reach, 1)
    strength = sum((np.abs(B) for B in system.B.values()), np.zeros_like(system.Fbar))
    least = system.highest + 2.0 * np.sqrt(np.linalg.norm(strength, 2)) + EXTRA_HARMONICS
    groups = 2 * int(np.ceil(least / reach)) + 1
    first = -(groups * reach) // 2
    m = np.arange(first, first + groups * reach).reshape(groups, reach)
    inner, upper, lower = _constant(system, reach)
    squares = np.repeat((alpha[:, None, None] + m) ** 2, n, axis=2)  # (c, groups, reach n)

    diagonal = inner - squares[..., None] * np.eye(reach * n)
    down, up = _eliminated(diagonal, lower, upper)
    inverse = np.linalg.inv(np.linalg.inv(down) + np.linalg.inv(up) - diagonal)
    # but for their sign, of which no modulus knows
    below = up[:, 1:] @ lower @ inverse[:, :-1]
    above = inverse[:, :-1] @ upper @ up[:, 1:]

    def common(error: Blocks) -> Float:
        of_inner, of_upper, of_lower = _constant(error, reach)
        found = _moduli(inverse, of_inner) + _moduli(below, of_upper) + _moduli(above, of_lower)
        return np.abs(values) * found

    rows = np.einsum("cgjk,cgkj->cg", np.abs(inverse), np.abs(diagonal))
    own = np.abs(values) * ROW_ULPS * np.sqrt(np.sum(rows**2, axis=1)) + DATA_ULPS * common(size)
    return float(EPS * np.mean(own)), float(np.mean(common(given)))


def _constant(system: Blocks, reach: int) -> tuple[Float, Float, Float]:
    """The blocks of T, the squares left out: on the diagonal, above it and below it."""
    n = system.n
    whole = np.zeros((3 * reach, n, reach, n))
    for row in range(3 * reach):
        for column in range(reach):
            p = abs(row - reach - column)
            whole[row, :, column] = system.Fbar if p == 0 else system.B.get(p, 0.0)
    lower_rows, inner, upper_rows = whole.reshape(3, reach * n, reach * n)
    # block row g - 1 of block column g is the upper coupling, row g + 1 the lower
    return inner, lower_rows, upper_rows


def _eliminated(diagonal: Any, lower: Float, upper: Float) -> tuple[Any, Any]:
    """Inverses of S_g = D_g - L S_(g-1)^-1 U from the first on, and of S'_g from the last."""
    both = np.stack([diagonal, diagonal[:, ::-1]])
    before, after = (np.stack(pair)[:, None] for pair in ((lower, upper), (upper, lower)))
    found = np.empty_like(both)
    found[:, :, 0] = np.linalg.inv(both[:, :, 0])
    for g in range(1, both.shape[2]):
        found[:, :, g] = np.linalg.inv(both[:, :, g] - before @ found[:, :, g - 1] @ after)
    return found[0], found[1][:, ::-1]


def _moduli(blocks: Any, size: Float) -> Float:
    """Sum over the elements of |sum_g block_g|^T times their size, (c,)."""
    return np.asarray(np.einsum("cjk,kj->c", np.abs(blocks.sum(axis=1)), size))
