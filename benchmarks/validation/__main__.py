"""``python -m benchmarks.validation [--output docs/validation.md]``."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import track

from benchmarks.validation.page import SOURCES, page
from compare.output import check_writable, write_whole

PAGE = Path("docs/validation.md")


def main(argv: Sequence[str] | None = None) -> int:
    """Compute every number and write the page; 1 if one differs."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.validation", description=__doc__)
    parser.add_argument("--output", type=Path, default=PAGE, metavar="FILE")
    args = parser.parse_args(argv)
    try:
        check_writable(args.output)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    found = [source() for source in track(SOURCES, "sources", console=Console(stderr=True))]
    write_whole(args.output, page(found))
    print(f"written: {args.output}")
    return int(any(number.found == "**no**" for source in found for number in source.numbers))


if __name__ == "__main__":
    sys.exit(main())
