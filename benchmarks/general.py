"""General equations: this project, SciPy and heyoka on the same ones, and on special ones.

Two systems for each number of coordinates: one that has z, in its special and in general form, and
one whose damping pulsates. A peer integrates to the monodromy matrix, at the loosest tolerance with
which it is no less accurate than the time domain here; its multipliers' polynomial is numpy's.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.compete import Field, reason
from benchmarks.measure import once, rounds
from benchmarks.plan import Plan
from benchmarks.systems import Float
from floquet import monodromy
from hill import Fourier, HillEquation, PeriodicEquation, characteristic

COORDINATES = (1, 2, 4, 8)

# Loosest first. Tighter ones stall.
TOLERANCES = {
    "DOP853": (1e-10, 1e-11, 1e-12, 1e-13, 3e-14),
    "LSODA": (1e-10, 1e-11, 1e-12),
    "heyoka": (1e-10, 1e-12, 1e-14, 0.0),
}
"""Of heyoka 0 is its own, an ulp."""

# As accurate as the time domain: to this factor, beside an ulp of a long sum.
ALIKE, ULPS = 3.0, 1e-14

# Bits of the arbiter's polynomial: far more than anybody has.
BITS = 80

Polynomial = Callable[[], Float]


def special(n: int) -> HillEquation:
    """Coupled coordinates with frequencies from 1 to 3, at Omega = 1.3."""
    rng = np.random.default_rng(n)
    F = np.diag(np.linspace(1.0, 3.0, n) ** 2) + 0.1 * rng.standard_normal((n, n)) / np.sqrt(n)
    return HillEquation(F, rng.standard_normal((n, n)) / np.sqrt(n), 0.2, 1.3, 0.05)


def pulsating(n: int) -> PeriodicEquation:
    """The same with two harmonics in C and K, sines and cosines."""
    rng = np.random.default_rng(100 + n)
    e = special(n).general()
    assert e.K is not None

    def waves(size: float) -> dict[int, Float]:
        return {k: size / k * rng.standard_normal((n, n)) / np.sqrt(n) for k in (1, 2)}

    return PeriodicEquation(
        C=Fourier(0.1 * np.eye(n), cos=waves(0.1), sin=waves(0.1)),
        K=Fourier(e.K.mean, cos=waves(0.2), sin=waves(0.2)),
        Omega=e.Omega,
    )


def general(plan: Plan, field: Field) -> dict[str, Any]:
    """A line for everybody and each number of coordinates."""
    lines: list[dict[str, Any]] = []
    for n in COORDINATES:
        one = special(n)
        both: dict[str, Any] = {"special": one, "general": one.general()}
        lines += _ours("with z", n, both, plan, _truth(both["general"], field))
        e = pulsating(n)
        truth = _truth(e, field)
        known = _ours("damping pulsates", n, {"general": e}, plan, truth)
        lines += known
        accuracy = known[-1]["error"]
        lines += _peers(n, e, plan, field, truth, accuracy)
    return {"lines": lines}


def _truth(e: PeriodicEquation, field: Field) -> Float | None:
    """The arbiter's polynomial of the multipliers, rounded."""
    try:
        from floquet.enclosure.general import reference
    except ImportError as missing:
        field.missing["reference of general equations"] = reason(missing)
        return None
    return np.array([float(x) for x in reference(e, narrow=BITS)])


def _error(found: Float, truth: Float | None) -> float | None:
    # P(z) is another polynomial
    if truth is None or found.shape != truth.shape:
        return None
    return float(np.max(np.abs(found - truth)) / np.max(np.abs(truth)))


def _ours(
    system: str, n: int, forms: dict[str, Any], plan: Plan, truth: Float | None
) -> list[dict[str, Any]]:
    """The determinant and the time domain, in each form; the time domain last."""
    jobs: dict[str, Polynomial] = {}
    for route, function in (("hill", characteristic), ("floquet", monodromy)):
        for form, e in forms.items():
            jobs[f"{route}, {form}"] = partial(_polynomial, function, e)
    return _measured(system, n, jobs, {}, plan, truth, ours=True)


def _polynomial(function: Any, e: Any) -> Float:
    return np.asarray(function(e).polynomial)


def _peers(
    n: int,
    e: PeriodicEquation,
    plan: Plan,
    field: Field,
    truth: Float | None,
    accuracy: float | None,
) -> list[dict[str, Any]]:
    jobs: dict[str, Polynomial] = {}
    settings: dict[str, tuple[str, float]] = {}
    for name, tolerances in TOLERANCES.items():
        build = _heyoka if name == "heyoka" else partial(_scipy, method=name)
        for tolerance in tolerances:
            try:
                run, seconds = once(partial(build, e, tolerance))
            except ImportError as missing:
                field.missing[name] = reason(missing)
                break
            jobs[name] = run
            settings[name] = f"tolerance {tolerance:.0e}" if tolerance else "an ulp", seconds
            if accuracy is None or truth is None:
                continue
            off = _error(run(), truth)
            if off is not None and off <= max(ALIKE * accuracy, ULPS):
                break
    return _measured("damping pulsates", n, jobs, settings, plan, truth, ours=False)


def _measured(
    system: str,
    n: int,
    jobs: dict[str, Polynomial],
    settings: dict[str, tuple[str, float]],
    plan: Plan,
    truth: Float | None,
    *,
    ours: bool,
) -> list[dict[str, Any]]:
    """Errors first, which also compiles what is to be compiled."""
    off = {name: _error(run(), truth) for name, run in jobs.items()}
    seconds = rounds(jobs, plan.sweep_rounds)
    nothing = ("", 0.0)
    return [
        {
            "name": name,
            "system": system,
            "n": n,
            "ours": ours,
            "settings": settings.get(name, nothing)[0],
            "build_seconds": settings.get(name, nothing)[1],
            "seconds": seconds[name],
            "error": off[name],
        }
        for name in jobs
    ]


def _scipy(e: PeriodicEquation, tolerance: float, *, method: str) -> Polynomial:
    assert e.C is not None
    assert e.K is not None
    K, C, n = e.K, e.C, e.K.n
    start = np.eye(2 * n).ravel()

    def at(matrix: Fourier, tau: float) -> Float:
        total = matrix.mean.copy()
        for k, x in matrix.cos.items():
            total += np.cos(k * e.Omega * tau) * x
        for k, x in matrix.sin.items():
            total += np.sin(k * e.Omega * tau) * x
        return total

    def slope(tau: float, x: Float) -> Float:
        X = x.reshape(2 * n, 2 * n)
        return np.vstack([X[n:], -at(K, tau) @ X[:n] - at(C, tau) @ X[n:]]).ravel()

    def run() -> Float:
        span, end = (0.0, e.period), [e.period]
        found = solve_ivp(
            slope, span, start, method=method, rtol=tolerance, atol=tolerance, t_eval=end
        )
        return np.asarray(np.poly(found.y[:, -1].reshape(2 * n, 2 * n)))

    return run


def _heyoka(e: PeriodicEquation, tolerance: float) -> Polynomial:
    """The equation compiled with its numbers; the columns of the matrix are the lanes."""
    import heyoka as hy

    assert e.C is not None
    assert e.K is not None
    n, K, C = e.K.n, e.K, e.C
    u = [hy.expression(f"u{i}") for i in range(n)]
    v = [hy.expression(f"v{i}") for i in range(n)]

    def element(matrix: Fourier, i: int, j: int) -> Any:
        parts = [hy.expression(float(matrix.mean[i, j]))]
        for wave, every in ((hy.cos, matrix.cos), (hy.sin, matrix.sin)):
            parts += [float(x[i, j]) * wave(float(k * e.Omega) * hy.time) for k, x in every.items()]
        return hy.sum(parts)

    def force(i: int) -> Any:
        terms = [element(K, i, j) * u[j] for j in range(n)]
        return -hy.sum(terms + [element(C, i, j) * v[j] for j in range(n)])

    system = [(u[i], v[i]) for i in range(n)] + [(v[i], force(i)) for i in range(n)]
    lanes = int(hy.recommended_simd_size())
    options: dict[str, Any] = {"tol": tolerance} if tolerance else {}
    integrator = hy.taylor_adaptive_batch(system, np.zeros((2 * n, lanes)), **options)

    def run() -> Float:
        Phi = np.empty((2 * n, 2 * n))
        for first in range(0, 2 * n, lanes):
            count = min(lanes, 2 * n - first)
            integrator.set_time(0.0)
            # the last lanes are filled up with the first column
            integrator.state[:] = np.eye(2 * n)[:, :1]
            integrator.state[:, :count] = np.eye(2 * n)[:, first : first + count]
            integrator.propagate_until(e.period)
            Phi[:, first : first + count] = integrator.state[:, :count]
        return np.asarray(np.poly(Phi))

    return run
