"""What a wrong command did, and what is wrong with that."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Told:
    """What a command did.

    Attributes
    ----------
    status : int
        Exit status; -1 where it did not end by itself.
    out, err : str
    """

    status: int
    out: str
    err: str


def faults(told: Told, named: str) -> list[str]:
    """What is wrong with it, in a few words each; nothing where it is as it should be."""
    found = []
    if told.status != 2:
        found.append("does not end" if told.status < 0 else f"status {told.status}")
    if "Traceback" in told.err or "Warning:" in told.err:
        found.append("an exception or a warning is shown")
    if told.out:
        found.append("prints to the standard output")
    lines = told.err.rstrip("\n").splitlines()
    # argparse shows the usage before its line
    own = lines[-1:] if lines and lines[0].startswith("usage:") else lines
    if len(own) != 1:
        found.append(f"{len(own)} lines")
    elif not own[0].startswith("verify"):
        found.append("does not say who speaks")
    elif named not in own[0]:
        found.append(f"does not name {named!r}")
    return found


def contents(folder: Path) -> dict[Path, int]:
    """Every file and when it was last written; what Python keeps of modules does not count."""
    return {
        path: path.stat().st_mtime_ns
        for path in _walk(folder)
        if path.is_file() or not any(path.iterdir())
    }


def _walk(folder: Path) -> Iterable[Path]:
    return (path for path in folder.rglob("*") if "__pycache__" not in path.parts)
