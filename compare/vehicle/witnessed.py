"""A band's worst Omega in the time domain, with the witness's own matrices."""

from dataclasses import dataclass
from typing import Any

from compare.vehicle.near import Band
from floquet import monodromy
from floquet.witness import maker, rougher_maker
from hill.oscillations.pair import pair
from hill.oscillations.steady import Steady, steady
from hill.stability import Verdict

# On what the last refinement of the witness's elements moved T by.
SAFETY = 4.0


@dataclass(frozen=True)
class Witnessed:
    """What the time domain says of a band.

    Attributes
    ----------
    T, T_error : float
        Of the whole vehicle, and a bound for its matrices as they are.
    discretisation : float
        An estimate of what the elements leave of T.
    verdict : {"stable", "unstable", "undecided"}
    agrees : bool
        Whether T is the band's within all errors, or more, where another oscillation grows more
        than its two.
    another : bool
        Whether it is more.
    """

    T: float
    T_error: float
    discretisation: float
    verdict: Verdict
    agrees: bool
    another: bool


def witnessed(system: Any, gamma: float, eta: float, band: Band, alone: Steady) -> Witnessed:
    """Integrate the witness's own equation at the band's worst Omega."""
    make, rougher = maker(system), rougher_maker(system)
    own = make(system, band.Omega, gamma, eta) if make else system.equation(band.Omega, gamma, eta)
    found = monodromy(own)
    elements = 0.0
    if rougher is not None:
        rough = rougher(system, band.Omega, gamma, eta)
        one, other = (pair(e, band.resonance, steady(e)) for e in (own, rough))
        elements = SAFETY * (abs(one.T - other.T) + one.error + other.error)
    allowed = found.T_error + band.T_error + elements
    return Witnessed(
        T=found.T,
        T_error=found.T_error,
        discretisation=elements,
        verdict=found.verdict,
        agrees=bool(band.T - allowed <= found.T),
        another=bool(band.T + allowed < found.T),
    )
