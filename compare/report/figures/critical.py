"""Figures 11 to 14 and 20 to 23: T_x against gamma, and the thrusts and ratios where T is zero."""

from collections.abc import Callable

import numpy as np

from compare.report.figures.beams import (
    at_resonance,
    beam_of,
    interior,
    point_count,
    printed,
    same_resonance,
)
from compare.report.figures.catalogue import Figure
from compare.report.figures.data import FigureData, Float, Series, largest
from compare.report.figures.regions import FINEST
from compare.report.one_route import RouteName, T_of, equation, solve
from compare.report.tables import GAMMA
from compare.stability.indicators import Function, crossings, interpolate, zero

TOP, BOTTOM = "T_x", "critical"
# Grid of gamma on which the first unstable one is looked for.
FINE = 301
# The smallest thrust: below it the rotation is slower than there is anything to see.
LEAST_T0 = 0.25
# Halvings of a step in T0 towards the thrust at which the curve leaves the range.
HALVINGS = 5


def critical_values(figure: Figure, detail: float = 1.0) -> FigureData:
    """Curves from the monodromy matrix, marks from Hill's determinant."""
    gamma_end = figure.span[1]
    series: list[Series] = []
    differences = []
    gammas = np.linspace(0.0, gamma_end, point_count(121, detail))
    for T0 in figure.values:
        Omega = _resonance(figure, T0)
        P = interpolate(_along_gamma("floquet", figure, T0, Omega), 0.0, gamma_end)
        T = T_of("floquet", P(gammas), Omega)
        chosen = interior(len(gammas), 4)
        at_marks = _along_gamma("hill", figure, T0, Omega)(gammas[chosen])
        marks = T_of("hill", at_marks, Omega)
        name = f"T0 = {T0:g}"
        series.append(Series(name, "curve", "floquet", gammas, T, panel=TOP))
        series.append(Series(name, "mark", "hill", gammas[chosen], marks, panel=TOP))
        differences.append(marks - T[chosen])
    T_printed = [r.T for r in printed(figure) if same_resonance(r.resonance, figure.resonance)]
    source = f"Table {figure.table}"
    x, y = np.full(len(T_printed), GAMMA), np.array(T_printed)
    series.append(Series("T0 = 20", "printed", source, x, y, panel=TOP))
    series += _envelope(figure, detail)
    return FigureData(figure.number, tuple(series), "T", largest(differences))


def _resonance(figure: Figure, T0: float) -> float:
    return at_resonance(figure.resonance, beam_of(figure, T0=T0))


def _along_gamma(
    route: RouteName, figure: Figure, T0: float, Omega: float, eta: float = 0.0
) -> Callable[[Float], Float]:
    """P at one thrust and the resonance's Omega, as a function of gamma."""
    beam = beam_of(figure, T0=T0)

    def P(gammas: Float) -> Float:
        return solve(route, [equation(route, beam, Omega, float(x), eta) for x in gammas])

    return P


def _envelope(figure: Figure, detail: float) -> list[Series]:
    """For every thrust the smallest gamma that is unstable with damping; T0 is the x here."""
    highest, end = 24.0 if figure.stepped else 25.0, figure.span[1]
    # what crosses 2 omega_(B) makes its envelope intricate
    count = point_count(121 if figure.resonance == "2 omega_(B)" else 49, detail, 9)
    found: dict[float, float | None] = {}
    before = LEAST_T0
    for T0 in map(float, np.linspace(LEAST_T0, highest, count)):
        here = _smallest(figure, T0)
        if found and (here is None) != (found[before] is None):
            found |= _closing(figure, *((before, T0) if here else (T0, before)))
        found[T0] = here
        before = T0
    T0s = np.array([0.0, *sorted(found)])
    gammas = np.array([end] + [found[T0] or end for T0 in T0s[1:]])
    stable = Series("stable", "region", "floquet", T0s, 0.0 * T0s, gammas, panel=BOTTOM)
    series, name = [stable], f"eta = {figure.eta:g}"
    inside = gammas < end
    for piece in np.split(np.arange(len(T0s)), np.flatnonzero(np.diff(inside)) + 1):
        if len(piece) > 1 and inside[piece[0]]:
            x, y = T0s[piece], gammas[piece]
            series.append(Series(name, "curve", "floquet", x, y, panel=BOTTOM))
            chosen = interior(len(piece), 5 if x[-1] - x[0] > 4.0 else 1)
            marks = np.array([_by_hill(figure, x[i], y[i]) for i in chosen])
            series.append(Series(name, "mark", "hill", x[chosen], marks, panel=BOTTOM))
    return series


def _closing(figure: Figure, absent: float, present: float) -> dict[float, float | None]:
    """Smallest unstable gammas at thrusts halved towards that beyond which there is none."""
    found: dict[float, float | None] = {}
    for _ in range(HALVINGS):
        middle = 0.5 * (absent + present)
        found[middle] = _smallest(figure, middle)
        if found[middle] is None:
            absent = middle
        else:
            present = middle
    return found


def _damped(figure: Figure, T0: float, route: RouteName) -> Function:
    """T of the damped equation at the resonance, as a function of gamma."""
    Omega = _resonance(figure, T0)
    P = _along_gamma(route, figure, T0, Omega, figure.eta)
    return lambda gammas: T_of(route, P(gammas), Omega, figure.eta)


def _smallest(figure: Figure, T0: float) -> float | None:
    """The smallest gamma that is unstable, or None within the range."""
    Omega, end = _resonance(figure, T0), figure.span[1]
    P = interpolate(_along_gamma("floquet", figure, T0, Omega, figure.eta), 0.0, end)

    def decay(x: Float) -> Float:
        return -T_of("floquet", P(x), Omega, figure.eta)

    falls, _ = crossings(decay, np.linspace(0.0, end, FINE))
    return falls[0] if falls else None


def _by_hill(figure: Figure, T0: float, gamma: float) -> float:
    """The smallest unstable gamma by the determinant, from a bracket about the known one."""
    T = _damped(figure, T0, "hill")
    return zero(T, 0.99 * gamma, 1.01 * gamma, rtol=FINEST)
