"""Whether multipliers come in pairs about a circle, told from the numbers of an equation.

Write the equation as L q = sum_d X_d(tau) D^d q = 0, D = d/dtau. Two operations lead from it to
others of its kind, eta being any number:

* the adjoint, with a weight exp(eta tau), from integrals of exp(eta tau) w L q by parts. Of second
  order it is M' D^2 + (2 eta M' - C') D + eta^2 M' - eta C' - (dC/dtau)' + K', ' the transposed;
* time run backwards, w(tau) = exp(-eta tau) R q(-tau), R a diagonal of signs: D becomes -(D + eta).

Where one of them gives L again, a multiplier mu comes with exp(-2 pi eta/Omega)/mu, since the
adjoint's multipliers are the inverses of L's but for the weight, and time run backwards inverts
them. Of x' = A x the adjoint is taken in J x, J the matrix of Hamilton's equations: it is the same
where J A + A' J is -eta J.

The floats are taken as they are, as fractions: a symmetry holds exactly or is not there.
"""

from collections import deque
from fractions import Fraction
from math import comb, gcd
from typing import Any

import numpy as np

from floquet.arrays import Bool
from hill import Fourier, PeriodicEquation


def pairs_decay(equation: PeriodicEquation) -> float | None:
    """Eta of the circle |mu| = exp(-pi eta/Omega) about which multipliers pair; None without."""
    X, harmonics = _operator(equation)
    heavy = np.diag(X[-1][0, 0])
    square = sum(heavy * heavy)
    eta = Fraction(2, len(X) - 1) * sum(heavy * np.diag(X[-2][0, 0])) / square if square else square
    if len(X) == 3:
        own = _self_adjoint(X, harmonics, Fraction(equation.Omega), eta)
    else:
        own = _hamiltonian(-X[0], eta)
    return float(eta) if own or _runs_backwards(X, harmonics, eta) else None


def _operator(equation: PeriodicEquation) -> tuple[list[Any], list[int]]:
    """X_d as fractions (h, 2, n, n), a cosine and a sine of each harmonic; harmonic 0 first."""
    if equation.A is not None:
        n, given = equation.A.n, [(-1.0, equation.A)]
        last = np.eye(n)
    else:
        assert equation.M is not None
        n, last = len(equation.M), equation.M
        given = [(1.0, x) for x in (equation.K, equation.C) if x is not None]
    harmonics = sorted({0, *(k for _, x in given for k in x.harmonics)})
    floats = [sign * _stacked(x, harmonics) for sign, x in given]
    top = np.zeros_like(floats[0])
    top[0, 0] = last
    fraction = np.frompyfunc(Fraction, 1, 1)
    return [fraction(x) for x in (*floats, top)], harmonics


def _stacked(matrix: Fourier, harmonics: list[int]) -> Any:
    none = np.zeros_like(matrix.mean)
    found = [[matrix.cos.get(k, none), matrix.sin.get(k, none)] for k in harmonics]
    found[0][0] = matrix.mean
    return np.array(found)


def _self_adjoint(X: list[Any], harmonics: list[int], Omega: Fraction, eta: Any) -> bool:
    K, C, M = (x.swapaxes(-1, -2) for x in X)
    rate = np.array([k * Omega for k in harmonics], object)[:, None, None]
    slope = np.stack([rate * C[:, 1], -rate * C[:, 0]], axis=1)
    adjoint = [eta * (eta * M - C) - slope + K, 2 * eta * M - C, M]
    return all(bool(np.all(x == y)) for x, y in zip(X, adjoint, strict=True))


def _hamiltonian(A: Any, eta: Any) -> bool:
    m = A.shape[-1]
    if m % 2:
        return False
    J = np.array(np.kron([[0, 1], [-1, 0]], np.eye(m // 2, dtype=int)), object)
    # J A + A' J, as (J A)' is -A' J
    turned = J @ A
    off = turned - turned.swapaxes(-1, -2)
    off[0, 0] = off[0, 0] + eta * J
    return not np.any(off != 0)


def _runs_backwards(X: list[Any], harmonics: list[int], eta: Any) -> bool:
    """Backwards from tau = 0, or from a quarter of the period later."""
    first = gcd(*harmonics) or 1
    at_zero = np.array([[1, -1]] * len(harmonics))
    later = at_zero * np.array([[(-1) ** (k // first)] for k in harmonics])
    return any(_same_but_signs(X, sign[:, :, None, None], eta) for sign in (at_zero, later))


def _same_but_signs(X: list[Any], mirror: Any, eta: Any) -> bool:
    degree = len(X) - 1
    fits = np.ones((2, *X[0].shape[-2:]), bool)
    for j in range(degree + 1):
        back = sum(
            (-1) ** (degree - d) * comb(d, j) * eta ** (d - j) * X[d] * mirror
            for d in range(j, degree + 1)
        )
        for i, sign in enumerate((1, -1)):
            fits[i] &= np.all(X[j] == sign * back, axis=(0, 1))
    return _signs(*fits)


def _signs(alike: Bool, opposite: Bool) -> bool:
    """Whether there are signs whose products, two by two, are among those that fit."""
    n = len(alike)
    alike, opposite = alike & alike.T, opposite & opposite.T
    if not np.all(alike | opposite):
        return False
    sign = [0] * n
    for start in range(n):
        if sign[start]:
            continue
        sign[start] = 1
        queue = deque([start])
        while queue:
            i = queue.popleft()
            for j in range(n):
                if alike[i, j] and opposite[i, j]:
                    continue
                needed = sign[i] if alike[i, j] else -sign[i]
                if sign[j] == 0:
                    sign[j] = needed
                    queue.append(j)
                elif sign[j] != needed:
                    return False
    return True
