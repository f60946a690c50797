"""A system, its forcing and the axes of its chart, from a TOML file."""

import math
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare import system_code
from compare.matrix_file import matrix, periodic
from hill import Fourier, PeriodicSystem, SteppedBeam, UniformBeam, checks
from hill.system import FORCING, MatrixSystem, System, varied
from hill.toml import content as toml
from hill.toml import one_of, only, table
from hill.vehicle import file as vehicle_file

Float = NDArray[np.float64]

SECTIONS = ("kind", "forcing", "axis", "title")
MATRICES = ("F", "G", "M")
GENERAL = ("M", "C", "K", "A")
TERMS = ("F_terms", "G_terms")


@dataclass(frozen=True, eq=False)
class Described:
    """What a file describes.

    Attributes
    ----------
    system : System
    forcing : dict of str to float
        Omega, gamma and eta, as far as they are given.
    axes : tuple of (name, low, high, count)
    kind : str
    title : str
    """

    system: System
    forcing: dict[str, float] = field(default_factory=dict)
    axes: tuple[tuple[str, float, float, int], ...] = ()
    kind: str = ""
    title: str = ""


def read(path: Path) -> Described:
    """Read a file.

    Raises
    ------
    ValueError
        It cannot be read, or says something that is not understood: one line with file and key.
    """
    content = toml(path)
    try:
        return _described(content, path)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def with_settings(found: Described, settings: Mapping[str, float]) -> Described:
    """The same with some numbers set: of the forcing, or parameters of the system.

    Raises
    ------
    ValueError
        A name that neither has.
    """
    own = {k: v for k, v in settings.items() if k not in FORCING}
    names = [p.name for p in found.system.parameters]
    counts = [name for name in _whole_fields(found.system) if name not in names]
    for name in own:
        if name not in (*names, *counts):
            raise ValueError(f"{name}: {one_of(name, [*FORCING, *names, *counts])}")
    system = varied(found.system, {k: v for k, v in own.items() if k in names})
    whole = {k: _whole(k, v) for k, v in own.items() if k in counts}
    return replace(
        found,
        system=replace(system, **whole) if whole else system,
        forcing=found.forcing | {k: v for k, v in settings.items() if k in FORCING},
    )


def _whole_fields(system: Any) -> list[str]:
    """A dataclass's counts, such as the number of modes: they can be set, and not varied."""
    if not is_dataclass(system) or isinstance(system, type):
        return []
    own = [f.name for f in fields(system) if f.init]
    return [n for n in own if type(getattr(system, n)) is int]


def _whole(name: str, value: float) -> int:
    if value != int(value):
        raise ValueError(f"{name} = {value:g}: must be a whole number")
    return int(value)


def _described(content: dict[str, Any], path: Path) -> Described:
    if "beam" in content:
        raise ValueError(
            'beam: is written kind = "uniform" or "stepped", and its numbers under [system]'
        )
    kind = content.get("kind")
    keys = OWN_KEYS.get(str(kind), ())
    if str(kind) in KINDS or kind is None:
        only(content, (keys or ("system",)) + SECTIONS, "")
    if not isinstance(kind, str) or kind not in KINDS:
        raise ValueError(f"kind = {kind!r}: {one_of(str(kind), tuple(KINDS))}")
    own = {k: content[k] for k in keys if k in content} if keys else table(content, "system")
    forcing = table(content, "forcing")
    only(forcing, FORCING, "forcing.")
    axes = content.get("axis", [])
    if not isinstance(axes, list):
        raise ValueError("axis: must be an array of tables, [[axis]]")
    system = KINDS[kind](own, path.parent)
    # given harmonics are what they are, unless less of them is asked for
    whole = {"gamma": 1.0} if isinstance(system, PeriodicSystem) else {}
    return Described(
        system=system,
        forcing=whole | {name: checks.number(f"forcing.{name}", x) for name, x in forcing.items()},
        axes=tuple(_axis(axis) for axis in axes),
        kind=kind,
        title=str(content.get("title", path.stem)),
    )


def _axis(axis: Any) -> tuple[str, float, float, int]:
    names = ("name", "low", "high", "count")
    if not isinstance(axis, dict) or set(axis) != set(names) or not isinstance(axis["name"], str):
        raise ValueError(f"axis: must have {', '.join(names)} and nothing else")
    low, high = (checks.number(f"axis {axis['name']}.{end}", axis[end]) for end in ("low", "high"))
    return axis["name"], low, high, checks.count("axis count", axis["count"], least=2)


def _beam(kind: Any) -> Callable[[dict[str, Any], Path], Any]:
    def make(own: dict[str, Any], _: Path) -> Any:
        names = [f.name for f in fields(kind)]
        only(own, names, "system.")
        needed = [f.name for f in fields(kind) if f.name not in own and _required(f)]
        if needed:
            raise ValueError(f"system.{needed[0]}: has no value")
        return kind(**own)

    return make


def _required(f: Any) -> bool:
    return f.default is MISSING and f.default_factory is MISSING


def _matrices(own: dict[str, Any], folder: Path) -> System:
    return _periodic(own, folder) if {"C", "K", "A"} & set(own) else _pulsating(own, folder)


def _periodic(own: dict[str, Any], folder: Path) -> PeriodicSystem:
    """M, C and K, or A, with their harmonics."""
    if {"F", "G"} & set(own):
        raise ValueError(
            "system.F, system.G: go without C, K and A; write them as K's mean and cos.1"
        )
    only(own, (*GENERAL, "frequency_names"), "system.")
    given: dict[str, Any] = {
        name: periodic(f"system.{name}", own[name], folder) for name in GENERAL if name in own
    }
    if isinstance(given.get("M"), Fourier):
        raise ValueError("system.M: must be constant, one matrix")
    return PeriodicSystem(**given, frequency_names=_frequency_names(own))


def _pulsating(own: dict[str, Any], folder: Path) -> MatrixSystem:
    """F and G, and what goes with them."""
    known = (*MATRICES, "H", "omega_L", *TERMS, "values", "frequency_names")
    only(own, known, "system.")
    for name in ("F", "G"):
        if name not in own:
            raise ValueError(f"system.{name}: has no value")
    given: dict[str, Any] = {
        name: matrix(f"system.{name}", own[name], folder) for name in MATRICES if name in own
    }
    H = own.get("H", [])
    if not isinstance(H, list):
        raise ValueError("system.H: must be a list of matrices")
    terms: dict[str, Any] = {
        which: {
            name: matrix(f"system.{which}.{name}", value, folder)
            for name, value in table(own, which).items()
        }
        for which in TERMS
    }
    return MatrixSystem(
        **given,
        H=[matrix(f"system.H[{s}]", value, folder) for s, value in enumerate(H)],
        omega_L=own.get("omega_L", math.inf),
        values=table(own, "values"),
        frequency_names=_frequency_names(own),
        **terms,
    )


def _frequency_names(own: dict[str, Any]) -> list[str] | None:
    names = own.get("frequency_names")
    if names is not None and not (
        isinstance(names, list) and all(isinstance(x, str) for x in names)
    ):
        raise ValueError("system.frequency_names: must be a list of words")
    return names


KINDS: dict[str, Callable[[dict[str, Any], Path], Any]] = {
    "uniform": _beam(UniformBeam),
    "stepped": _beam(SteppedBeam),
    "matrices": _matrices,
    "vehicle": vehicle_file.vehicle,
    "python": system_code.system,
}
OWN_KEYS = {"vehicle": vehicle_file.KEYS}
"""Kinds whose content stands at the top of the file instead of in [system]."""
