"""P(z) over Omega and a second parameter y: what tongues are traced on."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.stability.indicators import TAIL
from compare.stability.reading import IN_Z, Reading
from hill.averaging import modal

Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]


@dataclass(frozen=True)
class PolynomialField:
    """Equations in two parameters, Omega and another one, with the route that solves them.

    Attributes
    ----------
    equation : callable
        (Omega, y) to a `HillEquation`, or what else the reading reads.
    polynomial : callable
        An equation to the coefficients of P, highest power first.
    """

    equation: Callable[[float, float], Any]
    polynomial: Callable[[Any], Float]

    @property
    def reading(self) -> Reading:
        """What P is a polynomial of."""
        return IN_Z

    @property
    def error(self) -> float:
        """How well P is known, over its largest coefficient: it is no smoother than that."""
        return TAIL

    def frequencies(self, y: float) -> Complex:
        """Natural frequencies, ascending."""
        return modal(self.equation(1.0, y))[0]

    def poles(self, y: float, low: float, high: float) -> Float:
        """Omega between low and high at which there is no equation; none that it knows of."""
        return np.empty(0)

    def P(self, Omega: float, y: float) -> Float:
        """Coefficients of P at a point."""
        return self.polynomial(self.equation(Omega, y))

    def along(self, Omega: Float, y: float) -> Float:
        """Coefficients of P at many Omega, (k, n + 1)."""
        return np.array([self.P(float(x), y) for x in Omega])
