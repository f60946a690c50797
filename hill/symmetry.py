r"""Symmetries of a periodic equation by which its multipliers come in pairs, mu and r^2/mu.

With u = exp(eta tau/2) q the equation M q'' + C q' + K q = 0 becomes M u'' + C_u u' + K_u u = 0,

    C_u = C - eta M,     K_u = K - (eta/2) C_u - (eta^2/4) M.

The multipliers of u are in pairs mu, 1/mu, and those of q in pairs about r = exp(-pi eta/Omega), if

* M is symmetric, C_u skew and K_u - C_u'/2 symmetric: these are Lagrange's equations of
  (u' M u' - u' C_u u - u (K_u - C_u'/2) u)/2, and the monodromy matrix is symplectic in u and
  M u' + C_u u/2;
* or time can be reversed: with some signs R on the diagonal and some origin of time M and the even
  part of K_u commute with R, the even part of C_u anticommutes, and the odd parts the other way
  round. Then R u(-tau) is a solution where u(tau) is one.

An equation of first order likewise, x = exp(-eta tau/2) u: with J A_u symmetric it is Hamilton's in
the order of all coordinates and all momenta, and it is reversible if the even part of A_u
anticommutes with some R and the odd part commutes.

All of this is decided on the floats as they are given, in fractions, without any tolerance: what is
not exactly so has no pairs. eta is what the diagonal of C_u, or the trace of A_u, leaves no choice
of. Origins that are tried are tau = 0 and a quarter of the period later.
"""

from fractions import Fraction
from functools import reduce
from math import gcd
from typing import Any

import numpy as np
from scipy.sparse.csgraph import connected_components

from hill.arrays import Bool, Float
from hill.periodic import Fourier, PeriodicEquation

Parts = dict[tuple[int, bool], Any]
"""Matrices of fractions by harmonic, and whether it is a sine; the mean is harmonic 0's cosine."""

MEAN = (0, False)


def damping_of_pairs(equation: PeriodicEquation) -> Fraction | None:
    """Eta, where multipliers come in pairs mu and exp(-2 pi eta/Omega)/mu; None where not shown."""
    if equation.A is not None:
        return _first_order(equation.A)
    assert equation.C is not None
    assert equation.K is not None
    M, C, K = _exact(np.asarray(equation.M)), _parts(equation.C), _parts(equation.K)
    heaviest = int(np.argmax(np.abs(np.diag(M))))
    mass = M[heaviest, heaviest]
    eta = C[MEAN][heaviest, heaviest] / mass if mass else Fraction(0)
    if eta:
        C[MEAN] = C[MEAN] - eta * M
        K = {x: K.get(x, 0 * M) - (eta / 2 * C[x] if x in C else 0) for x in {*K, *C}}
        K[MEAN] = K[MEAN] - eta * eta / 4 * M
    if np.any(np.diag(C[MEAN]) != 0):
        return None
    if _lagrangian(M, C, K, Fraction(equation.Omega)):
        return eta
    return eta if _reversible(len(M), {MEAN: M}, C, K) else None


def _first_order(given: Fourier) -> Fraction | None:
    A = _parts(given)
    m = given.n
    eta = -2 * sum(np.diag(A[MEAN]), Fraction(0)) / m
    A[MEAN] = A[MEAN] + eta / 2 * np.eye(m, dtype=int)
    return eta if _hamiltonian(m, A) or _reversible(m, {}, A, {}) else None


def _lagrangian(M: Any, C: Parts, K: Parts, Omega: Fraction) -> bool:
    if not _same(M, M.T) or not all(_same(x, -x.T) for x in C.values()):
        return False
    for k, sine in {*K, *C}:
        # of C': cos k Omega tau comes from the sine
        rise = (-1 if sine else 1) * k * Omega * C.get((k, not sine), 0)
        stiffness = K.get((k, sine), 0 * M)
        if not _same(stiffness - stiffness.T, rise + 0 * M):
            return False
    return True


def _hamiltonian(m: int, A: Parts) -> bool:
    n = m // 2
    turned = [np.vstack([x[n:], -x[:n]]) for x in A.values()]
    return m == 2 * n and all(_same(x, x.T) for x in turned)


def _reversible(n: int, M: Parts, C: Parts, K: Parts) -> bool:
    """Whether there are signs, about one origin of time or the other."""
    basic = reduce(gcd, (k for k, _ in (*C, *K)), 0) or 1
    for later in (False, True):
        apart: list[Bool] = [np.zeros((n, n), bool)]
        alike: list[Bool] = [np.zeros((n, n), bool)]
        for parts, turns in ((M, False), (C, True), (K, False)):
            for (k, sine), matrix in parts.items():
                # a quarter of the period makes sines of odd cosines, and the reverse
                odd = sine != (later and (k // basic) % 2 == 1)
                (apart if turns != odd else alike).append(np.asarray(matrix != 0, bool))
        if _signs_exist(np.any(alike, axis=0), np.any(apart, axis=0)):
            return True
    return False


def _signs_exist(alike: Bool, apart: Bool) -> bool:
    """Whether signs can be alike and opposite as asked: none hangs together with its opposite."""
    n = len(alike)
    _, part = connected_components(np.block([[alike, apart], [apart, alike]]), directed=False)
    return bool(np.all(part[:n] != part[n:]))


def _parts(matrix: Fourier) -> Parts:
    cosines = {(k, False): _exact(x) for k, x in matrix.cos.items()}
    sines = {(k, True): _exact(x) for k, x in matrix.sin.items()}
    return {MEAN: _exact(matrix.mean), **cosines, **sines}


def _exact(matrix: Float) -> Any:
    return np.frompyfunc(Fraction, 1, 1)(matrix)


def _same(one: Any, other: Any) -> bool:
    return bool(np.all(one == other))
