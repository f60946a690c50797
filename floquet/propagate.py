"""From the identity at tau = 0 to the fundamental matrix at tau = `time`: one object a method."""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, factorial, log2
from typing import Any, Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from floquet.ode import Parameters, Shape, acceleration, symbols
from floquet.steps import Term, longest_step

Float = NDArray[np.floating[Any]]

# SX expands every scalar operation: quicker to run, slower to build. Measured: at this many of
# them both take about as long for ten calls, and a build stays under 0.2 s.
SX_OPERATIONS = 60_000

# Steps in one fold, whose inputs are held side by side; and the most of them in one period.
FOLDED = 1024
MOST_STEPS = 1_000_000


class Propagator(Protocol):
    """A way to integrate the matrix equation from 0 to `time`."""

    def __call__(self, p: Parameters, size: Shape, time: float) -> Float:
        """Return the fundamental matrix of (q, q') at `time`, shape (2n, 2n)."""
        ...


def terms(p: Parameters, size: Shape) -> list[Term]:
    """Stiffness matrices with the frequencies of their cosines."""
    free = [(p.H[:, s * size.n : (s + 1) * size.n], (s + 1) * p.omega_L) for s in range(size.terms)]
    return [(p.F, 0.0), (p.gamma * p.G, p.Omega), *free]


@dataclass(frozen=True)
class Taylor:
    """Taylor steps of fixed order, the coefficients by recurrence, folded over the time.

    Parameters
    ----------
    order : int
        Highest power of the step kept.
    tolerance : float
        What a step may leave out, of the solution's size; the default is below an ulp.
    """

    order: int = 24
    tolerance: float = 1e-17

    def __call__(self, p: Parameters, size: Shape, time: float) -> Float:
        """Fundamental matrix at `time`."""
        needed = ceil(time / longest_step(terms(p, size), p.C, self.order, self.tolerance))
        if needed > MOST_STEPS:
            raise ValueError(
                f"Omega = {p.Omega:g}: too small, one period needs {needed:,} Taylor steps "
                f"(at most {MOST_STEPS:,})"
            )
        steps = bucket(min(needed, FOLDED))
        return self.march(p, size, time, steps, ceil(needed / steps))

    def march(self, p: Parameters, size: Shape, time: float, steps: int, folds: int = 1) -> Float:
        """The same with a given number of steps, `folds` times as many as one fold has."""
        h = time / (folds * steps)
        fold = folded(size, self.order, steps)
        wide = [np.tile(value, (1, steps)) for value in p]
        X = np.eye(2 * size.n)
        for k in range(folds):
            start = h * np.arange(k * steps, (k + 1) * steps)[None, :]
            X = fold(X, start, np.full((1, steps), h), *wide)
        return np.asarray(X)


def bucket(steps: int) -> int:
    """Round up to 2^k or 3 2^(k-1), so that few folds are built and kept."""
    power = 1 << ceil(log2(max(steps, 2)))
    return power * 3 // 4 if steps <= power * 3 // 4 else power


@lru_cache(maxsize=64)
def folded(size: Shape, order: int, steps: int) -> Any:
    """`steps` steps as one CasADi function: inputs other than the state are side by side."""
    return _step(size, order).fold(steps)


@lru_cache(maxsize=64)
def _step(size: Shape, order: int) -> Any:
    """One step of length h from (Q, V) at tau, as a CasADi function."""
    n = size.n
    operations = n * n * order * (order + 4 * n) * (2 + size.terms)
    kind: Any = ca.SX if operations < SX_OPERATIONS else ca.MX
    p = symbols(kind, size)
    X, tau, h = kind.sym("X", 2 * n, 2 * n), kind.sym("tau"), kind.sym("h")

    cosines = [(p.gamma * p.G, _cosine(p.Omega, tau, h, order))]
    for s, H_s in enumerate(ca.horzsplit(p.H, n) if size.terms else [], start=1):
        cosines.append((H_s, _cosine(s * p.omega_L, tau, h, order)))

    # q(tau + x h) = sum_k a_k x^k, so q'' = -C q' - [F + sum cos] q reads, power by power,
    # (k+1)(k+2) a_(k+2) = -h (k+1) C a_(k+1) - h^2 (F a_k + sum_j cos_j a_(k-j))
    a = [X[:n, :], h * X[n:, :]]
    for k in range(order - 1):
        force = p.F @ a[k]
        for matrix, cosine in cosines:
            force += matrix @ sum(cosine[j] * a[k - j] for j in range(k + 1))
        a.append(-(h * (k + 1) * (p.C @ a[k + 1]) + h * h * force) / ((k + 1) * (k + 2)))
    Q = sum(reversed(a))
    V = sum(k * a[k] for k in reversed(range(1, order + 1))) / h
    return ca.Function("step", [X, tau, h, *p], [ca.vertcat(Q, V)])


def _cosine(frequency: Any, tau: Any, h: Any, order: int) -> list[Any]:
    """Taylor coefficients of cos(frequency (tau + x h)) in x."""
    c, s = ca.cos(frequency * tau), ca.sin(frequency * tau)
    turn = [c, -s, -c, s]
    return [turn[j % 4] * (frequency * h) ** j / factorial(j) for j in range(order)]


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
    options: dict[str, Any] = {
        "reltol": tolerance,
        "abstol": tolerance,
        "linear_multistep_method": "adams",
        "nonlinear_solver_iteration": "functional",
        "max_num_steps": 10_000_000,
    }
    return ca.integrator("cvodes", "cvodes", dae, 0.0, 1.0, options)
