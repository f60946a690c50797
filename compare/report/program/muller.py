"""The order in which SUBROUTINE MULLER found the three roots, which is the order of print.

The listing leaves MULLER out, a library routine. Muller's method started at .8, .85 and .9 on the
polynomial, then on what is left of it, gives the printed order of 95 of the report's 96 complete
triples (the other has two roots 9e-4 apart), and the sign of the first of a conjugate pair in 26 of
28. No source says so: the starting points are inferred from print.
"""

import cmath
from collections.abc import Sequence

import numpy as np

START = (0.8, 0.85, 0.9)
MAX_STEPS = 100
# Enough to tell which root it is. Two roots closer than this print the same anyway.
CLOSE = 1e-7


def in_order(roots: Sequence[complex]) -> tuple[complex, ...]:
    """The same roots, in the order in which the method finds them."""
    left, found = list(roots), []
    while len(left) > 1:
        near = _one(left)
        first = min(left, key=lambda z: abs(z - near))
        left.remove(first)
        found.append(first)
        # a complex root brings its conjugate with it
        if first.conjugate() in left and first.imag:
            left.remove(first.conjugate())
            found.append(first.conjugate())
    return (*found, *left)


def _one(roots: Sequence[complex]) -> complex:
    """The root that Muller's method runs into from `START`."""
    polynomial = np.poly(roots)
    x = [complex(start) for start in START]
    f = [complex(np.polyval(polynomial, at)) for at in x]
    for _ in range(MAX_STEPS):
        first, second = (f[1] - f[0]) / (x[1] - x[0]), (f[2] - f[1]) / (x[2] - x[1])
        curvature = (second - first) / (x[2] - x[0])
        slope = second + curvature * (x[2] - x[1])
        square = slope * slope - 4.0 * f[2] * curvature
        # adding zero: -0.0 would put the root of a negative number on the other side
        root = cmath.sqrt(complex(square.real, square.imag + 0.0))
        # of two equally large denominators, where a real search turns complex, the second
        wide = slope + root if abs(slope + root) > abs(slope - root) else slope - root
        if wide == 0.0:
            break
        step = -2.0 * f[2] / wide
        if abs(step) <= CLOSE * max(1.0, abs(x[2])):
            return x[2] + step
        x = [*x[1:], x[2] + step]
        f = [*f[1:], complex(np.polyval(polynomial, x[2]))]
    return x[2]
