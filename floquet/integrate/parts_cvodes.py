"""SUNDIALS' variable-order Adams method over each part of the period, by CasADi."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from floquet.arrays import Float
from floquet.integrate.cvodes import adams
from floquet.integrate.normal_form import Harmonic, Layout, NormalForm
from floquet.integrate.parts import Grid


@dataclass(frozen=True)
class PartsCvodes:
    """SUNDIALS' variable-order Adams method.

    Parameters
    ----------
    tolerance : float
        Relative, and absolute in units in which the fastest motion is near 1.
    """

    tolerance: float = 1e-14

    def __call__(self, form: NormalForm, grid: Grid) -> Float:
        """Fundamental matrix of each part, (parts, m, m)."""
        layout, unit, m = form.layout, grid.unit, form.layout.order
        h = form.period / grid.parts / unit
        stiffness = form.stiffness * (unit if layout.first_order else unit * unit)
        shared = [stiffness, form.damping * unit] if layout.damped else [stiffness]
        harmonics = np.array(form.harmonics, int)
        turn = 2.0 * np.pi / grid.parts * harmonics
        integrator = _integrator(layout, self.tolerance)
        found = np.empty((grid.first, m, m))
        for k in range(grid.first):
            phase = 2.0 * np.pi / grid.parts * (harmonics * k % grid.parts)
            matrices = (ca.vec(ca.DM(np.hstack(list(x)))) for x in shared)
            packed = ca.vertcat(h, turn, phase, *matrices)
            end = integrator(x0=np.eye(m).ravel(order="F"), p=packed)["xf"]
            found[k] = np.asarray(end).reshape((m, m), order="F")
        return found


@lru_cache(maxsize=32)
def _integrator(layout: Layout, tolerance: float) -> Any:
    """Integrator over x in [0, 1], from the start of a part to its end."""
    n, m, size = layout.n, layout.order, layout.harmonics
    sym = ca.SX.sym
    x, h, turn, phase = sym("x"), sym("h"), sym("turn", size), sym("phase", size)
    angle = phase + x * turn

    def now(matrix: Any, harmonics: tuple[Harmonic, ...]) -> Any:
        total, *parts = ca.horzsplit(matrix, n)
        for part, (k, is_sine) in zip(parts, harmonics, strict=True):
            total += (ca.sin if is_sine else ca.cos)(angle[k]) * part
        return total

    K = sym("K", n, n * (1 + len(layout.stiffness)))
    given = [K]
    X = sym("X", m, m)
    if layout.first_order:
        rise = now(K, layout.stiffness) @ X
    else:
        Q, V = X[:n, :], X[n:, :]
        force = -now(K, layout.stiffness) @ Q
        if layout.damped:
            C = sym("C", n, n * (1 + len(layout.damping)))
            given.append(C)
            force -= now(C, layout.damping) @ V
        rise = ca.vertcat(V, force)
    packed = ca.vertcat(h, turn, phase, *(ca.vec(value) for value in given))
    return adams({"x": ca.vec(X), "t": x, "p": packed, "ode": ca.vec(h * rise)}, tolerance)
