"""How fast this machine could do it at best: operations and bytes a point, counted and measured."""

from collections import deque
from collections.abc import Callable, Sequence
from functools import partial
from math import ceil
from typing import Any

import numpy as np

from benchmarks.measure import timed
from benchmarks.ours import drawn
from benchmarks.systems import Float, Points
from compare.charts import chebyshev
from compare.charts.grid import BLOCK
from compare.stability.roots import growth
from floquet.batch.numpy_kernel import ORDER, TOLERANCE
from floquet.integrate.step_length import longest_step

SIDE = 1024
"""Of the matrices multiplied."""
LARGE, SMALL = 1 << 23, 1 << 12
"""Floats copied: 64 MB, far beyond the caches, and 32 kB, in the first of them."""
TRIES = 5
SLOW = {"arccos", "cos", "cbrt", "log1p", "hypot", "sqrt", "divide", "exp", "log"}
"""Elementwise functions that take many operations each; every one counts as one here."""


def machine() -> dict[str, float]:
    """Measured: operations a second in a matrix product, bytes a second in a copy (both ways)."""
    a, b = (np.random.default_rng(k).random((SIDE, SIDE)) for k in range(2))
    product = min(timed(partial(np.matmul, a, b)) for _ in range(TRIES))
    found = {"flops": 2.0 * SIDE**3 / product}
    for name, size in (("memory", LARGE), ("cache", SMALL)):
        source, target = np.ones(size), np.ones(size)
        copy = min(timed(partial(np.copyto, target, source)) for _ in range(TRIES))
        found[name] = 16.0 * size / copy
    return found


def chart_parts(count: int, tolerance: float) -> dict[str, Any]:
    """An interpolated chart's parts: nodes, series, roots; operations and bytes a point, seconds.

    Parameters
    ----------
    count : int
        Points of the chart.
    tolerance : float
        Of the chart.
    """
    found = drawn(count, "floquet", tolerance)
    seconds = timed(lambda: drawn(count, "floquet", tolerance))
    smallest = timed(lambda: drawn(100, "floquet", tolerance))
    sides = [len(axis.points) for axis in found.axes]
    total = sides[0] * sides[1]
    flops = series_seconds = 0.0
    stacked: list[Float] = []
    for piece in found.surface.pieces:
        if piece.series is None:
            continue
        # each piece at its share of the points, so that their sum is the chart
        shape = (max(2, sides[0] // len(found.surface.pieces)), sides[1])
        local = tuple(np.linspace(-1.0, 1.0, k) for k in shape)
        series_seconds += timed(partial(_evaluate, piece.series, local))
        n, x, y = piece.series.shape
        flops += 2.0 * n * x * y * shape[0] + 2.0 * n * y * shape[0] * shape[1]
        stacked += [P for _, P in chebyshev.on_blocks(piece.series, local, BLOCK)]
    P = np.concatenate(stacked, axis=1)
    roots = timed(lambda: growth(P)) / P.shape[1]
    return {
        "points": total,
        "seconds": seconds / total,
        "nodes": found.nodes,
        "nodes_seconds": smallest,
        "series_flops": flops / total,
        "series_seconds": series_seconds / total,
        "roots_seconds": roots,
        "bytes": 8.0,
        "pieces": len(found.surface.pieces),
        **elementwise(growth, P[:, : 1 << 13]),
    }


def _evaluate(series: Float, local: Sequence[Float]) -> None:
    deque(chebyshev.on_blocks(series, local, BLOCK), maxlen=0)


def elementwise(function: Callable[[Any], Any], P: Float) -> dict[str, float]:
    """What a function of arrays does to a column: operations, slow ones, bytes moved.

    What it does outside numpy is not seen.
    """
    tally = {"roots_operations": 0.0, "roots_slow": 0.0, "roots_bytes": 0.0}

    class Counted(np.ndarray[Any, Any]):
        """An array that counts what is done to it."""

        def __array_ufunc__(
            self, ufunc: Any, method: str, *inputs: Any, out: Any = None, **options: Any
        ) -> Any:
            arrays = [_plain(x) for x in inputs]
            options = {name: _plain(value) for name, value in options.items()}
            if out is not None:
                options["out"] = tuple(_plain(x) for x in out)
            return note(ufunc.__name__, arrays, getattr(ufunc, method)(*arrays, **options))

        def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
            plain = [_plain(x) for x in args]
            named = {name: _plain(x) for name, x in kwargs.items()}
            return note(function.__name__, plain, function(*plain, **named))

    def note(name: str, inputs: list[Any], result: Any) -> Any:
        if not isinstance(result, np.ndarray):
            return result
        moved = sum(x.nbytes for x in inputs if isinstance(x, np.ndarray)) + result.nbytes
        if not name.startswith(("empty", "ones", "zeros", "full")):
            tally["roots_operations"] += result.size
            tally["roots_slow"] += result.size if name in SLOW else 0
            tally["roots_bytes"] += moved
        return result.view(Counted)

    function(P.view(Counted))
    return {name: value / P.shape[1] for name, value in tally.items()}


def _plain(value: Any) -> Any:
    return value.view(np.ndarray) if isinstance(value, np.ndarray) else value


def batch_work(points: Points) -> dict[str, float]:
    """A direct batch: Taylor steps, operations and bytes a point, on average over some points.

    The recurrence of `floquet.batch.numpy_kernel`: for each of its powers the Cauchy product with
    the cosine, two n-by-n matrices times n-by-2n columns, and a division.
    """
    n, order = points.n, ORDER
    nothing = np.zeros((n, n))
    steps = []
    for Omega, gamma in zip(points.Omega, points.gamma, strict=True):
        x = 1.0 / Omega**2
        terms = [(x * points.F, 0.0), (gamma * x * points.G, 1.0)]
        steps.append(ceil(np.pi / longest_step(terms, nothing, order, TOLERANCE)))
    columns = n * 2 * n
    cauchy = sum(2.0 * (j + 1) * columns for j in range(order - 1))
    products = (order - 1) * (2.0 * 2 * n * columns + 3.0 * columns)
    end = 3.0 * (order + 1) * columns
    mean = float(np.mean(steps))
    # in: Omega, gamma, eta; out: n + 1 coefficients and their bound
    return {
        "n": n,
        "order": order,
        "steps": mean,
        "flops": mean * (cauchy + products + end),
        "bytes": 8.0 * (3 + n + 2),
    }
