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
    "listing",
    "figures",
    "claims",
)
"""Subcommands, each a module of `compare.commands` with SUMMARY, EPILOG, configure and run."""

# Thousands of systems of a hundred equations each: on two busy cores two threads of linear algebra
# take seven times as long as one. What the environment says already is left.
MANY_SMALL = ("vehicle",)

INTERRUPTED, ENDED, READER_GONE = 130, 143, 141
"""Exit statuses of a shell's convention: 128 and the number of the signal."""

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
    handlers = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGINT)}
    # a signal that ends the process ends it as an exception: cursor, files, workers are mended
    with suppress(ValueError):  # not the main thread
        signal.signal(signal.SIGTERM, _terminate)
        # libraries swallow a Ctrl-C that meets them while they are imported
        signal.signal(signal.SIGINT, lambda *_: _leave(program))
    try:
        status = _run(words)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        _say(program, "interrupted")
        return INTERRUPTED
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

    with suppress(ValueError):
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return int(command.run(options))
    except (ValueError, OverflowError, MemoryError, WorkersError) as error:
        _say(program, " ".join(str(error).split()) or "out of memory")
        return 2
    except RuntimeError as error:
        # CasADi turns Ctrl-C into an error of its own
        if "KeyboardInterrupt" in str(error):
            raise KeyboardInterrupt from None
        raise


def _parser(command: Any, program: str, name: str) -> argparse.ArgumentParser:
    description = command.SUMMARY[0].upper() + command.SUMMARY[1:] + "."
    epilog = command.EPILOG
    if name == "rows":
        summaries = [(c, import_module(f"compare.commands.{c}").SUMMARY) for c in COMMANDS]
        lines = "\n".join(f"  verify {c:<12} {summary}" for c, summary in summaries)
        epilog = f"{epilog}\n\nother commands:\n{lines}\n  verify help COMMAND; verify --version"
    parser = argparse.ArgumentParser(
        prog=program,
        description=description,
        epilog=epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser._negative_number_matcher = NEGATIVE
    command.configure(parser)
    return parser


def _version() -> str:
    import platform
    from importlib.metadata import version

    parts = [f"{name} {version(name)}" for name in ("numpy", "scipy", "casadi")]
    own = f"floquet-crosscheck {version('floquet-crosscheck')}"
    return f"{own} (Python {platform.python_version()}, {', '.join(parts)})"


def _terminate(_signal: int, _frame: Any) -> None:
    sys.exit(ENDED)


def _leave(program: str) -> None:
    """End at once; nothing has been begun."""
    _say(program, "interrupted")
    os._exit(INTERRUPTED)


def _say(program: str, what: str) -> None:
    if sys.stderr is not None:
        print(f"{program}: {what}", file=sys.stderr)


def _discard_output() -> None:
    """Let nothing be written, or complained of, at exit."""
    sys.stdout = open(os.devnull, "w")  # noqa: SIM115


if __name__ == "__main__":
    sys.exit(main())
