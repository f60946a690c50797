"""The finite determinant (sections 6.2 and B-4) over the rows of Tables 1 and 2."""

from dataclasses import dataclass
from functools import lru_cache

from compare.report.claims.both_routes import both
from compare.report.claims.finding import PRINTED, Finding, Number, check_for, graded
from compare.report.match import distance
from compare.report.tables import GAMMA, rows
from hill import characteristic

# What the program calls unstable (STAB).
UNSTABLE = 1e-7
# Half a unit of the last printed digit of z.
PRINTED_Z = 5e-6


@dataclass(frozen=True)
class _Miss:
    Omega: float
    T: tuple[float, float]
    z: float
    flips: bool


@lru_cache(maxsize=1)
def _misses() -> tuple[_Miss, ...]:
    """Truncated as in the report against converged, row by row."""
    found = []
    for row in (*rows(1), *rows(2)):
        beam = row.beam(2)
        cut = characteristic(beam.equation(row.Omega, GAMMA), truncation="report")
        full = both(beam, row.Omega, GAMMA)
        T = cut.T if cut.T > UNSTABLE else 0.0
        found.append(
            _Miss(
                row.Omega,
                (abs(T - full.hill), abs(T - full.floquet)),
                distance(cut.z, full.z),
                (T > 0.0) == full.stable,
            )
        )
    return tuple(found)


@check_for("sufficient")
def sufficient() -> Finding:
    """Digits and verdicts lost to the report's M."""
    misses = _misses()
    flips = sum(m.flips for m in misses)
    lost = sum(m.T[0] > PRINTED for m in misses)
    worst = max(misses, key=lambda m: m.T[0])
    numbers = (
        Number("rows of Tables 1 and 2", len(misses), None, 0),
        Number("rows whose T misses a printed digit", lost, None, 0),
        Number("rows whose z misses a printed digit", _count_z(misses), None, 0),
        Number("largest miss of T", *worst.T, 5),
        Number("largest miss of z", max(m.z for m in misses), None, 3),
        Number("verdicts on stability that flip", flips, None, 0),
    )
    verdict = graded(lost == 0 and flips == 0, flips == 0)
    because = (
        f"It loses printed digits of T in {lost} of {len(misses)} rows and the verdict in {flips}: "
        "the neglected harmonics add up like M^-3, however small each is."
    )
    return Finding(numbers, verdict, because)


def _count_z(misses: tuple[_Miss, ...]) -> int:
    return sum(m.z > PRINTED_Z for m in misses)


@check_for("small-frequencies")
def small_frequencies() -> Finding:
    """The same below and above Omega = 1."""
    below = [m for m in _misses() if m.Omega < 1.0]
    above = [m for m in _misses() if m.Omega >= 1.0]
    numbers = []
    for name, part in (("below", below), ("above", above)):
        worst = max(part, key=lambda m: m.T[0])
        numbers += [
            Number(f"rows {name} Omega = 1", len(part), None, 0),
            Number(f"largest miss of T {name}", *worst.T, 5),
            Number(f"largest miss of z {name}", max(m.z for m in part), None, 4),
            Number(f"verdicts that flip {name}", sum(m.flips for m in part), None, 0),
        ]
    wrong_below = any(m.T[0] > PRINTED or m.flips for m in below)
    wrong_above = any(m.T[0] > PRINTED or m.flips for m in above)
    verdict = graded(wrong_below and not wrong_above, wrong_below)
    because = (
        f"It is in error there, T by up to {max(m.T[0] for m in below):.3f}; but above 1 too, T by "
        f"up to {max(m.T[0] for m in above):.4f}, with {sum(m.flips for m in above)} verdicts lost."
    )
    return Finding(tuple(numbers), verdict, because)
