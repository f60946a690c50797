"""Forcing at a longitudinal frequency: Figures 28 and 29, omega_L = 2 (7.3.2, 8.1.3 and 8.4)."""

import numpy as np

from compare.report.claims.both_routes import Boundary, both, boundary, by_both, edge, severest
from compare.report.claims.cases import Region, regions, resonances, uniform
from compare.report.claims.finding import VISIBLE, Finding, Number, check_for, graded, share
from compare.report.claims.out_of_phase import sine_alone, whole_force
from compare.report.one_route import RouteName
from compare.report.tables import ETA
from hill import UniformBeam

OMEGA_L = 2.0
STRIDE = 0.02
# "Broad": ten times the rigid bar's.
BROAD = 10.0
# "Slightly": no more than a fifth.
SLIGHTLY = 0.2
OUT_OF_PHASE = "the part of the force out of phase, which that leaves out"


def bar(g: float) -> UniformBeam:
    """The beam of Table 1 with omega_L = 2."""
    return uniform(omega_L=OMEGA_L, g=g)


def _rigid() -> Region:
    return next(r for r in regions(uniform()) if r.name == "2 omega_(1)")


def _lower(g: float) -> Boundary:
    """Lower boundary of the region at 2 omega_(1)."""
    return edge(bar(g), _rigid().Omega, -STRIDE)


def _upper(g: float) -> Boundary:
    """Upper boundary: above 2 where there is a region, else below."""
    beam = bar(g)
    above = 2.0375
    return edge(beam, _rigid().Omega if both(beam, above).stable else above, STRIDE)


def _width(low: Boundary, high: Boundary, route: RouteName) -> float:
    return float(getattr(high, route) - getattr(low, route))


@check_for("gap")
def gap() -> Finding:
    """Stability at Omega = 2, g = .04, in the report's equation and with the whole force."""
    beam = bar(0.04)
    at = both(beam, 2.0)
    numbers = [at.number("T at Omega = 2, g = .04")]
    if at.stable:
        ends = [boundary(beam, far, 2.0) for far in (1.9625, 2.0375)]
        numbers += [ends[0].number("stable from"), ends[1].number("stable to")]
    other = sine_alone(beam, 2.0)
    numbers.append(other.number("T at Omega = 2, the part out of phase alone", 4))
    whole = whole_force(beam, 2.0)
    numbers.append(whole.number("T at Omega = 2, the whole force", 4))
    verdict = graded(at.stable and other.stable, at.stable)
    because = (
        f"True of the report's equation; {OUT_OF_PHASE}, is largest there, alone makes T = "
        f"{other.hill:.2f}, and T with the whole force is {whole.hill:.4f}: the gap is none."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("above-gap")
def above_gap() -> Finding:
    """The region above Omega = 2 with g = .08."""
    Omegas = np.arange(2.0, 2.13, STRIDE)
    less, more = severest(bar(0.04), Omegas), severest(bar(0.08), Omegas)
    other = sine_alone(bar(0.08), 2.05)
    numbers = (
        less.number("largest T, Omega = 2 to 2.12, g = .04"),
        more.number("largest T, Omega = 2 to 2.12, g = .08"),
        other.number("T at Omega = 2.05, g = .08, the part out of phase alone", 4),
        whole_force(bar(0.08), 2.05).number("T at Omega = 2.05, g = .08, the whole force", 4),
    )
    gone = more.stable and not less.stable
    verdict = graded(gone and other.stable, gone)
    because = (
        f"True of the report's equation; {OUT_OF_PHASE}, alone keeps T = {other.hill:.2f} at 2.05."
    )
    return Finding(numbers, verdict, because)


@check_for("broad")
def broad() -> Finding:
    """Width of the region at 2 omega_(1) with omega_L = 2."""
    low, high = _lower(0.0), _upper(0.0)

    def rigid(route: RouteName) -> float:
        return 2.0 * _rigid().by(route).radius

    numbers = (
        low.number("from"),
        high.number("to"),
        by_both("width with omega_L infinite", rigid, 4),
        by_both("ratio", lambda route: _width(low, high, route) / rigid(route), 0),
    )
    ratio = numbers[-1].hill
    verdict = graded(ratio >= BROAD, ratio > 1.0 + VISIBLE)
    return Finding(numbers, verdict, f"It is {ratio:.0f} times as wide as the rigid bar's.")


@check_for("at-four")
def at_four() -> Finding:
    """Instability about Omega = 4, twice omega_L, where the rigid bar has none."""
    points = (3.98, 4.02)
    with_L = [both(bar(0.0), Omega) for Omega in points]
    without = [both(uniform(), Omega) for Omega in points]
    ends = [edge(bar(0.0), start, way) for start, way in ((3.98, -0.01), (4.02, 0.01))]
    nearest = min(abs(Omega - 4.0) for Omega in resonances(uniform()).values())
    numbers = (
        *(T.number(f"T at Omega = {x:g}") for x, T in zip(points, with_L, strict=True)),
        *(T.number(f"the same, rigid, {x:g}") for x, T in zip(points, without, strict=True)),
        ends[0].number("from"),
        ends[1].number("to"),
        Number("distance to the nearest first-order resonance", nearest, None, 2),
    )
    new = all(not T.stable for T in with_L) and all(T.stable for T in without)
    verdict = graded(new and nearest > _width(ends[0], ends[1], "hill"), new)
    because = (
        "Unstable on both sides of 4 = 2 omega_L, where the force is infinite and no first-order "
        "resonance is near."
    )
    return Finding(numbers, verdict, because)


@check_for("at-four-damped")
def at_four_damped() -> Finding:
    """The same with longitudinal damping."""
    Omegas = np.concatenate([np.arange(3.95, 4.06, 0.01), [4.0]])
    some, more = severest(bar(0.04), Omegas), severest(bar(0.08), Omegas)
    other = sine_alone(bar(0.08), 4.0)
    numbers = (
        some.number("largest T, Omega = 3.95 to 4.05, g = .04"),
        more.number("largest T, Omega = 3.95 to 4.05, g = .08"),
        other.number("T at Omega = 4, g = .08, the part out of phase alone", 4),
        whole_force(bar(0.08), 4.0).number("T at Omega = 4, g = .08, the whole force", 4),
    )
    verdict = graded(more.stable and other.stable, more.stable)
    because = (
        f"True of the report's equation with g = .08, not with .04; {OUT_OF_PHASE}, alone keeps "
        f"T = {other.hill:.2f} at 4."
    )
    return Finding(numbers, verdict, because)


@check_for("damping-far")
def damping_far() -> Finding:
    """T_x at the other resonances with omega_L = 2, g = 0 and .08."""
    numbers, changes = [], []
    for r in regions(uniform()):
        if r.name == "2 omega_(1)":
            continue
        free, damped = (both(bar(g), r.Omega) for g in (0.0, 0.08))
        if free.stable:
            continue
        changes.append(abs(damped.hill / free.hill - 1.0))
        numbers.append(free.number(f"{r.name}: T_x, g = 0"))
        numbers.append(damped.number(f"{r.name}: T_x, g = .08"))
    verdict = graded(max(changes) <= VISIBLE, float(np.median(changes)) <= VISIBLE)
    because = f"With g = .08 these T_x change by {share(max(changes))} at most."
    return Finding(tuple(numbers), verdict, because)


@check_for("narrowed")
def narrowed() -> Finding:
    """Width and severity of the region at 2 omega_(1) by g."""
    low = {g: _lower(g) for g in (0.0, 0.04, 0.08)}
    high = {g: _upper(g) for g in (0.0, 0.04, 0.08)}
    width = {g: _width(low[g], high[g], "hill") for g in low}
    other = sine_alone(bar(0.08), 2.0)
    top = {g: severest(bar(g), np.arange(1.7375, 2.1, 0.0125)) for g in (0.04, 0.08)}
    numbers = (
        *(x.number(f"from, g = {g:g}") for g, x in low.items()),
        *(x.number(f"to, g = {g:g}") for g, x in high.items()),
        *(T.number(f"largest T, g = {g:g}") for g, T in top.items()),
        other.number("T at Omega = 2, g = .08, the part out of phase alone", 4),
        whole_force(bar(0.08), 2.0).number("T at Omega = 2, g = .08, the whole force", 4),
    )
    narrower = {g: 1.0 - width[g] / width[0.0] for g in (0.04, 0.08)}
    severe = min(T.hill for T in top.values()) > 10.0 * ETA
    verdict = graded(severe and max(narrower.values()) <= SLIGHTLY, severe)
    because = (
        f"T falls from no limit to {top[0.04].hill:.2f} and {top[0.08].hill:.2f}, still more than "
        f"ten times eta; but with g = .08 the region loses {share(narrower[0.08])} of its width in "
        "the report's equation, and in the lost part, at 2, the part of the force out of phase "
        f"alone makes T = {other.hill:.2f}."
    )
    return Finding(numbers, verdict, because)


@check_for("infinite-amplitude")
def infinite_amplitude() -> Finding:
    """Largest T with g = .04."""
    T = severest(bar(0.04), np.arange(1.7375, 2.1, 0.0125))
    near, other = both(bar(0.0), 1.99), sine_alone(bar(0.04), 2.0)
    whole = whole_force(bar(0.04), 2.0)
    numbers = (
        near.number("T at Omega = 1.99, g = 0"),
        T.number("largest T, Omega = 1.74 to 2.1, g = .04"),
        other.number("T at Omega = 2, g = .04, the part out of phase alone", 4),
        whole.number("T at Omega = 2, g = .04, the whole force", 4),
    )
    finite = max(T.hill, other.hill, whole.hill)
    verdict = graded(finite > near.hill, finite > 10.0)
    because = f'T stays below {finite:.2f} with g = .04: "finite" is meant, as the next lines show.'
    return Finding(numbers, verdict, because)
