"""The methods there are; a further one is a file beside this and a line in `METHODS`."""

from dataclasses import dataclass
from typing import Protocol

from floquet.arrays import Float
from floquet.integrate.cvodes import Cvodes
from floquet.integrate.ode import Parameters, Shape
from floquet.integrate.parts import PartsMethod
from floquet.integrate.parts_cvodes import PartsCvodes
from floquet.integrate.parts_taylor import PartsTaylor
from floquet.integrate.taylor import Taylor


class Propagator(Protocol):
    """A way to integrate the matrix equation from 0 to `time`."""

    def __call__(self, p: Parameters, size: Shape, time: float) -> Float:
        """Return the fundamental matrix of (q, q') at `time`, shape (2n, 2n)."""
        ...


@dataclass(frozen=True)
class Method:
    """How the period is integrated, and how that is checked.

    Attributes
    ----------
    run : Propagator
    check : Propagator
        The same with other steps, or by another method that overflow does not escape.
    parts, parts_check : PartsMethod
        The same for the parts of the period of a general equation.
    """

    run: Propagator
    check: Propagator
    parts: PartsMethod
    parts_check: PartsMethod


METHODS: dict[str, Method] = {
    "taylor": Method(
        run=Taylor(), check=Taylor(order=29), parts=PartsTaylor(), parts_check=PartsTaylor(order=29)
    ),
    # Two tolerances of SUNDIALS leave errors much alike, whose difference bounds neither: a hundred
    # times the tolerance and a floor bounded them, 8,000 times too large in the median. A Taylor
    # run is off by so much less that the difference from it is the error: of parts, on 40 systems
    # held against balls, .125 of what is reported for it, the factor on a difference being 8.
    "cvodes": Method(
        run=Cvodes(1e-14),
        check=Taylor(order=29),
        parts=PartsCvodes(1e-14),
        parts_check=PartsTaylor(order=29),
    ),
}
