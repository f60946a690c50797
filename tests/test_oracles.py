"""Numbers that nobody here computed from the report: tables, closed forms, other methods."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jv

from floquet import monodromy
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic

ROUTES: dict[str, Callable] = {"hill": characteristic, "floquet": monodromy}
both = pytest.mark.parametrize("route", ROUTES)

# x'' + (a - 2 q cos 2 t) x = 0, DLMF chapter 28: (name, q) -> a, and z = trace/2 after pi.
MATHIEU = {
    ("a0", 1): (-0.45513860410741355, 1.0),
    ("b1", 1): (-0.11024881699209517, -1.0),
    ("a1", 1): (1.8591080725143635, -1.0),
    ("b2", 1): (3.9170247729984712, 1.0),
    ("a2", 1): (4.3713009827350857, 1.0),
    ("a0", 5): (-5.8000460208515084, 1.0),
    ("b1", 5): (-5.7900805986377710, -1.0),
    ("a1", 5): (1.8581875415477509, -1.0),
    ("b2", 5): (2.0994604454866654, 1.0),
    ("a2", 5): (7.4491097395291778, 1.0),
}
# Inside, a = 1: q -> z = (mu + 1/mu)/2.
MU = {0.1: -0.85479289278902375, 1.0: -4.1560549385828014}
INTERIOR = {q: 0.5 * (mu + 1.0 / mu) for q, mu in MU.items()} | {0.2: 0.5 * -2.0985825254188450}


def mathieu(a: float, q: float, eta: float = 0.0) -> HillEquation:
    return HillEquation([[a]], [[1.0]], -2.0 * q, 2.0, eta)


def constant(equation: HillEquation, route: str) -> float:
    return float(-ROUTES[route](equation).polynomial[1])


@both
@pytest.mark.parametrize("name", MATHIEU, ids=lambda name: f"{name[0]}, q = {name[1]}")
def test_mathieu_characteristic_values(name: tuple[str, int], route: str) -> None:
    """The trace over pi is 2 or -2."""
    (a, z), q = MATHIEU[name], name[1]
    found = ROUTES[route](mathieu(a, q))
    # dz/da, -7.6 to 1.6 at q = 1 and up to -202 at q = 5, times the ulp to which a is known:
    # 2e-13 at most. Measured: 4e-14 by hill, 3e-13 by floquet, both for q = 5.
    h = 1e-6
    change = constant(mathieu(a + h, q), route) - constant(mathieu(a - h, q), route)
    table = abs(change) / (2 * h) * math.ulp(a)
    assert abs(found.z[0] - z) <= found.error + table
    assert found.error + table < 5e-12


@both
@pytest.mark.parametrize("q", INTERIOR)
def test_mathieu_interior_points(q: float, route: str) -> None:
    found = ROUTES[route](mathieu(1.0, q))
    # Measured 4e-15.
    assert found.z[0] == pytest.approx(INTERIOR[q], abs=5e-14)
    assert abs(found.z[0] - INTERIOR[q]) <= found.error + math.ulp(INTERIOR[q])
    if q in MU:
        # T = (Omega/pi) ln R magnifies an error of z by (Omega/pi)/sqrt(z^2 - 1), 4 at q = 0.1:
        # measured 4e-15.
        T = 2.0 / math.pi * abs(math.log(-MU[q]))
        assert abs(found.T - T) < 1e-13
    assert found.verdict == "unstable"


@pytest.mark.parametrize("q", MU)
def test_mathieu_multipliers(q: float) -> None:
    found = monodromy(mathieu(1.0, q)).multipliers
    expected = sorted([MU[q], 1.0 / MU[q]])
    # Measured 9e-16.
    np.testing.assert_allclose(sorted(found.real), expected, rtol=5e-14)
    np.testing.assert_array_equal(found.imag, 0.0)


# n scalar Mathieu equations of known z, period pi: a, q, z.
SCALARS = [
    (1.0, 1.0, INTERIOR[1.0]),
    (1.0, 0.2, INTERIOR[0.2]),
    (4.3713009827350857, 1.0, 1.0),
    (1.8581875415477509, 5.0, -1.0),
    (2.25, 0.0, math.cos(1.5 * math.pi)),
    (-0.16, 0.0, math.cosh(0.4 * math.pi)),
]


def manufactured(n: int, eta: float, couple: str) -> tuple[HillEquation, np.ndarray]:
    a, q, z = np.array(SCALARS[:n]).T
    rng = np.random.default_rng(n)
    F, G = np.diag(a + 0.25 * eta**2), np.diag(-2.0 * q)
    if couple == "triangular":
        F, G = (M + np.triu(rng.standard_normal((n, n)), 1) for M in (F, G))
    basis = np.eye(n) + 0.3 * rng.standard_normal((n, n))
    F, G = (basis @ M @ np.linalg.inv(basis) for M in (F, G))
    return HillEquation(F, G, 1.0, 2.0, eta), z


@both
@pytest.mark.parametrize("eta", [0.0, 0.3])
@pytest.mark.parametrize("n", range(2, 7))
@pytest.mark.parametrize("couple", ["diagonal", "triangular"])
def test_manufactured(n: int, eta: float, couple: str, route: str) -> None:
    """P diag(a) P^-1 and P diag(b) P^-1: dense, not symmetric, and the scalars' z.

    So does a triangular coupling between them, which no change of coordinates removes.
    """
    equation, z = manufactured(n, eta, couple)
    found = ROUTES[route](equation)
    assert not np.allclose(equation.G, equation.G.T)
    # Measured 2e-13 by hill, 9e-14 by floquet: F and G themselves are rounded.
    assert np.max(np.abs(found.polynomial - np.poly(z))) < 2e-12
    T = 2.0 / math.pi * math.log(4.1560549385828014) - eta
    # Measured 8e-14.
    assert abs(found.T - T) < 2e-12


@pytest.mark.parametrize("eta", [0.0, 0.3])
@pytest.mark.parametrize("n", range(2, 7))
def test_manufactured_multipliers(n: int, eta: float) -> None:
    """Those of the scalars, times exp(-eta T/2)."""
    equation, z = manufactured(n, eta, "diagonal")
    root = np.sqrt(z.astype(complex) ** 2 - 1.0)
    expected = np.concatenate([z + root, z - root]) * np.exp(-0.5 * eta * math.pi)
    found = np.poly(monodromy(equation).multipliers)
    # Measured 2e-13.
    np.testing.assert_allclose(found, np.poly(expected), atol=2e-12)


# Hsu: first-order widths, two modes.
OMEGA = np.array([1.0, 1.73])
COUPLINGS = {
    "principal 1": np.array([[1.0, 0.4], [0.7, -0.8]]),
    "principal 2": np.array([[1.0, 0.4], [0.7, -0.8]]),
    "sum": np.array([[0.3, 0.4], [0.7, -0.2]]),
    "difference": np.array([[0.3, 0.4], [-0.7, -0.2]]),
}


def hsu(kind: str, gamma: float) -> tuple[float, float]:
    """Centre and half width of the tongue."""
    (w1, w2), G = OMEGA, COUPLINGS[kind]
    if kind.startswith("principal"):
        i = int(kind[-1]) - 1
        return 2 * OMEGA[i], gamma * abs(G[i, i]) / (2 * OMEGA[i])
    centre = w1 + w2 if kind == "sum" else w2 - w1
    return centre, 0.5 * gamma * math.sqrt(abs(G[0, 1] * G[1, 0]) / (w1 * w2))


def tongue(kind: str, gamma: float, eta: float = 0.0) -> HillEquation:
    """As a function of Omega."""
    return lambda Omega: HillEquation(np.diag(OMEGA**2), COUPLINGS[kind], gamma, Omega, eta)  # type: ignore[return-value]


def inside(kind: str, polynomial: np.ndarray) -> float:
    """Changes sign at the boundary: P(-1) = 0, or two z that meet."""
    if kind.startswith("principal"):
        return float(np.polyval(polynomial, -1.0))
    return float(polynomial[1] ** 2 - 4.0 * polynomial[2])


def boundaries(sign: Callable[[float], float], centre: float, width: float) -> tuple[float, float]:
    ends = centre - 2.0 * width, centre + 2.0 * width
    low, high = (brentq(sign, centre, end, xtol=1e-12) for end in ends)
    return low, high


@both
@pytest.mark.parametrize("kind", COUPLINGS)
def test_hsu_widths(kind: str, route: str) -> None:
    """The first-order width and centre, with an error of second order."""
    gammas, ratios, shifts = [0.04, 0.02, 0.01], [], []
    for gamma in gammas:
        centre, width = hsu(kind, gamma)
        system = tongue(kind, gamma)

        def sign(Omega: float, system: Callable = system) -> float:
            return inside(kind, ROUTES[route](system(Omega)).polynomial)

        low, high = boundaries(sign, centre, width)
        ratios.append((high - low) / (2.0 * width) - 1.0)
        shifts.append((low + high) / 2.0 - centre)
    # Measured: ratio - 1 = -.06 gamma^2 and a shift of -.055 gamma^2 at most.
    for gamma, ratio, shift in zip(gammas, ratios, shifts, strict=True):
        assert abs(ratio) < 0.1 * gamma**2
        assert abs(shift) < 0.1 * gamma**2
    assert abs(ratios[2]) < abs(ratios[0]) / 8


@pytest.mark.parametrize("kind", COUPLINGS)
def test_the_other_combination_is_stable(kind: str) -> None:
    """G_12 G_21 > 0 couples at the sum only, < 0 at the difference only."""
    if kind.startswith("principal"):
        i = int(kind[-1]) - 1
        Omega, G = 2 * OMEGA[i], np.array([[0.0, 0.4], [0.7, 0.0]])
    else:
        (w1, w2), G = OMEGA, COUPLINGS[kind]
        Omega = w2 - w1 if kind == "sum" else w1 + w2
    _, width = hsu("sum", 0.02)
    for offset in np.linspace(-2, 2, 9) * width:
        equation = HillEquation(np.diag(OMEGA**2), G, 0.02, Omega + offset)
        assert characteristic(equation).stable
        assert monodromy(equation).stable


@both
@pytest.mark.parametrize("kind", COUPLINGS)
def test_hsu_widths_with_damping(kind: str, route: str) -> None:
    """sqrt(width^2 - eta^2)."""
    gamma = 0.01
    centre, width = hsu(kind, gamma)
    eta = 0.6 * width
    expected = 0.8 * width
    system = tongue(kind, gamma, eta)
    low, high = boundaries(lambda Omega: ROUTES[route](system(Omega)).T, centre, width)  # type: ignore[operator]
    # Measured 6e-6: of the order of gamma^2, as without damping.
    assert (high - low) / (2.0 * expected) == pytest.approx(1.0, abs=gamma**2)
    beyond = tongue(kind, gamma, 1.05 * width)
    assert all(
        ROUTES[route](beyond(centre + offset)).stable  # type: ignore[operator]
        for offset in np.linspace(-1, 1, 9) * width
    )


def test_free_free_frequencies() -> None:
    """Without thrust: lambda_n**2, over the first, and the rigid rotation's zero."""
    published = np.array([4.7300407448627040, 7.8532046240958376, 10.995607838001671])
    found = UniformBeam(T0=0.0, K_theta=0.5, xi_G=0.5, modes=3).natural_frequencies()
    np.testing.assert_allclose(found, [0.0, *(published / published[0]) ** 2], rtol=1e-15)


def critical(modes: int) -> float:
    """The thrust at which two bending frequencies of the uncontrolled beam meet."""

    def flutters(T0: float) -> bool:
        beam = UniformBeam(T0=T0, K_theta=0.0, xi_G=0.5, modes=modes)
        # Rounding makes 1e-8 and less of a double eigenvalue and of rotation's zero.
        return bool(np.max(np.abs(beam.natural_frequencies().imag)) > 1e-5)

    low, high = 90.0, 130.0
    assert not flutters(low)
    assert flutters(high)
    while high - low > 1e-5:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if flutters(middle) else (middle, high)
    return high


@pytest.mark.parametrize(
    ("modes", "expected"), [(2, 116.097), (3, 109.984), (4, 109.967), (6, 109.782), (8, 109.722)]
)
def test_follower_flutter(modes: int, expected: float) -> None:
    """Half a unit of the last digit given."""
    assert critical(modes) == pytest.approx(expected, abs=5.1e-4)


def test_follower_flutter_converges() -> None:
    loads = [critical(modes) for modes in (8, 12, 16)]
    assert np.all(np.diff(loads) < 0)
    # Measured 109.7218, 109.6955, 109.6910, and 109.6899 with 20.
    assert loads[-1] == pytest.approx(109.69, abs=2e-3)


def buckling(modes: int, K_theta: float, xi_G: float) -> float:
    """Lowest thrust at which a natural frequency vanishes: det F = 0, but for T0 = 0 itself."""

    def determinant(T0: float) -> float:
        beam = UniformBeam(T0=T0, K_theta=K_theta, xi_G=xi_G, modes=modes)
        return float(np.prod(beam.natural_frequencies() ** 2).real / T0)

    loads = np.linspace(1.0, 29.0, 8)
    signs = np.sign([determinant(T0) for T0 in loads])
    (change,) = np.flatnonzero(np.diff(signs))[:1]
    return float(brentq(determinant, loads[change], loads[change + 1], xtol=1e-12))


@pytest.mark.parametrize("K_theta", [0.25, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("xi_G", [0.0, 0.3, 0.5, 0.8, 1.0])
def test_inertial_buckling(K_theta: float, xi_G: float) -> None:
    """26.58 with two modes, whatever the control: at zero frequency the beam need not turn."""
    load = buckling(2, K_theta, xi_G)
    assert load == pytest.approx(26.58, abs=5e-3)
    # Measured 1e-14.
    assert load == pytest.approx(buckling(2, 0.7, 0.45), rel=1e-12)


def test_inertial_buckling_of_the_continuous_beam() -> None:
    """(3/2 j)^2 with the first zero j of J_(2/3): the limit of many modes, from above."""
    j = brentq(lambda x: jv(2.0 / 3.0, x), 3.0, 4.0, xtol=1e-14)
    limit = (1.5 * j) ** 2
    assert limit == pytest.approx(25.638, abs=5e-4)
    modes = [2, 4, 8, 16]
    excess = np.array([buckling(N, 0.5, 0.5) for N in modes]) - limit
    # Measured .94, .20, .036, .0054, and .00075 for 32: towards N^-3.
    assert np.all(excess > 0)
    assert np.all(excess[1:] < excess[:-1] / 4)
    assert excess[-1] < 6e-3


@pytest.mark.parametrize(("K_theta", "xi_G"), [(0.25, 0.5), (0.5, 0.5), (0.5, 0.8), (1.0, 0.6)])
def test_inertial_buckling_comes_first(K_theta: float, xi_G: float) -> None:
    """Every frequency is real below 26.58, and one is imaginary above."""

    def frequencies(T0: float) -> np.ndarray:
        return UniformBeam(T0=T0, K_theta=K_theta, xi_G=xi_G).natural_frequencies()

    assert all(not np.iscomplexobj(frequencies(T0)) for T0 in np.linspace(0.5, 26.5, 27))
    lost = frequencies(26.7)
    assert np.iscomplexobj(lost)
    assert lost[0].real == 0.0
    assert abs(lost[0].imag) > 1e-3


@both
@pytest.mark.parametrize("xi_c", [0.0, 0.2, 0.6, 1.0])
@pytest.mark.parametrize("omega_L", [math.inf, 100.0, 3.3])
def test_a_step_of_nothing(xi_c: float, omega_L: float, route: str) -> None:
    """Area and inertia ratio 1: the uniform beam."""
    common = {"T0": 20.0, "K_theta": 0.5, "xi_G": 0.4, "omega_L": omega_L, "modes": 3}
    plain = UniformBeam(**common).equation(1.1, 0.2, 0.03)
    step = {"xi_c": xi_c, "area_ratio": 1.0, "inertia_ratio": 1.0}
    stepped = SteppedBeam(**common, **step).equation(1.1, 0.2, 0.03)
    # Measured 2e-14, F_33 being 30, and 6e-15; P 1e-14.
    np.testing.assert_allclose(stepped.F, plain.F, atol=1e-13)
    np.testing.assert_allclose(stepped.G, plain.G, atol=1e-13)
    P, Q = ROUTES[route](stepped).polynomial, ROUTES[route](plain).polynomial
    np.testing.assert_allclose(P, Q, atol=2e-13)


def test_a_step_at_an_end_is_a_uniform_beam() -> None:
    """With all of the beam in one section only that section's properties count."""
    common = {"K_theta": 0.5, "xi_G": 0.4, "omega_L": 3.3}
    ratios = {"area_ratio": 0.6, "inertia_ratio": 0.4}
    uniform = UniformBeam(T0=20.0, **common).equation(1.1, 0.2)
    behind = SteppedBeam(T0=20.0, xi_c=0.0, **common, **ratios).equation(1.1, 0.2)
    # section 1 alone: T0 is over .4 EI_2, and omega_1^2 is .4/.6 of section 2's
    ahead = SteppedBeam(T0=20.0 * 0.4, xi_c=1.0, **common, **ratios).equation(1.1, 0.2)
    # Measured 4e-15.
    for found, expected in ((behind, uniform.F), (ahead, uniform.F * (0.4 / 0.6))):
        np.testing.assert_allclose(found.F, expected, atol=1e-13)


@both
def test_omega_L_large_is_omega_L_infinite(route: str) -> None:
    """The compliance enters by (Omega/omega_L)^2."""

    def P(omega_L: float) -> np.ndarray:
        beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=omega_L)
        return ROUTES[route](beam.equation(1.1, 0.2)).polynomial

    rigid = P(math.inf)
    distances = [np.max(np.abs(P(omega_L) - rigid)) for omega_L in (20.0, 200.0, 2000.0)]
    assert distances[0] / distances[1] == pytest.approx(100.0, rel=0.05)
    assert distances[1] / distances[2] == pytest.approx(100.0, rel=0.01)
