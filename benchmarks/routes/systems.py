"""Seeded general systems with m = 1 .. 12 multipliers, class by class."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from benchmarks.honesty import symmetric
from hill import Fourier, PeriodicEquation

Rng = np.random.Generator

MAX_HARMONICS = 4

ALL = "all at once"
"""Everything in any combination: fast motion, units of all sizes, damping of all strengths."""


def system(kind: str, seed: int) -> PeriodicEquation:
    """One of a class of `KINDS`; the same for the same seed."""
    if kind == ALL:
        return random_periodic(seed)
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
    harmonics = int(rng.integers(1, MAX_HARMONICS + 1)) if highest is None else highest
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
    highest = int(rng.integers(1, MAX_HARMONICS + 1))
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

KINDS = (*_OWN, ALL, *symmetric.KINDS)


@cache
def random_periodic(seed: int, most: int = 12, fastest: float = 6.0) -> PeriodicEquation:
    """The same equation for the same seed, with at most `most` multipliers.

    `fastest` is the highest frequency and harmonic over Omega; damping is up to three times that.
    """
    rng = np.random.default_rng(seed)
    Omega = 10.0 ** rng.uniform(-1.0, 1.0)
    every = np.arange(1, 1 + int(fastest))
    count = int(rng.integers(0, 1 + min(4, len(every))))
    harmonics = rng.choice(every, size=count, replace=False)
    strength = rng.choice([0.03, 0.15, 0.3, 0.6])
    damped = rng.uniform() < 0.3
    rest = Omega, harmonics, strength, damped, fastest
    if rng.uniform() < 0.35 or most == 1:
        return _drawn_first_order(rng, int(rng.integers(1, most + 1)), *rest)
    return _drawn_second_order(rng, int(rng.integers(1, most // 2 + 1)), *rest)


def _drawn_first_order(
    rng: np.random.Generator,
    m: int,
    Omega: float,
    harmonics: Any,
    strength: float,
    damped: bool,
    fastest: float,
) -> PeriodicEquation:
    B = rng.standard_normal((m, m)) / np.sqrt(m)
    mean = 0.5 * fastest * 10.0 ** rng.uniform(-1.2, 0.0) * (B - B.T)
    mean += 0.1 * rng.standard_normal((m, m)) / np.sqrt(m)
    if damped:
        mean -= np.diag(3.0 * fastest * 10.0 ** rng.uniform(-3.0, 0.0, m))
    # in units of all sizes
    units = 2.0 ** rng.uniform(-10.0, 10.0, m) if rng.uniform() < 0.2 else np.ones(m)

    def some() -> dict[int, Any]:
        return {
            int(k): strength * Omega / k * _turned(rng.standard_normal((m, m)) / np.sqrt(m), units)
            for k in harmonics
            if rng.uniform() < 0.8
        }

    A = Fourier(Omega * _turned(mean, units), cos=some(), sin=some())
    return PeriodicEquation.first_order(A=A, Omega=Omega)


def _turned(matrix: Any, units: Any) -> Any:
    return units[:, None] * matrix / units


def _drawn_second_order(
    rng: np.random.Generator,
    n: int,
    Omega: float,
    harmonics: Any,
    strength: float,
    damped: bool,
    fastest: float,
) -> PeriodicEquation:
    highest = fastest * 10.0 ** rng.uniform(-1.0, 0.0)
    w = highest * rng.uniform(0.1, 1.0, n)
    basis = np.eye(n) + 0.3 * rng.standard_normal((n, n))
    while np.linalg.cond(basis) > 50.0:
        basis = np.eye(n) + 0.3 * rng.standard_normal((n, n))
    root = rng.standard_normal((n, n))
    M = 10.0 ** rng.uniform(-3.0, 3.0) * (root @ root.T + 0.3 * np.eye(n))
    if rng.uniform() < 0.3:
        M = np.eye(n)
    G = rng.standard_normal((n, n))
    C = 0.05 * rng.standard_normal((n, n)) + 0.2 * highest * (G - G.T) * (rng.uniform() < 0.5)
    if damped:
        C += np.diag(3.0 * fastest * 10.0 ** rng.uniform(-2.0, 0.0, n))

    def some(size: float) -> dict[int, Any]:
        return {
            int(k): M @ (strength * size / k * rng.standard_normal((n, n)) / np.sqrt(n))
            for k in harmonics
            if rng.uniform() < 0.6
        }

    stiffness, drag = highest * Omega**2, 0.3 * highest * Omega
    return PeriodicEquation(
        M=M,
        C=Fourier(Omega * M @ C, cos=some(drag), sin=some(drag)),
        K=Fourier(
            Omega**2 * M @ basis @ np.diag(w**2) @ np.linalg.inv(basis),
            cos=some(stiffness),
            sin=some(stiffness),
        ),
        Omega=Omega,
    )
