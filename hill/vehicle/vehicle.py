"""A vehicle: sections, masses, thrust, control and damping; data that both routes share."""

import math
from dataclasses import dataclass, replace
from itertools import accumulate
from pathlib import Path
from typing import Literal

from hill import checks
from hill.arrays import Complex, Float
from hill.equation import HillEquation
from hill.periodic import PeriodicEquation
from hill.system import Parameter
from hill.toml import one_of
from hill.vehicle.parts import LARGEST_G, Damping, PointMass, Section, Sensor, Thrust
from hill.vehicle.units import Units, checked
from hill.vehicle.validate import End, ends, items, on_board, on_vehicle
from hill.vehicle.vary import varied, varying

AxialDamping = Literal["report", "hysteretic"]
AXIAL_DAMPING = ("report", "hysteretic")

MAX_MODES = 60
"""An equation of more coordinates takes either route minutes."""

UNLOADED, UNDAMPED, SI = Thrust(), Damping(), Units()


@dataclass(frozen=True, kw_only=True)
class Vehicle:
    """A beam of any sections, pushed toward its nose by a gimbaled, pulsating thrust.

    Stations count from the nose, x = 0, to the aft end, x = `length`; the deflection y and the
    rotation psi = y' are the report's. All numbers are in one consistent set of units.

    The axial force P, compression positive, holds the vehicle's inertia in steady acceleration:
    ahead of the thrust it is T0 times the share of the mass ahead of x, behind it that less T0.
    Where an end is pinned or clamped that end takes the thrust (the nose, if both are): P is T0
    between the thrust and a held nose, -T0 between the thrust and a held aft end, 0 beyond, and
    nothing else.

    Parameters
    ----------
    sections : sequence of Section
        From the nose to the aft end.
    masses : sequence of PointMass, optional
    ends : (str, str), optional
        Nose and aft end, each "free", "pinned" or "clamped"; free and free by default.
    thrust : Thrust, optional
    sensors : sequence of Sensor, optional
        What turns the gimbal; none by default.
    servo_time : float, optional
        Time constant of a servo of first order between the sensors' sum and the gimbal's angle; 0
        by default, the gimbal follows at once.
    damping : Damping, optional
    g : float, optional
        Structural damping of the axial vibration; it matters where EA is finite.
    axial_damping : {"report", "hysteretic"}, optional
        In the axial vibration Omega^2 is replaced by ``Omega^2 - i g omega_L^2`` (4.2.34), omega_L
        the vehicle's lowest axial frequency; or by ``Omega^2/(1 + i g)``, that is EA (1 + i g).
    quadrature_force : bool, optional
        Keep the sine part of the damped axial force, which (4.2.39) drops. True by default.
    units : Units or str, optional
        "SI" by default.
    modes : int, optional
        N, the number of elastic modes kept; a free or a once pinned vehicle has a rotation besides.

    Raises
    ------
    ValueError
        A parameter out of range, by name; a mass, sensor or thrust outside the vehicle.
    """

    sections: tuple[Section, ...]
    masses: tuple[PointMass, ...] = ()
    ends: tuple[End, End] = ("free", "free")
    thrust: Thrust = UNLOADED
    sensors: tuple[Sensor, ...] = ()
    servo_time: float = 0.0
    damping: Damping = UNDAMPED
    g: float = 0.0
    axial_damping: AxialDamping = "report"
    quadrature_force: bool = True
    units: Units = SI
    modes: int = 4

    def __post_init__(self) -> None:
        checks.store(
            self,
            sections=items("sections", self.sections, Section),
            ends=ends(self.ends),
            servo_time=checks.between("servo_time", self.servo_time, 0.0, math.inf),
            g=checks.between("g", self.g, 0.0, LARGEST_G),
            units=checked(self.units),
            modes=checks.count("modes", self.modes, least=1, most=MAX_MODES),
        )
        if not self.sections:
            raise ValueError("sections: must be at least one")
        if self.axial_damping not in AXIAL_DAMPING:
            raise ValueError(
                f"axial_damping = {self.axial_damping!r}: "
                f"{one_of(str(self.axial_damping), AXIAL_DAMPING)}"
            )
        if not isinstance(self.quadrature_force, bool):
            raise ValueError(f"quadrature_force = {self.quadrature_force!r}: must be true or false")
        for name, kind in (("thrust", Thrust), ("damping", Damping)):
            if not isinstance(getattr(self, name), kind):
                raise ValueError(f"{name} = {getattr(self, name)!r}: must be a {kind.__name__}")
        station = self.thrust.station
        checks.store(
            self,
            masses=on_board(self.length, "masses", items("masses", self.masses, PointMass)),
            sensors=on_board(self.length, "sensors", items("sensors", self.sensors, Sensor)),
            thrust=self.thrust
            if station is None
            else replace(self.thrust, station=on_vehicle("thrust.station", station, self.length)),
        )
        matrix = self.damping.matrix
        if matrix is not None and len(matrix) != self.coordinates:
            raise ValueError(
                f"damping.matrix has {len(matrix)} rows: must have {self.coordinates}, "
                f"one for each of {self.modes} modes"
                + (" and the rotation" if self.coordinates > self.modes else "")
            )

    @classmethod
    def from_file(cls, path: str | Path) -> "Vehicle":
        """A vehicle from a TOML file.

        Raises
        ------
        ValueError
            The file cannot be read or says something that is not understood: one line with file,
            key and value.
        """
        from hill.vehicle.file import read

        return read(Path(path))

    # ---- geometry -------------------------------------------------------------------------------

    @property
    def edges(self) -> tuple[float, ...]:
        """Stations where sections begin and end, (sections + 1,), from 0 to `length`."""
        return tuple(accumulate((s.length for s in self.sections), initial=0.0))

    @property
    def length(self) -> float:
        """The aft end's station."""
        return self.edges[-1]

    @property
    def thrust_station(self) -> float:
        """Where the thrust acts."""
        return self.length if self.thrust.station is None else self.thrust.station

    @property
    def rotates(self) -> bool:
        """Whether there is a rigid rotation: free at both ends, or pinned at one and else free."""
        return "free" in self.ends and "clamped" not in self.ends

    @property
    def coordinates(self) -> int:
        """Coordinates of the equation: the modes, and the rotation if there is one."""
        return self.modes + self.rotates

    @property
    def rigid_axially(self) -> bool:
        """Whether every EA is infinite."""
        return all(math.isinf(s.EA[0]) for s in self.sections)

    # ---- as a system ----------------------------------------------------------------------------

    @property
    def depends_on_Omega(self) -> bool:
        """Whether the pulsating matrices move with Omega, as with a finite EA."""
        return not self.rigid_axially

    @property
    def frequency_names(self) -> tuple[str, ...]:
        """Of the coordinates: the rotation first, as in the report, then bending."""
        return (*(("B",) if self.rotates else ()), *(str(n) for n in range(1, self.modes + 1)))

    @property
    def values(self) -> dict[str, float]:
        """Every number that may be varied, by its name."""
        return {p.name: value for p, value in varying(self)}

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What may be varied."""
        return tuple(p for p, _ in varying(self))

    def varied(self, **values: float) -> "Vehicle":
        """The same with other values of some parameters."""
        return varied(self, values)

    def damping_apart(self) -> tuple["Vehicle", float]:
        """The same without ``damping.eta``, and that."""
        return replace(self, damping=replace(self.damping, eta=0.0)), self.damping.eta

    def equation(
        self, Omega: float, gamma: float, eta: float = 0.0
    ) -> HillEquation | PeriodicEquation:
        """The equation under a pulsating thrust, ``mean (1 + gamma cos Omega t)``.

        Its coordinates are the mass-normalised exact modes of the vehicle without thrust, the
        deflection at the aft end positive (the rotation at a pinned one, the moment at a clamped
        one), and the rigid rotation after them. Everything is in the vehicle's unit of time.

        Parameters
        ----------
        Omega : float
            Radians per unit of time, > 0.
        gamma : float
        eta : float, optional
            Damping in addition to the vehicle's own, 1/time.

        Returns
        -------
        HillEquation
            Where the damping is one number and nothing turns the gimbal by a rate.
        PeriodicEquation
            Otherwise: of second order with modal damping, rates, or the sine part of a damped
            axial force; of first order, of (q, q', the gimbal's angle), with a servo.
            ``data_error`` is what the modes and the integrals are known to.

        Raises
        ------
        ValueError
            A parameter out of range; an undamped longitudinal resonance.
        """
        from hill.vehicle.equations import equation

        return equation(self, Omega, gamma, eta)

    def natural_frequencies(self) -> Float | Complex:
        """Under the mean thrust without damping, radians per unit of time.

        Returns
        -------
        (coordinates,) ndarray
            Ascending by real part; complex where the vehicle is unstable. The gimbal follows at
            once and rates are left out.
        """
        from hill.vehicle.equations import natural_frequencies

        return natural_frequencies(self)

    def frequencies(self, *, under_thrust: bool = False) -> Float | Complex:
        """Cycles per unit of time, Hz where that is the second.

        Parameters
        ----------
        under_thrust : bool, optional
            As `natural_frequencies`; else of the elastic modes without thrust, (modes,).
        """
        from hill.vehicle.equations import unloaded_frequencies

        found = self.natural_frequencies() if under_thrust else unloaded_frequencies(self)
        return found / (2.0 * math.pi)
