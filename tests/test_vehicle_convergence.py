"""What more modes change of a study, against limits that are known and against many more modes."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jv

from compare.vehicle.convergence import Settling, settling
from compare.vehicle.critical import critical_gamma
from compare.vehicle.near import Band, Near
from hill import CriticalThrust, Damping, Section, Sensor, Thrust, Vehicle, critical_thrust
from hill.averaging import Resonance
from hill.oscillations.steady import steady

OMEGA_1 = 4.7300407448627040**2
BEAM = Vehicle(
    sections=(Section(1.0, 1.0, 1.0),),
    thrust=Thrust(20.0),
    sensors=(Sensor(0.5, 0.5),),
    damping=Damping(eta=0.01 * OMEGA_1),
    modes=2,
    units="none",  # type: ignore[arg-type]
)
REPORTS = Resonance(1, 0)
# of inertial buckling: the report's two modes say 26.58
BUCKLING = (1.5 * brentq(lambda x: jv(2.0 / 3.0, x), 3.0, 4.0)) ** 2


def solved(vehicle: Vehicle, gamma: float) -> tuple[Band, float | None]:
    alone = steady(vehicle.equation(1.0, 0.0))

    def near(at: float) -> Near:
        return Near(lambda Omega: vehicle.equation(Omega, at), REPORTS, alone)

    band = near(gamma).band()
    return band, critical_gamma(near, band, gamma)


def of(vehicle: Vehicle, gamma: float, more: int) -> dict[str, Settling]:
    loss: CriticalThrust = critical_thrust(vehicle)
    found = settling(vehicle, gamma, 0.0, loss, [solved(vehicle, gamma)], more)
    return {one.what: one for one in found}


def test_the_critical_thrust_of_the_free_beam() -> None:
    found = of(BEAM, 0.1, 5)["critical thrust"]
    assert found.of is None
    assert found.modes == (2, 4, 6, 8, 10, 12)
    assert found.values[0] == pytest.approx(26.58, abs=5e-3)
    assert found.limit is not None
    assert found.error is not None
    assert abs(found.limit - BUCKLING) <= found.error
    assert found.values[-1] is not None
    # and nearer than what there was
    assert abs(found.limit - BUCKLING) < 0.5 * abs(found.values[-1] - BUCKLING)


@pytest.mark.parametrize("gamma", [0.1, 0.3])
@pytest.mark.parametrize("modes", [2, 4])
def test_each_is_what_the_vehicle_of_so_many_modes_says(modes: int, gamma: float) -> None:
    """The windows of fewer modes serve those of more: what is found is the same without them."""
    found = of(replace(BEAM, modes=modes), gamma, 3)
    for k, number in enumerate(found["T"].modes):
        other = replace(BEAM, modes=number)
        band, critical = solved(other, gamma)
        assert found["T"].values[k] == pytest.approx(band.T, rel=1e-6)
        assert found["width"].values[k] == pytest.approx(band.width, rel=1e-6)
        assert found["critical pulsation ratio"].values[k] == pytest.approx(critical, rel=1e-4)
        thrust = found["critical thrust"].values[k]
        assert thrust == pytest.approx(critical_thrust(other).thrust, rel=1e-6)


def test_limits_cover_what_many_more_modes_say() -> None:
    """The report's resonance, whose T with two modes is a tenth too large."""
    many = of(replace(BEAM, modes=30), 0.1, 5)
    for modes in (2, 4, 8):
        few = of(replace(BEAM, modes=modes), 0.1, 5)
        assert set(few) == set(many)
        for what, one in few.items():
            far = many[what]
            assert one.limit is not None
            assert one.error is not None
            assert far.limit is not None
            assert far.error is not None
            assert one.values[0] is not None
            assert abs(one.limit - far.limit) <= one.error + far.error
            assert abs(one.limit - far.limit) < 0.5 * abs(one.values[0] - far.limit)


def test_what_has_no_limit() -> None:
    closed = of(BEAM, 0.01, 3)
    assert "width" not in closed
    assert closed["T"].limit is not None
    # as many as a vehicle may have are too few to extrapolate
    top = of(replace(BEAM, modes=56), 0.1, 5)
    assert top["T"].modes == (56, 58, 60)
    assert top["T"].limit is None
    assert top["T"].error is None


def test_a_damping_matrix_fixes_the_number() -> None:
    damped: Any = Damping(matrix=0.1 * np.eye(3))
    vehicle = replace(BEAM, damping=damped)
    assert settling(vehicle, 0.1, 0.0, None, [], 5) == ()
