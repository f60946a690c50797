"""`floquet/march.c` built with the machine's C compiler, where there is one; never required."""

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from functools import cache, lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from floquet.charpoly import BY_MINORS, characteristic_polynomials
from floquet.march import ORDER, POWERS, TOLERANCE, Found, March, Points
from floquet.propagate import MOST_STEPS
from floquet.steps import MOST_EXPONENT, RADII

COMPILERS = ("cc", "gcc", "clang")
FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-fPIC", "-shared", "-lm")

# Sums kept at once, of 32 registers; the quickest of 8, 12, 16, 18 and 24 from 2 to 20 modes.
MOST_SUMS = 16

# Bytes of the nearest cache that the coefficients of some columns may fill; 32 to 48 kB is usual.
NEAREST_CACHE = 40_000
BYTES = 8 * 8
"""Of one number for eight points side by side."""

# The numbers of a point sit on the compiler's stack, 3 (2n)^2 of them.
MOST_COORDINATES = 40


def compiler() -> str | None:
    """The C compiler: ``$CC``, or the first of `COMPILERS` on the path."""
    named = os.environ.get("CC", "").split()
    return next(filter(None, map(shutil.which, [*named[:1], *COMPILERS])), None)


@lru_cache(maxsize=64)
def march(n: int, terms: int) -> March | None:
    """The compiled march for n coordinates and `terms` cosines; None where it cannot be had.

    Built once and kept in the user's cache directory (``$XDG_CACHE_HOME`` or ``~/.cache``), under
    a name made of source, compiler and options; where that cannot be written, for this process.
    """
    command = compiler()
    if command is None or n > MOST_COORDINATES:
        return None
    try:
        library = ctypes.CDLL(str(_built(command, n, terms)))
    except (OSError, subprocess.SubprocessError):
        return None
    return _wrapped(library.march)


def _built(command: str, n: int, terms: int) -> Path:
    source = files("floquet").joinpath("march.c").read_bytes()
    columns, block = _blocks(n)
    sizes = {"N": n, "TERMS": terms, "ORDER": ORDER, "POWERS": POWERS}
    sizes |= {"COLUMNS": columns, "BLOCK": block}
    sizes |= {"RADII": len(RADII), "MOST_EXPONENT": int(MOST_EXPONENT)}
    options = [f"-D{name}={value}" for name, value in sizes.items()]
    version = subprocess.run([command, "--version"], capture_output=True, check=True, timeout=20)
    key = hashlib.sha256(repr((source, command, version.stdout, options, FLAGS, _cpu())).encode())
    folder = _folder()
    target = folder / f"march-{n}-{terms}-{key.hexdigest()[:24]}.so"
    if not target.exists():
        # a name of its own, then one rename: processes may build the same at the same time
        handle, unfinished = tempfile.mkstemp(dir=folder, suffix=".so")
        os.close(handle)
        try:
            subprocess.run(
                [command, "-x", "c", "-", "-o", unfinished, *options, *FLAGS],
                input=source,
                capture_output=True,
                check=True,
                timeout=120,
            )
            os.replace(unfinished, target)
        finally:
            Path(unfinished).unlink(missing_ok=True)
    return target


def _blocks(n: int) -> tuple[int, int]:
    """Columns taken at once, and sums kept at once, a multiple of them."""
    fitting = NEAREST_CACHE // (BYTES * (ORDER + 1) * n)
    most = min(max(fitting, 1), MOST_SUMS)
    columns = max(c for c in range(1, most + 1) if 2 * n % c == 0)
    rows = min(n, MOST_SUMS // columns)
    return columns, columns * rows


def _folder() -> Path:
    home = os.environ.get("XDG_CACHE_HOME")
    try:
        folder = (Path(home) if home else Path.home() / ".cache") / "floquet-crosscheck"
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except (OSError, RuntimeError):  # read-only, or no home at all
        return Path(_while_running().name)
    return folder if os.access(folder, os.W_OK) else Path(_while_running().name)


@cache
def _while_running() -> "tempfile.TemporaryDirectory[str]":
    """A place for this process alone, where nothing can be kept."""
    return tempfile.TemporaryDirectory(prefix="floquet-crosscheck-")


def _cpu() -> str:
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
        shapes = ((k, n + 1), (k,)) if n <= BY_MINORS else ((k, n, n), (k, n, n))
        one, other, growth, rate = (np.empty(shape) for shape in (*shapes, (k,), (k,)))
        at = [
            array.__array_interface__["data"][0]
            for array in (*numbers, phases, RADII, one, other, growth, rate)
        ]
        if function(k, *at[:5], TOLERANCE, float(MOST_STEPS), *at[5:]):
            raise MemoryError(f"half a period of {n} coordinates does not fit into memory")
        if n > BY_MINORS:
            one[~np.isfinite(growth)] = 0.0
            one, other = characteristic_polynomials(one, other)
        return Found(one, other, growth, rate)

    return run
