"""Sections from a CSV table of stations: a header, then one station a row, linear in between."""

import csv
import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

from hill import checks
from hill.toml import only, unreadable
from hill.vehicle.parts import Section

NEEDED = ("station", "mass_per_length", "EI")
OPTIONAL = {"EA": math.inf, "rotary_inertia": 0.0, "kGA": math.inf}
COLUMNS = (*NEEDED, *OPTIONAL)


def sections_from(path: Path) -> tuple[Section, ...]:
    """Sections between the stations of a table, the properties linear between them.

    The first line names the columns: station, mass_per_length, EI, and if wanted EA,
    rotary_inertia, kGA. Stations ascend from 0; two rows of the same station are a step. Empty
    lines and lines that start with # are skipped.

    Raises
    ------
    ValueError
        A file that cannot be read, a column or a value that is missing or no number, stations that
        do not ascend: one line with the file's line and column.
    """
    rows = list(_rows(path))
    found: list[Section] = []
    for (_, one), (line, other) in pairwise(rows):
        length = other["station"] - one["station"]
        if length < 0.0:
            raise ValueError(
                f"line {line}: station = {other['station']:g}: is behind the one above it, "
                f"{one['station']:g}; stations must ascend"
            )
        if length == 0.0:
            continue
        ends: dict[str, Any] = {
            name: (one[name], other[name]) for name in COLUMNS if name != "station"
        }
        try:
            found.append(Section(length=length, **ends))
        except ValueError as error:
            raise ValueError(f"line {line}: {error}") from None
    if not found:
        raise ValueError("has fewer than two stations")
    if rows[0][1]["station"] != 0.0:
        raise ValueError(
            f"line {rows[0][0]}: station = {rows[0][1]['station']:g}: the first must be 0, the nose"
        )
    _no_third(rows)
    return tuple(found)


def _no_third(rows: list[tuple[int, dict[str, float]]]) -> None:
    """Refuse three rows of one station, and a step at an end."""
    stations = [row["station"] for _, row in rows]
    for k in range(2, len(stations)):
        if stations[k] == stations[k - 2]:
            raise ValueError(f"line {rows[k][0]}: station = {stations[k]:g}: is there three times")
    for k in (1, len(stations) - 1):
        if stations[k] == stations[k - 1]:
            raise ValueError(
                f"line {rows[k][0]}: station = {stations[k]:g}: is there twice, at an end"
            )


def _rows(path: Path) -> Iterator[tuple[int, dict[str, float]]]:
    """Line number and values of every station."""
    names: list[str] | None = None
    for line, cells in _lines(path):
        if names is None:
            names = cells
            only(dict.fromkeys(names), COLUMNS, f"line {line}: column ")
            for name in NEEDED:
                if name not in names:
                    raise ValueError(f"line {line}: has no column {name}")
            if len(set(names)) < len(names):
                raise ValueError(f"line {line}: has a column twice")
            continue
        if len(cells) != len(names):
            raise ValueError(f"line {line}: has {len(cells)} values, must have {len(names)}")
        given = {
            name: _number(f"line {line}: {name}", cell)
            for name, cell in zip(names, cells, strict=True)
        }
        yield line, OPTIONAL | given
    if names is None:
        raise ValueError("is empty")


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ValueError(unreadable(error)) from None
    except UnicodeDecodeError:
        raise ValueError("is not a text file") from None
    for line, row in enumerate(csv.reader(text.splitlines()), start=1):
        cells = [cell.strip() for cell in row]
        if any(cells) and not cells[0].startswith("#"):
            yield line, cells


def _number(name: str, cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        raise ValueError(
            f"{name} = {cell!r}: must be a number" if cell else f"{name}: has no value"
        ) from None
    return value if value == math.inf else checks.number(name, value)
