"""``python -m benchmarks.vehicles.stations``: `verify vehicle` of 200 stations and 20 modes."""

import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

STATIONS, MODES = 200, 20

FILE = """\
kind = "vehicle"
title = "{stations} stations"
stations = "stations.csv"
modes = {modes}
[thrust]
mean = 2e6
[[sensor]]
station = 30.0
K_theta = 0.5
K_rate = 0.002
[damping]
ratios = 0.005
[forcing]
gamma = 0.1
Omega = 25.0
"""


def write(folder: Path) -> Path:
    """A tapered vehicle of 100 m whose properties go up and down by half along it."""
    x = np.linspace(0.0, 100.0, STATIONS)
    rng = np.random.default_rng(1)
    uneven = np.exp(0.4 * rng.uniform(-1.0, 1.0, (2, STATIONS)))
    rows = ["station,mass_per_length,EI,EA"]
    for k, at in enumerate(x.tolist()):
        mass, EI = 1500.0 * uneven[0, k], 1.5e9 * uneven[1, k]
        rows.append(f"{at!r},{float(mass)!r},{float(EI)!r},{float(EI)!r}")
    (folder / "stations.csv").write_text("\n".join(rows) + "\n")
    path = folder / "vehicle.toml"
    path.write_text(FILE.format(stations=STATIONS, modes=MODES))
    return path


def main() -> int:
    """Time it, and say what it said first."""
    from compare.__main__ import main as verify

    with tempfile.TemporaryDirectory() as folder:
        path = write(Path(folder))
        began, busy = time.perf_counter(), time.process_time()
        status = verify(["vehicle", str(path), "--range", "2", "40"])
        took, used = time.perf_counter() - began, time.process_time() - busy
    print(f"{STATIONS} stations, {MODES} modes: {took:.1f} s, {used:.1f} s of the processor")
    return status


if __name__ == "__main__":
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    sys.exit(main())
