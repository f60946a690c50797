"""One system by two routes: what each finds, how far they differ, what both show."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from floquet import Monodromy, monodromy
from floquet.witness import maker
from hill import Characteristic, Fourier, HillEquation, PeriodicEquation, characteristic
from hill.stability import Verdict

Method = Literal["taylor", "cvodes"]


@dataclass(frozen=True, eq=False)
class CrossCheck:
    """Both routes' results and the comparison.

    Attributes
    ----------
    hill : Characteristic
        By the determinant.
    floquet : Monodromy
        By the time domain.
    difference : float
        Largest difference between the coefficients of the two polynomials, P(z) or that of the
        multipliers.
    matrices : float
        Largest difference between the two routes' matrices, over their largest element.
    shared_matrices : bool
        Whether both routes were given the same matrices, so that only the solution is checked.
    routes_agree : bool
        Whether every coefficient's difference is within the sum of its two errors, and neither
        route shows the opposite of what the other shows.
    verdict : {"stable", "unstable", "undecided"}
        What either route shows, where the other does not show the opposite.
    """

    hill: Characteristic
    floquet: Monodromy
    difference: float
    matrices: float
    shared_matrices: bool
    routes_agree: bool
    verdict: Verdict

    @property
    def stable(self) -> bool:
        """Whether the system is shown to be stable."""
        return self.verdict == "stable"

    @property
    def bound(self) -> float:
        """Sum of the two errors of P."""
        return self.hill.error + self.floquet.error

    @property
    def T(self) -> float:
        """The characteristic argument of the route that knows it better."""
        return self.hill.T if self.hill.T_error < self.floquet.T_error else self.floquet.T

    @property
    def T_error(self) -> float:
        """Bound on the error of `T`."""
        return min(self.hill.T_error, self.floquet.T_error)


def crosscheck(
    what: Any,
    *,
    Omega: float | None = None,
    gamma: float | None = None,
    eta: float = 0.0,
    method: Method = "taylor",
) -> CrossCheck:
    """Solve an equation, or a system under a forcing, by both routes.

    Parameters
    ----------
    what : HillEquation, PeriodicEquation or System
    Omega, gamma, eta : float, optional
        The forcing of a system; an equation has its own.
    method : {"taylor", "cvodes"}, optional
        How the time domain integrates.

    Returns
    -------
    CrossCheck

    Raises
    ------
    ValueError
        A forcing beside an equation, or none for a system; whatever is out of range.
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    if isinstance(what, HillEquation | PeriodicEquation):
        if Omega is not None or gamma is not None or eta != 0.0:
            raise ValueError("Omega, gamma, eta: an equation has its own; leave them out")
        return compare_routes(what, what, method=method)
    for name, value in (("Omega", Omega), ("gamma", gamma)):
        if value is None:
            raise ValueError(f"{name}: has no value; a system needs a forcing")
    own = what.equation(Omega, gamma, eta)
    make = maker(what)
    other = make(what, Omega, gamma, eta) if make else own
    return compare_routes(own, other, method=method)


def compare_routes(closed: Any, other: Any, *, method: Method = "taylor") -> CrossCheck:
    """An equation by the determinant, and the same or the witness's own by the time domain."""
    h, f = characteristic(closed), monodromy(other, method=method)
    apart = np.abs(h.polynomial - f.polynomial)
    shown = {h.verdict, f.verdict} - {"undecided"}
    return CrossCheck(
        hill=h,
        floquet=f,
        difference=float(np.max(apart)),
        matrices=0.0 if closed is other else _apart(closed, other),
        shared_matrices=closed is other,
        routes_agree=bool(np.all(apart <= h.errors + f.errors)) and len(shown) < 2,
        verdict=shown.pop() if len(shown) == 1 else "undecided",
    )


def _apart(one: Any, other: Any) -> float:
    pairs = zip(_matrices(one), _matrices(other), strict=True)
    return max(
        float(np.max(np.abs(a - b)) / max(np.max(np.abs(a)), np.max(np.abs(b)), 1e-300))
        for a, b in pairs
    )


def _matrices(equation: HillEquation | PeriodicEquation) -> list[Any]:
    if isinstance(equation, HillEquation):
        return [equation.F, equation.G, *equation.H]
    parts = [x for x in (equation.K, equation.C, equation.A) if x is not None]
    return [matrix for part in parts for matrix in _coefficients(part)]


def _coefficients(matrix: Fourier) -> list[Any]:
    return [matrix.mean, *matrix.cos.values(), *matrix.sin.values()]
