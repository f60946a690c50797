"""``python -m benchmarks.vehicles``: random vehicles by both routes; 1 where one disagrees."""

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np

from benchmarks.vehicles.systems import random_forcing, random_vehicle

COUNT = 330


@dataclass(frozen=True)
class Met:
    """How two routes met on one vehicle.

    Attributes
    ----------
    seed : int
    kind : str
        Of the equation; why not, where there is no answer.
    agree : bool
    share : float
        Largest difference of a coefficient of P over the sum of its bounds.
    difference, integration, discretisation : float
        Of P, and the two parts of the bound.
    """

    seed: int
    kind: str
    agree: bool = True
    share: float = 0.0
    difference: float = 0.0
    integration: float = 0.0
    discretisation: float = 0.0


def met(seed: int) -> Met:
    """One random vehicle under a random forcing."""
    from compare import crosscheck

    vehicle = random_vehicle(seed)
    Omega, gamma = random_forcing(vehicle, seed)
    try:
        x = crosscheck(vehicle, Omega=Omega, gamma=gamma)
    except (ValueError, OverflowError) as error:
        return Met(seed, f"refused: {error}")
    kind = type(vehicle.equation(Omega, gamma)).__name__
    return Met(
        seed,
        "servo" if vehicle.servo_time > 0.0 and vehicle.sensors else kind,
        x.routes_agree,
        x.difference / x.bound,
        x.difference,
        x.hill.error + x.floquet.error,
        x.discretisation,
    )


def main() -> int:
    """Run all, print what disagrees, and a summary."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.vehicles", description=__doc__)
    parser.add_argument("--count", type=int, default=COUNT, metavar="N")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of the first")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N")
    options = parser.parse_args()
    seeds = range(options.seed, options.seed + options.count)
    with ProcessPoolExecutor(options.jobs) as pool:
        found = []
        for one in pool.map(met, seeds, chunksize=4):
            found.append(one)
            if not one.agree or one.kind.startswith("refused"):
                print(one, flush=True)
    print(summary(found))
    return int(not all(one.agree for one in found))


def summary(found: list[Met]) -> str:
    """How many of each kind, and how near their bounds."""
    lines = []
    answered = [one for one in found if not one.kind.startswith("refused")]
    for kind in sorted({one.kind for one in answered}):
        own = [one for one in answered if one.kind == kind]
        shares = np.array([one.share for one in own])
        lines.append(
            f"{kind}: {len(own)} vehicles, {sum(one.agree for one in own)} agree; |dP| over its "
            f"bound {np.median(shares):.1e} in the middle, {shares.max():.1e} at most; |dP| at "
            f"most {max(one.difference for one in own):.0e}; bounds in the middle: integration "
            f"{np.median([one.integration for one in own]):.0e}, elements "
            f"{np.median([one.discretisation for one in own]):.0e}"
        )
    lines.append(f"{len(found) - len(answered)} refused")
    return "\n".join(lines)


if __name__ == "__main__":
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    sys.exit(main())
