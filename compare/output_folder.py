"""Writing a folder whole or not at all."""

import json
import os
import shutil
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

LIST = "made-by.json"
"""Says of a folder that it is ours, and which files it has."""


def check_folder(path: Path) -> Path:
    """Refuse before the work what would be refused after it; return where it really is.

    A folder is ours if its `LIST` names every file in it: whatever else lies there would be lost.

    Raises
    ------
    ValueError
        `path` is a file, the folder of the shell, or has files in it that are not ours; its parent
        does not exist or cannot be written to.
    """
    if "\0" in str(path):
        raise _refusal(path, "no such name")
    try:
        target = path.resolve()
        if target.exists() and not target.is_dir():
            raise _refusal(path, "is a file")
        if Path.cwd().resolve().is_relative_to(target):
            raise _refusal(path, "is the current directory, or has it in it; give another")
        if not os.access(target.parent, os.W_OK | os.X_OK):
            there = target.parent.is_dir()
            raise _refusal(path, "permission denied" if there else "no such directory")
        foreign = _foreign(target) if target.exists() else ""
    except (OSError, RuntimeError) as error:
        raise _refusal(path, error) from None
    if foreign:
        raise _refusal(path, f"it has files that are not of this command, such as {foreign!r}")
    return target


def write_folder(path: Path, content: Mapping[str, bytes], about: Mapping[str, Any]) -> None:
    """Write files by their paths in a folder, through one beside it that takes its place.

    Parameters
    ----------
    path : Path
    content : mapping of str to bytes
    about : mapping
        What made them, for `LIST`.

    Raises
    ------
    ValueError
        As of `check_folder`; what was there before is untouched.
    """
    target = check_folder(path)
    listed = dict(about) | {"files": sorted([*content, LIST])}
    files = dict(content) | {LIST: (json.dumps(listed, indent=1) + "\n").encode()}
    try:
        made = Path(tempfile.mkdtemp(dir=target.parent, prefix=".unfinished-"))
    except OSError as error:
        raise _refusal(path, error) from None
    try:
        for name, data in files.items():
            (made / name).parent.mkdir(parents=True, exist_ok=True)
            (made / name).write_bytes(data)
        # mkdtemp makes the folder private; give it what it had, or what a plain mkdir would give
        mask = os.umask(0)
        os.umask(mask)
        made.chmod(target.stat().st_mode & 0o777 if target.exists() else 0o777 & ~mask)
        _exchange(made, target)
    except BaseException as error:
        shutil.rmtree(made, ignore_errors=True)
        if isinstance(error, OSError):
            raise _refusal(path, error) from None
        raise


def _exchange(made: Path, target: Path) -> None:
    """Put the new folder in the old one's place; the old one comes back if that fails."""
    if not target.exists():
        made.rename(target)
        return
    aside = Path(tempfile.mkdtemp(dir=target.parent, prefix=".replaced-"))
    old = aside / "old"
    try:
        target.rename(old)
        made.rename(target)
    except BaseException:
        if old.exists() and not target.exists():
            old.rename(target)
        raise
    finally:
        if target.exists():
            shutil.rmtree(aside, ignore_errors=True)


def _foreign(folder: Path) -> str:
    """A file in it that its list does not name."""
    known: set[str] = set()
    with suppress(OSError, ValueError, KeyError, TypeError):
        known = set(json.loads((folder / LIST).read_text(encoding="utf-8"))["files"])
    for here, _, names in os.walk(folder, onerror=_raise):
        for name in sorted(names):
            own = (Path(here) / name).relative_to(folder).as_posix()
            if own not in known:
                return own
    return ""


def _raise(error: OSError) -> None:
    raise error


def _refusal(path: Path, reason: object) -> ValueError:
    if isinstance(reason, Exception):
        reason = (getattr(reason, "strerror", None) or str(reason)).lower()
    return ValueError(f"output = {str(path)!r}: cannot be written ({reason})")
