"""docs/proofs.md is what the enclosures say; a sample of its rows is computed again."""

import re
from importlib import import_module
from pathlib import Path

import pytest

from compare.report.proofs import prove_row
from compare.report.tables import all_rows

proofs_page = import_module("compare.report.proofs_page")

PAGE = Path(__file__).parent.parent / "docs" / "proofs.md"
TEXT = PAGE.read_text(encoding="utf-8")
LINES = {
    cells[0]: (line, cells)
    for line in TEXT.splitlines()
    if re.match(r"\| T\d-", line)
    for cells in [[cell.strip() for cell in line.strip("|").split("|")]]
}
ROWS = {row.id: row for row in all_rows()}


@pytest.mark.parametrize("name", ["T1-14", "T2-02", "T2-27", "T3-02a"])
def test_rows_are_up_to_date(name: str) -> None:
    """If not: python -m compare.report.proofs_page, which computes all of them in two minutes."""
    assert proofs_page.line(prove_row(ROWS[name], interval=True)) == LINES[name][0]


def test_every_row_is_there_once() -> None:
    assert list(LINES) == [row.id for row in all_rows()]
    assert len(re.findall(r"^\| T\d-", TEXT, re.M)) == len(LINES)


def test_the_summary_is_what_the_table_says() -> None:
    proven = [cells[7] for _, cells in LINES.values()]
    everywhere = [cells[8] for _, cells in LINES.values()]
    wrong = sum("->" in cell for cell in proven)
    undecided = sum(cell == "undecided" for cell in proven)
    one = [cell for cell in everywhere if not cell.startswith(("both", "undecided"))]
    assert f"> {len(proven) - undecided} of {len(proven)} verdicts are proven" in TEXT
    assert f"; {wrong} printed verdicts are wrong." in TEXT
    assert f"printed one {len(one)} are proven" in TEXT
    assert f"{sum('->' in cell for cell in one)} of them wrong in print" in TEXT


def test_what_is_not_on_the_page_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The text is the module's; only rows come from outside."""
    row = prove_row(ROWS["T2-27"], interval=True)
    written = proofs_page.page([row])
    above = written.split("## Row by row")[0]
    assert above.split("> ")[0] == TEXT.split("> ")[0]
    assert above.split("## Under")[1] == TEXT.split("## Under")[1].split("## Row by row")[0]
    asked = []
    monkeypatch.setattr(proofs_page, "all_rows", lambda: ("T1-01",))
    monkeypatch.setattr(proofs_page, "mapper", _Here)
    monkeypatch.setattr(proofs_page, "prove_row", lambda row, interval: asked.append(row) or 1)
    with pytest.raises(AttributeError):
        proofs_page.page()
    assert asked == ["T1-01"]


class _Here:
    def __init__(self, _: int) -> None:
        pass

    def __enter__(self) -> object:
        return map

    def __exit__(self, *_: object) -> None:
        pass
