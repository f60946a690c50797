"""Seeded random Hill equations: dense, nonsymmetric, damped or not, with harmonics or not.

The size of P's coefficients is looked at by leapfrog, which neither route uses, and kept below
`LARGEST`; every tenth seed is made to grow, with a coefficient of at least `GROWN`.
"""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill import HillEquation, SteppedBeam, UniformBeam

Float = NDArray[np.float64]
LARGEST = 1e6
GROWN = 1e3
# Of F's eigenvectors: what is lost beyond it is lost by rounding F, whoever solves the equation.
CONDITION = 50.0


def grows(seed: int) -> bool:
    """Whether the system of this seed is one of those with large coefficients."""
    return seed % 10 == 9


@cache
def random_system(seed: int) -> HillEquation:
    """The same system for the same seed; n runs from 1 to 8 with the seed."""
    rng = np.random.default_rng(seed)
    least, most = (GROWN, LARGEST) if grows(seed) else (0.0, LARGEST)
    while True:
        equation = _draw(rng, 1 + seed % 8, 3.0 if grows(seed) else 1.0)
        if least <= largest_coefficient(equation) <= most:
            return equation


def largest_coefficient(equation: HillEquation) -> float:
    """Largest coefficient of P, to a few per cent."""
    n, Omega = len(equation.F), equation.Omega
    ratio = round(equation.omega_L / Omega) if equation.H else 1
    F = (equation.F - 0.25 * float(equation.eta) ** 2 * np.eye(n)) / Omega**2
    terms = [(1, equation.gamma * equation.G / Omega**2)]
    terms += [(s * ratio, H / Omega**2) for s, H in enumerate(equation.H, start=1)]
    fastest = np.sqrt(np.abs(np.linalg.eigvals(F)).max()) + terms[-1][0] + 2.0
    steps = int(30 * fastest)
    h = 2.0 * np.pi / steps
    stiffness = [np.cos(p * h * np.arange(steps + 1))[:, None, None] * M for p, M in terms]
    kick = h * (F + sum(stiffness))
    u, v = np.eye(n), -0.5 * kick[0]
    for k in range(1, steps + 1):
        u = u + h * v
        v = v - kick[k] @ u
    return float(np.max(np.abs(np.poly(u))))


def _draw(rng: np.random.Generator, n: int, strength: float) -> HillEquation:
    Omega = 10.0 ** rng.uniform(-0.7, 0.7)
    highest = 10.0 ** rng.uniform(-0.5, 1.0)  # w_max in units of Omega
    w = highest * rng.uniform(0.05, 1.0, n)
    w[-1] = highest
    squares = np.diag(w**2)
    kind = rng.uniform()
    if kind < 0.15:
        squares[0, 0] = -(rng.uniform(0.1, 0.8) ** 2)
    elif kind < 0.3 and n > 1:
        # a conjugate pair: w^2 exp(+-i angle), growing by exp(2 pi Im w) at most
        pair = (w[0] * np.exp(0.5j * np.arcsin(min(1.0, rng.uniform(0.1, 0.8) / w[0])))) ** 2
        squares[:2, :2] = [[pair.real, pair.imag], [-pair.imag, pair.real]]
    basis = np.eye(n) + 0.3 * rng.standard_normal((n, n))
    while np.linalg.cond(basis) > CONDITION:
        basis = np.eye(n) + 0.3 * rng.standard_normal((n, n))
    damped = rng.uniform() < 0.5
    terms = 1 + n % 3 if rng.uniform() < 0.4 else 0  # so that few shapes are compiled
    ratio = int(rng.integers(1, 4))

    def coupling(size: float) -> Any:
        return strength * size * highest * Omega**2 * rng.standard_normal((n, n)) / np.sqrt(n)

    return HillEquation(
        F=Omega**2 * basis @ squares @ np.linalg.inv(basis),
        G=coupling(1.0),
        gamma=rng.uniform(-0.5, 0.5),
        Omega=Omega,
        eta=rng.uniform(0.0, 0.3) * Omega if damped else 0.0,
        H=[coupling(0.2) for _ in range(terms)],
        omega_L=ratio * Omega if terms else np.inf,
    )


def _beam(T0: float, K_theta: float, Omega: float, gamma: float, **more: Any) -> HillEquation:
    forcing = {name: more.pop(name) for name in ("eta", "initial_terms") if name in more}
    beam = UniformBeam(T0=T0, K_theta=K_theta, xi_G=0.5, **more)
    return beam.equation(Omega, gamma, **forcing)


def _equation(F: Any, G: Any, gamma: float = 0.3, Omega: float = 1.0, **more: Any) -> HillEquation:
    return HillEquation(F, G, gamma, Omega, **more)


DENSE = [[1.0, 2.0], [3.0, 1.0]]
STEP = {"xi_c": 0.6, "area_ratio": 0.6, "inertia_ratio": 0.6}

# What the report excludes or never met, by name.
SPECIAL: dict[str, HillEquation] = {
    "w = 2": _equation([[4.0]], [[1.0]]),
    "w = 1": _equation([[4.0]], [[1.0]], Omega=2.0),
    "w = 1/2": _equation([[0.25]], [[1.0]]),
    "w = 3/2": _equation([[9.0]], [[1.0]], Omega=2.0),
    "w = 1/2, damped": _equation([[0.26]], [[1.0]], eta=0.2),
    "w = 0": _equation([[0.0]], [[1.0]]),
    "w = i": _equation([[-1.0]], [[1.0]]),
    "w = 2i": _equation([[-4.0]], [[1.0]]),
    "w_2 - w_1 = 1": _equation([[1.21, 0.0], [0.0, 4.41]], DENSE),
    "w_1 + w_2 = 1": _equation([[0.09, 0.0], [0.0, 0.49]], DENSE),
    "w_1 whole, w_2 half": _equation([[1.0, 0.5], [0.2, 0.25]], DENSE),
    "equal diagonal": _equation([[2.0, 1.0], [3.0, 2.0]], DENSE),
    "equal frequencies": _equation([[2.0, 0.0], [0.0, 2.0]], DENSE),
    "defective F": _equation([[2.0, 1.0], [0.0, 2.0]], DENSE),
    "nilpotent F": _equation([[0.0, 1.0], [0.0, 0.0]], DENSE),
    "complex frequencies": _equation([[2.0, 0.3], [-0.3, 2.0]], DENSE),
    "one negative": _equation([[-0.5, 0.3], [0.2, 3.0]], DENSE),
    "nothing at all": _equation([[0.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]]),
    "no coupling": _equation([[2.0, 1.0], [3.0, 5.0]], DENSE, gamma=0.0),
    "strong coupling": _equation([[1.0]], [[1.0]], gamma=30.0),
    "no forcing but H": _equation([[2.0]], [[0.0]], H=[[[0.5]], [[0.3]]], omega_L=3.0),
    "three harmonics": _equation(
        [[2.0, 1.0], [3.0, 5.0]], DENSE, eta=0.1, H=[DENSE, np.eye(2), DENSE], omega_L=1.0
    ),
    "uncontrolled beam": _beam(20.0, 0.0, 1.1, 0.2),
    "report's beam": _beam(20.0, 0.5, 1.1, 0.1, omega_L=100.0),
    "report's beam, slow": _beam(20.0, 0.5, 0.38, 0.1),
    "report's beam, damped": _beam(20.0, 0.5, 2.0, 0.2, eta=0.05),
    "initial conditions": _beam(20.0, 0.5, 1.1, 0.1, omega_L=2.2, initial_terms=2),
    "inertially buckled beam": _beam(27.5, 0.5, 1.1, 0.1),
    "fluttering beam": _beam(120.0, 0.0, 2.0, 0.1),
    "stepped beam": SteppedBeam(T0=20.0, K_theta=1.0, xi_G=0.5, **STEP).equation(1.1, 0.1),
    "six modes": _beam(20.0, 0.5, 10.0, 0.2, modes=6),
}
