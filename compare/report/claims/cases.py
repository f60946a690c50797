"""The beams that the report's conclusions are drawn from, their resonances and their regions."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from compare.report.claims.both_routes import Both, Boundary, both, edge, real_frequencies
from compare.report.one_route import Beam, RouteName
from compare.report.tables import GAMMA, STEPPED, UNIFORM
from hill import SteppedBeam, UniformBeam
from hill.averaging import first_order

STEP = {name: STEPPED[name] for name in ("xi_c", "area_ratio", "inertia_ratio")}
"""The step of Table 2."""

INTERIOR = 9
"""Points inside a region where its T is compared with a half circle."""


def uniform(**changes: Any) -> UniformBeam:
    """The beam of Table 1."""
    return UniformBeam(**(UNIFORM | changes))


def stepped(**changes: Any) -> SteppedBeam:
    """The beam of Table 2."""
    return SteppedBeam(**(STEPPED | changes))


def resonances(beam: Beam) -> dict[str, float]:
    """First-order resonances of B, 1 and 2, by name."""
    omega = np.array(real_frequencies(beam), complex)
    return {resonance.name: resonance.Omega(omega) for resonance in first_order(3)}


@dataclass(frozen=True)
class Extent:
    """A region as one route has it: its resonance, its boundaries, T at the resonance."""

    Omega: float
    low: float
    high: float
    T_x: float

    @property
    def centre(self) -> float:
        """Half way between the boundaries."""
        return 0.5 * (self.low + self.high)

    @property
    def radius(self) -> float:
        """Half the width."""
        return 0.5 * (self.high - self.low)

    @property
    def offset(self) -> float:
        """How far the centre lies from the resonance, in radii."""
        return (self.centre - self.Omega) / self.radius


@dataclass(frozen=True)
class Region:
    """A first-order region of instability.

    Attributes
    ----------
    beam, gamma, eta
        What it belongs to.
    name : str
        Its resonance.
    Omega : float
        The resonance itself.
    lower, upper : Boundary
    """

    beam: Beam
    gamma: float
    eta: float
    name: str
    Omega: float
    lower: Boundary
    upper: Boundary

    @property
    def at_resonance(self) -> Both:
        """T_x of section 7.3."""
        return both(self.beam, self.Omega, self.gamma, self.eta)

    @property
    def hill(self) -> Extent:
        """By the determinant."""
        return self.by("hill")

    def by(self, route: RouteName) -> Extent:
        """The region by one route."""
        lower, upper, T_x = (
            float(getattr(x, route)) for x in (self.lower, self.upper, self.at_resonance)
        )
        return Extent(self.Omega, lower, upper, T_x)

    @cached_property
    def inside(self) -> tuple[tuple[float, Both], ...]:
        """Points between the boundaries, the ends left out."""
        points = self.hill.centre + self.hill.radius * np.linspace(-0.95, 0.95, INTERIOR)
        return tuple((float(x), both(self.beam, float(x), self.gamma, self.eta)) for x in points)

    @property
    def peak(self) -> Both:
        """The largest T inside."""
        return max((T for _, T in self.inside), key=lambda T: T.hill)

    def departure(self, route: RouteName) -> float:
        """Largest distance of T from the half circle between the boundaries, in radii."""
        own = self.by(route)
        return max(
            abs(float(np.hypot(getattr(T, route), Omega - own.centre)) / own.radius - 1.0)
            for Omega, T in self.inside
        )


@lru_cache(maxsize=64)
def regions(beam: Beam, gamma: float = GAMMA, eta: float = 0.0) -> tuple[Region, ...]:
    """First-order resonances that are unstable, with the boundaries of their regions."""
    found = []
    for name, Omega in resonances(beam).items():
        if both(beam, Omega, gamma, eta).stable:
            continue
        # half the undamped T_x, so that no step leaps over the stable ground beyond
        stride = 0.5 * both(beam, Omega, gamma).hill
        lower, upper = (edge(beam, Omega, way * stride, gamma, eta) for way in (-1.0, 1.0))
        found.append(Region(beam, gamma, eta, name, Omega, lower, upper))
    return tuple(found)


def beams() -> tuple[tuple[str, Beam], ...]:
    """The beams of Tables 1 and 2."""
    return ("uniform", uniform()), ("stepped", stepped())


def every_region() -> list[tuple[str, Region]]:
    """Their first-order regions."""
    return [(kind, region) for kind, beam in beams() for region in regions(beam)]
