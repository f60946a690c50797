"""P on a chart's grid, a block at a time: from its series, or evaluated where it has none."""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import chebyshev
from compare.charts.scenario import Scenario
from compare.charts.smooth import Part, Smooth, Where, shape_of
from compare.charts.surface import Piece, Surface, to_local

Float = NDArray[np.floating[Any]]
Values = Mapping[str, Any]

BLOCK = 1 << 15
"""Points at a time: P of a block stays in the cache, and P of all is never there at once."""


@dataclass(frozen=True, eq=False)
class Cells:
    """A part of the grid.

    Attributes
    ----------
    where : tuple of slice or of int ndarray
        What picks them out of an array on the grid.
    P : (degree + 1, k) ndarray
        Of the points, the last axis running fastest. Columns of nan where there is no equation, of
        infinities where P is beyond a float.
    error : (k,) ndarray
        Bound on the error of the coefficients.
    why : str
        Why they were evaluated one by one; empty where they are from a series.
    """

    where: Where
    P: Float
    error: Float
    why: str = ""

    @property
    def shape(self) -> tuple[int, ...]:
        """Of what is picked."""
        return shape_of(self.where)

    @property
    def there(self) -> NDArray[np.bool_]:
        """Where P is finite and known."""
        return np.asarray(np.all(np.isfinite(self.P), axis=0) & np.isfinite(self.error))

    def spread(self, grid: Float) -> Float:
        """A number on the grid as one a point of these cells."""
        # an axis along which the number is the same has one entry
        sizes = zip(self.where, grid.shape, strict=True)
        same = (slice(None) if isinstance(w, slice) else np.zeros_like(w) for w in self.where)
        own = grid[tuple(w if n > 1 else one for (w, n), one in zip(sizes, same, strict=True))]
        return np.broadcast_to(own, self.shape).ravel()


def from_series(fitted: Surface, smooth: Smooth) -> Iterator[Cells]:
    """What the series give, about `BLOCK` points at a time."""
    for piece in fitted.pieces:
        part = smooth.part(piece.low, piece.high) if piece.series is not None else None
        if piece.series is None or part is None:
            continue
        blocks = _by_rows if part.counts is not None else _at_once
        for where, P in blocks(piece, piece.series, part, smooth):
            yield Cells(where, P, np.broadcast_to(piece.error, P.shape[1]))


def _at_once(
    piece: Piece, series: Float, part: Part, smooth: Smooth
) -> Iterator[tuple[Where, Float]]:
    """P on a tensor grid."""
    own = [points[i] for points, i in zip(smooth.points, part.chosen, strict=True)]
    local = [to_local(s, a, b) for s, a, b in zip(own, piece.low, piece.high, strict=True)]
    for block, P in chebyshev.on_blocks(series, local, BLOCK):
        first = [int(chosen[0]) for chosen in part.chosen]
        yield tuple(slice(f + s.start, f + s.stop) for f, s in zip(first, block, strict=True)), P


def _by_rows(
    piece: Piece, series: Float, part: Part, smooth: Smooth
) -> Iterator[tuple[Where, Float]]:
    """The same where each row has columns of its own.

    The other axes and that of the rows are summed first, as on a tensor grid; a series in one
    variable is then left to each row, and summed at as many columns as the longest row has.
    """
    assert part.first is not None
    assert part.counts is not None
    rows, columns = part.rows, part.columns
    left = series
    for k in (k for k in range(len(part.chosen)) if k != columns):
        own = to_local(smooth.points[k][part.chosen[k]], piece.low[k], piece.high[k])
        left = chebyshev.along(left, 1 + k, own)
    # rows, coefficients and the other axes, the columns' variable
    left = np.moveaxis(np.moveaxis(left, 1 + columns, -1), 1 + rows - (columns < rows), 0)
    others, longest = left.shape[2:-1], int(part.counts.max())
    left = left.reshape(len(left), -1, left.shape[-1])
    block = max(1, BLOCK // (longest * math.prod(others)))
    for start in range(0, len(left), block):
        own_rows = slice(start, start + block)
        counts = part.counts[own_rows]
        there = part.first[own_rows, None] + np.arange(longest)
        there = np.minimum(there, part.chosen[columns][-1])
        ratio = smooth.ratios(part.chosen[rows][own_rows, None], there)
        at = to_local(ratio, piece.low[columns], piece.high[columns])
        table = chebyshev.basis(at.ravel(), left.shape[-1]).reshape(*at.shape, -1)
        sums = (left[own_rows] @ table.transpose(0, 2, 1)).transpose(0, 2, 1)
        sums = sums[np.arange(longest) < counts[:, None]].reshape(-1, len(series), *others)
        P = np.ones((len(series) + 1, *sums.shape[:1], *others))
        P[1:] = np.moveaxis(sums, 1, 0)
        yield part.where(own_rows), P.reshape(len(P), -1)


def one_by_one(
    fitted: Surface,
    smooth: Smooth,
    evaluate: Callable[[Float], tuple[Float, Float]],
    most: int,
) -> tuple[Cells, ...]:
    """What has no series, evaluated.

    Parameters
    ----------
    evaluate : callable
        Values of the axes (k, axes) to coefficients (k, degree + 1) and errors (k,).
    most : int
        Points that may go one by one.

    Raises
    ------
    ValueError
        There are more.
    """
    found = ((p, smooth.part(p.low, p.high)) for p in fitted.pieces if p.series is None)
    pieces = [(piece, part) for piece, part in found if part is not None]
    counts = [part.count for _, part in pieces]
    if sum(counts) > most:
        raise ValueError(
            f"axes: {sum(counts):,} points have no series ({pieces[0][0].why}) and would go one "
            f"by one, {most:,} at most; ask for fewer points, or a narrower range"
        )
    if not pieces:
        return ()
    mesh = np.broadcast_arrays(*np.ix_(*(axis.points for axis in smooth.axes)))
    places = [part.where() for _, part in pieces]
    points = [np.stack([values[where].ravel() for values in mesh], axis=1) for where in places]
    P, errors = evaluate(np.concatenate(points))
    ends = np.cumsum(counts)[:-1]
    parts = zip(pieces, places, np.split(P, ends), np.split(errors, ends), strict=True)
    return tuple(Cells(where, p.T, e, piece.why) for (piece, _), where, p, e in parts)


def reasons(cells: Sequence[Cells]) -> dict[str, int]:
    """Why points were evaluated one by one, and how many."""
    count: Counter[str] = Counter()
    for part in cells:
        count[part.why] += part.P.shape[1]
    return dict(count.most_common())


def Omega_and_eta(scenario: Scenario, values: Values) -> tuple[Any, Any]:
    """Omega and eta, varied or fixed."""
    given = {**scenario.forcing, **values}
    return given["Omega"], given["eta"]


def on_mesh(scenario: Scenario) -> tuple[Float, Float]:
    """Omega and eta on the grid, with one entry along an axis that does not vary them."""
    mesh = np.ix_(*(axis.points for axis in scenario.axes))
    one = np.ones([1] * len(mesh))
    Omega, eta = Omega_and_eta(scenario, dict(zip(scenario.names, mesh, strict=True)))
    return np.asarray(Omega * one), np.asarray(eta * one)
