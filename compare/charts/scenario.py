"""What a chart is of: a system, its forcing, the axes along which some of it varies."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.axis import Axis
from compare.charts.limits import checked, largest_elements, own_equation, slow_enough
from compare.stability.reading import Reading, reading_of
from compare.vehicle.damping import damping_as_forcing
from floquet.witness import maker
from hill import HillEquation, PeriodicEquation, Singular, System, Vehicle, checks
from hill.oscillations.steady import mean_frequencies
from hill.system import (
    FORCING,
    frequency_names,
    natural_frequencies,
    parameter_values,
    singular_Omega,
    varied,
)

Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]
Values = Mapping[str, float]
Equation = HillEquation | PeriodicEquation

POLE_CLEARANCE = 0.25
"""Widths of a box: a series over it whose nearest pole is farther than this converges by 2.6 a
term, whatever the residue."""

# Two floats that far apart are a pole met exactly, where neither Omega nor the pole is varied.
SAME_OMEGA = 1e-9


@dataclass(frozen=True, eq=False)
class Scenario:
    """A system under a forcing, some of whose parameters vary. Made by `scenario`.

    Attributes
    ----------
    system : System
    axes : tuple of Axis
    forcing : dict of str to float
        Omega, gamma and eta, as far as they are no axes.
    reading : Reading
        What P is a polynomial of, and how it tells stability.
    coordinates : int
        Degree of P.
    """

    system: Any
    axes: tuple[Axis, ...]
    forcing: Mapping[str, float]
    reading: Reading
    coordinates: int

    @property
    def names(self) -> tuple[str, ...]:
        """The axes' names."""
        return tuple(axis.name for axis in self.axes)

    @property
    def shared_matrices(self) -> bool:
        """Whether the witness has no matrices of its own, so that both routes get the system's."""
        return maker(self.system) is None

    @property
    def fixed(self) -> dict[str, float]:
        """The numbers of the system and the forcing that do not vary."""
        own = {k: v for k, v in parameter_values(self.system).items() if k not in self.names}
        return own | {name: float(value) for name, value in self.forcing.items()}

    def at(self, values: Values) -> tuple[Any, dict[str, float]]:
        """The system and its forcing at a point."""
        forcing = dict(self.forcing)
        forcing |= {name: float(values[name]) for name in FORCING if name in values}
        own = {name: float(value) for name, value in values.items() if name not in FORCING}
        return varied(self.system, own), forcing

    def equation(self, values: Values) -> Equation:
        """The system's own equation at a point, in the form whose polynomial is charted.

        Raises
        ------
        Singular
            There is none.
        ValueError
            The system refuses, or what it gives is no equation.
        """
        system, forcing = self.at(values)
        return self.reading.form(own_equation(system, **forcing), forcing["eta"])

    def equations(self, points: Mapping[str, Float], route: str) -> list[Equation | None]:
        """The equations at many points, their matrices made once where they are the same.

        None where there is no equation, or one whose motion is beyond `limits.MAX_RADIANS`.

        Parameters
        ----------
        points : mapping of str to (k,) ndarray
        route : {"hill", "floquet"}
            Whose matrices: the system's, or the witness's own where it has some.
        """
        make = (maker(self.system) if route == "floquet" else None) or own_equation
        systems: dict[Any, Any] = {}
        made: dict[Any, tuple[HillEquation, tuple[float, float]]] = {}
        found: list[Equation | None] = []
        own_names = [name for name in points if name not in FORCING]
        for line in zip(*points.values(), strict=True):
            values = dict(zip(points, map(float, line), strict=True))
            own = tuple(values[name] for name in own_names)
            if own not in systems:
                systems[own] = varied(self.system, {name: values[name] for name in own_names})
            system = systems[own]
            forcing = dict(self.forcing) | {k: v for k, v in values.items() if k in FORCING}
            moves = getattr(system, "depends_on_Omega", None)
            key = (own, forcing["Omega"] if moves or moves is None else None)
            known = made.get(key) if moves is not None else None
            try:
                if known is not None:  # its matrices, and how large their elements are
                    one = known[0].forced(**forcing)
                    found.append(one if slow_enough(one, known[1]) else None)
                    continue
                new = self.reading.form(make(system, **forcing), forcing["eta"])
                if isinstance(new, HillEquation) and not new.H:
                    made[key] = new, largest_elements(new)
                found.append(new if slow_enough(new) else None)
            except Singular:
                found.append(None)
        return found

    def frequencies(self, values: Values, Omega: float) -> Complex:
        """Natural frequencies at a point, ascending; `Omega` is where F is looked at.

        Of a general equation those of its mean, which need not be the system's own.
        """
        if self.reading.general:
            return mean_frequencies(self.equation({**values, "Omega": Omega}))
        return natural_frequencies(self.at({**values, "Omega": Omega})[0], Omega)

    def frequency_names(self, count: int) -> tuple[str, ...]:
        """What the system calls them, where it has as many."""
        own = getattr(self.system, "frequency_names", None)
        if self.reading.general and own is not None and len(own) != count:
            return tuple(str(k) for k in range(1, count + 1))
        return frequency_names(self.system, count)

    def singular(self, low: Values, high: Values) -> str | None:
        """The parameter to cut by where a pole is in a box of parameters, or close by; or None.

        The system says where its poles are in Omega. The box counts with a margin of
        `POLE_CLEARANCE` on each side, so that a series over it has none at its door.
        """
        if not hasattr(self.system, "singular_Omega"):
            return None
        ends = {
            name: self._widened(name, low[name], high[name]) for name in low if name not in FORCING
        }
        if "Omega" in low:
            Omega = self._widened("Omega", low["Omega"], high["Omega"])
        else:
            fixed = self.forcing["Omega"]
            Omega = fixed * (1.0 - SAME_OMEGA), fixed * (1.0 + SAME_OMEGA)
        corners = [
            varied(self.system, dict(zip(ends, corner, strict=True)))
            for corner in product(*ends.values())
        ]
        # a pole that is on another side of the box at another corner passes through
        below = {len(singular_Omega(system, 0.0, Omega[0])) for system in corners}
        if len(below) == 1 and not any(len(singular_Omega(s, *Omega)) for s in corners):
            return None
        return self._across(low, high)

    def _widened(self, name: str, low: float, high: float) -> tuple[float, float]:
        margin = POLE_CLEARANCE * (high - low)
        if name == "Omega":
            return max(low - margin, 0.5 * low), high + margin
        own = next(p for p in self.system.parameters if p.name == name)
        return (
            low - margin if low - margin > own.low else low,
            high + margin if high + margin < own.high else high,
        )

    def _across(self, low: Values, high: Values) -> str:
        """The parameter along which Omega and the poles move most against each other."""
        middle = {name: 0.5 * (low[name] + high[name]) for name in low}
        Omega = middle.get("Omega", self.forcing.get("Omega", 1.0))
        moved = {"Omega": high["Omega"] - low["Omega"]} if "Omega" in low else {}
        for name in (n for n in low if n not in FORCING):
            own = {k: v for k, v in middle.items() if k not in FORCING}
            first, last = (
                singular_Omega(varied(self.system, own | {name: end}), 0.0, 2.0 * Omega)
                for end in (low[name], high[name])
            )
            if len(first) == len(last):
                moved[name] = float(np.max(np.abs(last - first), initial=0.0))
        return max(moved, key=lambda name: moved[name]) if moved else next(iter(low))


def scenario(
    system: System,
    axes: Sequence[Axis | tuple[str, float, float, int]] = (),
    forcing: Values | None = None,
) -> Scenario:
    """Check what is asked, before any work.

    Parameters
    ----------
    system : System
    axes : sequence of Axis or (name, low, high, count)
        Any parameter of the system, `Omega`, `gamma` or `eta`.
    forcing : mapping, optional
        Values of `Omega`, `gamma` and `eta` that are not axes; `eta` is 0 by default.

    Raises
    ------
    ValueError
        A name that the system does not have, twice or not at all; a corner of the ranges that the
        system refuses, or that would take for ever or leave the floats, far into the work.
    """
    if not isinstance(system, System):
        raise ValueError(
            f"system = {type(system).__name__}: must have parameters and equation(Omega, gamma, "
            "eta), as hill.System says"
        )
    own = {p.name: p.smooth for p in system.parameters}
    drawn = tuple(_drawn(axis, own) for axis in axes)
    if isinstance(system, Vehicle) and "eta" not in [axis.name for axis in drawn]:
        system, in_all = damping_as_forcing(system, (forcing or {}).get("eta", 0.0))
        forcing = {**(forcing or {}), "eta": in_all}
    given = {"eta": 0.0, **(forcing or {})}
    names = [axis.name for axis in drawn]
    _check_names(names, list(own), forcing or {})
    if "eta" in names:
        del given["eta"]
    fixed = {name: float(value) for name, value in given.items()}
    box = {axis.name: (axis.low, axis.high) for axis in drawn}
    corners = [dict(zip(box, corner, strict=True)) for corner in product(*box.values())]
    # every corner may be on a pole
    inner = [{k: a + share * (b - a) for k, (a, b) in box.items()} for share in (0.5, 0.382)]
    found = _equations(system, corners, fixed) or _equations(system, inner, fixed)
    if not found:
        checked(system, corners[0], fixed)  # says why there is none
    equations, eta = zip(*found, strict=True)
    reading = reading_of(equations, eta)
    degree = reading.degree(reading.form(equations[0], eta[0]))
    return Scenario(system, drawn, fixed, reading, degree)


def _equations(
    system: System, points: list[dict[str, float]], fixed: Values
) -> list[tuple[Equation, float]]:
    """Those that there are, and their eta; `checked` refuses what cannot be charted."""
    found = []
    for values in points:
        with suppress(Singular):
            found.append((checked(system, values, fixed), {**fixed, **values}["eta"]))
    return found


def singular_across(of: Scenario, low: Float, high: Float) -> int | None:
    """The axis to cut by where a rectangle of smooth coordinates has a pole, or one is near."""
    ends = [
        sorted((float(a.from_smooth(x)), float(a.from_smooth(y))))
        for a, x, y in zip(of.axes, low, high, strict=True)
    ]
    found = of.singular(
        dict(zip(of.names, (e[0] for e in ends), strict=True)),
        dict(zip(of.names, (e[1] for e in ends), strict=True)),
    )
    return None if found is None else of.names.index(found)


def _drawn(axis: Axis | tuple[str, float, float, int], smooth: Mapping[str, str]) -> Axis:
    made = axis if isinstance(axis, Axis) else Axis(*axis)
    return replace(made, smooth=smooth.get(made.name, made.smooth))


def _check_names(names: list[str], own: list[str], forcing: Values) -> None:
    known = [*own, *FORCING]
    for name in names:
        if name not in known:
            raise ValueError(f"axis = {name!r}: must be one of {', '.join(known)}")
        if names.count(name) > 1:
            raise ValueError(f"axis = {name!r}: is there twice")
    for name, value in forcing.items():
        if name not in FORCING:
            raise ValueError(f"{name}: must be one of {', '.join(FORCING)}")
        checks.number(name, value)
        if name in names:
            raise ValueError(f"{name} = {value:g}: is an axis too; leave one of them out")
    missing = {"Omega", "gamma"} - set(names) - set(forcing)
    if missing:
        raise ValueError(f"{min(missing)}: has no value; fix it, or make it an axis")
