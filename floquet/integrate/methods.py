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
        The same with other steps or another tolerance.
    floor : float
        What `run` may be off without `check` showing it, over the size of the terms summed.
    most_decay : float
        The damped equation itself is only checked where it decays by less than exp of this.
    diverges : bool
        Whether overflow is not told by itself, so that a Taylor run has to tell first.
    parts, parts_check : PartsMethod
        The same for the parts of the period of a general equation.
    parts_floor : float
        As `floor`, for them.
    """

    run: Propagator
    check: Propagator
    parts: PartsMethod
    parts_check: PartsMethod
    floor: float = 0.0
    most_decay: float = float("inf")
    diverges: bool = False
    parts_floor: float = 0.0


METHODS: dict[str, Method] = {
    "taylor": Method(
        run=Taylor(), check=Taylor(order=29), parts=PartsTaylor(), parts_check=PartsTaylor(order=29)
    ),
    # A tenth of the tolerance leaves errors much alike, whose difference bounds neither. SUNDIALS'
    # tolerance is local: errors of 1e-14 a step add up alike in both, which is the floor. Its
    # absolute tolerance leaves nothing of what decays by more than exp(5).
    "cvodes": Method(
        run=Cvodes(1e-14),
        check=Cvodes(1e-12),
        parts=PartsCvodes(1e-14),
        parts_check=PartsCvodes(1e-12),
        floor=1e-12,
        most_decay=5.0,
        diverges=True,
        parts_floor=1e-13,
    ),
}
