"""A set of pages before it is written: what stands on each, and which files go with them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, eq=False)
class Page:
    """One page.

    Attributes
    ----------
    path : str
        Within the set, "/" between folders.
    title : str
        Unique in the set.
    template : str
        What lays it out, in ``templates``.
    content : dataclass
        What it says.
    part : str
        The entry of the navigation that it belongs to, by its path; its own where empty.
    """

    path: str
    title: str
    template: str
    content: Any
    part: str = ""


@dataclass(frozen=True, eq=False)
class Site:
    """Pages that belong together.

    Attributes
    ----------
    name : str
        What all are of.
    navigation : tuple of (label, path)
    pages : tuple of Page
    files : mapping of str to bytes
        Pictures and data, by path.
    made : str
        What made it, in words.
    about : mapping
        The same for machines.
    """

    name: str
    navigation: tuple[tuple[str, str], ...]
    pages: tuple[Page, ...]
    made: str
    about: Mapping[str, Any]
    files: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True)
class Table:
    """Heads, rows of as many cells, and what it is of; `words` many columns of words come first."""

    caption: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: int = 1
