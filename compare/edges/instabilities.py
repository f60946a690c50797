"""What an engineer asks of a tongue: its frequencies, width, tips, and the largest T in it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.axis import Axis
from compare.charts.result import Chart
from compare.edges.interpolated import InterpolatedField, axes_of, on_surface
from compare.edges.on_chart import ORDERS, merged, stations, tongues
from compare.edges.tongue import Tongue
from compare.stability.indicators import ZERO_SHARE, ZERO_TO
from hill.averaging import Resonance
from hill.oscillations.expected import critical_gamma, damping, half_width

Float = NDArray[np.floating[Any]]
EdgeFunction = Callable[[Float, Float, float], Float]
EPS = float(np.finfo(float).eps)

# Shares of an edge's own Omega at which its slope is taken; central, so it is off by their square.
SLOPE = 1e-6
INSIDE = 65
"""Points across a tongue among which the one of the largest T is sought."""


@dataclass(frozen=True, eq=False)
class Instability:
    """One instability of a chart of Omega and another parameter y.

    Attributes
    ----------
    resonance : Resonance
        Its name, type (I or II), order k, the frequencies and whether they add.
    tongue : Tongue
        Its two edges in Omega along y.
    edge_error : (k,) ndarray
        Bound on the error of the edges at each y of the tongue, from P's; infinite where they meet
        too closely to tell, or where another instability has taken the place of an edge.
    tips : tuple of (float, float)
        (Omega, y) where the edges meet within the chart.
    y : float
        Where the tongue is widest, apart from where it has run into another; the following numbers
        are taken there.
    width, width_Hsu : float
        Its width there, and what averaging expects: of Hill's equation to first order in gamma, 0
        for k > 1.
    T, T_error, Omega : float
        The largest T there, a bound on its error, and where.
    critical_gamma, critical_gamma_Hsu : float
        The gamma from which damping is overcome: the tip's, on a chart of gamma with eta > 0, and
        to first order; nan where there is none.
    """

    resonance: Resonance
    tongue: Tongue
    edge_error: Float
    tips: tuple[tuple[float, float], ...]
    y: float
    width: float
    width_Hsu: float
    T: float
    T_error: float
    Omega: float
    critical_gamma: float
    critical_gamma_Hsu: float


def instabilities(
    chart: Chart, boundaries: tuple[Tongue, ...] | None = None, orders: int = ORDERS
) -> tuple[Instability, ...]:
    """The instabilities of a chart of Omega and another parameter, widest first.

    Those narrower than the error of their edges are left out.

    Parameters
    ----------
    chart : Chart
    boundaries : tuple of Tongue, optional
        Those of `compare.tongues`, if they are there already.
    orders : int, optional
        Resonances up to this order k, where `boundaries` are not given.

    Raises
    ------
    ValueError
        The chart is not one of Omega and one other parameter.
    """
    _, y = axes_of(chart)
    curves = on_surface(chart)
    found = tongues(chart, orders) if boundaries is None else boundaries
    described = [_described(chart, curves, y, tongue, found) for tongue in found]
    seen = [i for i in described if i.edge_error.min() < 0.25 * i.width]
    return tuple(sorted(seen, key=lambda i: -i.width))


def _described(
    chart: Chart, curves: InterpolatedField, y_axis: Axis, tongue: Tongue, others: Sequence[Tongue]
) -> Instability:
    # where two tongues have run into one another, a width is neither's
    own = np.where(merged(tongue, others), 0.0, tongue.upper - tongue.lower)
    resonance, widest = tongue.resonance, int(np.argmax(own))
    y, low, high = (float(v[widest]) for v in (tongue.y, tongue.lower, tongue.upper))
    equation = curves.equation(0.5 * (low + high), y)
    eta = damping(resonance, equation)
    _, forcing = chart.scenario.at({"Omega": 0.5 * (low + high), y_axis.name: y})
    at = np.linspace(low, high, INSIDE)
    P, errors = curves.known(at, y)
    T = curves.reading.growth(P, at, eta)
    top = slice(int(T.argmax()), int(T.argmax()) + 1)
    tips = _tips(tongue)
    opens_at_0 = y_axis.name == "gamma" and eta == 0.0 and y_axis.low == 0.0
    if opens_at_0 and tongue.y[0] == stations(y_axis)[0]:
        tips = ((resonance.Omega(curves.frequencies(y)), 0.0), *tips)
    return Instability(
        resonance=resonance,
        tongue=tongue,
        edge_error=_edge_error(curves, tongue),
        tips=tips,
        y=y,
        width=high - low,
        width_Hsu=2.0 * half_width(resonance, equation)
        if resonance.order == 1 or curves.reading.general
        else 0.0,
        T=float(T.max()),
        T_error=float(
            curves.reading.argument_errors(P[top], errors[top], T[top], at[top], np.array([eta]))[0]
        ),
        Omega=float(at[T.argmax()]),
        critical_gamma=tips[0][1]
        if y_axis.name == "gamma" and eta > 0.0 and tips
        else float("nan"),
        critical_gamma_Hsu=critical_gamma(resonance, equation, forcing["gamma"]),
    )


def _tips(tongue: Tongue) -> tuple[tuple[float, float], ...]:
    closed = np.flatnonzero(tongue.lower == tongue.upper)
    return tuple((float(tongue.lower[k]), float(tongue.y[k])) for k in closed)


def _edge_error(curves: InterpolatedField, tongue: Tongue) -> Float:
    """How far P's error can move the edges at each y, the larger of the two.

    The edge's function is smooth in P's coefficients p and in Omega: to first order its zero moves
    by sum |df/dp_j| error / |df/dOmega|. Doubled, for what the first order leaves out. Infinite
    where the function does not change sign within it: where two instabilities have run into one
    another what is left of an edge need not be one of this kind.
    """
    kind, edge_function = tongue.resonance.indicator, curves.reading.edge_function
    # what the edges were solved to, and an ulp or two of them
    found_to = ZERO_TO + (ZERO_SHARE + 4.0 * EPS) * float(np.max(tongue.upper))
    worst = np.full(len(tongue.y), found_to)
    for k, y in enumerate(map(float, tongue.y)):
        for Omega in map(float, (tongue.lower[k], tongue.upper[k])):
            eta = damping(tongue.resonance, curves.equation(Omega, y))
            step = SLOPE * Omega
            nearby = Omega + step * np.array([-1.0, 0.0, 1.0])
            P, errors = curves.known(nearby, y)
            f = edge_function(kind, P, nearby, eta)
            slope = abs(f[2] - f[0]) / (2.0 * step)
            moved = _moved(partial(edge_function, kind), P[1], Omega, eta, float(errors.max()))
            # where the edges are closer than this moves them, they cannot be told apart
            bound = 2.0 * moved / slope if slope > 0.0 else np.inf
            if bound < 0.25 * (tongue.upper[k] - tongue.lower[k]):
                sides = Omega + (found_to + bound) * np.array([-1.0, 1.0])
                at_sides = edge_function(kind, curves.known(sides, y)[0], sides, eta)
                bound = bound if np.prod(np.sign(at_sides)) < 0.0 else np.inf
            else:
                bound = np.inf
            worst[k] += bound
    return worst


def _moved(f: EdgeFunction, P: Float, Omega: float, eta: float, error: float) -> float:
    """How far the function moves where every coefficient moves by `error`."""
    # a step well above rounding, and small beside P; the function is a polynomial in p
    step = max(1e-6, error)
    total = 0.0
    for j in range(1, len(P)):
        sides = np.array([P, P])
        sides[0, j] -= step
        sides[1, j] += step
        values = f(sides, np.full(2, Omega), eta)
        total += abs(values[1] - values[0]) / (2.0 * step)
    return total * error
