"""What the commands share at the terminal: its width, and a bar on the standard error."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from compare.output import write_whole

WIDE = 140
"""Columns where there is no terminal to ask."""


class _Output(Console):
    """A console that leaves a reader that went away to the command, and so its exit status."""

    def on_broken_pipe(self) -> None:
        """Tell the command."""
        raise BrokenPipeError


def terminal() -> Console:
    """The standard output: as wide as it is, or wide enough for everything."""
    console = _Output(markup=False, emoji=False)
    return console if console.is_terminal else _Output(width=WIDE, markup=False, emoji=False)


def deliver(content: str, path: Path | None) -> None:
    """To the standard output, or whole into a file."""
    if path is not None:
        write_whole(path, content)
        return
    sys.stdout.write(content)
    sys.stdout.flush()


@contextmanager
def _bar(*columns: ProgressColumn) -> Iterator[Progress]:
    """On the standard error, where that is a terminal; elsewhere nothing is written at all."""
    console = Console(stderr=True)
    bar = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
    if bar.disable:
        yield bar
        return
    try:
        with bar:
            yield bar
    except BaseException:
        # a signal may have met it half begun: the cursor back
        bar.stop()
        bar.console.show_cursor()
        raise


@contextmanager
def progress(what: str, total: int) -> Iterator[Callable[[object], None]]:
    """A bar on the standard error, where that is a terminal; yields what moves it on by one."""
    with _bar(TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()) as bar:
        task = bar.add_task(what, total=total)
        yield lambda _: bar.advance(task)


@contextmanager
def stages() -> Iterator[Callable[[str, int, int], None]]:
    """A bar for one thing after another; yields what says which, how much of it, and of how much.

    Of "thousandths of the range" the share is told beside the nodes.
    """
    columns = (
        SpinnerColumn(),
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[count]}"),
        TimeElapsedColumn(),
    )
    share = ""

    def stage(what: str, done: int, total: int) -> None:
        nonlocal share
        if what == "thousandths of the range":
            share = f", {done / 10:.0f}% of the range"
            return
        count = f"{done} of {total}" + (share if what == "nodes" else "") if total else ""
        bar.update(task, description=what, completed=done, total=total or None, count=count)

    with _bar(*columns) as bar:
        task = bar.add_task("beginning", total=None, count="")
        yield stage


@contextmanager
def working(what: str) -> Iterator[None]:
    """A line on the standard error, with the seconds, while there are no steps to count."""
    with _bar(SpinnerColumn(), TextColumn(what), TimeElapsedColumn()) as bar:
        bar.add_task(what, total=None)
        yield
