"""Where parametric resonances are to be looked for, and how wide first-order theory makes them.

A guess to start from, not a result: the boundaries themselves come from P.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill import HillEquation, PeriodicEquation

Complex = NDArray[np.complexfloating[Any, Any]]

# A frequency with more than this share of imaginary part belongs to a beam already unstable.
REAL = 1e-9


@dataclass(frozen=True)
class Resonance:
    """Omega = 2 omega_i/k, (7.1.3), or (omega_i +- omega_j)/k, (7.1.4).

    Attributes
    ----------
    i, j : int
        Natural frequencies in ascending order, from 0; i >= j.
    sign : {1, -1}
    order : int
        k.
    names : tuple of str
        What the system calls its frequencies; as the report does, B, 1, 2, ..., where it is empty.
    """

    i: int
    j: int
    sign: int = 1
    order: int = 1
    names: tuple[str, ...] = field(default=(), compare=False)

    @property
    def type(self) -> str:
        """Type I or II of section 7.1."""
        return "I" if self.i == self.j else "II"

    @property
    def indicator(self) -> str:
        """What meets on its undamped boundary: multipliers at +1, at -1, or two pairs of them."""
        if self.i != self.j:
            return "pair"
        return "-1" if self.order % 2 else "+1"

    @property
    def crossing(self) -> str:
        """What leaves the unit circle there, in words."""
        return {"+1": "mu = 1", "-1": "mu = -1"}.get(self.indicator, "a pair")

    @property
    def frequencies(self) -> tuple[str, str]:
        """The names of its two frequencies."""
        names = self.names or ("B", *(str(k) for k in range(1, self.i + 1)))
        return names[self.i], names[self.j]

    @property
    def name(self) -> str:
        """As the report's tables print it: "2 omega_(B)", "omega_(1) + omega_(B)"."""
        first, second = (f"omega_({name})" for name in self.frequencies)
        text = f"2 {first}" if self.i == self.j else f"{first} {'+-'[self.sign < 0]} {second}"
        return text if self.order == 1 else f"({text})/{self.order}"

    def Omega(self, frequencies: Complex) -> float:
        """The resonance, given the natural frequencies; nan where they are not real."""
        first, second = complex(frequencies[self.i]), complex(frequencies[self.j])
        if max(abs(first.imag), abs(second.imag)) > REAL * abs(first):
            return float("nan")
        return (first.real + self.sign * second.real) / self.order


def first_order(n: int, names: Sequence[str] = ()) -> tuple[Resonance, ...]:
    """Every resonance of order 1 of n frequencies, with the names that they have."""
    own = tuple(names)
    pairs = [(i, j) for j, i in combinations_with_replacement(range(n), 2)]
    differences = [Resonance(i, j, -1, names=own) for i, j in pairs if i > j]
    return tuple([Resonance(i, j, names=own) for i, j in pairs] + differences)


def modal(equation: HillEquation) -> tuple[Complex, Complex]:
    """Natural frequencies, ascending, and G in the modes of F."""
    squares, modes = np.linalg.eig(equation.F)
    frequencies = np.sqrt(squares.astype(complex))
    order = np.lexsort((frequencies.imag, frequencies.real))
    modes = modes[:, order]
    return frequencies[order], np.linalg.solve(modes, equation.G @ modes)


def fastest_motion(equation: HillEquation | PeriodicEquation) -> float:
    """No frequency, and no growth, is above it, whatever the units of the coordinates.

    The square root of the largest eigenvalue of |F| + |gamma| |G| + sum |H_s| (Perron), or that of
    the moduli of all that multiplies the states (q, q') or x; infinite where that is beyond a
    float.
    """
    if isinstance(equation, PeriodicEquation):
        return _fastest(equation)
    with np.errstate(over="ignore"):
        sizes = np.abs(equation.F) + abs(equation.gamma) * np.abs(equation.G)
        for H in equation.H:
            sizes = sizes + np.abs(H)
    if not np.all(np.isfinite(sizes)):
        return float("inf")
    return float(np.sqrt(np.max(np.abs(np.linalg.eigvals(sizes)))))


def _fastest(equation: PeriodicEquation) -> float:
    parts = [np.abs(x) for x in _moduli(equation)]
    if equation.A is not None:
        sizes = parts[0]
    else:
        n = len(parts[0])
        over = np.abs(np.linalg.inv(np.asarray(equation.M)))
        sizes = np.block([[np.zeros((n, n)), np.eye(n)], [over @ parts[0], over @ parts[1]]])
    if not np.all(np.isfinite(sizes)):
        return float("inf")
    return float(np.max(np.abs(np.linalg.eigvals(sizes))))


def _moduli(equation: PeriodicEquation) -> list[Any]:
    """What the elements of A, or of K and C, are at most in a period."""
    matrices = [equation.A] if equation.A is not None else [equation.K, equation.C]
    return [
        np.abs(x.mean) + sum(np.abs(part) for part in (*x.cos.values(), *x.sin.values()))
        for x in matrices
        if x is not None
    ]


def half_width(resonance: Resonance, equation: HillEquation, *, damped: bool = True) -> float:
    """Hsu's half width in Omega, to first order in gamma; 0 where there is no instability.

    gamma |G_ii|/(2 omega_i) at 2 omega_i; (gamma/2) sqrt(+-G_ij G_ji/(omega_i omega_j)) at the sum
    or the difference; damping eta takes it to sqrt(width**2 - eta**2), unless `damped` is false.
    Orders above 1 are narrower.

    References
    ----------
    Hsu, On the parametric excitation of a dynamic system having multiple degrees of freedom,
    Journal of Applied Mechanics 30 (1963).
    """
    square = 0.25 * equation.gamma**2 * coupling(resonance, equation)
    square -= equation.damping**2 if damped else 0.0
    return float(np.sqrt(square)) if square > 0.0 else 0.0


def critical_gamma(resonance: Resonance, equation: HillEquation) -> float:
    """Where Hsu's width with damping opens, 2 eta/sqrt(+-G_ij G_ji/(omega_i omega_j)).

    Nan without damping, above the first order, and where there is no instability.
    """
    eta, square = equation.damping, coupling(resonance, equation)
    if eta <= 0.0 or resonance.order > 1 or not square > 0.0:
        return float("nan")
    return float(2.0 * eta / np.sqrt(square))


def coupling(resonance: Resonance, equation: HillEquation) -> float:
    """+-G_ij G_ji/(omega_i omega_j), G in the modes of F: an instability where it is positive.

    0 where a frequency is: first order says nothing of a rigid body's motion.
    """
    frequencies, G = modal(equation)
    i, j = resonance.i, resonance.j
    squares = frequencies[i] * frequencies[j]
    return float(resonance.sign * (G[i, j] * G[j, i] / squares).real) if squares else 0.0
