"""The ``verify`` command: the tables, or one of the subcommands."""

import argparse
import difflib
import os
import re
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any

COMMANDS: tuple[str, ...] = (
    "system",
    "vehicle",
    "chart",
    "sensitivity",
    "simulate",
    "listing",
    "figures",
    "claims",
    "prove",
    "report",
)
"""Subcommands, each a module of `compare.commands` with SUMMARY, EPILOG, configure and run."""

# Thousands of systems of a hundred equations each: on two busy cores two threads of linear algebra
# take seven times as long as one. What the environment says already is left.
MANY_SMALL = ("vehicle", "report")

READER_GONE = 141
"""Exit status of a shell's convention: 128 and the number of the signal."""

SIGNALS = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}
"""What ends a command, and what it says then; its exit status is 128 and the number."""

# What argparse takes for an option otherwise: "-1e-3" behind --x.
NEGATIVE = re.compile(r"^-(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$|^-inf$|^-nan$")


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command; return its exit status, 2 for wrong usage or input."""
    words = list(sys.argv[1:] if argv is None else argv)
    name = words[0] if words and words[0] in COMMANDS else ""
    program = f"verify {name}".strip()
    if sys.stdout is None:
        _say(program, "standard output is closed")
        return 2
    handlers = {number: signal.getsignal(number) for number in SIGNALS}
    with suppress(ValueError):  # not the main thread
        # libraries swallow an exception that meets them while they are imported
        for number in SIGNALS:
            signal.signal(number, lambda number, _: _leave(program, number))
    try:
        status = _run(words)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt as end:
        number = end.number if isinstance(end, _Signalled) else signal.SIGINT
        _say(program, SIGNALS[number])
        return 128 + number
    except BrokenPipeError:
        # the reader went away (verify | head): nothing more to say, and no complaint at exit
        _discard_output()
        return READER_GONE
    except OSError as error:
        _discard_output()
        _say(program, f"standard output: cannot be written ({(error.strerror or '').lower()})")
        return 2
    finally:
        with suppress(ValueError, TypeError):
            for number, handler in handlers.items():
                signal.signal(number, handler)


def _run(words: list[str]) -> int:
    if words and words[0] in ("--version", "-V"):
        print(_version())
        return 0
    if words and words[0] == "help":
        words = [*words[1:2], "--help"]
    if words and words[0] == "rows":
        words = words[1:]
    if words and words[0] not in COMMANDS and not words[0].startswith("-"):
        near = difflib.get_close_matches(words[0], COMMANDS, 1)
        hint = f"did you mean {near[0]}? " if near else ""
        _say("verify", f"{words[0]!r}: {hint}must be one of {', '.join(COMMANDS)}")
        return 2
    name = words.pop(0) if words and words[0] in COMMANDS else "rows"
    program = "verify" if name == "rows" else f"verify {name}"
    if name in MANY_SMALL:
        for library in ("OPENBLAS", "OMP", "MKL"):
            os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    command: Any = import_module(f"compare.commands.{name}")
    options = _parser(command, program, name).parse_args(words)
    from compare.jobs.workers import WorkersError
    from compare.system_code import place_of

    heard: list[signal.Signals] = []

    def signalled(number: int, _frame: Any) -> None:
        """End as an exception does: cursor, files and workers are mended."""
        heard.append(signal.Signals(number))
        raise _Signalled(heard[0])

    with suppress(ValueError):
        for number in SIGNALS:
            signal.signal(number, signalled)
    try:
        status = int(command.run(options))
    except Exception as error:
        # a library may make an error of its own of it, and workers may be ended by it too
        if heard:
            raise _Signalled(heard[0]) from None
        if isinstance(error, (ValueError, OverflowError, MemoryError, WorkersError)):
            _say(program, " ".join(str(error).split()) or "out of memory")
            return 2
        place = place_of(error)
        if not place:
            raise
        # a mistake in somebody's own class
        _say(program, place)
        return 2
    if heard:
        # ... or swallow it
        raise _Signalled(heard[0])
    return status


class _Parser(argparse.ArgumentParser):
    """One that does not keep to itself that its help could not be written."""

    names_others = False
    """Whether the help ends with the other commands, which are imported for it and not before."""

    def format_help(self) -> str:
        """What is printed for --help."""
        if self.names_others:
            summaries = [(c, import_module(f"compare.commands.{c}").SUMMARY) for c in COMMANDS]
            lines = "\n".join(f"  verify {c:<12} {summary}" for c, summary in summaries)
            self.epilog = (
                f"{self.epilog}\n\nother commands:\n{lines}\n"
                "  verify help COMMAND; verify --version"
            )
            self.names_others = False
        return super().format_help()

    def print_help(self, file: Any = None) -> None:
        """Write it, or raise `OSError`."""
        file = file or sys.stdout
        file.write(self.format_help())
        file.flush()


def _parser(command: Any, program: str, name: str) -> argparse.ArgumentParser:
    description = command.SUMMARY[0].upper() + command.SUMMARY[1:] + "."
    parser = _Parser(
        prog=program,
        description=description,
        epilog=command.EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.names_others = name == "rows"
    parser._negative_number_matcher = NEGATIVE
    command.configure(parser)
    return parser


def _version() -> str:
    import platform
    from importlib.metadata import version

    from floquet.batch import kernel_in_use

    parts = [f"{name} {version(name)}" for name in ("numpy", "scipy", "casadi")]
    own = f"floquet-crosscheck {version('floquet-crosscheck')}"
    packages = f"{own} (Python {platform.python_version()}, {', '.join(parts)})"
    return f"{packages}\nmany points at once: {kernel_in_use()}"


class _Signalled(KeyboardInterrupt):
    """A signal that ends the command."""

    def __init__(self, number: signal.Signals) -> None:
        super().__init__(number)
        self.number = number


def _leave(program: str, number: int) -> None:
    """End at once; nothing has been begun."""
    _say(program, SIGNALS[signal.Signals(number)])
    os._exit(128 + number)


def _say(program: str, what: str) -> None:
    if sys.stderr is not None:
        print(f"{program}: {what}", file=sys.stderr)


def _discard_output() -> None:
    """Let nothing be written, or complained of, at exit."""
    sys.stdout = open(os.devnull, "w")  # noqa: SIM115


if __name__ == "__main__":
    sys.exit(main())
