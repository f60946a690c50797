"""One printed row, held against both routes and against the program as it was run."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from compare.both_routes import CrossCheck, compare_routes
from compare.erratum import Erratum
from compare.publication import Method
from compare.report.match import distance
from compare.report.program.deck import constants
from compare.report.program.listing import Stab, stab
from compare.report.recover import HALF_UNIT, T_AS_RUN, Z_AS_RUN
from compare.report.tables import Row, corrected
from floquet import Monodromy
from floquet.weak_form import galerkin
from hill import Characteristic, HillEquation, characteristic
from hill.determinant.residues import as_the_report
from hill.stability import Verdict

Complex = NDArray[np.complexfloating[Any, Any]]
Cause = Literal["agrees", "truncation", "listing-slip", "misprint", "unexplained"]
Found = tuple[float, Complex]
"""T and z."""

TERMS = 5
"""Terms of the free longitudinal vibration, as many as the listing's S."""

AS_RUN = (Z_AS_RUN, T_AS_RUN)

# The report's equations, truncated like the report but at the exact lambda_n, pi and omega_L, miss
# the deck's by its five-figure constants: 6.7e-5 at most over Tables 1 and 2, open rows apart.
Z_REPORT = 1e-4
# The same for T, times 1/Omega: 1.2e-4 at most (T2-22).
T_REPORT = 1.5e-4


@dataclass(frozen=True, eq=False)
class Outcome:
    """A row and everything found about it; what renderers print.

    Attributes
    ----------
    row : Row
    as_run_T, as_run_z
        The report's program at the recovered Omega: its truncation, its slips.
    hill : Characteristic
    floquet : Monodromy
        The two routes, converged.
    difference : float
        Largest difference between the coefficients of the two P(z).
    matrices : float
        Largest difference between the two routes' F, G and H, over their largest element.
    routes_agree : bool
        Whether `difference` is within the sum of the two errors, and the verdicts do not oppose
        each other.
    cause : str
        Why the printed value differs: "agrees", "truncation", "listing-slip", "misprint" or
        "unexplained".
    expected : bool
        False where `cause` is "unexplained" and the errata do not list the row as open.
    verdict_printed, verdict : str
        "stable" or "unstable"; `verdict` is "undecided" where neither route shows one, or one
        route the opposite of the other.
    note : str
    """

    row: Row
    modes: int
    as_run_T: float
    as_run_z: Complex
    hill: Characteristic
    floquet: Monodromy
    difference: float
    matrices: float | None
    routes_agree: bool
    cause: Cause
    expected: bool
    verdict_printed: str
    verdict: Verdict
    note: str

    @property
    def differs(self) -> bool:
        """Whether print differs, or says another verdict."""
        return self.cause != "agrees" or self.flips

    @property
    def flips(self) -> bool:
        """Whether the printed verdict on stability is shown to be wrong."""
        return self.verdict not in ("undecided", self.verdict_printed)


def as_run(row: Row) -> Stab:
    """What the report's program gives at the Omega it was run at."""
    return stab(constants(row.run["beam"]), row.case, row.Omega)


def solve(row: Row, *, method: Method, modes: int) -> CrossCheck:
    """Both routes, each with its own matrices."""
    return compare_routes(equation(row, modes), witness(row, modes), method=method)


def explain(row: Row, x: CrossCheck, program: Stab, errata: tuple[Erratum, ...]) -> Outcome:
    """Why print differs, if it does. The cause is always judged with the report's two modes."""
    modes, listed_open = len(x.hill.z) - 1, any(e.kind == "open" for e in errata)
    of_two_modes = equation(row, 2)
    judged = x.hill if modes == 2 else characteristic(of_two_modes)
    found, run = (judged.T, judged.z), (program.STAB1, program.roots)
    cause, note = _cause(row, of_two_modes, found, run)
    if cause == "unexplained" and listed_open:
        note = "open, see the errata"
    return Outcome(
        row=row,
        modes=modes,
        as_run_T=program.STAB1,
        as_run_z=program.roots,
        hill=x.hill,
        floquet=x.floquet,
        difference=x.difference,
        matrices=x.matrices,
        routes_agree=x.routes_agree,
        cause=cause,
        expected=cause != "unexplained" or listed_open,
        verdict_printed="stable" if row.T == 0.0 else "unstable",
        verdict=x.verdict,
        note=note if modes == 2 else f"{modes} modes; {note}".removesuffix("; "),
    )


def equation(row: Row, modes: int) -> HillEquation:
    """The row's equation, matrices in closed form."""
    return row.beam(modes).equation(row.Omega, row.gamma, **_damping(row))


def witness(row: Row, modes: int) -> HillEquation:
    """The row's equation, matrices by quadrature of the weak form."""
    return galerkin(row.beam(modes), row.Omega, row.gamma, **_damping(row))


def _damping(row: Row) -> dict[str, Any]:
    return {"eta": row.run["eta"], "initial_terms": TERMS if row.initial_conditions else 0}


def _cause(row: Row, eq: HillEquation, converged: Found, as_run: Found) -> tuple[Cause, str]:
    """The first explanation that brings the printed numbers back, from the simplest on."""
    corrected_row = corrected(row)
    if _reproduces(row, converged):
        lost = not _reproduces(corrected_row, as_run)
        return "agrees", "as run does not come back, see the errata" if lost else ""
    explanations: list[tuple[Cause, Found, tuple[float, float]]] = [
        ("agrees", converged, AS_RUN),
        ("truncation", _truncated(eq), (Z_REPORT, T_REPORT)),
        ("listing-slip", as_run, AS_RUN),
    ]
    for cause, found, tolerances in explanations:
        if _reproduces(row, found, tolerances):
            return cause, ""
    for cause, found, tolerances in explanations:
        if corrected_row != row and _reproduces(corrected_row, found, tolerances):
            return "misprint", f"as corrected: {cause}"
    return "unexplained", ""


def _truncated(eq: HillEquation) -> Found:
    """T and z with the report's truncation, where its residues exist."""
    found = as_the_report(eq)
    return (found.T, found.z) if found else (float("nan"), np.full(eq.n, np.nan, complex))


def _reproduces(row: Row, found: Found, tolerances: tuple[float, float] = AS_RUN) -> bool:
    """Whether the printed T, z and rounded Omega are the ones found."""
    T, z = found
    z_tolerance, T_tolerance = tolerances
    # Table 3 is run at resonances, which its printed Omega and omega_L only name
    rounded = row.table == 3 or abs(float(row.Omega_printed) - row.Omega) <= HALF_UNIT * (1 + 1e-6)
    if not (rounded and abs(max(T, 0.0) - row.T) <= T_tolerance / row.Omega):
        return False
    return not row.z_printed or distance(z, row.z) <= z_tolerance
