"""What a console is given: words as they are, tables no wider than it, the same for a file."""

import io
from collections.abc import Callable

from rich import box
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

UNBOUNDED = 1000
"""Columns that no table has."""


def say(console: Console, line: str, style: str = "", *, whole: bool = False) -> None:
    """A line, broken between words where the console is narrower; brackets are what they are.

    Parameters
    ----------
    whole : bool, optional
        Not broken in a file or a pipe, for what somebody may look for there.
    """
    console.print(
        line,
        style=style,
        markup=False,
        emoji=False,
        highlight=False,
        soft_wrap=whole and not console.is_terminal,
    )


def bare_table(gap: int = 1) -> Table:
    """A table with a line under its heads, and one column more than `gap` between its columns."""
    return Table(
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        show_edge=False,
        header_style="bold",
        padding=(0, gap, 0, 0),
    )


def show(console: Console, table: Table) -> None:
    """Print it, its columns nearer to each other where it would be too wide otherwise."""
    whole = console.options.update(max_width=UNBOUNDED)
    if Measurement.get(console, whole, table).maximum > console.width:
        table.padding = (0, 0, 0, 0)
    console.print(table)


def as_file(write: Callable[[Console], None], width: int = 100) -> str:
    """What `write` prints, for a file of so many columns."""
    buffer = io.StringIO()
    write(Console(file=buffer, width=width, markup=False, emoji=False, highlight=False))
    return buffer.getvalue()
