"""Stability boundaries as curves: a resonance's two edges, followed through a second parameter.

Where to look comes from the resonances and Hsu's widths (`hill.averaging`); what is solved is the
sign change of an indicator of P (`compare.stability.indicators`), by bracketing, in a window that
moves with the tongue; where the tongue closes, its depth is brought to zero in the second
parameter.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from compare.stability.indicators import (
    TAIL,
    NotSmooth,
    deepest,
    edges,
    growth,
    indicator,
    interpolate_in_Omega,
)
from hill import HillEquation
from hill.averaging import Resonance, half_width, modal

Float = NDArray[np.floating[Any]]
Pair = tuple[float, float]

# Half window over the half width expected, and what is added for the shift of the centre, which is
# of second order: this share of gamma^2 Omega.
REACH, SHIFT = 2.0, 0.3
# How often the window is doubled before an instability's edges are given up.
WIDER = 3
# The window keeps to Omega above this share of the resonance.
LOWEST = 0.4
# Points added towards the tip of a tongue, as squares of these shares of a step: edges meet there
# like a parabola.
TOWARDS_TIP = (0.1, 0.25, 0.45, 0.7)


@dataclass(frozen=True)
class Family:
    """Equations in two parameters, Omega and another one, with the route that solves them.

    Attributes
    ----------
    equation : callable
        (Omega, y) to a `HillEquation`.
    polynomial : callable
        A `HillEquation` to the coefficients of P, highest power first.
    """

    equation: Callable[[float, float], HillEquation]
    polynomial: Callable[[HillEquation], Float]

    @property
    def error(self) -> float:
        """How well P is known, over its largest coefficient: it is no smoother than that."""
        return TAIL

    def P(self, Omega: float, y: float) -> Float:
        """Coefficients of P at a point."""
        return self.polynomial(self.equation(Omega, y))

    def along(self, Omega: Float, y: float) -> Float:
        """Coefficients of P at many Omega, (k, n + 1)."""
        return np.array([self.P(float(x), y) for x in Omega])


@dataclass(frozen=True, eq=False)
class Tongue:
    """One instability's boundary: two edges in Omega at each y, equal where it closes.

    Attributes
    ----------
    resonance : Resonance
    y, lower, upper : (k,) ndarray
    """

    resonance: Resonance
    y: Float
    lower: Float
    upper: Float

    def at(self, y: float) -> Pair | None:
        """Edges at y by straight lines; None beyond its ends."""
        if not self.y[0] <= y <= self.y[-1]:
            return None
        return float(np.interp(y, self.y, self.lower)), float(np.interp(y, self.y, self.upper))


@dataclass(frozen=True)
class Section:
    """A tongue at one y: edges if it is there, and its deepest point."""

    y: float
    Omega: float
    edges: Pair | None
    bottom: float
    depth: float

    @property
    def offsets(self) -> Pair:
        """Edges from the resonance."""
        lower, upper = self.edges or (self.bottom, self.bottom)
        return lower - self.Omega, upper - self.Omega


@dataclass(frozen=True)
class Cutter:
    """One resonance of a family, cut at any y.

    Attributes
    ----------
    family : Family
    resonance : Resonance
    """

    family: Family
    resonance: Resonance

    def Omega(self, y: float) -> float:
        """The resonance; nan where the frequencies are not real."""
        return self.resonance.Omega(modal(self.family.equation(1.0, y))[0])

    def cut(self, y: float, expected: Pair | None = None) -> Section | None:
        """Section at y; None without resonance, or with a longitudinal one beside it.

        `expected` are the edges' offsets from the resonance.
        """
        Omega = self.Omega(y)
        if not Omega > 0.0:
            return None
        equation = self.family.equation(Omega, y)
        width, undamped = (half_width(self.resonance, equation, damped=d) for d in (True, False))
        low, high = expected or (-width, width)
        reach = REACH * max(undamped, 0.5 * (high - low)) + SHIFT * equation.gamma**2 * Omega
        for _ in range(WIDER):
            try:
                section = self._within(y, Omega, (low, high), reach, equation.damping)
            except NotSmooth:
                return None
            # unstable, but edges out of sight: the tongue is wider than first order makes it
            if section.edges is not None or section.depth >= 0.0:
                break
            reach *= 2.0
        return section

    def _within(self, y: float, Omega: float, guess: Pair, reach: float, eta: float) -> Section:
        """What is seen in a window that reaches this far to either side of the guess's middle."""
        low, high = guess
        centre = Omega + 0.5 * (low + high)
        lo, hi = max(centre - reach, LOWEST * Omega), centre + reach
        P = interpolate_in_Omega(lambda x: self.family.along(x, y), lo, hi, self.family.error)

        def f(x: Float) -> Float:
            return indicator(self.resonance.indicator, P(x), x, eta)

        # undamped, of two z that meet P's error makes its root
        rounding = 0.0 if eta > 0.0 else np.sqrt(self.family.error)

        def grows(x: Float) -> NDArray[np.bool_]:
            return growth(P(x), x, eta) > rounding

        bottom, depth = deepest(f, lo, hi)
        pair = edges(f, lo, hi, (Omega + low, Omega + high), bottom, grows)
        return Section(y, Omega, pair, bottom, depth)

    def tip(self, a: Section, b: Section) -> Section | None:
        """Where between a and b, one with edges and one without, the tongue closes."""
        offsets = (a if a.edges else b).offsets
        if a.depth * b.depth >= 0.0:
            return None

        def depth(y: float) -> float:
            for known in (a, b):
                if y == known.y:
                    return known.depth
            section = self.cut(y, offsets)
            return section.depth if section else abs(a.depth)

        section = self.cut(float(brentq(depth, a.y, b.y, xtol=1e-6 * (b.y - a.y))), offsets)
        return section and replace(section, edges=(section.bottom, section.bottom))

    def towards(self, tip: Section, known: Section) -> list[Section]:
        """The tip and sections from it towards a known one, ever wider apart."""
        steps = [tip.y + share**2 * (known.y - tip.y) for share in TOWARDS_TIP]
        sections = [self.cut(y, known.offsets) for y in steps]
        return [tip, *(s for s in sections if s is not None and s.edges is not None)]


def follow(
    family: Family, resonance: Resonance, ys: Sequence[float], within: Sequence[Tongue] = ()
) -> tuple[Tongue, ...]:
    """The boundary of one resonance's instability over the range of y, a `Tongue` a piece.

    Parameters
    ----------
    family : Family
    resonance : Resonance
    ys : sequence of float
        Ascending; more are added where the tongue closes.
    within : sequence of Tongue, optional
        The same without damping: where to look for what damping leaves of it.
    """
    cutter = Cutter(family, resonance)
    pieces: list[list[Section]] = [[]]
    last: Section | None = None
    for y in ys:
        outline = [pair for tongue in within if (pair := tongue.at(y))]
        if outline:
            Omega = cutter.Omega(y)
            here = cutter.cut(y, (outline[0][0] - Omega, outline[0][1] - Omega))
        else:
            here = None if within else cutter.cut(y, _continued(pieces[-1], y))
        there = here is not None and here.edges is not None
        if here and last and there != bool(pieces[-1]) and (tip := cutter.tip(last, here)):
            between = cutter.towards(tip, here if there else last)
            pieces[-1] += between if there else between[::-1]
        if here and there:
            pieces[-1].append(here)
        elif pieces[-1]:
            pieces.append([])
        last = here
    return tuple(_tongue(resonance, piece) for piece in pieces if len(piece) > 1)


def _continued(before: list[Section], y: float) -> Pair | None:
    """Offsets continued in a straight line from the last two sections."""
    if len(before) < 2:
        return before[0].offsets if before else None
    first, last = before[-2:]
    if last.y == first.y:  # a tip upon a station
        return last.offsets
    t = min(1.0, (y - last.y) / (last.y - first.y))
    low, high = (b + t * (b - a) for a, b in zip(first.offsets, last.offsets, strict=True))
    return (low, high) if low < high else last.offsets


def _tongue(resonance: Resonance, piece: list[Section]) -> Tongue:
    lower, upper = np.array([section.edges for section in piece]).T
    return Tongue(resonance, np.array([section.y for section in piece]), lower, upper)
