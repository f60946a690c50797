"""The witness: what a monodromy matrix must satisfy, whatever the equation."""

import numpy as np
import pytest
from scipy.linalg import expm
from systems import DENSE, SPECIAL, random_system

from floquet import monodromy
from floquet.integrate.cvodes import Cvodes
from floquet.integrate.ode import parameter_values, shape
from floquet.integrate.taylor import Taylor
from floquet.period import second_half
from hill import HillEquation

F = np.array([[2.0, 0.3], [0.2, 1.0]])
G = np.array(DENSE)
DAMPING = np.array([[0.1, 0.5], [-0.4, 0.2]])
H = [np.array([[0.1, 0.2], [0.0, 0.3]])]

EQUATIONS = {
    "scalar": HillEquation([[1.3]], [[1.0]], 0.4, 1.0),
    "dense": HillEquation(F, G, 0.3, 1.3),
    "damped": HillEquation(F, G, 0.3, 1.3, 0.2),
    "with H": HillEquation(F, G, 0.3, 1.3, 0.2, H, 2.6),
    "slow": HillEquation(F, G, 0.3, 0.2, 0.05),
    "fast": HillEquation(F, G, 0.3, 30.0),
    "seed 2": random_system(2),
    "seed 4": random_system(4),
    "seed 7": random_system(7),
    "report's beam": SPECIAL["report's beam"],
    "stepped beam": SPECIAL["stepped beam"],
}
MATRIX_DAMPED = {
    "dashpot": HillEquation(F, G, 0.3, 1.3, [[0.2, 0.0], [0.0, 0.0]]),
    "gyroscope": HillEquation(F, G, 0.3, 1.3, DAMPING),
    "with H": HillEquation(F, G, 0.3, 1.3, DAMPING, H, 2.6),
    "excited": HillEquation(F, G, 0.3, 1.3, -DAMPING),
}
named = pytest.mark.parametrize("name", EQUATIONS)


def whole_period(equation: HillEquation, run: Taylor | Cvodes | None = None) -> np.ndarray:
    run = Taylor(order=28) if run is None else run
    return run(parameter_values(equation), shape(equation), equation.period)


def in_steps(equation: HillEquation, order: int, steps: int) -> np.ndarray:
    return Taylor(order).march(parameter_values(equation), shape(equation), equation.period, steps)


def relative(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.max(np.abs(found - expected)) / np.max(np.abs(expected)))


@named
def test_liouville(name: str) -> None:
    """det Phi = exp(-n eta T), of the matrix returned and of the run that checks it."""
    equation = EQUATIONS[name]
    found = monodromy(equation)
    expected = np.exp(-equation.n * equation.damping * equation.period)
    # Measured 3e-14 (seed 7, which grows by 20 in a period) and 1e-14.
    assert np.linalg.det(found.matrix) == pytest.approx(expected, rel=5e-13)
    assert found.liouville_defect < 2e-13


@named
def test_half_a_period_is_enough(name: str) -> None:
    """S U^-1 S U of half the period is the whole one, integrated straight through."""
    equation = EQUATIONS[name]
    undamped = parameter_values(equation, undamped=True), shape(equation)
    half, whole = (Taylor()(*undamped, t * equation.period) for t in (0.5, 1.0))
    # Measured 5e-15.
    assert relative(second_half(half)[0], whole) < 1e-13


@pytest.mark.parametrize(("name", "half"), [("report's beam", True), ("w = 2i", False)])
def test_half_a_period_is_used(name: str, half: bool) -> None:
    """But not where the solution grows by 1e5 and U cannot be inverted so well."""
    found = monodromy(SPECIAL[name])
    assert found.half_period is half
    # Measured 1e-15.
    assert relative(found.matrix, whole_period(SPECIAL[name])) < 2e-14


@named
def test_reversibility(name: str) -> None:
    """(S U)^2 = I for u = exp(eta tau/2) q, with a matrix that took no symmetry for granted."""
    equation = EQUATIONS[name]
    n, eta = equation.n, equation.damping
    Phi = whole_period(equation)
    to_u = np.block([[np.eye(n), np.zeros((n, n))], [0.5 * eta * np.eye(n), np.eye(n)]])
    Phi_u = np.exp(0.5 * eta * equation.period) * to_u @ Phi @ np.linalg.inv(to_u)
    S = np.diag([1.0] * n + [-1.0] * n)
    size = max(1.0, np.max(np.abs(Phi_u)) ** 2)
    # Measured 3e-15 and 8e-15.
    assert np.max(np.abs(S @ Phi_u @ S @ Phi_u - np.eye(2 * n))) / size < 1e-13
    assert monodromy(equation).reversibility_defect < 1e-13


@named
def test_multipliers_are_eigenvalues(name: str) -> None:
    """Compared by their polynomial, which double multipliers on the unit circle do not blur."""
    found = monodromy(EQUATIONS[name])
    from_pairs, from_matrix = np.poly(found.multipliers), np.poly(found.matrix)
    # Measured 5e-14 (seed 7), 2e-15.
    assert relative(np.real(from_pairs), from_matrix) < 1e-12
    assert np.all(np.diff(np.abs(found.multipliers)) <= 1e-12)


@named
def test_z_are_half_sums_of_pairs(name: str) -> None:
    """(mu + 1/mu)/2 over all 2n multipliers of u is each z, twice."""
    equation = EQUATIONS[name]
    found = monodromy(equation)
    mu = found.multipliers * np.exp(0.5 * equation.damping * equation.period)
    twice = np.real(np.poly(0.5 * (mu + 1.0 / mu)))
    # Measured 4e-15 and 2.1e-14.
    assert relative(twice, np.real(np.poly(np.repeat(found.z, 2)))) < 1e-13
    assert relative(np.real(np.poly(found.z)), found.polynomial) < 1e-13


@named
def test_T_is_the_growth_of_the_solution(name: str) -> None:
    """exp(T tau/2): the largest multiplier after one period."""
    equation = EQUATIONS[name]
    found = monodromy(equation)
    growth = np.log(np.abs(np.linalg.eigvals(found.matrix)).max()) * 2.0 / equation.period
    # Measured 2e-14: no two multipliers of these meet.
    assert abs(found.T - growth) < 5e-13
    assert found.stable == (found.T_error >= found.T)


@named
def test_cvodes_is_taylor(name: str) -> None:
    equation = EQUATIONS[name]
    taylor, cvodes = monodromy(equation), monodromy(equation, method="cvodes")
    assert (taylor.method, cvodes.method) == ("taylor", "cvodes")
    # Measured 3e-12.
    assert relative(cvodes.matrix, taylor.matrix) < 5e-11
    difference = np.max(np.abs(cvodes.polynomial - taylor.polynomial))
    assert difference <= cvodes.error + taylor.error


@named
def test_finer_steps_change_nothing(name: str) -> None:
    """Steps for a tolerance of 1e-17 are short enough for one of 1e-24."""
    equation = EQUATIONS[name]
    # Measured 4e-15 (seed 7), 2e-15.
    fine = whole_period(equation, Taylor(24, 1e-24))
    assert relative(whole_period(equation, Taylor(24)), fine) < 1e-13


@pytest.mark.parametrize("order", [4, 6, 8])
@pytest.mark.parametrize("name", ["dense", "with H", "report's beam"])
def test_order_of_convergence(name: str, order: int) -> None:
    """The velocity keeps one power of h less than the order."""
    equation = EQUATIONS[name]
    exact = whole_period(equation)
    steps = [24, 32, 48, 64]
    errors = [relative(in_steps(equation, order, n), exact) for n in steps]
    fitted = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    # Measured 1e-10 and more, far above rounding: 2.96 to 3.07, 4.96 to 5.12, 6.95 to 7.16.
    assert errors[-1] > 1e-12
    assert fitted == pytest.approx(order - 1, abs=0.3)


@pytest.mark.parametrize("run", [Taylor(), Taylor(29), Cvodes()], ids=repr)
@pytest.mark.parametrize("Omega", [0.5, 2.0])
def test_meissner(run: Taylor | Cvodes, Omega: float) -> None:
    """x'' + (a + b sgn(cos Omega t)) x: two constant halves, the trace in closed form."""
    a, b, half = 1.7, 0.6, np.pi / Omega
    pieces = []
    for square in (a + b, a - b):
        constant = HillEquation([[square]], [[0.0]], 0.0, Omega)
        pieces.append(run(parameter_values(constant), shape(constant), half))
    p, q = np.sqrt([a + b, a - b])
    c, d = p * half, q * half
    trace = 2 * np.cos(c) * np.cos(d) - (p / q + q / p) * np.sin(c) * np.sin(d)
    # Measured 2e-15 and 4e-12.
    tolerance = 5e-11 if isinstance(run, Cvodes) else 2e-14
    assert np.trace(pieces[1] @ pieces[0]) == pytest.approx(trace, abs=tolerance)


@pytest.mark.parametrize("eta", [0.3, DAMPING], ids=["scalar", "matrix"])
@pytest.mark.parametrize("method", ["taylor", "cvodes"])
def test_constant_coefficients(eta: object, method: str) -> None:
    """Without pulsation Phi is the exponential of the first-order matrix."""
    equation = HillEquation(F, G, 0.0, 1.3, eta)  # type: ignore[arg-type]
    C = eta * np.eye(2) if np.ndim(eta) == 0 else DAMPING
    first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-F, -C]])
    found = monodromy(equation, method=method)  # type: ignore[arg-type]
    # Measured 6e-14, scipy's share included, and 8e-13.
    tolerance = 5e-13 if method == "taylor" else 1e-11
    assert relative(found.matrix, expm(first_order * equation.period)) < tolerance


@pytest.mark.parametrize("eta", [0.0, 0.2, -0.1])
def test_a_multiple_of_the_identity_is_a_scalar(eta: float) -> None:
    """The same monodromy by two different ways."""
    scalar = monodromy(HillEquation(F, G, 0.3, 1.3, eta, H, 2.6))
    matrix = monodromy(HillEquation(F, G, 0.3, 1.3, eta * np.eye(2), H, 2.6))
    assert (scalar.half_period, matrix.half_period) == (True, False)
    # Measured 6e-16, 2e-15, 3e-16.
    assert relative(matrix.matrix, scalar.matrix) < 1e-14
    multipliers = (np.real(np.poly(m.multipliers)) for m in (matrix, scalar))
    assert relative(*multipliers) < 5e-14
    assert abs(matrix.T - scalar.T) < 1e-14


@pytest.mark.parametrize("name", MATRIX_DAMPED)
@pytest.mark.parametrize("method", ["taylor", "cvodes"])
def test_a_damping_matrix(name: str, method: str) -> None:
    """No z, no reversibility, the multipliers' own polynomial; Liouville with the trace of C."""
    equation = MATRIX_DAMPED[name]
    found = monodromy(equation, method=method)  # type: ignore[arg-type]
    assert found.z.shape == (0,)
    assert not found.half_period
    assert np.isnan(found.reversibility_defect)
    assert found.polynomial.shape == (5,)
    expected = np.exp(-np.trace(equation.eta) * equation.period)
    # Measured 9e-16 and 9e-16, cvodes 8e-14 and 4e-12.
    assert np.linalg.det(found.matrix) == pytest.approx(expected, rel=5e-12)
    assert found.liouville_defect < (1e-13 if method == "taylor" else 5e-11)
    assert found.polynomial[-1] == pytest.approx(expected, abs=found.error)
    growth = np.log(np.abs(found.multipliers).max()) * 2.0 / equation.period
    assert abs(found.T - growth) < 1e-13
    assert found.stable == (name != "excited")


@pytest.mark.parametrize("name", ["dense", "with H", "fast"])
def test_two_periods(name: str) -> None:
    """Time starts at a crest again: Phi(2 T) = Phi(T)^2."""
    equation = EQUATIONS[name]
    twice = Taylor(28)(parameter_values(equation), shape(equation), 2 * equation.period)
    Phi = monodromy(equation).matrix
    # Measured 1e-15.
    assert relative(Phi @ Phi, twice) < 5e-14


@pytest.mark.parametrize("square", [-1.0, -31.0, -1e5])
def test_growth_is_finite_or_refused(square: float) -> None:
    try:
        found = monodromy(HillEquation([[square]], [[1.0]], 0.1, 1.0))
    except OverflowError:
        assert np.sqrt(-square) * 2 * np.pi > 300
        return
    numbers = [found.error, found.T, found.T_error, *found.polynomial]
    assert np.all(np.isfinite(numbers))
    assert abs(found.T / (2 * np.sqrt(-square)) - 1.0) < 2e-3


def test_damping_beyond_a_float_is_refused() -> None:
    """exp(pi eta/Omega) = exp(942): refused in one line, not a matrix of nan."""

    def damped(Omega: float) -> HillEquation:
        return HillEquation(F=[[1.7]], G=[[1.0]], gamma=0.0, Omega=Omega, eta=0.3)

    with pytest.raises(OverflowError, match=r"eta = 0\.3, Omega = 0\.001: the decay"):
        monodromy(damped(0.001))
    # half of it is within reach, and T is -eta: 2e-15 measured
    assert abs(monodromy(damped(0.002)).T + 0.3) < 1e-12
