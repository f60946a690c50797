"""One resonance of a system, seen along Omega: where it grows, how fast, where it ends.

What is looked at, half the sum of two exponents and the square of half their difference, is smooth
where the growth is not: a few values of Omega across the band know it, and its edges are solved for
on the polynomials through them and corrected at the edges themselves.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.optimize import brentq

from compare.vehicle.fits import UNDAMPED, Fits, Window, excess
from hill.averaging import Resonance
from hill.errors import Refused
from hill.oscillations.coupling import Coupled, Guess
from hill.oscillations.pair import Pair, pair
from hill.oscillations.steady import Steady

Equation = Callable[[float], Any]

# Reach of the window over the half width of the band that it was made for.
REACH = 1.3

# Of half a window that was made for another band: farther out its top is not in its middle.
INSIDE = 0.9

# How often the window is moved to where the band is.
MAX_MOVES = 6

# Shift of a band's middle, over its resonance: beyond, it is another's.
MAX_SHIFT = 0.3

# An edge that is corrected by more, over half the window, is solved for without polynomials.
MAX_CORRECTION = 0.02

# Each parabola's half over the last one's, and what it may still move the top by, over the excess
# at rest, which is what a pulsation has to overcome: what is left of a cubic term is smaller by the
# cube of the first.
NARROWER, SETTLED = 0.3, 1e-5

# Share of Omega to which an edge is solved for without them.
SOLVED = 1e-10

# Half a window where nothing grows, and where averaging sees no coupling at all.
LEAST = 1e-4


@dataclass(frozen=True)
class Band:
    """What one resonance does at one pulsation.

    Attributes
    ----------
    resonance : Resonance
    Omega : float
        Where it grows fastest, or decays slowest.
    T : float
        Twice the growth exponent there, of the two oscillations alone.
    T_error : float
        An estimate.
    edges : (float, float) or None
        Omega between which it grows.
    edge_error : float
        An estimate.
    excess : float
        What becomes 0 where the band closes; linear in a power of the pulsation.
    middle : float
        Omega where the excess is that.
    window : Window
        In which it was solved for, from the resonance's own Omega on.
    """

    resonance: Resonance
    Omega: float
    T: float
    T_error: float
    edges: tuple[float, float] | None
    edge_error: float
    excess: float
    middle: float
    window: Window

    @property
    def width(self) -> float:
        """In Omega; 0 where there is no band."""
        return self.edges[1] - self.edges[0] if self.edges else 0.0


@dataclass(frozen=True, eq=False)
class Near:
    """A resonance of an equation along Omega.

    Attributes
    ----------
    equation : callable
        Of Omega.
    resonance : Resonance
    alone : Steady
        The oscillations without pulsation.
    """

    equation: Equation
    resonance: Resonance
    alone: Steady
    known: dict[float, Pair] = field(default_factory=dict)

    @property
    def Omega(self) -> float:
        """The resonance's own."""
        return self.resonance.Omega(self.alone.frequencies + 0j)

    @property
    def rates(self) -> tuple[float, float]:
        """What the two oscillations decay by without pulsation."""
        both = [self.alone.oscillations[k] for k in (self.resonance.i, self.resonance.j)]
        a, b = (-float(self.alone.exponents[k].real) for k in both)
        return a, b

    @property
    def excess_at_rest(self) -> float:
        """`excess` at the resonance without pulsation."""
        a, b = self.rates
        return -a * b if min(a, b) > UNDAMPED * self.Omega else 0.0

    def guess(self) -> Guess:
        """By averaging."""
        return Coupled(self.equation(self.Omega), self.alone).guess(self.resonance)

    def at(self, Omega: float) -> Pair:
        """The two exponents at one Omega."""
        if Omega not in self.known:
            self.known[Omega] = pair(self.equation(Omega), self.resonance, self.alone)
        return self.known[Omega]

    def band(self, like: Band | None = None) -> Band:
        """The band, at the equation's pulsation.

        Parameters
        ----------
        like : Band, optional
            Of much the same equation: it is looked for in the same window first.

        Raises
        ------
        Refused
            It lies within another instability, or too many harmonics take part.
        """
        fits, peak = self._top(like)
        own, window = self.at(peak), fits.window
        over, middle = excess(own, peak), peak
        edges, error = None, 0.0
        if over <= 0.0:
            middle = fits.middle()
            over = excess(self.at(middle), middle)
        else:
            (low, off), (high, other) = (
                self._edge(fits, peak, window.centre + side * window.half) for side in (-1.0, 1.0)
            )
            edges, error = (low, high), max(off, other)
        about = Window(window.centre - self.Omega, window.half)
        return Band(self.resonance, peak, own.T, 2.0 * own.error, edges, error, over, middle, about)

    def most(self, centre: float, half: float) -> tuple[float, float]:
        """The largest excess, of a band about so wide whose middle is near there, and its Omega.

        By parabolas through three values, each about the last one's top and narrower, until that
        has settled: where one of the two decays much faster the excess is no parabola of the width.

        Raises
        ------
        Refused
            As `band`.
        """
        top = np.inf
        for narrower in range(MAX_MOVES):
            reach = half * NARROWER**narrower
            at = centre + reach * np.array([-1.0, 0.0, 1.0])
            low, mid, high = (excess(self.at(float(x)), float(x)) for x in at)
            bend = low - 2.0 * mid + high
            if not bend < 0.0:
                return self._most_of_window()
            move = 0.5 * (low - high) / bend
            if abs(move) > 3.0:
                return self._most_of_window()
            centre = float(at[1] + reach * move)
            before, top = top, mid - 0.125 * (high - low) ** 2 / bend
            if abs(top - before) <= SETTLED * max(abs(self.excess_at_rest), abs(top)):
                break
        return top, centre

    def _most_of_window(self) -> tuple[float, float]:
        fits, _ = self._top()
        middle = fits.middle()
        return excess(self.at(middle), middle), middle

    def _top(self, like: Band | None = None) -> tuple[Fits, float]:
        """Polynomials across the band, and where they grow fastest."""
        if like is not None:
            window = Window(self.Omega + like.window.centre, like.window.half)
            fits = Fits.of(window, [self.at(x) for x in window.nodes])
            inside = INSIDE * window.half
            if max(abs(x - window.centre) for x in (fits.peak(), fits.middle())) < inside:
                return fits, fits.peak()
        window = self._window(self.guess())
        fits = Fits.of(window, [self.at(x) for x in window.nodes])
        return fits, fits.peak()

    def _window(self, guess: Guess) -> Window:
        """About the middle of the band, as wide as it."""
        k, centre = self.resonance.order, self.Omega
        half = max(2.0 * abs(guess.coupling) ** 0.5 / k, LEAST * centre)
        for _ in range(MAX_MOVES):
            at = centre + half * np.array([-1.0, 0.0, 1.0])
            squares = np.array([self.at(float(x)).square.real for x in at])
            bend = squares[0] - 2.0 * squares[1] + squares[2]
            # the square is that of the growth at the middle less (k (Omega - middle)/2)^2
            move = 0.5 * (squares[0] - squares[2]) / bend if bend < 0.0 else 0.0
            top = squares[1] - 0.125 * (squares[2] - squares[0]) ** 2 / bend if bend < 0.0 else 0.0
            middle = float(at[1] + half * np.clip(move, -3.0, 3.0))
            wide = max(2.0 * max(top, 0.0) ** 0.5 / k, LEAST * centre)
            settled = abs(middle - centre) < 0.3 * half and 0.3 * half < wide < 3.0 * half
            centre, half = middle, wide
            if abs(centre - self.Omega) > MAX_SHIFT * self.Omega:
                raise Refused(f"{self.resonance.name}: has no band beside Omega = {self.Omega:g}")
            if settled:
                break
        return Window(centre, REACH * half)

    def _edge(self, fits: Fits, peak: float, end: float) -> tuple[float, float]:
        """Where growth ends between its peak and the window's end, and how far that may be off."""
        # a band that is hardly open may be closed for the polynomials, or beyond their window
        if fits.excess(peak) <= 0.0 or fits.excess(end) > 0.0:
            return self._solved(peak, end), SOLVED * peak
        half = fits.window.half
        first = float(brentq(fits.excess, peak, end, xtol=1e-14 * peak))
        step = 1e-3 * half
        slope = (fits.excess(first + step) - fits.excess(first - step)) / (2.0 * step)
        correction = -excess(self.at(first), first) / slope if slope else np.inf
        if abs(correction) > MAX_CORRECTION * half:
            return self._solved(peak, end), SOLVED * peak
        # another would be smaller by about the same factor
        return first + correction, abs(correction) * MAX_CORRECTION + 1e-12 * peak

    def _solved(self, peak: float, end: float) -> float:
        """The same without polynomials."""
        for _ in range(MAX_MOVES):
            if excess(self.at(end), end) < 0.0:
                return float(brentq(lambda x: excess(self.at(x), x), peak, end, rtol=0.1 * SOLVED))
            end = max(end + (end - peak), LEAST * peak)
        raise Refused(f"{self.resonance.name}: has no edge beside Omega = {peak:g}")
