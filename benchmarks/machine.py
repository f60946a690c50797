"""The machine of a run: processor, vectors, versions; nothing that says whose it is."""

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

PACKAGES = ("floquet-crosscheck", "numpy", "scipy", "casadi", "heyoka", "python-flint")

VECTORS = {
    "avx512": ("AVX-512", 8, "avx512f"),
    "avx2": ("AVX2", 4, "avx2"),
    "sse2": ("SSE2", 2, "sse2"),
    "neon": ("NEON", 2, "asimd"),
    "other": ("Other vectors", 1, ""),
}
"""Names, floats in a vector and the processor's own word for it; the widest first."""


def machine() -> dict[str, Any]:
    """What the JSON keeps of it."""
    return {
        "processor": _line("model name") or platform.processor() or platform.machine(),
        "vectors": vectors(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "threads": 1,
        "versions": {name: _version(name) for name in PACKAGES},
    }


def vectors() -> str:
    """The widest that the processor has, a key of `VECTORS`; "other" where it does not say."""
    flags = (_line("flags") or _line("Features")).split()
    for name, (_, _, flag) in VECTORS.items():
        if flag in flags:
            return name
    return "other"


def title(name: str) -> str:
    """How the page calls them."""
    called, floats, _ = VECTORS[name]
    return f"{called}, {floats} numbers in a vector" if floats > 1 else called


def _line(head: str) -> str:
    """What /proc/cpuinfo says of the first processor."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
    lines = (line.split(":", 1) for line in text.splitlines() if ":" in line)
    return next((value.strip() for name, value in lines if name.strip() == head), "")


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None
