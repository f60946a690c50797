"""``python -m benchmarks.routes``: on one thread, said before numpy is loaded."""

import os
import sys

if __name__ == "__main__":
    for library in ("OPENBLAS", "OMP", "MKL", "BLIS", "VECLIB_MAXIMUM"):
        os.environ[f"{library}_NUM_THREADS"] = "1"
    from benchmarks.routes.run import main

    sys.exit(main())
