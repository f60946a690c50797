"""A Hill equation in balls, from the floats' exact values on, and its derivative in a direction.

In theta = Omega tau, and for a damping that is one number in u = exp(eta tau/2) q,

    u'' + D u' + (K + sum_p M_p cos p theta) u = 0.

The solution of the equation with the blocks [[K, dK], [0, K]] has the blocks [[u, du], [0, u]]: a
derivative is the solution of an equation twice as large, with nothing to be differenced.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, arb_mat


@dataclass(frozen=True, eq=False)
class Problem:
    """The equation above.

    Attributes
    ----------
    K : (n, n) arb_mat
    pulses : tuple of (int, arb_mat)
        Each (p, M_p).
    D : arb_mat or None
        None where there is no such term.
    """

    K: Any
    pulses: tuple[tuple[int, Any], ...]
    D: Any | None

    @property
    def n(self) -> int:
        """Coordinates."""
        return int(self.K.nrows())


def exact(matrix: Any) -> Any:
    """Floats as balls of radius zero."""
    rows = np.atleast_2d(np.asarray(matrix, float))
    return arb_mat(*rows.shape, [arb(float(x)) for x in rows.ravel()])


def identity(n: int) -> Any:
    """The unit matrix."""
    return exact(np.eye(n))


def norm(matrix: Any) -> float:
    """Upper bound on the largest row sum of moduli."""
    return 1.0001 * max(sum(float(x.abs_upper()) for x in row) for row in matrix.tolist())


def problem(equation: Any) -> Problem:
    """The equation, read as data, at the precision of the moment."""
    Omega = arb(float(equation.Omega))
    per = 1 / Omega**2
    pulses = [(1, exact(equation.G) * (arb(float(equation.gamma)) * per))]
    for s, H in enumerate(equation.H, start=1):
        pulses.append((s * round(equation.omega_L / equation.Omega), exact(H) * per))
    F = exact(equation.F)
    if np.ndim(equation.eta) > 0:
        return Problem(F * per, tuple(pulses), exact(equation.eta) / Omega)
    eta = arb(float(equation.eta))
    return Problem((F - identity(len(equation.F)) * (eta * eta / 4)) * per, tuple(pulses), None)


def moved(equation: Any, direction: Mapping[str, Any]) -> Problem:
    """The equation of twice the size, whose solution has the derivative in a direction in it.

    Parameters
    ----------
    equation : HillEquation
    direction : mapping of str to array_like
        How fast "Omega", "gamma", "eta", "F", "G" and "H" move; omega_L keeps its ratio to Omega.
    """
    here, n = problem(equation), len(equation.F)
    Omega = arb(float(equation.Omega))
    per, faster = 1 / Omega**2, _number(direction, "Omega") / Omega
    nothing = np.zeros((n, n))
    dF = exact(direction.get("F", nothing))
    dD = None
    if here.D is not None:
        dD = _block(here.D, exact(direction.get("eta", nothing)) / Omega - here.D * faster)
    else:
        dF = dF - identity(n) * (arb(float(equation.eta)) * _number(direction, "eta") / 2)
    dG = exact(direction.get("G", nothing)) * arb(float(equation.gamma))
    moves = [dG + exact(equation.G) * _number(direction, "gamma")]
    moves += [exact(H) for H in direction.get("H", [nothing] * len(equation.H))]
    pulses = [
        (p, _block(M, dM * per - M * (2 * faster)))
        for (p, M), dM in zip(here.pulses, moves, strict=True)
    ]
    return Problem(_block(here.K, dF * per - here.K * (2 * faster)), tuple(pulses), dD)


def _number(direction: Mapping[str, Any], name: str) -> Any:
    return arb(float(direction.get(name, 0.0)))


def _block(M: Any, dM: Any) -> Any:
    """[[M, dM], [0, M]]."""
    n, zero = M.nrows(), [arb(0)] * M.ncols()
    above = [a + b for a, b in zip(M.tolist(), dM.tolist(), strict=True)]
    return arb_mat(
        2 * n, 2 * n, [x for row in [*above, *(zero + r for r in M.tolist())] for x in row]
    )
