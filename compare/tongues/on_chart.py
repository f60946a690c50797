"""Boundaries on a chart of Omega and another parameter: curves, each with its resonance."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import chebyshev
from compare.charts.parameters import Axis
from compare.charts.result import Chart
from compare.charts.surface import Surface
from compare.stability.indicators import TAIL, NotSmooth
from compare.tongues.boundaries import Family as Curves
from compare.tongues.boundaries import Tongue, follow
from floquet.batch import polynomials
from hill import HillEquation
from hill.averaging import Resonance, first_order, modal

Float = NDArray[np.floating[Any]]

STATIONS = 33
"""Values of y at which the edges are solved for, before those added where a tongue closes."""

ORDERS = 3
"""Resonances are followed up to this order where nothing else is asked."""

BESIDE = 1.5
"""How far beyond the chart's ends, as a factor, a resonance is followed that may reach into it."""

SAME = 0.02
"""Two tongues are one where their edges differ by no more than this share of the width; they are
compared by straight lines between stations."""

MOSTLY = 0.7
"""Share of its stations from which a tongue that is another there is no tongue of its own."""


@dataclass(frozen=True)
class OnSurface(Curves):
    """The chart's interpolant in place of a route: the same P, at a hundredth of the price.

    Attributes
    ----------
    surface : Surface
    along_Omega : int
        Which of the surface's two axes is Omega's.
    y_to_smooth : callable
        The other parameter's smooth variable.
    """

    surface: Surface | None = None
    along_Omega: int = 0
    y_to_smooth: Callable[[Float], Float] = np.asarray
    sections: dict[tuple[int, float], Float] = field(default_factory=dict)

    @property
    def error(self) -> float:
        """The series', which are no smoother where one follows the other."""
        assert self.surface is not None
        return max(TAIL, self.surface.error)

    def along(self, Omega: Float, y: float) -> Float:
        """Coefficients of P at several Omega, (k, n + 1); beyond the chart's edge, directly.

        Raises
        ------
        NotSmooth
            A longitudinal resonance is too near for a series.
        """
        assert self.surface is not None
        i, j = self.along_Omega, 1 - self.along_Omega
        u = 1.0 / np.asarray(Omega, float)
        v = float(self.y_to_smooth(np.array(y)))
        found: dict[int, Float] = {}
        for k, piece in enumerate(self.surface.pieces):
            inside = (u >= piece.low[i]) & (u <= piece.high[i])
            if not piece.low[j] <= v <= piece.high[j] or not np.any(inside):
                continue
            if piece.series is None:
                raise NotSmooth("P has no series here: a longitudinal resonance is too near")
            if (k, y) not in self.sections:
                local = (2.0 * v - piece.low[j] - piece.high[j]) / (piece.high[j] - piece.low[j])
                row = chebyshev.basis(np.array([local]), piece.series.shape[1 + j])[0]
                self.sections[k, y] = np.tensordot(piece.series, row, axes=(1 + j, 0))
            section = self.sections[k, y]
            local_u = (2.0 * u[inside] - piece.low[i] - piece.high[i]) / (
                piece.high[i] - piece.low[i]
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


def axes_of(chart: Chart) -> tuple[Axis, Axis]:
    """Omega's axis and the other one.

    Raises
    ------
    ValueError
        The chart is not one of Omega and one other parameter.
    """
    names = [axis.name for axis in chart.axes]
    if len(names) != 2 or "Omega" not in names:
        raise ValueError(f"tongues: need a chart of Omega and one other, not of {', '.join(names)}")
    k = names.index("Omega")
    return chart.axes[k], chart.axes[1 - k]


def on_surface(chart: Chart) -> OnSurface:
    """The chart's equations, with P from its interpolant.

    Raises
    ------
    ValueError
        As for `axes_of`.
    """
    Omega_axis, y = axes_of(chart)

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
        return model.forced(**forcing)

    return OnSurface(
        known,
        lambda e: polynomials([e]).coefficients[0],
        chart.surface,
        chart.axes.index(Omega_axis),
        y.to_smooth,
    )


def stations(y: Axis) -> list[float]:
    """Where the edges are solved for; not at 0, where a tongue in gamma is a point."""
    first = y.low + (y.high - y.low) / 200.0 if y.low == 0.0 else y.low
    return [float(v) for v in np.linspace(first, y.high, STATIONS)]


def tongues(
    chart: Chart, orders: int = ORDERS, progress: Callable[[int, int], Any] | None = None
) -> tuple[Tongue, ...]:
    """Boundaries of the instabilities of the first orders over a chart of Omega and another one.

    They break off next to a longitudinal resonance, where the chart has no series.

    Parameters
    ----------
    chart : Chart
    orders : int, optional
        Resonances 2 omega_i/k and (omega_i +- omega_j)/k up to this k.
    progress : callable, optional
        Called with how many resonances are done, and how many there are.

    Raises
    ------
    ValueError
        As for `axes_of`.
    """
    x, y = axes_of(chart)
    curves = on_surface(chart)
    at = stations(y)
    frequencies = [modal(curves.equation(1.0, v))[0] for v in at]
    wanted = [
        replace(resonance, order=order)
        for resonance in first_order(len(frequencies[0]))
        for order in range(1, orders + 1)
    ]
    found: list[Tongue] = []
    for done, resonance in enumerate(wanted, start=1):
        found += _one(curves, resonance, at, frequencies, x)
        if progress is not None:
            progress(done, len(wanted))
    return distinct(found)


def distinct(found: Sequence[Tongue]) -> tuple[Tongue, ...]:
    """Without those whose edges are another's nearly everywhere.

    A resonance of higher order that lies within a wide tongue is a guess that leads to its edges.
    """
    kept: list[Tongue] = []
    for tongue in sorted(found, key=lambda t: (t.resonance.order, -len(t.y))):
        if np.mean(merged(tongue, kept)) <= MOSTLY:
            kept.append(tongue)
    return tuple(kept)


def merged(tongue: Tongue, others: Sequence[Tongue]) -> NDArray[np.bool_]:
    """At which y the tongue's edges are another's: itself, or both have run into one another."""
    width = tongue.upper - tongue.lower
    result = np.zeros(len(width), bool)
    for other in others:
        if other is not tongue:
            within = (other.y[0] <= tongue.y) & (tongue.y <= other.y[-1])
            apart = np.maximum(
                np.abs(tongue.lower - np.interp(tongue.y, other.y, other.lower)),
                np.abs(tongue.upper - np.interp(tongue.y, other.y, other.upper)),
            )
            result |= within & (apart <= SAME * width) & (width > 0.0)
    return result


def _one(
    curves: OnSurface,
    resonance: Resonance,
    at: list[float],
    frequencies: list[Any],
    x: Axis,
) -> list[Tongue]:
    """The pieces of one resonance's boundary that reach into the chart."""
    low, high = x.low / BESIDE, x.high * BESIDE
    if not any(low <= resonance.Omega(omega) <= high for omega in frequencies):
        return []
    return [
        tongue
        for tongue in follow(curves, resonance, at)
        if np.any((tongue.upper >= x.low) & (tongue.lower <= x.high))
    ]
