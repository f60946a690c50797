"""Growth of two oscillations across a band: polynomials in Omega through what is smooth there."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from hill.oscillations.pair import Pair

Complex = NDArray[np.complexfloating[Any, Any]]

# Values of Omega across a band. What they leave of an edge is corrected at the edge.
NODES = 7

# Damping, over Omega, that is none: rounding of an undamped exponent.
UNDAMPED = 1e-10


def excess(pair: Pair, Omega: float) -> float:
    """Above 0 where one of two exponents grows, smooth through 0: of mean -a and square p + i q.

    a < Re sqrt(p + i q) is q^2 > 4 a^2 (a^2 - p).
    """
    a, p, q = -pair.mean.real, pair.square.real, pair.square.imag
    if a <= UNDAMPED * Omega:
        return p if a >= -UNDAMPED * Omega else max(p, 0.0) + a * a
    return p - a * a + (0.5 * q / a) ** 2


@dataclass(frozen=True)
class Window:
    """Omega about a band.

    Attributes
    ----------
    centre, half : float
    """

    centre: float
    half: float

    @property
    def nodes(self) -> list[float]:
        """Chebyshev's."""
        angles = np.pi * (np.arange(NODES) + 0.5) / NODES
        return [float(self.centre + self.half * x) for x in np.cos(angles)]


@dataclass(frozen=True, eq=False)
class Fits:
    """Polynomials through mean and square over a window.

    Attributes
    ----------
    window : Window
    mean, square : (NODES,) complex ndarray
        Chebyshev's coefficients.
    """

    window: Window
    mean: Complex
    square: Complex

    @classmethod
    def of(cls, window: Window, pairs: list[Pair]) -> "Fits":
        """Through the pairs at the window's nodes."""
        t = (np.array(window.nodes) - window.centre) / window.half

        def through(values: list[complex]) -> Complex:
            found = np.array(values)
            real, imag = (chebyshev.chebfit(t, x, NODES - 1) for x in (found.real, found.imag))
            return np.asarray(real + 1j * imag)

        return cls(window, through([p.mean for p in pairs]), through([p.square for p in pairs]))

    def at(self, Omega: float) -> Pair:
        """Mean and square there."""
        t = (Omega - self.window.centre) / self.window.half
        mean, square = (complex(chebyshev.chebval(t, c)) for c in (self.mean, self.square))
        return Pair(mean, square, 0.0, 0.0)

    def excess(self, Omega: float) -> float:
        """As `excess`, of the polynomials."""
        return excess(self.at(Omega), Omega)

    def peak(self) -> float:
        """Where it grows fastest; where the square is largest, if nothing grows."""
        return self._most(lambda x: (self.at(x).T, self.at(x).square.real))

    def middle(self) -> float:
        """Where the excess is largest."""
        return self._most(self.excess)

    def _most(self, of: Callable[[float], Any]) -> float:
        low, high = self.window.centre - self.window.half, self.window.centre + self.window.half
        for _ in range(3):
            grid = np.linspace(low, high, 41)
            values = [of(float(x)) for x in grid]
            most = max(range(41), key=values.__getitem__)
            low, high = grid[max(most - 1, 0)], grid[min(most + 1, 40)]
        return float(grid[most])
