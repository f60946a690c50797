"""heyoka: Taylor's method compiled for this very equation, one point or several at a time.

The phase theta = Omega tau is its time, so that all points share the span; 1/Omega^2 and
gamma/Omega^2 are run-time parameters; F and G are compiled in. A lane of a batch is one point with
all its columns, or, for large systems, one column of one point. Points are sorted by Omega first,
so that the lanes of a batch take about as many steps.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.reduction import from_half, from_whole
from benchmarks.systems import Contender, Float, Points, Solver

# Above this many coordinates one column a lane compiles and runs quicker than all of them: at 6
# coordinates both run alike, at 13 one column is six times quicker.
WIDE = 5


@dataclass(frozen=True)
class Formulation:
    """How the equation is put to heyoka.

    Attributes
    ----------
    lanes : int
        Points at a time; 0 is the scalar integrator.
    half : bool
        Half a period, all columns; else the whole one.
    all_columns : bool
        Over a whole period: the monodromy matrix; else only the n columns that P(z) needs.
    tolerance : float
        0 for heyoka's own, an ulp.
    high_accuracy : bool
        heyoka's compensated summation.
    """

    lanes: int
    half: bool
    all_columns: bool = True
    tolerance: float = 0.0
    high_accuracy: bool = False


def plain(lanes: int) -> Formulation:
    """As a user would: the monodromy matrix over the whole period, heyoka's defaults."""
    return Formulation(lanes, half=False)


def best(n: int, tolerance: float = 0.0) -> Formulation:
    """The quickest found for n coordinates: eight lanes of AVX-512, half a period or n columns."""
    return Formulation(8, half=n <= WIDE, all_columns=n <= WIDE, tolerance=tolerance)


NARROW = Formulation(8, half=False, all_columns=False)
"""Eight lanes of the n columns that P(z) needs, over the whole period: no inverse to take."""


def all_peers() -> list[Contender]:
    """Scalar and batch, as a user would and at its best.

    Raises
    ------
    ImportError
        heyoka is not installed.
    """
    import heyoka

    wide = int(heyoka.recommended_simd_size())
    return [
        make("heyoka", plain(0)),
        make("heyoka, high accuracy", Formulation(0, half=False, high_accuracy=True)),
        make("heyoka, half period", Formulation(0, half=True)),
        make(f"heyoka batch of {wide}", plain(wide)),
        make("heyoka batch of 8, half period", best(3)),
        make("heyoka batch of 8, n columns", NARROW),
    ]


def make(name: str, formulation: Formulation) -> Contender:
    """A contender of this formulation."""
    f = formulation
    settings = "half period" if f.half else "whole period"
    settings += "" if f.half or f.all_columns else ", n columns"
    settings += f", tolerance {f.tolerance:.0e}" if f.tolerance else ", its own tolerance"
    return Contender(name, settings, lambda points: _solver(points, f), together=f.lanes > 0)


def _solver(points: Points, f: Formulation) -> Solver:
    n = points.n
    needed = 2 * n if f.half or f.all_columns else n
    together = needed if n <= WIDE else 1
    integrator = _integrator(points, f, together)
    columns = np.eye(2 * n)[:, :needed]
    # (groups, state): what each lane of a point starts from
    starts = np.array([columns[:, j : j + together].ravel() for j in range(0, needed, together)])
    end = np.pi if f.half else 2.0 * np.pi

    def solve(points: Points) -> Float:
        order = np.argsort(points.Omega, kind="stable")
        x = 1.0 / points.Omega[order] ** 2
        parameters = np.array([x, points.gamma[order] * x])
        groups = len(starts)
        if f.lanes == 0:
            ends = _one_by_one(integrator, parameters, starts[0], end)
        elif groups == 1:
            ends = _side_by_side(integrator, parameters, starts, end, f.lanes)
        else:
            many = np.repeat(parameters, groups, axis=1)
            ends = _side_by_side(integrator, many, starts, end, f.lanes)
        k = len(points)
        apart = ends.reshape(k, groups, 2 * n, together)
        U = np.moveaxis(apart, 1, 2).reshape(k, 2 * n, needed)
        P = np.empty((k, n + 1))
        P[order] = (from_half if f.half else from_whole)(U, n)
        return P

    return solve


def _integrator(points: Points, f: Formulation, together: int) -> Any:
    """The equation u'' = -(x F + y cos(theta) G) u for `together` columns, as first order."""
    import heyoka as hy

    n = points.n
    u = [[hy.expression(f"u{i}_{j}") for j in range(together)] for i in range(n)]
    v = [[hy.expression(f"v{i}_{j}") for j in range(together)] for i in range(n)]
    pulse = hy.par[1] * hy.cos(hy.time)

    def force(i: int, j: int) -> Any:
        constant = hy.sum([float(points.F[i, k]) * u[k][j] for k in range(n)])
        pulsating = hy.sum([float(points.G[i, k]) * u[k][j] for k in range(n)])
        return -(hy.par[0] * constant) - pulse * pulsating

    places = [(i, j) for i in range(n) for j in range(together)]
    system = [(u[i][j], v[i][j]) for i, j in places]
    system += [(v[i][j], force(i, j)) for i, j in places]
    options: dict[str, Any] = {"high_accuracy": f.high_accuracy}
    if f.tolerance:
        options["tol"] = f.tolerance
    size = 2 * n * together
    if f.lanes == 0:
        return hy.taylor_adaptive(system, np.zeros(size), pars=np.zeros(2), **options)
    if f.lanes == 8:
        options["force_avx512"] = True
    zeros = np.zeros((size, f.lanes)), np.zeros((2, f.lanes))
    return hy.taylor_adaptive_batch(system, zeros[0], pars=zeros[1], **options)


def _one_by_one(integrator: Any, parameters: Float, start: Float, end: float) -> Float:
    ends = np.empty((parameters.shape[1], len(start)))
    for k, pair in enumerate(parameters.T):
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.pars[:] = pair
        integrator.propagate_until(end)
        ends[k] = integrator.state
    return ends


def _side_by_side(
    integrator: Any, parameters: Float, starts: Float, end: float, lanes: int
) -> Float:
    """A batch at a time; the last one is filled up with what it already has."""
    groups, count = len(starts), parameters.shape[1]
    padded = -(-count // lanes) * lanes
    index = np.minimum(np.arange(padded), count - 1)
    filled = parameters[:, index]
    begin = starts.T[:, index % groups] if groups > 1 else np.repeat(starts.T, lanes, axis=1)
    ends = np.empty((padded, starts.shape[1]))
    for s in range(0, padded, lanes):
        integrator.set_time(0.0)
        integrator.state[:] = begin[:, s : s + lanes] if groups > 1 else begin
        integrator.pars[:] = filled[:, s : s + lanes]
        integrator.propagate_until(end)
        ends[s : s + lanes] = integrator.state.T
    return ends[:count]
