"""Mathematics as MathML, which browsers render by themselves: no script and no network.

The translation is that of docutils; Sphinx's own choice, MathJax, loads a script from elsewhere.
"""

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml
from sphinx.application import Sphinx
from sphinx.errors import SphinxError
from sphinx.util.math import get_node_equation_number

APPLIED = re.compile(r"<mo>&ApplyFunction;</mo>(?=\s*<(?!/mrow|mo\b))")
"""A function before anything but a bracket."""


def as_mathml(formula: str, *, block: bool) -> str:
    """A formula, or a build that fails: one that cannot be read is not printed raw."""
    try:
        found = str(latex2mathml.tex2mathml(formula, as_block=block))
    except MathError as error:
        raise SphinxError(f"mathematics: {formula!r}: {error}") from error
    # browsers set cos x as cosx
    return APPLIED.sub(r"\g<0><mspace width='0.17em'/>", found)


def inline(self: Any, node: nodes.math) -> None:
    """Within a line."""
    self.body.append(as_mathml(node.astext(), block=False))
    raise nodes.SkipNode


def displayed(self: Any, node: nodes.math_block) -> None:
    """On a line of its own, its number behind it; wide ones scroll."""
    self.body.append('<div class="math" tabindex="0">')
    if node["number"]:
        number = get_node_equation_number(self, node)
        self.body.append(f'<span class="eqno">({number})</span>')
    self.body.append(as_mathml(node.astext(), block=True))
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Offer the renderer."""
    app.add_html_math_renderer("mathml", (inline, None), (displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
