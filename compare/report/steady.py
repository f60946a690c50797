"""The beam under its constant thrust: natural frequencies by either route, and where they end."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from compare.report.one_route import Beam, Complex, RouteName, equation
from floquet.frequencies import natural_frequencies as time_domain_frequencies

BUCKLING, COALESCENCE = "inertial buckling", "coalescence"

# Thrusts at which a loss of stability is looked for: one in two thirds of a unit.
STEPS = 57
LEAST_THRUST = 0.1


def natural_frequencies(route: RouteName, beam: Beam) -> Complex:
    """omega_(B), omega_(1), ..., ascending by real part; complex beyond the loss of stability."""
    if route == "hill":
        return np.asarray(beam.natural_frequencies(), complex)
    return time_domain_frequencies(equation("floquet", beam, 1.0, 0.0))


def loss(at: Callable[[float], Beam], most: float, route: RouteName = "hill") -> tuple[float, str]:
    """Thrust at which a frequency ceases to be real, and how; `most` and nothing if none does.

    Parameters
    ----------
    at : callable
        Thrust to beam.
    most : float
        The largest thrust looked at.
    route : {"hill", "floquet"}, optional
    """
    found = [(end, how) for how in LOST if (end := _first(how, at, most, route)) is not None]
    return min(found, default=(most, ""))


def buckling(at: Callable[[float], Beam], most: float, route: RouteName) -> float:
    """Thrust at which the lowest frequency's square passes zero.

    Raises
    ------
    ValueError
        It does not, up to `most`.
    """
    found = _first(BUCKLING, at, most, route)
    if found is None:
        raise ValueError(f"no inertial buckling up to T0 = {most:g}")
    return found


def _first(how: str, at: Callable[[float], Beam], most: float, route: RouteName) -> float | None:
    """Where a function of the lower two squares first changes its sign."""

    def f(T0: float) -> float:
        return LOST[how](natural_frequencies(route, at(T0))[:2] ** 2)

    thrusts = np.linspace(LEAST_THRUST, most, STEPS)
    lost = np.flatnonzero([f(float(T0)) <= 0.0 for T0 in thrusts])
    if not len(lost):
        return None
    return float(brentq(f, thrusts[lost[0] - 1], thrusts[lost[0]], xtol=1e-12))


def _discriminant(squares: Complex) -> float:
    return float(((squares[1] - squares[0]) ** 2).real)


def _product(squares: Complex) -> float:
    return float(np.prod(squares).real)


LOST = {COALESCENCE: _discriminant, BUCKLING: _product}
"""What passes zero: the squares of two frequencies meet, or that of the lowest vanishes."""
