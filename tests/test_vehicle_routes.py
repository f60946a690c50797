"""Vehicles by both routes, which share nothing but the data: exact modes and finite elements."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from vehicles import random_vehicle as own_vehicle

from benchmarks.vehicles.systems import random_forcing, random_vehicle
from compare import crosscheck
from compare.both_routes import compare_routes
from floquet.vehicle import discretise, reduce
from floquet.vehicle.discretise import discretised
from hill import Fourier, HillEquation, PeriodicEquation, Section, Sensor, Thrust, Vehicle

pytest.importorskip("skfem")

# one of every kind of equation, of damping and of ends; 330 more: python -m benchmarks.vehicles
SEEDS = [0, 1, 2, 3, 5, 6, 7, 11, 13, 15, 17, 21, 23, 26, 45, 66, 67, 99, 107, 154, 216, 282]


@pytest.mark.parametrize("seed", SEEDS)
def test_random_vehicles_meet(seed: int) -> None:
    vehicle = random_vehicle(seed)
    Omega, gamma = random_forcing(vehicle, seed)
    x = crosscheck(vehicle, Omega=Omega, gamma=gamma)
    assert x.routes_agree
    assert not x.shared_matrices
    assert x.discretisation > 0.0
    assert x.bound == x.hill.error + x.floquet.error + x.discretisation
    # a bound that allows everything shows nothing
    assert x.bound < 1e-6 * max(1.0, np.max(np.abs(x.hill.polynomial)))


def test_the_sample_has_every_kind() -> None:
    vehicles = [random_vehicle(seed) for seed in SEEDS]
    assert {len(v.sections) for v in vehicles} >= {1, 12} or len(vehicles) > 20
    assert any(v.servo_time > 0.0 and v.sensors for v in vehicles)
    assert any(s.K_rate for v in vehicles for s in v.sensors)
    assert any(v.masses for v in vehicles)
    kinds = {type(v.equation(*random_forcing(v, 0))) for v in vehicles}
    assert kinds == {HillEquation, PeriodicEquation}


VEHICLE = Vehicle(
    sections=(
        Section(1.0, 1.0, 1.0, EA=500.0),
        Section(0.5, (1.0, 0.6), (0.8, 0.5), EA=300.0),
    ),
    thrust=Thrust(3.0),
    sensors=(Sensor(0.4, 0.5),),
    modes=3,
    units="none",  # type: ignore[arg-type]
)
FORCING = {"Omega": 21.0, "gamma": 0.3}


@pytest.mark.parametrize(
    "wrong",
    [
        {"thrust": Thrust(3.0 * (1 + 1e-9))},
        {"sensors": (Sensor(0.4 * (1 + 1e-8), 0.5),)},
        {"sections": (Section(1.0, 1.0, 1.0 + 1e-9, EA=500.0), VEHICLE.sections[1])},
        {"sections": (Section(1.0, 1.0, 1.0, EA=500.0 * (1 + 1e-6)), VEHICLE.sections[1])},
    ],
    ids=["thrust", "sensor", "EI", "EA"],
)
def test_a_route_with_other_data_is_found_out(wrong: dict[str, object]) -> None:
    """The bounds are so narrow that a change in the ninth digit shows."""
    other = replace(VEHICLE, **wrong)  # type: ignore[arg-type]
    forcing = tuple(FORCING.values())
    found = discretise.discretise(other, *forcing)
    x = compare_routes(VEHICLE.equation(*forcing), found.best, found.rougher)
    assert not x.routes_agree
    own = crosscheck(VEHICLE, **FORCING)
    assert own.routes_agree
    assert own.matrices is not None
    assert own.matrices < 1e-12


def test_poor_elements_say_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then it is the discretisation's part of the bound that grows, and it is needed."""
    monkeypatch.setattr(discretise, "ORDERS", (4, 5))
    monkeypatch.setattr(discretise, "MAX_REFINEMENTS", 0)
    x = crosscheck(VEHICLE, **FORCING)
    assert x.routes_agree
    assert x.difference > x.hill.error + x.floquet.error
    assert x.discretisation > x.difference


def test_elements_are_kept() -> None:
    """A chart asks for one vehicle at many forcings."""
    crosscheck(VEHICLE, Omega=21.0, gamma=0.1)
    before = reduce._elements.cache_info().misses
    for gamma in (0.2, 0.3):
        crosscheck(replace(VEHICLE, thrust=Thrust(2.0)), Omega=22.0, gamma=gamma)
    assert reduce._elements.cache_info().misses == before


@pytest.mark.parametrize("seed", [15, 26, 29, 98, 139, 140, 152, 167])
def test_matrices_differ_by_their_errors_alone(seed: int) -> None:
    """Servos and short sections between held ends too, where rounding was much larger."""
    v = own_vehicle(seed, control=True)
    Omega = 1.1 * float(abs(v.natural_frequencies()[-1]))
    one, other = v.equation(Omega, 0.3), discretised(v, Omega, 0.3)
    allowed = one.data_error + other.data_error
    for a, b in _kinds(one, other):
        size = max(np.max(np.abs(x)) for x in a)
        assert max(np.max(np.abs(x - y)) for x, y in zip(a, b, strict=True)) <= allowed * size


def _kinds(one: Any, other: Any) -> list[tuple[list[Any], list[Any]]]:
    """Stiffness, steady and pulsating, and damping of both; or A."""
    one, other = (e.general() if isinstance(e, HillEquation) else e for e in (one, other))
    names = ("A",) if one.A is not None else ("K", "C")
    found = [tuple(_every(getattr(e, name)) for e in (one, other)) for name in names]
    return [(a, b) for a, b in found if any(np.any(x) for x in a)]


def _every(matrix: Fourier) -> list[Any]:
    return [matrix.mean, *matrix.cos.values(), *matrix.sin.values()]


def test_a_servo_s_angle_is_the_same_for_both() -> None:
    """In other units too: what `CrossCheck.matrices` compares is one thing."""
    for unit in (1.0, 2.7e4):
        v = Vehicle(
            sections=(Section(3.0, 2.0 * unit, 5.0 * unit),),
            thrust=Thrust(4.0 * unit),
            sensors=(Sensor(1.0, 0.5, 0.03),),
            servo_time=0.05,
            modes=2,
            units="none",  # type: ignore[arg-type]
        )
        assert 0.0 < crosscheck(v, Omega=2.0, gamma=0.2).matrices < 1e-12
