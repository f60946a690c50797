"""The page of one printed row: what stands on it, from its outcome."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from compare.pages import pictures
from compare.pages.drawing import Picture
from compare.pages.motion import Motion
from compare.report import tables
from compare.report.errata_tables import Entry
from compare.report.match import order
from compare.report.proofs import RowProof
from compare.report.proofs import record as proof_record
from compare.report.render import decimal
from compare.report.row import Outcome
from compare.verification import Report

CAUSES = {
    "agrees": "Print agrees with both routes.",
    "truncation": "The report's determinant is cut off after a few harmonics; cut off in the same "
    "way, ours gives what is printed.",
    "listing-slip": "The report's program, slips included, gives what is printed; its equations, "
    "solved, do not.",
    "misprint": "A cell is misprinted: with the corrected one the row comes back.",
    "unexplained": "The report's own program, run again, does not give what is printed.",
}

COORDINATES = ("bending 1", "bending 2", "rotation")


@dataclass(frozen=True, eq=False)
class RowPage:
    """One row.

    Attributes
    ----------
    record : mapping
        What JSON holds of it.
    printed : mapping
        Its Omega and T as they stand on the page.
    held : tuple of (str, number)
        The parameters of its run.
    cause : str
        Why print differs, in a sentence.
    as_run_T : str
        To as many digits as the report prints.
    z_order : mapping
        Of "as_run", "hill" and "floquet": which z is the first that is printed, the second, ...
    multipliers : tuple of (complex, complex)
        By Hill and by Floquet.
    pictures, motion : tuple of Picture
    moves : Motion or str
        What `motion` is drawn of, or why nothing is.
    errata : tuple of Entry
    proof : mapping or None
        What JSON of `verify prove` holds of it.
    before, after : str
        Ids of the rows beside it, or empty.
    """

    record: Mapping[str, Any]
    printed: Mapping[str, str]
    as_run_T: str
    held: tuple[tuple[str, Any], ...]
    cause: str
    z_order: Mapping[str, tuple[int, ...]]
    multipliers: tuple[tuple[complex, complex], ...]
    pictures: tuple[Picture, ...]
    motion: tuple[Picture, ...]
    moves: Motion | str
    errata: tuple[Entry, ...]
    proof: Mapping[str, Any] | None
    before: str
    after: str


def row_page(
    report: Report,
    o: Outcome,
    motion: Motion | str,
    errata: tuple[Entry, ...],
    proof: RowProof | None,
    beside: tuple[str, str],
) -> RowPage:
    """What is said of a row; `beside` are the ids of those before and after it, or empty."""
    row = o.row
    given = (*held(row.table), ("omega_L", row.omega_L), ("N", o.modes))
    roots = pictures.Roots(
        polynomial=tuple(map(float, o.floquet.polynomial)),
        hill=_finite(o.hill.z),
        floquet=_finite(o.floquet.z),
        printed=row.z,
    )
    first = row.z or tuple(o.hill.z)
    found = {"as_run": o.as_run_z, "hill": o.hill.z, "floquet": o.floquet.z}
    witness = o.floquet.multipliers[order(_finite(o.hill.multipliers), o.floquet.multipliers)]
    same = len(first) == len(o.hill.z)
    return RowPage(
        record=report.publication.rendering.record(o),
        printed={"Omega": row.Omega_printed, "T": row.T_printed},
        as_run_T=decimal(o.as_run_T),
        held=given,
        cause=CAUSES[o.cause],
        z_order={
            name: tuple(order(first, z) if same and len(z) == len(first) else range(len(z)))
            for name, z in found.items()
        },
        multipliers=tuple(zip(_finite(o.hill.multipliers), _finite(witness), strict=True)),
        pictures=(
            pictures.multipliers(_finite(o.hill.multipliers), _finite(o.floquet.multipliers)),
            pictures.whole(roots),
            pictures.closest(roots),
        ),
        motion=pictures.of_motion(motion),
        moves=motion,
        errata=errata,
        proof=proof_record(proof) if proof else None,
        before=beside[0],
        after=beside[1],
    )


def _finite(values: Iterable[complex]) -> tuple[complex, ...]:
    return tuple(complex(value) for value in values)


def held(table: int) -> tuple[tuple[str, Any], ...]:
    """The parameters that a table was run with."""
    run = tables.heading(table)["run"]
    return tuple((name, value) for name, value in run.items() if name not in ("beam", "modes"))
