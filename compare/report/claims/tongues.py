"""Shape, width and place of the regions of instability (sections 7.3 and 8.1.2)."""

from functools import partial

import numpy as np

from compare.report.claims.both_routes import both, by_both, real_frequencies
from compare.report.claims.cases import Region, beams, every_region, regions, uniform
from compare.report.claims.finding import VISIBLE, Finding, Number, check_for, graded, share
from compare.report.one_route import RouteName
from compare.report.tables import GAMMA, rows
from hill import characteristic

# Thrust ratios over which boundaries and widths are called linear; tables and examples have .1.
RATIOS = (0.025, 0.1)


@check_for("half-circles")
def half_circles() -> Finding:
    """T against Omega, held against the half circle between the boundaries."""
    found = every_region()
    numbers = []
    for kind, r in found:
        label = f"{kind}, {r.name}: T off a half circle, in radii"
        numbers.append(by_both(label, r.departure, 3))
        label = f"{kind}, {r.name}: its centre off, in radii"
        numbers.append(by_both(label, partial(_offset, r), 2))
    shape = max(r.departure("hill") for _, r in found)
    off = [abs(r.hill.offset) for _, r in found]
    verdict = graded(shape <= VISIBLE and max(off) <= VISIBLE, shape <= VISIBLE)
    because = (
        f"All {len(found)} regions are half circles to {share(shape)} of their radius, as "
        "averaging says (T^2 + (Omega - Omega_0)^2 = T_x^2); "
        f"{sum(o > VISIBLE for o in off)} of them have their centre off the resonance, by up to "
        f"{share(max(off))} of it."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("exception-at-2B")
def exception() -> Finding:
    """The region of 2 omega_(B) in Table 1, converged and cut off."""
    beam = uniform()
    region = next(r for r in regions(beam) if r.name == "2 omega_(B)")
    omega_B, omega_1, _ = real_frequencies(beam)
    own = region.hill
    inner = (2.0 * omega_1 / 5.0, (omega_B + omega_1) / 3.0)
    printed = [row.Omega for row in rows(1) if row.Omega < own.high]
    points = np.concatenate([np.linspace(own.low, own.high, 21)[1:-1], inner, printed])
    outside, T_cut, off_cut, outside_cut = 0, [], [], 0
    for Omega in points:
        outside = max(outside, _outside(both(beam, float(Omega)).z))
        cut = characteristic(beam.equation(float(Omega), GAMMA), truncation="report")
        outside_cut = max(outside_cut, _outside(cut.z))
        T_cut.append(cut.T)
        off_cut.append(abs(np.hypot(cut.T, Omega - own.centre) / own.radius - 1.0))
    numbers = (
        by_both("T off a half circle, in radii", region.departure, 3),
        Number("the same, the report's truncation", max(off_cut), None, 1),
        Number("largest T", region.peak.hill, region.peak.floquet, 5),
        Number("the same, the report's truncation", max(T_cut), None, 4),
        Number("most z off [-1, 1] at once", outside, None, 0),
        Number("the same, the report's truncation", outside_cut, None, 0),
        Number("2 omega_(1)/5, inside the region", inner[0], None, 4),
        Number("(omega_(B) + omega_(1))/3, inside it too", inner[1], None, 4),
        both(beam, 0.3975).number("T at .3975, printed .02834 at .398"),
    )
    clean = region.departure("hill") <= VISIBLE and outside <= 1
    artefact = max(off_cut) > VISIBLE
    verdict = graded(outside > 1, not (clean and artefact))
    because = (
        "Converged, T is one half circle and one z alone leaves [-1, 1], at the higher-order "
        "resonances inside too; the printed irregularity is the determinant cut off at 14 "
        "harmonics or fewer."
    )
    return Finding(numbers, verdict, because)


def _outside(z: np.ndarray) -> int:
    """How many z are off [-1, 1]."""
    return int(np.sum((np.abs(z.imag) > 1e-7) | (np.abs(z.real) > 1.0 + 1e-7)))


@check_for("boundary-rule")
def boundary_rule() -> Finding:
    """Boundaries against resonance +- T_x, Eq. (7.3.1)."""
    numbers, misses = [], []
    for kind, r in every_region():
        miss = by_both(f"{kind}, {r.name}: miss over T_x", partial(_miss, r), 3)
        numbers.append(miss)
        misses.append(miss.hill)
    near = sum(miss <= VISIBLE for miss in misses)
    verdict = graded(near == len(misses), 2 * near >= len(misses))
    because = (
        f"Good to {share(VISIBLE)} of T_x in {near} of {len(misses)} regions; in the others the "
        f"centre is off the resonance and the rule misses by up to {share(max(misses))}."
    )
    return Finding(tuple(numbers), verdict, because)


def _offset(region: Region, route: RouteName) -> float:
    return region.by(route).offset


def _miss(region: Region, route: RouteName) -> float:
    """The larger miss of the two boundaries, over T_x."""
    r = region.by(route)
    ends = (r.low - (r.Omega - r.T_x), r.high - (r.Omega + r.T_x))
    return max(abs(end) for end in ends) / r.T_x


@check_for("linear-boundaries")
def linear_boundaries() -> Finding:
    """(Omega_b - Omega_0)/gamma, which would be constant."""
    numbers, bends = [], []
    for kind, name, series in _by_ratio():
        label = f"{kind}, {name}: change of slope"
        bend = by_both(label, partial(_change_of_slope, series), 3)
        numbers.append(bend)
        bends.append(bend.hill)
    straight = sum(bend <= VISIBLE for bend in bends)
    verdict = graded(straight == len(bends), 2 * straight >= len(bends))
    because = (
        f"Straight to {share(VISIBLE)} from gamma = .025 to .1 in {straight} of {len(bends)} "
        f"regions; the centre of the others moves like gamma^2, which changes the slope by up to "
        f"{share(max(bends))}."
    )
    return Finding(tuple(numbers), verdict, because)


def _change_of_slope(series: list[Region], route: RouteName) -> float:
    extents = [r.by(route) for r in series]
    slopes = np.array([[r.low - r.Omega, r.high - r.Omega] for r in extents])
    slopes /= np.array(RATIOS)[:, None]
    return float(np.max(np.ptp(slopes, axis=0) / np.abs(slopes).min(axis=0)))


@check_for("linear-width")
def linear_width() -> Finding:
    """Width over gamma, which would be constant."""
    numbers, bends = [], []
    for kind, name, series in _by_ratio():
        label = f"{kind}, {name}: change of width/gamma"
        bend = by_both(label, partial(_change_of_width, series), 3)
        numbers.append(bend)
        bends.append(bend.hill)
    worst = max(bends)
    verdict = graded(worst <= VISIBLE, float(np.median(bends)) <= VISIBLE)
    because = f"From gamma = .025 to .1 width/gamma changes by {share(worst)} at most."
    return Finding(tuple(numbers), verdict, because)


def _change_of_width(series: list[Region], route: RouteName) -> float:
    widths = np.array([2.0 * r.by(route).radius for r in series]) / np.array(RATIOS)
    return float(np.ptp(widths) / widths.min())


def _by_ratio() -> list[tuple[str, str, list[Region]]]:
    found = []
    for kind, beam in beams():
        by_ratio = [{r.name: r for r in regions(beam, gamma)} for gamma in RATIOS]
        common = [name for name in by_ratio[0] if all(name in table for table in by_ratio)]
        found += [(kind, name, [table[name] for table in by_ratio]) for name in common]
    return found


@check_for("largest-at-resonance")
def largest_at_resonance() -> Finding:
    """T_x against the largest T of its region."""
    numbers, excess = [], []
    for kind, r in every_region():
        excess.append(r.peak.hill / r.hill.T_x - 1.0)
        numbers.append(r.peak.number(f"{kind}, {r.name}: largest T"))
        numbers.append(r.at_resonance.number(f"{kind}, {r.name}: T_x"))
    verdict = graded(max(excess) <= VISIBLE, float(np.median(excess)) <= VISIBLE)
    because = (
        f"The largest T exceeds T_x by {share(max(excess))} at most, because the top of a circle "
        "is flat even where its centre is off."
    )
    return Finding(tuple(numbers), verdict, because)
