"""The public surface of a package, name by name of its ``__all__``, from the docstrings."""

import inspect
from importlib import import_module
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform
from sphinx.util.docutils import SphinxDirective
from sphinx.util.parsing import nested_parse_to_nodes

PACKAGES = ("hill", "floquet", "compare")


class Public(SphinxDirective):
    """``{public} hill``: functions first, then classes, each in alphabetical order."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Ask autodoc for each name; a new one in ``__all__`` needs no line here."""
        package = self.arguments[0]
        module = import_module(package)
        functions, classes = [], []
        for name in sorted(module.__all__, key=str.lower):
            (classes if inspect.isclass(getattr(module, name)) else functions).append(name)
        found: list[nodes.Node] = []
        for title, names, kind in (
            ("Functions", functions, "autofunction"),
            ("Classes", classes, "autoclass"),
        ):
            section = nodes.section(ids=[nodes.make_id(f"{package} {title}")])
            section += nodes.title(title, title)
            lines = [line for name in names for line in (f".. {kind}:: {package}.{name}", "")]
            text = StringList(lines, source=f"{package}.__all__")
            section += rst_nodes(self, text)
            found.append(section)
        return found


def rst_nodes(directive: SphinxDirective, text: StringList) -> list[nodes.Node]:
    """Docstrings are reStructuredText, on a page that is not."""
    from myst_parser.mocking import MockState

    if isinstance(directive.state, MockState):
        lines = ["```{eval-rst}", *text, "```"]
        text = StringList(lines, source=text.source(0))
    return nested_parse_to_nodes(directive.state, text)


class Types(SphinxTransform):
    """In "(n, n) ndarray" n is a number and no attribute of that name: only classes are links."""

    default_priority = 1

    def apply(self, **_: Any) -> None:
        """Leave of other references their text."""
        known = {name for package in PACKAGES for name in import_module(package).__all__}
        for link in list(self.document.findall(addnodes.pending_xref)):
            if link.get("refdomain") == "py" and link["reftarget"].split(".")[-1] not in known:
                link.replace_self(link.children)


def setup(app: Sphinx) -> dict[str, Any]:
    """Offer the directive."""
    app.add_directive("public", Public)
    app.add_transform(Types)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
