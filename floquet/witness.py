"""Which systems the witness has matrices of its own for, made by other means than theirs."""

from collections.abc import Callable
from typing import Any

from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam

Make = Callable[..., HillEquation]
"""make(system, Omega, gamma, eta): the equation, its matrices found by the witness's own means."""

_MAKERS: dict[type, Make] = {UniformBeam: galerkin, SteppedBeam: galerkin}


def register(kind: type, make: Make) -> None:
    """Let `make(system, Omega, gamma, eta)` be the witness's matrices of systems of this type."""
    _MAKERS[kind] = make


def maker(system: Any) -> Make | None:
    """What makes the witness's own matrices of the system; None where both routes share its own."""
    return _MAKERS.get(type(system))
