"""Where there are instabilities, of first and of higher order (sections 7.3 and 8.1.1)."""

import numpy as np

from compare.report.claims.both_routes import severest
from compare.report.claims.cases import beams, every_region, regions, resonances
from compare.report.claims.finding import Finding, Number, check_for, graded
from compare.report.one_route import Beam

# Where the second-order region is looked for: nothing of T above .001 escapes these steps.
SEARCH = np.linspace(-0.006, 0.006, 13)


@check_for("second-order")
def second_order() -> Finding:
    """Largest T near half of every first-order resonance that is unstable."""
    numbers, worse = [], []
    for kind, beam in beams():
        for r in regions(beam):
            # the region is about as wide as its T is large, and moves with gamma^2 like the first
            T = severest(beam, 0.5 * r.Omega + SEARCH)
            numbers.append(T.number(f"{kind}, half of {r.name}: largest T"))
            numbers.append(r.at_resonance.number(f"{kind}, {r.name}: T_x"))
            if T.hill > r.hill.T_x:
                worse.append(f"{r.name} of the {kind} beam")
    count = len(numbers) // 2
    verdict = graded(not worse, 2 * len(worse) < count)
    because = f"It holds in {count - len(worse)} of {count}" + (
        f"; the exception is {', '.join(worse)}." if worse else "."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("where")
def where() -> Finding:
    """Which first-order resonances are unstable, and whether anything is elsewhere."""
    numbers: list[Number] = []
    quiet: dict[str, int] = {}
    largest = 0.0
    for kind, beam in beams():
        found = regions(beam)
        dead = [name for name in resonances(beam) if name not in {r.name for r in found}]
        quiet |= {name: quiet.get(name, 0) + 1 for name in dead}
        label = f"{kind}: first-order resonances unstable, of 9"
        numbers.append(Number(label, len(found), len(found), 0))
        T = severest(beam, _elsewhere(beam))
        largest = max(largest, T.hill)
        numbers.append(T.number(f"{kind}: largest T outside the first-order regions"))
    first = [r.hill.T_x for _, r in every_region()]
    verdict = graded(not quiet and largest <= min(first), largest <= max(first))
    names = ", ".join(name for name, count in quiet.items() if count == len(beams()))
    because = (
        f"Not near every one: {names} are stable on both beams even without damping; and weak "
        f"regions of higher order lie elsewhere, with T up to {largest:.4f} at the points tried."
    )
    return Finding(tuple(numbers), verdict, because)


def _elsewhere(beam: Beam) -> np.ndarray:
    """Halves and thirds of the first-order resonances, and a coarse scan, outside the regions."""
    points = [Omega / k for Omega in resonances(beam).values() for k in (2, 3)]
    points += [float(x) for x in np.arange(0.3, 6.0, 0.15)]
    found = regions(beam)
    return np.array(
        [x for x in points if x > 0.25 and not any(r.hill.low <= x <= r.hill.high for r in found)]
    )
