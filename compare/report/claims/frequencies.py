"""Natural frequencies of the uniform beam under the constant thrust (section 7.2)."""

import numpy as np
from scipy.special import jn_zeros, jv

from compare.report.claims.both_routes import RoutesDisagree, both, frequencies, real_frequencies
from compare.report.claims.cases import uniform
from compare.report.claims.finding import VISIBLE, Finding, Number, check_for, graded, share
from compare.report.one_route import ROUTES, Beam
from compare.report.steady import buckling, loss
from compare.report.tables import ETA
from hill import UniformBeam

BUCKLING = 25.67
COALESCENCE = 15.0
# Half a unit of the last digit of 25.67.
LAST_DIGIT = 0.005
# What closed form and quadrature leave of a critical thrust of 25.
THRUST_TOLERANCE = 1e-8
# Up to where a loss of stability is looked for.
HIGHEST = 30.0


@check_for("buckling")
def buckling_load() -> Finding:
    """The least thrust at which a natural frequency vanishes."""
    modes = (2, 4, 8)
    settings = ((0.5, 0.5), (1.0, 0.2), (0.1, 0.9))
    two = [_buckling(2, *setting) for setting in settings]
    spread = max(h for h, _ in two) - min(h for h, _ in two)
    numbers = [_number(f"critical T0, {N} modes", *_buckling(N, 0.5, 0.5), 3) for N in modes]
    numbers.append(Number("spread over K_theta and xi_G, 2 modes", spread, None, 6))
    limit = many_modes()
    numbers.append(Number("limit of many modes, (3/2 j_(2/3,1))^2", limit, None, 3))
    own = abs(two[0][0] - BUCKLING)
    verdict = graded(own <= LAST_DIGIT, abs(limit / BUCKLING - 1.0) <= VISIBLE / 10.0)
    because = (
        f"With two modes it is {two[0][0]:.2f}, whatever the control; {BUCKLING} belongs to eight "
        f"modes or more, whose limit is {limit:.2f}."
    )
    return Finding(tuple(numbers), verdict, because)


def many_modes() -> float:
    """(3/2 j)**2 with j the first zero of J_(2/3): the free-free bar under its own inertia."""
    low, high = jn_zeros(0, 1)[0], jn_zeros(1, 1)[0]  # j_(0,1) < j_(2/3,1) < j_(1,1)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if jv(2.0 / 3.0, middle) > 0.0 else (low, middle)
    return float((1.5 * low) ** 2)


def _buckling(modes: int, K_theta: float, xi_G: float) -> tuple[float, float]:
    """By both routes."""

    def at(T0: float) -> UniformBeam:
        return UniformBeam(T0=T0, K_theta=K_theta, xi_G=xi_G, modes=modes)

    return _agreed(*(buckling(at, HIGHEST, route) for route in ROUTES))


def _agreed(h: float, f: float) -> tuple[float, float]:
    if abs(h - f) > THRUST_TOLERANCE:
        raise RoutesDisagree(f"the routes' critical thrusts disagree: {h:.9g}, {f:.9g}")
    return h, f


@check_for("coalescence")
def coalescence() -> Finding:
    """The least thrust at which two frequencies meet, by sensor station."""
    stations = (0.0, 0.1, 0.2, 0.3)
    two = {xi: _coalescence(xi, 2) for xi in stations}
    eight = {xi: _coalescence(xi, 8) for xi in stations}
    numbers = [
        Number(f"T0, {modes} modes, xi_G = {xi:g}", *T0[xi], 2)
        for modes, T0, shown in ((2, two, stations[:3]), (8, eight, stations[:2]))
        for xi in shown
    ]
    buckles = [xi for xi in stations if two[xi][0] > BUCKLING]
    numbers.append(Number("first station of these without", min(buckles), None, 1))
    xi = min(two, key=lambda station: abs(two[station][0] - COALESCENCE))
    near = abs(two[xi][0] / COALESCENCE - 1.0)
    many = min(abs(h / COALESCENCE - 1.0) for h, _ in eight.values())
    verdict = graded(near <= VISIBLE and many <= VISIBLE, near <= VISIBLE)
    because = (
        f"With two modes it is {two[xi][0]:.2f} for a sensor at {xi:g}, the nearest of the grid; "
        f"with eight it is {eight[0.0][0]:.1f} at the earliest, {share(many)} from 15 at best."
    )
    return Finding(tuple(numbers), verdict, because)


def _coalescence(xi_G: float, modes: int) -> tuple[float, float]:
    """Least T0 with a complex frequency by both routes: two have met, or one has vanished."""

    def at(T0: float) -> UniformBeam:
        return UniformBeam(T0=T0, K_theta=1.0, xi_G=xi_G, modes=modes)

    return _agreed(*(loss(at, HIGHEST, route)[0] for route in ROUTES))


@check_for("above-buckling")
def above_buckling() -> Finding:
    """Whether anything is stable beyond T0 = 25.67."""
    steady = frequencies(uniform(T0=26.0))
    below, beyond = both(uniform(T0=26.0), 0.4), both(uniform(T0=26.6), 0.3)
    lost = frequencies(uniform(T0=26.6))[0]
    vanished = max(abs(w.imag) for w in lost)
    high = [both(uniform(T0=30.0), float(Omega)) for Omega in np.arange(0.2, 1.6, 0.1)]
    numbers = (
        _number("omega_(B) at T0 = 26, steady", *_lowest(steady), 4),
        below.number("T at T0 = 26, Omega = .4"),
        Number("growth exponent at T0 = 26.6, steady thrust", vanished, None, 4),
        beyond.number("T at T0 = 26.6, Omega = .3, gamma = .1"),
        min(high, key=lambda T: T.hill).number("least T at T0 = 30, Omega = .2 to 1.5"),
    )
    verdict = graded(not below.stable and not beyond.stable, all(not T.stable for T in high))
    because = (
        "With the report's two modes the beam buckles only at 26.58, and a little above that the "
        "pulsation itself holds it up; from T0 = 30 on the statement holds."
    )
    return Finding(numbers, verdict, because)


@check_for("damped-frequencies")
def damped_frequencies() -> Finding:
    """Damping and natural frequencies, read from the exponents of the equation without gamma."""
    beam, Omega = uniform(), 8.0  # above twice the highest frequency: alpha < 1/2 gives it back
    free, damped = (np.sort(_alphas(beam, Omega, eta)) for eta in (0.0, ETA))
    drop = (free - damped) / free
    names = ("omega_(B)", "omega_(1)", "omega_(2)")
    numbers = tuple(
        Number(f"{name}, relative decrease", float(d), None, 7)
        for name, d in zip(names, drop, strict=True)
    )
    verdict = graded(bool(np.all((drop > 0) & (drop < VISIBLE / 10.0))), bool(np.all(drop > 0)))
    because = f"All decrease, by {share(float(drop.max()))} at most, as sqrt(omega^2 - eta^2/4)."
    return Finding(numbers, verdict, because)


def _alphas(beam: Beam, Omega: float, eta: float) -> np.ndarray:
    z = both(beam, Omega, 0.0, eta).z
    return np.arccos(z.real.clip(-1.0, 1.0)) * Omega / (2.0 * np.pi)


@check_for("control-and-sensor")
def control_and_sensor() -> Finding:
    """Frequencies over K_theta and over xi_G, as in Figures 3 and 4."""
    control = _spread([UniformBeam(T0=10.0, K_theta=K, xi_G=0.5) for K in (0.25, 0.5, 0.75, 1.0)])
    sensor = _spread([UniformBeam(T0=10.0, K_theta=1.0, xi_G=x) for x in (0.1, 0.3, 0.5, 0.7, 0.9)])
    numbers = (
        Number("largest spread over K_theta, .25 to 1", max(control), None, 3),
        Number("omega_(1) over K_theta", control[1], None, 3),
        Number("largest spread over xi_G, .1 to .9", max(sensor), None, 3),
        Number("omega_(1) over xi_G", sensor[1], None, 3),
    )
    verdict = graded(min(max(control), max(sensor)) > VISIBLE, max(*control, *sensor) > VISIBLE)
    because = (
        f"At T0 = 10 a frequency moves by {share(max(control))} of its mean over K_theta and by "
        f"{share(max(sensor))} over the sensor's station."
    )
    return Finding(numbers, verdict, because)


def _spread(beams: list[UniformBeam]) -> list[float]:
    table = np.array([real_frequencies(beam) for beam in beams])
    return [float(x) for x in np.ptp(table, axis=0) / np.mean(table, axis=0)]


def _lowest(found: tuple[tuple[complex, ...], tuple[complex, ...]]) -> tuple[float, float]:
    h, f = (min(w.real for w in route) for route in found)
    return h, f


def _number(label: str, hill: float, floquet: float, digits: int) -> Number:
    return Number(label, hill, floquet, digits)
