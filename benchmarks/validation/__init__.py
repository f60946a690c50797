"""Numbers that others printed, ours beside them: ``python -m benchmarks.validation``."""
