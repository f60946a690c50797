"""Writing a file whole or not at all."""

import os
import tempfile
from pathlib import Path


def write_whole(path: Path, content: str | bytes) -> None:
    """Write `content` to `path` through a temporary file beside it.

    Raises
    ------
    ValueError
        The file cannot be written; what was there before is untouched.
    """
    data = content.encode() if isinstance(content, str) else content
    try:
        if path.is_dir():
            raise IsADirectoryError(21, "is a directory")
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        raise ValueError(f"output = {str(path)!r}: {_reason(error)}") from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        # mkstemp makes the file private; give it what a plain open would have
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, path)
    except BaseException as error:
        Path(name).unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise ValueError(f"output = {str(path)!r}: {_reason(error)}") from None
        raise


def check_writable(path: Path) -> None:
    """Refuse before the work what would be refused after it.

    Raises
    ------
    ValueError
        `path` is a directory, or its directory does not exist or cannot be written to.
    """
    if path.is_dir():
        raise ValueError(f"output = {str(path)!r}: cannot be written (is a directory)")
    if not os.access(path.parent, os.W_OK | os.X_OK):
        why = "permission denied" if path.parent.is_dir() else "no such directory"
        raise ValueError(f"output = {str(path)!r}: cannot be written ({why})")


def _reason(error: OSError) -> str:
    return f"cannot be written ({(error.strerror or str(error)).lower()})"
