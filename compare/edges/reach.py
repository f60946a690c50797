"""Whether a resonance beside a chart can have an edge on it: those that cannot are not followed.

To follow one there takes P where the chart has no series, and where it grows most. What is seen of
a tongue on the chart has an edge on it, and that is looked for on the chart's own series.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.edges.tongue import JUMP
from compare.edges.tracer import MIN_SHARE, TongueTracer, rounding
from compare.stability.indicators import GRID, NotSmooth, deepest
from hill.oscillations.expected import damping

Float = NDArray[np.floating[Any]]

# Lines a step of the stations, and points on each: no farther from one another than the tracer's
# own in the widest of its windows.
BETWEEN, POINTS = 4, GRID


def may_reach(tracer: TongueTracer, at: Sequence[float]) -> bool:
    """Whether the tongue that a tracer follows along these y may be seen within its range.

    An edge within the range is the tongue's only where it is near the resonance, or near the
    range's end, or where the system is unstable all the way to it: a wider window is looked at
    only for the edges of a tongue that the narrower one cuts.

    Parameters
    ----------
    tracer : TongueTracer
        Of a field that has P within the tracer's range of Omega.
    at : sequence of float
        Ascending; it is looked between them too.
    """
    k = np.arange(BETWEEN * (len(at) - 1) + 1) / BETWEEN
    return any(_seen(tracer, float(y)) for y in np.interp(k, np.arange(len(at)), at))


def _seen(tracer: TongueTracer, y: float) -> bool:
    """Whether an edge, or the whole range, may be the tongue's at this y."""
    Omega, (low, high) = tracer.Omega(y), tracer.within
    if not Omega > 0.0:
        return False
    # no window goes farther
    first, last = MIN_SHARE * Omega, Omega / MIN_SHARE
    if low <= Omega <= high:
        return True
    if last <= low or first >= high:
        return False
    lo, hi = max(low, first), min(high, last)
    near = tracer.window(y, doublings=0) or (Omega, Omega)
    equation = tracer.field.equation(Omega, y)
    reading, error = tracer.field.reading, tracer.field.error
    eta = damping(tracer.resonance, equation)

    def f(x: Float) -> Float:
        P = tracer.field.along(x, y)
        return reading.indicator(tracer.resonance.indicator, P, x, eta)

    # from the resonance outwards
    x = np.linspace(lo, hi, POINTS) if Omega < low else np.linspace(hi, lo, POINTS)
    try:
        value = f(x)
        grows = reading.growth(tracer.field.along(x, y), x, eta) > rounding(error, eta)
        if not np.any(value <= 0.0):
            # as narrow a tongue as the tracer sees
            bottom, depth = deepest(f, lo, hi)
            return depth <= 0.0 and _near(bottom, Omega, low, high, near)
    except NotSmooth:
        return True
    edges = np.flatnonzero((value[:-1] <= 0.0) & (value[1:] > 0.0))
    beyond = near[1] if Omega < low else near[0]
    start = int(np.argmax(np.abs(x - Omega) >= abs(beyond - Omega)))
    if bool(np.all(grows[start:])) and (last > high if Omega < low else first < low):
        return True  # the tongue may be wider than the range
    return any(
        _near(float(x[k]), Omega, low, high, near) or bool(np.all(grows[start : k + 1]))
        for k in edges
    )


def _near(x: float, Omega: float, low: float, high: float, window: tuple[float, float]) -> bool:
    """Whether x is in a first window, or so near the range's end that a tongue may come over it."""
    end = x <= low * (1.0 + JUMP) if Omega < low else x >= high * (1.0 - JUMP)
    return end or window[0] <= x <= window[1]
