"""P(z) over a rectangle of parameters, from its values at Chebyshev points.

The coefficients of P are analytic in the smooth variables, so a tensor series in them converges
geometrically. A rectangle whose series has not decayed at its allowed size is cut in two; one that
has fewer points than nodes, or is too small to cut again (a pole of the axial force runs through
it), is left to direct evaluation.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import chebyshev
from compare.charts.cuts import Cut, Uncovered
from compare.charts.known import Known, Sampler

Float = NDArray[np.floating[Any]]

FIRST_POINTS, MAX_POINTS = 9, 129
"""Points an axis at first, and at most before the rectangle is cut; 2^k + 1, so that they nest."""

RESOLVED = 1e-2
"""A series whose last coefficients are below this share of the largest value has begun to decay."""

MAX_RANGE = 1e6
"""A series' error is one for the whole piece: where P's largest coefficient varies by more than
this, it would say nothing where P is small."""

# Values at random points miss by no more than this many times the last coefficients kept, which
# bound a geometric series' remainder where its ratio is below 3/4; tests/test_chart.py measures it.
SAFETY = 4.0


POLE, STEEP, SLOW = "a pole is near", "P is too steep for a series", "a series takes as many nodes"
"""Why a rectangle has no series."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A rectangle with its series; `series` is None where only direct evaluation will do.

    Attributes
    ----------
    low, high : (axes,) ndarray
        Corners, in smooth variables.
    series : (n, points on each axis) ndarray or None
        Chebyshev coefficients of the coefficients of P below its leading 1.
    error : float
        Bound on the error of a coefficient of P anywhere in the rectangle.
    size : float
        Largest coefficient of P at its nodes.
    why : str
        Why it has no series, where it has none.
    """

    low: Float
    high: Float
    series: Float | None
    error: float
    size: float = 1.0
    why: str = ""


@dataclass(frozen=True, eq=False)
class Surface:
    """Pieces that cover the chart, and how many evaluations they took."""

    pieces: tuple[Piece, ...]
    nodes: int

    @property
    def error(self) -> float:
        """Largest bound over the pieces that have a series."""
        return max((p.error for p in self.pieces if p.series is not None), default=0.0)

    @property
    def relative_error(self) -> float:
        """Largest bound over the largest coefficient of P in its piece."""
        return max((p.error / p.size for p in self.pieces if p.series is not None), default=0.0)


def fit(
    sample: Sampler,
    low: Float,
    high: Float,
    tolerance: float,
    wanted: Callable[[Float, Float], float],
    singular: Callable[[Float, Float], Cut | None] = lambda low, high: None,
    covered: Callable[[float], Any] | None = None,
    points: float = np.inf,
    kept: Callable[[Float, Float], tuple[Float, Float] | None] = lambda low, high: (low, high),
) -> Surface:
    """Cover a rectangle with series whose error is below `tolerance` times the largest |P|.

    Parameters
    ----------
    sample : callable
        Evaluates P at smooth coordinates.
    low, high : (axes,) ndarray
        The rectangle.
    tolerance : float
        Relative to the largest coefficient of P in the piece.
    wanted : callable
        Corners of a rectangle to the number of points that are wanted there: it is not sampled at
        more nodes than that.
    singular : callable, optional
        Corners of a rectangle to how it is to be cut, where P has a pole in it or next to it: it
        gets no series, be the residue as small as it may.
    covered : callable, optional
        Called with the share of the rectangle that is done with, after each piece.
    points : int, optional
        Of the chart. Where P was too steep wherever a series was tried, as under growth by powers
        of ten, no more nodes than that are spent on finding another one.
    kept : callable, optional
        Corners of a rectangle to those of what is to be covered in it; None where that is nothing.
    """
    known = Known(sample, np.asarray(low, float), np.asarray(high, float))
    pieces: list[Piece] = []
    first = Uncovered(known.low, known.high, (0,) * len(low))
    pending, share, steep = [first], 0.0, True
    while pending:
        at = pending.pop()
        corners = kept(at.low, at.high)
        found: Piece | Cut | None = None
        if corners is not None:
            a, b = corners
            most = wanted(a, b)
            across = singular(a, b)
            if steep and len(known.values) > points:
                found = Piece(a, b, None, np.inf, why=STEEP)
            elif across is None:
                found = _piece(known, a, b, tolerance, most)
            elif most < FIRST_POINTS ** len(a):
                found = Piece(a, b, None, np.inf, why=POLE)
            else:
                found = across
            if isinstance(found, Cut) and not at.may_be(found):
                found = Piece(a, b, None, np.inf, why=found.why)
            why = at.why if isinstance(found, Piece) and found.why == SLOW else found.why
            steep = steep and why == STEEP
        if isinstance(found, Cut):
            pending += at.cut(a, b, found)
            continue
        if found is not None:
            # what the larger rectangle was cut for says more than that the rest is small
            pieces.append(replace(found, why=at.why) if found.why == SLOW and at.why else found)
        share += at.share
        if covered is not None:
            covered(share)
    return Surface(tuple(pieces), len(known.values))


def evaluate(fitted: Surface, smooth: Float) -> tuple[Float, Float]:
    """P at scattered points, from smooth coordinates (k, axes).

    Returns
    -------
    (n + 1, k) ndarray
        Coefficients, highest power first; nan where there is no series.
    (k,) ndarray
        Bound on their error; infinite there.
    """
    size = next((len(p.series) for p in fitted.pieces if p.series is not None), 0)
    P, error = np.full((size + 1, len(smooth)), np.nan), np.full(len(smooth), np.inf)
    for piece in fitted.pieces:
        inside = np.all((smooth >= piece.low) & (smooth <= piece.high), axis=1)
        if piece.series is not None and np.any(inside):
            local = to_local(smooth[inside], piece.low, piece.high)
            P[0, inside] = 1.0
            P[1:, inside] = chebyshev.at_points(piece.series, tuple(local.T))
            error[inside] = piece.error
    return P, error


def to_local(smooth: Float, low: Any, high: Any) -> Float:
    """Smooth coordinates as coordinates of a piece from `low` to `high`, in [-1, 1]."""
    return np.asarray(np.clip((2.0 * smooth - low - high) / (high - low), -1.0, 1.0))


def _piece(known: Known, a: Float, b: Float, tolerance: float, most: float) -> "Piece | Cut":
    """A series that has decayed, or the axis along which it has not.

    Without a series where that would take more than `most` nodes.
    """
    axes = len(a)
    counts = [FIRST_POINTS] * axes
    over = tuple(range(1, axes + 1))
    before: list[tuple[int, float]] = [(0, np.inf)] * axes
    while np.prod(counts) <= most:
        grid = [_nodes(a[k], b[k], counts[k]) for k in range(axes)]
        values, errors = known.on(grid)
        if not np.all(np.isfinite(values)):
            beyond = np.any(np.isinf(values))
            return Cut(_across_pole(values), STEEP if beyond else POLE)
        sizes = np.maximum(np.max(np.abs(values), axis=0), 1.0)
        if sizes.max() > MAX_RANGE * sizes.min():
            return Cut(_steepest(sizes), STEEP)
        series = chebyshev.coefficients(values, over)
        size = max(1.0, float(np.max(np.abs(values))))
        tails = np.array([chebyshev.decay(series, axis) for axis in over])
        allowed = tolerance * size / SAFETY
        short = tails > allowed
        if not np.any(short):
            trimmed = _trim(series, 1e-3 * tolerance * size)
            # a series' error is at most the sum over its axes; the nodes' own errors are amplified
            # by Lebesgue's constant, below (2/pi ln n + 1) an axis
            lebesgue = float(np.prod([2.0 / np.pi * np.log(n) + 1.0 for n in counts]))
            left = float(np.sum(np.abs(series))) - float(np.sum(np.abs(trimmed)))
            error = SAFETY * float(tails.sum()) + max(left, 0.0) + lebesgue * float(errors.max())
            return Piece(a, b, trimmed, error, size)
        shares = tails / size
        for k in np.flatnonzero(short):
            if _expected(counts[k], shares[k], before[k], allowed / size) > MAX_POINTS:
                return Cut(int(k), SLOW)
            before[k] = (counts[k], float(shares[k]))
        counts = [
            2 * n - 1 if s and n < MAX_POINTS else n for n, s in zip(counts, short, strict=True)
        ]
    return Piece(a, b, None, np.inf, why=SLOW)


def _expected(n: int, tail: float, before: tuple[int, float], allowed: float) -> float:
    """Points an axis after which a series that decays as it did lately will have decayed.

    A series that has not begun to decay (an oscillation not yet resolved) gets its next points;
    one that decays too slowly for `MAX_POINTS` is given up before they are spent.
    """
    if n >= MAX_POINTS:
        return np.inf
    if tail > RESOLVED or not tail < before[1] < np.inf:
        return n
    rate = np.log(before[1] / tail) / (n - before[0])
    return float(n + np.log(tail / allowed) / rate)


def _steepest(sizes: Float) -> int:
    """The axis along which P's size varies most."""
    logs = np.log(sizes)
    return int(np.argmax([np.ptp(logs, axis=k).max() for k in range(sizes.ndim)]))


def _across_pole(values: Float) -> int:
    """The axis along which infinite values are few: a pole runs across it."""
    infinite = ~np.isfinite(values).all(axis=0)
    axes = range(infinite.ndim)
    others = (tuple(j for j in axes if j != k) for k in axes)
    shares = [float(np.any(infinite, axis=other).mean()) for other in others]
    return int(np.argmin(shares))


def _trim(series: Float, small: float) -> Float:
    """Drop trailing coefficients that do not matter, the same on every row."""
    for axis in range(1, series.ndim):
        sizes = np.max(np.abs(series), axis=tuple(k for k in range(series.ndim) if k != axis))
        kept = len(sizes) - int(np.argmax(sizes[::-1] > small)) if np.any(sizes > small) else 1
        series = np.take(series, range(kept), axis=axis)
    return series


def _nodes(a: float, b: float, n: int) -> Float:
    return 0.5 * (a + b) + 0.5 * (b - a) * chebyshev.lobatto(n)
