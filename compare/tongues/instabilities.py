"""What an engineer asks of a tongue: which frequencies, how wide, from where on, how violent."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.parameters import Axis
from compare.charts.result import Chart
from compare.stability.indicators import edge_function, growth
from compare.tongues.boundaries import Tongue
from compare.tongues.on_chart import (
    ORDERS,
    OnSurface,
    axes_of,
    merged,
    on_surface,
    stations,
    tongues,
)
from hill.averaging import Resonance, half_width, modal

Float = NDArray[np.floating[Any]]
EPS = float(np.finfo(float).eps)

# Shares of an edge's own Omega at which its slope is taken; central, so it is off by their square.
SLOPE = 1e-6
INSIDE = 65
"""Points across a tongue among which its most violent one is sought."""


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
        too closely to tell.
    tips : tuple of (float, float)
        (Omega, y) where the edges meet within the chart.
    y : float
        Where the tongue is widest, apart from where it has run into another; the following numbers
        are taken there.
    width, width_Hsu : float
        Its width there, and to first order in gamma (0 for k > 1: of higher order).
    T, Omega : float
        The largest T there, and where.
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
        Those of `compare.tongues.on_chart.tongues`, if they are there already.
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
    chart: Chart, curves: OnSurface, y_axis: Axis, tongue: Tongue, others: Sequence[Tongue]
) -> Instability:
    # where two tongues have run into one another, a width is neither's
    own = np.where(merged(tongue, others), 0.0, tongue.upper - tongue.lower)
    resonance, widest = tongue.resonance, int(np.argmax(own))
    y, low, high = (float(v[widest]) for v in (tongue.y, tongue.lower, tongue.upper))
    equation = curves.equation(0.5 * (low + high), y)
    eta = equation.damping
    at = np.linspace(low, high, INSIDE)
    T = growth(curves.along(at, y), at, eta)
    tips = _tips(tongue)
    opens_at_0 = y_axis.name == "gamma" and eta == 0.0 and y_axis.low == 0.0
    if opens_at_0 and tongue.y[0] == stations(y_axis)[0]:
        tips = ((resonance.Omega(modal(equation)[0]), 0.0), *tips)
    return Instability(
        resonance=resonance,
        tongue=tongue,
        edge_error=_edge_error(chart, curves, tongue),
        tips=tips,
        y=y,
        width=high - low,
        width_Hsu=2.0 * half_width(resonance, equation) if resonance.order == 1 else 0.0,
        T=float(T.max()),
        Omega=float(at[T.argmax()]),
        critical_gamma=tips[0][1]
        if y_axis.name == "gamma" and eta > 0.0 and tips
        else float("nan"),
        critical_gamma_Hsu=_critical(resonance, equation),
    )


def _tips(tongue: Tongue) -> tuple[tuple[float, float], ...]:
    closed = np.flatnonzero(tongue.lower == tongue.upper)
    return tuple((float(tongue.lower[k]), float(tongue.y[k])) for k in closed)


def _critical(resonance: Resonance, equation: Any) -> float:
    """2 eta/sqrt(+-G_ij G_ji/(omega_i omega_j)): where Hsu's width with damping opens."""
    eta = equation.damping
    if eta <= 0.0 or resonance.order > 1:
        return float("nan")
    frequencies, G = modal(equation)
    i, j = resonance.i, resonance.j
    product = resonance.sign * (G[i, j] * G[j, i] / (frequencies[i] * frequencies[j])).real
    return float(2.0 * eta / np.sqrt(product)) if product > 0.0 else float("nan")


def _edge_error(chart: Chart, curves: OnSurface, tongue: Tongue) -> Float:
    """How far P's error can move the edges at each y, the larger of the two.

    The edge's function is smooth in P's coefficients p and in Omega: to first order its zero moves
    by sum |df/dp_j| error / |df/dOmega|. Doubled, for what the first order leaves out.
    """
    worst = np.full(len(tongue.y), 4.0 * EPS * float(np.max(tongue.upper)))
    for k, y in enumerate(map(float, tongue.y)):
        for Omega in map(float, (tongue.lower[k], tongue.upper[k])):
            eta = curves.equation(Omega, y).damping
            step = SLOPE * Omega
            nearby = Omega + step * np.array([-1.0, 0.0, 1.0])
            P = curves.along(nearby, y)
            f = edge_function(tongue.resonance.indicator, P, nearby, eta)
            slope = abs(f[2] - f[0]) / (2.0 * step)
            moved = _moved(tongue.resonance.indicator, P[1], Omega, eta, chart.error)
            # where the edges are closer than this moves them, they cannot be told apart
            bound = 2.0 * moved / slope if slope > 0.0 else np.inf
            worst[k] += bound if bound < 0.25 * (tongue.upper[k] - tongue.lower[k]) else np.inf
    return worst


def _moved(kind: str, P: Float, Omega: float, eta: float, error: float) -> float:
    """How far the function moves where every coefficient moves by `error`."""
    # a step well above rounding, and small beside P; the function is a polynomial in p
    step = max(1e-6, error)
    total = 0.0
    for j in range(1, len(P)):
        sides = np.array([P, P])
        sides[0, j] -= step
        sides[1, j] += step
        f = edge_function(kind, sides, np.full(2, Omega), eta)
        total += abs(f[1] - f[0]) / (2.0 * step)
    return total * error
