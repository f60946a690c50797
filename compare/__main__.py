"""The ``verify`` command: the tables, or one of the subcommands."""

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module

from compare.workers import WorkersError

COMMANDS: tuple[str, ...] = ("system", "listing", "figures", "claims", "chart", "sensitivity")
"""Subcommands, each a module of `compare.commands` with SUMMARY, EPILOG, configure and run."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command; return its exit status, 2 for wrong usage or input."""
    words = list(sys.argv[1:] if argv is None else argv)
    name = words.pop(0) if words and words[0] in COMMANDS else "rows"
    command = import_module(f"compare.commands.{name}")
    program = "verify" if name == "rows" else f"verify {name}"
    description = command.SUMMARY[0].upper() + command.SUMMARY[1:] + "."
    parser = argparse.ArgumentParser(
        prog=program,
        description=description,
        epilog=command.EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.configure(parser)
    options = parser.parse_args(words)
    try:
        return int(command.run(options))
    except (ValueError, OverflowError, WorkersError) as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"{program}: interrupted", file=sys.stderr)
        return 130
    except BrokenPipeError:
        # the reader went away (verify | head): nothing more to say, and no complaint at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


if __name__ == "__main__":
    sys.exit(main())
