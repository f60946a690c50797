"""Boundaries on a chart of Omega and another parameter: curves, each with its resonance."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.boundaries import Family as Curves
from compare.boundaries import Tongue, follow
from compare.charts import chebyshev
from compare.charts.compute import Chart
from compare.charts.parameters import with_forcing
from compare.charts.surface import Surface
from compare.resonances import first_order, modal
from floquet.batch import polynomials
from hill import HillEquation

Float = NDArray[np.floating[Any]]

STATIONS = 33
"""Values of y at which the edges are solved for, before those added where a tongue closes."""


@dataclass(frozen=True)
class OnSurface(Curves):
    """The chart's interpolant in place of a route: the same P, at a hundredth of the price."""

    surface: Surface | None = None
    y_to_smooth: Callable[[Float], Float] = np.asarray
    sections: dict[tuple[int, float], Float] = field(default_factory=dict)

    def along(self, Omega: Float, y: float) -> Float:
        """Coefficients of P at several Omega, (k, n + 1); where there is no series, directly."""
        assert self.surface is not None
        u = 1.0 / np.asarray(Omega, float)
        v = float(self.y_to_smooth(np.array(y)))
        found: dict[int, Float] = {}
        for k, piece in enumerate(self.surface.pieces):
            inside = (u >= piece.low[0]) & (u <= piece.high[0])
            if piece.series is None or not piece.low[1] <= v <= piece.high[1]:
                continue
            if (k, y) not in self.sections:
                local = (2.0 * v - piece.low[1] - piece.high[1]) / (piece.high[1] - piece.low[1])
                row = chebyshev.basis(np.array([local]), piece.series.shape[2])[0]
                self.sections[k, y] = piece.series @ row
            section = self.sections[k, y]
            local_u = (2.0 * u[inside] - piece.low[0] - piece.high[0]) / (
                piece.high[0] - piece.low[0]
            )
            values = section @ chebyshev.basis(local_u, section.shape[1]).T
            found |= {
                int(i): np.append(1.0, p)
                for i, p in zip(np.flatnonzero(inside), values.T, strict=True)
            }
        beyond = [i for i in range(len(u)) if i not in found]
        if beyond:
            equations = [self.equation(float(Omega[i]), y) for i in beyond]
            found |= dict(zip(beyond, polynomials(equations).coefficients, strict=True))
        return np.array([found[i] for i in range(len(u))])

    def P(self, Omega: float, y: float) -> Float:
        """Coefficients of P at a point."""
        return np.asarray(self.along(np.array([Omega]), y)[0])


def tongues(chart: Chart, orders: int = 2) -> tuple[Tongue, ...]:
    """Boundaries of the instabilities of the first orders over a chart of Omega (x) and y.

    Raises
    ------
    ValueError
        The chart is not one of Omega against a second parameter.
    """
    if len(chart.axes) != 2 or chart.axes[0].name != "Omega":
        raise ValueError("boundaries: need a chart of Omega (x) against a second parameter (y)")
    x, y = chart.axes

    def equation(Omega: float, value: float) -> HillEquation:
        beam, forcing = chart.family.at({"Omega": Omega, y.name: value})
        return beam.equation(forcing["Omega"], forcing["gamma"], forcing["eta"])

    @lru_cache(maxsize=512)
    def matrices(value: float, Omega: float | None) -> HillEquation:
        return equation(Omega or 1.0, value)

    def known(Omega: float, value: float) -> HillEquation:
        # without compliance F and G do not know Omega
        beam, forcing = chart.family.at({"Omega": Omega, y.name: value})
        model = matrices(value, None if np.isinf(beam.omega_L) else Omega)
        return with_forcing(model, forcing)

    curves = OnSurface(
        known, lambda e: polynomials([e]).coefficients[0], chart.surface, y.to_smooth
    )
    # at gamma = 0 every tongue is a point, and there is nothing to solve for
    first = y.low + (y.high - y.low) / 200.0 if y.low == 0.0 else y.low
    stations = [float(v) for v in np.linspace(first, y.high, STATIONS)]
    size = equation(x.low, y.high).n
    found: list[Tongue] = []
    for resonance in first_order(size):
        for order in range(1, orders + 1):
            own = replace(resonance, order=order)
            if not any(x.low <= own.Omega(modal(known(1.0, v))[0]) <= x.high for v in stations):
                continue
            for tongue in follow(curves, own, stations):
                if np.any((tongue.upper >= x.low) & (tongue.lower <= x.high)):
                    found.append(tongue)
    return tuple(found)


def width(tongue: Tongue, y: float) -> float:
    """Width in Omega at a value of y; 0 where the tongue is not open."""
    pair = tongue.at(y)
    return 0.0 if pair is None else pair[1] - pair[0]
