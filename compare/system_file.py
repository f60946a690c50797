"""A system, its forcing and the axes of its chart, from a TOML file."""

import difflib
import math
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill import SteppedBeam, UniformBeam, checks
from hill.system import FORCING, MatrixSystem, System, varied

Float = NDArray[np.float64]

SECTIONS = ("kind", "system", "forcing", "axis", "title")
MATRICES = ("F", "G", "M")
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
    for name in own:
        if name not in names:
            raise ValueError(f"{name}: {one_of(name, [*names, *FORCING])}")
    forcing = found.forcing | {k: v for k, v in settings.items() if k in FORCING}
    return Described(varied(found.system, own), forcing, found.axes, found.kind, found.title)


def one_of(word: str, known: Sequence[str]) -> str:
    """What would be right in place of a word, the nearest first."""
    near = difflib.get_close_matches(word, known, 1)
    text = f"must be one of {', '.join(known)}" if known else "must not be there"
    return f"did you mean {near[0]}? It {text}" if near else text


def toml(path: Path) -> dict[str, Any]:
    """What a TOML file holds, or one line that says why it cannot be had."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ValueError(f"{path}: cannot be read ({reason})") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: is not TOML ({error})") from None
    except RecursionError:
        raise ValueError(f"{path}: is nested too deeply") from None


def _described(content: dict[str, Any], path: Path) -> Described:
    _only(content, SECTIONS, "")
    kind = content.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        raise ValueError(f"kind = {kind!r}: {one_of(str(kind), tuple(KINDS))}")
    own = table(content, "system")
    forcing = table(content, "forcing")
    _only(forcing, FORCING, "forcing.")
    axes = content.get("axis", [])
    if not isinstance(axes, list):
        raise ValueError("axis: must be an array of tables, [[axis]]")
    return Described(
        system=KINDS[kind](own, path.parent),
        forcing={name: checks.number(f"forcing.{name}", x) for name, x in forcing.items()},
        axes=tuple(_axis(axis) for axis in axes),
        kind=kind,
        title=str(content.get("title", path.stem)),
    )


def table(content: dict[str, Any], name: str, path: Path | None = None) -> dict[str, Any]:
    """A table of a file's content, empty where it is not there."""
    found = content.get(name, {})
    if not isinstance(found, dict):
        raise ValueError(f"{f'{path}: ' if path else ''}{name}: must be a table, [{name}]")
    return dict(found)


def _only(table: Mapping[str, Any], known: Sequence[str], where: str) -> None:
    for name in table:
        if name not in known:
            raise ValueError(f"{where}{name}: {one_of(name, known)}")


def _axis(axis: Any) -> tuple[str, float, float, int]:
    names = ("name", "low", "high", "count")
    if not isinstance(axis, dict) or set(axis) != set(names) or not isinstance(axis["name"], str):
        raise ValueError(f"axis: must have {', '.join(names)} and nothing else")
    low, high = (checks.number(f"axis {axis['name']}.{end}", axis[end]) for end in ("low", "high"))
    return axis["name"], low, high, checks.count("axis count", axis["count"], least=2)


def _beam(kind: Any) -> Callable[[dict[str, Any], Path], Any]:
    def make(own: dict[str, Any], _: Path) -> Any:
        names = [f.name for f in fields(kind)]
        _only(own, names, "system.")
        needed = [f.name for f in fields(kind) if f.name not in own and _required(f)]
        if needed:
            raise ValueError(f"system.{needed[0]}: has no value")
        return kind(**own)

    return make


def _required(f: Any) -> bool:
    return f.default is MISSING and f.default_factory is MISSING


def _matrices(own: dict[str, Any], folder: Path) -> MatrixSystem:
    known = (*MATRICES, "H", "omega_L", *TERMS, "values", "frequency_names")
    _only(own, known, "system.")
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
    names = own.get("frequency_names")
    if names is not None and not (
        isinstance(names, list) and all(isinstance(x, str) for x in names)
    ):
        raise ValueError("system.frequency_names: must be a list of words")
    return MatrixSystem(
        **given,
        H=[matrix(f"system.H[{s}]", value, folder) for s, value in enumerate(H)],
        omega_L=own.get("omega_L", math.inf),
        values=table(own, "values"),
        frequency_names=names,
        **terms,
    )


def matrix(name: str, value: Any, folder: Path) -> Float:
    """A matrix given row by row, or as "file.npz:array", "file.mat:array" or "file.mtx".

    Raises
    ------
    ValueError
        It is not one, or the file is not there or does not have it.
    """
    if not isinstance(value, str):
        return checks.square(name, value)
    file, _, array = value.partition(":")
    path = folder / file
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ValueError(
            f"{name} = {value!r}: must be rows of numbers or a file's name, {', '.join(READERS)}"
        )
    if path.suffix.lower() != ".mtx" and not array:
        raise ValueError(f'{name} = {value!r}: must name the array too, as "{file}:F"')
    try:
        found = reader(path, array)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ValueError(f"{name} = {value!r}: cannot be read ({reason})") from None
    return checks.square(name, found)


def _named(available: Mapping[str, Any], array: str, path: Path) -> Any:
    if array not in available:
        names = [name for name in available if not name.startswith("__")]
        raise ValueError(f"{path.name} has no array {array!r}: {one_of(array, names)}")
    return available[array]


def _npz(path: Path, array: str) -> Any:
    from zipfile import BadZipFile

    try:
        with np.load(path, allow_pickle=False) as archive:
            if not hasattr(archive, "files"):
                raise ValueError(f"{path.name}: is not an .npz archive")
            return _named({name: archive[name] for name in archive.files}, array, path)
    except BadZipFile:
        raise ValueError(f"{path.name}: is not an .npz archive") from None


def _mat(path: Path, array: str) -> Any:
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        return _dense(_named(loadmat(str(path)), array, path))
    except NotImplementedError:
        raise ValueError(
            f"{path.name}: is a .mat file of version 7.3; save it as version 7 (save -v7)"
        ) from None
    except MatReadError as error:
        raise ValueError(f"{path.name}: is not a .mat file ({error})") from None


def _mtx(path: Path, _: str) -> Any:
    from scipy.io import mmread

    if not path.exists():
        raise FileNotFoundError(2, "no such file or directory")
    return _dense(mmread(str(path)))


def _dense(found: Any) -> Any:
    return found.toarray() if hasattr(found, "toarray") else found


READERS: dict[str, Callable[[Path, str], Any]] = {".npz": _npz, ".mat": _mat, ".mtx": _mtx}
KINDS: dict[str, Callable[[dict[str, Any], Path], Any]] = {
    "uniform": _beam(UniformBeam),
    "stepped": _beam(SteppedBeam),
    "matrices": _matrices,
}
