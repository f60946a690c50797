"""One resonance's instability, cut at any value of a second parameter, and followed through it.

Where to look comes from the resonances and Hsu's widths (`hill.averaging`); what is solved is the
sign change of an indicator of P (`compare.stability.indicators`), by bracketing, in a window that
moves with the tongue; where the tongue closes, its depth is brought to zero in the second
parameter.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from compare.edges.field import PolynomialField
from compare.edges.tongue import (
    DRIFT,
    NOT_REAL,
    RANGE,
    TIP,
    UNSEEN,
    Gap,
    Pair,
    Section,
    Tongue,
    continued,
    continues,
)
from compare.stability.indicators import (
    BESIDE_POLE,
    NotSmooth,
    deepest,
    edges,
    interpolate_in_Omega,
)
from hill import HillEquation, PeriodicEquation, Singular
from hill.averaging import Resonance
from hill.oscillations.expected import damping, half_width, strength

Float = NDArray[np.floating[Any]]

# Half window over the half width expected, and what is added for the shift of the centre, which is
# of second order: this share of gamma^2 Omega.
REACH, SHIFT = 2.0, 0.3
# How often the window is doubled before an instability's edges are given up.
DOUBLINGS = 2
# The window keeps to Omega above this share of the resonance, and below its reciprocal.
MIN_SHARE = 0.4
# A window ends before a pole by this share of the way to it.
POLE_MARGIN = 0.1
# Points added towards the tip of a tongue, as squares of these shares of a step: edges meet there
# like a parabola.
TOWARDS_TIP = (0.1, 0.25, 0.45, 0.7)


def rounding(error: float, eta: float) -> float:
    """A T that is none: undamped, of two z that meet P's error makes its root."""
    return 0.0 if eta > 0.0 else float(np.sqrt(error))


@dataclass(frozen=True)
class TongueTracer:
    """One resonance of a field, cut at any y.

    Attributes
    ----------
    field : PolynomialField
    resonance : Resonance
    within : (float, float), optional
        The range of Omega that matters: where no window reaches into it, nothing is looked for.
    """

    field: PolynomialField
    resonance: Resonance
    within: Pair = (0.0, np.inf)

    def Omega(self, y: float) -> float:
        """The resonance; nan where the frequencies are not real."""
        return self.resonance.Omega(self.field.frequencies(y))

    def window(self, y: float, doublings: int = DOUBLINGS) -> Pair | None:
        """What the tracer may look at, doublings included; None where that is of no interest."""
        Omega, equation = self._at(y)
        if equation is None:
            return None
        undamped = half_width(self.resonance, equation, damped=False)
        reach = 2.0**doublings * (REACH * undamped + SHIFT * strength(equation) ** 2 * Omega)
        low, high = max(Omega - reach, MIN_SHARE * Omega), min(Omega + reach, Omega / MIN_SHARE)
        return (low, high) if low <= self.within[1] and high >= self.within[0] else None

    def section(self, y: float, expected: Pair | None = None) -> Section | Gap:
        """What there is at y; `expected` are the edges' offsets from the resonance."""
        Omega, equation = self._at(y)
        if equation is None:
            return Gap(BESIDE_POLE if Omega > 0.0 else NOT_REAL)
        if expected is None and self.window(y) is None:
            return Gap(RANGE)
        width, undamped = (half_width(self.resonance, equation, damped=d) for d in (True, False))
        low, high = expected or (-width, width)
        reach = REACH * max(undamped, 0.5 * (high - low)) + SHIFT * strength(equation) ** 2 * Omega
        eta = damping(self.resonance, equation)
        section: Section | None = None
        for _ in range(DOUBLINGS + 1):
            try:
                section = self._within(y, Omega, (low, high), reach, eta)
            except NotSmooth as reason:
                return Gap(reason.why)
            # unstable, but edges out of sight: the tongue is wider than first order makes it
            if section is None or section.edges is not None or section.depth >= 0.0:
                break
            reach *= 2.0
        if section is None:
            return Gap(UNSEEN)
        cut = section.edges is None and section.depth < 0.0
        if cut and len(self.field.poles(y, Omega - reach, Omega + reach)):
            return Gap(BESIDE_POLE)
        return section

    def _at(self, y: float) -> tuple[float, HillEquation | PeriodicEquation | None]:
        """The resonance and the equation there; none where it is not real, or on a pole."""
        Omega = self.Omega(y)
        if not Omega > 0.0:
            return Omega, None
        with suppress(Singular):
            return Omega, self.field.equation(Omega, y)
        return Omega, None

    def _within(
        self, y: float, Omega: float, guess: Pair, reach: float, eta: float
    ) -> Section | None:
        """What is seen in a window that reaches this far to either side of the guess's middle.

        None where that is too far from the resonance.
        """
        low, high = guess
        centre = Omega + 0.5 * (low + high)
        lo, hi = self._clear(y, centre, centre - reach, centre + reach)
        lo, hi = max(lo, MIN_SHARE * Omega), min(hi, Omega / MIN_SHARE)
        if not lo < centre < hi:
            return None
        reading, error = self.field.reading, self.field.error
        P = interpolate_in_Omega(lambda x: self.field.along(x, y), lo, hi, error)

        def f(x: Float) -> Float:
            return reading.indicator(self.resonance.indicator, P(x), x, eta)

        def grows(x: Float) -> NDArray[np.bool_]:
            return reading.growth(P(x), x, eta) > rounding(error, eta)

        bottom, depth = deepest(f, lo, hi)
        pair = edges(f, lo, hi, (Omega + low, Omega + high), bottom, grows)
        return Section(y, Omega, pair, bottom, depth)

    def _clear(self, y: float, centre: float, lo: float, hi: float) -> Pair:
        """The window as far as no pole is in it, nor close by."""
        poles = self.field.poles(y, lo / (1.0 + POLE_MARGIN), hi * (1.0 + POLE_MARGIN))
        below, above = poles[poles <= centre], poles[poles > centre]
        if len(below):
            lo = max(lo, below[-1] + POLE_MARGIN * (centre - below[-1]))
        if len(above):
            hi = min(hi, above[0] - POLE_MARGIN * (above[0] - centre))
        return lo, hi

    def refine_tip(self, a: Section, b: Section) -> Section | None:
        """Where between a and b, one with edges and one without, the tongue closes.

        None where what closes there is another one, `DRIFT` widths away or more.
        """
        offsets = (a if a.edges else b).offsets
        if a.depth * b.depth >= 0.0:
            return None

        def depth(y: float) -> float:
            for known in (a, b):
                if y == known.y:
                    return known.depth
            section = self.section(y, offsets)
            return section.depth if isinstance(section, Section) else abs(a.depth)

        at = float(brentq(depth, a.y, b.y, xtol=1e-6 * (b.y - a.y)))
        section = self.section(at, offsets)
        if not isinstance(section, Section):
            return None
        drift = abs(section.bottom - section.Omega - 0.5 * sum(offsets))
        if drift > DRIFT * (offsets[1] - offsets[0]):
            return None
        return replace(section, edges=(section.bottom, section.bottom))

    def towards_tip(self, tip: Section, known: Section) -> list[Section]:
        """The tip and sections from it towards a known one, ever wider apart."""
        steps = [tip.y + share**2 * (known.y - tip.y) for share in TOWARDS_TIP]
        sections = [self.section(y, known.offsets) for y in steps]
        return [tip, *(s for s in sections if isinstance(s, Section) and s.edges is not None)]


@dataclass
class _Piece:
    """Sections one after another, and why there is none before the first and after the last."""

    begins: str
    sections: list[Section]
    ends: str = RANGE


def follow(
    field: PolynomialField,
    resonance: Resonance,
    ys: Sequence[float],
    within: Sequence[Tongue] = (),
    Omega: Pair = (0.0, np.inf),
) -> tuple[Tongue, ...]:
    """The boundary of one resonance's instability over the range of y, a `Tongue` a piece.

    Parameters
    ----------
    field : PolynomialField
    resonance : Resonance
    ys : sequence of float
        Ascending; more are added where the tongue closes.
    within : sequence of Tongue, optional
        The same without damping: where to look for what damping leaves of it.
    Omega : (float, float), optional
        The range that matters.
    """
    tracer = TongueTracer(field, resonance, Omega)
    pieces: list[_Piece] = []
    open_piece: _Piece | None = None
    last: Section | Gap | None = None
    for y in ys:
        here = _station(tracer, y, open_piece, within)
        if (
            open_piece
            and isinstance(here, Section)
            and not continues(open_piece.sections[-1], here)
        ):
            here = Gap(UNSEEN)
        there = isinstance(here, Section) and here.edges is not None
        tip: Section | None = None
        turned = there != (open_piece is not None)
        if turned and isinstance(here, Section) and isinstance(last, Section):
            tip = tracer.refine_tip(last, here)
        if there and open_piece is None:
            open_piece = _Piece(RANGE if last is None else _why(last, tip), [])
            pieces.append(open_piece)
        if tip is not None and open_piece is not None and isinstance(here, Section):
            known = here if there else last
            assert isinstance(known, Section)
            between = tracer.towards_tip(tip, known)
            open_piece.sections += between if there else between[::-1]
        if there and open_piece is not None and isinstance(here, Section):
            open_piece.sections.append(here)
        elif open_piece is not None:
            open_piece.ends = _why(here, tip)
            open_piece = None
        last = here
    return tuple(_tongue(resonance, piece) for piece in pieces if len(piece.sections) > 1)


def _station(
    tracer: TongueTracer, y: float, piece: _Piece | None, within: Sequence[Tongue]
) -> Section | Gap:
    if not within:
        return tracer.section(y, continued(piece.sections if piece else [], y))
    outline = [pair for tongue in within if (pair := tongue.at(y))]
    if not outline:
        return Gap(UNSEEN)
    Omega = tracer.Omega(y)
    return tracer.section(y, (outline[0][0] - Omega, outline[0][1] - Omega))


def _why(beyond: Section | Gap, tip: Section | None) -> str:
    """Why a piece goes no further."""
    if tip is not None:
        return TIP
    return beyond.why if isinstance(beyond, Gap) else UNSEEN


def _tongue(resonance: Resonance, piece: _Piece) -> Tongue:
    lower, upper = np.array([section.edges for section in piece.sections]).T
    y = np.array([section.y for section in piece.sections])
    return Tongue(resonance, y, lower, upper, piece.begins, piece.ends)
