"""What transverse damping does (sections 7.3.1 and 8.3, abstract)."""

from functools import partial

import numpy as np
from scipy.optimize import brentq

from compare.report.claims.both_routes import both, by_both
from compare.report.claims.cases import Region, beams, regions, resonances, uniform
from compare.report.claims.finding import (
    PRINTED,
    VISIBLE,
    Finding,
    Number,
    check_for,
    graded,
    share,
)
from compare.report.one_route import RouteName
from compare.report.tables import ETA, GAMMA, rows

# A region is "larger" where damping of .01 leaves more than half of its T_x.
LARGER = 2.0


@check_for("shift")
def shift() -> Finding:
    """T(0) - T(eta) - eta, at the unstable rows of Tables 1 and 2 and at their resonances."""
    at_rows, at_tops = [], []
    for table in (1, 2):
        for row in rows(table):
            beam = row.beam(2)
            free, damped = (both(beam, row.Omega, GAMMA, eta) for eta in (0.0, ETA))
            if not free.stable:
                miss = (
                    damped.hill + ETA - free.hill,
                    damped.floquet + ETA - free.floquet,
                )
                at_rows.append((row, miss))
                if row.resonance:
                    at_tops.append((row, miss))
    worst_row, worst = max(at_rows, key=lambda pair: abs(pair[1][0]))
    top_row, top = max(at_tops, key=lambda pair: abs(pair[1][0]))
    numbers = (
        Number(f"largest miss, at {worst_row.id}", *worst, 6),
        Number(f"largest miss at a resonance, {top_row.id}", *top, 6),
        Number("rows compared", len(at_rows), None, 0),
        Number(
            "rows that miss by a printed digit",
            sum(abs(miss[0]) > PRINTED for _, miss in at_rows),
            None,
            0,
        ),
    )
    verdict = graded(abs(worst[0]) <= PRINTED, abs(worst[0]) <= VISIBLE * ETA)
    because = (
        f"To {share(abs(worst[0]) / ETA)} of eta, not exactly: eta^2/4 also lowers the natural "
        "frequencies, which moves the region and shows near its ends."
    )
    return Finding(numbers, verdict, because)


@check_for("larger-boundaries")
def larger_boundaries() -> Finding:
    """How much a damping of .01 narrows the regions it leaves."""
    numbers, moves = [], []
    for kind, beam in beams():
        left = {r.name: r for r in regions(beam, GAMMA, ETA)}
        for r in regions(beam):
            if r.hill.T_x >= LARGER * ETA:
                numbers.append(
                    by_both(f"{kind}, {r.name}: narrower by", partial(_lost, r, left), 3)
                )
                moves.append(numbers[-1].hill)
    small = sum(move <= VISIBLE for move in moves)
    verdict = graded(small == len(moves), small > 0)
    because = (
        f"Of {len(moves)} regions with T_x above twice eta, {small} narrow by less than "
        f"{share(VISIBLE)}; the others by up to {share(max(moves))}, as sqrt(T_x^2 - eta^2) says."
    )
    return Finding(tuple(numbers), verdict, because)


def _lost(r: Region, damped: dict[str, Region], route: RouteName) -> float:
    """The share of its radius that damping takes from a region."""
    return 1.0 - damped[r.name].by(route).radius / r.by(route).radius


@check_for("decay")
def decay() -> Finding:
    """T where nothing is unstable, with damping and without."""
    numbers, kept, neutral = [], [], []
    for kind, beam in beams():
        for Omega in (0.7, 2.1, 3.3, 4.3):
            damped, free = both(beam, Omega, GAMMA, ETA), both(beam, Omega)
            kept.append(damped.hill)
            neutral.append(free)
            numbers.append(damped.number(f"{kind}, T at Omega = {Omega:g}, eta = .01"))
    largest = max(neutral, key=lambda T: T.hill)
    numbers.append(largest.number("largest T at these, eta = 0"))
    verdict = graded(all(abs(T / -ETA - 1.0) <= VISIBLE for T in kept), all(T < 0.0 for T in kept))
    because = (
        "T is -eta there, so that vibrations die out like exp(-eta tau/2); without damping they "
        "go on unchanged."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("weak-regions")
def weak_regions() -> Finding:
    """Regions with T_x below eta, damped."""
    numbers, gone = [], []
    for kind, beam in beams():
        for r in regions(beam):
            if r.peak.hill >= ETA:
                continue
            span = np.linspace(r.hill.low, r.hill.high, 7)
            T = max((both(beam, float(x), GAMMA, ETA) for x in span), key=lambda p: p.hill)
            gone.append(T.stable)
            numbers.append(r.at_resonance.number(f"{kind}, {r.name}: T_x, eta = 0"))
            numbers.append(T.number(f"{kind}, {r.name}: largest T, eta = .01"))
    verdict = graded(bool(gone) and all(gone), any(gone))
    because = f"{len(gone)} regions of Tables 1 and 2 have T below .01 throughout and disappear."
    return Finding(tuple(numbers), verdict, because)


@check_for("small-thrust")
def small_thrust() -> Finding:
    """T at T0 = .001 without damping; the thrust at which T_x = eta with it."""
    tiny = uniform(T0=0.001)
    free = both(tiny, resonances(tiny)["2 omega_(2)"])
    numbers = [Number("10^3 T at 2 omega_(2), T0 = .001", 1e3 * free.hill, 1e3 * free.floquet, 5)]
    critical = {}
    for name in ("2 omega_(B)", "omega_(1) + omega_(B)", "omega_(2) + omega_(B)", "2 omega_(2)"):
        critical[name] = _critical(name)
        numbers.append(Number(f"T0 where T_x = .01, {name}", critical[name], None, 2))
    least = min(critical.values())
    below = uniform(T0=0.9 * least)
    damped = [both(below, Omega, GAMMA, ETA) for Omega in resonances(below).values()]
    worst = max(damped, key=lambda T: T.hill)
    numbers.append(worst.number("largest T at the nine resonances, T0 10 % below the least"))
    verdict = graded(not free.stable and worst.stable, not free.stable or worst.stable)
    because = (
        "Undamped, T_x goes to zero with the thrust and never gets there; with eta = .01 no "
        f"first-order region is left below T0 = {least:.1f} (gamma = .1)."
    )
    return Finding(tuple(numbers), verdict, because)


def _critical(name: str) -> float:
    """T0 at which T at a resonance equals eta, as in Figures 11 to 14."""

    def excess(T0: float) -> float:
        beam = uniform(T0=T0)
        return both(beam, resonances(beam)[name]).hill - ETA

    return float(brentq(excess, 2.0, 20.0, xtol=1e-4))
