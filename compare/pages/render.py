"""Pages to files: the templates, what they may call, and the style sheet beside them."""

import json
import posixpath
from collections.abc import Callable, Mapping
from importlib.resources import files
from typing import Any

from compare.pages import mathematics
from compare.pages.site import Site

MISSING = 'pages need Jinja2: pip install "floquet-crosscheck[pages]"'

BESIDE = ("pages.css", "tables.js")
"""Files that every set of pages has; written as they are."""


def require() -> None:
    """Raise ValueError where Jinja2 is missing."""
    try:
        import jinja2  # noqa: F401
    except ImportError:
        raise ValueError(MISSING) from None


def rendered(site: Site, progress: Callable[[int, int], Any] | None = None) -> dict[str, bytes]:
    """All files of a set of pages, by path.

    Parameters
    ----------
    site : Site
    progress : callable, optional
        Called with how many pages are done, and of how many.

    Raises
    ------
    ValueError
        Jinja2 is not installed.
    """
    require()
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    folder = files("compare") / "pages" / "templates"
    environment = Environment(
        loader=FunctionLoader(lambda name: (folder / name).read_text(encoding="utf-8")),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= FILTERS
    environment.globals |= {"datum": datum}
    made = {name: (folder / name).read_bytes() for name in BESIDE} | dict(site.files)
    for done, page in enumerate(site.pages, start=1):
        up = "../" * page.path.count("/")
        text = environment.get_template(page.template).render(
            site=site, page=page, c=page.content, up=up, part=page.part or page.path
        )
        made[posixpath.normpath(page.path)] = text.encode()
        if progress:
            progress(done, len(site.pages))
    return made


def datum(record: Mapping[str, Any], key: str, digits: int = 9, shown: Any = None) -> Any:
    """A number of a record with its value for machines, every digit; ``hill.z.0`` is complex.

    Parameters
    ----------
    record : mapping
        What JSON holds.
    key : str
        Names and places in lists, between dots.
    digits : int, optional
    shown : Markup, optional
        What stands there for people instead of so many digits.
    """
    from markupsafe import Markup, escape

    value: Any = record
    for part in key.split("."):
        value = value[int(part)] if isinstance(value, list) else value[part]
    if shown is None:
        if isinstance(value, list):
            shown = Markup(mathematics.complex_number(complex(*value), digits))
        elif isinstance(value, str | bool):
            shown = str(value)
        else:
            shown = Markup(mathematics.number(value, digits))
    exact = json.dumps(value)
    return Markup('<data value="{}" data-is="{}">{}</data>').format(escape(exact), key, shown)


def _marked(make: Callable[..., str]) -> Callable[..., Any]:
    """What makes HTML by itself: not escaped again."""

    def made(*given: Any, **named: Any) -> Any:
        from markupsafe import Markup

        return Markup(make(*given, **named))

    return made


FILTERS: dict[str, Callable[..., Any]] = {
    "maths": _marked(mathematics.as_html),
    "mathtext": _marked(mathematics.from_mathtext),
    "plain": mathematics.plain,
    "number": _marked(mathematics.number),
    "complex": _marked(mathematics.complex_number),
    "words_of_mathtext": mathematics.words_of_mathtext,
}
