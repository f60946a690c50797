"""Our own: one equation at a time, many at a time, and a chart from an interpolated P(z)."""

from importlib import import_module
from importlib.util import find_spec
from inspect import signature
from typing import Any

import numpy as np

from benchmarks.systems import GAMMA, OMEGA, Contender, Float, Points, Solver, beam, grid
from compare.charts.compute import chart
from compare.charts.result import Chart
from floquet import monodromy
from hill import HillEquation, characteristic


def singles() -> list[Contender]:
    """One equation after another: with error bounds, multipliers, T and residuals."""
    return [
        Contender(name, settings, _one_by_one(function), ours=True)
        for name, settings, function in (
            ("floquet", "`monodromy()`, Taylor, checked by a second run", monodromy),
            ("hill", "`characteristic()`, converged", characteristic),
        )
    ]


def batches() -> list[Contender]:
    """Many points in one call, by either route, with every kernel there is."""
    found = []
    for route in ("floquet", "hill"):
        if find_spec(f"{route}.batch") is None:
            continue
        module = import_module(f"{route}.batch")
        # arrays of Omega and gamma where the route takes them; else one equation a point
        arrays = hasattr(module, "sweep")
        function = module.sweep if arrays else module.polynomials
        kernels = ("compiled", "numpy") if "kernel" in signature(function).parameters else ("",)
        for kernel in kernels:
            options = {"kernel": kernel} if kernel else {}
            settings = f"`{route}.batch.{function.__name__}()`"
            name = f"{route} batch" + (f", {kernel}" if kernel else "")
            build = _together(function, arrays, options)
            found.append(Contender(name, settings, build, together=True, ours=True))
    return found


def drawn(count: int, route: str, tolerance: float, workers: int = 1) -> Chart:
    """The chart of T over (Omega, gamma), nodes included."""
    x, y = grid(count)
    return chart(
        beam(),
        [("Omega", *OMEGA, x), ("gamma", *GAMMA, y)],
        route=route,
        tolerance=tolerance,
        workers=workers,
    )


def read(found: Chart, points: Points) -> Float:
    """P(z) at points anywhere in a chart, from its series."""
    return found.at(Omega=points.Omega, gamma=points.gamma).polynomial


def _one_by_one(function: Any) -> Any:
    def build(points: Points) -> Solver:
        function(points.equations[0])  # builds what CasADi keeps
        return lambda points: np.array([function(e).polynomial for e in points.equations])

    return build


def _together(function: Any, arrays: bool, options: dict[str, str]) -> Any:
    def solve(points: Points) -> Float:
        if arrays:
            first = HillEquation(F=points.F, G=points.G, gamma=0.1, Omega=1.0)
            found = function(first, Omega=points.Omega, gamma=points.gamma, **options)
        else:
            found = function(points.equations, **options)
        return np.asarray(found.coefficients)

    def build(points: Points) -> Solver:
        solve(points.first(1))  # compiles, where there is something to compile
        return solve

    return build
