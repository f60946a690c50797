"""Which kernel many points go by, for people."""

from pathlib import Path

from floquet.batch import c_kernel


def kernel_in_use() -> str:
    """What would be used, from what is there already: no compiler is run, no library loaded."""
    command = c_kernel.compiler()
    if command is None:
        return "by numpy, as there is no C compiler"
    built = sum(map(c_kernel.is_intact, c_kernel.cache_folder().glob("march-*.so")))
    kept = f"{built} built and kept" if built else "none built yet"
    return f"compiled by {Path(command).name}, {_lanes()}; {kept}"


def _lanes() -> str:
    """Points in a vector, as `kernel.c` chooses by the compiler's macros for this processor."""
    flags = set(c_kernel.processor().split())
    widths = ((8, {"avx512f"}), (4, {"avx"}), (2, {"sse2", "asimd"}))
    lanes = next((lanes for lanes, names in widths if flags & names), 0)
    return f"{lanes} points in a vector" if lanes else "vectors unknown"
