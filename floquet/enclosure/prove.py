"""From an equation or a beam to its enclosure."""

from typing import Any

import numpy as np
from flint import ctx

from floquet.enclosure import beams, general, judgement
from floquet.enclosure.balls import Problem, number, problem
from floquet.enclosure.narrow import narrowed, square
from floquet.enclosure.result import Enclosure
from hill import HillEquation, PeriodicEquation, SteppedBeam, UniformBeam
from hill.decimals import ExactBeam, ExactForcing, Number, exact_beam


def of_equation(equation: HillEquation | PeriodicEquation, bits: int) -> Enclosure:
    """Of floats as they are."""
    if isinstance(equation, PeriodicEquation):
        return enclosed(general.reference(equation, narrow=bits), equation.Omega, None)
    P = narrowed(lambda: _polynomial(problem(equation)), bits)
    eta = None if np.ndim(equation.eta) > 0 else equation.damping
    return enclosed(P, equation.Omega, eta)


def of_beam(
    beam: UniformBeam | SteppedBeam,
    forcing: tuple[Number, Number],
    eta: Number,
    initial_terms: int,
    ratio: int | None,
    bits: int,
) -> Enclosure:
    """Of the parameters as they are written."""
    given, under = exact_beam(beam, *forcing, eta, initial_terms, ratio)
    P = narrowed(lambda: _polynomial(of_decimals(given, under)), bits)
    return enclosed(P, under.Omega, under.eta, decimals=True)


def of_decimals(given: ExactBeam, under: ExactForcing) -> Problem:
    """The equation in balls, at the precision of the moment."""
    F, G, H = beams.matrices(given, ctx.prec)
    return beams.forced(F, G, H, given.gamma, under, 1 / number(under.Omega) ** 2)


def _polynomial(given: Problem) -> list[Any]:
    return list(reversed(square(given).charpoly().coeffs()))


def enclosed(P: list[Any], Omega: Any, eta: Any, *, decimals: bool = False) -> Enclosure:
    """What follows from P's balls; `eta` is None where P is of the multipliers."""
    with ctx.workprec(judgement.BITS):
        found = judgement.enclosed(P)
        growth = judgement.judged(P, Omega, eta)
    proven = growth.truth in ("stable", "unstable")
    return Enclosure(
        polynomial=tuple(P),
        of="multipliers" if eta is None else "z",
        roots=tuple(found.balls),
        simple=found.simple,
        T=growth.T,
        verdict=growth.truth if proven else "undecided",  # type: ignore[arg-type]
        decimals=decimals,
    )
