"""The beams that the report's conclusions are drawn from, their resonances and their regions."""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from compare.report.claims.routes import Beam, Both, both, edge, real_frequencies
from hill import SteppedBeam, UniformBeam

GAMMA = 0.1
ETA = 0.01
"""The damping factor of Figures 8 and 15 to 25."""

STEP = {"xi_c": 0.6, "area_ratio": 0.6, "inertia_ratio": 0.6}
INTERIOR = 9
"""Points inside a region where its T is compared with a half circle."""

PAIRS = (
    ("2 omega_(B)", 0, 0, 1),
    ("omega_(B) + omega_(1)", 0, 1, 1),
    ("2 omega_(1)", 1, 1, 1),
    ("omega_(B) + omega_(2)", 0, 2, 1),
    ("2 omega_(2)", 2, 2, 1),
    ("omega_(1) + omega_(2)", 1, 2, 1),
    ("omega_(1) - omega_(B)", 0, 1, -1),
    ("omega_(2) - omega_(B)", 0, 2, -1),
    ("omega_(2) - omega_(1)", 1, 2, -1),
)
"""The first-order resonances of three coordinates: name, i, j, sign of omega_i in omega_j +- it."""


def uniform(**changes: Any) -> UniformBeam:
    """The beam of Table 1."""
    return UniformBeam(**({"T0": 20.0, "K_theta": 0.5, "xi_G": 0.5} | changes))


def stepped(**changes: Any) -> SteppedBeam:
    """The beam of Table 2."""
    return SteppedBeam(**({"T0": 20.0, "K_theta": 1.0, "xi_G": 0.5} | STEP | changes))


def resonances(beam: Beam) -> dict[str, float]:
    """First-order resonances of B, 1 and 2, by name."""
    omega = real_frequencies(beam)
    return {name: omega[j] + sign * omega[i] for name, i, j, sign in PAIRS}


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
    low, high : float
        Its boundaries.
    """

    beam: Beam
    gamma: float
    eta: float
    name: str
    Omega: float
    low: float
    high: float

    @property
    def at_resonance(self) -> Both:
        """T_x of section 7.3."""
        return both(self.beam, self.Omega, self.gamma, self.eta)

    @property
    def T_x(self) -> float:
        """The same as a number."""
        return self.at_resonance.hill

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

    @cached_property
    def inside(self) -> tuple[tuple[float, Both], ...]:
        """Points between the boundaries, the ends left out."""
        points = self.centre + self.radius * np.linspace(-0.95, 0.95, INTERIOR)
        return tuple((float(x), both(self.beam, float(x), self.gamma, self.eta)) for x in points)

    @property
    def peak(self) -> Both:
        """The largest T inside."""
        return max((T for _, T in self.inside), key=lambda T: T.hill)

    def departure(self, route: str = "hill") -> float:
        """Largest distance of T from the half circle between the boundaries, in radii."""
        return max(
            abs(np.hypot(getattr(T, route), Omega - self.centre) / self.radius - 1.0)
            for Omega, T in self.inside
        )


@cache
def regions(beam: Beam, gamma: float = GAMMA, eta: float = 0.0) -> tuple[Region, ...]:
    """First-order resonances that are unstable, with the boundaries of their regions."""
    found = []
    for name, Omega in resonances(beam).items():
        if both(beam, Omega, gamma, eta).stable:
            continue
        # half the undamped T_x, so that no step leaps over the stable ground beyond
        stride = 0.5 * both(beam, Omega, gamma).hill
        low, high = (edge(beam, Omega, way * stride, gamma, eta) for way in (-1.0, 1.0))
        found.append(Region(beam, gamma, eta, name, Omega, low, high))
    return tuple(found)


def beams() -> tuple[tuple[str, Beam], ...]:
    """The beams of Tables 1 and 2."""
    return ("uniform", uniform()), ("stepped", stepped())


def every_region() -> list[tuple[str, Region]]:
    """Their first-order regions."""
    return [(kind, region) for kind, beam in beams() for region in regions(beam)]
