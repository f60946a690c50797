"""``python -m benchmarks.bad_commands``."""

import sys

from benchmarks.bad_commands.run import main

if __name__ == "__main__":
    sys.exit(main())
