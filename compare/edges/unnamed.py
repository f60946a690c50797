"""Unstable regions of a chart that no tongue covers: nothing coloured stays without a word."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, label

from compare.charts.result import Chart
from compare.edges.interpolated import axes_of
from compare.edges.tongue import Tongue

Float = NDArray[np.floating[Any]]

# Edges are straight between stations: on six charts of the report's beams, of 300 x 200 to 1000 x
# 1000 points, they left pieces of at most 3 cells uncovered, of at most 2 once one cell is added;
# what no tongue had was 12 cells or more.
CELLS_BEYOND_EDGES = 1
MIN_CELLS = 4


@dataclass(frozen=True)
class Region:
    """An unstable region of the grid.

    Attributes
    ----------
    extent : tuple of (name, low, high)
        Along each axis.
    cells : int
    T : float
        The largest in it.
    at : tuple of float
        Omega and the other parameter where it is.
    """

    extent: tuple[tuple[str, float, float], ...]
    cells: int
    T: float
    at: tuple[float, float]


def unnamed(chart: Chart, tongues: Sequence[Tongue]) -> tuple[Region, ...]:
    """Connected unstable cells that are in no tongue, the largest T first.

    Parameters
    ----------
    chart : Chart
        Of Omega and one other parameter.
    tongues : sequence of Tongue
        Those that are known.
    """
    Omega, y = axes_of(chart)
    # rows are y, columns Omega, whichever is drawn upwards
    turned = chart.axes[0] is y
    unstable = chart.unstable().T if turned else chart.unstable()
    T = chart.T.T if turned else chart.T
    return uncovered(Omega.points, y.points, unstable, T, tongues, y.name)


def uncovered(
    Omega: Float,
    y: Float,
    unstable: NDArray[np.bool_],
    T: Float,
    tongues: Sequence[Tongue],
    other: str,
) -> tuple[Region, ...]:
    """The same of any grid.

    Parameters
    ----------
    Omega, y : ndarray
        Its points, ascending.
    unstable, T : (points of y, points of Omega) ndarray
    tongues : sequence of Tongue
    other : str
        What y is.
    """
    covered = np.zeros(unstable.shape, bool)
    for tongue in tongues:
        rows = np.flatnonzero((y >= tongue.y[0]) & (y <= tongue.y[-1]))
        low = np.interp(y[rows], tongue.y, tongue.lower)
        high = np.interp(y[rows], tongue.y, tongue.upper)
        x = Omega[None, :]
        covered[rows] |= (x >= low[:, None]) & (x <= high[:, None])
    covered = binary_dilation(covered, iterations=CELLS_BEYOND_EDGES)
    marks, count = label(unstable & ~covered)
    found = []
    for k in range(1, count + 1):
        rows, columns = np.nonzero(marks == k)
        if len(rows) >= MIN_CELLS:
            extent = (
                ("Omega", *_ends(Omega[columns])),
                (other, *_ends(y[rows])),
            )
            top = int(np.argmax(T[rows, columns]))
            at = float(Omega[columns[top]]), float(y[rows[top]])
            found.append(Region(extent, len(rows), float(T[rows[top], columns[top]]), at))
    return tuple(sorted(found, key=lambda region: -region.T))


def _ends(values: Float) -> tuple[float, float]:
    return float(values.min()), float(values.max())
