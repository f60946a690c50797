"""Edges of tongues on charts, held against the arbiter's sign changes.

A tongue's edge is a zero in Omega of a function of P, and its bound holds where that function has
different signs at the edge less its error and at the edge plus its error. With c and s the
hyperbolic cosine and sine of pi eta/Omega the function is P(c) or P(-c); or, for a pair of z that
meet, or leave the ellipse x^2/c^2 + y^2/s^2 = 1 together, the determinant of

    (s/c)^2 S^2/4 - S^2/4 + Q - s^2 I

over pairs of coordinates, S and Q the second additive and multiplicative compounds of P's companion
matrix: their eigenvalues are z_i + z_j and z_i z_j.
"""

from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

from benchmarks.honesty import arbiter
from benchmarks.honesty.judge import INFLATED, Judged, Measured, truth
from benchmarks.honesty.trial import caught
from compare.charts.compute import chart
from compare.edges.instabilities import Instability, instabilities
from floquet.enclosure.balls import identity
from floquet.enclosure.judgement import BITS
from hill import HillEquation, MatrixSystem, SteppedBeam, UniformBeam
from hill.system import varied

ROUTES = ("floquet", "both")
NUMBERS = ("edge",)

# Places along a tongue at which both edges are looked at.
PLACES = 3

POINTS = 24
"""Of an axis: the chart is drawn with few, its series are as good as with many."""


def _gamma(rng: np.random.Generator) -> tuple[Any, dict[str, float], tuple[str, float, float]]:
    forcing = {"eta": float(rng.choice([0.0, rng.uniform(1e-3, 0.05)]))}
    return _beam(rng), forcing, ("gamma", 0.0, rng.uniform(0.1, 0.5))


def _thrust(rng: np.random.Generator) -> tuple[Any, dict[str, float], tuple[str, float, float]]:
    forcing = {"gamma": rng.uniform(0.02, 0.3), "eta": float(rng.choice([0.0, 0.01]))}
    return _beam(rng), forcing, ("T0", 2.0, rng.uniform(10.0, 25.0))


def _matrices(rng: np.random.Generator) -> tuple[Any, dict[str, float], tuple[str, float, float]]:
    n = int(rng.integers(2, 4))
    w = np.sort(rng.uniform(0.6, 2.5, n))
    basis = np.eye(n) + 0.2 * rng.standard_normal((n, n))
    F = basis @ np.diag(w**2) @ np.linalg.inv(basis)
    forcing = {"eta": float(rng.choice([0.0, rng.uniform(1e-3, 0.03)]))}
    system = MatrixSystem(F, 0.5 * rng.standard_normal((n, n)))
    return system, forcing, ("gamma", 0.0, rng.uniform(0.1, 0.6))


CHARTS: dict[str, Callable[[np.random.Generator], Any]] = {
    "beams, gamma": _gamma,
    "beams, thrust": _thrust,
    "matrices, gamma": _matrices,
}
NAMES = tuple(CHARTS)


def _beam(rng: np.random.Generator) -> UniformBeam | SteppedBeam:
    given: dict[str, Any] = {
        "T0": rng.uniform(5.0, 25.0),
        "K_theta": rng.uniform(0.2, 1.5),
        "xi_G": 0.5,
        "modes": int(rng.integers(1, 4)),
    }
    if rng.uniform() < 0.5:
        return UniformBeam(**given)
    return SteppedBeam(
        **given, xi_c=rng.uniform(0.3, 0.7), area_ratio=rng.uniform(0.5, 2.0),
        inertia_ratio=rng.uniform(0.5, 2.0),
    )  # fmt: skip


def trial(kind: str, seed: int, number: int, *, shrink: float = 1.0) -> list[Judged]:
    """Judge every tongue of one chart.

    Parameters
    ----------
    kind, seed, number
        Of `NAMES`, and which.
    shrink : float, optional
        Multiplies every bound: below 1 the trial must find fault.
    """
    rng = np.random.default_rng([seed, NAMES.index(kind), number])
    system, forcing, y = CHARTS[kind](rng)
    route = str(rng.choice(ROUTES))
    low = rng.uniform(0.7, 1.2)
    axes = [("Omega", low, low * rng.uniform(2.0, 3.5), POINTS), (*y, POINTS)]
    n = system.equation(1.0, 0.0).n
    about = {"kind": kind, "number": number, "n": n, "route": route}
    said = caught(lambda: instabilities(chart(system, axes, forcing=forcing, route=route)))
    if said.found is None:
        status = "refused" if said.refused else "failed"
        return [Judged(**about, status=status, violations=said.wrong)]

    def equation(Omega: float, value: float) -> HillEquation:
        at = forcing | {"Omega": Omega}
        if y[0] == "gamma":
            return system.equation(at["Omega"], value, at["eta"])
        return varied(system, {y[0]: value}).equation(at["Omega"], at["gamma"], at["eta"])

    return [_judged(about, found, equation, shrink, dict(said.wrong)) for found in said.found]


def _judged(
    about: dict[str, Any],
    found: Instability,
    equation: Callable[[float, float], HillEquation],
    shrink: float,
    wrong: dict[str, str],
) -> Judged:
    """Both edges at some places of a tongue, and its middle, which must be unstable."""
    known = np.flatnonzero(np.isfinite(found.edge_error))
    measured = []
    for k in map(int, known[np.linspace(0, len(known) - 1, min(PLACES, len(known))).astype(int)]):
        y, error = float(found.tongue.y[k]), shrink * float(found.edge_error[k])
        for edge in (float(found.tongue.lower[k]), float(found.tongue.upper[k])):
            one = _edge(found.resonance.indicator, edge, error, y, equation)
            if one is None:
                wrong["edge"] = (
                    f"{found.resonance.name}: none at {edge:.15g} +- {error:.2g}, y = {y}"
                )
            else:
                measured.append(one)
    y, low, high = found.y, *(found.tongue.at(found.y) or (found.Omega, found.Omega))
    middle = truth(equation(0.5 * (low + high), y)).growth
    if middle is not None and middle.truth not in ("unstable", "unknown"):
        wrong["verdict"] = f"{found.resonance.name}: its middle is {middle.truth} at y = {y}"
    return Judged(
        **about,
        status="answered",
        violations=wrong,
        measured={"edge": max(measured, key=lambda m: m.ratio)} if measured else {},
        unjudged=() if measured else ("edge",),
        truth=middle.truth if middle else "unknown",
    )


def _edge(
    kind: str,
    edge: float,
    error: float,
    y: float,
    equation: Callable[[float, float], HillEquation],
) -> Measured | None:
    """How far the true edge is; None where the function has the same sign at both ends."""
    ends = (edge - error, edge + error)
    one, other = (edge_function(kind, equation(Omega, y)) for Omega in ends)
    if not (one * other < 0):
        return None
    with ctx.workprec(BITS):
        # straight between the ends: what is left is of second order in their distance
        zero = ends[0] + (ends[1] - ends[0]) * float(one / (one - other))
    ratio = abs(zero - edge) / error
    true = max(abs(zero - edge), float(np.spacing(edge)))
    return Measured(ratio, error / true, told=error / true <= INFLATED)


def edge_function(kind: str, equation: HillEquation) -> Any:
    """What vanishes on an edge of this kind, as a ball."""
    P = arbiter.reference(equation)
    with ctx.workprec(BITS):
        angle = arb.pi() * arb(float(equation.eta)) / arb(float(equation.Omega))
        c, s = angle.cosh(), angle.sinh()
        if kind == "pair":
            return _pairs(P, c, s)
        at, value = c if kind == "+1" else -c, arb(0)
        for p in P:
            value = value * at + p
        return value


def _pairs(P: list[Any], c: Any, s: Any) -> Any:
    n = len(P) - 1
    A = arb_mat(n, n, [arb(0)] * (n * n))
    for j in range(n):
        A[0, j] = -P[j + 1]
        if j:
            A[j, j - 1] = arb(1)
    pairs = list(combinations(range(n), 2))
    total = arb_mat(len(pairs), len(pairs), [arb(0)] * len(pairs) ** 2)
    product = arb_mat(len(pairs), len(pairs), [arb(0)] * len(pairs) ** 2)
    for row, (i, j) in enumerate(pairs):
        for column, (k, m) in enumerate(pairs):
            product[row, column] = A[i, k] * A[j, m] - A[i, m] * A[j, k]
            total[row, column] = (
                A[i, k] * (j == m) + A[j, m] * (i == k) - A[i, m] * (j == k) - A[j, k] * (i == m)
            )
    squares = total * total
    form = squares * ((s / c) ** 2 / 4) - squares * (arb(1) / 4) + product
    return (form - identity(len(pairs)) * s**2).det()
