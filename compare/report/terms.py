"""Table 3 with initial conditions when more terms of the free vibration are kept than the report's.

The listing sums five terms of section 4.6. H_s falls like 1/s^2, C_s and its integrals like 1/s
each, and acts on P in pairs at the frequency s omega_L: what S terms leave out of P falls like
S^-5. Rows keep five, as printed; `verify --more-terms` puts this beside them.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from compare import publication
from compare.both_routes import compare_routes
from compare.report.row import TERMS as PRINTED
from compare.report.tables import Row
from floquet import monodromy
from floquet.weak_form import galerkin
from hill.stability import Verdict, stability_of

# Both routes take so many; the determinant's band widens with every one.
TERMS = 8

# The time domain alone goes on to these, for the limit: from 8 and 12 it is not yet S^-5, and the
# limit of T3-01b comes out 1.5e-6 too small, from 12 and 16 4e-8 too large.
FINER = (12, 16)
POWER = 5


@dataclass(frozen=True)
class MoreTerms:
    """A row of Table 3 with more terms, and in the limit of many.

    Attributes
    ----------
    terms : int
        Terms kept for `T_hill`, `T_floquet` and `verdict`.
    T_hill, T_floquet : float
        T by both routes.
    routes_agree : bool
        Whether they agree on P within their bounds.
    T_limit : float
        T of the extrapolated P.
    T_limit_estimate : float
        An estimate, and no bound, of the error of `T_limit`: what P may do if it is off by as much
        as it moved between the two finest sums.
    verdict : {"stable", "unstable", "undecided"}
        What either route shows with `terms` terms, where the other does not show the opposite.
    verdict_in_the_limit : {"stable", "unstable", "undecided"}
        What the extrapolated P shows if the estimate holds.
    """

    terms: int
    T_hill: float
    T_floquet: float
    routes_agree: bool
    T_limit: float
    T_limit_estimate: float
    verdict: Verdict
    verdict_in_the_limit: Verdict


def with_more_terms(row: Row, terms: int = TERMS) -> MoreTerms:
    """The row by both routes with `terms` terms, and the limit by the time domain.

    Raises
    ------
    ValueError
        The row has no initial conditions, so that there is nothing to sum.
    """
    if not row.initial_conditions:
        raise ValueError(f"row = {row.id!r}: has no initial conditions, must be one of Table 3 (b)")
    beam, forcing = row.beam(2), (row.Omega, row.gamma, row.run["eta"])
    x = compare_routes(beam.equation(*forcing, terms), galerkin(beam, *forcing, terms))
    coarse, fine = (monodromy(galerkin(beam, *forcing, count)) for count in FINER)
    moved = fine.polynomial - coarse.polynomial
    limit = fine.polynomial + moved / ((FINER[1] / FINER[0]) ** POWER - 1.0)
    doubt = float(np.max(np.abs(moved))) + coarse.error + fine.error
    found = stability_of(limit, doubt, row.Omega, row.run["eta"])
    return MoreTerms(
        terms=terms,
        T_hill=x.hill.T,
        T_floquet=x.floquet.T,
        routes_agree=x.routes_agree,
        T_limit=found.T,
        T_limit_estimate=found.T_error,
        verdict=x.verdict,
        verdict_in_the_limit=found.verdict,
    )


def sums_terms(row: Row) -> bool:
    """Whether a row has initial conditions."""
    return bool(row.initial_conditions)


def record(found: MoreTerms) -> dict[str, Any]:
    """What JSON holds; null for an estimate that is none."""
    values = asdict(found)
    if not math.isfinite(found.T_limit_estimate):
        values["T_limit_estimate"] = None
    return values


def line(row: Row, found: MoreTerms) -> str:
    """In words."""
    many = f"{found.terms} terms for {PRINTED}"
    if found.verdict == found.verdict_in_the_limit == "stable":
        return f"{row.id}: {many}, {_agreed(found)}: stable, and so in the limit."
    return (
        f"{row.id}: {many}, {_agreed(found)}: T = {found.T_hill:.6f}, {found.verdict}; "
        f"in the limit {found.T_limit:.6f}, off by {found.T_limit_estimate:.0e} by estimate, "
        f"{found.verdict_in_the_limit}."
    )


def _agreed(found: MoreTerms) -> str:
    return "both routes" if found.routes_agree else "THE ROUTES DISAGREE"


MORE_TERMS = publication.MoreTerms(sums_terms, with_more_terms, record, line)
