"""Papers with printed tables, a module each: its ``PUBLICATION`` (see `compare.publication`).

A module put into this package is found without being listed anywhere.
"""

import difflib
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from compare.publication import Publication

__all__ = ["FIRST", "find", "names"]

FIRST = "kincaid"
"""The report this project began with."""


def names() -> tuple[str, ...]:
    """What there is, the first one first."""
    found = sorted(module.name for module in iter_modules(__path__))
    return (FIRST, *(name for name in found if name != FIRST))


def find(name: str) -> Publication[Any, Any, Any]:
    """A publication by its name.

    Raises
    ------
    ValueError
        There is none; the nearest name is suggested.
    """
    known = names()
    if name not in known:
        near = difflib.get_close_matches(name, known, 1)
        hint = f"did you mean {near[0]}? " if near else ""
        raise ValueError(f"publication = {name!r}: {hint}must be one of {', '.join(known)}")
    found: Publication[Any, Any, Any] = import_module(f"{__name__}.{name}").PUBLICATION
    return found
