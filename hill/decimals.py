"""A beam and its forcing as exact fractions, for those who prove something about them.

A float stands for the shortest decimal that is read as it: 0.1 is 1/10. So what is proven holds for
the numbers as they are written, and not for their nearest neighbours in binary.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from hill import checks
from hill.beams import SteppedBeam, UniformBeam
from hill.errors import LongitudinalResonance

Number = float | str | Fraction


@dataclass(frozen=True)
class ExactBeam:
    """What the matrices F, G and H_s are made of.

    Attributes
    ----------
    stepped : bool
    modes : int
    T0, K_theta, xi_G, xi_c, area_ratio, inertia_ratio, g : Fraction
        As of the beams; a uniform one has no step: 0, 1 and 1.
    sigma : Fraction
        Omega/omega_L.
    gamma : Fraction
    terms : int
        How many H_s there are.
    """

    stepped: bool
    modes: int
    T0: Fraction
    K_theta: Fraction
    xi_G: Fraction
    xi_c: Fraction
    area_ratio: Fraction
    inertia_ratio: Fraction
    g: Fraction
    sigma: Fraction
    gamma: Fraction
    terms: int


@dataclass(frozen=True)
class ExactForcing:
    """The rest of the equation: Omega, the damping eta, and omega_L/Omega where that is whole."""

    Omega: Fraction
    eta: Fraction
    ratio: int


def fraction(name: str, value: Number) -> Fraction:
    """A number as it is written.

    Parameters
    ----------
    name : str
        What it is, for the message.
    value : float, str or Fraction
        "0.383" and 0.383 are 383/1000.

    Raises
    ------
    ValueError
        It is no finite number.
    """
    if isinstance(value, Fraction):
        return value
    if isinstance(value, str):
        try:
            return Fraction(value)
        except (ValueError, ZeroDivisionError):
            raise ValueError(f"{name} = {value!r}: must be a decimal number") from None
    return Fraction(repr(checks.number(name, value)))


def exact_beam(
    beam: UniformBeam | SteppedBeam,
    Omega: Number,
    gamma: Number,
    eta: Number = 0.0,
    initial_terms: int = 0,
    ratio: int | None = None,
) -> tuple[ExactBeam, ExactForcing]:
    """A beam under a forcing, in fractions.

    Parameters
    ----------
    beam : UniformBeam or SteppedBeam
    Omega, gamma, eta : float, str or Fraction
    initial_terms : int, optional
        How many H_s; they need a whole omega_L/Omega.
    ratio : int, optional
        omega_L is exactly so many times Omega, whatever the beam's own is rounded to.

    Raises
    ------
    ValueError
        A number out of range; `initial_terms` without a common period; the quarter-period part of
        the force, which the report's equation does not have.
    LongitudinalResonance
        The undamped axial force of a uniform beam is infinite.
    """
    at, damping = fraction("Omega", Omega), fraction("eta", eta)
    if at <= 0:
        raise ValueError(f"Omega = {Omega}: must be > 0")
    terms = checks.count("initial_terms", initial_terms, least=0)
    uniform = isinstance(beam, UniformBeam)
    if isinstance(beam, UniformBeam) and beam.quadrature_force:
        raise ValueError("quadrature_force: must be False; enclose beam.equation(...) instead")
    if ratio is not None:
        ratio = checks.count("ratio", ratio, least=1)
        sigma = Fraction(1, ratio)
    elif math.isinf(beam.omega_L):
        sigma = Fraction(0)
    else:
        sigma = at / fraction("omega_L", beam.omega_L)
    if terms and (not uniform or sigma == 0 or (1 / sigma).denominator != 1):
        raise ValueError(
            f"initial_terms = {terms}: needs a uniform beam and a whole omega_L/Omega, "
            f"which is {'infinite' if sigma == 0 else 1 / sigma}"
        )
    g = _of(beam, "g", 0)
    if terms and g > 0:
        raise ValueError(f"initial_terms = {terms}: must be 0 with damping, g = {float(g):g}")
    if uniform and g == 0 and sigma and sigma.denominator == 1:
        raise LongitudinalResonance(
            f"Omega = {float(at):g} is a longitudinal resonance: the undamped axial force is "
            "infinite there"
        )
    whole = 1 / sigma if sigma else Fraction(0)
    made = ExactBeam(
        stepped=not uniform,
        modes=beam.modes,
        T0=_of(beam, "T0"),
        K_theta=_of(beam, "K_theta"),
        xi_G=_of(beam, "xi_G"),
        xi_c=_of(beam, "xi_c", 0),
        area_ratio=_of(beam, "area_ratio", 1),
        inertia_ratio=_of(beam, "inertia_ratio", 1),
        g=g,
        sigma=sigma,
        gamma=fraction("gamma", gamma),
        terms=terms,
    )
    return made, ExactForcing(at, damping, int(whole) if whole.denominator == 1 else 0)


def _of(beam: Any, name: str, otherwise: int = 0) -> Fraction:
    return fraction(name, vars(beam)[name]) if name in vars(beam) else Fraction(otherwise)
