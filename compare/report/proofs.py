"""Rows proven: at the Omega they were run at, and for every Omega that is printed so."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from compare.proofs import Proof, prove
from compare.publications.kincaid import check
from compare.report.row import TERMS
from compare.report.tables import Row, corrected
from floquet import enclose_interval
from floquet.enclosure.result import IntervalProof
from hill.stability import Verdict

HALF_UNIT = Fraction(1, 2000)
"""Omega is printed to three decimals."""

RATIO = 2
"""omega_L/Omega of Table 3."""


@dataclass(frozen=True)
class RowProof:
    """A row and what is proven of it.

    Attributes
    ----------
    row : Row
    proof : Proof
        At the Omega that it was run at.
    shown : {"stable", "unstable", "undecided"}
        What `verify` shows.
    interval : IntervalProof or None
        Of every Omega that rounds to the printed one; None where it was not asked for.
    """

    row: Row
    proof: Proof
    shown: Verdict
    interval: IntervalProof | None

    @property
    def printed(self) -> Verdict:
        """What print says."""
        return "stable" if self.row.T == 0.0 else "unstable"

    @property
    def proven(self) -> bool:
        """Whether what `verify` shows is proven."""
        return self.proof.verdict == self.shown != "undecided"

    @property
    def flips(self) -> bool:
        """Whether print is proven to be wrong at the Omega that it was run at."""
        return self.proof.verdict not in ("undecided", self.printed)

    @property
    def everywhere(self) -> bool:
        """Whether one verdict is proven for every Omega that is printed so."""
        return self.interval is not None and self.interval.verdict in ("stable", "unstable")

    @property
    def flips_everywhere(self) -> bool:
        """Whether print is wrong whatever the Omega was that is printed so."""
        found = self.interval
        return self.everywhere and found is not None and found.verdict != self.printed


def forcing(row: Row) -> dict[str, Any]:
    """What its beam is under, but for Omega."""
    return {
        "gamma": row.gamma,
        "eta": row.run["eta"],
        "initial_terms": TERMS if row.initial_conditions else 0,
        "ratio": RATIO if row.table == 3 else None,
    }


def printed_interval(row: Row) -> tuple[Fraction, Fraction]:
    """Every Omega that rounds to the printed one, as the errata correct it; ends included."""
    Omega = Fraction(corrected(row).Omega_printed)
    return Omega - HALF_UNIT, Omega + HALF_UNIT


def prove_row(row: Row, *, interval: bool = False) -> RowProof:
    """Of two modes, as the report has; the equations as the errata correct them."""
    beam, given = row.beam(2), forcing(row)
    return RowProof(
        row=row,
        proof=prove(beam, {"Omega": row.Omega} | given),
        shown=check(row).verdict,
        interval=enclose_interval(beam, Omega=printed_interval(row), **given) if interval else None,
    )


def counts(rows: tuple[RowProof, ...]) -> dict[str, Any]:
    """The summary in numbers; of intervals only where they were asked for."""
    asked = [r for r in rows if r.interval is not None]
    found: dict[str, Any] = {
        "rows": len(rows),
        "proven": sum(r.proven for r in rows),
        "routes_meet": sum(r.proof.meet for r in rows),
        "wrong_in_print": [r.row.id for r in rows if r.flips],
    }
    if asked:
        found |= {
            "proven_for_every_Omega": sum(r.everywhere for r in asked),
            "wrong_for_every_Omega": [r.row.id for r in asked if r.flips_everywhere],
            "depends_on_Omega": [r.row.id for r in asked if not r.everywhere],
        }
    return found


def lines(rows: tuple[RowProof, ...]) -> tuple[str, str]:
    """The summary in two lines."""
    n = counts(rows)
    first = (
        f"{n['proven']} of {n['rows']} verdicts are proven, the routes' balls meet on "
        f"{n['routes_meet']}; {len(n['wrong_in_print'])} printed verdicts are wrong."
    )
    if "depends_on_Omega" not in n:
        return first, "Every Omega that rounds to the printed one: --interval."
    rest = ", ".join(n["depends_on_Omega"])
    second = (
        f"Of every Omega that rounds to the printed one {n['proven_for_every_Omega']} are proven, "
        f"{len(n['wrong_for_every_Omega'])} of them wrong in print"
        f"{f'; not one verdict: {rest}' if rest else ''}."
    )
    return first, second


def record(found: RowProof) -> dict[str, Any]:
    """What JSON holds of a row."""
    row = found.row
    return {
        "id": row.id,
        "table": row.table,
        "Omega_printed": row.Omega_printed,
        "Omega": repr(row.Omega),
        "verdict_printed": found.printed,
        "verdict_shown": found.shown,
        "proven": found.proven,
        **proof_record(found.proof),
        "interval": interval_record(found.interval),
    }


def proof_record(proof: Proof) -> dict[str, Any]:
    """What JSON holds of a proof; balls are strings."""
    return {
        "verdict": proof.verdict,
        "routes_meet": proof.meet,
        "of_decimals": proof.decimals,
        "reason": proof.reason,
        **{
            name: None
            if route is None
            else {
                "polynomial_of": route.of,
                "polynomial": list(route.polynomial),
                "radius": route.radius,
                "roots": list(route.roots),
                "T": route.T,
                "verdict": route.verdict,
            }
            for name, route in (("hill", proof.hill), ("floquet", proof.floquet))
        },
    }


def interval_record(found: IntervalProof | None) -> dict[str, Any] | None:
    """What JSON holds of an interval."""
    if found is None:
        return None
    return {
        "Omega": list(found.Omega),
        "verdict": found.verdict,
        "parts": [{"Omega": [a, b], "verdict": kind} for a, b, kind in found.parts],
        "nodes": found.nodes,
        "remainder": found.remainder,
    }
