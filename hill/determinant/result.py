"""What the determinant says of an equation."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from hill.arrays import EPS, Complex, Float
from hill.determinant.general_polynomial import Polynomial, polynomial
from hill.determinant.general_values import Determinant, determinant
from hill.determinant.in_z import by_discs
from hill.determinant.on_circle import judged
from hill.determinant.roots import WELL_KNOWN, discs, improved, larger_of_pair, monic_in_y
from hill.equation import HillEquation
from hill.multipliers import Multipliers, in_discs, multipliers
from hill.notebook import of_route
from hill.periodic import PeriodicEquation
from hill.precision import remark
from hill.stability import Verdict, stability_of

Form = Literal["converged", "residues", "samples"]


@dataclass(frozen=True, eq=False)
class Characteristic:
    """The characteristic equation of a periodic system, from its infinite determinant.

    Attributes
    ----------
    polynomial : (n + 1,) float ndarray
        P(z), monic, highest power first. Of a `PeriodicEquation`, and with a damping matrix, which
        have no z, the polynomial of the multipliers themselves, (m + 1,).
    errors : (n + 1,) float ndarray
        Bound on the absolute error of each coefficient of `polynomial`, for the matrices to the
        last bit as they are given.
    data_error : float
        What the equation's own `data_error` may add to that; 0 where it has none. An estimate with
        a safety factor: to first order, of which it is .67 at least where that was measured, for
        matrices that are off by half of what they say at most. The rounding of 66 random beams
        moved P by .007 of it at most.
    z : (n,) complex ndarray
        The characteristic values cos 2 pi alpha (6.3.8), by descending real part; empty where
        `polynomial` is that of the multipliers.
    multipliers : (m,) complex ndarray
        By descending modulus.
    exponents : (m,) complex ndarray
        ln of the multipliers over the period, in the same order: the solutions of q grow like
        their exponentials.
    exponent_errors : (m,) float ndarray
        Bounds on the absolute errors of `exponents` that `errors` allow; infinite where a
        multiplier may be 0 for all that is known.
    T : float
        Characteristic argument (7.1.1): twice the largest growth exponent, over ``omega_1``.
    T_error : float
        Bound on the error of `T` that `errors` allow; large where two z, or two multipliers, meet.
    verdict : {"stable", "unstable", "undecided"}
        What the polynomial and its errors show: no growth, all z real, simple and within (-1, 1) or
        every multiplier within the unit circle; growth; or neither.
    M : tuple of int
        Harmonics kept: in each determinant of the extrapolation, or for each residue K_j; of a
        `PeriodicEquation` in the one determinant there is.
    form : {"converged", "residues", "samples"}
        How `polynomial` was obtained.
    remark : str
        What of all this is known to less than nine digits, or not shown, in a sentence
        (`hill.precision`); empty where nothing is.
    """

    polynomial: Float
    errors: Float
    data_error: float
    z: Complex
    multipliers: Complex
    exponents: Complex
    exponent_errors: Float
    T: float
    T_error: float
    verdict: Verdict
    M: tuple[int, ...]
    form: Form
    remark: str

    @property
    def error(self) -> float:
        """Bound on the absolute error of every coefficient of `polynomial`: largest of `errors`."""
        return float(np.max(self.errors))

    @property
    def stable(self) -> bool:
        """Whether the system is shown to be stable."""
        return self.verdict == "stable"

    def _repr_html_(self) -> str:
        return of_route("By Hill's determinant", self)


def of_z(
    equation: HillEquation,
    polynomial: Float,
    error: float,
    data_error: float,
    M: tuple[int, ...],
    form: Form,
    d: Determinant | None = None,
) -> Characteristic:
    """From P(z); and, with the determinant, from what it says at the roots."""
    s = stability_of(polynomial, error, equation.Omega, equation.damping)
    if d is not None:
        with np.errstate(all="ignore"):
            s = by_discs(d, s, equation.Omega, equation.damping)
    outer = larger_of_pair(s.z)
    growth = np.log(outer) / equation.period
    # on the circle, and pairs stay together
    growth = np.where((s.z.imag == 0.0) & (np.abs(s.z) <= 1.0), 1j * growth.imag, growth)
    exponents = np.stack([growth, -growth], axis=1).ravel() - 0.5 * equation.damping + 0j
    off = np.repeat(_of_arccosh(s.z, s.radius) / equation.period, 2)
    off = off + 4.0 * EPS * (np.abs(exponents) + np.abs(equation.damping))
    order = np.argsort(-exponents.real, kind="stable")
    with np.errstate(over="ignore", under="ignore"):
        decay = np.exp(-0.5 * equation.damping * equation.period)
        mu = np.stack([outer, 1.0 / outer], axis=1).ravel() * decay
    return Characteristic(
        polynomial=polynomial,
        errors=np.append(0.0, np.full(len(polynomial) - 1, error)),
        data_error=data_error,
        z=s.z,
        multipliers=mu[order],
        exponents=exponents[order],
        exponent_errors=off[order],
        T=s.T,
        T_error=s.T_error,
        verdict=s.verdict,
        M=M,
        form=form,
        remark=remark(s.T, s.T_error, equation.Omega, s.verdict, polynomial, error),
    )


def of_multipliers(equation: HillEquation | PeriodicEquation) -> Characteristic:
    """From the polynomial of the multipliers."""
    # what overflows is refused, by what comes out
    with np.errstate(over="ignore", invalid="ignore"):
        d = determinant(equation)
        found = polynomial(d)
        c, errors, data = found.unscaled()
        m = multipliers(found.coefficients, found.errors, equation.period, found.log_scale)
        # where the symmetry is enough, roots need not be improved; else better ones may help it
        m = judged(equation, d, m)
        m = judged(equation, d, _by_discs(d, found, m, equation.period))
    return Characteristic(
        polynomial=c,
        errors=errors,
        data_error=float(np.max(data)),
        z=np.empty(0, complex),
        multipliers=m.mu,
        exponents=m.exponents,
        exponent_errors=m.exponent_errors,
        T=m.T,
        T_error=m.T_error,
        verdict=m.verdict,
        M=found.M,
        form="converged",
        remark=remark(m.T, m.T_error, equation.Omega, m.verdict, c, float(np.max(errors))),
    )


def _by_discs(d: Determinant, p: Polynomial, m: Multipliers, period: float) -> Multipliers:
    """What the determinant says at the roots themselves, where that is better known."""
    evaluate = monic_in_y(d)
    for improve in (False, True):
        if m.T_error * period < WELL_KNOWN:
            break
        with np.errstate(divide="ignore"):
            y = np.exp(m.exponents * period - p.log_scale)
        if np.any(y == 0.0):
            break
        found = discs(evaluate, improved(evaluate, y) if improve else y)
        other = in_discs(found.centre, found.radius, period, p.log_scale, p.errors[-1])
        verdict = m.verdict if other.verdict == "undecided" else other.verdict
        if other.T_error < m.T_error:
            m = other
        m = replace(m, verdict=verdict)
    return m


def _of_arccosh(z: Complex, radius: Float) -> Float:
    """How far arccosh moves at most, its sign and whole turns apart, as z moves within a disc.

    By its derivative 1/(z^2 - 1)^(1/2) within the disc; or, close to 1 and -1, from
    cosh w' - cosh w = 2 sinh (w' + w)/2 sinh (w' - w)/2, whose smaller factor is at most
    (radius/2)^(1/2), and |x| <= pi/2 |sinh x| for |Im x| <= pi/2.
    """
    near, far = (np.sqrt(np.maximum(np.abs(z - one) - radius, 0.0)) for one in (1.0, -1.0))
    least = near * far
    steep = np.divide(radius, least, out=np.full_like(radius, np.inf), where=least > 0.0)
    return np.minimum(steep, np.pi * np.sqrt(0.5 * radius))
