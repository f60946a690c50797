"""Every wrong command in a process of its own, with its time."""

import argparse
import os
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from benchmarks.bad_commands import COMMANDS, files
from benchmarks.bad_commands.judge import Told, contents, faults
from compare.__main__ import main as verify

# Seconds that a wrong command may take, and after which it is ended.
LONGEST, GIVEN_UP = 5.0, 20.0

SLOWEST = 10
"""Of them are printed."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all, print what is wrong, the count and the slowest; 0 where nothing is wrong."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.bad_commands",
        description="Wrong commands: status 2, one clear line, within seconds, nothing written.",
    )
    parser.add_argument("--only", default="", metavar="TEXT", help="those with it in their name")
    parser.add_argument("--say", action="store_true", help="print every line that was said")
    options = parser.parse_args(arguments)
    chosen = {name: case for name, case in COMMANDS.items() if options.only in name}
    if not chosen:
        parser.error(f"--only {options.only!r}: no command has such a name")
    bad, times = 0, []
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place, "files")
        folder.mkdir()
        files(folder)
        os.chdir(folder)
        before = contents(folder)
        _load()
        for name, (words, named) in chosen.items():
            begun = time.perf_counter()
            told = _told(words, Path(place))
            times.append((time.perf_counter() - begun, name))
            wrong = faults(told, named)
            if times[-1][0] > LONGEST:
                wrong.append(f"takes {times[-1][0]:.1f} s")
            after = contents(folder)
            if after != before:
                wrong.append("leaves or changes a file")
                before = after
            bad += bool(wrong)
            if wrong or options.say:
                last = told.err.strip().splitlines()[-1:]
                print(f"{name}: {'; '.join(wrong) or 'as it should be'}\n    {' '.join(last)}")
        os.chdir(place)
    print(f"{len(chosen)} wrong commands, {bad} not as they should be; the slowest:")
    for seconds, name in sorted(times, reverse=True)[:SLOWEST]:
        print(f"{seconds:6.2f} s  {name}")
    return 1 if bad else 0


def _load() -> None:
    """What every command loads, once: the times are of what is done and not of imports."""
    from compare.commands import (  # noqa: F401 - to have them
        chart,
        claims,
        figures,
        listing,
        report,
        rows,
        sensitivity,
        simulate,
        system,
        vehicle,
    )


def _told(words: list[str], place: Path) -> Told:
    """Run one in a copy of this process, and end it where it does not end."""
    paths = [place / name for name in ("out", "err")]
    sys.stdout.flush()
    process = os.fork()
    if process == 0:
        _run(words, paths)
    status = _status(process)
    out, err = (path.read_text(encoding="utf-8", errors="replace") for path in paths)
    return Told(status, out, err)


def _run(words: list[str], paths: list[Path]) -> None:
    """In the copy: never returns."""
    status = 1
    try:
        for number, path in enumerate(paths, start=1):
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
        # whatever this process had in their place
        sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False)  # noqa: SIM115
        try:
            status = verify(words)
        except SystemExit as end:  # argparse
            status = end.code if isinstance(end.code, int) else 1
        except BaseException:
            import traceback

            traceback.print_exc()
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        os._exit(status)


def _status(process: int) -> int:
    deadline = time.monotonic() + GIVEN_UP
    while time.monotonic() < deadline:
        ended, status = os.waitpid(process, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.002)
    os.kill(process, signal.SIGKILL)
    os.waitpid(process, 0)
    return -1
