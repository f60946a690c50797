"""The derivative of a Hill equation in a direction, in balls.

The solution of the equation with the blocks [[K, dK], [0, K]] has the blocks [[u, du], [0, u]]: a
derivative is the solution of an equation twice as large, with nothing to be differenced.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from flint import arb, arb_mat

from floquet.enclosure.balls import Problem, exact, identity, problem


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
