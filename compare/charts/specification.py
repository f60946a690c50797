"""What to chart, from a TOML file or from words: beam, forcing, axes."""

from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from compare.charts.parameters import FORCING, Axis, Beam
from compare.report.tables import STEPPED, UNIFORM
from hill import SteppedBeam, UniformBeam
from hill.toml import content as toml
from hill.toml import one_of, table

BEAMS: dict[str, type[Beam]] = {"uniform": UniformBeam, "stepped": SteppedBeam}
REPORT = {"uniform": UNIFORM, "stepped": STEPPED}
"""The beams of Tables 1 and 2: what is not said otherwise."""


@dataclass(frozen=True)
class Specification:
    """A beam, its forcing and the axes of a chart."""

    kind: str = "uniform"
    values: dict[str, float] = field(default_factory=dict)
    axes: tuple[Axis, ...] = ()

    @property
    def beam(self) -> Beam:
        """The beam: the report's but for what is said."""
        own = {f.name for f in fields(BEAMS[self.kind])}
        given = {name: value for name, value in self.values.items() if name in own}
        return BEAMS[self.kind](**(REPORT[self.kind] | given))  # type: ignore[arg-type]

    @property
    def forcing(self) -> dict[str, float]:
        """Omega, gamma and eta, as far as they are given."""
        own = {f.name for f in fields(BEAMS[self.kind])}
        return {name: value for name, value in self.values.items() if name not in own}


def from_words(
    kind: str, settings: list[str], axes: list[list[str]], base: Specification | None = None
) -> Specification:
    """From "NAME=VALUE" and [NAME, LOW, HIGH, COUNT] as typed.

    Raises
    ------
    ValueError
        Words that are not of this form.
    """
    values = dict(base.values) if base else {}
    kind = base.kind if base else kind
    known = [*FORCING, *(f.name for f in fields(BEAMS[kind]))]
    for word in settings:
        name, equals, text = word.partition("=")
        if not equals or not name:
            raise ValueError(f"--set {word}: must be NAME=VALUE")
        if name not in known:
            raise ValueError(f"--set {word}: {name}: {one_of(name, known)}")
        values[name] = _value(f"--set {word}", name, text)
    typed = tuple(
        Axis(name, _number(name, low), _number(name, high), _whole(name, count))
        for name, low, high, count in axes
    )
    kept = base.axes if base and not typed else typed
    for axis in kept:
        if any(word.startswith(f"{axis.name}=") for word in settings):
            raise ValueError(f"--set {axis.name}: is an axis; leave one of them out")
    return Specification(kind, values, kept)


def from_file(path: Path) -> Specification:
    """From a TOML file: a table ``beam`` (with ``kind``), a table ``forcing``, an array ``axis``.

    Raises
    ------
    ValueError
        The file cannot be read, or says something else.
    """
    content = toml(path)
    if "kind" in content or "system" in content:
        raise ValueError(f"{path}: has [system]; a chart's file has [beam]")
    own = table(content, "beam", path)
    forcing = table(content, "forcing", path)
    axes = content.get("axis", [])
    for name in content:
        if name not in ("beam", "forcing", "axis"):
            raise ValueError(f"{path}: {name!r} {one_of(name, ('beam', 'forcing', 'axis'))}")
    kind = own.pop("kind", "uniform")
    if not isinstance(kind, str) or kind not in BEAMS:
        raise ValueError(f"{path}: kind = {kind!r} must be one of {', '.join(BEAMS)}")
    known = [f.name for f in fields(BEAMS[kind])]
    for where, given, names in (("beam", own, known), ("forcing", forcing, FORCING)):
        for name, value in given.items():
            if name not in names:
                raise ValueError(f"{path}: {where}.{name}: {one_of(name, names)}")
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise ValueError(f"{path}: {where}.{name} = {value!r}: must be a number")
    if not isinstance(axes, list):
        raise ValueError(f"{path}: axis: must be an array of tables, [[axis]]")
    found = []
    for axis in axes:
        if not isinstance(axis, dict) or set(axis) != {"name", "low", "high", "count"}:
            raise ValueError(f"{path}: each axis must have name, low, high and count")
        if not isinstance(axis["name"], str):
            raise ValueError(f"{path}: axis.name = {axis['name']!r}: must be a word")
        found.append(Axis(**axis))
    return Specification(kind, own | forcing, tuple(found))


def _value(where: str, name: str, text: str) -> Any:
    if name == "modes":
        return _whole(name, text)
    try:
        if not text.isascii():
            raise ValueError
        return float(text)
    except ValueError:
        raise ValueError(f"{where}: {text!r} is not a number") from None


def _number(name: str, text: str) -> float:
    return float(_value(f"axis {name}", "", text))


def _whole(name: str, text: str) -> int:
    try:
        number = float(text)
        if number != int(number):
            raise ValueError
        return int(number)
    except (ValueError, OverflowError):
        raise ValueError(f"{name}: {text!r} is not a whole number") from None
