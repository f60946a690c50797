"""Writing a file whole or not at all."""

import os
import tempfile
from pathlib import Path


def write_whole(path: Path, content: str | bytes) -> None:
    """Write `content` to `path` through a temporary file beside it.

    A link is followed to its target. What is no regular file, a device or a pipe, is written to
    straight away.

    Raises
    ------
    ValueError
        The file cannot be written; what was there before is untouched.
    """
    data = content.encode() if isinstance(content, str) else content
    check_writable(path)
    try:
        path = path.resolve()
        if path.exists() and not path.is_file():
            path.write_bytes(data)
            return
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=".unfinished-")
    except (OSError, RuntimeError) as error:
        raise _refusal(path, error) from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        # mkstemp makes the file private; give it what it had, or what a plain open would give
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~mask)
        os.replace(name, path)
    except BaseException as error:
        Path(name).unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise _refusal(path, error) from None
        raise


def check_writable(path: Path, name: str = "output") -> None:
    """Refuse before the work what would be refused after it; `name` is what the path is for.

    Raises
    ------
    ValueError
        `path` is a directory or read-only, its directory does not exist or cannot be written to.
    """
    if "\0" in str(path):
        raise ValueError(f"{name} = {str(path)!r}: cannot be written (no such name)")
    try:
        target = path.resolve()
        if target.is_dir():
            raise ValueError(f"{name} = {str(path)!r}: cannot be written (is a directory)")
        if target.exists():
            # root may write anything: the mode is what the owner wants
            read_only = target.is_file() and not target.stat().st_mode & 0o222
            if read_only or not os.access(target, os.W_OK):
                raise ValueError(f"{name} = {str(path)!r}: cannot be written (read-only)")
            if not target.is_file():
                return
        if not os.access(target.parent, os.W_OK | os.X_OK):
            why = "permission denied" if target.parent.is_dir() else "no such directory"
            raise ValueError(f"{name} = {str(path)!r}: cannot be written ({why})")
    except (OSError, RuntimeError) as error:
        raise _refusal(path, error, name) from None


def check_apart(**paths: Path | None) -> None:
    """Refuse two outputs that are the same file.

    Raises
    ------
    ValueError
        They are.
    """
    seen: dict[Path, str] = {}
    for name, path in paths.items():
        if path is not None:
            target = Path(os.path.realpath(path))
            if target in seen:
                raise ValueError(f"{name} = {str(path)!r}: is the file of {seen[target]} too")
            seen[target] = name


def _refusal(path: Path, error: Exception, name: str = "output") -> ValueError:
    reason = (getattr(error, "strerror", None) or str(error)).lower()
    return ValueError(f"{name} = {str(path)!r}: cannot be written ({reason})")
