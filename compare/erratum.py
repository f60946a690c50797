"""What is wrong in a paper, as data."""

import tomllib
from dataclasses import dataclass
from importlib.resources.abc import Traversable


@dataclass(frozen=True)
class Erratum:
    """What is wrong in a paper, printed beside corrected.

    Attributes
    ----------
    kind : str
        "cell", "text", "equation", "slip" (of the paper's program), or "open" (not explained).
    row, field : str
        For a cell, the printed row and its column; empty otherwise.
    test : str
        The test that shows it.
    """

    id: str
    kind: str
    where: str
    printed: str
    corrected: str
    why: str
    test: str
    row: str = ""
    field: str = ""


def errata_from(file: Traversable) -> tuple[Erratum, ...]:
    """The errata of a TOML file, in its order, each an ``[[erratum]]``."""
    return tuple(Erratum(**entry) for entry in tomllib.loads(file.read_text())["erratum"])
