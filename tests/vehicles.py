"""Random vehicles, and their matrices by plain finite elements that share nothing with the tested.

Bending by Hermite's cubics, or with shear by two polynomials of degree 9 an element.
"""

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from hill import Damping, PointMass, Section, Sensor, Thrust, Vehicle

Array = NDArray[np.float64]

ENDS = (
    *(("free", "free"), ("free", "free"), ("clamped", "free"), ("pinned", "pinned")),
    *(("pinned", "free"), ("free", "pinned"), ("clamped", "pinned"), ("free", "clamped")),
    ("clamped", "clamped"),
)


def random_vehicle(seed: int, *, wild: float = 1.0, control: bool = False, **given: Any) -> Vehicle:
    """1 to 12 sections, some tapered, perhaps with shear, up to 3 masses; any ends, any units."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 13))
    length = np.exp(0.7 * rng.normal(size=n))
    length *= 3.0 * math.exp(rng.normal()) / length.sum()
    total = float(length.sum())
    mass_unit, stiffness_unit = np.exp(2.0 * rng.normal(size=2))
    shear = rng.random() < 0.4
    sections = []
    for one in length:
        EI = _ends(rng, stiffness_unit, 1.5 * wild, wild)
        m = _ends(rng, mass_unit, wild, wild)
        more: dict[str, Any] = {}
        if shear:
            ratio = math.exp(rng.uniform(2.0, 6.0)) / total**2
            inertia = m[0] * total**2 * math.exp(-rng.uniform(4.0, 8.0))
            more = {"kGA": (EI[0] * ratio, EI[1] * ratio), "rotary_inertia": inertia}
        sections.append(Section(float(one), m, EI, **more))
    mass = sum(s.length * sum(s.mass_per_length) / 2.0 for s in sections)
    masses = tuple(
        PointMass(
            total * (rng.random() if rng.random() < 0.7 else float(rng.integers(0, 2))),
            mass * math.exp(rng.normal(-3.0, 1.0)),
            mass * total**2 * math.exp(rng.normal(-8.0, 1.0)) if rng.random() < 0.5 else 0.0,
        )
        for _ in range(rng.integers(0, 4))
    )
    chosen: dict[str, Any] = {
        "sections": tuple(sections),
        "masses": masses,
        "ends": ENDS[int(rng.integers(0, len(ENDS)))],
        "modes": int(rng.integers(2, 7)),
    }
    if control:
        chosen |= _control(rng, total, mass, stiffness_unit)
    return Vehicle(**(chosen | given))


def _ends(rng: np.random.Generator, unit: float, spread: float, wild: float) -> tuple[float, float]:
    start = unit * math.exp(spread * rng.uniform(-1.0, 1.0))
    tapered = rng.random() < 0.4
    return start, start * math.exp(0.8 * wild * rng.uniform(-1.0, 1.0)) if tapered else start


def _control(rng: np.random.Generator, length: float, mass: float, EI: float) -> dict[str, Any]:
    time = math.sqrt(mass * length**3 / EI) / 20.0
    thrust = Thrust(
        EI / length**2 * rng.uniform(1.0, 10.0),
        None if rng.random() < 0.7 else length * rng.uniform(0.5, 1.0),
        "follower" if rng.random() < 0.8 else "fixed",
    )
    sensors = tuple(
        Sensor(length * rng.random(), rng.uniform(0.0, 1.0), rng.uniform(0.0, 1.0) * time)
        for _ in range(rng.integers(0, 3))
    )
    return {
        "thrust": thrust,
        "sensors": sensors,
        "servo_time": time * rng.random() if rng.random() < 0.3 else 0.0,
        "damping": Damping(rng.uniform(0.0, 0.02) if rng.random() < 0.5 else (), 0.01 / time),
    }


# ---- finite elements -----------------------------------------------------------------------------


def finite_elements(vehicle: Vehicle, cuts: int = 120) -> tuple[Array, Array]:
    """Mass and stiffness, with the ends' conditions, of about so many elements."""
    shear = math.isfinite(vehicle.sections[0].kGA[0])
    fine = _stations(vehicle, 8 if shear else cuts)
    size = 1 + DEGREE if shear else 2
    n = (len(fine) - 1) * (2 * DEGREE if shear else 2) + 2
    M, K = np.zeros((n, n)), np.zeros((n, n))
    make = _timoshenko if shear else _hermite
    starts = np.array(vehicle.edges)
    step = 2 * DEGREE if shear else 2
    for e, (a, b) in enumerate(pairwise(fine)):
        k = int(np.searchsorted(starts, 0.5 * (a + b)) - 1)
        section = vehicle.sections[k]
        own = slice(e * step, e * step + 2 * size)
        mass, stiffness = make(section, a - starts[k], b - starts[k])
        M[own, own] += mass
        K[own, own] += stiffness
    for point in vehicle.masses:
        at = int(np.argmin(np.abs(np.array(fine) - point.station)))
        M[step * at, step * at] += point.mass
        M[step * at + 1, step * at + 1] += point.rotary_inertia
    fixed = {"free": [], "pinned": [0], "clamped": [0, 1]}
    drop = [*fixed[vehicle.ends[0]], *(n - 2 + k for k in fixed[vehicle.ends[1]])]
    kept = np.delete(np.arange(n), drop)
    return M[np.ix_(kept, kept)], K[np.ix_(kept, kept)]


def _stations(vehicle: Vehicle, cuts: int) -> list[float]:
    """Nodes: wherever something changes, and between."""
    parts = (*vehicle.masses, *vehicle.sensors)
    edges = np.unique([*vehicle.edges, *(p.station for p in parts), vehicle.thrust_station])
    fine = [0.0]
    for a, b in pairwise(edges):
        number = max(1, round(cuts * (b - a) / vehicle.length))
        fine += np.linspace(a, b, number + 1)[1:].tolist()
    return fine


NODES, WEIGHTS = np.polynomial.legendre.leggauss(14)
DEGREE = 9


def _along(pair: tuple[float, float], section: Section, x: Array) -> Array:
    return (
        pair[0] + (pair[1] - pair[0]) * x / section.length
        if pair[0] != pair[1]
        else pair[0] + 0 * x
    )


def _hermite(section: Section, a: float, b: float) -> tuple[Array, Array]:
    h = b - a
    s = 0.5 * (1.0 + NODES)
    x, w = a + h * s, 0.5 * h * WEIGHTS
    y = np.array(
        [1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, h * (s**3 - s**2)]
    )
    bend = np.array([12 * s - 6, h * (6 * s - 4), 6 - 12 * s, h * (6 * s - 2)]) / h**2
    slope = _slopes(s, h)
    m, r, EI = (
        _along(p, section, x) for p in (section.mass_per_length, section.rotary_inertia, section.EI)
    )
    return (y * w * m) @ y.T + (slope * w * r) @ slope.T, (bend * w * EI) @ bend.T


def _slopes(s: Array, h: float) -> Array:
    """First derivatives of Hermite's cubics."""
    return np.array(
        [6 * (s**2 - s) / h, 1 - 4 * s + 3 * s**2, 6 * (s - s**2) / h, 3 * s**2 - 2 * s]
    )


def _timoshenko(section: Section, a: float, b: float) -> tuple[Array, Array]:
    """Unknowns: y and psi at one end, the inner ones, y and psi at the other."""
    h = b - a
    x, w = a + 0.5 * h * (1.0 + NODES), 0.5 * h * WEIGHTS
    # ends' hats and integrals of Legendre polynomials, which vanish at both
    shapes = [
        np.array([0.5, -0.5]),
        *(legendre.legint(np.eye(k + 1)[k], lbnd=-1) for k in range(1, DEGREE)),
        np.array([0.5, 0.5]),
    ]
    f = np.array([legendre.legval(NODES, c) for c in shapes])
    df = np.array([legendre.legval(NODES, legendre.legder(c)) for c in shapes]) * 2.0 / h
    m, r, EI, kGA = (
        _along(p, section, x)
        for p in (section.mass_per_length, section.rotary_inertia, section.EI, section.kGA)
    )
    n = DEGREE + 1
    M, K = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    Y, PSI = slice(0, None, 2), slice(1, None, 2)
    M[Y, Y], M[PSI, PSI] = (f * w * m) @ f.T, (f * w * r) @ f.T
    K[Y, Y] = (df * w * kGA) @ df.T
    K[Y, PSI] = -(df * w * kGA) @ f.T
    K[PSI, Y] = K[Y, PSI].T
    K[PSI, PSI] = (df * w * EI) @ df.T + (f * w * kGA) @ f.T
    return M, K


def thrust_matrices(vehicle: Vehicle, cuts: int) -> tuple[Array, Array, Array]:
    """Mass, stiffness and what a unit of steady thrust adds to it, by Hermite's cubics.

    P comes from a sum over the masses ahead; the ends' conditions are in.
    """
    M, K = finite_elements(replace(vehicle, ends=("free", "free")), cuts)
    fine = _stations(vehicle, cuts)
    stations = np.array(fine)
    n = len(M)
    pull = np.zeros((n, n))
    at = vehicle.thrust_station
    for e, (a, b) in enumerate(pairwise(fine)):
        h = b - a
        s = 0.5 * (1.0 + NODES)
        slope = _slopes(s, h)
        force = np.array([_force(vehicle, x) for x in a + h * s])
        own = slice(2 * e, 2 * e + 4)
        pull[own, own] -= (slope * 0.5 * h * WEIGHTS * force) @ slope.T

    def node(x: float) -> int:
        k = int(np.argmin(np.abs(stations - x)))
        assert abs(stations[k] - x) < 1e-9 * vehicle.length
        return k

    push = 2 * node(at)
    if vehicle.thrust.direction == "follower":
        pull[push, push + 1] += 1.0
    for sensor in vehicle.sensors:
        pull[push, 2 * node(sensor.station) + 1] += sensor.K_theta
    fixed = {"free": [], "pinned": [0], "clamped": [0, 1]}
    drop = [*fixed[vehicle.ends[0]], *(n - 2 + k for k in fixed[vehicle.ends[1]])]
    kept = np.ix_(*(np.delete(np.arange(n), drop),) * 2)
    return M[kept], K[kept], pull[kept]


def _force(vehicle: Vehicle, x: float) -> float:
    """P of a unit thrust, compression positive."""
    beyond = x > vehicle.thrust_station
    if vehicle.ends[0] != "free":
        return 0.0 if beyond else 1.0
    if vehicle.ends[1] != "free":
        return -1.0 if beyond else 0.0
    ahead = total = 0.0
    for start, section in zip(vehicle.edges, vehicle.sections, strict=False):
        first, last = section.mass_per_length
        total += section.length * (first + last) / 2.0
        part = min(max(x - start, 0.0), section.length)
        ahead += part * (first + 0.5 * (last - first) * part / section.length)
    for point in vehicle.masses:
        total += point.mass
        ahead += point.mass if point.station < x else 0.0
    return ahead / total - beyond
