"""One system by two routes: what each finds, how far they differ, what both show."""

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from compare.proofs import Proof, prove
from floquet import Monodromy, monodromy
from floquet.witness import maker, rougher_maker
from hill import Characteristic, Fourier, HillEquation, PeriodicEquation, characteristic
from hill.precision import remark
from hill.stability import Verdict

Method = Literal["taylor", "cvodes"]
Precision = Literal["double", "proof"]

# On what the last refinement of the witness's elements moved P by: they gain two digits each time.
SAFETY = 4.0

# Over it is divided.
SMALLEST = 1e-300


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
    discretisation : float
        How far P may be off for the matrices, where the witness makes its own from finite elements:
        an estimate, of its elements by what the last refinement moved P by, and of both routes'
        rounding. 0 for other systems.
    matrices : float
        Largest difference between the two routes' matrices, over their largest element.
    shared_matrices : bool
        Whether both routes were given the same matrices, so that only the solution is checked.
    routes_agree : bool
        Whether every coefficient's difference is within the sum of its errors, and neither route
        shows the opposite of what the other shows.
    verdict : {"stable", "unstable", "undecided"}
        What either route shows, where the other does not show the opposite.
    remark : str
        What is known to less than nine digits, or not shown, by the route that knows T better; as
        of its results, `hill.precision`.
    proof : Proof or None
        Both routes' enclosures, where they were asked for; `verdict` is theirs then.
    """

    hill: Characteristic
    floquet: Monodromy
    difference: float
    discretisation: float
    matrices: float
    shared_matrices: bool
    routes_agree: bool
    verdict: Verdict
    remark: str
    proof: Proof | None = None

    @property
    def stable(self) -> bool:
        """Whether the system is shown to be stable."""
        return self.verdict == "stable"

    @property
    def bound(self) -> float:
        """Sum of the two routes' errors of P, and of the discretisation's."""
        return self.hill.error + self.floquet.error + self.discretisation

    @property
    def T(self) -> float:
        """The characteristic argument of the route that knows it better."""
        return _better(self.hill, self.floquet).T

    @property
    def T_error(self) -> float:
        """Bound on the error of `T`."""
        return _better(self.hill, self.floquet).T_error

    def _repr_html_(self) -> str:
        from compare.notebook import of_crosscheck

        return of_crosscheck(self)


def crosscheck(
    what: Any,
    *,
    Omega: float | None = None,
    gamma: float | None = None,
    eta: float = 0.0,
    method: Method = "taylor",
    precision: Precision = "double",
) -> CrossCheck:
    """Solve an equation, or a system under a forcing, by both routes.

    Parameters
    ----------
    what : HillEquation, PeriodicEquation or System
    Omega, gamma, eta : float, optional
        The forcing of a system; an equation has its own.
    method : {"taylor", "cvodes"}, optional
        How the time domain integrates.
    precision : {"double", "proof"}, optional
        "proof" also encloses by both routes in ball arithmetic (extra `proof`): the verdict is
        proven then, or undecided, also where double precision shows none.

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
    if precision not in ("double", "proof"):
        raise ValueError(f'precision = {precision!r}: must be "double" or "proof"')
    if isinstance(what, HillEquation | PeriodicEquation):
        if Omega is not None or gamma is not None or eta != 0.0:
            raise ValueError("Omega, gamma, eta: an equation has its own; leave them out")
        x = compare_routes(what, what, method=method)
        return _proven(x, what, {}, what.Omega) if precision == "proof" else x
    for name, value in (("Omega", Omega), ("gamma", gamma)):
        if value is None:
            raise ValueError(f"{name}: has no value; a system needs a forcing")
    own = what.equation(Omega, gamma, eta)
    if not isinstance(own, HillEquation | PeriodicEquation):
        raise ValueError(
            f"{type(what).__name__}.equation: gave a {type(own).__name__}, must give a "
            "HillEquation or a PeriodicEquation"
        )
    make, rougher = maker(what), rougher_maker(what)
    other = make(what, Omega, gamma, eta) if make else own
    rough = rougher(what, Omega, gamma, eta) if rougher else None
    x = compare_routes(own, other, rough, method=method)
    forcing = {"Omega": Omega, "gamma": gamma, "eta": eta}
    return _proven(x, what, forcing, own.Omega) if precision == "proof" else x


def _proven(x: CrossCheck, what: Any, forcing: dict[str, Any], Omega: float) -> CrossCheck:
    """The same with the enclosures' verdict."""
    proof, known = prove(what, forcing), _better(x.hill, x.floquet)
    shown = {x.verdict, proof.verdict} - {"undecided"}
    told = remark(known.T, known.T_error, Omega, proof.verdict, known.polynomial, known.error)
    return replace(
        x,
        verdict=proof.verdict,
        routes_agree=x.routes_agree and proof.meet and len(shown) < 2,
        remark=told,
        proof=proof,
    )


def compare_routes(
    closed: Any, other: Any, rougher: Any = None, *, method: Method = "taylor"
) -> CrossCheck:
    """An equation by the determinant, and the same or the witness's own by the time domain.

    Where the witness's own comes from finite elements, `rougher` is from the elements before the
    last refinement, its `data_error` what is left of them but rounding.
    """
    if isinstance(closed, HillEquation) != isinstance(other, HillEquation):
        closed, other, rougher = (
            e.general() if isinstance(e, HillEquation) else e for e in (closed, other, rougher)
        )
    h, f = characteristic(closed), monodromy(other, method=method)
    apart = np.abs(h.polynomial - f.polynomial)
    elements = np.zeros_like(apart)
    if rougher is not None:
        r = monodromy(rougher, method=method)
        # of coefficients that move by chance in nothing, what the others say of them
        moved, scale = np.abs(f.polynomial - r.polynomial), np.maximum(f.errors, SMALLEST)
        elements = SAFETY * np.max(moved / scale) * scale + r.data_error + h.data_error
    better = _better(h, f)
    shown = {h.verdict, f.verdict} - {"undecided"}
    agreed = len(shown) < 2
    verdict: Verdict = shown.pop() if len(shown) == 1 else "undecided"
    return CrossCheck(
        hill=h,
        floquet=f,
        difference=float(np.max(apart)),
        discretisation=float(np.max(elements)),
        matrices=0.0 if closed is other else _apart(closed, other),
        shared_matrices=closed is other,
        routes_agree=bool(np.all(apart <= h.errors + f.errors + elements)) and agreed,
        verdict=verdict,
        remark=remark(
            better.T, better.T_error, closed.Omega, verdict, better.polynomial, better.error
        ),
    )


def _better(h: Characteristic, f: Monodromy) -> Characteristic | Monodromy:
    """Who knows T better."""
    return h if h.T_error < f.T_error else f


def _apart(one: Any, other: Any) -> float:
    """Largest difference of two equations' matrices, of each over its largest element."""
    if isinstance(one, HillEquation):
        pairs = list(zip((one.F, one.G, *one.H), (other.F, other.G, *other.H), strict=True))
    elif one.A is not None:
        pairs = _pairs(one.A, other.A)
    else:
        pairs = [*_pairs(one.K, other.K), *_pairs(one.C, other.C)]
    return max(
        float(np.max(np.abs(a - b)) / max(np.max(np.abs(a)), np.max(np.abs(b)), SMALLEST))
        for a, b in pairs
    )


def _pairs(one: Fourier, other: Fourier) -> list[tuple[Any, Any]]:
    """Coefficients by harmonic, 0 where there is none."""
    none = np.zeros_like(one.mean)
    waves = ((one.cos, other.cos), (one.sin, other.sin))
    return [(one.mean, other.mean)] + [
        (a.get(k, none), b.get(k, none)) for a, b in waves for k in {*a, *b}
    ]
