"""The pages as a reader has them: opened from the disk, sorted, filtered, narrow, dark, printed."""

from pathlib import Path

import pytest
from browser import Browser
from test_pages import files, records

NARROW = 390


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("pages")
    for name, content in files().items():
        (made / name).parent.mkdir(exist_ok=True)
        (made / name).write_bytes(content)
    return made


PAGES = (
    "index.html",
    "table-1.html",
    "rows/T1-07.html",
    "claims.html",
    "errata.html",
    "figures.html",
)


@pytest.mark.parametrize("page", PAGES)
@pytest.mark.parametrize("width", [1280, NARROW])
def test_a_page_opens_without_complaint(
    page: str, width: int, folder: Path, browser: Browser
) -> None:
    browser.look(width=width, dark=width == NARROW)
    browser.open(folder / page)
    assert browser.complaints() == []
    assert browser.nameless() == []
    # nothing is wider than the screen but what scrolls by itself
    assert browser.run("return document.documentElement.scrollWidth") <= width


def rows(browser: Browser) -> list[str]:
    """The rows that are seen, in their order."""
    return browser.run(
        "return [...document.querySelectorAll('tbody tr[data-row]')]"
        ".filter(row => row.offsetParent !== null).map(row => row.dataset.row)"
    )


def click(browser: Browser, head: str) -> str:
    """Click the head of a column; how it is sorted then."""
    return browser.run(
        "const head = [...document.querySelectorAll('thead th')]"
        ".find(th => th.textContent === arguments[0]);"
        "head.querySelector('button').click(); return head.getAttribute('aria-sort')",
        head,
    )


@pytest.mark.parametrize(
    ("head", "key"), [("as run", "as_run"), ("Hill", "hill"), ("Floquet", "floquet")]
)
def test_a_column_is_sorted_by_every_digit(
    head: str, key: str, folder: Path, browser: Browser
) -> None:
    browser.look()
    browser.open(folder / "table-2.html")
    printed = rows(browser)
    T = {name: record[key]["T"] for name, record in records().items()}
    assert click(browser, head) == "ascending"
    up = [T[name] for name in rows(browser)]
    assert up == sorted(T[name] for name in printed)
    assert click(browser, head) == "descending"
    assert [T[name] for name in rows(browser)] == up[::-1]
    assert click(browser, head) is None
    assert rows(browser) == printed


def test_words_are_sorted_and_rows_with_the_same_stay_in_order(
    folder: Path, browser: Browser
) -> None:
    browser.look()
    browser.open(folder / "table-1.html")
    click(browser, "cause")
    causes = [records()[name]["cause"] for name in rows(browser)]
    assert causes == sorted(causes)
    assert len(set(causes)) > 2
    same = [name for name in rows(browser) if records()[name]["cause"] == causes[-1]]
    assert same == sorted(same)


def test_rows_are_filtered(folder: Path, browser: Browser) -> None:
    browser.look()
    browser.open(folder / "table-3.html")
    enter = (
        "const control = document.querySelector(arguments[0]);"
        "if (control.type === 'checkbox') control.checked = arguments[1];"
        "else control.value = arguments[1];"
        "control.dispatchEvent(new Event('input', {bubbles: true}))"
    )
    everything = {name: r for name, r in records().items() if r["table"] == 3}
    assert rows(browser) == list(everything)
    browser.run(enter, ".controls select", "listing-slip")
    slips = [name for name, r in everything.items() if r["cause"] == "listing-slip"]
    assert rows(browser) == slips
    browser.run(enter, ".controls [type=checkbox]", True)
    wrong = [name for name in slips if everything[name]["flips"]]
    assert 0 < len(wrong) < len(slips)
    assert rows(browser) == wrong
    browser.run(enter, ".controls [type=search]", "t3-01")
    assert rows(browser) == ["T3-01b"]
    counted = browser.run("return document.querySelector('.controls output').textContent")
    assert counted == f"1 of {len(everything)}"


def test_a_reader_who_wants_it_dark_has_it_dark(folder: Path, browser: Browser) -> None:
    shades = {}
    for dark in (False, True):
        browser.look(dark=dark)
        browser.open(folder / "index.html")
        for of in ("backgroundColor", "color"):
            rgb = browser.run(
                "return getComputedStyle(document.body)[arguments[0]].match(/\\d+/g)", of
            )
            shades[dark, of] = sum(map(int, rgb)) / 3
    # on paper near white ink near black, and the other way about
    assert shades[False, "backgroundColor"] - shades[False, "color"] > 150
    assert shades[True, "color"] - shades[True, "backgroundColor"] > 150


def test_the_tables_are_there_without_scripts(folder: Path, browser: Browser) -> None:
    browser.look()
    browser.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        browser.open(folder / "table-1.html")
    finally:
        browser.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})
    assert len(rows(browser)) == 30
    assert browser.run("return document.querySelectorAll('.controls, th button').length") == 0


def test_in_print_no_control_is_left_and_nothing_is_cut(folder: Path, browser: Browser) -> None:
    browser.look(width=720)
    browser.open(folder / "table-1.html")
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        shown = browser.run(
            "return [...document.querySelectorAll('nav, .controls')]"
            ".filter(e => getComputedStyle(e).display !== 'none').length"
        )
        # a sheet of A4 between its margins, in CSS pixels
        wide = browser.run("return document.documentElement.scrollWidth")
    finally:
        browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    assert shown == 0
    assert wide <= 720
