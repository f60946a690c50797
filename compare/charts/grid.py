"""P on a chart's grid, a block at a time: from its series, or evaluated where it has none."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts import chebyshev
from compare.charts.axis import Axis
from compare.charts.scenario import Scenario
from compare.charts.surface import Piece, Surface

Float = NDArray[np.floating[Any]]
Values = Mapping[str, Any]

BLOCK = 1 << 15
"""Points at a time: P of a block stays in the cache, and P of all is never there at once."""


@dataclass(frozen=True, eq=False)
class Cells:
    """A part of the grid.

    Attributes
    ----------
    chosen : list of int ndarray
        Which points along each axis.
    P : (degree + 1, k) ndarray
        Of the points, the last axis running fastest. Columns of nan where there is no equation, of
        infinities where P is beyond a float.
    error : (k,) ndarray
        Bound on the error of the coefficients.
    why : str
        Why they were evaluated one by one; empty where they are from a series.
    """

    chosen: list[NDArray[np.int_]]
    P: Float
    error: Float
    why: str = ""

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each axis."""
        return tuple(map(len, self.chosen))

    @property
    def where(self) -> tuple[slice, ...]:
        """The same as `chosen`: the points of an axis in a rectangle are neighbours."""
        return tuple(slice(int(c[0]), int(c[-1]) + 1) for c in self.chosen)

    @property
    def there(self) -> NDArray[np.bool_]:
        """Where P is finite and known."""
        return np.asarray(np.all(np.isfinite(self.P), axis=0) & np.isfinite(self.error))

    def spread(self, grid: Float) -> Float:
        """A number on the grid as one a point of these cells."""
        # an axis along which the number is the same has one entry
        sizes = zip(self.where, grid.shape, strict=True)
        own = grid[tuple(where if n > 1 else slice(None) for where, n in sizes)]
        return np.broadcast_to(own, self.shape).ravel()


def _chosen(piece: Piece, axes: Sequence[Axis]) -> list[NDArray[np.int_]]:
    smooth = (axis.to_smooth(axis.points) for axis in axes)
    ends = zip(smooth, piece.low, piece.high, strict=True)
    return [np.flatnonzero((s >= a) & (s <= b)) for s, a, b in ends]


def from_series(fitted: Surface, axes: Sequence[Axis]) -> Iterator[Cells]:
    """What the series give, about `BLOCK` points at a time."""
    for piece in fitted.pieces:
        chosen = _chosen(piece, axes)
        if piece.series is None or any(len(index) == 0 for index in chosen):
            continue
        own = [a.to_smooth(a.points)[i] for a, i in zip(axes, chosen, strict=True)]
        ends = zip(own, piece.low, piece.high, strict=True)
        local = [np.clip((2.0 * s - a - b) / (b - a), -1.0, 1.0) for s, a, b in ends]
        for part, P in chebyshev.on_blocks(piece.series, local, BLOCK):
            there = [index[s] for index, s in zip(chosen, part, strict=True)]
            yield Cells(there, P, np.broadcast_to(piece.error, P.shape[1]))


def one_by_one(
    fitted: Surface,
    axes: Sequence[Axis],
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
    pieces = [(p, _chosen(p, axes)) for p in fitted.pieces if p.series is None]
    pieces = [(p, chosen) for p, chosen in pieces if all(map(len, chosen))]
    counts = [int(np.prod([len(c) for c in chosen])) for _, chosen in pieces]
    if sum(counts) > most:
        raise ValueError(
            f"axes: {sum(counts):,} points have no series ({pieces[0][0].why}) and would go one "
            f"by one, {most:,} at most; ask for fewer points, or a narrower range"
        )
    if not pieces:
        return ()
    points = []
    for _, chosen in pieces:
        own = [axis.points[i] for axis, i in zip(axes, chosen, strict=True)]
        points.append(np.stack([m.ravel() for m in np.meshgrid(*own, indexing="ij")], axis=1))
    P, errors = evaluate(np.concatenate(points))
    ends = np.cumsum(counts)[:-1]
    parts = zip(pieces, np.split(P, ends), np.split(errors, ends), strict=True)
    return tuple(Cells(chosen, p.T, e, piece.why) for (piece, chosen), p, e in parts)


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
