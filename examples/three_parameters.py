"""How much of the (Omega, gamma) plane is unstable, and how fast, as the thrust grows.

    python examples/three_parameters.py                              here
    python examples/three_parameters.py tcp://scheduler:8786         on a Dask cluster

An interrupted run goes on where it was: its nodes are in three_parameters.nodes.
"""

import sys
from contextlib import nullcontext
from pathlib import Path

from compare import chart
from compare.jobs.cluster import connect
from compare.system_file import read


def main(address: str | None = None, resume: str = "three_parameters.nodes") -> None:
    """Chart T over Omega, gamma and T0 and print a line a thrust."""
    wanted = read(Path(__file__).with_suffix(".toml"))
    with connect(address) if address else nullcontext(1) as workers:
        cube = chart(
            wanted.system,
            wanted.axes,
            route="floquet",
            tolerance=1e-9,
            workers=workers,
            resume=resume,
        )
    thrusts = cube.axes[2].points
    print("  T0  unstable  largest T")
    for T0, plane in zip(thrusts[::5], cube.T[::5], strict=True):
        print(f"{T0:4.0f}  {(plane > 1e-6).mean():7.1%}  {plane.max():9.5f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
