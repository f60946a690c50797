"""The determinant's own cases: what the report excludes, and its finite form."""

import math
from itertools import pairwise

import numpy as np
import pytest
from systems import DENSE, SPECIAL

from floquet import monodromy
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic
from hill.determinant.finite import blocks

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)


def distance(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.max(np.abs(one - other)))


@pytest.mark.parametrize("name", SPECIAL)
def test_what_the_report_excludes(name: str) -> None:
    """The two routes meet as closely as anywhere else."""
    hill, floquet = characteristic(SPECIAL[name]), monodromy(SPECIAL[name])
    assert hill.form == "converged"
    size = np.max(np.abs(floquet.polynomial))
    # Measured 2e-14 and less, 3e-13 with three harmonics; 5e-12 where the coupling is 15 times
    # the square of the forcing frequency.
    tolerance = 5e-11 if name == "strong coupling" else 2e-12
    assert distance(hill.polynomial, floquet.polynomial) <= tolerance * size


@pytest.mark.parametrize(
    ("name", "form"),
    [
        ("w = 2", "samples"),
        ("w = 1", "samples"),
        ("w = 1/2", "samples"),
        ("w = 3/2", "samples"),
        ("w = 1/2, damped", "samples"),
        ("w_2 - w_1 = 1", "samples"),
        ("w_1 + w_2 = 1", "samples"),
        ("equal diagonal", "samples"),
        ("defective F", "samples"),
        ("report's beam", "residues"),
        ("one negative", "residues"),
        ("no coupling", "residues"),
    ],
)
@pytest.mark.parametrize("truncation", ["report", 8])
def test_form_is_samples_where_poles_meet(name: str, form: str, truncation: object) -> None:
    assert characteristic(SPECIAL[name], truncation=truncation).form == form  # type: ignore[arg-type]


@pytest.mark.parametrize("offset", [1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("M", [6, 12])
def test_residues_and_samples_are_one_polynomial(offset: float, M: int) -> None:
    """Close to where poles meet the residues still exist, and give the samples' P."""
    at = HillEquation([[4.0]], [[1.0]], 0.3, 1.0)
    near = HillEquation([[(2.0 + offset) ** 2]], [[1.0]], 0.3, 1.0)
    samples, residues = (characteristic(e, truncation=M) for e in (at, near))
    assert (samples.form, residues.form) == ("samples", "residues")
    # P itself moves by .17 offset at most; the two finite forms differ by .017 M^-3 (measured).
    assert distance(samples.polynomial, residues.polynomial) < 0.2 * offset + 0.02 / M**3


@pytest.mark.parametrize("K_theta", [0.0, 1e-12, 1e-6])
@pytest.mark.parametrize("Omega", [0.38, 1.1, 2.0])
def test_an_uncontrolled_beam(K_theta: float, Omega: float) -> None:
    """Rotation has no stiffness, w = 0 is a double root: nothing special."""
    beam = UniformBeam(T0=20.0, K_theta=K_theta, xi_G=0.5)
    equation = beam.equation(Omega, 0.2)
    hill, floquet = characteristic(equation), monodromy(equation)
    # Measured 2e-14.
    assert distance(hill.polynomial, floquet.polynomial) < 5e-13


def without_coupling(Omega: float, squares: list[float]) -> np.ndarray:
    """prod (z - cos(2 pi sqrt(lambda)/Omega))."""
    return np.real(np.poly(np.cos(2 * np.pi * np.sqrt(np.array(squares, complex)) / Omega)))


@pytest.mark.parametrize("Omega", [0.38, 1.1, 2.0, 7.0])
@pytest.mark.parametrize(
    "squares",
    [[2.0], [2.0, 3.0], [0.0, 2.0, 3.0], [-0.01, 2.0, 3.0], [2.0, 2.0, 3.0], [1.0, 4.0, 9.0]],
    ids=str,
)
def test_report_form_without_coupling(Omega: float, squares: list[float]) -> None:
    """Every Delta is 1: P is the product over the poles, whatever M."""
    equation = HillEquation(np.diag(squares), np.ones((len(squares),) * 2), 0.0, Omega)
    expected = without_coupling(Omega, squares)
    for truncation in ("report", 14, "converged"):
        found = characteristic(equation, truncation=truncation)  # type: ignore[arg-type]
        # The cosine's argument, up to 50, is rounded: measured 6e-15.
        assert distance(found.polynomial, expected) < 1e-13 * np.max(np.abs(expected))


@pytest.mark.parametrize("Omega", [0.38, 1.1, 2.0, 7.0])
@pytest.mark.parametrize(
    "F",
    [
        [[2.0, 1.0], [3.0, 5.0]],
        [[2.0, 1.0], [0.0, 2.0]],
        [[2.0, 0.3], [-0.3, 2.0]],
        [[-0.1, 1], [1, 2]],
    ],
    ids=["dense", "defective", "complex", "negative"],
)
def test_gamma_zero(F: list[list[float]], Omega: float) -> None:
    """F need not be diagonal for the converged form."""
    found = characteristic(HillEquation(F, DENSE, 0.0, Omega))
    trace, det = np.trace(F), np.linalg.det(F)
    root = np.sqrt(complex(trace**2 / 4 - det))
    expected = without_coupling(Omega, [trace / 2 + root, trace / 2 - root])
    # A double eigenvalue is known to 1e-8 only, but enters in pairs: measured 4e-15.
    assert distance(found.polynomial, expected) < 2e-13 * np.max(np.abs(expected))


def slope(x: list[int], y: list[float]) -> float:
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


@pytest.mark.parametrize(
    "name", ["w = 1/2", "w = 2", "report's beam", "equal diagonal", "stepped beam"]
)
def test_a_finite_determinant_falls_like_M_to_the_minus_three(name: str) -> None:
    equation = SPECIAL[name]
    converged = characteristic(equation).polynomial
    sizes = [8, 12, 16, 24, 32]
    found = [characteristic(equation, truncation=M) for M in sizes]
    distances = [distance(f.polynomial, converged) for f in found]
    # Measured -2.94 to -3.06.
    assert slope(sizes, distances) == pytest.approx(-3.0, abs=0.1)
    assert [f.M for f in found] == [(M,) * equation.n for M in sizes]


@pytest.mark.parametrize("name", ["report's beam", "report's beam, slow", "w = 2", "one negative"])
def test_report_form_converges_to_the_tail_summed(name: str) -> None:
    """Two finite determinants, extrapolated by M^-3, are as much nearer as they should be."""
    equation = SPECIAL[name]
    converged = characteristic(equation).polynomial
    sizes = [16, 32, 64]
    P = [characteristic(equation, truncation=M).polynomial for M in sizes]
    plain = [distance(p, converged) for p in P]
    twice = [distance((8 * q - p) / 7, converged) for p, q in pairwise(P)]
    assert plain[2] < plain[1] / 6 < plain[0] / 36
    # Measured 20 times nearer and more; what is left falls like M^-4, or M^-5 for one coordinate.
    assert twice[0] < plain[1] / 15
    assert twice[1] < twice[0] / 10


@pytest.mark.parametrize(
    ("diagonal", "eta", "Omega", "M"),
    [
        ([2.25, 6.25, 0.25], 0.0, 0.7, (6, 8, 5)),  # 4/.7 + 1, 5/.7 + 1, 3/.7 + 1
        ([2.25, 6.25, 0.25], 0.0, 7.0, (1, 1, 1)),  # 0.57 + 1, 0.71 + 1, 0.43 + 1
        ([2.25, 6.25, 0.25], 0.0, 0.3, (14, 14, 11)),  # 14.3, 17.7, 11
        ([2.25, -6.25, 0.25], 0.0, 0.7, (6, 8, 5)),  # sqrt|F|
        ([3.25, 7.25, 1.25], 2.0, 0.7, (6, 8, 5)),  # F - eta^2/4
    ],
)
def test_M_rule(diagonal: list[float], eta: float, Omega: float, M: tuple[int, ...]) -> None:
    """(sqrt|F_NN| + sqrt|F_jj|)/Omega + 1, at most 14."""
    equation = HillEquation(np.diag(diagonal), np.ones((3, 3)), 0.1, Omega, eta)
    assert characteristic(equation, truncation="report").M == M


def test_M_rule_for_the_beam_of_the_report() -> None:
    """Roots .868, 2.499, .346: 3.368/1.1 + 1 = 4.06, 4.999/1.1 + 1 = 5.54, 2.846/1.1 + 1 = 3.59."""
    equation = BEAM.equation(1.1, 0.1)
    assert np.round(np.sqrt(np.diag(equation.F)), 3).tolist() == [0.868, 2.499, 0.346]
    assert characteristic(equation, truncation="report").M == (4, 5, 3)


@pytest.mark.parametrize("beam", [UniformBeam, SteppedBeam])
@pytest.mark.parametrize("Omega", [3.0, 5.0])
def test_twelve_modes(beam: type, Omega: float) -> None:
    """The highest frequency is 69 omega_1, w = 23, the mode's exponentials reach 1e17."""
    step = {} if beam is UniformBeam else {"xi_c": 0.6, "area_ratio": 0.6, "inertia_ratio": 0.6}
    equation = beam(T0=10.0, K_theta=0.5, xi_G=0.5, modes=12, **step).equation(Omega, 0.2)
    hill, floquet = characteristic(equation), monodromy(equation)
    assert equation.n == 13
    # Measured 7e-14 and less.
    assert distance(hill.polynomial, floquet.polynomial) < 2e-12 * np.max(np.abs(hill.polynomial))
    assert distance(hill.polynomial, floquet.polynomial) <= hill.error + floquet.error


GROWING = {
    "exp(7)": (-1.0, 1.0),
    "exp(35)": (-31.0, 1.0),
    "exp(200)": (-1e3, 1.0),
    "exp(600)": (-9.2e3, 1.0),
    "exp(6e3)": (-1e6, 1.0),
    "exp(6e5)": (-1e6, 0.01),
}


@pytest.mark.parametrize("name", GROWING)
def test_growth_is_finite_or_refused(name: str) -> None:
    """Never a nan or an infinity that nobody has spoken of."""
    square, Omega = GROWING[name]
    equation = HillEquation([[square]], [[1.0]], 0.1, Omega)
    try:
        found = characteristic(equation)
    except (OverflowError, ValueError):
        assert 2 * np.pi * math.sqrt(-square) / Omega > 500.0
        return
    assert np.all(np.isfinite(found.polynomial))
    assert np.all(np.isfinite([found.error, found.T, found.T_error]))
    # gamma's part of T is of second order: measured 5e-4 for exp(7), the others less.
    assert abs(found.T / (2.0 * math.sqrt(-square)) - 1.0) < 2e-3
    assert found.error < 1e-9 * np.max(np.abs(found.polynomial))


def test_the_blocks_are_those_of_the_report() -> None:
    """Fbar = (F - eta^2/4)/Omega^2, B_1 = gamma G/(2 Omega^2), B_(s r) = H_s/(2 Omega^2)."""
    F, G, H = np.diag([2.0, 3.0]), np.array(DENSE), [np.eye(2), 2 * np.eye(2)]
    system = blocks(HillEquation(F, G, 0.2, 2.0, 0.4, H, 6.0))
    np.testing.assert_allclose(system.Fbar, (F - 0.04 * np.eye(2)) / 4.0, rtol=1e-15)
    np.testing.assert_allclose(system.B[1], 0.025 * G, rtol=1e-15)
    np.testing.assert_allclose(system.B[3], 0.125 * np.eye(2), rtol=1e-15)
    np.testing.assert_allclose(system.B[6], 0.25 * np.eye(2), rtol=1e-15)
    assert sorted(system.B) == [1, 3, 6]


def test_H_in_step_with_the_thrust_adds_to_it() -> None:
    """omega_L = Omega: gamma G and H_1 are one harmonic."""
    G, H = np.array(DENSE), np.array([[0.3, 0.1], [0.7, -0.2]])
    F = np.diag([2.0, 3.3])
    apart = characteristic(HillEquation(F, G, 0.2, 1.1, 0.0, [H], 1.1))
    together = characteristic(HillEquation(F, 0.2 * G + H, 1.0, 1.1))
    # One rounding of the sum.
    assert distance(apart.polynomial, together.polynomial) < 1e-14


@pytest.mark.parametrize("truncation", ["converged", "report", 5])
def test_the_sign_of_gamma_does_not_matter(truncation: object) -> None:
    """Half a period later the cosine has the other sign."""
    both = [
        characteristic(BEAM.equation(1.1, gamma), truncation=truncation)  # type: ignore[arg-type]
        for gamma in (0.3, -0.3)
    ]
    assert distance(both[0].polynomial, both[1].polynomial) < 1e-13


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_units_do_not_matter(scale: float) -> None:
    """Neither the coordinates' nor time's."""
    G = np.array(DENSE)
    F = np.array([[2.0, 1.0], [0.5, 3.0]])
    plain = characteristic(HillEquation(F, G, 0.3, 1.1)).polynomial
    D = np.diag([1.0, scale])
    coordinates = HillEquation(D @ F @ np.linalg.inv(D), D @ G @ np.linalg.inv(D), 0.3, 1.1)
    time = HillEquation(scale**2 * F, scale**2 * G, 0.3, scale * 1.1)
    for other in (coordinates, time):
        # Measured 2e-15.
        assert distance(characteristic(other).polynomial, plain) < 5e-14
