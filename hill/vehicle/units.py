"""Units of a vehicle's numbers: a consistent set, by name; nothing is ever converted."""

import math
from dataclasses import dataclass
from typing import Any

from hill.toml import one_of

# One of each in SI, by the definitions of the international pound, foot and standard gravity.
_POUND = 0.45359237
_POUND_FORCE = _POUND * 9.80665
KINDS = {
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "in": 0.0254, "ft": 0.3048},
    "mass": {
        "kg": 1.0,
        "g": 1e-3,
        "t": 1e3,
        "lb": _POUND,
        "slug": _POUND_FORCE / 0.3048,
        "lbf s2/in": _POUND_FORCE / 0.0254,
    },
    "time": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "force": {
        "N": 1.0,
        "mN": 1e-3,
        "kN": 1e3,
        "MN": 1e6,
        "lbf": _POUND_FORCE,
        "kip": 1e3 * _POUND_FORCE,
        "kgf": 9.80665,
    },
}

# Unit definitions in print have six digits or more.
SAME = 1e-5

NONE = "none"


@dataclass(frozen=True, kw_only=True)
class Units:
    """Names of the units that a vehicle's numbers are in, a consistent set.

    Consistent means that one of force is one of mass times one of length over one of time
    squared, so that no number needs a factor. ``Units.named("none")`` is a set without names.

    Parameters
    ----------
    length : {"m", "mm", "cm", "km", "in", "ft"}, optional
    mass : {"kg", "g", "t", "lb", "slug", "lbf s2/in"}, optional
    time : {"s", "ms", "min"}, optional
    force : {"N", "mN", "kN", "MN", "lbf", "kip", "kgf"}, optional

    Raises
    ------
    ValueError
        A name that is not known, or is one of another kind; a set that is not consistent.
    """

    length: str = "m"
    mass: str = "kg"
    time: str = "s"
    force: str = "N"

    def __post_init__(self) -> None:
        names = {kind: getattr(self, kind) for kind in KINDS}
        if all(name == "" for name in names.values()):
            return
        for kind, name in names.items():
            _known(kind, name)
        one = {kind: KINDS[kind][name] for kind, name in names.items()}
        needed = one["mass"] * one["length"] / one["time"] ** 2
        if not math.isclose(one["force"], needed, rel_tol=SAME):
            right = [x for x, value in KINDS["force"].items() if math.isclose(value, needed)]
            raise ValueError(
                f"units.force = {self.force!r}: is not consistent, 1 {self.mass} {self.length}/"
                f"{self.time}^2 is {needed / one['force']:.6g} {self.force}"
                + (f"; it must be {right[0]}" if right else "")
            )

    @classmethod
    def named(cls, value: Any) -> "Units":
        """A set by its name, "SI", "mm-t-s", "in-lbf-s", "ft-lbf-s" or "none"."""
        if not isinstance(value, str) or value not in SETS:
            raise ValueError(f"units = {value!r}: {one_of(str(value), tuple(SETS))}")
        return cls(**dict(zip(KINDS, SETS[value], strict=True)))

    @property
    def frequency(self) -> str:
        """Of cycles per unit of time: "Hz" for seconds."""
        return {"s": "Hz", "": ""}.get(self.time, f"1/{self.time}")


SETS = {
    "SI": ("m", "kg", "s", "N"),
    "mm-t-s": ("mm", "t", "s", "N"),
    "in-lbf-s": ("in", "lbf s2/in", "s", "lbf"),
    "ft-lbf-s": ("ft", "slug", "s", "lbf"),
    NONE: ("", "", "", ""),
}


def checked(value: Any) -> Units:
    """`Units`, or a set by its name."""
    return value if isinstance(value, Units) else Units.named(value)


def _known(kind: str, name: Any) -> None:
    if isinstance(name, str) and name in KINDS[kind]:
        return
    others = [other for other in KINDS if isinstance(name, str) and name in KINDS[other]]
    why = f"is a unit of {others[0]}, " if others else ""
    raise ValueError(f"units.{kind} = {name!r}: {why}{one_of(str(name), tuple(KINDS[kind]))}")
