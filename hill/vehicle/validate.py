"""What a vehicle's parts must be to be one: refusals, in one line each."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal, TypeVar

from hill.toml import one_of
from hill.vehicle.parts import PointMass, Sensor

End = Literal["free", "pinned", "clamped"]
ENDS = ("free", "pinned", "clamped")

MAX_PARTS = 5000

# Stations are sums of lengths: the aft end as typed may miss the sum by its rounding.
STATION = 1e-12

Part = TypeVar("Part", PointMass, Sensor)


def on_board(length: float, name: str, parts: tuple[Part, ...]) -> tuple[Part, ...]:
    """Parts whose stations are on a vehicle of this length."""
    return tuple(
        replace(part, station=on_vehicle(f"{name}[{k}].station", part.station, length))
        for k, part in enumerate(parts, start=1)
    )


def on_vehicle(name: str, value: float, length: float) -> float:
    """A station on the vehicle; a rounding error beyond the aft end is put back."""
    if abs(value - length) <= STATION * length:
        return length
    if not 0.0 <= value <= length:
        raise ValueError(
            f"{name} = {value:g}: is outside the vehicle, must be between 0 and {length:g}"
        )
    return value


def ends(value: Any) -> tuple[End, End]:
    """Two ends, of the nose and of the aft end."""
    if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != 2:
        raise ValueError(f"ends = {value!r}: must be two words, of the nose and of the aft end")
    for name in value:
        if name not in ENDS:
            raise ValueError(f"ends = {name!r}: {one_of(str(name), ENDS)}")
    return value[0], value[1]


def items(name: str, value: Any, kind: type) -> tuple[Any, ...]:
    """A tuple of parts of one kind."""
    try:
        found = tuple(value)
    except TypeError:
        raise ValueError(f"{name}: must be a sequence of {kind.__name__}") from None
    for k, item in enumerate(found, start=1):
        if not isinstance(item, kind):
            raise ValueError(f"{name}[{k}] = {item!r}: must be a {kind.__name__}")
    if len(found) > MAX_PARTS:
        raise ValueError(f"{name}: are {len(found):,}, must be at most {MAX_PARTS:,}")
    return found
