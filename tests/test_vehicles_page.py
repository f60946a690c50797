"""The table of docs/vehicles.md has every key that a file may have, and no other."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

from hill import PointMass, Sensor, Thrust, Vehicle
from hill.system import FORCING
from hill.vehicle.file import KEYS, SECTION
from hill.vehicle.stations import COLUMNS
from hill.vehicle.units import KINDS, SETS
from hill.vehicle.vehicle import MAX_MODES

ROOT = Path(__file__).parent.parent
PAGE = (ROOT / "docs" / "vehicles.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| `(\w+)` \| (?:`\[+(\w+)\]+`|(file)) \| ", re.M)


def documented() -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for key, table, file in ROW.findall(PAGE):
        found.setdefault(table or file, set()).add(key)
    return found


def names(kind: type) -> set[str]:
    return {field.name for field in fields(kind)}


def test_every_key_is_there() -> None:
    tables = {"section", "mass", "thrust", "sensor", "servo", "damping", "axial"}
    assert documented() == {
        "file": (set(KEYS) - tables) | {"kind", "title"},
        "section": set(SECTION),
        "mass": names(PointMass),
        "thrust": names(Thrust),
        "sensor": names(Sensor),
        "servo": {"time_constant"},
        "damping": {"ratios", "eta", "matrix"},
        "axial": {"g", "damping", "quadrature_force"},
        "forcing": set(FORCING),
    }


@pytest.mark.parametrize(
    ("table", "keys"),
    [("servo", {"time_constant"}), ("axial", {"g", "damping", "quadrature_force"})],
)
def test_the_reader_knows_those_keys_alone(table: str, keys: set[str], tmp_path: Path) -> None:
    path = tmp_path / "v.toml"
    path.write_text(
        f"[[section]]\nlength = 1.0\nmass_per_length = 1.0\nEI = 1.0\n[{table}]\nother = 1\n"
    )
    with pytest.raises(ValueError, match=f"{table}.other") as told:
        Vehicle.from_file(path)
    assert all(key in str(told.value) for key in keys)


def test_units_columns_and_limits() -> None:
    assert all(f'"{name}"' in PAGE for name in SETS)
    assert all(f"`{name}`" in PAGE for name in (*KINDS, *COLUMNS))
    assert f"{MAX_MODES} at most" in PAGE


@pytest.mark.parametrize("place", re.findall(r"`((?:hill|floquet|compare)/[\w/]+\.py)`", PAGE))
def test_the_modules_that_it_names_are_there(place: str) -> None:
    assert (ROOT / place).is_file()


@pytest.mark.parametrize("path", re.findall(r"examples/\w+\.toml", PAGE))
def test_its_examples_are_there(path: str) -> None:
    assert Vehicle.from_file(ROOT / path).modes >= 2
