"""A chart: T on its grid, and the solution anywhere in it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compare.charts import nodes, surface
from compare.charts.axis import Axis
from compare.charts.certified import Certified
from compare.charts.grid import Cells, Omega_and_eta, from_series, on_mesh
from compare.charts.scenario import Scenario
from compare.stability.points import (
    UNDECIDED,
    UNSTABLE,
    VERDICTS,
    Codes,
    Points,
    codes,
)
from hill import Singular

Float = NDArray[np.floating[Any]]

MAX_ASKED_AGAIN = 10_000
"""Points that the series leaves undecided and that are then evaluated: a second or two."""


@dataclass(frozen=True, eq=False)
class Chart:
    """T over a grid of parameters.

    Attributes
    ----------
    scenario : Scenario
        The system, its axes and what is fixed. The first axis is the fastest to vary when drawn: x,
        then y.
    T : ndarray
        Characteristic argument (7.1.1), shape (..., points of y, points of x).
    error : float
        Bound on the absolute error of the interpolated coefficients of P; of those evaluated
        directly where none is interpolated.
    relative_error : float
        The same over P's largest coefficient, in the same rectangle or at the same point.
    checked : float or None
        Largest difference from direct evaluation at random points; never above `error`. None where
        nothing could be checked.
    checks : int
        At how many of 40 random points; the others have no series, or direct evaluation knows P
        less well than the series there.
    disagreement : float
        Largest difference between the two routes at the nodes, over the largest coefficient of P,
        where both know P well enough to tell; nan where only one route was asked.
    sampled : (nodes, axes) ndarray
        Where P was evaluated.
    apart : (nodes,) ndarray
        Difference between the two routes there, as `disagreement`; nan where P is not known well
        enough to tell, as next to a pole.
    one_by_one : dict of str to int
        Why points of the grid were evaluated without a series, and how many.
    resumed : int
        Nodes that were already on disk.
    route : str
        Who evaluated the nodes.
    surface : Surface
        The interpolant, for further use.
    alone : tuple of Cells
        What was evaluated one by one.
    certified : Certified or None
        What is proven of its cells; None where it was not asked for.
    seconds : float
        Time taken, nodes included, what was certified not.
    """

    scenario: Scenario
    T: Float
    error: float
    relative_error: float
    checked: float | None
    checks: int
    disagreement: float
    sampled: Float
    apart: Float
    one_by_one: dict[str, int]
    resumed: int
    route: str
    surface: surface.Surface
    alone: tuple[Cells, ...]
    certified: Certified | None
    seconds: float

    @property
    def axes(self) -> tuple[Axis, ...]:
        """x, y and more."""
        return self.scenario.axes

    @property
    def system(self) -> Any:
        """What is charted; its varied parameters at the values that it was given with."""
        return self.scenario.system

    @property
    def nodes(self) -> int:
        """Evaluations of P, points of the grid among them that have no series."""
        return len(self.sampled)

    @property
    def direct(self) -> int:
        """Grid points evaluated one by one."""
        return sum(self.one_by_one.values())

    @property
    def shared_matrices(self) -> bool:
        """Whether both routes had the same matrices, so that only the solution is checked."""
        return self.scenario.shared_matrices

    @property
    def routes_agree(self) -> bool:
        """Whether the routes differ by no more than P's error allows; True where one was asked."""
        return self.route != "both" or self.disagreement <= max(self.relative_error, nodes.SAME)

    @property
    def contradicted(self) -> int:
        """Points whose verdict is another than is proven of their cells: an error somewhere."""
        return 0 if self.certified is None else self.certified.contradicted(self.verdict())

    def at(self, **values: ArrayLike) -> Points:
        """z, R, T and the verdict at any points within the axes.

        Parameters
        ----------
        **values : array_like
            One for each axis, by its name; broadcast against each other to k points.

        Raises
        ------
        ValueError
            An axis without values, a name that is no axis, a value beyond its ends; a point at
            which the system has no equation, on an undamped longitudinal resonance, say.
        """
        return _at(self, values)

    def verdict(self) -> NDArray[np.str_]:
        """What is shown on the grid, like `T`: "stable", "unstable" or "undecided".

        Undecided next to boundaries, on undamped lines where z meet (gamma = 0 at a resonance), and
        on a pole, where there is no equation.
        """
        return np.array(VERDICTS)[self._verdict]

    def unstable(self) -> NDArray[np.bool_]:
        """Where on the grid the system is shown to be unstable, like `T`."""
        return np.asarray(self._verdict == UNSTABLE)

    def undecided(self) -> NDArray[np.bool_]:
        """Where on the grid neither is shown, like `T`."""
        return np.asarray(self._verdict == UNDECIDED)

    def T_error(self) -> Float:
        """Bound on the error of `T`, like it; infinite where nothing is known.

        Takes longer than T itself: about 20 microseconds a point that is not shown to be stable.
        """
        return self._T_error

    def save(self, path: str | Path, *, title: str = "") -> None:
        """Write the chart to a file, whole or not at all.

        Parameters
        ----------
        path : path
            Its suffix says as what: .html a page to explore, .png and .svg a picture, .npz, .json
            and .csv numbers. On a chart of Omega and one other parameter pages, pictures and .json
            have the tongues.
        title : str, optional
            What the system is called, on pages and pictures.

        Raises
        ------
        ValueError
            Another suffix; the file cannot be written; too many axes for a picture or a page; what
            draws it is not installed.
        """
        from compare.chart_saving import save

        save(self, Path(path), title)

    def _repr_html_(self) -> str:
        from compare.notebook import of_chart

        return of_chart(self)

    @cached_property
    def _verdict(self) -> Codes:
        """Which of `VERDICTS`, a byte a point."""
        result = np.full(self.T.shape, UNDECIDED, np.int8)
        for cells, Omega, eta in self._cells():
            own = np.full(cells.P.shape[1], UNDECIDED, np.int8)
            # P beyond a float has a root beyond any edge
            own[np.any(np.isinf(cells.P), axis=0)] = UNSTABLE
            own[cells.there] = self.scenario.reading.verdicts(*self._known(cells, Omega, eta))
            result.T[cells.where] = own.reshape(cells.shape)
        self._ask_again(result)
        return result

    def _ask_again(self, verdict: Codes) -> None:
        """Decide by direct evaluation, which knows P better, what the series leaves undecided."""
        undecided = verdict == UNDECIDED
        undecided &= np.isfinite(self.T)
        count = int(np.count_nonzero(undecided))
        if not 0 < count <= MAX_ASKED_AGAIN or not any(
            piece.series is not None for piece in self.surface.pieces
        ):
            return
        index = np.nonzero(undecided.T)
        values = [axis.points[i] for axis, i in zip(self.axes, index, strict=True)]
        P, error = directly(self, np.column_stack(values))
        named = dict(zip(self.scenario.names, values, strict=True))
        Omega, eta = (np.broadcast_to(v, count) for v in Omega_and_eta(self.scenario, named))
        known = np.flatnonzero(np.all(np.isfinite(P), axis=1) & np.isfinite(error))
        found = self.scenario.reading.solve(P[known], error[known], Omega[known], eta[known])
        verdict.T[tuple(i[known] for i in index)] = codes(found.verdict)

    @cached_property
    def _T_error(self) -> Float:
        result = np.full(self.T.shape, np.inf)
        for cells, Omega, eta in self._cells():
            own = np.full(cells.P.shape[1], np.inf)
            known = self._known(cells, Omega, eta)
            own[cells.there] = self.scenario.reading.argument_errors(*known)
            result.T[cells.where] = own.reshape(cells.shape)
        return result

    def _cells(self) -> Iterator[tuple[Cells, Float, Float]]:
        Omega, eta = on_mesh(self.scenario)
        for cells in chain(from_series(self.surface, self.scenario.smooth), self.alone):
            yield cells, cells.spread(Omega), cells.spread(eta)

    def _known(self, cells: Cells, Omega: Float, eta: Float) -> tuple[Float, ...]:
        """P, its error, T, Omega and eta where P is known."""
        T, there = self.T.T[cells.where].ravel(), cells.there
        if np.all(there):
            return cells.P.T, cells.error, T, Omega, eta
        return cells.P[:, there].T, cells.error[there], T[there], Omega[there], eta[there]


def _at(chart: Chart, values: Mapping[str, ArrayLike]) -> Points:
    names = chart.scenario.names
    if set(values) != set(names):
        raise ValueError(f"at: needs {', '.join(names)}; got {', '.join(values) or 'nothing'}")
    arrays = np.broadcast_arrays(*(np.asarray(values[name], float) for name in names))
    for axis, x in zip(chart.axes, arrays, strict=True):
        beyond = ~((x >= axis.low) & (x <= axis.high))
        if np.any(beyond):
            raise ValueError(
                f"{axis.name} = {x[beyond].flat[0]:g}: must be from {axis.low:g} to {axis.high:g}"
            )
    points = np.column_stack([x.ravel() for x in arrays])
    P, error = surface.evaluate(chart.surface, chart.scenario.smooth.to_smooth(points))
    without = ~np.isfinite(error)
    if np.any(without):
        found, own = directly(chart, points[without])
        P = np.full((found.shape[1], len(points)), np.nan) if len(P) == 1 else P
        P[:, without], error[without] = found.T, own
    lost = np.flatnonzero(~np.isfinite(error))
    if len(lost):
        there = dict(zip(names, map(float, points[lost[0]]), strict=True))
        words = ", ".join(f"{name} = {x:g}" for name, x in there.items())
        try:
            chart.scenario.equation(there)
        except Singular as reason:
            raise ValueError(f"{words}: {reason}") from None
        raise ValueError(f"{words}: P is beyond a float, so fast does the solution grow")
    named = dict(zip(names, points.T, strict=True))
    Omega, eta = (np.broadcast_to(v, len(points)) for v in Omega_and_eta(chart.scenario, named))
    return chart.scenario.reading.solve(P.T, error, Omega, eta)


def directly(chart: Chart, points: Float, route: str = "") -> tuple[Float, Float]:
    """P, (k, degree + 1), and its error at values of the axes (k, axes), not from a series.

    By the route that is asked for, or else by the chart's own; of both by floquet.
    """
    named = dict(zip(chart.scenario.names, points.T, strict=True))
    own = "hill" if chart.route == "hill" else "floquet"
    lines = nodes.solved(chart.scenario, named, route or own)
    return lines[:, :-2], lines[:, -2]
