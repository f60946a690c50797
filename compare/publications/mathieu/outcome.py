"""A characteristic value by both routes: does P change its sign about it?"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from compare.both_routes import CrossCheck, crosscheck
from compare.erratum import Erratum
from compare.publication import Method
from compare.publications.mathieu.table import Row
from floquet import Monodromy
from hill import Characteristic, HillEquation

# The interval is drawn in by this share, which is above the rounding of its ends.
INWARDS = 1e-5

Cause = Literal["agrees", "misprint", "undecided", "unexplained"]


@dataclass(frozen=True)
class Around:
    """P(z) of one route at the printed value and half a unit to either side, and its bound."""

    below: float
    at: float
    above: float
    bound: float

    @property
    def changes_sign(self) -> bool:
        """Whether P is shown to vanish within half a unit."""
        return self.below * self.above < 0.0 and min(abs(self.below), abs(self.above)) > self.bound

    @property
    def may_vanish(self) -> bool:
        """Whether the bound allows P to vanish at the printed value."""
        return abs(self.at) <= self.bound


@dataclass(frozen=True)
class Outcome:
    """A value and what both routes say of it.

    Attributes
    ----------
    hill, floquet : Around
    difference : float
        Largest difference of the two P.
    routes_agree : bool
        Whether at all three points the difference is within the bounds.
    cause : str
        "agrees" where both show a change of sign; "misprint" where they do for the corrected value;
        "undecided" where neither contradicts; else "unexplained".
    expected : bool
        False unless it agrees or the errata say why not.
    """

    row: Row
    hill: Around
    floquet: Around
    difference: float
    routes_agree: bool
    cause: Cause
    expected: bool
    note: str

    @property
    def differs(self) -> bool:
        """Whether the value is not shown to be right."""
        return self.cause != "agrees"

    @property
    def flips(self) -> bool:
        """Nothing is printed of stability."""
        return False


def solve(row: Row, *, method: Method, modes: None = None) -> tuple[CrossCheck, ...]:
    """Both routes below, at and above the printed value; both are given the same a and q."""
    a, half = float(row.printed), row.half_unit * (1.0 - INWARDS)
    return tuple(
        crosscheck(HillEquation([[x]], [[1.0]], -2.0 * row.q, 2.0), method=method)
        for x in (a - half, a, a + half)
    )


def explain(
    row: Row, found: tuple[CrossCheck, ...], _: None, errata: tuple[Erratum, ...]
) -> Outcome:
    """Whether the value is right; if not, whether the errata say so."""
    hill, floquet = (
        _around(row, [getattr(x, route) for x in found]) for route in ("hill", "floquet")
    )
    cause, note = _cause(row, hill, floquet, errata)
    open_ = [e.why for e in errata if e.kind == "open"]
    return Outcome(
        row=row,
        hill=hill,
        floquet=floquet,
        difference=max(x.difference for x in found),
        routes_agree=all(x.routes_agree for x in found),
        cause=cause,
        expected=cause in ("agrees", "misprint") or (cause == "undecided" and bool(open_)),
        note=note or (open_[0] if cause == "undecided" and open_ else ""),
    )


def _cause(
    row: Row, hill: Around, floquet: Around, errata: tuple[Erratum, ...]
) -> tuple[Cause, str]:
    if hill.changes_sign and floquet.changes_sign:
        return "agrees", ""
    for erratum in (e for e in errata if e.kind == "cell"):
        right = replace(row, printed=erratum.corrected)
        if explain(right, solve(right, method="taylor"), None, ()).cause == "agrees":
            return "misprint", f"should be {erratum.corrected}"
    if all(route.changes_sign or route.may_vanish for route in (hill, floquet)):
        return "undecided", ""
    return "unexplained", ""


def _around(row: Row, found: Sequence[Characteristic | Monodromy]) -> Around:
    values = [row.z + float(result.polynomial[1]) for result in found]
    eps = float(np.finfo(float).eps)
    bound = max(x.error + eps * (1.0 + abs(float(x.polynomial[1]))) for x in found)
    below, at, above = values
    return Around(below, at, above, bound)
