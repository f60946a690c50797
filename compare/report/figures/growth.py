"""T against Omega: Figures 8 and 17 near every resonance, Figure 28 near a longitudinal one."""

from functools import partial
from itertools import pairwise

import numpy as np

from compare.report.figures.beams import (
    at_resonance,
    beam_of,
    interior,
    nearest,
    point_count,
    printed,
    resonance_named,
)
from compare.report.figures.catalogue import ORDER, Figure
from compare.report.figures.data import FigureData, Float, Series, largest
from compare.report.figures.sampling import adaptive
from compare.report.one_route import Beam, RouteName, T_of, equation, solve
from compare.report.tables import GAMMA, Row, number
from compare.stability.indicators import Function, crossings, interpolate_in_Omega
from hill.averaging import half_width

# T below this is zero: z at the edge of a tongue is known to 1e-14, and T like its square root.
NOTHING = 1e-6
# Grid on which unstable intervals are looked for, as a share of the window: 1/1500.
FINE = 1501
# A window's half width in Hsu's half widths; and the least, to show something of a narrow tongue.
REACH, LEAST = 1.75, 0.008
# Figure 28: the top of its axis, and the start's nearest point to the pole, as a share of its side.
HIGHEST, CLOSEST = 0.5, 0.01


def near_resonances(figure: Figure, detail: float = 1.0) -> FigureData:
    """Figures 8 and 17: curves from Hill's determinant, marks from the monodromy matrix."""
    beam = beam_of(figure)
    centres = {name: at_resonance(name, beam) for name in ORDER}
    series: list[Series] = []
    differences = []
    for name, centre in centres.items():
        width = half_width(resonance_named(name), equation("hill", beam, centre, GAMMA))
        reach = max(REACH * width, LEAST)
        own = [
            row
            for row in printed(figure)
            if nearest(_Omega(row), centres) == name and abs(_Omega(row) - centre) < 3.0 * reach
        ]
        lo = min([centre - reach, *(_Omega(row) - 0.1 * reach for row in own)])
        hi = max([centre + reach, *(_Omega(row) + 0.1 * reach for row in own)])
        for eta in (0.0, figure.eta):
            x, y = _curve(beam, eta, lo, hi, detail)
            series.append(Series(name, "curve", "hill", x, y, panel=name, damped=eta > 0.0))
            if eta == 0.0:
                unstable = np.flatnonzero(y > NOTHING)
                chosen = unstable[interior(len(unstable), 7)]
                other = [equation("floquet", beam, float(v), GAMMA) for v in x[chosen]]
                T = T_of("floquet", solve("floquet", other), x[chosen])
                series.append(Series(name, "mark", "floquet", x[chosen], T, panel=name))
                differences.append(T - y[chosen])
        x, y = np.array([_Omega(row) for row in own]), np.array([row.T for row in own])
        series.append(Series(name, "printed", f"Table {figure.table}", x, y, panel=name))
    return FigureData(figure.number, tuple(series), "T", largest(differences))


def _Omega(row: Row) -> float:
    return number(row.Omega_printed)


def _curve(beam: Beam, eta: float, lo: float, hi: float, detail: float) -> tuple[Float, Float]:
    """T by Hill's determinant, whose P is interpolated."""

    def exact(x: Float) -> Float:
        return solve("hill", [equation("hill", beam, float(v), GAMMA, eta) for v in x])

    P = interpolate_in_Omega(exact, lo, hi)
    x = stations(lambda s: T_of("hill", P(s), s), lo, hi, detail)
    return x, T_of("hill", P(x), x, eta)


def stations(T: Function, lo: float, hi: float, detail: float) -> Float:
    """Where to evaluate T: crowded towards both ends of every unstable interval."""
    falls, rises = crossings(lambda s: NOTHING - T(s), np.linspace(lo, hi, FINE))
    ends = sorted({lo, hi, *falls, *rises})
    points = [lo]
    for a, b in pairwise(ends):
        count = point_count(60, detail) if T(np.array([0.5 * (a + b)]))[0] > NOTHING else 4
        points.extend(0.5 * (a + b - (b - a) * np.cos(np.pi * np.arange(1, count + 1) / count)))
    return np.array(points)


def near_longitudinal_resonance(figure: Figure, detail: float = 1.0) -> FigureData:
    """Figure 28: curves from the monodromy matrix, marks from Hill's determinant."""
    series: list[Series] = []
    differences = []
    for g in figure.values:
        beam = beam_of(figure, g=g)

        def T(route: RouteName, x: Float, beam: Beam = beam) -> Float:
            P = solve(route, [equation(route, beam, float(v), GAMMA) for v in x])
            return T_of(route, P, x)

        for part in _sides(figure, g, detail):
            x, y = adaptive(partial(T, "floquet"), part, HIGHEST)
            series.append(Series(f"g = {g:g}", "curve", "floquet", x, y))
            shown = np.flatnonzero((y > NOTHING) & (y < HIGHEST))
            chosen = shown[interior(len(shown), 6)]
            marks = T("hill", x[chosen]) if len(chosen) else x[:0]
            series.append(Series(f"g = {g:g}", "mark", "hill", x[chosen], marks))
            differences.append(marks - y[chosen])
    return FigureData(figure.number, tuple(series), "T", largest(differences))


def _sides(figure: Figure, g: float, detail: float) -> list[Float]:
    """Points to start from on both sides of the resonance; not at it where G has a pole there."""
    (lo, hi), pole = figure.span, figure.omega_L
    steps = np.geomspace(CLOSEST, 1.0, point_count(24, detail, 9))
    below, above = (pole + (end - pole) * steps for end in (lo, hi))
    if g == 0.0:
        return [below[::-1], above]
    return [np.append(below[::-1], pole), np.append(pole, above)]
