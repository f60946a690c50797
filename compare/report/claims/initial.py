"""Zero initial conditions (sections 7.3.3 and 8.5, Table 3), with the amplitudes C_s."""

from functools import lru_cache

from compare.report.claims.both_routes import Both, both
from compare.report.claims.cases import resonances, uniform
from compare.report.claims.finding import VISIBLE, Finding, Number, check_for, graded
from compare.report.tables import GAMMA

TERMS = 5
"""As many as the listing's S; with 12 no verdict of Table 3 is another (see the tests)."""
PRINTED_STABLE = ("2 omega_(B)", "omega_(2) - omega_(1)")
"""Unstable without and stable with initial conditions, as printed."""
ABOVE = (0.01, 0.02, 0.03, 0.04, 0.05)
"""How far above its resonance a region that has moved is looked for."""
AROUND = tuple(0.02 * k for k in range(-5, 6))
"""How far about a resonance any instability is looked for."""


def _point(Omega: float, terms: int) -> Both:
    """T with omega_L = 2 Omega, as in Table 3."""
    return both(uniform(omega_L=2.0 * Omega), Omega, GAMMA, 0.0, terms)


@lru_cache(maxsize=1)
def _table() -> dict[str, tuple[Both, Both]]:
    """By resonance: without and with."""
    found = resonances(uniform())
    return {name: (_point(found[name], 0), _point(found[name], TERMS)) for name in found}


def _near(name: str, steps: tuple[float, ...]) -> Both:
    """The largest T so far from a resonance, with initial conditions."""
    Omega = resonances(uniform())[name]
    return max((_point(Omega + step, TERMS) for step in steps), key=lambda T: T.hill)


def _changed(less: bool) -> list[str]:
    """Resonances stable without and unstable with (less), or the other way round."""
    pairs = {name: (before.stable, after.stable) for name, (before, after) in _table().items()}
    return [name for name, pair in pairs.items() if pair == (less, not less)]


@check_for("table-3")
def table_3() -> Finding:
    """Table 3 with C_s = s pi A_s."""
    numbers, ratios = [], []
    for name, (before, after) in _table().items():
        if before.stable and after.stable:
            continue
        numbers.append(before.number(f"{name}: T without"))
        numbers.append(after.number(f"{name}: T with"))
        ratios.append(abs(after.hill / before.hill - 1.0) if not before.stable else 1.0)
    flips = len(_changed(True)) + len(_changed(False))
    strongest = resonances(uniform())["2 omega_(B)"]
    numbers.append(_point(strongest, 12).number("2 omega_(B): T with, 12 terms for 5"))
    numbers.append(Number("verdicts that change, of 9", flips, flips, 0))
    verdict = graded(not flips and max(ratios) <= VISIBLE, not flips)
    because = (
        f"The column was made with A_s, smaller by s pi; with C_s {flips} of 9 verdicts change, "
        f"and at 2 omega_(B) T is {_table()['2 omega_(B)'][1].hill:.2f}."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("stabilise")
def stabilise() -> Finding:
    """Resonances that initial conditions stabilise, and where their regions have gone."""
    calmed = _changed(False)
    numbers, moved = [], []
    for name in calmed:
        T = _near(name, ABOVE)
        numbers.append(_table()[name][0].number(f"{name}: T without"))
        numbers.append(_table()[name][1].number(f"{name}: T with"))
        numbers.append(T.number(f"{name}: largest T with, up to .05 above it"))
        moved += [] if T.stable else [name]
    printed = len(set(calmed) & set(PRINTED_STABLE))
    verdict = graded(len(calmed) >= 2 and not moved, len(calmed) >= 2)
    because = (
        f"{len(calmed)} resonances become stable, {printed} of the two printed among them; but "
        f"the regions of {len(moved)} of them have only moved up by a few hundredths, about as "
        "strong as before."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("neglected")
def neglected() -> Finding:
    """Whether leaving initial conditions out is safe."""
    numbers, growth = [], []
    for name in ("2 omega_(B)", "omega_(1) + omega_(B)", "2 omega_(1)", "2 omega_(2)"):
        before, T = _table()[name][0], _near(name, AROUND)
        growth.append(T.hill / before.hill - 1.0)
        numbers.append(before.number(f"{name}: T without, at it", 4))
        numbers.append(T.number(f"{name}: largest T with, within .1 of it", 4))
    flips = len(_changed(True)) + len(_changed(False))
    numbers.append(Number("verdicts that change at the resonances, of 9", flips, flips, 0))
    safe = max(growth) <= VISIBLE
    verdict = graded(safe and not flips, safe)
    because = (
        "While the free vibration lasts it makes T up to "
        f"{1.0 + max(growth):.0f} times as large near these resonances; the investigation does not "
        "substantiate it. That longitudinal damping ends the vibration is a better reason."
    )
    return Finding(tuple(numbers), verdict, because)
