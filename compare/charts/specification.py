"""What to chart, from a TOML file or from words: beam, forcing, axes."""

import tomllib
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from compare.charts.parameters import Axis, Beam
from compare.tables import STEPPED, UNIFORM
from hill import SteppedBeam, UniformBeam

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
    for word in settings:
        name, equals, text = word.partition("=")
        if not equals or not name:
            raise ValueError(f"--set {word}: must be NAME=VALUE")
        values[name] = _value(f"--set {word}", name, text)
    typed = tuple(
        Axis(name, _number(name, low), _number(name, high), _whole(name, count))
        for name, low, high, count in axes
    )
    kept = base.axes if base and not typed else typed
    return Specification(base.kind if base else kind, values, kept)


def from_file(path: Path) -> Specification:
    """From a TOML file: a table ``beam`` (with ``kind``), a table ``forcing``, an array ``axis``.

    Raises
    ------
    ValueError
        The file cannot be read, or says something else.
    """
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ValueError(f"{path}: cannot be read ({reason})") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: is not TOML ({error})") from None
    beam, forcing = dict(content.pop("beam", {})), dict(content.pop("forcing", {}))
    axes = content.pop("axis", [])
    if content:
        raise ValueError(f"{path}: {min(content)!r} must be one of beam, forcing, axis")
    kind = beam.pop("kind", "uniform")
    if kind not in BEAMS:
        raise ValueError(f"{path}: kind = {kind!r} must be one of {', '.join(BEAMS)}")
    found = []
    for axis in axes:
        if not isinstance(axis, dict) or set(axis) != {"name", "low", "high", "count"}:
            raise ValueError(f"{path}: each axis must have name, low, high and count")
        found.append(Axis(**axis))
    return Specification(kind, beam | forcing, tuple(found))


def _value(where: str, name: str, text: str) -> Any:
    if name == "modes":
        return _whole(name, text)
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{where}: {text!r} is not a number") from None


def _number(name: str, text: str) -> float:
    return float(_value(f"axis {name}", "", text))


def _whole(name: str, text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"{name}: {text!r} is not a whole number") from None
