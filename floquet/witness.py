"""The witness's own matrices of a system, made by other means than the system's own."""

from collections.abc import Callable
from typing import Any

from floquet.galerkin import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam
from hill.system import System

Make = Callable[..., HillEquation]

_MAKERS: dict[type, Make] = {UniformBeam: galerkin, SteppedBeam: galerkin}


def register(kind: type, make: Make) -> None:
    """Let `make(system, Omega, gamma, eta)` be the witness's matrices of systems of this type."""
    _MAKERS[kind] = make


def has_own_matrices(system: Any) -> bool:
    """Whether the witness makes its own matrices of the system, or takes the system's."""
    return type(system) in _MAKERS


def equation(
    system: System, Omega: float, gamma: float, eta: float = 0.0, **more: Any
) -> HillEquation:
    """The system's equation with the witness's matrices, or the system's where it has no own."""
    make = _MAKERS.get(type(system))
    if make is None:
        found: HillEquation = system.equation(Omega, gamma, eta, **more)
        return found
    return make(system, Omega, gamma, eta, **more)
