"""Seeded general equations with an exact symmetry, and the same with it broken in one element.

Elements are whole numbers over 2^20, so that sums and products with Omega, eta and harmonics are
exact: the symmetry is one of the floats. Most systems are stable, one in six is not.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import ctx

from floquet.enclosure.judgement import BITS, enclosed, judged
from floquet.enclosure.judgement import Truth as Verdict
from hill import Fourier, PeriodicEquation

Rng = np.random.Generator
FINE = 2.0**20


def system(kind: str, seed: int) -> PeriodicEquation:
    """One of a class of `KINDS`; the same for the same seed."""
    return KINDS[kind](np.random.default_rng([seed, sorted(KINDS).index(kind)]))


def broken(kind: str, seed: int, by: float = 1.0 / FINE) -> PeriodicEquation:
    """The same, with one element of a mean off by so much: on the diagonal of C, or of A."""
    e = system(kind, seed)
    off = np.zeros((e.order, e.order)) if e.A is not None else np.zeros_like(e.C.mean)  # type: ignore[union-attr]
    off[-1, -1] = by
    if e.A is not None:
        return PeriodicEquation.first_order(A=_plus(e.A, -off), Omega=e.Omega)
    assert e.C is not None
    assert e.K is not None
    return PeriodicEquation(M=e.M, C=_plus(e.C, off), K=e.K, Omega=e.Omega)


def _plus(matrix: Fourier, off: Any) -> Fourier:
    return Fourier(matrix.mean + off, cos=matrix.cos, sin=matrix.sin)


def _fine(x: Any) -> Any:
    return np.round(np.asarray(x) * FINE) / FINE


def _some(rng: Rng, n: int, size: float) -> Any:
    return _fine(size * rng.standard_normal((n, n)) / np.sqrt(n))


def _even(x: Any) -> Any:
    return x + x.T


def _skew(x: Any) -> Any:
    return x - x.T


def _frequencies(rng: Rng, n: int) -> Any:
    """Squares, apart, and Omega of about their roots."""
    return np.diag(_fine((np.arange(1, n + 1) + rng.uniform(-0.3, 0.3, n)) ** 2))


def _start(rng: Rng) -> tuple[int, float, float, list[int]]:
    n = int(rng.integers(1, 5))
    Omega = float(_fine(rng.uniform(0.8, 3.0)))
    size = float(rng.choice([0.03, 0.1, 0.3]))
    harmonics = sorted(rng.choice([1, 2, 3], int(rng.integers(1, 3)), replace=False).tolist())
    return n, Omega, size, harmonics


def _lagrange(rng: Rng, *, turning: bool) -> PeriodicEquation:
    """M symmetric, C skew, K - C'/2 symmetric."""
    n, Omega, size, harmonics = _start(rng)
    root = _some(rng, n, 0.3)
    M = np.eye(n) + _fine(root @ root.T)
    C = {(k, wave): _skew(_some(rng, n, size)) for k in harmonics for wave in (0, 1)}
    if not turning:
        C = {x: 0.0 * matrix for x, matrix in C.items()}
    K = {}
    for k in harmonics:
        for wave, sign in ((0, 1.0), (1, -1.0)):
            own = _even(_some(rng, n, size))
            K[k, wave] = own + 0.5 * sign * k * Omega * C[k, 1 - wave]
    stiffness = _frequencies(rng, n) + _even(_some(rng, n, 0.5 * size))
    return PeriodicEquation(
        M=M,
        C=_fourier(_skew(_some(rng, n, 0.3)), C),
        K=_fourier(_fine(M @ stiffness + stiffness @ M) / 2.0, K),
        Omega=Omega,
    )


def _fourier(mean: Any, waves: Any) -> Fourier:
    return Fourier(
        mean,
        cos={k: x for (k, wave), x in waves.items() if not wave},
        sin={k: x for (k, wave), x in waves.items() if wave},
    )


def _reversible(rng: Rng, *, later: bool) -> PeriodicEquation:
    """Even and odd about tau = 0, or about a quarter of the period; signs of all patterns."""
    n, Omega, size, harmonics = _start(rng)
    signs = rng.choice([-1.0, 1.0], n)
    alike = np.equal.outer(signs, signs)
    size = 0.5 * size

    def waves(turns: bool, size: float) -> dict[Any, Any]:
        found = {}
        for k in harmonics:
            for wave in (0, 1):
                odd = (wave == 1) != (later and (k // np.gcd.reduce(harmonics)) % 2 == 1)
                found[k, wave] = _some(rng, n, size) * (alike != (odd != turns))
        return found

    return PeriodicEquation(
        M=np.eye(n) + _some(rng, n, 0.1) * alike,
        C=_fourier(_some(rng, n, 0.1) * ~alike, waves(True, size)),
        K=_fourier(_frequencies(rng, n) + _some(rng, n, size) * alike, waves(False, size)),
        Omega=Omega,
    )


def _damped(rng: Rng) -> PeriodicEquation:
    """A reversible one in u = exp(eta tau/2) q: C is eta M, and eta/2 C_u is in K."""
    e = _reversible(rng, later=False)
    assert e.C is not None
    assert e.K is not None
    eta = float(rng.choice([0.125, 0.5, -0.25]))
    K = {(k, 0): x for k, x in e.K.cos.items()} | {(k, 1): x for k, x in e.K.sin.items()}
    for wave, part in enumerate((e.C.cos, e.C.sin)):
        for k, x in part.items():
            K[k, wave] = K[k, wave] + 0.5 * eta * x
    M = np.asarray(e.M)
    mean = e.K.mean + 0.5 * eta * e.C.mean + 0.25 * eta**2 * M
    return PeriodicEquation(
        M=M, C=_plus(e.C, eta * M), K=_fourier(mean, K), Omega=e.Omega
    )  # fmt: skip


def _hamilton(rng: Rng) -> PeriodicEquation:
    """J S(tau) with S symmetric, in the order of coordinates and momenta."""
    n, Omega, size, harmonics = _start(rng)
    J = np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(n))
    energy = np.kron(np.diag([1.0, 0.0]), _frequencies(rng, n)) + np.kron(
        np.diag([0, 1]), np.eye(n)
    )
    energy = energy + _even(_some(rng, 2 * n, 0.5 * size))
    waves = {(k, w): J @ _even(_some(rng, 2 * n, size)) for k in harmonics for w in (0, 1)}
    return PeriodicEquation.first_order(A=_fourier(J @ energy, waves), Omega=Omega)


def _companion(rng: Rng) -> PeriodicEquation:
    """A reversible equation of second order, its mass apart, written as one of first order."""
    e = _reversible(rng, later=bool(rng.integers(2)))
    assert e.C is not None
    assert e.K is not None
    n = e.K.n

    def below(K: Any, C: Any, corner: Any) -> Any:
        return np.block([[np.zeros((n, n)), corner], [-K, -C]])

    zero = np.zeros((n, n))
    waves = {
        (k, w): below(K, C, zero)
        for w, (Ks, Cs) in enumerate(((e.K.cos, e.C.cos), (e.K.sin, e.C.sin)))
        for (k, K), C in zip(Ks.items(), Cs.values(), strict=True)
    }
    A = _fourier(below(e.K.mean, e.C.mean, np.eye(n)), waves)
    return PeriodicEquation.first_order(A=A, Omega=e.Omega)


KINDS: dict[str, Callable[[Rng], PeriodicEquation]] = {
    "conservative": lambda rng: _lagrange(rng, turning=False),
    "conservative, C pulsating": lambda rng: _lagrange(rng, turning=True),
    "reversible": lambda rng: _reversible(rng, later=False),
    "reversible, later": lambda rng: _reversible(rng, later=True),
    "proportional damping": _damped,
    "Hamilton": _hamilton,
    "reversible, first order": _companion,
}


@dataclass(frozen=True)
class Truth:
    """T as a ball, and what is true of an equation that has its symmetry."""

    T: Any
    verdict: Verdict


def truth_of(e: PeriodicEquation, polynomial: list[Any]) -> Truth:
    """What the arbiter's polynomial says: on the circle, simple and in pairs is stable."""
    growth = judged(polynomial, e.Omega, None)
    with ctx.workprec(BITS):
        bounded = growth.truth == "boundary" and enclosed(polynomial).simple
    return Truth(growth.T, "stable" if bounded else growth.truth)
