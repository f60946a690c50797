"""Figure 29: regions of instability with a longitudinal resonance among them."""

from dataclasses import dataclass

import numpy as np

from compare.edges.tongue import Tongue
from compare.edges.tracer import follow
from compare.report.figures.beams import RESONANCES, beam_of, family_of, point_count
from compare.report.figures.catalogue import Figure
from compare.report.figures.data import FigureData, Float, Series, largest
from compare.report.figures.regions import (
    ended_at_zero,
    expects_width,
    marks,
    nearest_zero,
    section_parameters,
)
from compare.report.one_route import RouteName, equation, solve
from compare.report.tables import GAMMA
from compare.stability.indicators import crossings, indicator, zero
from hill.averaging import Resonance

SLOW = Resonance(0, 0)
# From outside towards an undamped pole, each distance this share of the one before, to this one.
APPROACH, NEAREST = 0.8, 1e-3
# Points across the window where the pole is damped away.
GRID = 41
# Halvings of a step in T0 towards the thrust at which a region begins.
HALVINGS = 6


@dataclass(frozen=True)
class Window:
    """A longitudinal resonance, the interval of Omega about it, and what changes sign there.

    At omega_L the diagonal of G has its pole, at 2 omega_L the rest of it (section 7.3.2): the
    instability beside the first is of type I, beside the second of type II.
    """

    name: str
    kind: str
    pole: float
    lo: float
    hi: float


def windows(omega_L: float) -> tuple[Window, ...]:
    """Omega = omega_L, into which 2 omega_(1) leads, and Omega = 2 omega_L."""
    first, second = "2 omega_(1) and omega_L", "2 omega_L"
    return (
        Window(first, "-1", omega_L, 0.75 * omega_L, 1.2 * omega_L),
        Window(second, "pair", 2.0 * omega_L, 1.95 * omega_L, 2.05 * omega_L),
    )


def coupled_regions(figure: Figure, detail: float = 1.0) -> FigureData:
    """Curves from the monodromy matrix, marks from Hill's determinant."""
    series: list[Series] = []
    differences = []
    count = point_count(16, detail, 6)
    # closer at small thrust, where the regions open
    ys = [figure.span[1] * (k / count) ** 1.5 for k in range(1, count + 1)]
    for g in figure.values:
        for resonance in RESONANCES:
            if (resonance.i, resonance.j) == (1, 1) or not expects_width(figure, resonance):
                continue
            # slow where the forcing is
            share, near = (0.3, (0.08, 0.35)) if resonance == SLOW else (0.7, (0.08, 0.35, 0.65))
            T0s = section_parameters(figure, resonance, share * detail, near)
            for tongue in follow(family_of(figure, "floquet", g=g), resonance, T0s):
                piece = ended_at_zero(figure, tongue)
                y, lower, upper, difference = marks(figure, tongue, g, 2)
                series += _both(g, resonance.name, piece, np.append(y, y), np.append(lower, upper))
                differences.append(difference)
        for window in windows(figure.omega_L):
            for edges in about(figure, window, g, ys):
                y, solved, difference = _marks(figure, window, g, edges)
                series += _both(g, window.name, edges, y, solved)
                differences.append(difference)
    return FigureData(figure.number, tuple(series), "Omega", largest(differences))


@dataclass(frozen=True, eq=False)
class Piece:
    """A region's two edges; at an undamped pole one of them is the pole."""

    y: Float
    lower: Float
    upper: Float


def about(figure: Figure, window: Window, g: float, ys: list[float]) -> list[Piece]:
    """Regions about a longitudinal resonance: its two sides, where the pole is not damped away."""
    if g > 0.0:
        found = {y: pair for y in ys if (pair := across(figure, window, g, y))}
        found |= _beginning(figure, window, g, ys, min(found)) if found else {}
        return [_piece(found)] if found else []
    pieces = []
    for side, end in ((-1, window.lo), (1, window.hi)):
        found = {0.0: (window.pole, window.pole)}
        distance = abs(end - window.pole)
        for y in reversed(ys):  # wide to narrow
            edge_found = towards_pole(figure, window, side * distance, y)
            found[y] = (min(edge_found, window.pole), max(edge_found, window.pole))
            distance = min(distance, 1.25 * abs(edge_found - window.pole))
        pieces.append(_piece(found))
    return pieces


def _piece(found: dict[float, tuple[float, float]]) -> Piece:
    y = sorted(found)
    lower, upper = np.array([found[v] for v in y]).T
    return Piece(np.array(y), lower, upper)


def _beginning(
    figure: Figure, window: Window, g: float, ys: list[float], first: float
) -> dict[float, tuple[float, float]]:
    """Sections towards the thrust at which the region begins, by halving."""
    below, above = max((y for y in ys if y < first), default=0.0), first
    found = {}
    for _ in range(HALVINGS):
        middle = 0.5 * (below + above)
        pair = across(figure, window, g, middle)
        if pair is None:
            below = middle
        else:
            above, found[middle] = middle, pair
    return found


def across(figure: Figure, window: Window, g: float, T0: float) -> tuple[float, float] | None:
    """First and last unstable Omega of a window whose pole is damped away."""

    def f(x: Float) -> Float:
        return inside(figure, window, "floquet", g, T0, x)

    falls, rises = crossings(f, np.linspace(window.lo, window.hi, GRID))
    return (falls[0], rises[-1]) if falls and rises else None


def towards_pole(figure: Figure, window: Window, start: float, T0: float) -> float:
    """The first unstable Omega on the way to an undamped pole, from a distance with its sign.

    Raises
    ------
    ValueError
        All is stable to within `NEAREST` of the pole.
    """

    def f(x: Float) -> Float:
        return inside(figure, window, "floquet", 0.0, T0, x)

    distance, pole = start, window.pole
    while f(np.array([pole + APPROACH * distance]))[0] >= 0.0:
        distance *= APPROACH
        if abs(distance) < NEAREST:
            raise ValueError(f"T0 = {T0:g}: no instability beside Omega = {pole:g}")
    return zero(f, *sorted((pole + distance, pole + APPROACH * distance)))


def inside(
    figure: Figure, window: Window, route: RouteName, g: float, T0: float, Omega: Float
) -> Float:
    """The window's indicator at many Omega by one route: negative where unstable."""
    beam = beam_of(figure, T0=T0, g=g)
    P = solve(route, [equation(route, beam, float(x), GAMMA) for x in Omega])
    return indicator(window.kind, P, Omega)


def _marks(figure: Figure, window: Window, g: float, piece: Piece) -> tuple[Float, Float, Float]:
    """Some of the edges by the other route; a pole is no edge to solve for."""
    found = []
    for i in (len(piece.y) // 2, len(piece.y) - 2):
        width = float(piece.upper[i] - piece.lower[i])

        def f(x: Float, y: float = float(piece.y[i])) -> Float:
            return inside(figure, window, "hill", g, y, x)

        for e in (float(piece.lower[i]), float(piece.upper[i])):
            if e != window.pole:
                solved = nearest_zero(f, e, width)
                found.append((float(piece.y[i]), solved, solved - e))
    y, edges, differences = np.array(found).T
    return y, edges, differences


def _both(g: float, panel: str, piece: Piece | Tongue, x: Float, y: Float) -> list[Series]:
    name = f"g = {g:g}"
    region = Series(name, "region", "floquet", piece.y, piece.lower, piece.upper, panel=panel)
    return [region, Series(name, "mark", "hill", x, y, panel=panel)]
