"""What is proven of a chart's cells: the cell of a point is all that is nearest to it."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.axis import Axis
from compare.charts.scenario import Scenario
from compare.jobs.workers import MapLike
from floquet import enclose_region
from floquet.enclosure.result import RegionProof
from hill import HillEquation, SteppedBeam, UniformBeam
from hill.decimals import fraction

MAX_CELLS = 4_000_000
"""A million take 40 s of one core and 0.8 GB, chart included."""


@dataclass(frozen=True, eq=False)
class Certified:
    """What is proven of the cells of a chart.

    Attributes
    ----------
    cells : ndarray of str
        Like `Chart.T`: "stable" or "unstable" where that is proven of every point of the cell,
        which is all of the chart that is nearer to this point of its grid than to another, ends
        included; else "undecided".
    stable, unstable, undecided : float
        Shares of the chart's area in Omega and gamma, proven part by part, cells that a boundary
        crosses included.
    whole : float
        Share of the cells that are proven whole.
    enclosures : int
        At how many points P was enclosed.
    remainder : float
        Bound on what the polynomial through them leaves out of P's coefficients.
    decimals : bool
        Whether it is of a beam's parameters as they are written, and of matrices made from them in
        ball arithmetic; otherwise of the system's matrices as floats.
    seconds : float
        Time taken.
    """

    cells: NDArray[np.str_]
    stable: float
    unstable: float
    undecided: float
    whole: float
    enclosures: int
    remainder: float
    decimals: bool
    seconds: float

    def contradicted(self, verdict: NDArray[np.str_]) -> int:
        """How many points of the grid have another verdict than is proven of their cells."""
        shown = (verdict != "undecided") & (self.cells != "undecided")
        return int(np.sum(shown & (verdict != self.cells)))


def certify(
    of: Scenario, run: MapLike, progress: Callable[[str, int, int], Any] | None
) -> Certified:
    """Prove what can be proven of a chart's cells.

    Raises
    ------
    ValueError
        Other axes than Omega and gamma, matrices that move with Omega, damping that is no number,
        too many cells; as `floquet.enclose_region`.
    """
    if set(of.names) != {"Omega", "gamma"}:
        raise ValueError(
            f"certify: needs a chart of Omega and gamma, this is one of {' and '.join(of.names)}"
        )
    count = int(np.prod([axis.count for axis in of.axes]))
    if count > MAX_CELLS:
        raise ValueError(f"certify: {count:,} cells, {MAX_CELLS:,} at most; ask for fewer points")
    started, what = time.perf_counter(), _provable(of)
    edges = {axis.name: _edges(axis) for axis in of.axes}
    eta = 0.0 if isinstance(what, HillEquation) else of.forcing["eta"]
    proof: RegionProof = enclose_region(
        what, Omega=edges["Omega"], gamma=edges["gamma"], eta=eta, over=run, progress=progress
    )
    return Certified(
        cells=np.ascontiguousarray(proof.cells if of.names[0] == "Omega" else proof.cells.T),
        stable=proof.share("stable"),
        unstable=proof.share("unstable"),
        undecided=proof.share("undecided"),
        whole=proof.whole,
        enclosures=proof.nodes,
        remainder=proof.remainder,
        decimals=not isinstance(what, HillEquation),
        seconds=time.perf_counter() - started,
    )


def _provable(of: Scenario) -> Any:
    """A beam itself; of anything else an equation, whose F and G must be those of every Omega."""
    if isinstance(of.system, UniformBeam | SteppedBeam):
        return of.system
    middle = {axis.name: 0.5 * (axis.low + axis.high) for axis in of.axes}
    equation = None if of.reading.general else of.equation(middle)
    if not isinstance(equation, HillEquation) or equation.H or np.ndim(equation.eta):
        raise ValueError(
            "certify: needs a HillEquation without H whose damping is one number, "
            f"{type(of.system).__name__} has none"
        )
    if getattr(of.system, "depends_on_Omega", True):
        raise ValueError(
            f"certify: the matrices of {type(of.system).__name__} may move with Omega; a system "
            "whose do not says so by depends_on_Omega = False"
        )
    return equation


def _edges(axis: Axis) -> list[Fraction]:
    """The cells' ends: those of the axis, and midway between its points."""
    low, high = fraction(axis.name, axis.low), fraction(axis.name, axis.high)
    last = axis.count - 1
    between = (low + (high - low) * Fraction(2 * k + 1, 2 * last) for k in range(last))
    return [low, *between, high]
