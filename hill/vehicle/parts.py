"""The parts of a vehicle: data only, each validated where it is made."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from hill import checks

Linear = tuple[float, float]
"""Values at a section's start and end, linear between them."""

Direction = Literal["follower", "fixed"]
DIRECTIONS = ("follower", "fixed")

# exp(pi sqrt(g)) must not overflow; a structure's g is below 1.
LARGEST_G = 1e4


@dataclass(frozen=True, init=False)
class Section:
    """A stretch of the vehicle whose properties are uniform or linear along it.

    Each property is a number, or [start, end] and linear between. They are stored as (start, end).

    Parameters
    ----------
    length : float
    mass_per_length : float or [float, float]
    EI : float or [float, float]
        Bending stiffness.
    EA : float or [float, float], optional
        Axial stiffness; infinite by default, the section is rigid along its axis.
    rotary_inertia : float or [float, float], optional
        Mass moment of inertia of the cross-section about its neutral axis, per length (rho I).
    kGA : float or [float, float], optional
        Shear stiffness; infinite by default, cross-sections stay normal to the axis.
    name : str, optional

    Raises
    ------
    ValueError
        A length, mass or stiffness that is not greater than 0, a negative rotary inertia.
    """

    length: float
    mass_per_length: Linear
    EI: Linear
    EA: Linear
    rotary_inertia: Linear
    kGA: Linear
    name: str

    def __init__(
        self,
        length: float,
        mass_per_length: float | Sequence[float],
        EI: float | Sequence[float],
        EA: float | Sequence[float] = math.inf,
        *,
        rotary_inertia: float | Sequence[float] = 0.0,
        kGA: float | Sequence[float] = math.inf,
        name: str = "",
    ) -> None:
        checks.store(
            self,
            length=checks.positive("length", length),
            mass_per_length=_linear("mass_per_length", mass_per_length),
            EI=_linear("EI", EI),
            EA=_linear("EA", EA, or_infinite=True),
            rotary_inertia=_linear("rotary_inertia", rotary_inertia, or_zero=True),
            kGA=_linear("kGA", kGA, or_infinite=True),
            name=str(name),
        )


@dataclass(frozen=True)
class PointMass:
    """A rigid mass at a station.

    Parameters
    ----------
    station : float
        Distance from the nose.
    mass : float
        >= 0; 0 only with a rotary inertia.
    rotary_inertia : float, optional
        About its own centre, which is on the axis.
    name : str, optional
    """

    station: float
    mass: float
    rotary_inertia: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        inertia = checks.number("rotary_inertia", self.rotary_inertia)
        if inertia < 0.0:
            raise ValueError(f"rotary_inertia = {inertia:g}: must be at least 0")
        checks.store(
            self,
            station=checks.number("station", self.station),
            mass=(
                checks.positive("mass", self.mass)
                if inertia == 0.0
                else checks.between("mass", self.mass, 0.0, math.inf)
            ),
            rotary_inertia=inertia,
            name=str(self.name),
        )


@dataclass(frozen=True)
class Thrust:
    """What pushes the vehicle toward its nose: ``mean (1 + gamma cos Omega t)``.

    Parameters
    ----------
    mean : float
        T0, a force; a negative one pulls.
    station : float, optional
        Where it acts, from the nose; the aft end by default.
    direction : {"follower", "fixed"}, optional
        Along the rotated cross-section at its station, as an engine's, or along the undeformed
        axis. The gimbal turns it from there.
    """

    mean: float = 0.0
    station: float | None = None
    direction: Direction = "follower"

    def __post_init__(self) -> None:
        if self.direction not in DIRECTIONS:
            raise ValueError(f"direction = {self.direction!r}: must be one of follower, fixed")
        checks.store(
            self,
            mean=checks.number("mean", self.mean),
            station=None if self.station is None else checks.number("station", self.station),
        )


@dataclass(frozen=True)
class Sensor:
    """A sensor of rotation and of its rate; the gimbal turns by the sum over all sensors.

    ``K_theta psi(station) + K_rate psi'(station)``, psi the rotation of the cross-section and psi'
    its rate. Positive gains turn a free vehicle back, as in Eq. (4.1.5).

    Parameters
    ----------
    station : float
        From the nose.
    K_theta : float, optional
        Gimbal angle over rotation.
    K_rate : float, optional
        Gimbal angle over rate of rotation, a time.
    """

    station: float
    K_theta: float = 0.0
    K_rate: float = 0.0

    def __post_init__(self) -> None:
        checks.store(
            self,
            **{name: checks.number(name, getattr(self, name)) for name in self.__annotations__},
        )


@dataclass(frozen=True, init=False)
class Damping:
    """Lateral damping: modal ratios, one number, a matrix; what is given adds up.

    Parameters
    ----------
    ratios : float or sequence of float, optional
        Of critical damping, in the modes of the vehicle without thrust: mode j decays with
        ``2 ratio_j omega_j``. One number is for every mode; of a list the last goes on for the
        modes beyond it. A rigid rotation has none.
    eta : float, optional
        Viscous damping over mass per length, 1/time, as in Eq. (4.4.14), on every coordinate.
    matrix : (n, n) array_like, optional
        Modal damping, 1/time, in the equation's coordinates, the mass-normalised elastic modes,
        ascending, and then the rigid rotation if there is one. It fixes the number of modes.
    """

    ratios: tuple[float, ...]
    eta: float
    matrix: tuple[tuple[float, ...], ...] | None

    def __init__(
        self, ratios: float | Sequence[float] = (), eta: float = 0.0, matrix: Any = None
    ) -> None:
        given = list(ratios) if isinstance(ratios, (list, tuple, np.ndarray)) else [ratios]
        square = None if matrix is None else checks.square("matrix", matrix)
        checks.store(
            self,
            ratios=tuple(
                checks.number("ratios" if len(given) == 1 else f"ratios[{k}]", x)
                for k, x in enumerate(given, start=1)
            ),
            eta=checks.number("eta", eta),
            matrix=None if square is None else tuple(map(tuple, square.tolist())),
        )


def _linear(name: str, value: Any, *, or_infinite: bool = False, or_zero: bool = False) -> Linear:
    """(start, end) of a property, from one number or two."""
    pair = isinstance(value, (list, tuple, np.ndarray)) and np.ndim(value) == 1
    if pair and len(value) != 2:
        raise ValueError(f"{name} = {list(value)}: must be a number, or [start, end]")
    ends = [_end(name, x, or_infinite, or_zero) for x in (value if pair else (value, value))]
    if math.isinf(ends[0]) != math.isinf(ends[1]):
        raise ValueError(f"{name} = {list(value)}: both ends must be finite, or both infinite")
    return ends[0], ends[1]


def _end(name: str, value: Any, or_infinite: bool, or_zero: bool) -> float:
    if or_zero:
        found = checks.number(name, value)
        if found < 0.0:
            raise ValueError(f"{name} = {found:g}: must be at least 0")
        return found
    return checks.positive(name, value, or_infinite=or_infinite)
