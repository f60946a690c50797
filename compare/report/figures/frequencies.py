"""Figures 3 to 7: natural frequencies under thrust, to where the beam loses its stability."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from compare.report.figures.beams import beam_of, inner, spread
from compare.report.figures.catalogue import Figure
from compare.report.figures.data import FigureData, Float, Series, largest
from compare.report.figures.one_route import Beam, equation
from hill.averaging import modal

Complex = NDArray[np.complex128]
NAMES = ("omega_(B)", "omega_(1)", "omega_(2)")
LOWER, UPPER = "omega_(B), omega_(1)", "omega_(2)"

PRINTED = {
    3: ("section 7.2", 25.67, 0.0),
    4: ("section 7.2", 15.0, 0.0),
    7: ("Appendix A", 0.0, 0.974),
}
"""What the text reads off the figures: two critical thrusts, and omega_(1) of Example 2."""

# Thrusts at which a loss of stability is looked for: one in two thirds of a unit.
STEPS = 57


def natural_frequencies(figure: Figure, detail: float = 1.0) -> FigureData:
    """Curves from the closed form, marks from Galerkin's quadrature."""
    series: list[Series] = []
    differences = []
    for value in figure.values:
        changed = {figure.along: value}

        def at(T0: float, changed: dict[str, float] = changed) -> Beam:
            return beam_of(figure, **(changed | {"T0": T0}))

        end, event = loss(at, figure.span[1])
        count = spread(80, detail)
        # frequencies start and end like square roots
        T0 = 0.5 * end * (1.0 - np.cos(np.pi * np.arange(count) / (count - 0.5)))
        curves = np.array([real_part(at(t).natural_frequencies()) for t in T0]).T
        chosen = inner(count, 6)
        other = np.array([by_quadrature(at(T0[i])) for i in chosen]).T
        label = f"{figure.along} = {value:g}"
        for name, y, mark in zip(NAMES, curves, other, strict=True):
            panel = UPPER if name == "omega_(2)" else LOWER
            full = f"{label}, {name}"
            series.append(Series(full, "curve", "hill", T0, y, panel=panel))
            series.append(Series(full, "mark", "floquet", T0[chosen], mark, panel=panel))
            differences.append(mark - y[chosen])
        if event:
            y_end = np.mean(real_part(at(end).natural_frequencies())[:2]) if "coal" in event else 0
            point = np.array([end]), np.array([y_end])
            series.append(Series(f"{label}, {event}", "event", "hill", *point, panel=LOWER))
    if figure.number in PRINTED:
        source, x, y = PRINTED[figure.number]
        point = np.array([x]), np.array([y])
        series.append(Series("read off", "printed", source, *point, panel=LOWER))
    return FigureData(figure.number, tuple(series), "omega", largest(differences))


def loss(at: Callable[[float], Beam], most: float) -> tuple[float, str]:
    """Thrust at which a frequency ceases to be real, and how; `most` and nothing if none does.

    The lowest frequency's square passes zero (inertial buckling), or the lower two squares meet,
    which is where their discriminant does (coalescence).
    """

    def lower_two(T0: float) -> Complex:
        return np.asarray(at(T0).natural_frequencies(), complex)[:2] ** 2

    def discriminant(squares: Complex) -> float:
        return float(((squares[1] - squares[0]) ** 2).real)

    def product(squares: Complex) -> float:
        return float(np.prod(squares).real)

    T0 = np.linspace(0.1, most, STEPS)
    squares = [lower_two(t) for t in T0]
    for how, f in (("coalescence", discriminant), ("inertial buckling", product)):
        lost = np.flatnonzero([f(s) <= 0.0 for s in squares])
        if len(lost):
            a, b = T0[lost[0] - 1], T0[lost[0]]
            return float(brentq(lambda t, f=f: f(lower_two(t)), a, b, xtol=1e-12)), how
    return most, ""


def real_part(frequencies: Any) -> Float:
    """Ascending real parts."""
    return np.real(frequencies)


def by_quadrature(beam: Beam) -> Float:
    """Natural frequencies from the other route's F."""
    return np.real(modal(equation("floquet", beam, 1.0, 0.0))[0])
