"""docs/proofs.md is what the enclosures say; a sample of its rows is computed again."""

import re
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from compare import chart
from compare.report.proofs import prove_row
from compare.report.tables import all_rows
from hill import UniformBeam

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


def test_rows_without_one_verdict_are_told_with_the_reason() -> None:
    names = [name for name, (_, cells) in LINES.items() if cells[8].startswith("both")]
    told = dict(re.findall(r"^- \*\*(T[\w-]+)\*\*, (.*)$", TEXT, re.M))
    assert list(told) == names == ["T1-14", "T2-21"]
    for name in names:
        _, cells = LINES[name]
        edge = re.search(r"an edge at ([\d.]+),", told[name])
        assert edge
        assert f"from {edge[1]} to" in cells[8]
        assert f"; {cells[7].strip('*-> ').lower()} at {cells[2]}, where it was run." in told[name]


def test_the_chart_s_share_is_told() -> None:
    """Its cells and areas add up; python -m compare.report.proofs_page computes it in a minute."""
    found = re.search(
        r"^> ([\d.]+)% of the area is proven, ([\d.]+)% stable and ([\d.]+)% unstable; of the "
        r"40,000 cells ([\d,]+) are proven stable, ([\d,]+) unstable, ([\d.]+)% in all. "
        r"0 verdicts of the floats contradict it.$",
        TEXT,
        re.M,
    )
    assert found
    area, stable, unstable, *cells, whole = (float(x.replace(",", "")) for x in found.groups())
    assert area == pytest.approx(stable + unstable, abs=0.011)
    assert whole == pytest.approx(100.0 * sum(cells) / 40_000, abs=0.06)


def test_what_is_not_on_the_page_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The text is the module's; only rows come from outside."""
    row = prove_row(ROWS["T2-27"], interval=True)
    small = [("Omega", 2.6, 2.8, 9), ("gamma", 0.05, 0.2, 6)]
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
    charted = chart(beam, small, route="floquet", certify=True)
    written = proofs_page.page([row], charted)
    assert f"> {1.0 - charted.certified.undecided:.2%} of the area is proven" in written
    assert "of the 54 cells" in written
    above = written.split("## Row by row")[0]
    assert above.split("> ")[0] == TEXT.split("> ")[0]
    assert above.split("## Under")[1] == TEXT.split("## Under")[1].split("## Row by row")[0]
    asked: list[Any] = []
    monkeypatch.setattr(proofs_page, "all_rows", lambda: ("T1-01",))
    monkeypatch.setattr(proofs_page, "mapper", _Here)
    monkeypatch.setattr(proofs_page, "prove_row", lambda row, interval: asked.append(row) or 1)
    monkeypatch.setattr(proofs_page, "chart", lambda *what, **how: asked.append((what, how)))
    with pytest.raises(AttributeError):
        proofs_page.page()
    assert asked[0] == "T1-01"
    (system, axes), how = asked[1]
    assert system == beam
    assert [axis[3] for axis in axes] == [200, 200]
    assert how["certify"]


class _Here:
    def __init__(self, *_: int, **__: bool) -> None:
        pass

    def __enter__(self) -> object:
        return map

    def __exit__(self, *_: object) -> None:
        pass
