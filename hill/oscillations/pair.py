"""Two oscillations that pulsation couples: their exponents, from a corner of Hill's matrix.

Near a resonance Omega = (omega_i +- omega_j)/k two exponents are close together: oscillation i in
harmonic 0 and j in harmonic -k. Where they meet, each has a branch point, and an instability
begins; half their sum and the square of half their difference have none. The two are found in the
Krylov space that inverse iteration spans from the two oscillations, in a corner of the infinite
matrix that is enlarged until they do not move: unlike a determinant's, the error of an exponent
falls faster than any power of the corner's size. Others may pass between the two; these are the
ones whose vectors are still mostly the two oscillations'.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hill.arrays import EPS, Complex
from hill.averaging import Resonance
from hill.equation import HillEquation
from hill.errors import Refused
from hill.oscillations.corner import Corner, Inverse
from hill.oscillations.steady import Steady
from hill.periodic import PeriodicEquation

# Harmonics beyond those of the two oscillations, tried in turn.
BEYOND = (2, 4, 7, 11, 16, 24)

# What a larger corner may move an exponent by, over Omega.
TOLERANCE = 1e-11

# The shift is off the pair's middle by this much of Omega: without pulsation both may be upon it.
BESIDE = (0.6 + 0.8j) * 1e-6

# Of the exponents, over Omega: what is less well known is refused.
WORST = 1e-6

# Inverse iterations, of two vectors each.
MAX_STEPS = 20

# A third takes part like this, over the second of the two, where it is as much like them.
ALIKE = 0.5

# Rounding of `mean` and of the root of `square`, over the exponents: at the edge of an instability
# of the report's beam the real part of `mean`, which is 0 there, is off by 5e-13.
ROUNDING = 4096.0 * EPS


@dataclass(frozen=True)
class Pair:
    """Two exponents, mean +- sqrt(square).

    Attributes
    ----------
    mean, square : complex
        Smooth in every parameter.
    mean_error, square_error : float
        Estimates of their errors: what the last enlargement of the corner moved them by, and
        rounding.
    """

    mean: complex
    square: complex
    mean_error: float
    square_error: float

    @property
    def exponents(self) -> tuple[complex, complex]:
        """Both, the one that grows more first."""
        root = complex(np.sqrt(complex(self.square)))
        return self.mean + root, self.mean - root

    @property
    def error(self) -> float:
        """Estimate of the error of either exponent; of a root where the two meet."""
        apart = abs(self.square)
        if self.square_error < 0.5 * apart:
            return self.mean_error + self.square_error / apart**0.5
        return self.mean_error + (apart + self.square_error) ** 0.5

    @property
    def T(self) -> float:
        """Twice the larger growth exponent, as in (7.1.1)."""
        return 2.0 * self.exponents[0].real

    def moved(self, before: "Pair") -> "Pair":
        """The same with errors from an earlier one."""
        return Pair(
            self.mean,
            self.square,
            self.mean_error + abs(self.mean - before.mean),
            self.square_error + abs(self.square - before.square),
        )


def pair(equation: HillEquation | PeriodicEquation, resonance: Resonance, alone: Steady) -> Pair:
    """The exponents of a resonance's two oscillations.

    Parameters
    ----------
    equation : HillEquation or PeriodicEquation
    resonance : Resonance
        Which oscillations, of those that `alone` has, and how many harmonics apart.
    alone : Steady
        The same equation's without pulsation.

    Raises
    ------
    Refused
        No corner tried is large enough, or a third exponent cannot be told from the two.
    """
    e = equation.general() if isinstance(equation, HillEquation) else equation
    before: Pair | None = None
    block: Complex | None = None
    for beyond in BEYOND:
        corner = Corner(e, -resonance.order - beyond, beyond)
        found, block = _nearest(corner, resonance, alone, block)
        if before is not None:
            now = found.moved(before)
            allowed = TOLERANCE * e.Omega
            # where the two meet it is rounding that moves them
            if now.error <= allowed or (
                now.mean_error <= allowed and now.square_error <= 4.0 * found.square_error
            ):
                return now
        before = found
    raise Refused(f"{resonance.name}: too many harmonics take part at Omega = {e.Omega:g}")


def _nearest(
    corner: Corner, resonance: Resonance, alone: Steady, near: Complex | None = None
) -> tuple[Pair, Complex]:
    """The pair of a corner, its errors those of rounding, and the span of its two vectors.

    It is looked for from the two oscillations on, or from such a span of a smaller corner.
    """
    k, Omega = resonance.order, corner.equation.Omega
    exponents, right, left = _two(resonance, alone)
    start, read = (
        np.stack([corner.state(x, h) for x, h in zip(vectors, (0, -k), strict=True)], axis=1)
        for vectors in (right, left)
    )
    middle = 0.5 * (exponents[0] + exponents[1] + 1j * k * Omega) + BESIDE * Omega
    before, moved, third = None, None, np.inf
    first = start if near is None else corner.widened(near)
    for T, V in _projections(corner.about(middle), first):
        mean, square, third, vectors = _chosen(T, read.T @ V, V.conj().T @ start)
        size = abs(middle + mean) + Omega
        now = Pair(
            middle + mean,
            square,
            ROUNDING * size,
            ROUNDING * size * (abs(square) ** 0.5 + abs(BESIDE) * size),
        )
        if before is not None:
            moved = now.moved(before)
            if (
                moved.mean_error <= 2.0 * now.mean_error
                and moved.square_error <= 2.0 * now.square_error
                and third < ALIKE
            ):
                return now, V @ vectors
        before = now
    # where the two meet they may be known to less
    if moved is not None and third < ALIKE and moved.error <= WORST * Omega:
        return moved, V @ vectors
    raise Refused(
        f"{resonance.name}: at Omega = {Omega:g} a third oscillation cannot be told from the two"
    )


def _two(resonance: Resonance, alone: Steady) -> tuple[list[complex], list[Complex], list[Complex]]:
    """Exponents and vectors of the two without pulsation: of the sum, j's conjugate is near i."""
    if max(resonance.i, resonance.j) >= len(alone.oscillations):
        raise Refused(f"{resonance.name}: one of the two is damped beyond oscillating")
    both = [alone.oscillations[k] for k in (resonance.i, resonance.j)]
    exponents = [complex(alone.exponents[k]) for k in both]
    right, left = [alone.right[:, k] for k in both], [alone.left[:, k] for k in both]
    left = [y / (y @ x) for x, y in zip(right, left, strict=True)]
    if resonance.sign > 0:
        exponents[1] = exponents[1].conjugate()
        right[1], left[1] = right[1].conj(), left[1].conj()
    return exponents, right, left


def _projections(inverse: Inverse, start: Complex) -> Iterator[tuple[Complex, Complex]]:
    """The inverse on ever larger Krylov spaces, and their orthonormal bases, by block Arnoldi."""
    V = np.linalg.qr(start)[0]
    T = np.zeros((2, 0), complex)
    for _ in range(MAX_STEPS):
        new = inverse.right(V[:, -2:])
        column = np.zeros((V.shape[1], 2), complex)
        for _ in range(2):  # twice is enough (Kahan)
            part = V.conj().T @ new
            new, column = new - V @ part, column + part
        T = np.hstack([T, column])
        yield T, V
        more, rest = np.linalg.qr(new)
        V = np.hstack([V, more])
        T = np.vstack([T, np.hstack([np.zeros((2, T.shape[1] - 2)), rest])])


def _chosen(T: Complex, read: Complex, start: Complex) -> tuple[complex, complex, float, Complex]:
    """Of the two most like the oscillations: half the sum of 1/value, half the difference squared.

    The oscillations' vectors are sums of T's, and what each adds to ``read @ start``, which is the
    identity, is how much it takes part. Then the third's part over the second's, and what the two
    are in the columns of `read`.
    """
    values, vectors = np.linalg.eig(T)
    part = np.abs(np.sum((read @ vectors).T * np.linalg.solve(vectors, start), axis=1))
    third, second, first = np.argsort(np.append(part, -1.0))[-3:]
    one, other = 1.0 / values[first], 1.0 / values[second]
    alike = float(part[third] / part[second]) if third < len(part) else 0.0
    both = vectors[:, [first, second]]
    return 0.5 * complex(one + other), 0.25 * complex(one - other) ** 2, alike, both
