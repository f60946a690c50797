"""What the commands share at the terminal: its width, and a bar on the standard error."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

WIDE = 140
"""Columns where there is no terminal to ask."""


class _Output(Console):
    """A console that leaves a reader that went away to the command, and so its exit status."""

    def on_broken_pipe(self) -> None:
        """Tell the command."""
        raise BrokenPipeError


def terminal() -> Console:
    """The standard output: as wide as it is, or wide enough for everything."""
    console = _Output()
    return console if console.is_terminal else _Output(width=WIDE)


@contextmanager
def progress(what: str, total: int) -> Iterator[Callable[[object], None]]:
    """A bar on the standard error, where that is a terminal; yields what moves it on by one."""
    console = Console(stderr=True)
    bar = Progress(
        TextColumn(what),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    task = bar.add_task(what, total=total)
    with _running(bar):
        yield lambda _: bar.advance(task)


@contextmanager
def stages() -> Iterator[Callable[[str, int, int], None]]:
    """A bar for one thing after another; yields what says which, how much of it, and of how much.

    Of "thousandths of the range" the share is told beside the nodes.
    """
    console = Console(stderr=True)
    bar = Progress(
        SpinnerColumn(),
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[count]}"),
        TimeElapsedColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    task = bar.add_task("beginning", total=None, count="")
    share = ""

    def stage(what: str, done: int, total: int) -> None:
        nonlocal share
        if what == "thousandths of the range":
            share = f", {done / 10:.0f}% of the range"
            return
        count = f"{done} of {total}" + (share if what == "nodes" else "") if total else ""
        bar.update(task, description=what, completed=done, total=total or None, count=count)

    with _running(bar):
        yield stage


@contextmanager
def working(what: str) -> Iterator[None]:
    """A line on the standard error, with the seconds, while there are no steps to count."""
    console = Console(stderr=True)
    columns = (SpinnerColumn(), TextColumn(what), TimeElapsedColumn())
    bar = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
    bar.add_task(what, total=None)
    with _running(bar):
        yield


@contextmanager
def _running(bar: Progress) -> Iterator[None]:
    """A bar while it is needed, and the cursor back, wherever a signal meets it."""
    try:
        with bar:
            yield
    except BaseException:
        # it may have been met half begun
        bar.stop()
        bar.console.show_cursor()
        raise
