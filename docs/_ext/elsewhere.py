"""Links out of docs/, as they are right in the repository: to files that the site does not have.

``../examples/beck.toml`` is a link on a page of the repository. In the site the file is offered
for download, and a link to a folder or to another page of Markdown is left as its text.
"""

from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform


class Elsewhere(SphinxTransform):
    """Before references are resolved."""

    default_priority = 1

    def apply(self, **_: Any) -> None:
        """Turn each link that begins with ``../`` into what the site has of it."""
        folder = Path(self.env.doc2path(self.env.docname)).parent
        for link in list(self.document.findall(nodes.reference)):
            self._turn(link, str(link.get("refuri", "")), folder)
        for link in list(self.document.findall(addnodes.pending_xref)):
            if link.get("refdomain") == "doc" and link["reftarget"] not in self.env.found_docs:
                link.replace_self(nodes.inline(link.astext(), link.astext()))
            else:
                self._turn(link, str(link.get("reftarget", "")), folder)
        for link in list(self.document.findall(addnodes.download_reference)):
            self._turn(link, str(link.get("reftarget", "")), folder)

    def _turn(self, link: nodes.Element, target: str, folder: Path) -> None:
        if not target.startswith("../"):
            return
        path = (folder / target.partition("#")[0]).resolve()
        if path.is_file() and path.suffix != ".md":
            return
        text = nodes.literal if path.suffix != ".md" else nodes.inline
        link.replace_self(text(link.astext(), link.astext()))


def setup(app: Sphinx) -> dict[str, Any]:
    """Add the transform."""
    app.add_transform(Elsewhere)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
