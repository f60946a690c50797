"""A page as a reader has it: headless Chromium, without a network."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest

CHROMIUM = ("chromium", "chromium-browser", "google-chrome", "chrome")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # no name is resolved: what asks for one gets an error, and the error is in the log
    "--host-resolver-rules=MAP * ~NOTFOUND",
)
LONGEST = 60
"""Seconds that a page, or a script in it, may take."""


class Browser:
    """One window; `driver` is selenium's."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def open(self, page: Path) -> None:
        """A file, as a double click opens it; what was said before is forgotten."""
        self.complaints()
        self.driver.get(page.resolve().as_uri())

    def run(self, script: str, *arguments: Any) -> Any:
        """The body of a function in the page; promises are awaited."""
        return self.driver.execute_script(script, *arguments)

    def complaints(self) -> list[str]:
        """Errors and warnings of the console since the last time, failed requests among them."""
        log = self.driver.get_log("browser")
        return [line["message"] for line in log if line["level"] in ("SEVERE", "WARNING")]

    def look(self, *, width: int = 1280, height: int = 900, dark: bool = False) -> None:
        """The screen, in CSS pixels, and the reader's colour scheme."""
        screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})

    def picture(self, path: Path) -> None:
        """What is seen, as PNG."""
        path.write_bytes(self.driver.get_screenshot_as_png())

    def nameless(self) -> list[str]:
        """What a screen reader meets and cannot name: controls, pictures and frames."""
        return self.run("""
            const named = e => (e.getAttribute("aria-label") || e.getAttribute("alt") ||
                e.getAttribute("title") || e.getAttribute("aria-labelledby") ||
                (e.labels && e.labels.length) || e.textContent.trim());
            const of = "a[href], button, input:not([type=hidden]), select, textarea, summary, " +
                "img, [role=img], iframe";
            return [...document.querySelectorAll(of)].filter(e => !named(e)).map(e => e.outerHTML);
        """)


@contextmanager
def started() -> Iterator[Browser]:
    """A browser of one's own; the test is skipped where there is none."""
    webdriver = pytest.importorskip("selenium.webdriver", reason="no selenium: no browser is asked")
    program = next(filter(None, map(shutil.which, CHROMIUM)), None)
    driver = shutil.which("chromedriver")
    if program is None or driver is None:
        pytest.skip("no browser: needs chromium and chromedriver")
    with TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = webdriver.ChromeOptions()
        options.binary_location = program
        for flag in (*FLAGS, f"--user-data-dir={profile}"):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        service = webdriver.ChromeService(executable_path=driver)
        try:
            window = webdriver.Chrome(options=options, service=service)
        except Exception as why:
            pytest.skip(f"the browser does not start: {str(why).splitlines()[0]}")
        try:
            window.set_page_load_timeout(LONGEST)
            window.set_script_timeout(LONGEST)
            yield Browser(window)
        finally:
            window.quit()
