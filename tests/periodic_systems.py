"""General periodic systems: from the literature, with what their source says, and seeded at random.

`RANDOM` draws equations of both orders with m = 1 .. 12 multipliers: gyroscopic terms, damping of
all strengths, pulsating damping and stiffness, sines and cosines of up to four harmonics, masses.
"""

from functools import cache
from typing import Any

import numpy as np

from hill import Fourier, PeriodicEquation

# A = [[-1 - 9 c^2 + 12 s c, 12 c^2 + 9 s c], [-12 s^2 + 9 s c, -1 - 9 s^2 - 12 s c]], c = cos 6t,
# s = sin 6t: its eigenvalues are -1 and -10 at every t (Vinograd 1952). Period pi/6.
VINOGRAD = PeriodicEquation.first_order(
    A=Fourier(
        [[-5.5, 6.0], [-6.0, -5.5]],
        cos={1: [[-4.5, 6.0], [6.0, 4.5]]},
        sin={1: [[6.0, 4.5], [4.5, -6.0]]},
    ),
    Omega=12.0,
)
# A = [[-1 - sin^2 2t, 2 - sin(4t)/2], [-2 - sin(4t)/2, -1 - cos^2 2t]] (Zhou and Hagiwara 2002).
ZHOU_HAGIWARA = PeriodicEquation.first_order(
    A=Fourier(
        [[-1.5, 2.0], [-2.0, -1.5]],
        cos={1: [[0.5, 0.0], [0.0, -0.5]]},
        sin={1: [[0.0, -0.5], [-0.5, 0.0]]},
    ),
    Omega=4.0,
)
# x'' + (24 + 10 sin t) x' + 10 cos t x is (x' + (24 + 10 sin t) x)' (Bittanti and Colaneri).
BITTANTI_COLANERI = PeriodicEquation(
    K=Fourier([[0.0]], cos={1: [[10.0]]}), C=Fourier([[24.0]], sin={1: [[10.0]]}), Omega=1.0
)
BITTANTI_COLANERI_FIRST_ORDER = PeriodicEquation.first_order(
    A=Fourier(
        [[0.0, 1.0], [0.0, -24.0]],
        cos={1: [[0.0, 0.0], [-10.0, 0.0]]},
        sin={1: [[0.0, 0.0], [0.0, -10.0]]},
    ),
    Omega=1.0,
)


def asymmetric_rotor(damping: float = 0.0) -> PeriodicEquation:
    """Stiffness 1 +- 0.2 turning at the speed 1, seen from where it does not turn."""
    return PeriodicEquation(
        K=Fourier(
            np.eye(2),
            cos={1: [[0.2, 0.0], [0.0, -0.2]]},
            sin={1: [[0.0, 0.2], [0.2, 0.0]]},
        ),
        C=damping * np.eye(2),
        Omega=2.0,
    )


# From their sources; the imaginary part up to whole multiples of Omega.
EXPONENTS: dict[str, tuple[PeriodicEquation, tuple[complex, ...]]] = {
    "vinograd": (VINOGRAD, (2.0 + 6.0j, -13.0 + 6.0j)),
    "zhou-hagiwara": (ZHOU_HAGIWARA, (-1.0 + 2.0j, -2.0 + 2.0j)),
    "bittanti-colaneri": (BITTANTI_COLANERI, (0.0, -24.0)),
    "bittanti-colaneri, first order": (BITTANTI_COLANERI_FIRST_ORDER, (0.0, -24.0)),
    # turned with it: r'' + 2 J r' + diag(k0 + dk - 1, k0 - dk - 1) r = 0
    "asymmetric rotor": (
        asymmetric_rotor(),
        tuple(
            1j + s * np.sqrt(-2.0 + t * np.sqrt(4.04) + 0j)
            for s in (1.0, -1.0)
            for t in (1.0, -1.0)
        ),
    ),
}


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
        return _first_order(rng, int(rng.integers(1, most + 1)), *rest)
    return _second_order(rng, int(rng.integers(1, most // 2 + 1)), *rest)


def _first_order(
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


def _second_order(
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
