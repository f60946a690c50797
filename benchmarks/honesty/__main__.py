"""``python -m benchmarks.honesty``: on one thread a process, said before numpy is loaded."""

import os
import sys

if __name__ == "__main__":
    for library in ("OPENBLAS", "OMP", "MKL", "BLIS", "VECLIB_MAXIMUM"):
        os.environ[f"{library}_NUM_THREADS"] = "1"
    from benchmarks.honesty.run import main

    sys.exit(main())
