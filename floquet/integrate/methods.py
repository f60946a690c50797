"""The methods there are; a further one is a file beside this and a line in `METHODS`."""

from dataclasses import dataclass
from typing import Protocol

from floquet.arrays import Float
from floquet.integrate.cvodes import Cvodes
from floquet.integrate.ode import Parameters, Shape
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
    """

    run: Propagator
    check: Propagator
    floor: float = 0.0
    most_decay: float = float("inf")
    diverges: bool = False


METHODS: dict[str, Method] = {
    "taylor": Method(Taylor(), Taylor(order=29)),
    # A tenth of the tolerance leaves errors much alike, whose difference bounds neither. SUNDIALS'
    # tolerance is local: errors of 1e-14 a step add up alike in both, which is the floor. Its
    # absolute tolerance leaves nothing of what decays by more than exp(5).
    "cvodes": Method(Cvodes(1e-14), Cvodes(1e-12), floor=1e-12, most_decay=5.0, diverges=True),
}
