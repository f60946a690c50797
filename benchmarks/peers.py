"""SciPy and CasADi: general integrators on the matrix equation, one point at a time.

Each is there twice: the monodromy matrix over the whole period, as one would write it down, and
over half a period, which the symmetry of the equation allows (docs/theory.md, section 3).
"""

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.reduction import from_half, from_whole
from benchmarks.systems import Contender, Float, Points, Solver

TIGHT = {"DOP853": 3e-14, "LSODA": 1e-12, "cvodes Adams": 1e-14, "cvodes BDF": 1e-12}
"""As tight as each will go without stalling."""


def all_peers() -> list[Contender]:
    """Every method at its tightest, over a whole period and over half of one."""
    return [
        make(method, tolerance, half)
        for method, tolerance in TIGHT.items()
        for half in (False, True)
    ]


def make(method: str, tolerance: float, half: bool) -> Contender:
    """One method at one tolerance, relative and absolute."""
    library = "CasADi" if method.startswith("cvodes") else "SciPy"
    build = _casadi if library == "CasADi" else _scipy
    return Contender(
        f"{library} {method}" + (", half period" if half else ""),
        f"{'half' if half else 'whole'} period, tolerance {tolerance:.0e}",
        lambda points: _solver(
            build(points, method, tolerance, np.pi if half else 2 * np.pi), half
        ),
    )


Integrate = Callable[[float, float], Float]
"""(Omega, gamma) to the fundamental matrix of (q, dq/dtheta), theta = Omega tau."""


def _solver(integrate: Integrate, half: bool) -> Solver:
    def solve(points: Points) -> Float:
        U = np.array([integrate(w, g) for w, g in zip(points.Omega, points.gamma, strict=True)])
        return (from_half if half else from_whole)(U, points.n)

    return solve


def _scipy(points: Points, method: str, tolerance: float, end: float) -> Integrate:
    n, F, G = points.n, -points.F, -points.G
    start = np.eye(2 * n).ravel()

    def integrate(Omega: float, gamma: float) -> Float:
        constant, pulsating = F / Omega**2, G * (gamma / Omega**2)
        rise = np.empty((2 * n, 2 * n))

        def slope(theta: float, x: Float) -> Float:
            X = x.reshape(2 * n, 2 * n)
            rise[:n] = X[n:]
            np.matmul(constant + np.cos(theta) * pulsating, X[:n], out=rise[n:])
            return rise.ravel().copy()

        found = solve_ivp(
            slope, (0.0, end), start, method=method, rtol=tolerance, atol=tolerance, t_eval=[end]
        )
        return np.asarray(found.y[:, -1]).reshape(2 * n, 2 * n)

    return integrate


def _casadi(points: Points, method: str, tolerance: float, end: float) -> Integrate:
    n = points.n
    X, theta, p = ca.SX.sym("X", 2 * n, 2 * n), ca.SX.sym("theta"), ca.SX.sym("p", 2)
    stiffness = p[0] * ca.DM(points.F) + p[1] * ca.cos(theta) * ca.DM(points.G)
    rise = ca.vertcat(X[n:, :], -stiffness @ X[:n, :])
    options: dict[str, Any] = {"reltol": tolerance, "abstol": tolerance, "max_num_steps": 10**7}
    if method == "cvodes Adams":
        options |= {
            "linear_multistep_method": "adams",
            "nonlinear_solver_iteration": "functional",
        }
    dae = {"x": ca.vec(X), "t": theta, "p": p, "ode": ca.vec(rise)}
    integrator = ca.integrator("peer", "cvodes", dae, 0.0, end, options)
    start = np.eye(2 * n).ravel()

    def integrate(Omega: float, gamma: float) -> Float:
        found = integrator(x0=start, p=[1.0 / Omega**2, gamma / Omega**2])["xf"]
        return np.asarray(found).reshape((2 * n, 2 * n), order="F")

    return integrate
