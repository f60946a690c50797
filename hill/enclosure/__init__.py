"""P, its roots and T as balls that hold the true values, by Hill's determinant; python-flint."""

from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np

from hill.beams import SteppedBeam, UniformBeam
from hill.decimals import Number, exact_beam
from hill.equation import HillEquation
from hill.periodic import PeriodicEquation

if TYPE_CHECKING:
    from hill.enclosure.result import Enclosure

NO_BALLS = "enclosures need python-flint: pip install 'floquet-crosscheck[proof]'"

# Where damping pulsates, or of first order, rows fall like 1/m: no trace norm, no geometric series.
NO_Z = "the determinant is enclosed for equations with z only; floquet.enclose does without"


def enclose(
    what: HillEquation | UniformBeam | SteppedBeam,
    *,
    Omega: Number | None = None,
    gamma: Number | None = None,
    eta: Number = 0.0,
    initial_terms: int = 0,
    ratio: int | None = None,
    bits: int = 100,
) -> "Enclosure":
    """Enclose the characteristic polynomial P(z), its roots and T by the infinite determinant.

    The determinant is folded from outside; the product of all that lies beyond is a series in
    Hurwitz's zeta functions whose remainder is bounded by Cauchy's estimate (docs/theory.md, 12).

    Parameters
    ----------
    what : HillEquation, UniformBeam or SteppedBeam
        An equation is taken with its floats as they are. A beam is taken with its parameters as
        they are written in decimals, and its matrices are closed forms in ball arithmetic.
    Omega, gamma, eta : float, str or Fraction
        The forcing of a beam; an equation has its own.
    initial_terms, ratio : int, optional
        Of a beam: how many H_s there are, and omega_L as an exact multiple of Omega.
    bits : int, optional
        To which P's coefficients are known, of the largest.

    Returns
    -------
    Enclosure

    Raises
    ------
    ValueError
        python-flint is not there; a forcing beside an equation, or none for a beam; a number out of
        range; an equation without z; one that takes more harmonics or digits than are spent.
    """
    if find_spec("flint") is None:
        raise ValueError(NO_BALLS)
    from hill.enclosure import prove

    if isinstance(what, HillEquation):
        if Omega is not None or gamma is not None or eta != 0 or initial_terms or ratio is not None:
            raise ValueError("Omega, gamma, eta: an equation has its own; leave them out")
        if np.ndim(what.eta) > 0:
            raise ValueError(f"eta is a matrix: {NO_Z}")
        return prove.of_equation(what, bits)
    if isinstance(what, PeriodicEquation):
        raise ValueError(f"PeriodicEquation: {NO_Z}")
    if not isinstance(what, UniformBeam | SteppedBeam):
        raise ValueError(
            f"{type(what).__name__}: must be a HillEquation, a UniformBeam or a SteppedBeam"
        )
    if Omega is None or gamma is None:
        raise ValueError(f"{'Omega' if Omega is None else 'gamma'}: must be given for a beam")
    given, under = exact_beam(what, Omega, gamma, eta, initial_terms, ratio)
    return prove.of_beam(given, under, bits)
