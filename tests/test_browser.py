"""The tests' browser sees what it is there to see."""


def test_it_tells_of_errors_of_requests_and_of_what_has_no_name(browser, tmp_path):
    page = tmp_path / "page.html"
    page.write_text(
        "<!doctype html><html lang=en><meta name=viewport content=width=device-width>"
        "<title>a page</title><script>nothing()</script>"
        '<script src="https://example.org/x.js"></script><p>words<button></button>'
        "<label>n <input></label>"
    )
    browser.look(width=390, height=800, dark=True)
    browser.open(page)
    assert browser.driver.title == "a page"
    assert browser.run("return matchMedia('(prefers-color-scheme: dark)').matches")
    assert browser.run("return innerWidth") == 390
    undefined, refused = sorted(browser.complaints(), key=len, reverse=True)
    assert "nothing is not defined" in undefined + refused
    assert "example.org" in undefined + refused
    assert browser.nameless() == ["<button></button>"]
    assert browser.complaints() == []
    browser.picture(tmp_path / "page.png")
    assert (tmp_path / "page.png").read_bytes().startswith(b"\x89PNG")
