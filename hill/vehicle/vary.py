"""A vehicle's numbers by name, for charts and sensitivities: what they are, and other values."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from hill.system import Parameter
from hill.vehicle.parts import LARGEST_G, Damping, Section

if TYPE_CHECKING:
    from hill.vehicle.vehicle import Vehicle

NAMED_SECTIONS = 12
"""Sections up to this number are parameters one by one."""

Change = Callable[["Vehicle", float], "Vehicle"]
Known = tuple[Parameter, float, Change]


def varying(vehicle: "Vehicle") -> list[tuple[Parameter, float]]:
    """Each number that may be varied: its name and range, and its value."""
    return [(parameter, value) for parameter, value, _ in _known(vehicle)]


def varied(vehicle: "Vehicle", values: Mapping[str, float]) -> "Vehicle":
    """The vehicle with other values of some numbers; the names are known."""
    changes = {parameter.name: change for parameter, _, change in _known(vehicle)}
    for name, value in values.items():
        vehicle = changes[name](vehicle, value)
    return vehicle


def _known(v: "Vehicle") -> list[Known]:
    found: list[Known] = [
        (
            Parameter("thrust", dependence="linear"),
            v.thrust.mean,
            lambda v, x: replace(v, thrust=replace(v.thrust, mean=x)),
        )
    ]
    if v.thrust.station is not None:
        found.append(
            (
                Parameter("thrust_station", 0.0, v.length),
                v.thrust.station,
                lambda v, x: replace(v, thrust=replace(v.thrust, station=x)),
            )
        )
    for k in range(len(v.sensors)):
        end = f"_{k + 1}" if len(v.sensors) > 1 else ""
        for name in ("K_theta", "K_rate"):
            found.append(
                (Parameter(name + end, dependence="linear"), *_part("sensors", k, name, v))
            )
        found.append(
            (Parameter(f"sensor_station{end}", 0.0, v.length), *_part("sensors", k, "station", v))
        )
    if v.servo_time > 0.0:
        found.append(
            (
                Parameter("servo_time", 0.0),
                v.servo_time,
                lambda v, x: replace(v, servo_time=x),
            )
        )
    if len(v.damping.ratios) == 1:
        found.append(
            (Parameter("damping_ratio", dependence="linear"), v.damping.ratios[0], _damping_ratio)
        )
    if not v.rigid_axially:
        found.append((Parameter("g", 0.0, LARGEST_G), v.g, lambda v, x: replace(v, g=x)))
    for k, mass in enumerate(v.masses):
        name = mass.name or str(k + 1)
        found.append((Parameter(f"mass_{name}", 0.0), *_part("masses", k, "mass", v)))
        found.append(
            (Parameter(f"station_{name}", 0.0, v.length), *_part("masses", k, "station", v))
        )
    if len(v.sections) <= NAMED_SECTIONS:
        for k, section in enumerate(v.sections):
            found += _section(k, section)
    return _once(found)


def _once(found: list[Known]) -> list[Known]:
    """The first of each name: two parts may have been called the same."""
    names = [parameter.name for parameter, _, _ in found]
    return [one for k, one in enumerate(found) if names.index(names[k]) == k]


def _part(which: str, k: int, name: str, v: "Vehicle") -> tuple[float, Change]:
    """Value and change of a number of the k-th mass or sensor."""

    def change(v: "Vehicle", x: float) -> "Vehicle":
        parts = list(getattr(v, which))
        parts[k] = replace(parts[k], **{name: x})
        return replace(v, **{which: tuple(parts)})  # type: ignore[arg-type]

    return getattr(getattr(v, which)[k], name), change


def _damping_ratio(v: "Vehicle", x: float) -> "Vehicle":
    return replace(v, damping=Damping(x, v.damping.eta, v.damping.matrix))


def _section(k: int, section: Section) -> list[Known]:
    """What of a section is uniform and finite."""
    found: list[Known] = []
    label = section.name or str(k + 1)
    for name, short in (("EI", "EI"), ("mass_per_length", "m"), ("EA", "EA")):
        start, end = getattr(section, name)
        if start == end and math.isfinite(start):
            found.append((Parameter(f"{short}_{label}", 0.0), start, _section_change(k, name)))
    return found


def _section_change(k: int, name: str) -> Change:
    def change(v: "Vehicle", x: float) -> "Vehicle":
        sections = list(v.sections)
        s = sections[k]
        own: dict[str, Any] = {
            "length": s.length,
            "mass_per_length": s.mass_per_length,
            "EI": s.EI,
            "EA": s.EA,
            "rotary_inertia": s.rotary_inertia,
            "kGA": s.kGA,
            "name": s.name,
        }
        sections[k] = Section(**(own | {name: x}))
        return replace(v, sections=tuple(sections))

    return change
