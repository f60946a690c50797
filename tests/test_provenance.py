"""Every file says what made it, what it is of and in which units, and nothing of the machine."""

import json
import re
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import csv_lines

from compare.__main__ import main
from compare.provenance import as_line, in_words, provenance

MADE_BY = f"floquet-crosscheck {version('floquet-crosscheck')}"
VEHICLE = str(Path(__file__).parent.parent / "examples" / "uniform.toml")
ROW = ["--row", "T1-12"]
SYSTEM = """
kind = "matrices"
[system]
F = [[2.0, -1.0], [-1.0, 2.0]]
G = [[1.0, 0.0], [0.0, 1.0]]
[forcing]
gamma = 0.15
Omega = 2.0
"""
CHART = ["--x", "Omega", "1.9", "2.1", "5", "--y", "gamma", "0.1", "0.2", "4"]


def record(path: Path) -> dict[str, Any]:
    """What a file says of itself, whatever it is."""
    if path.suffix == ".png":
        return json.loads(_png(path)["Description"])
    if path.suffix == ".npz":
        with np.load(path) as content:
            return json.loads(str(content["provenance"]))
    text = path.read_text()
    if path.suffix == ".json":
        return json.loads(text)
    if path.suffix == ".csv":
        return csv_lines(text)[0]
    if path.suffix == ".svg":
        (line,) = re.findall(r"<dc:description>(.*?)</dc:description>", text, re.DOTALL)
        return json.loads(line.replace("&quot;", '"').replace("&gt;", ">").replace("&lt;", "<"))
    if path.suffix == ".lst":
        return json.loads(text.splitlines()[-1].removeprefix("# "))
    words = " ".join(text.split())
    (found,) = re.findall(r"Made by (.*?): .*? Units: (.*?)\.(?= |$)", words)
    return {"schema": 1, "made_by": found[0], "units": found[1]}


def _png(path: Path) -> dict[str, str]:
    image = pytest.importorskip("PIL.Image")
    with image.open(path) as opened:
        return dict(opened.text)


CASES = {
    "rows": (["--output"], ("md", "csv", "txt")),
    "mathieu": (["--publication", "mathieu", "--row", "b2-q5", "--output"], ("md", "csv", "txt")),
    "system": (["system", "{file}", "--output"], ("json", "md", "csv", "txt")),
    "sensitivity": (["sensitivity", "{file}", "--output"], ("json", "txt")),
    "simulate": (
        ["simulate", "{file}", "--output"],
        ("json", "csv", "txt", "png", "svg"),
    ),
    "vehicle": (
        ["vehicle", VEHICLE, "--closely", "1", "--both", "0", "--output"],
        ("json", "md", "txt"),
    ),
    "prove": (["prove", "T2-27", "--output"], ("json", "txt")),
    "claims": (["claims", "integrals", "--output"], ("json", "md", "txt")),
    "listing": (["listing", "uniform", "--output"], ("lst",)),
    "compared": (["listing", "uniform", "--compare", "--output"], ("lst",)),
    "chart": (["chart", "{file}", *CHART, "--output"], ("json", "csv", "npz", "png", "svg")),
}


@pytest.mark.parametrize(
    ("name", "kind"), [(name, kind) for name, (_, kinds) in CASES.items() for kind in kinds]
)
def test_every_file_says_what_made_it(name: str, kind: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(SYSTEM)
    words = [word.format(file=file) for word in CASES[name][0]]
    words = [*ROW, *words] if name == "rows" else words
    path = tmp_path / f"out.{kind}"
    assert main([*words, str(path)]) == 0
    found = record(path)
    assert (found["schema"], found["made_by"]) == (1, MADE_BY)
    assert "frequenc" in str(found["units"])
    assert str(tmp_path).encode() not in path.read_bytes()


def test_figures_say_what_made_them(tmp_path: Path) -> None:
    assert main(["figures", "27", "--workers", "1", "--output", str(tmp_path)]) == 0
    records = [record(tmp_path / f"figure27.{kind}") for kind in ("csv", "png", "svg")]
    assert records[0] == records[1] == records[2]
    assert (records[0]["made_by"], records[0]["figure"]) == (MADE_BY, 27)


def test_the_rows_json_is_as_it_was(tmp_path: Path) -> None:
    """Its names are a contract of their own."""
    path = tmp_path / "out.json"
    assert main([*ROW, "--output", str(path)]) == 0
    assert set(json.loads(path.read_text())) == {"summary", "rows"}


def test_a_system_s_own_values_are_told(tmp_path: Path) -> None:
    """Two files that differ in one number of F, and one that differs in nothing but its place."""
    found = []
    for name, text in (("a", SYSTEM), ("b", SYSTEM.replace("2.0, -1.0]", "2.1, -1.0]")), ("c", "")):
        folder = tmp_path / name
        folder.mkdir()
        file, path = folder / "mine.toml", folder / "out.json"
        file.write_text(text or SYSTEM)
        assert main(["system", str(file), "--output", str(path)]) == 0
        found.append(path.read_bytes())
    values = [json.loads(content)["values"] for content in found]
    assert values[0] != values[1]
    assert found[0] == found[2]


def test_the_record_in_its_forms() -> None:
    about = {"a": {"b": float("inf"), "c": [1, 0.25]}, "none": None, "yes": True}
    assert json.loads(as_line(about)) == provenance(about)
    assert provenance(about)["a"] == {"b": "inf", "c": [1, 0.25]}
    assert (
        in_words(about | {"units": "m"})
        == f"Made by {MADE_BY}: a b inf, c 1, 0.25, yes yes. Units: m."
    )
    assert in_words({"units": "m"}) == f"Made by {MADE_BY}. Units: m."
