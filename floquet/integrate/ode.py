"""The matrix Hill equation as a CasADi expression, written as Eq. (6.1.1) is printed."""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from floquet.arrays import Float
from hill import HillEquation


@dataclass(frozen=True)
class Shape:
    """What a compiled CasADi function depends on: n coordinates, `terms` matrices H_s."""

    n: int
    terms: int


@dataclass(frozen=True, eq=False)
class Parameters:
    """The numbers of one equation, in the order the CasADi functions take them."""

    F: Any
    G: Any
    H: Any
    C: Any
    gamma: Any
    Omega: Any
    omega_L: Any

    def __iter__(self) -> Any:
        return iter(vars(self).values())


def shape(equation: HillEquation) -> Shape:
    """The shape of an equation."""
    return Shape(len(equation.F), len(equation.H))


def parameter_values(equation: HillEquation, *, undamped: bool = False) -> Parameters:
    """The numbers of an equation; `undamped` in u of Eq. (6.1.2), whose damping term is gone.

    H_s are side by side, shape (n, n * terms); C is the damping matrix.
    """
    n = len(equation.F)
    C = equation.eta * np.eye(n) if np.ndim(equation.eta) == 0 else np.asarray(equation.eta)
    F = equation.F - 0.25 * equation.damping**2 * np.eye(n) if undamped else equation.F
    return Parameters(
        F=F,
        G=equation.G,
        H=np.hstack(equation.H) if equation.H else np.zeros((n, 0)),
        C=np.zeros((n, n)) if undamped else C,
        gamma=equation.gamma,
        Omega=equation.Omega,
        omega_L=equation.omega_L if equation.H else 0.0,
    )


def symbols(kind: Any, size: Shape) -> Parameters:
    """CasADi symbols for `Parameters`; `kind` is ``casadi.SX`` or ``casadi.MX``."""
    n = size.n
    return Parameters(
        F=kind.sym("F", n, n),
        G=kind.sym("G", n, n),
        H=kind.sym("H", n, n * size.terms),
        C=kind.sym("C", n, n),
        gamma=kind.sym("gamma"),
        Omega=kind.sym("Omega"),
        omega_L=kind.sym("omega_L"),
    )


def acceleration(q: Any, v: Any, tau: Any, p: Parameters, size: Shape) -> Any:
    """Q'' of Eq. (6.1.1) at the time `tau`, for one or more columns q and v = q'."""
    stiffness = p.F + p.gamma * ca.cos(p.Omega * tau) * p.G
    for s, H_s in enumerate(ca.horzsplit(p.H, size.n) if size.terms else [], start=1):
        stiffness += ca.cos(s * p.omega_L * tau) * H_s
    return -(p.C @ v) - stiffness @ q


def terms(p: Parameters, size: Shape) -> list[tuple[Float, float]]:
    """Stiffness matrices with the frequencies of their cosines."""
    free = [(p.H[:, s * size.n : (s + 1) * size.n], (s + 1) * p.omega_L) for s in range(size.terms)]
    return [(p.F, 0.0), (p.gamma * p.G, p.Omega), *free]
