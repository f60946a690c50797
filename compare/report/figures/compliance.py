"""Figure 26, T_x against the longitudinal frequency, and Figure 27, an element of G."""

from functools import partial

import numpy as np

from compare.report.figures.beams import (
    at_resonance,
    beam_of,
    interior,
    point_count,
    printed,
    same_resonance,
)
from compare.report.figures.catalogue import ORDER, Figure
from compare.report.figures.data import FigureData, Float, Series, largest
from compare.report.figures.sampling import adaptive
from compare.report.one_route import RouteName, T_of, equation, integral_of_force, solve
from compare.report.tables import GAMMA
from hill import UniformBeam

# The top of Figure 26. Marks keep below it: where P spans twenty powers of ten, Hill's route says
# that it cannot tell.
HIGHEST = 0.12
# Nearest to the pole, as a share of the resonance: closer by, T_x goes up and down many times.
CLOSEST = 1e-2
# Curves start at this share of Omega: the bar's second resonance is at one half.
START = 0.75


def of_longitudinal_frequency(figure: Figure, detail: float = 1.0) -> FigureData:
    """Figure 26: curves from the monodromy matrix, marks from Hill's determinant."""
    series: list[Series] = []
    differences = []
    for name in ORDER:
        Omega = at_resonance(name, beam_of(figure))

        def T_x(route: RouteName, omega_L: Float, Omega: float = Omega) -> Float:
            beams = [beam_of(figure, omega_L=float(x)) for x in omega_L]
            P = solve(route, [equation(route, b, Omega, GAMMA) for b in beams])
            return T_of(route, P, Omega)

        count, far = point_count(24, detail, 8), figure.span[1] / Omega - 1.0
        below = Omega * (1.0 - np.geomspace(CLOSEST, 1.0 - START, count)[::-1])
        above = Omega * (1.0 + np.geomspace(CLOSEST, far, count))
        for start in (below, above):
            omega_L, y = adaptive(partial(T_x, "floquet"), start, HIGHEST)
            series.append(Series(name, "curve", "floquet", omega_L, y))
            shown = np.flatnonzero((y < HIGHEST) & (y > 0.0))
            chosen = shown[interior(len(shown), 4)]
            marks = T_x("hill", omega_L[chosen]) if len(chosen) else omega_L[:0]
            series.append(Series(name, "mark", "hill", omega_L[chosen], marks))
            differences.append(marks - y[chosen])
        own = [r for r in printed(figure) if same_resonance(_as_labelled(r.resonance), name)]
        x = np.array([r.omega_L for r in own])
        y = np.array([r.T for r in own])
        series.append(Series(name, "printed", f"Table {figure.table}", x, y))
    return FigureData(figure.number, tuple(series), "T", largest(differences))


def _as_labelled(resonance: str) -> str:
    """Table 3 labels 1.100 as omega_(1) + omega_(2); it is omega_(B) + omega_(1)."""
    return "omega_(B) + omega_(1)" if resonance == "omega_(1) + omega_(2)" else resonance


def integral(figure: Figure, detail: float = 1.0) -> FigureData:
    """Figure 27: Re of the integral of Phi*, out of each route's G_(N+1,N+1)."""
    series: list[Series] = []
    differences = []
    for g in figure.values:
        # tan(z/2)/z has its poles at odd multiples of pi: resonance at sigma = 2 leaves no trace
        steps = np.geomspace(1e-3, 0.999, point_count(60, detail, 8))
        sides = [1.0 - steps[::-1], 1.0 + steps]
        pieces = sides if g == 0.0 else [np.concatenate([sides[0], [1.0], sides[1]])]
        for sigma in pieces:
            y = _phi(figure, "hill", sigma, g)
            series.append(Series(f"g = {g:g}", "curve", "hill", sigma, y))
            chosen = interior(len(sigma), 9)
            marks = _phi(figure, "floquet", sigma[chosen], g)
            series.append(Series(f"g = {g:g}", "mark", "floquet", sigma[chosen], marks))
            differences.append(marks - y[chosen])
    return FigureData(figure.number, tuple(series), "the integral", largest(differences))


def _phi(figure: Figure, route: RouteName, sigma: Float, g: float) -> Float:
    """Re of the integral by one route, bar and forcing at omega_L = 1."""
    beam = beam_of(figure, omega_L=1.0, g=g)
    assert isinstance(beam, UniformBeam)
    return np.array([integral_of_force(route, beam, float(x)).real for x in sigma])
