"""One thread a process: the matrices are small, and the processes are as many as the cores."""

import os
import sys
from pathlib import Path

import pytest
from browser import started

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

# the benchmarks, with the arbiter; last, so that what is installed comes before what lies here
sys.path.append(str(Path(__file__).parents[1]))


@pytest.fixture(scope="session")
def browser():
    """One for all tests of a process; they say what they `look` like before they open a page."""
    with started() as window:
        yield window
