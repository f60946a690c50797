"""SUNDIALS' variable-order Adams method, by CasADi, on the equation as it stands."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from floquet.arrays import Float
from floquet.integrate.ode import Parameters, Shape, acceleration, symbols


@dataclass(frozen=True)
class Cvodes:
    """SUNDIALS' variable-order Adams method on the equation as it stands.

    Parameters
    ----------
    tolerance : float
        Relative and absolute; 1e-14 is the tightest that does not stall, 6e-12 is what it gives.
    """

    tolerance: float = 1e-14

    def __call__(self, p: Parameters, size: Shape, time: float) -> Float:
        """Fundamental matrix at `time`."""
        integrator = _integrator(size, self.tolerance)
        packed = ca.vertcat(time, *(ca.vec(ca.DM(value)) for value in p))
        end = integrator(x0=np.eye(2 * size.n).ravel(order="F"), p=packed)["xf"]
        return np.asarray(end).reshape((2 * size.n, 2 * size.n), order="F")


@lru_cache(maxsize=32)
def _integrator(size: Shape, tolerance: float) -> Any:
    """Integrator over x in [0, 1], tau = time x, with the time a parameter."""
    n = size.n
    p, x, time = symbols(ca.SX, size), ca.SX.sym("x"), ca.SX.sym("time")
    X = ca.SX.sym("X", 2 * n, 2 * n)
    rise = ca.vertcat(X[n:, :], acceleration(X[:n, :], X[n:, :], time * x, p, size))
    dae = {
        "x": ca.vec(X),
        "t": x,
        "p": ca.vertcat(time, *(ca.vec(value) for value in p)),
        "ode": ca.vec(time * rise),
    }
    return adams(dae, tolerance)


def adams(dae: dict[str, Any], tolerance: float) -> Any:
    """SUNDIALS' Adams method on a system from 0 to 1, with one tolerance for all."""
    options: dict[str, Any] = {
        "reltol": tolerance,
        "abstol": tolerance,
        "linear_multistep_method": "adams",
        "nonlinear_solver_iteration": "functional",
        "max_num_steps": 10_000_000,
    }
    return ca.integrator("cvodes", "cvodes", dae, 0.0, 1.0, options)
