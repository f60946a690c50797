"""Figures 3 to 7: natural frequencies under thrust, to where the beam loses its stability."""

import numpy as np

from compare.report.figures.beams import beam_of, interior, point_count
from compare.report.figures.catalogue import Figure
from compare.report.figures.data import FigureData, Float, Series, largest
from compare.report.one_route import Beam, RouteName
from compare.report.steady import COALESCENCE, loss, natural_frequencies

NAMES = ("omega_(B)", "omega_(1)", "omega_(2)")
LOWER, UPPER = "omega_(B), omega_(1)", "omega_(2)"

PRINTED = {
    3: ("section 7.2", 25.67, 0.0),
    4: ("section 7.2", 15.0, 0.0),
    7: ("Appendix A", 0.0, 0.974),
}
"""What the text reads off the figures: two critical thrusts, and omega_(1) of Example 2."""


def steady_frequencies(figure: Figure, detail: float = 1.0) -> FigureData:
    """Curves from the closed form, marks from Galerkin's quadrature."""
    series: list[Series] = []
    differences = []
    for value in figure.values:
        changed = {figure.along: value}

        def at(T0: float, changed: dict[str, float] = changed) -> Beam:
            return beam_of(figure, **(changed | {"T0": T0}))

        end, event = loss(at, figure.span[1])
        count = point_count(80, detail)
        # frequencies start and end like square roots
        T0 = 0.5 * end * (1.0 - np.cos(np.pi * np.arange(count) / (count - 0.5)))
        curves = np.array([real_part("hill", at(t)) for t in T0]).T
        chosen = interior(count, 6)
        other = np.array([real_part("floquet", at(T0[i])) for i in chosen]).T
        label = f"{figure.along} = {value:g}"
        for name, y, mark in zip(NAMES, curves, other, strict=True):
            panel = UPPER if name == "omega_(2)" else LOWER
            full = f"{label}, {name}"
            series.append(Series(full, "curve", "hill", T0, y, panel=panel))
            series.append(Series(full, "mark", "floquet", T0[chosen], mark, panel=panel))
            differences.append(mark - y[chosen])
        if event:
            y_end = np.mean(real_part("hill", at(end))[:2]) if event == COALESCENCE else 0
            point = np.array([end]), np.array([y_end])
            series.append(Series(f"{label}, {event}", "event", "hill", *point, panel=LOWER))
    if figure.number in PRINTED:
        source, x, y = PRINTED[figure.number]
        point = np.array([x]), np.array([y])
        series.append(Series("read off", "printed", source, *point, panel=LOWER))
    return FigureData(figure.number, tuple(series), "omega", largest(differences))


def real_part(route: RouteName, beam: Beam) -> Float:
    """Ascending real parts of the natural frequencies."""
    return np.real(natural_frequencies(route, beam))
