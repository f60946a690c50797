"""P(z) on a chart of Omega and another parameter, from its series: what tongues are traced on."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import chebyshev
from compare.charts.axis import Axis
from compare.charts.poles import singular_across
from compare.charts.result import Chart, directly
from compare.charts.scenario import Equation
from compare.charts.smooth import Smooth
from compare.charts.surface import Piece, fit, to_local
from compare.edges.field import PolynomialField
from compare.stability.indicators import BESIDE_POLE, TAIL, NotSmooth
from compare.stability.reading import Reading
from hill import HillEquation
from hill.system import singular_Omega

Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]

SECTIONS = 512
"""Lines of constant y whose series are kept: one resonance after another is cut at the same."""

TOLERANCE = 1e-11
"""Of the series beside the chart, over P's largest coefficient; the chart's own default."""

MAX_BESIDE = 5000
"""Nodes of one of them; a chart as wide as the report's takes 1105."""

LEAST_BESIDE = 1.0 / 128.0
"""Share of what lies beside the chart that is cut no further: a line is evaluated there."""

MAX_ALONE = 65
"""Points of one line that are evaluated without a series: an interpolant of degree 64."""


@dataclass(frozen=True)
class InterpolatedField(PolynomialField):
    """A chart's series in place of a route: the same P, at a hundredth of the price.

    Attributes
    ----------
    chart : Chart
        Of Omega and one other parameter.
    pieces : tuple of Piece
        The chart's, and others beside it.
    """

    chart: Chart
    pieces: tuple[Piece, ...]
    _section: Callable[[int, float], Float] = field(repr=False, compare=False)
    _frequencies: Callable[[float], Complex] = field(repr=False, compare=False)

    @property
    def reading(self) -> Reading:
        """The chart's."""
        return self.chart.scenario.reading

    @property
    def error(self) -> float:
        """The series', which are no smoother where one follows the other."""
        return max(TAIL, self.chart.surface.error)

    def frequencies(self, y: float) -> Complex:
        """Natural frequencies, ascending."""
        return self._frequencies(y)

    def poles(self, y: float, low: float, high: float) -> Float:
        """Omega between low and high at which the system has no equation."""
        _, other = axes_of(self.chart)
        system, _ = self.chart.scenario.at({other.name: y, "Omega": low})
        return singular_Omega(system, low, high)

    def along(self, Omega: Float, y: float) -> Float:
        """Coefficients of P at several Omega, (k, degree + 1); directly where there is no series.

        Raises
        ------
        NotSmooth
            A pole is met, or P leaves the floats.
        """
        return self.known(Omega, y)[0]

    def known(self, Omega: Float, y: float) -> tuple[Float, Float]:
        """The same with the errors, (k,)."""
        Omega = np.atleast_1d(np.asarray(Omega, float))
        i = self.chart.scenario.names.index("Omega")
        smooth = self._smooth.to_smooth(self._points(Omega, y))
        P = np.ones((len(Omega), self.chart.scenario.coordinates + 1))
        errors = np.full(len(Omega), np.nan)
        there, v = self._of_pieces(smooth), float(smooth[0, 1 - i])
        for k in map(int, np.flatnonzero(np.any(there, axis=1))):
            piece, inside = self.pieces[k], there[k]
            assert piece.series is not None
            local = to_local(smooth[inside], piece.low, piece.high)
            if self._smooth.skew:
                own = chebyshev.at_points(piece.series, tuple(local.T))
            else:
                section = self._section(k, v)
                own = section @ chebyshev.basis(local[:, i], section.shape[1]).T
            P[inside, 1:] = own.T
            errors[inside] = piece.error
        alone = np.isnan(errors)
        if np.any(alone):
            P[alone], errors[alone] = self._directly(Omega[alone], y)
        return P, errors

    def _directly(self, Omega: Float, y: float) -> tuple[Float, Float]:
        if len(Omega) > MAX_ALONE:
            raise NotSmooth("P has no series here, and is not smooth enough to do with few points")
        P, errors = directly(self.chart, self._points(Omega, y), _route_beside(self.chart))
        if np.any(np.isnan(P)):
            raise NotSmooth("a pole is on the line", BESIDE_POLE)
        if not np.all(np.isfinite(P)):
            raise NotSmooth("P is beyond a float")
        return P, errors

    def _points(self, Omega: Float, y: float) -> Float:
        """On a line of constant y, as the chart's axes have them."""
        other = axes_of(self.chart)[1].name
        ends = {"Omega": Omega, other: np.full(len(Omega), y)}
        return np.column_stack([ends[name] for name in self.chart.scenario.names])

    def _of_pieces(self, smooth: Float) -> NDArray[np.bool_]:
        """Which pieces have a series at which points, (pieces, k)."""
        low, high = self._corners
        return np.asarray(np.all((smooth >= low[:, None]) & (smooth <= high[:, None]), axis=-1))

    @cached_property
    def _corners(self) -> tuple[Float, Float]:
        """Of the pieces; of those without a series, such that nothing is within."""
        there = np.array([[piece.series is not None] for piece in self.pieces])
        low, high = (np.array([getattr(p, end) for p in self.pieces]) for end in ("low", "high"))
        return np.where(there, low, np.inf), high

    @cached_property
    def _smooth(self) -> Smooth:
        return self.chart.scenario.smooth

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
    names = chart.scenario.names
    if len(names) != 2 or "Omega" not in names:
        raise ValueError(f"tongues: need a chart of Omega and one other, not of {', '.join(names)}")
    k = names.index("Omega")
    return chart.axes[k], chart.axes[1 - k]


def on_surface(chart: Chart, low: float = np.inf, high: float = 0.0) -> InterpolatedField:
    """The chart's equations, with P from its series, and from others where Omega is beyond them.

    Parameters
    ----------
    chart : Chart
    low, high : float, optional
        How far Omega will be asked for; the chart's own range where that is enough.

    Raises
    ------
    ValueError
        As for `axes_of`.
    """
    Omega_axis, y = axes_of(chart)
    keep = getattr(chart.system, "depends_on_Omega", True) is False

    @lru_cache(maxsize=SECTIONS)
    def matrices(value: float) -> Equation:
        return chart.scenario.equation({"Omega": Omega_axis.high, y.name: value})

    def equation(Omega: float, value: float) -> Equation:
        values = {"Omega": Omega, y.name: value}
        known = matrices(value) if keep else None
        if isinstance(known, HillEquation) and not known.H:
            # F and G do not know Omega
            return known.forced(**chart.scenario.at(values)[1])
        return chart.scenario.equation(values)

    along_y = 1 - chart.axes.index(Omega_axis)
    pieces = (*chart.surface.pieces, *_beside(chart, low, high))
    section = lru_cache(maxsize=SECTIONS)(partial(_section, pieces, along_y))

    @lru_cache(maxsize=SECTIONS)
    def frequencies(value: float) -> Complex:
        middle = float(np.sqrt(Omega_axis.low * Omega_axis.high))
        return chart.scenario.frequencies({y.name: value}, middle)

    route = chart.scenario.reading.polynomials["floquet"]
    return InterpolatedField(
        equation, lambda e: route([e]).coefficients[0], chart, pieces, section, frequencies
    )


def _route_beside(chart: Chart) -> str:
    """Who evaluates P beside the chart, of the routes that it has.

    Below its Omega growth is largest: there floquet takes two runs a point, 10 ms each on the
    stepped beam at Omega = 0.1 and gamma = 0.4; the determinant 0.1 ms, and knows P better. Of
    a general equation it has no such ease.
    """
    both = chart.route == "both" and not chart.scenario.reading.general
    return "hill" if both else chart.route.replace("both", "floquet")


def _beside(chart: Chart, low: float, high: float) -> tuple[Piece, ...]:
    """Series over the Omega below and above the chart's, where a line at a time would be dear.

    Each is as wide as the chart itself in 1/Omega, at most, and so takes no more nodes.
    """
    smooth, k = chart.scenario.smooth, chart.scenario.names.index("Omega")
    first, last = smooth.span
    ends = [axis.reach for axis in chart.axes]
    found: list[Piece] = []
    route = _route_beside(chart)
    for start, end in ((1.0 / high if high else np.inf, first[k]), (last[k], 1.0 / low)):
        if start < end:
            count = int(np.ceil((end - start) / (last[k] - first[k])))
            for a, b in pairwise(np.linspace(start, end, count + 1)):
                ends[k] = 1.0 / b, 1.0 / a
                corners = smooth.rectangle(ends)
                found += fit(
                    lambda at: directly(chart, smooth.from_smooth(at), route),
                    *corners,
                    TOLERANCE,
                    partial(_worth, corners[1] - corners[0]),
                    partial(singular_across, chart.scenario),
                    kept=smooth.kept,
                ).pieces
    return tuple(found)


def _worth(whole: Float, low: Float, high: Float) -> float:
    """Nodes that a rectangle beside the chart is worth: none next to a pole."""
    return MAX_BESIDE if np.prod((high - low) / whole) >= LEAST_BESIDE else 0.0


def _section(pieces: tuple[Piece, ...], along_y: int, k: int, v: float) -> Float:
    """The series of a piece on a line of constant y, whose smooth variable is v."""
    piece = pieces[k]
    assert piece.series is not None
    low, high = piece.low[along_y], piece.high[along_y]
    local = np.array([(2.0 * v - low - high) / (high - low)])
    row = chebyshev.basis(local, piece.series.shape[1 + along_y])[0]
    return np.asarray(np.tensordot(piece.series, row, axes=(1 + along_y, 0)))
