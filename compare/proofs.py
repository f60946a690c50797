"""One system enclosed by both routes: balls as decimal strings, whether they meet, the verdict."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import floquet
import hill
from hill import HillEquation, PeriodicEquation, SteppedBeam, UniformBeam
from hill.stability import Verdict

DIGITS = 40
"""Of a ball's middle, as long as its radius allows them; the string holds the ball."""

# Bits to which the determinant's P is asked for: 24 digits, where 100 take twice as long.
BITS = 80


@dataclass(frozen=True)
class RouteProof:
    """What one route encloses.

    Attributes
    ----------
    polynomial : tuple of str
        Balls about P's coefficients, monic, highest power first.
    of : str
        Of what: "z" or "multipliers".
    roots : tuple of str
        Balls that hold its roots.
    T : str
        A ball.
    radius : float
        The largest of P's coefficients.
    verdict : {"stable", "unstable", "undecided"}
        Proven, or undecided.
    """

    polynomial: tuple[str, ...]
    of: str
    roots: tuple[str, ...]
    T: str
    radius: float
    verdict: Verdict


@dataclass(frozen=True)
class Proof:
    """Both routes' enclosures.

    Attributes
    ----------
    hill, floquet : RouteProof or None
        None where a route refuses, for the `reason`.
    meet : bool
        Whether all balls of P and of T that both routes have meet.
    decimals : bool
        Whether it is of parameters as they are written, matrices included; otherwise of floats.
    reason : str
        Why a route has nothing, or why nothing is proven.
    """

    hill: RouteProof | None
    floquet: RouteProof | None
    meet: bool
    decimals: bool
    reason: str

    @property
    def verdict(self) -> Verdict:
        """What either route proves, if their balls meet and neither proves the opposite."""
        shown = {r.verdict for r in (self.hill, self.floquet) if r} - {"undecided"}
        return shown.pop() if self.meet and len(shown) == 1 else "undecided"


def prove(what: Any, forcing: Mapping[str, Any]) -> Proof:
    """Enclose a system, or an equation, by both routes.

    Parameters
    ----------
    what : System, HillEquation or PeriodicEquation
        A beam is taken with its parameters as they are written, and each route makes its own
        matrices; of anything else both take the floats of its equation.
    forcing : mapping
        Omega, gamma and eta of a system; for a beam also `initial_terms` and `ratio`.

    Raises
    ------
    ValueError
        python-flint is not there; neither route encloses it.
    """
    exact = isinstance(what, UniformBeam | SteppedBeam) and not _whole_force(what)
    if exact:
        given: dict[str, Any] = dict(forcing)
    else:
        is_equation = isinstance(what, HillEquation | PeriodicEquation)
        what, given = what if is_equation else what.equation(**forcing), {}
    by_time, no_time = _tried(floquet.enclose, what, given)
    by_determinant, no_determinant = _tried(hill.enclose, what, given | {"bits": BITS})
    if by_time is None and by_determinant is None:
        raise ValueError(no_time)
    meet = True
    if by_time is not None and by_determinant is not None:
        pairs = zip(by_time.polynomial, by_determinant.polynomial, strict=True)
        meet = all(a.overlaps(b) for a, b in pairs) and bool(by_time.T.overlaps(by_determinant.T))
    found = Proof(
        hill=_route(by_determinant, "z"),
        floquet=_route(by_time, "" if by_time is None else by_time.of),
        meet=meet,
        decimals=exact,
        reason=no_time or no_determinant,
    )
    return found if found.verdict != "undecided" or found.reason else _with_reason(found)


def _whole_force(beam: UniformBeam | SteppedBeam) -> bool:
    return isinstance(beam, UniformBeam) and beam.quadrature_force


def _tried(enclose: Any, what: Any, given: dict[str, Any]) -> tuple[Any, str]:
    """An enclosure, or why there is none; without the extra there is nothing to try."""
    try:
        return enclose(what, **given), ""
    except ValueError as error:
        if "[proof]" in str(error):
            raise
        return None, str(error)


def _route(found: Any, of: str) -> RouteProof | None:
    if found is None:
        return None
    return RouteProof(
        polynomial=tuple(c.str(DIGITS) for c in found.polynomial),
        of=of,
        roots=tuple(z.str(DIGITS) for z in found.roots),
        T=found.T.str(DIGITS),
        radius=found.radius,
        verdict=found.verdict,
    )


def _with_reason(found: Proof) -> Proof:
    """Why nothing is proven of what both enclose."""
    if not found.meet:
        reason = "the routes' balls do not meet: one of the enclosures is wrong"
    else:
        reason = "T is 0 within its ball: on an edge, or roots meet that no ball tells apart"
    return Proof(found.hill, found.floquet, found.meet, found.decimals, reason)
