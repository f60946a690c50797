"""From an equation or a beam to its enclosure."""

from typing import Any

from flint import ctx

from hill.decimals import ExactBeam, ExactForcing
from hill.enclosure import beams
from hill.enclosure.polynomial import polynomial
from hill.enclosure.result import Enclosure
from hill.enclosure.rows import Rows, floats, number, rows
from hill.enclosure.verdict import BITS, judged
from hill.equation import HillEquation


def of_equation(equation: HillEquation, bits: int) -> Enclosure:
    """Of floats as they are."""

    def make() -> Rows:
        pulses = {1: floats(equation.G) * number(equation.gamma)}
        for s, H in enumerate(equation.H, start=1):
            p = s * equation.ratio
            pulses[p] = pulses[p] + floats(H) if p in pulses else floats(H)
        return rows(floats(equation.F), pulses, number(equation.Omega), number(equation.damping))

    return _enclosed(make, bits, equation.Omega, equation.damping, decimals=False)


def of_beam(given: ExactBeam, under: ExactForcing, bits: int) -> Enclosure:
    """Of the parameters as they are written."""

    def make() -> Rows:
        F, G, H = beams.matrices(given, ctx.prec)
        pulses = {1: G * number(given.gamma)}
        for s, h in enumerate(H, start=1):
            p = s * under.ratio
            pulses[p] = pulses[p] + h if p in pulses else h
        return rows(F, pulses, number(under.Omega), number(under.eta))

    return _enclosed(make, bits, under.Omega, under.eta, decimals=True)


def _enclosed(make: Any, bits: int, Omega: Any, eta: Any, *, decimals: bool) -> Enclosure:
    P, beyond = polynomial(make, bits)
    with ctx.workprec(BITS):
        roots, T, verdict = judged(P, number(Omega), number(eta))
    return Enclosure(
        polynomial=tuple(P),
        roots=roots,
        T=T,
        verdict=verdict,
        decimals=decimals,
        harmonics=beyond.start,
        tail=float(beyond.left_out),
    )
