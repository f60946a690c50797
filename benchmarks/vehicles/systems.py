"""Random vehicles: everything that a vehicle may have, in any combination."""

import math
from typing import Any

import numpy as np

from hill import Damping, PointMass, Section, Sensor, Thrust, Units, Vehicle

# Free vehicles are what it is about; the others are where the literature has numbers.
ENDS = (
    *(("free", "free"),) * 5,
    *(("clamped", "free"), ("free", "clamped"), ("pinned", "free"), ("free", "pinned")),
    *(("pinned", "pinned"), ("clamped", "pinned"), ("clamped", "clamped")),
)

# Of the highest frequency: below it the forcing's period takes a route minutes.
LOWEST_FORCING = 3e-3


def random_vehicle(seed: int) -> Vehicle:
    """1 to 12 sections, tapers, shear, compliance, masses, sensors with rates, servo, damping."""
    rng = np.random.default_rng(seed)
    axial, shear, rotary = (bool(rng.random() < share) for share in (0.6, 0.3, 0.4))
    n = int(rng.integers(1, 13))
    sections = []
    for _ in range(n):
        more: dict[str, Any] = {}
        if axial and rng.random() < 0.85:
            more["EA"] = _property(rng, 300.0, 3e4)
        if rotary:
            more["rotary_inertia"] = _property(rng, 1e-5, 1e-3)
        if shear and rng.random() < 0.8:
            more["kGA"] = _property(rng, 30.0, 3e3)
        mass, EI = _property(rng, 0.3, 3.0), _property(rng, 0.3, 3.0)
        sections.append(Section(_log(rng, 0.2, 2.0) / n, mass, EI, **more))
    length = math.fsum(s.length for s in sections)
    return Vehicle(
        sections=tuple(sections),
        masses=tuple(_mass(rng, length) for _ in range(rng.integers(0, 4))),
        ends=ENDS[int(rng.integers(0, len(ENDS)))],  # type: ignore[arg-type]
        thrust=Thrust(
            rng.uniform(-3.0, 12.0),
            None if rng.random() < 0.7 else rng.uniform(0.2, 1.0) * length,
            "follower" if rng.random() < 0.7 else "fixed",
        ),
        sensors=tuple(_sensor(rng, length) for _ in range(rng.integers(0, 4))),
        servo_time=_log(rng, 1e-3, 0.1) if rng.random() < 0.35 else 0.0,
        damping=_damping(rng),
        g=_log(rng, 1e-3, 0.3) if rng.random() < 0.5 else 0.0,
        axial_damping="report" if rng.random() < 0.5 else "hysteretic",
        quadrature_force=bool(rng.random() < 0.8),
        units=Units.named("none"),
        modes=int(rng.integers(1, 6)),
    )


def random_forcing(vehicle: Vehicle, seed: int) -> tuple[float, float]:
    """Omega beside some frequency of the vehicle, and gamma."""
    rng = np.random.default_rng([seed, 1])
    frequencies = np.abs(np.asarray(vehicle.natural_frequencies(), complex))
    usable = frequencies[frequencies > LOWEST_FORCING * frequencies.max()]
    return float(rng.uniform(0.5, 2.5) * rng.choice(usable)), float(rng.uniform(-0.5, 0.5))


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _property(rng: np.random.Generator, low: float, high: float) -> Any:
    start = _log(rng, low, high)
    return (start, start * _log(rng, 0.3, 3.0)) if rng.random() < 0.4 else start


def _mass(rng: np.random.Generator, length: float) -> PointMass:
    station = (0.0, length, rng.uniform(0.0, length))[int(rng.integers(0, 3))]
    inertia = _log(rng, 1e-4, 1e-2) if rng.random() < 0.5 else 0.0
    return PointMass(station, _log(rng, 0.01, 1.0), inertia)


def _sensor(rng: np.random.Generator, length: float) -> Sensor:
    rate = rng.uniform(-0.01, 0.05) if rng.random() < 0.5 else 0.0
    return Sensor(rng.uniform(0.0, length), rng.uniform(-0.3, 1.0), rate)


def _damping(rng: np.random.Generator) -> Damping:
    ratio, other = _log(rng, 1e-3, 5e-2), _log(rng, 1e-3, 5e-2)
    kinds = (
        Damping(),
        Damping(eta=rng.uniform(0.0, 0.3)),
        Damping(ratio),
        Damping((ratio, other), 0.05),
    )
    return kinds[int(rng.integers(0, len(kinds)))]
