"""Which systems the witness has matrices of its own for, made by other means than theirs."""

from collections.abc import Callable
from typing import Any

from floquet.vehicle.discretise import discretised, rougher
from floquet.weak_form import galerkin
from hill import SteppedBeam, UniformBeam, Vehicle

Make = Callable[..., Any]
"""make(system, Omega, gamma, eta): the equation, its matrices found by the witness's own means."""

_MAKERS: dict[type, Make] = {UniformBeam: galerkin, SteppedBeam: galerkin, Vehicle: discretised}
_ROUGHER: dict[type, Make] = {Vehicle: rougher}


def register(kind: type, make: Make, *, rougher: Make | None = None) -> None:
    """Let `make(system, Omega, gamma, eta)` be the witness's matrices of systems of this type.

    Matrices that a discretisation makes come with `rougher`, the same from a coarser one.
    """
    _MAKERS[kind] = make
    if rougher is not None:
        _ROUGHER[kind] = rougher


def maker(system: Any) -> Make | None:
    """What makes the witness's own matrices of the system; None where both routes share its own."""
    return _MAKERS.get(type(system))


def matrices_of(system: Any) -> tuple[Make, bool]:
    """What makes the equation of a system here, and whether that is the system's own.

    The one place where the witness asks a system: where it has no matrices of its own.
    """
    make = maker(system)
    return (make, False) if make is not None else (_asked, True)


def _asked(system: Any, Omega: float, gamma: float, eta: float = 0.0) -> Any:
    return system.equation(Omega, gamma, eta)


def rougher_maker(system: Any) -> Make | None:
    """What makes them from a coarser discretisation; None where there is nothing discretised."""
    return _ROUGHER.get(type(system))
