"""Who computes what DRIVER prints: the report's program as run, or one of the two routes."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.report.program import listing
from compare.report.program.listing import RIGID, Case, Stab, Stepped, Uniform
from floquet import monodromy
from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic

Float = NDArray[np.floating[Any]]
Program = Uniform | Stepped

# The printed output was made without compliance for OMEGL > 50 (DRIVER sets G = F there), though
# the uniform DETER as listed, which tests OMEGB, would bring it back: T at 5.003 is 6e-5 off then.
# `listing` is the text as listed. At this OMEGL, (OMEGB/OMEGL)**2 is below 3e-7 and
# (1 - cos X)/(X sin X) still has ten digits.
NO_COMPLIANCE = 1e4

# OMEGL is printed with two decimals: half a unit.
HALF_UNIT = 0.005


@dataclass(frozen=True)
class Evaluator:
    """One way to compute.

    Attributes
    ----------
    name : str
    frequencies : callable
        (constants, case, count) -> `count` natural frequencies; without the rotation where there
        is one less than coordinates.
    stab : callable
        (constants, case, OMEGB) -> Stab.
    """

    name: str
    frequencies: Callable[[Program, Case, int], tuple[float, ...]]
    stab: Callable[[Program, Case, float], Stab]


def as_run(constants: Program, case: Case, OMEGB: float) -> Stab:
    """The report's program."""
    rigid = case.RC is None and case.OMEGL > RIGID and case.GA == 0.0
    case = replace(case, OMEGL=max(case.OMEGL, NO_COMPLIANCE)) if rigid else case
    return listing.stab(constants, case, OMEGB)


def by_hill(constants: Program, case: Case, OMEGB: float) -> Stab:
    """The converged determinant, matrices in closed form."""
    c = characteristic(beam(case, OMEGB).equation(OMEGB, case.GAMMA, case.ETA, _terms(case)))
    return Stab(OMEGB, c.z, c.T, 0)


def by_floquet(constants: Program, case: Case, OMEGB: float) -> Stab:
    """The monodromy matrix, matrices by quadrature."""
    equation = galerkin(beam(case, OMEGB), OMEGB, case.GAMMA, case.ETA, _terms(case))
    m = monodromy(equation)
    return Stab(OMEGB, m.z, m.T, 0)


def beam(case: Case, OMEGB: float | None = None) -> UniformBeam | SteppedBeam:
    """The beam of a case; where Q is omega_L/Omega, omega_L is made that multiple exactly."""
    omega_L = case.OMEGL
    if case.Q and OMEGB is not None:
        if abs(omega_L - case.Q * OMEGB) > HALF_UNIT:
            raise ValueError(
                f"FQ = {case.Q} says that OMEGL is {case.Q} OMEGB = {case.Q * OMEGB:.4f}, and it "
                f"is {omega_L:g}: initial conditions have no common period with the thrust then"
            )
        omega_L = case.Q * OMEGB
    common: dict[str, Any] = {
        "T0": case.TO,
        "K_theta": case.SPC,
        "xi_G": case.XG,
        "omega_L": omega_L,
    }
    if case.RC is None:
        return UniformBeam(**common, g=case.GA)
    return SteppedBeam(**common, xi_c=case.RC, area_ratio=case.RA, inertia_ratio=case.RI)


def _terms(case: Case) -> int:
    return case.S if case.Q else 0


def _frequencies_as_run(constants: Program, case: Case, count: int) -> tuple[float, ...]:
    # F depends on neither OMEGL nor OMEGB
    F, _, _ = listing.coefficients(constants, replace(case, OMEGL=NO_COMPLIANCE), 1.0)
    return _signs_dropped(F, count)


def _frequencies(make: Callable[..., HillEquation]) -> Callable[..., tuple[float, ...]]:
    def of(constants: Program, case: Case, count: int) -> tuple[float, ...]:
        F = make(replace(case, Q=0, GA=0.0, OMEGL=NO_COMPLIANCE)).F
        return _signs_dropped(F - 0.25 * case.ETA**2 * np.eye(len(F)), count)

    return of


def _signs_dropped(F: Float, count: int) -> tuple[float, ...]:
    """Square roots of the sizes of F's eigenvalues, ascending by the eigenvalues, as DRIVER."""
    squares = np.sort(np.linalg.eigvals(F[:count, :count]).real)
    return tuple(np.sqrt(np.abs(squares)).tolist())


EVALUATORS = {
    "as-run": Evaluator("as-run", _frequencies_as_run, as_run),
    "hill": Evaluator("hill", _frequencies(lambda case: beam(case).equation(1.0, 0.0)), by_hill),
    "floquet": Evaluator(
        "floquet", _frequencies(lambda case: galerkin(beam(case), 1.0, 0.0)), by_floquet
    ),
}
