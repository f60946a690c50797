"""Seeded general systems with m = 1 .. 12 multipliers, class by class."""

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.honesty import symmetric
from hill import Fourier, PeriodicEquation

Rng = np.random.Generator

MOST_HARMONICS = 4


def system(kind: str, seed: int) -> PeriodicEquation:
    """One of a class of `KINDS`; the same for the same seed."""
    if kind in symmetric.KINDS:
        return symmetric.system(kind, seed)
    return _OWN[kind](np.random.default_rng([seed, list(_OWN).index(kind), 1]))


def _some(rng: Rng, n: int, size: float) -> Any:
    return size * rng.standard_normal((n, n)) / np.sqrt(n)


def _waves(rng: Rng, n: int, mean: Any, size: float, highest: int, waves: str) -> Fourier:
    """Every harmonic up to the highest with a chance of .7, the highest itself always."""
    some = [k for k in range(1, highest + 1) if k == highest or rng.uniform() < 0.7]

    def of(wave: str) -> dict[int, Any]:
        return {k: _some(rng, n, size / k) for k in some} if wave in waves else {}

    return Fourier(mean, cos=of("cos"), sin=of("sin"))


def _second_order(
    rng: Rng,
    *,
    turning: float = 0.0,
    damping: float = 0.1,
    pulsating: bool = False,
    waves: str = "cos sin",
    highest: int | None = None,
    mass: bool = False,
) -> PeriodicEquation:
    n = int(rng.integers(1, 7))
    harmonics = int(rng.integers(1, MOST_HARMONICS + 1)) if highest is None else highest
    Omega = float(10.0 ** rng.uniform(-0.4, 0.6))
    gyroscopic = _some(rng, n, turning)
    drag = np.diag(damping * rng.uniform(0.0, 1.0, n)) + _some(rng, n, 0.1 * damping)
    C = gyroscopic - gyroscopic.T + drag
    K = np.diag(rng.uniform(0.2, 6.0, n)) + _some(rng, n, 0.3)
    size = float(rng.choice([0.05, 0.2, 0.6]))
    M = np.eye(n) + _some(rng, n, 0.2) if mass else np.eye(n)
    return PeriodicEquation(
        M=M,
        C=_waves(rng, n, M @ C, size, harmonics, waves) if pulsating else M @ C,
        K=_waves(rng, n, M @ K, size, harmonics, waves),
        Omega=Omega,
    )


def _first_order(rng: Rng, *, damping: float) -> PeriodicEquation:
    m = int(rng.integers(1, 13))
    highest = int(rng.integers(1, MOST_HARMONICS + 1))
    swing = _some(rng, m, 1.5)
    mean = swing - swing.T + _some(rng, m, 0.1) - np.diag(damping * rng.uniform(0.0, 1.0, m))
    A = _waves(rng, m, mean, float(rng.choice([0.05, 0.2, 0.6])), highest, "cos sin")
    return PeriodicEquation.first_order(A=A, Omega=float(10.0 ** rng.uniform(-0.4, 0.6)))


_OWN: dict[str, Callable[[Rng], PeriodicEquation]] = {
    "one harmonic": lambda rng: _second_order(rng, waves="cos", highest=1),
    "sines": lambda rng: _second_order(rng, waves="cos sin"),
    "gyroscopic": lambda rng: _second_order(rng, turning=1.0, damping=0.02),
    "pulsating damping": lambda rng: _second_order(rng, pulsating=True),
    "four harmonics": lambda rng: _second_order(rng, turning=0.3, pulsating=True, highest=4),
    "mass matrix": lambda rng: _second_order(rng, turning=0.3, pulsating=True, mass=True),
    "strong damping": lambda rng: _second_order(rng, damping=20.0, pulsating=True),
    "negative damping": lambda rng: _second_order(rng, damping=-0.5, pulsating=True),
    "first order": lambda rng: _first_order(rng, damping=0.3),
    "first order, strong damping": lambda rng: _first_order(rng, damping=10.0),
}

KINDS = (*_OWN, *symmetric.KINDS)
