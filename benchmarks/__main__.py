"""``python -m benchmarks``: on one thread, which has to be said before numpy is loaded."""

import os

if __name__ == "__main__":
    for library in ("OPENBLAS", "OMP", "MKL", "BLIS", "VECLIB_MAXIMUM"):
        os.environ[f"{library}_NUM_THREADS"] = "1"
    from benchmarks.run import main

    main()
