"""A system from somebody's own Python file: the class that a TOML file names."""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from importlib import import_module, invalidate_caches
from importlib.util import find_spec
from inspect import signature
from math import inf
from pathlib import Path
from traceback import extract_tb
from typing import Any

from hill import Parameter, System, checks
from hill.toml import only


def system(own: Mapping[str, Any], folder: Path) -> Any:
    """What ``[system]`` describes: `class` names a class, the other keys are what it is made with.

    The code that it names is run.

    Parameters
    ----------
    own : mapping
        ``class = "mine.py:Mine"``, a file beside the TOML file, or ``"package.module:Mine"``.
    folder : Path
        Where the TOML file is.

    Raises
    ------
    ValueError
        There is no such class, it is no System, or does not take these values.
    """
    values = dict(own)
    named = values.pop("class", None)
    place, colon, name = named.rpartition(":") if isinstance(named, str) else ("", "", "")
    if not (place and colon and name.isidentifier()):
        raise ValueError(f'system.class = {named!r}: must be "file.py:Class" or "module:Class"')
    module = _beside(folder / place) if place.endswith(".py") else _imported(place)
    kind = getattr(module, name, None)
    if not isinstance(kind, type):
        raise ValueError(f"system.class = {named!r}: {place} has no class {name}")
    if is_dataclass(kind):
        only(values, [f.name for f in fields(kind) if f.init], "system.")
    try:
        made = kind(**values)
    except ValueError as error:
        raise ValueError(f"system: {error}") from None
    except Exception as error:  # whatever somebody's code raises
        raise ValueError(f"system.class = {named!r}: {_words(error)}") from None
    if not (isinstance(made, System) and _takes_forcing(made) and _has_parameters(made)):
        raise ValueError(
            f"system.class = {named!r}: must have parameters, a tuple of Parameter, and "
            "equation(Omega, gamma, eta)"
        )
    for name in {p.name for p in made.parameters} & set(values):
        if values[name] != inf:
            checks.number(f"system.{name}", values[name])
    return made


def _beside(path: Path) -> Any:
    """The module of a file. Its folder is put on Python's path, so that workers find it too."""
    path = path.resolve()
    if not path.is_file():
        raise ValueError(f"system.class: {path} is not there")
    name = path.stem
    if not name.isidentifier():
        raise ValueError(f"system.class: {path.name} must be called like a Python module")
    if str(path.parent) not in sys.path:
        sys.path.append(str(path.parent))
        invalidate_caches()
    known = sys.modules.get(name)
    found = getattr(known, "__file__", None) if known else getattr(find_spec(name), "origin", None)
    if found is None or Path(found).resolve() != path:
        raise ValueError(
            f"system.class: there is another module {name} ({found}); call {path.name} otherwise"
        )
    OWN_FILES.add(str(path))
    return _imported(name)


def _imported(name: str) -> Any:
    try:
        return import_module(name)
    except (Exception, SystemExit) as error:  # whatever somebody's code raises
        raise ValueError(f"system.class: {name} cannot be imported ({_words(error)})") from None


def _words(error: BaseException) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"


def _takes_forcing(made: Any) -> bool:
    try:
        signature(made.equation).bind(1.0, 0.0, 0.0)
    except TypeError:
        return False
    return True


def _has_parameters(made: Any) -> bool:
    own = made.parameters
    return isinstance(own, Sequence) and all(isinstance(p, Parameter) for p in own)


def place_of(error: BaseException) -> str:
    """Where in somebody's own file an exception was met, and what it says; empty if in none."""
    met = [frame for frame in extract_tb(error.__traceback__) if frame.filename in OWN_FILES]
    if not met:
        return ""
    return f"{Path(met[-1].filename).name}, line {met[-1].lineno}: {_words(error)}"


OWN_FILES: set[str] = set()
"""Of the classes that were asked for."""
