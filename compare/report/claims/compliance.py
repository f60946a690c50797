"""Longitudinal compliance away from resonance and its integrals (7.3.2, 8.1.4, B-4)."""

from itertools import pairwise

import numpy as np

from compare.report.claims.both_routes import RoutesDisagree, both
from compare.report.claims.cases import regions, resonances, uniform
from compare.report.claims.finding import (
    PRINTED,
    VISIBLE,
    Finding,
    Number,
    check_for,
    graded,
    share,
)
from compare.report.one_route import ROUTES, equation, integral_of_force
from compare.report.tables import GAMMA
from hill import UniformBeam

# Closed form against quadrature, of integrals of order 10.
INTEGRAL_TOLERANCE = 1e-9
# G grows like 1/|1 - sigma| where it is infinite at all: two decades nearer multiply it by 100.
GROWTH = 50.0


@check_for("compliance-far")
def compliance_far() -> Finding:
    """T_x over omega_L/Omega, beside the rigid bar's."""
    ratios = (20.0, 10.0, 5.0, 2.0)
    numbers, worst = [], dict.fromkeys(ratios, 0.0)
    for r in regions(uniform()):
        for ratio in ratios:
            T = both(uniform(omega_L=ratio * r.Omega), r.Omega)
            worst[ratio] = max(worst[ratio], abs(T.hill / r.hill.T_x - 1.0))
            if ratio == 2.0:
                numbers.append(r.at_resonance.number(f"{r.name}: T_x, omega_L infinite"))
                numbers.append(T.number(f"{r.name}: T_x, omega_L = 2 Omega"))
    numbers += [
        Number(f"largest change of a T_x, omega_L = {ratio:g} Omega", change, None, 3)
        for ratio, change in worst.items()
    ]
    verdict = graded(max(worst.values()) <= VISIBLE, worst[20.0] <= VISIBLE)
    because = (
        f"At omega_L = 20 Omega every T_x is within {share(worst[20.0])} of the rigid bar's; at "
        f"10 Omega one is off by {share(worst[10.0])}, at 2 Omega by a factor of "
        f"{1.0 + worst[2.0]:.1f}, that of 2 omega_(1), where G_11 nearly cancels."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("infinite-at-resonance")
def infinite_at_resonance() -> Finding:
    """T_x as omega_L comes down to Omega, a tenth of the distance at a time."""
    numbers, factors = [], []
    rigid = resonances(uniform())
    for name in ("2 omega_(1)", "omega_(2) + omega_(B)", "2 omega_(2)"):
        series = []
        for distance in (0.1, 0.01, 0.001):
            beam = uniform(omega_L=rigid[name] * (1.0 + distance))
            series.append(both(beam, rigid[name]))
            numbers.append(series[-1].number(f"{name}: T_x, omega_L/Omega = 1 + {distance:g}", 3))
        factors += [b.hill / a.hill for a, b in pairwise(series)]
    verdict = graded(min(factors) >= 2.0, min(factors) > 1.0 + VISIBLE)
    because = (
        f"Each tenth of the distance multiplies T_x by {min(factors):.1f} or more, without end: "
        "in the end like 1/sqrt(distance), as where the stiffness itself grows like 1/distance."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("integrals")
def integrals() -> Finding:
    """How every element of G grows as Omega/omega_L comes to 1 and to 2."""
    grown = {at: _growth(at) for at in (1, 2)}
    names = ("1", "2", "B")
    numbers, wrong = [], []
    for j in range(3):
        for k in range(j, 3):
            for at in (1, 2):
                h, f = (min(route[j, k], route[k, j]) for route in grown[at])
                numbers.append(Number(f"G_{names[j]}{names[k]}: growth towards {at}", h, f, 0))
                infinite, said = h > GROWTH, (j == k) == (at == 1)
                if infinite != said and infinite:
                    wrong.append(f"G_{names[j]}{names[k]} at {at}")
    diagonal = all(grown[1][0][j, j] > GROWTH for j in range(3))
    verdict = graded(diagonal and not wrong, diagonal)
    because = (
        "The diagonal is infinite at 1. Off it parity decides: elements of modes of unlike "
        f"symmetry are infinite at 2, but not all are unlike ({', '.join(wrong)} is infinite too)."
    )
    return Finding(tuple(numbers), verdict, because)


def _growth(at: int) -> tuple[np.ndarray, np.ndarray]:
    """|G| nearer the resonance over |G| farther from it, by both routes."""
    beam, found = uniform(omega_L=2.0), []
    for route in ROUTES:
        near, far = (equation(route, beam, 2.0 * (at - d), GAMMA).G for d in (1e-5, 1e-3))
        found.append(np.abs(near / far))
    return found[0], found[1]


@check_for("damped-integral")
def damped_integral() -> Finding:
    """Re of the integral of Phi* (Figure 27), and Im, which the figure leaves out."""
    away, changes = (0.5, 0.8, 1.2, 1.5), []
    numbers = []
    for sigma in away:
        free, damped = (_integral(sigma, g) for g in (1e-12, 0.04))
        changes.append(abs(damped[0].real / free[0].real - 1.0))
        numbers.append(_real(f"Re, g = .04, Omega/omega_L = {sigma:g}", damped))
        numbers.append(Number(f"its change by g, Omega/omega_L = {sigma:g}", changes[-1], None, 3))
    at, beside = _integral(1.0, 0.04), (_integral(0.98, 0.04), _integral(1.02, 0.04))
    numbers += [_real("Re, g = .04, Omega/omega_L = .98", beside[0])]
    numbers += [_real("Re, g = .04, Omega/omega_L = 1", at)]
    numbers += [_real("Re, g = .04, Omega/omega_L = 1.02", beside[1])]
    numbers += [Number("Im, g = .04, Omega/omega_L = 1", at[0].imag, at[1].imag, 4)]
    passes = beside[0][0].real > 0.0 > beside[1][0].real
    stated = max(changes) <= VISIBLE and passes
    vanishes = abs(at[0]) <= VISIBLE * max(abs(pair[0]) for pair in beside)
    verdict = graded(stated and vanishes, stated)
    because = (
        f"The real part does so, but the force does not vanish with it: at resonance it is "
        f"{abs(at[0].imag):.1f}, a quarter of a period behind the thrust, its largest; the "
        "report's equation leaves that part out."
    )
    return Finding(tuple(numbers), verdict, because)


def _integral(sigma: float, g: float) -> tuple[complex, complex]:
    """Integral of Phi* over the beam by both routes."""
    beam = UniformBeam(T0=1.0, K_theta=0.0, xi_G=0.0, omega_L=1.0, g=g)
    closed, summed = (integral_of_force(route, beam, sigma) for route in ROUTES)
    if abs(summed - closed) > INTEGRAL_TOLERANCE:
        raise RoutesDisagree(f"integral of Phi* at {sigma:g}: {closed:.12g} and {summed:.12g}")
    return closed, summed


def _real(label: str, pair: tuple[complex, complex]) -> Number:
    return Number(label, pair[0].real, pair[1].real, 4)


@check_for("above-fifty")
def above_fifty() -> Finding:
    """T_x and z at omega_L = 100 and 50, beside the rigid bar's."""
    numbers, moved, relative = [], [], []
    for omega_L in (100.0, 50.0):
        for r in regions(uniform()):
            T = both(uniform(omega_L=omega_L), r.Omega)
            moved.append(T.hill - r.hill.T_x)
            relative.append(abs(moved[-1]) / r.hill.T_x)
            change = Number(
                f"{r.name}: change of T_x, omega_L = {omega_L:g}",
                moved[-1],
                T.floquet - r.at_resonance.floquet,
                6,
            )
            if abs(moved[-1]) > PRINTED:
                numbers.append(change)
    largest = max(abs(m) for m in moved)
    numbers.append(Number("largest relative change of a T_x", max(relative), None, 4))
    verdict = graded(largest <= PRINTED, max(relative) <= VISIBLE)
    because = (
        f"It moves T_x by {share(max(relative))} at most, which no figure shows; but Tables 1 and "
        f"2 print five decimals, and {largest:.5f} is {largest / 1e-5:.0f} units of the last."
    )
    return Finding(tuple(numbers), verdict, because)
