"""docs/validation.md is what the computation says: most of it is computed again and compared."""

import re
from decimal import Decimal
from pathlib import Path

import pytest

from benchmarks.validation import beams, page, periodic
from benchmarks.validation.__main__ import main
from benchmarks.validation.comparison import Comparison

TEXT = (Path(__file__).parents[1] / "docs" / "validation.md").read_text(encoding="utf-8")
AGAIN = {source.__name__: source for source in page.SOURCES if source is not beams.rotating}


def written(title: str) -> list[list[str]]:
    """Cells of a section's table."""
    section = TEXT.split(f"## {title}\n")[1].split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows[2:]]


@pytest.mark.parametrize("name", AGAIN)
def test_numbers_are_up_to_date(name: str) -> None:
    """If not: python -m benchmarks.validation."""
    if AGAIN[name].__module__ == beams.__name__:
        pytest.importorskip("skfem", reason="needs the extra: vehicle")
    source = AGAIN[name]()
    rows = written(source.title)
    assert len(rows) == len(source.numbers)
    for row, number in zip(rows, source.numbers, strict=True):
        now = number.cells()
        assert (row[0], row[1], row[4]) == (now[0], now[1], now[4])
        for then, there in zip(row[2:4], now[2:4], strict=True):
            # one processor rounds differently from the next: a unit, and what arithmetic adds
            unit = 10.0 ** int(Decimal(row[1]).as_tuple().exponent - 1)
            assert then == there or abs(float(then) - float(there)) <= unit + number.rounding


def test_the_summary_counts_the_tables() -> None:
    cells = [row[4] for title in re.findall(r"^## (.*)$", TEXT, re.M) for row in written(title)]
    said = re.search(r"^> (\d+) numbers: (\d+) are the same, (\d+) to a unit of", TEXT, re.M)
    assert said is not None
    counts = len(cells), cells.count("yes"), cells.count("to a unit")
    assert said.groups() == tuple(map(str, counts))
    assert "last digit, 0 differ." in TEXT


def test_a_wrong_number_is_seen() -> None:
    """A digit changed, in the source or in either route."""
    assert Comparison("x", "1.234", 1.2341, 1.2339).found == "yes"
    assert Comparison("x", "1.234", 1.2348, 1.2348).found == "to a unit"
    assert Comparison("x", "1.234", 1.2341, 1.2355).found == "**no**"
    assert Comparison("x", "1.234", None, 1.2325).found == "**no**"


def test_characteristic_values_do_not_lean_on_print() -> None:
    """From a printed number that is off by 1e-4 the root is the same."""
    for solve in periodic.ROUTES:
        found = periodic.characteristic_value(solve, "3.9171247729984712", 1, 1.0)
        # dz/da is of order 1, z is known to 1e-13
        assert found == pytest.approx(3.9170247729984712, abs=1e-12)


def test_a_page_that_cannot_be_written(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--output", "no/such/folder/page.md"]) == 2
    assert "no/such/folder" in capsys.readouterr().err
