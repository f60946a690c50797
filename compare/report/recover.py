"""Recovers the forcing frequencies the tables were run at.

``python -m compare.report.recover`` writes ``data/recovered.toml``. Omega is printed to three
decimals, but the program ran at full precision, and z moves by up to 300 times as much as Omega.
Candidates are the places the program itself goes to (a resonance, the steps of SWITCH), then round
numbers (a round distance from a resonance, or as printed), then SWITCH with its step from T as
printed. The first whose z, as run, comes back to `Z_AS_RUN` is taken; where none does, a row
labelled as a resonance is left there and any other gets the best fit within the rounding interval.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from compare.report.match import distance
from compare.report.program.deck import constants
from compare.report.program.driver import places
from compare.report.program.listing import Case, Stepped, Uniform, frequencies, stab, switch
from compare.report.tables import DATA, TABLES, Row, corrected, rows

# Five printed decimals, from 27-bit arithmetic. Over the rows of Tables 1 and 2, as run at their
# recovered Omega, the distance has a median of 4e-6 and a largest value of 2.9e-5 but for the two
# rows listed as open (2.8e-3 and 3.5e-4); this module prints it.
Z_AS_RUN = 4e-5

# Times 1/Omega, as T is Omega times a logarithm of what 2 pi sqrt(F)/Omega is carried to: how far T
# as run misses print. Largest 3.4e-5 (T2-03), then 2.1e-5; the open rows are at 8e-5 and more.
T_AS_RUN = 4e-5
HALF_UNIT = 0.0005
HALF_UNIT_T = 0.000005
ROUND = 0.001
NAMES = ("omega_(B)", "omega_(1)", "omega_(2)")

Program = Uniform | Stepped


def resonances(deck: Program, case: Case) -> dict[str, float]:
    """2 omega_i, omega_i + omega_j and omega_j - omega_i in the order of DRIVER."""
    found = {}
    for sign, high, low, Omega in places(tuple(frequencies(deck, case))):
        last = NAMES[high - 1]
        found[f"2 {last}" if sign == "2" else f"{last} {sign} {NAMES[low - 1]}"] = Omega
    return found


def candidates(deck: Program, case: Case, near: float) -> Iterator[tuple[float, str]]:
    """Frequencies the program, or whoever filled in its cards, would choose, within rounding."""
    around = {name: f for name, f in resonances(deck, case).items() if abs(f - near) < 0.25 * near}
    for name, f in around.items():
        yield f, f"resonance {name}"
    for name, f in around.items():
        for step in switch(deck, case, f)[1:]:
            yield step.OMEGB, f"SWITCH around {name}"
    for name, f in around.items():
        offset = ROUND * round((near - f) / ROUND)
        yield f + offset, f"{name} {offset:+.3f}"
    yield near, "as printed"


def recover(row: Row) -> tuple[float, str, float]:
    """Omega as run, how it was found, and how far z as run is from z as printed."""
    deck, case = constants(row.run["beam"]), row.case
    near = float(row.Omega_printed)

    def miss(Omega: float) -> float:
        return distance(stab(deck, case, Omega).roots, row.z)

    tried = [
        (Omega, source, miss(Omega))
        for Omega, source in candidates(deck, case, near)
        if abs(Omega - near) <= HALF_UNIT * (1 + 1e-9)
    ]
    for found in tried:
        if found[2] <= Z_AS_RUN:
            return found
    # SWITCH's step is 1.2 T, and the 7094's T is known from print to half a unit; its furthest
    # stations are 1.5 steps out
    reach = 1.5 * 1.2 * HALF_UNIT_T
    for Omega, source in printed_steps(row, deck, case):
        if abs(Omega - near) <= HALF_UNIT:
            at, least = _fit(miss, Omega - reach, Omega + reach)
            if least <= Z_AS_RUN:
                return at, source, least
    if tried and tried[0][1].startswith("resonance") and row.resonance:
        return tried[0]
    at, least = _fit(miss, near - HALF_UNIT, near + HALF_UNIT)
    return at, "fit within the rounding interval", least


def printed_steps(row: Row, deck: Program, case: Case) -> Iterator[tuple[float, str]]:
    """SWITCH's stations with the step from T as printed at the resonance."""
    names = resonances(deck, case)
    for other in rows(row.table, recovered=False):
        for name, f in names.items():
            at_resonance = abs(f - float(other.Omega_printed)) <= HALF_UNIT and other.resonance
            if at_resonance and abs(f - float(row.Omega_printed)) < 2.0 * 1.2 * other.T:
                for step in switch(deck, case, f, first_T=other.T)[1:]:
                    yield step.OMEGB, f"SWITCH around {name}, from T as printed"


def _fit(miss: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    grid = np.linspace(low, high, 101)
    best = int(np.argmin([miss(Omega) for Omega in grid]))
    bounds = (grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)])
    fit = minimize_scalar(miss, bounds=bounds, method="bounded", options={"xatol": 1e-9})
    return float(fit.x), float(fit.fun)


def main() -> None:
    """Recover every row of Tables 1 and 2; Table 3 stands at the resonances themselves."""
    text = "# Written by python -m compare.report.recover: Omega as run, by printed row.\n"
    misses = []
    for table in TABLES:
        for row in rows(table, recovered=False):
            if table == 3:
                if row.initial_conditions:
                    continue
                name, rigid = row.id[:-1], replace(row.case, OMEGL=100.0)
                at = resonances(constants("uniform"), rigid)
                label, Omega = min(
                    at.items(), key=lambda item: abs(item[1] - float(row.Omega_printed))
                )
                source = f"resonance {label}"
            else:
                name, (Omega, source, miss) = row.id, recover(corrected(row))
                misses.append(miss)
                print(f"{row.id}  {row.Omega_printed:>6}  {Omega:.7f}  {miss:.1e}  {source}")
            text += f'\n[{name}]\nOmega = {Omega:.9f}\nfrom = "{source}"\n'
    with open(str(DATA / "recovered.toml"), "w", encoding="utf-8") as file:
        file.write(text)
    ordered = sorted(misses)
    print(f"median {ordered[len(ordered) // 2]:.1e}, largest four {ordered[-4:]}")


if __name__ == "__main__":
    main()
