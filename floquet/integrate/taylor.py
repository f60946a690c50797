"""Taylor steps of a fixed order, the coefficients by recurrence in CasADi, folded over the time."""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log2
from typing import Any

import casadi as ca
import numpy as np

from floquet.arrays import Float
from floquet.integrate.ode import Parameters, Shape, symbols, terms
from floquet.integrate.recurrence import cosine, second_order
from floquet.integrate.step_length import TaylorSteps

# SX expands every scalar operation: quicker to run, slower to build. Measured: at this many of
# them both take about as long for ten calls, and a build stays under 0.2 s.
SX_OPERATIONS = 60_000

# Steps in one fold, whose inputs are held side by side: a step of three coordinates takes 43 us in
# folds of 64, 35 us in folds of 1,024 and no less in longer ones.
MAX_FOLD_STEPS = 1024


@dataclass(frozen=True)
class Taylor(TaylorSteps):
    """Taylor steps of fixed order, the coefficients by recurrence, folded over the time."""

    def __call__(self, p: Parameters, size: Shape, time: float) -> Float:
        """Fundamental matrix at `time`."""
        needed = self.count(terms(p, size), p.C, time, float(p.Omega))
        steps = rounded_up(min(needed, MAX_FOLD_STEPS))
        return self.march(p, size, time, steps, ceil(needed / steps))

    def march(self, p: Parameters, size: Shape, time: float, steps: int, folds: int = 1) -> Float:
        """The same with a given number of steps, `folds` times as many as one fold has."""
        h, damped = time / (folds * steps), bool(np.any(p.C))
        if not _is_expanded(size, self.order):
            return self._one_by_one(p, size, h, folds * steps, damped)
        fold = _march(size, self.order, steps, damped)
        numbers = np.concatenate([[h], *(np.ravel(value, order="F") for value in p)])
        X: Any = np.eye(2 * size.n)
        for k in range(folds):
            X = fold(X, k * steps, numbers)
        return np.asarray(X)

    def _one_by_one(self, p: Parameters, size: Shape, h: float, steps: int, damped: bool) -> Float:
        """The same to the last bit: a fold of large steps takes far longer to build than to run."""
        step, numbers = _step(size, self.order, damped), [ca.DM(value) for value in p]
        X = ca.DM(np.eye(2 * size.n))
        for k in range(steps):
            X = step(X, h * k, h, *numbers)
        return np.asarray(X)


def rounded_up(steps: int) -> int:
    """Round up to 2^k or 3 2^(k-1), so that few folds are built and kept."""
    power = 1 << ceil(log2(max(steps, 2)))
    return power * 3 // 4 if steps <= power * 3 // 4 else power


def _is_expanded(size: Shape, order: int) -> bool:
    """Whether a step is written out in scalars."""
    operations = size.n**2 * order * (order + 4 * size.n) * (2 + size.terms)
    return operations < SX_OPERATIONS


@lru_cache(maxsize=64)
def folded(size: Shape, order: int, steps: int) -> Any:
    """`steps` steps as one CasADi function: inputs other than the state are side by side."""
    return _step(size, order).fold(steps)


@lru_cache(maxsize=64)
def _march(size: Shape, order: int, steps: int, damped: bool) -> Any:
    """The same from the step `first` on; h and all parameters, one vector, are those of each."""
    X, first = ca.MX.sym("X", 2 * size.n, 2 * size.n), ca.MX.sym("first")
    shapes = [value.shape for value in symbols(ca.SX, size)]
    numbers = ca.MX.sym("numbers", 1 + sum(rows * columns for rows, columns in shapes))
    h, *parts = ca.vertsplit(numbers, np.cumsum([0, 1, *(a * b for a, b in shapes)]).tolist())
    wide = [
        ca.repmat(ca.reshape(x, shape), 1, steps) for x, shape in zip(parts, shapes, strict=True)
    ]
    start = h * (first + ca.DM(range(steps)).T)
    fold = _step(size, order, damped).fold(steps)
    return ca.Function(
        "march", [X, first, numbers], [fold(X, start, ca.repmat(h, 1, steps), *wide)]
    )


@lru_cache(maxsize=64)
def _step(size: Shape, order: int, damped: bool = True) -> Any:
    """One step of length h from (Q, V) at tau, as a CasADi function; C may be left out."""
    n = size.n
    kind: Any = ca.SX if _is_expanded(size, order) else ca.MX
    p = symbols(kind, size)
    X, tau, h = kind.sym("X", 2 * n, 2 * n), kind.sym("tau"), kind.sym("h")

    pulsating = [(p.gamma * p.G, _cosine(p.Omega, tau, h, order))]
    for s, H_s in enumerate(ca.horzsplit(p.H, n) if size.terms else [], start=1):
        pulsating.append((H_s, _cosine(s * p.omega_L, tau, h, order)))
    Q, V = second_order(
        X[:n, :], X[n:, :], h, order, (p.F, pulsating), (p.C, ()) if damped else None
    )
    return ca.Function("step", [X, tau, h, *p], [ca.vertcat(Q, V)])


def _cosine(frequency: Any, tau: Any, h: Any, order: int) -> list[Any]:
    """Taylor coefficients of cos(frequency (tau + x h)) in x."""
    phase = frequency * tau
    return cosine(ca.cos(phase), ca.sin(phase), frequency * h, order)
