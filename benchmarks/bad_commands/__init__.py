"""Wrong commands, each with what its one line must name; files that they need are made by `files`.

Every one is to end with status 2 and one clear line, within seconds and with nothing written.
"""

from pathlib import Path

from benchmarks.bad_commands import report, systems, vehicles

COMMANDS: dict[str, tuple[list[str], str]] = {
    **report.COMMANDS, **systems.commands(), **vehicles.commands()
}  # fmt: skip
"""Name to words, and to what the line names."""


def files(folder: Path) -> None:
    """Write what the commands ask for into the folder that they are run in."""
    for part in (report, systems, vehicles):
        part.files(folder)
