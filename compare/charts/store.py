"""Finished nodes on disk: one file, which a kill at any moment leaves whole.

The file is a line of JSON that says whose nodes these are, and then records, one a finished job.
A record carries its length and two checksums and is appended by a single write. That is what makes
it atomic: a record either is there with its checksums right, or it does not count. A kill inside
the write leaves the beginning of a record at the end of the file; it is recognised by its length,
passed over on reading and cut off before the next record.

The usual way to write a file atomically, a new one that is renamed over the old, would write all
earlier nodes again with every job (or save only now and then, and lose what was finished in
between), and a kill could leave the new one behind. Here every node costs one write of its own
size, and there is never a second file.
"""

import json
import os
import struct
import time
import weakref
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

try:
    import fcntl
except ImportError:  # no such notion here
    fcntl = None  # type: ignore[assignment]

Float = NDArray[np.floating[Any]]

FORMAT = "floquet-crosscheck nodes 1"
HEAD = struct.Struct("<4sIII")
"""Of a record: mark, rows, checksum of the rows, checksum of the twelve bytes before."""

MARK = b"NODE"

_HELD: set[str] = set()
"""Files that this process has locked at some time: it may have several stores of one."""

PAUSE = 1.0
"""Seconds between two requests to the disk itself, which only the loss of power makes matter."""


class Store:
    """Lines of numbers, on disk as soon as they are finished.

    Parameters
    ----------
    path : Path
        The file: continued if it is there, begun if not.
    owner : mapping
        Whose lines they are, in values that JSON can hold.
    columns : int
        Numbers a line.

    Attributes
    ----------
    lines : (k, columns) ndarray
        What the file held when it was opened.

    Raises
    ------
    ValueError
        The file is another owner's, is no such file, is damaged, cannot be read or written. It is
        left as it was.
    """

    def __init__(self, path: Path, owner: Mapping[str, Any], columns: int) -> None:
        self.path, self.columns = path, columns
        self._synced = time.monotonic()
        self._torn: int | None = None
        header = json.dumps({"format": FORMAT} | dict(owner)).encode() + b"\n"
        if path.exists() and not path.is_file():
            raise self._refusal("is not a file")
        try:
            data = path.read_bytes() if path.exists() else b""
            # absent, empty, or killed inside its first line: there is nothing to lose
            if len(data) < len(header) and header.startswith(data):
                with open(path, "wb", buffering=0) as file:
                    file.write(header)
                data = header
        except OSError as error:
            raise self._refusal(_because("cannot be opened", error)) from None
        if not os.access(path, os.W_OK):
            raise self._refusal("cannot be written (permission denied)")
        self._check_owner(data, header)
        self._lock()
        self.lines = self._records(data, data.index(b"\n") + 1)

    def _lock(self) -> None:
        """Two processes that continue one file would do everything twice."""
        if fcntl is None:
            return
        handle = os.open(self.path, os.O_RDWR)
        # until this store, or the process, is gone
        weakref.finalize(self, os.close, handle)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            _HELD.add(str(self.path.resolve()))
        except BlockingIOError:
            if str(self.path.resolve()) not in _HELD:
                raise self._refusal("is in use by another process") from None
        except OSError:  # a file system without locks
            return

    def append(self, lines: Float) -> None:
        """Add lines, all or none of them.

        Raises
        ------
        ValueError
            The file cannot be written; what it held is still there.
        """
        body = np.ascontiguousarray(lines, "<f8").tobytes()
        head = HEAD.pack(MARK, len(lines), zlib.crc32(body), 0)[:12]
        record = head + struct.pack("<I", zlib.crc32(head)) + body
        try:
            with open(self.path, "ab", buffering=0, opener=_existing) as file:
                if self._torn is not None:
                    file.truncate(self._torn)
                    self._torn = None
                end = file.seek(0, os.SEEK_END)
                try:
                    written = file.write(record)
                    while written < len(record):
                        written += file.write(record[written:])
                except BaseException:
                    file.truncate(end)
                    raise
                if time.monotonic() - self._synced > PAUSE:
                    os.fsync(file.fileno())
                    self._synced = time.monotonic()
        except OSError as error:
            raise self._refusal(_because("cannot be written", error)) from None

    def _check_owner(self, data: bytes, header: bytes) -> None:
        first, newline, _ = data.partition(b"\n")
        try:
            there = json.loads(first) if newline else None
        except ValueError:
            there = None
        if not isinstance(there, dict) or there.get("format") != FORMAT:
            raise self._refusal("is not a file of finished nodes; give another name")
        here = json.loads(header)
        for name in here | there:
            if there.get(name) != here.get(name):
                raise self._refusal(
                    f"holds the nodes of another chart ({name} = {there.get(name)} there, "
                    f"{here.get(name)} here); give another name, or remove the file"
                )

    def _records(self, data: bytes, start: int) -> Float:
        found: list[Float] = [np.empty((0, self.columns))]
        while start < len(data):
            head = data[start : start + HEAD.size]
            # zeros: the file had grown when the power went, its content had not arrived
            empty = head == bytes(HEAD.size) and not any(data[start:])
            if len(head) < HEAD.size or empty:
                self._torn = start
                break
            mark, rows, checksum, own = HEAD.unpack(head)
            if mark != MARK or zlib.crc32(head[:12]) != own:
                raise self._damage(start, found)
            end = start + HEAD.size + 8 * rows * self.columns
            if end > len(data):
                self._torn = start
                break
            body = data[start + HEAD.size : end]
            if zlib.crc32(body) != checksum:
                raise self._damage(start, found)
            found.append(np.frombuffer(body, "<f8").reshape(rows, self.columns))
            start = end
        return np.concatenate(found)

    def _damage(self, start: int, found: list[Float]) -> ValueError:
        sound = sum(map(len, found))
        return self._refusal(
            f"is damaged at byte {start}; cut there, it holds {sound} sound nodes, or remove it"
        )

    def _refusal(self, why: str) -> ValueError:
        return ValueError(f"resume = {str(self.path)!r}: {why}")


def _existing(path: str, flags: int) -> int:
    """Open; a file that was taken away is not begun again without its first line."""
    return os.open(path, flags & ~os.O_CREAT)


def _because(what: str, error: OSError) -> str:
    return f"{what} ({(error.strerror or str(error)).lower()})"
