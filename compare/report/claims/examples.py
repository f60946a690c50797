"""The two vehicles of Appendix A."""

import math

import numpy as np

from compare.report.claims.both_routes import Both, both, frequencies, real_frequencies, severest
from compare.report.claims.cases import STEP, stepped, uniform
from compare.report.claims.finding import Finding, Number, check_for, graded, share
from compare.report.one_route import Beam
from compare.report.tables import ETA, GAMMA
from hill.averaging import Resonance, first_order
from hill.matrices.modes import eigenvalue

LAMBDA_4 = 500.6
ACCELERATION = 5 * 386
"""5 g, in/s^2."""
LENGTH = 4800
"""In."""
FREQUENCY = 2.0 * math.pi
"""Fundamental bending frequency without thrust, rad/s."""


@check_for("example-1-thrust")
def example_1_thrust() -> Finding:
    """T0 of the uniform vehicle."""
    own = eigenvalue(1) ** 4
    T0 = LAMBDA_4 * ACCELERATION / (FREQUENCY**2 * LENGTH)
    numbers = (
        Number("lambda_1^4, printed 500.6", own, None, 3),
        Number("T0, printed 5.1", T0, None, 4),
    )
    verdict = graded(abs(T0 - 5.1) <= 0.05 and abs(own - LAMBDA_4) <= 0.05, abs(T0 - 5.1) <= 0.5)
    return Finding(numbers, verdict, f"The arithmetic gives {T0:.3f}.")


@check_for("example-1-stable")
def example_1_stable() -> Finding:
    """Any instability at T0 = 5.1, gamma = .1, eta = .01."""
    drawn = {
        "K_theta = .5": uniform(T0=5.1),
        "K_theta = 1": uniform(T0=5.1, K_theta=1.0),
        "K_theta = 1, 4 modes": uniform(T0=5.1, K_theta=1.0, modes=4),
    }
    others = {
        f"K_theta = {K:g}, sensor at {xi:g}": uniform(T0=5.1, K_theta=K, xi_G=xi)
        for K in (0.5, 1.0)
        for xi in (0.1, 0.9)
    }
    tops = {label: _worst(beam) for label, beam in (drawn | others).items()}
    own = [tops[label] for label in drawn]
    verdict = graded(all(T.stable for T in tops.values()), all(T.stable for T in own))
    loose = [label for label, T in tops.items() if not T.stable]
    because = (
        "So for a sensor in the middle, though with K_theta = 1 by "
        f"{share(-max(T.hill for T in own) / ETA)} of eta only; "
        + (f"not for {' nor for '.join(loose)}." if loose else "so for the other sensors too.")
    )
    numbers = tuple(T.number(f"largest T, {label}") for label, T in tops.items())
    return Finding(numbers, verdict, because)


@check_for("example-2-thrust")
def example_2_thrust() -> Finding:
    """omega_1 and T0 of the stepped vehicle, and what follows for it."""
    h, f = (sorted(w.real for w in route)[1] for route in frequencies(stepped(T0=0.0)))
    twelve = real_frequencies(stepped(T0=0.0, modes=12))[1]
    omega_1 = FREQUENCY / 0.974
    mass = 1.0 - STEP["xi_c"] * (1.0 - STEP["area_ratio"])
    T0 = mass * LAMBDA_4 * ACCELERATION / (omega_1**2 * LENGTH)
    as_printed = mass * LAMBDA_4 * ACCELERATION / (6.55**2 * LENGTH)
    worst = [(thrust, _worst(stepped(T0=thrust))) for thrust in (3.56, round(T0, 2))]
    numbers = (
        Number("omega_(1) at T0 = 0, printed .974", h, f, 4),
        Number("the same, 12 modes", twelve, None, 4),
        Number("2 pi/.974, printed 6.55", omega_1, None, 3),
        Number("T0, printed 3.56", T0, None, 3),
        Number("T0 with the printed 6.55", as_printed, None, 3),
        *(T.number(f"largest T, T0 = {thrust:.2f}, eta = .01") for thrust, T in worst),
    )
    verdict = graded(
        abs(omega_1 - 6.55) <= 0.005 and abs(T0 - 3.56) <= 0.005, abs(T0 - 3.56) <= 0.05
    )
    follows = "is stable at either" if all(T.stable for _, T in worst) else "is not stable at both"
    because = (
        f"2 pi/.974 is {omega_1:.2f} and T0 is {T0:.2f}; the reading .974 is right, and with "
        f"gamma = .1 and eta = .01 the vehicle {follows} thrust."
    )
    return Finding(numbers, verdict, because)


def _worst(beam: Beam) -> Both:
    """The largest damped T over all forcing frequencies.

    Where a damped region exists at all, the undamped T, a half circle, is above eta at its top and
    at least .86 eta within half an eta of its centre. No centre is farther than that from its
    resonance at such thrusts, so that the resonances of every order that could be so strong do not
    miss a region; where T is highest a finer row of points follows.
    """
    omega = np.array(real_frequencies(beam), complex)
    orders = (1, 2, 3) if beam.modes == 2 else (1,)
    found = [Resonance(r.i, r.j, r.sign, k) for r in first_order(len(omega)) for k in orders]
    points = [x for r in found if (x := r.Omega(omega)) > 0.1]
    best = max(points, key=lambda Omega: both(beam, Omega, GAMMA, ETA).hill)
    return severest(beam, best + ETA * np.linspace(-1.0, 1.0, 17), GAMMA, ETA)
