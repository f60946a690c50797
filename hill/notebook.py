"""Results as small tables of HTML, for a notebook to show; nothing is computed.

Everything is escaped: a name from somebody's file is text.
"""

from collections.abc import Container, Iterable, Sequence
from html import escape
from typing import Any

LISTED = 8
"""Coefficients and roots that are listed; of more only the first."""


def table(
    caption: str,
    rows: Iterable[Sequence[str]],
    heads: Sequence[str] = (),
    words: Container[int] = (0,),
) -> str:
    """A table, its cells escaped.

    Parameters
    ----------
    caption : str
    rows : iterable of sequence of str
        The first cell of each is its head.
    heads : sequence of str, optional
        Of the columns.
    words : container of int, optional
        Which columns have words; the others have numbers, which stand on the right.
    """
    lines = [f"<table><caption>{escape(caption)}</caption>"]
    if heads:
        cells = (_cell("th", ' scope="col"', k, head, words) for k, head in enumerate(heads))
        lines.append(f"<thead><tr>{''.join(cells)}</tr></thead>")
    lines.append("<tbody>")
    for row in rows:
        cells = (
            _cell("th" if k == 0 else "td", "" if k else ' scope="row"', k, cell, words)
            for k, cell in enumerate(row)
        )
        lines.append(f"<tr>{''.join(cells)}</tr>")
    return "\n".join([*lines, "</tbody></table>"])


def paragraphs(lines: Iterable[str]) -> str:
    """Sentences, each on its own, escaped."""
    return "\n".join(f"<p>{escape(line)}</p>" for line in lines)


def of_route(name: str, result: Any) -> str:
    """What a route says of an equation: verdict, T, polynomial, roots, each with what bounds it.

    Parameters
    ----------
    name : str
        What made it.
    result : Characteristic or Monodromy
    """
    variable = "z" if len(result.z) else "mu"
    degree = len(result.polynomial) - 1
    rows = [
        ("verdict", result.verdict, ""),
        ("T", _number(result.T), _error(result.T_error)),
    ]
    shown = range(1, min(degree, LISTED) + 1)
    rows += [
        (
            f"P, {variable}^{degree - k}",
            f"{result.polynomial[k]:.12g}",
            _error(result.errors[k]),
        )
        for k in shown
    ]
    roots = result.z if len(result.z) else result.multipliers
    rows += [
        (f"{variable}_{k}", _complex(complex(root)), "")
        for k, root in enumerate(roots[:LISTED], start=1)
    ]
    left = degree - len(shown)
    told = [f"{left} more coefficients and roots."] if left > 0 else []
    told += [f"{result.remark}."] if result.remark else []
    return "\n".join(
        part for part in (table(name, rows, ("", "value", "known to")), paragraphs(told)) if part
    )


def _cell(element: str, scope: str, k: int, text: str, words: Container[int]) -> str:
    side = "left" if k in words else "right"
    return f'<{element}{scope} style="text-align: {side}">{escape(str(text))}</{element}>'


def _number(value: float) -> str:
    return f"{value + 0.0:.9g}"


def _error(value: float) -> str:
    return f"{value:.0e}"


def _complex(value: complex) -> str:
    if value.imag == 0.0:
        return _number(value.real)
    sign = "-" if value.imag < 0.0 else "+"
    return f"{_number(value.real)} {sign} {abs(value.imag):.9g}i"
