"""docs/errata.md is what the errata and the computation say, on any machine."""

from importlib import import_module
from pathlib import Path

import pytest

from compare.publications.kincaid import check
from compare.report.errata import all_errata
from compare.report.row import Outcome
from compare.report.tables import all_rows

errata_page = import_module("compare.report.errata_page")
errata_tables = import_module("compare.report.errata_tables")

PAGE = Path(__file__).parent.parent / "docs" / "errata.md"


@pytest.fixture(scope="module")
def outcomes() -> tuple[Outcome, ...]:
    return tuple(check(row) for row in all_rows())


def test_page_is_up_to_date(outcomes: tuple[Outcome, ...]) -> None:
    """If not: python -m compare.report.errata_page."""
    assert errata_page.page(outcomes) == PAGE.read_text(encoding="utf-8")
    assert errata_page.PAGE.parts == PAGE.parts[-2:]


def test_page_computes_what_it_is_not_given(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(errata_page, "all_rows", lambda: ("T1-01", "T1-02"))
    monkeypatch.setattr(errata_page, "check", asked.append)
    with pytest.raises(AttributeError):
        errata_page.page()
    assert asked == ["T1-01", "T1-02"]


def test_numbers_are_the_same_on_any_machine(
    outcomes: tuple[Outcome, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """No number on the page is nearer than rounding noise to where its last digit turns."""
    shown = []
    fixed, power = errata_tables._fixed, errata_tables._power

    def watched_fixed(value: float, digits: int) -> str:
        # 1e-9 is far above what another BLAS changes (1e-11 for z and T), far below a digit
        shown.append({fixed(value + d, digits) for d in (-1e-9, 0.0, 1e-9)})
        return fixed(value, digits)

    def watched_power(value: float, digits: int = 0) -> str:
        shown.append({power(value + d, digits) for d in (-1e-9, 0.0, 1e-9)})
        return power(value, digits)

    monkeypatch.setattr(errata_tables, "_fixed", watched_fixed)
    monkeypatch.setattr(errata_tables, "_power", watched_power)
    errata_page.page(outcomes)
    assert len(shown) > 50
    assert [texts for texts in shown if len(texts - {"-0.00000"}) > 1] == []


def test_every_erratum_is_on_the_page() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for erratum in all_errata():
        assert text.count(f"\n### {erratum.where}\n") == 1
        assert erratum.why in text
        assert f"Shown by `{erratum.test}`." in text
        if erratum.corrected:
            assert erratum.printed in text
            assert erratum.corrected in text


def test_verdicts_on_the_page(outcomes: tuple[Outcome, ...]) -> None:
    """One line for each row whose verdict changes, and no other."""
    text = PAGE.read_text(encoding="utf-8").split("## Verdicts that change")[1]
    table = text.split("##")[0].strip().splitlines()[5:]
    lines = [line.split("|")[1].strip() for line in table]
    assert lines == [o.row.id for o in outcomes if o.verdict != o.verdict_printed]
    assert all(("→ stable" in line) != ("→ unstable" in line) for line in table)
