"""What is computed: the report's uniform beam, and points spread over its chart."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill import HillEquation, UniformBeam

Float = NDArray[np.floating[Any]]

OMEGA, GAMMA = (0.35, 6.0), (0.0, 0.5)
"""The chart: Table 1's beam over its resonances, thrust ratios up to a half."""

# 1/x and 1/x^2 of the root of x^3 = x + 1: the first k points of this sequence are spread evenly
# whatever k, so that a slow contender's few points cost on average what a quick one's many do.
STEPS = (0.7548776662466927, 0.5698402909980532)


@dataclass(frozen=True, eq=False)
class Points:
    """Equations of one beam at several (Omega, gamma).

    Attributes
    ----------
    F, G : (n, n) ndarray
        The beam's matrices.
    Omega, gamma : (k,) ndarray
        Forcing frequency over omega_1, thrust ratio.
    """

    F: Float
    G: Float
    Omega: Float
    gamma: Float

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.F)

    def __len__(self) -> int:
        """Number of points."""
        return len(self.Omega)

    @cached_property
    def equations(self) -> list[HillEquation]:
        """The same as our own functions take them."""
        return [
            HillEquation(F=self.F, G=self.G, gamma=float(g), Omega=float(w))
            for w, g in zip(self.Omega, self.gamma, strict=True)
        ]

    def first(self, count: int) -> "Points":
        """The first so many."""
        return Points(self.F, self.G, self.Omega[:count], self.gamma[:count])


Solver = Callable[[Points], Float]
"""P(z) at each point, (k, n + 1), monic, highest power first."""


@dataclass(frozen=True)
class Contender:
    """A way to compute P(z).

    Attributes
    ----------
    name, settings : str
        What it is, and how it was set.
    build : callable
        From some points (only F and G matter) to a `Solver`; compiles what has to be compiled.
    together : bool
        Whether it gains by many points in one call.
    ours : bool
    """

    name: str
    settings: str
    build: Callable[[Points], Solver]
    together: bool = False
    ours: bool = False


def beam(modes: int = 2) -> UniformBeam:
    """The report's uniform beam (Table 1), with that many bending modes."""
    return UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=modes)


def points(count: int, modes: int = 2, Omega: tuple[float, float] = OMEGA, seed: int = 0) -> Points:
    """`count` points spread evenly over Omega and gamma, from a start of the seed's."""
    model = beam(modes).equation(1.0, 0.1)
    k = np.arange(1, count + 1)
    start = np.random.default_rng(seed).random(2)
    x, y = ((s + k * step) % 1.0 for s, step in zip(start, STEPS, strict=True))
    low, high = Omega
    return Points(model.F, model.G, low + (high - low) * x, GAMMA[0] + (GAMMA[1] - GAMMA[0]) * y)


def one(Omega: float, gamma: float = 0.3) -> Points:
    """One point."""
    model = beam().equation(1.0, 0.1)
    return Points(model.F, model.G, np.array([Omega]), np.array([gamma]))


def grid(count: int) -> tuple[int, int]:
    """Points on the axes Omega and gamma of a chart of `count` points."""
    x = round(count**0.5)
    return x, max(round(count / x), 2)


def grid_points(count: int) -> Points:
    """The points of such a chart, one by one, Omega slowest."""
    x, y = grid(count)
    model = beam().equation(1.0, 0.1)
    Omega, gamma = np.meshgrid(np.linspace(*OMEGA, x), np.linspace(*GAMMA, y), indexing="ij")
    return Points(model.F, model.G, Omega.ravel(), gamma.ravel())
