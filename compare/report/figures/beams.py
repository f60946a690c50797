"""From the catalogue's parameters to beams, families and resonances."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.edges.field import PolynomialField
from compare.report.figures.catalogue import Figure
from compare.report.one_route import Beam, RouteName, family
from compare.report.tables import GAMMA, Row, rows
from hill import SteppedBeam, UniformBeam
from hill.averaging import Resonance, first_order, modal

# In the stepped beam's Omega this one and 2 omega_(B) come near each other and repel (T0 = 9, 16).
THIRD = Resonance(1, 1, 1, 3)
RESONANCES = (*first_order(3), THIRD)


def beam_of(figure: Figure, **changes: float) -> Beam:
    """The figure's beam, with some parameters changed."""
    parameters: dict[str, Any] = {**figure.beam, "omega_L": figure.omega_L, **changes}
    return SteppedBeam(**parameters) if figure.stepped else UniformBeam(**parameters)


def family_of(
    figure: Figure, route: RouteName, eta: float = 0.0, g: float = 0.0
) -> PolynomialField:
    """Its equations along T0 at the tables' gamma, or along gamma at their T0."""
    base = beam_of(figure, g=g) if g else beam_of(figure)
    if figure.along == "T0":
        return family(route, lambda T0: replace(base, T0=T0), lambda _: GAMMA, eta)
    return family(route, lambda _: base, lambda gamma: gamma, eta)


def resonance_named(name: str) -> Resonance:
    """By its name in the tables, the two frequencies in either order."""
    for resonance in RESONANCES:
        if same_resonance(resonance.name, name):
            return resonance
    raise ValueError(f"resonance = {name!r}: not among those of three frequencies")


def same_resonance(one: str, other: str) -> bool:
    """Whether two names mean the same resonance."""
    return one == other or ("+" in one and one.split(" + ") == other.split(" + ")[::-1])


def at_resonance(name: str, beam: Beam) -> float:
    """Omega of a resonance."""
    return resonance_named(name).Omega(modal(beam.equation(1.0, 0.0))[0])


def printed(figure: Figure) -> list[Row]:
    """Printed rows of the figure's table, those of Table 3 without initial conditions."""
    return [row for row in rows(figure.table) if not row.initial_conditions]


def nearest(Omega: float, resonances: dict[str, float]) -> str:
    """The resonance that a forcing frequency belongs to."""
    return min(resonances, key=lambda name: abs(resonances[name] - Omega))


def point_count(count: int, detail: float, least: int = 5) -> int:
    """The usual count of points at a share `detail` of it, or `least`."""
    return max(least, round(count * detail))


def interior(count: int, marks: int) -> NDArray[np.intp]:
    """Indices of so many marks along a curve, not at its ends; none where it has but two points."""
    if count < 3:
        return np.empty(0, int)
    return np.unique(np.linspace(0, count - 1, marks + 2).round().astype(int)[1:-1])
