"""A vehicle from a TOML file, its stations perhaps from a CSV table beside it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from hill import checks
from hill.toml import content, one_of, only, table, tables
from hill.vehicle.parts import Damping, PointMass, Section, Sensor, Thrust
from hill.vehicle.stations import sections_from
from hill.vehicle.units import KINDS, Units
from hill.vehicle.vehicle import Vehicle

KEYS = (
    "units",
    "modes",
    "ends",
    "section",
    "stations",
    "mass",
    "thrust",
    "sensor",
    "servo",
    "damping",
    "axial",
)
"""What a file may say of a vehicle; beside it stand kind, title, forcing and axis."""

OTHER = ("kind", "forcing", "axis", "title")

SECTION = ("length", "mass_per_length", "EI", "EA", "rotary_inertia", "kGA", "name", "start", "end")

# A section's start and the last one's end, both typed.
JOINT = 1e-9

Made = TypeVar("Made")


def read(path: Path) -> Vehicle:
    """The vehicle of a file, as `Vehicle.from_file`."""
    found = content(path)
    try:
        only(found, (*KEYS, *OTHER), "")
        if found.get("kind", "vehicle") != "vehicle":
            raise ValueError(f"kind = {found['kind']!r}: must be 'vehicle'")
        return vehicle({k: v for k, v in found.items() if k in KEYS}, path.parent)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def vehicle(own: Mapping[str, Any], folder: Path) -> Vehicle:
    """The vehicle that a file's content describes; file names in it are looked up in `folder`.

    Raises
    ------
    ValueError
        An unknown key, a missing or a wrong value: one line with key and value.
    """
    only(own, KEYS, "")
    given: dict[str, Any] = {
        "sections": _sections(own, folder),
        "masses": _parts(own, "mass", PointMass),
        "sensors": _parts(own, "sensor", Sensor),
        "thrust": _part(own, "thrust", Thrust),
        "damping": _part(own, "damping", Damping, ("ratios", "eta", "matrix")),
        "units": _units(own.get("units", "SI")),
    }
    given |= {name: own[name] for name in ("modes", "ends") if name in own}
    for name, renamed in (
        ("servo", {"time_constant": "servo_time"}),
        ("axial", {"g": "g", "damping": "axial_damping", "quadrature_force": "quadrature_force"}),
    ):
        found = table(own, name)
        only(found, tuple(renamed), f"{name}.")
        given |= {renamed[key]: value for key, value in found.items()}
    try:
        return Vehicle(**given)
    except ValueError as error:
        raise ValueError(_as_in_the_file(str(error))) from None


# What the file calls what the class calls otherwise.
_FILE_NAMES = (
    ("sections:", "section:"),
    ("masses[", "mass["),
    ("sensors[", "sensor["),
    ("servo_time", "servo.time_constant"),
    ("axial_damping", "axial.damping"),
    ("quadrature_force", "axial.quadrature_force"),
    ("g =", "axial.g ="),
)


def _as_in_the_file(message: str) -> str:
    for name, own in _FILE_NAMES:
        if message.startswith(name):
            return own + message.removeprefix(name)
    return message


def _sections(own: Mapping[str, Any], folder: Path) -> tuple[Section, ...]:
    if "stations" in own and "section" in own:
        raise ValueError("stations: must not stand beside section; one of them is the vehicle")
    if "stations" in own:
        name = own["stations"]
        if not isinstance(name, str):
            raise ValueError(f"stations = {name!r}: must be the name of a CSV file")
        try:
            return sections_from(folder / name)
        except ValueError as error:
            raise ValueError(f"stations = {name!r}: {error}") from None
    found = []
    end = 0.0
    for k, one in enumerate(tables(own, "section"), start=1):
        where = f"section[{k}]."
        only(one, SECTION, where)
        length = _length(one, where, end)
        _needs(one, ("mass_per_length", "EI"), where)
        rest = {name: v for name, v in one.items() if name not in ("length", "start", "end")}
        found.append(_prefixed(where, lambda **x: Section(**x), {"length": length, **rest}))
        end += found[-1].length
    if not found:
        raise ValueError('section: has none; give [[section]] or stations = "FILE.csv"')
    return tuple(found)


def _length(one: Mapping[str, Any], where: str, end: float) -> Any:
    """A section's length, as given or from its start and end, which must fit the one ahead."""
    if "start" in one:
        start = checks.number(f"{where}start", one["start"])
        if abs(start - end) > JOINT * max(end, 1.0):
            what = "overlaps the one ahead" if start < end else "leaves a gap"
            raise ValueError(f"{where}start = {start:g}: {what}, which ends at {end:g}")
    if "end" not in one:
        _needs(one, ("length",), where)
        return one["length"]
    if "length" in one:
        raise ValueError(f"{where}length: must not stand beside end")
    return checks.number(f"{where}end", one["end"]) - end


def _parts(own: Mapping[str, Any], name: str, kind: Callable[..., Made]) -> list[Made]:
    known = [f.name for f in fields(kind)]  # type: ignore[arg-type]
    found = []
    for k, one in enumerate(tables(own, name), start=1):
        where = f"{name}[{k}]."
        only(one, known, where)
        _needs(one, ("station",), where)
        if name == "mass":
            _needs(one, ("mass",), where)
        found.append(_prefixed(where, kind, one))
    return found


def _part(
    own: Mapping[str, Any], name: str, kind: Callable[..., Made], known: Sequence[str] = ()
) -> Made:
    one = table(own, name)
    only(one, known or [f.name for f in fields(kind)], f"{name}.")  # type: ignore[arg-type]
    return _prefixed(f"{name}.", kind, one)


def _needs(one: Mapping[str, Any], names: Sequence[str], where: str) -> None:
    for name in names:
        if name not in one:
            raise ValueError(f"{where}{name}: has no value")


def _prefixed(where: str, make: Callable[..., Made], values: Mapping[str, Any]) -> Made:
    try:
        return make(**values)
    except ValueError as error:
        raise ValueError(f"{where}{error}") from None


def _units(value: Any) -> Units:
    if isinstance(value, dict):
        only(value, tuple(KINDS), "units.")
        return Units(**value)
    if not isinstance(value, str):
        raise ValueError(f"units = {value!r}: {one_of(str(value), tuple(KINDS))}")
    return Units.named(value)
