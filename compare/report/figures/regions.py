"""Regions of instability in Omega and T0 or gamma: Figures 9, 10, 15, 16 and 18, 19, 24, 25."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from compare.edges.tongue import Tongue
from compare.edges.tracer import TongueTracer, follow
from compare.report.figures.beams import RESONANCES, THIRD, family_of, point_count, printed
from compare.report.figures.catalogue import FIGURES, Figure
from compare.report.figures.data import FigureData, Float, Series, largest
from compare.report.tables import GAMMA, number
from compare.stability.indicators import Function, indicator, zero
from hill.averaging import Resonance, half_width

# Below this share of the widest tongue, first-order theory is taken to give none.
NEGLIGIBLE_WIDTH = 1e-6
# A mark is solved for within these shares of the tongue's width about the curve, the first that
# brackets a sign change: a wide bracket may hold the edge of a narrow tongue of higher order.
BRACKETS = (1e-4, 1e-3, 1e-2)
MARKS = 3
# Share of the thrusts from which sections are three times as close.
BENDS = 0.6
# As near as a float is to the zero: marks are held against the curves.
FINEST = 4.0 * float(np.finfo(float).eps)


def instability_regions(figure: Figure, detail: float = 1.0) -> FigureData:
    """Curves from the monodromy matrix, marks from Hill's determinant."""
    found = tongues(_undamped(figure), detail)
    shown = tongues(figure.number, detail) if figure.eta else found
    series = [s for t in found if figure.eta for s in [as_series(t, "outline")]]
    series += [as_series(tongue, tongue.resonance.name) for tongue in shown]
    differences = []
    for tongue in shown:
        y, lower, upper, difference = marks(figure, tongue, count=point_count(MARKS, detail, 1))
        name = tongue.resonance.name
        series.append(Series(name, "mark", "hill", y, lower, upper, panel=name))
        differences.append(difference)
    series += _printed(figure)
    return FigureData(figure.number, tuple(series), "Omega", largest(differences))


def _undamped(figure: Figure) -> int:
    """The number of the figure without damping."""
    return figure.number - 6 if figure.eta else figure.number


def as_series(tongue: Tongue, name: str) -> Series:
    """A tongue on the axes of its resonance."""
    return Series(
        name,
        "region" if name != "outline" else "curve",
        "floquet",
        tongue.y,
        tongue.lower,
        tongue.upper,
        panel=tongue.resonance.name,
    )


@lru_cache(maxsize=16)
def tongues(number: int, detail: float) -> tuple[Tongue, ...]:
    """Every tongue of a figure, by resonance; kept, since a damped figure needs the undamped."""
    figure = FIGURES[number]
    family = family_of(figure, "floquet", figure.eta)
    within = tongues(_undamped(figure), detail) if figure.eta else ()
    found: list[Tongue] = []
    for resonance in RESONANCES:
        if resonance == THIRD and not figure.stepped:
            continue
        own = [t for t in within if t.resonance == resonance]
        if (own or not figure.eta) and expects_width(figure, resonance):
            found += follow(family, resonance, section_parameters(figure, resonance, detail), own)
    return tuple(found if figure.eta else [ended_at_zero(figure, tongue) for tongue in found])


def section_parameters(
    figure: Figure,
    resonance: Resonance,
    detail: float,
    near: tuple[float, ...] = (0.03, 0.12, 0.3, 0.6),
) -> list[float]:
    """Values of T0 or gamma, closer where the tongue turns, below buckling and `near` zero.

    What is near zero is in steps of the others.
    """
    lo, hi = figure.span
    bent = resonance in (RESONANCES[0], THIRD)
    count = point_count(49 if bent else 25, detail, 9)
    even = np.linspace(lo, hi, count + 1)[1:]
    # the frequency of rotation starts like the square root of T0
    rotates = resonance.j == 0 and figure.along == "T0"
    near_zero = even[0] * np.array(near) if rotates else []
    # and ends like that of the distance from buckling, a little beyond the axis
    bends = even[:-1][even[:-1] >= BENDS * hi] if rotates else np.empty(0)
    between = np.ravel(bends[:, None] + (even[1] - even[0]) * np.array([1.0, 2.0]) / 3.0)
    return [float(v) for v in np.sort([*near_zero, *even, *between])]


def expects_width(figure: Figure, resonance: Resonance) -> bool:
    """Whether first-order theory gives a width, anywhere; the third order it does not describe."""
    family = family_of(figure, "hill")
    if resonance == THIRD:
        return True
    widths = []
    for y in np.linspace(*figure.span, 8)[1:]:
        Omega = TongueTracer(family, resonance).Omega(float(y))
        if Omega > 0.0:
            widths.append(half_width(resonance, family.equation(Omega, float(y))) / Omega)
    return max(widths, default=0.0) > NEGLIGIBLE_WIDTH


def ended_at_zero(figure: Figure, tongue: Tongue) -> Tongue:
    """The tongue continued to zero thrust or pulsation, where it closes on its resonance."""
    step = figure.span[1] / 8.0
    if tongue.y[0] > step:
        return tongue
    family = family_of(figure, "floquet")
    Omega = TongueTracer(family, tongue.resonance).Omega(0.0)
    return Tongue(
        tongue.resonance,
        np.append(0.0, tongue.y),
        np.append(Omega, tongue.lower),
        np.append(Omega, tongue.upper),
    )


def marks(
    figure: Figure, tongue: Tongue, g: float = 0.0, count: int = MARKS
) -> tuple[Float, Float, Float, Float]:
    """Some of the edges by the other route, and by how much they differ."""
    family = family_of(figure, "hill", figure.eta, g)
    wide = np.flatnonzero(tongue.upper - tongue.lower > 1e-4 * tongue.upper)
    short = tongue.y[-1] - tongue.y[0] < 0.25 * (figure.span[1] - figure.span[0])
    chosen = evenly_spaced(wide, tongue.y, 1 if short else count)
    kind = tongue.resonance.indicator
    solved: list[list[float]] = []
    for i in chosen:
        y, width = float(tongue.y[i]), float(tongue.upper[i] - tongue.lower[i])

        def f(Omega: Float, y: float = y) -> Float:
            return indicator(kind, family.along(Omega, y), Omega, figure.eta)

        solved.append([nearest_zero(f, float(e[i]), width) for e in (tongue.lower, tongue.upper)])
    edges = np.array(solved).reshape(-1, 2).T
    difference = edges - np.array([tongue.lower[chosen], tongue.upper[chosen]])
    return tongue.y[chosen], edges[0], edges[1], difference


def evenly_spaced(indices: NDArray[np.intp], y: Float, count: int) -> NDArray[np.intp]:
    """Some of these points at about equal distances in y."""
    if not len(indices):
        return indices
    first, last = y[indices[0]], y[indices[-1]]
    targets = first + (last - first) * np.arange(1, count + 1) / (count + 1)
    return np.unique([indices[np.abs(y[indices] - t).argmin()] for t in targets])


def nearest_zero(f: Function, near: float, width: float) -> float:
    """The zero of f nearest to a known edge, in ever wider brackets about it.

    Raises
    ------
    ValueError
        There is none: the routes disagree.
    """
    for share in BRACKETS:
        lo, hi = near - share * width, near + share * width
        if np.prod(f(np.array([lo, hi]))) < 0.0:
            return zero(f, lo, hi, xtol=1e-14, rtol=FINEST)
    raise ValueError(f"Omega = {near:g}: the routes disagree about this edge")


def _printed(figure: Figure) -> list[Series]:
    """The table's forcing frequencies at its T0 and gamma: unstable, or printed with T = 0."""
    value = figure.beam["T0"] if figure.along == "T0" else GAMMA
    rows = [(number(row.Omega_printed), figure.eta < row.T) for row in printed(figure)]
    series = []
    for sign, unstable in ((">", True), ("<=", False)):
        y = [Omega for Omega, grows in rows if grows == unstable]
        label = f"T {sign} {figure.eta:g}"
        series.append(
            Series(label, "printed", f"Table {figure.table}", np.full(len(y), value), np.array(y))
        )
    return series
