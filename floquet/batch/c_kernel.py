"""`kernel.c` built with the machine's C compiler, where there is one; never required."""

import atexit
import ctypes
import hashlib
import math
import os
import shutil
import signal
import stat
import subprocess
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from floquet.batch.numpy_kernel import (
    ORDER,
    POWERS,
    TINY,
    TOLERANCE,
    Found,
    March,
    Points,
    by_numpy,
)
from floquet.charpoly import MAX_MINORS, PRODUCTS_SHARE, characteristic_polynomials
from floquet.integrate.step_length import MAX_EXPONENT, MAX_STEPS, RADII, RADII_ORDER

COMPILERS = ("cc", "gcc", "clang")
FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-fPIC", "-shared", "-lm")

# Sums kept at once, of 32 registers; the quickest of 8, 12, 16, 18 and 24 from 2 to 20 modes.
MAX_SUMS = 16

# Bytes of the nearest cache that the coefficients of some columns may fill; 32 to 48 kB is usual.
NEAREST_CACHE = 40_000

MAX_LANES = 8
"""Points side by side, in the widest vectors that `kernel.c` knows."""

# Seconds: a compiler says its version in a few hundredths, and builds 40 coordinates in ten.
VERSION_TIMEOUT, BUILD_TIMEOUT = 5.0, 60.0

# Difference from numpy, of P, above which a build is not used.
TRIAL_TOLERANCE = 1e-10
# The same for what P's error is made of: the fastest motion is found by groups of points, and is up
# to 1.5e-3 lower.
TRIAL_ERROR_TOLERANCE = 0.1

# Builds kept in mind; each is some kilobytes.
MAX_KNOWN = 64
_KNOWN: dict[tuple[str, int, int, int], March] = {}

# Seconds for which a build that failed is not tried again: it may have been a full disk.
RETRY_AFTER = 600.0
_FAILED: dict[tuple[str, int, int, int], float] = {}

# The numbers of a point sit on the compiler's stack, 3 (2n)^2 of them.
MAX_COORDINATES = 40


def compiler() -> str | None:
    """The C compiler: ``$CC``, or the first of `COMPILERS` on the path."""
    named = os.environ.get("CC", "").split()
    return next(filter(None, map(shutil.which, [*named[:1], *COMPILERS])), None)


def march(n: int, terms: int) -> March | None:
    """The compiled march for n coordinates and `terms` cosines; None where it cannot be had.

    Built once and kept in the user's cache directory (``$XDG_CACHE_HOME`` or ``~/.cache``), under
    a name made of source, compiler and options; where that cannot be written, or is not the user's
    alone, for this process. A compiler that fails is asked again when it has changed, and after
    `RETRY_AFTER`.
    """
    command = compiler()
    if command is None or n > MAX_COORDINATES:
        return None
    identity = (command, os.stat(command).st_mtime_ns, n, terms)
    if identity in _KNOWN:
        return _KNOWN[identity]
    if time.monotonic() < _FAILED.get(identity, -math.inf) + RETRY_AFTER:
        return None
    for kept in (_KNOWN, _FAILED):
        if len(kept) >= MAX_KNOWN:
            kept.clear()
    try:
        found = _tried(_wrapped(_loaded(_built(command, n, terms))), n, terms)
    except (OSError, subprocess.SubprocessError, AttributeError, ValueError, MemoryError):
        _FAILED[identity] = time.monotonic()
        return None
    _KNOWN[identity] = found
    return found


def forget() -> None:
    """Keep nothing of what was built or failed in mind: the next `march` looks for it again."""
    _KNOWN.clear()
    _FAILED.clear()


def _tried(found: March, n: int, terms: int) -> March:
    """The march itself, once it has computed something known.

    Raises
    ------
    ValueError
        It does not do as numpy does.
    """
    rng = np.random.default_rng(n)
    matrices = rng.standard_normal((1 + terms, n, n)) / n
    weights = np.vstack([np.ones(3), np.full((terms, 3), 0.1)]) * [0.5, 0.7, 0.9]
    points = Points(matrices, weights, 0.01 * np.ones(3), tuple(range(1, 1 + terms)))
    mine, other = by_numpy(points), found(points)
    apart = np.max(np.abs(mine.P - other.P), axis=1) / np.max(np.abs(mine.P), axis=1)
    # both are good to some ulps of P: 1e-14 at 40 coordinates
    parts = [(vars(mine)[k], vars(other)[k]) for k in ("sensitivity", "growth", "rate")]
    bounds = all(np.allclose(x, y, rtol=TRIAL_ERROR_TOLERANCE, atol=0.0) for x, y in parts)
    if not (bounds and np.all(apart <= TRIAL_TOLERANCE)):
        raise ValueError("the compiled march computes something else")
    return found


def _loaded(library: Path) -> Any:
    """The function of a library whose content is what was written down when it was built.

    A truncated library would end the process as it is mapped, a planted one do what it likes.
    """
    if not is_intact(library):
        library.unlink(missing_ok=True)
        raise OSError("not what was built")
    return ctypes.CDLL(str(library)).march


def is_intact(library: Path) -> bool:
    """Whether a library and the digest beside it are the user's own, and belong together."""
    digest = library.with_suffix(".sha256")
    if not all(path.is_file() and _is_own(path) for path in (library, digest)):
        return False
    # as bytes: what is spoilt need not be text
    return digest.read_bytes() == _digest(library)


def _digest(library: Path) -> bytes:
    return hashlib.sha256(library.read_bytes()).hexdigest().encode("ascii")


def _built(command: str, n: int, terms: int) -> Path:
    source = files("floquet").joinpath("batch", "kernel.c").read_bytes()
    options = [f"-D{name}={value}" for name, value in defines(n, terms).items()]
    version = _run([command, "--version"], b"", VERSION_TIMEOUT)
    key = hashlib.sha256(repr((source, command, version, options, FLAGS, processor())).encode())
    folder = cache_folder()
    target = folder / f"march-{n}-{terms}-{key.hexdigest()[:24]}.so"
    if not is_intact(target):
        # a name of its own, then one rename: processes may build the same at the same time
        handle, name = tempfile.mkstemp(dir=folder, suffix=".so")
        os.close(handle)
        unfinished, digest = Path(name), Path(name).with_suffix(".sha256")
        try:
            _run([command, "-x", "c", "-", "-o", name, *options, *FLAGS], source, BUILD_TIMEOUT)
            digest.write_bytes(_digest(unfinished))
            # whatever the umask, nobody else may write to them
            unfinished.chmod(0o700)
            digest.chmod(0o600)
            os.replace(digest, target.with_suffix(".sha256"))
            os.replace(unfinished, target)
        finally:
            unfinished.unlink(missing_ok=True)
            digest.unlink(missing_ok=True)
    return target


def _run(words: list[str], given: bytes, seconds: float) -> bytes:
    """What a command prints; if it takes too long, it and all that it started are ended."""
    process = subprocess.Popen(
        words,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        printed, _ = process.communicate(given, timeout=seconds)
    except BaseException:
        if hasattr(os, "killpg"):
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        process.kill()
        # not to the end of what it prints: one that left the group may hold that open for ever
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()
        process.wait()
        raise
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, words[0])
    return printed


def defines(n: int, terms: int) -> dict[str, float]:
    """Every number that `kernel.c` shares with Python, under the names it has there."""
    columns, block = _blocks(n)
    return {
        "N": n,
        "TERMS": terms,
        "ORDER": ORDER,
        "POWERS": POWERS,
        "TINY": TINY,
        "COLUMNS": columns,
        "BLOCK": block,
        "MAX_LANES": MAX_LANES,
        "MAX_MINORS": MAX_MINORS,
        "RADII": len(RADII),
        "RADII_ORDER": RADII_ORDER,
        "MAX_EXPONENT": MAX_EXPONENT,
        "PRODUCTS_SHARE": PRODUCTS_SHARE,
    }


def _blocks(n: int) -> tuple[int, int]:
    """Columns taken at once, and sums kept at once, a multiple of them."""
    fitting = NEAREST_CACHE // (8 * MAX_LANES * (ORDER + 1) * n)
    most = min(max(fitting, 1), MAX_SUMS)
    columns = max(c for c in range(1, most + 1) if 2 * n % c == 0)
    rows = min(n, MAX_SUMS // columns)
    return columns, columns * rows


def cache_folder() -> Path:
    """Where kernels are kept, made if it is not there."""
    home = os.environ.get("XDG_CACHE_HOME")
    try:
        folder = (Path(home) if home else Path.home() / ".cache") / "floquet-crosscheck"
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except (OSError, RuntimeError):  # read-only, or no home at all
        return _while_running()
    own = os.access(folder, os.W_OK) and _is_own(folder)
    return folder if own else _while_running()


def _is_own(path: Path) -> bool:
    """Whether a file or folder is the user's own, and nobody else can write to it."""
    if not hasattr(os, "getuid"):  # no such notion here
        return True
    there = path.lstat()
    mode = stat.S_ISDIR(there.st_mode) or stat.S_ISREG(there.st_mode)
    return mode and there.st_uid == os.getuid() and not there.st_mode & 0o022


@cache
def _while_running() -> Path:
    """A place for this process alone, gone when it ends."""
    folder = tempfile.mkdtemp(prefix="floquet-crosscheck-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def processor() -> str:
    """What ``-march=native`` means here: a cache may be shared between machines."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return ""
    return next((line for line in lines if line.startswith(("flags", "Features"))), "")


def _wrapped(function: Callable[..., Any]) -> March:
    pointer, real = ctypes.c_void_p, ctypes.c_double
    types = [ctypes.c_int, *[pointer] * 5, real, real, *[pointer] * 4]
    function.argtypes, function.restype = types, ctypes.c_int  # type: ignore[attr-defined]

    def run(points: Points) -> Found:
        n, k = points.matrices.shape[1], points.weights.shape[1]
        given = (points.matrices, points.weights, points.shift)
        numbers = [np.ascontiguousarray(value, float) for value in given]
        phases = np.array(points.phases, np.intc)
        shapes = ((k, n + 1), (k,)) if n <= MAX_MINORS else ((k, n, n), (k, n, n))
        one, other, growth, rate = (np.empty(shape) for shape in (*shapes, (k,), (k,)))
        at = [
            array.__array_interface__["data"][0]
            for array in (*numbers, phases, RADII, one, other, growth, rate)
        ]
        if function(k, *at[:5], TOLERANCE, float(MAX_STEPS), *at[5:]):
            raise MemoryError(f"half a period of {n} coordinates does not fit into memory")
        if n > MAX_MINORS:
            one[~np.isfinite(growth)] = 0.0
            one, other = characteristic_polynomials(one, other)
        return Found(one, other, growth, rate)

    return run
