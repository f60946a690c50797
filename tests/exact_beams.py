"""F, G and H of the report's beams to any number of digits: closed forms in ball arithmetic."""

from functools import cache
from itertools import product
from typing import Any

import numpy as np
from flint import acb, arb, arb_mat, ctx

from hill import SteppedBeam, UniformBeam

Terms = list[tuple[acb, acb]]
"""c and kappa of a sum of c exp(kappa xi)."""

ZERO: Terms = [(acb(0), acb(0))]
UNIT: Terms = [(acb(1), acb(0))]


def bits(modes: int) -> int:
    """exp(2 lambda) loses 2.9 lambda bits, of lambda = (modes + 1/2) pi; 200 are left."""
    return 200 + int(10 * (modes + 1))


@cache
def eigenvalue(n: int, precision: int) -> arb:
    x = arb((n + 0.5) * np.pi)
    for _ in range(14):
        slope = x.sinh() * x.cos() - x.cosh() * x.sin()
        x = (x - (x.cosh() * x.cos() - 1) / slope).mid()
    return x


@cache
def mode(n: int, precision: int) -> Terms:
    lam = eigenvalue(n, precision)
    alpha = (lam.cosh() - lam.cos()) / (lam.sinh() - lam.sin())
    i, one, two = acb(0, 1), acb(1), acb(2)
    c = [(one - alpha) / two, (one + i * alpha) / two, (one + alpha) / two, (one - i * alpha) / two]
    return [(c[p], lam * i**p) for p in range(4)]


def derivative(f: Terms) -> Terms:
    return [(c * kappa, kappa) for c, kappa in f]


def at(f: Terms, xi: Any) -> arb:
    return sum((c * (kappa * xi).exp() for c, kappa in f), acb(0)).real


def times(f: Terms, g: Terms) -> Terms:
    return [(a * b, k + m) for (a, k), (b, m) in product(f, g)]


def moment(kappa: acb, a: arb, b: arb) -> acb:
    """Integral of exp(kappa xi)."""
    if kappa == 0:
        return acb(b - a)
    return ((kappa * b).exp() - (kappa * a).exp()) / kappa


def first_moment(kappa: acb, a: arb, b: arb) -> acb:
    """Integral of xi exp(kappa xi)."""
    if kappa == 0:
        return acb((b * b - a * a) / 2)
    ends = (kappa * b).exp() * (kappa * b - 1) - (kappa * a).exp() * (kappa * a - 1)
    return ends / kappa**2


def integral(f: Terms, a: arb, b: arb) -> acb:
    return sum((c * moment(kappa, a, b) for c, kappa in f), acb(0))


def sine_integral(f: Terms, nu: acb, origin: arb, a: arb, b: arb) -> acb:
    """Of f sin(nu (xi - origin))/nu."""
    if nu == 0:
        return sum((c * (first_moment(k, a, b) - origin * moment(k, a, b)) for c, k in f), acb(0))
    i = acb(0, 1)
    turn = (i * nu * origin).exp()
    return sum(
        (c * (moment(k + i * nu, a, b) / turn - moment(k - i * nu, a, b) * turn) for c, k in f),
        acb(0),
    ) / (2 * i * nu)


@cache
def matrices(beam: UniformBeam | SteppedBeam, Omega: float, gamma: float, terms: int = 0) -> Any:
    """F, G and the H, as nested lists of arb, for the parameters' own floats."""
    ctx.prec = bits(beam.modes)
    make = _uniform if isinstance(beam, UniformBeam) else _stepped
    return make(beam, Omega, gamma, terms, ctx.prec)


def _uniform(beam: UniformBeam, Omega: float, gamma: float, terms: int, precision: int) -> Any:
    shapes = [mode(n, precision) for n in range(1, beam.modes + 1)]
    slopes = [*map(derivative, shapes), UNIT]
    one, none, size = arb(1), arb(0), range(beam.modes + 1)
    lam = [eigenvalue(n, precision) for n in range(1, beam.modes + 1)]
    arm = [*(at(f, one) for f in shapes), arb(0.5)]
    side = [at(f, one) + arb(beam.K_theta) * at(f, arb(beam.xi_G)) for f in slopes]
    scale = [arb(beam.T0) / lam[0] ** 4 * k for k in [1] * beam.modes + [12]]
    sigma = arb(0) if np.isinf(beam.omega_L) else arb(Omega) / arb(beam.omega_L)

    def pairs(nu: acb) -> list[list[acb]]:
        return [
            [sine_integral(times(slopes[j], slopes[k]), nu, none, none, one) for k in size]
            for j in size
        ]

    def thrust(nu: acb) -> list[list[arb]]:
        over = acb(1) if nu == 0 else nu.sin() / nu
        found = pairs(nu)
        return [
            [scale[j] * (arm[j] * side[k] - (found[j][k] / over).real) for k in size] for j in size
        ]

    F = thrust(acb(0))
    for j in range(beam.modes):
        F[j][j] += (lam[j] / lam[0]) ** 4
    wave = (acb(sigma) ** 2 - acb(0, 1) * arb(beam.g)).sqrt() if beam.g else acb(sigma)
    H = []
    for s in range(1, terms + 1):
        C = 2 * s * (-1) ** s / arb.pi() * (1 / arb(s) ** 2 + arb(gamma) / (arb(s) ** 2 - sigma**2))
        nu = s * acb.pi()
        found = pairs(nu)
        H.append([[-scale[j] * C * (found[j][k] * nu).real for k in size] for j in size])
    return [F, thrust(acb.pi() * wave), *H]


def _stepped(beam: SteppedBeam, Omega: float, gamma: float, terms: int, precision: int) -> Any:
    shapes = [mode(n, precision) for n in range(1, beam.modes + 1)]
    slopes = [*map(derivative, shapes), UNIT, ZERO]
    one, none, size = arb(1), arb(0), range(beam.modes + 2)
    c, r, ratio = arb(beam.xi_c), arb(beam.area_ratio), arb(beam.inertia_ratio)
    first = eigenvalue(1, precision) ** 4
    bends = [*(derivative(derivative(f)) for f in shapes), ZERO, ZERO]
    sigma = arb(0) if np.isinf(beam.omega_L) else arb(Omega) / arb(beam.omega_L)

    def over_both(f: Any, ahead: arb) -> list[list[arb]]:
        return [[ahead * f(j, k, none, c) + f(j, k, c, one) for k in size] for j in size]

    def masses(j: int, k: int, a: arb, b: arb) -> arb:
        j, k = max(j, k), min(j, k)
        N = beam.modes
        if j < N:
            return integral(times(shapes[j], shapes[k]), a, b).real
        if k < N:
            f = shapes[k]
            if j == N:
                return sine_integral(f, acb(0), none, a, b).real
            return integral(f, a, b).real
        power = {(N, N): 3, (N + 1, N): 2, (N + 1, N + 1): 1}[(j, k)]
        return (b**power - a**power) / power

    def bending(j: int, k: int, a: arb, b: arb) -> arb:
        return integral(times(bends[j], bends[k]), a, b).real

    def thrust(nu: acb) -> list[list[arb]]:
        rest = 1 - c

        def over(x: acb) -> acb:
            return acb(1) if x == 0 else x.sin() / x

        stiffness = (nu * c).cos() * rest * over(nu * rest) + r * c * over(nu * c) * (
            nu * rest
        ).cos()
        whole, step = r / stiffness, (1 - r) * (nu * c).cos() / stiffness
        arm = [*(at(f, one) for f in shapes), one, one]
        side = [at(f, one) + arb(beam.K_theta) * at(f, arb(beam.xi_G)) for f in slopes]

        def axial(j: int, k: int) -> acb:
            both = times(slopes[j], slopes[k])
            return whole * sine_integral(both, nu, none, none, one) + step * sine_integral(
                both, nu, c, c, one
            )

        return [
            [arb(beam.T0) / first * (arm[j] * side[k] - axial(j, k).real) for k in size]
            for j in size
        ]

    A = arb_mat(over_both(masses, r))
    stiff = over_both(bending, ratio)
    steady = thrust(acb(0))
    B = arb_mat([[stiff[j][k] / first + steady[j][k] for k in size] for j in size])
    C = arb_mat(thrust(acb.pi() * acb(sigma)))
    cut = range(beam.modes + 1)
    return [[[X[j, k] for k in cut] for j in cut] for X in (A.solve(B), A.solve(C))]


def off(exact: Any, made: Any) -> np.ndarray:
    """exact - made, as floats."""
    return np.array(
        [
            [float((x - arb(float(y))).mid()) for x, y in zip(row, line, strict=True)]
            for row, line in zip(exact, made, strict=True)
        ]
    )
