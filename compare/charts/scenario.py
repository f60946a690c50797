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
from compare.charts.smooth import Smooth
from compare.stability.reading import Reading, reading_of
from floquet.witness import maker
from hill import HillEquation, PeriodicEquation, Singular, System, checks
from hill.oscillations.steady import mean_frequencies
from hill.system import (
    FORCING,
    frequency_names,
    natural_frequencies,
    parameter_values,
    varied,
    with_damping_apart,
)

Float = NDArray[np.floating[Any]]
Complex = NDArray[np.complexfloating[Any, Any]]
Values = Mapping[str, float]
Equation = HillEquation | PeriodicEquation


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
    def smooth(self) -> Smooth:
        """The variables of its series."""
        return Smooth(self.axes, self.forcing.get("Omega", float("nan")))

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
        ratio = next((p.name for p in self.system.parameters if p.smooth == "ratio"), None)
        for line in zip(*points.values(), strict=True):
            values = dict(zip(points, map(float, line), strict=True))
            own = tuple(values[name] for name in own_names)
            if own not in systems:
                systems[own] = varied(self.system, {name: values[name] for name in own_names})
            system = systems[own]
            forcing = dict(self.forcing) | {k: v for k, v in values.items() if k in FORCING}
            moves, Omega = getattr(system, "depends_on_Omega", None), forcing["Omega"]
            key: tuple[float, ...] = own
            if moves and ratio in own_names:
                key = tuple(
                    Omega / v if n == ratio else v for n, v in values.items() if n in own_names
                )
            elif moves:
                key = (*own, Omega)
            known = made.get(key) if moves is not None else None
            try:
                if known is not None:  # its matrices, and how large their elements are
                    omega_L = known[0].omega_L * (Omega / known[0].Omega if moves else 1.0)
                    one = known[0].forced(**forcing, omega_L=omega_L)
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
    drawn = _drawn(axes, own)
    if "eta" not in [axis.name for axis in drawn]:
        system, eta_in_all = with_damping_apart(system, (forcing or {}).get("eta", 0.0))
        forcing = {**(forcing or {}), "eta": eta_in_all}
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


def _drawn(
    axes: Sequence[Axis | tuple[str, float, float, int]], smooth: Mapping[str, str]
) -> tuple[Axis, ...]:
    """Axes in the variables that the system says; the first ratio is one, others reciprocals."""
    found: list[Axis] = []
    for axis in axes:
        made = axis if isinstance(axis, Axis) else Axis(*axis)
        own = smooth.get(made.name, made.smooth)
        if own == "ratio" and any(other.smooth == "ratio" for other in found):
            own = "reciprocal"
        found.append(replace(made, smooth=own))
    return tuple(found)


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
