"""Many coordinates, many steps: steps from few phases, discs one by one, T where P is of no use."""

from typing import Any

import numpy as np
import pytest

from benchmarks.validation.literature import VINOGRAD, asymmetric_rotor, random_periodic
from floquet import monodromy
from floquet.eigenvalues import discs_from_matrix
from floquet.general.mode_bounds import discs_one_by_one
from floquet.integrate import phases
from floquet.integrate.normal_form import normal_form
from floquet.integrate.parts import MAX_PARTS, Grid, parts_needed
from floquet.integrate.parts_taylor import PartsTaylor
from floquet.integrate.phases import Pair, series
from hill import Fourier, HillEquation, PeriodicEquation, UniformBeam

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=59)


def turned(n: int, seed: int) -> np.ndarray:
    """Well-conditioned coordinates."""
    rng = np.random.default_rng(seed)
    left, right = (np.linalg.qr(rng.standard_normal((n, n)))[0] for _ in range(2))
    return left @ np.diag(np.geomspace(1.0, 3.0, n)) @ right


def scalars(n: int, eta: float = 0.0) -> tuple[HillEquation, list[HillEquation]]:
    """Uncoupled Mathieu equations in other coordinates, and each alone."""
    w, R = np.linspace(1.0, 6.0, n), turned(n, n)
    G = 0.5 * w
    one = HillEquation(
        R @ np.diag(w**2) @ np.linalg.inv(R), R @ np.diag(G) @ np.linalg.inv(R), 0.4, 2.0, eta
    )
    return one, [HillEquation([[a**2]], [[b]], 0.4, 2.0, eta) for a, b in zip(w, G, strict=True)]


@pytest.mark.parametrize("n", [13, 25, 50])
@pytest.mark.parametrize("form", ["special", "general"])
def test_T_of_uncoupled_equations(n: int, form: str) -> None:
    together, each = scalars(n)
    found = monodromy(together if form == "special" else together.general())
    alone = [monodromy(one) for one in each]
    T = max(one.T for one in alone)
    assert T > 0.01
    # Measured 2e-13: R and its inverse are rounded too.
    assert abs(found.T - T) < 1e-11
    # Measured 9e-11, of fifty: in coordinates that are all coupled moduli add up.
    assert found.T_error < 2e-10
    assert found.verdict == "unstable"
    multipliers = np.concatenate([one.multipliers for one in alone])
    apart = np.abs(found.multipliers[:, None] - multipliers).min(axis=1)
    assert np.max(apart) < 1e-6


def test_sixty_coordinates_are_shown_to_be_stable() -> None:
    found = monodromy(BEAM.equation(1.3, 0.1))
    assert found.verdict == "stable"
    assert abs(found.T) <= found.T_error < 1e-13
    damped = monodromy(BEAM.equation(1.05, 0.05, eta=0.02))
    assert damped.verdict == "stable"
    assert pytest.approx(-0.02, abs=1e-15) == damped.T


def test_sixty_coordinates_by_two_forms() -> None:
    """Half a period and P(z), or all of it and the multipliers: T to 1e-10 by both."""
    equation = BEAM.equation(1.1, 0.1)
    special, general = monodromy(equation), monodromy(equation.general())
    assert special.half_period
    assert (special.verdict, general.verdict) == ("unstable", "unstable")
    assert abs(special.T - general.T) <= special.T_error + general.T_error
    assert max(special.T_error, general.T_error) < 1e-10
    # P itself is not known so well, and says so
    assert special.error > 1e-4
    fewer = monodromy(UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=40).equation(1.1, 0.1))
    assert abs(fewer.T - special.T) < 1e-3


def test_growth_in_many_coordinates_takes_the_whole_period() -> None:
    w2 = np.linspace(-4.0, 30.0, 15)
    R = turned(15, 2)
    F = R @ np.diag(w2) @ np.linalg.inv(R)
    found = monodromy(HillEquation(F, 0.0 * F, 0.0, 1.0))
    assert not found.half_period
    # exp(2 * 2 pi) = 3e5
    assert abs(found.T - 4.0) <= found.T_error < 1e-8


# ---- steps from few phases -----------------------------------------------------------------------

SLOW: dict[str, PeriodicEquation] = {
    "scalar": PeriodicEquation(K=Fourier([[1.3]], cos={1: [[0.4]]}), Omega=0.01),
    "sines, damping": PeriodicEquation(
        K=Fourier([[1.0, 0.3], [0.1, 2.0]], sin={1: [[0.3, 0.0], [0.1, 0.2]]}, cos={3: np.eye(2)}),
        C=Fourier(0.002 * np.eye(2), cos={2: [[0.0, 0.1], [-0.1, 0.0]]}),
        Omega=0.02,
    ),
    "first order": PeriodicEquation.first_order(
        A=Fourier([[0.0, 1.0], [-1.0, 0.001]], sin={2: [[0.1, 0.2], [0.3, -0.1]]}), Omega=0.002
    ),
}


@pytest.mark.parametrize("name", SLOW)
def test_steps_from_few_phases_are_the_steps(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    few = monodromy(SLOW[name])
    monkeypatch.setattr(phases, "WORTH", 10**9)
    every = monodromy(SLOW[name])
    assert not np.array_equal(few.matrix, every.matrix)
    assert np.all(np.abs(few.matrix - every.matrix) <= few.matrix_error + every.matrix_error)
    assert abs(few.T - every.T) <= few.T_error + every.T_error
    # Measured 6e-12 of 1e-9: a thousand radians are off by some ulps each
    assert np.max(np.abs(few.matrix - every.matrix)) < 1e-10 * np.max(np.abs(every.matrix))
    assert few.T_error < 1e-12


def wave(at: Any, of: int) -> Any:
    phase = 2.0 * np.pi * np.asarray(at) / of
    return np.exp(np.sin(phase))[:, None, None] * np.array([[1.0, 2.0], [0.5, 1.0]])


def test_a_series_is_what_it_is_made_of() -> None:
    known = series(wave, 3.0 * np.ones((2, 2)), 1000)
    assert known is not None
    # exp(sin x): harmonics fall like 1/(2^k k!), below 1e-16 from the 14th on
    assert len(known.series) == 32
    at = np.arange(0, 997, 83)
    assert np.max(np.abs(known(at, 997) - wave(at, 997))) < 2e-14
    assert np.allclose(known.largest, np.e * np.array([[1.0, 2.0], [0.5, 1.0]]), rtol=1e-2)


def test_a_jump_is_no_series() -> None:
    def jump(at: Any, of: int) -> Any:
        return np.sign(np.sin(2.0 * np.pi * (np.asarray(at) / of + 0.01)))[:, None, None]

    assert series(jump, np.ones((1, 1)), 10_000) is None


def test_two_stretches_are_one() -> None:
    pair = Pair(wave, 100)
    found = pair(np.array([7]), 30)
    first, second = wave([7], 30), wave([7 * 100 + 30], 3000)
    assert np.allclose(found, second @ first, rtol=1e-14)


@pytest.mark.parametrize("equation", [VINOGRAD, asymmetric_rotor(0.1), random_periodic(4)])
def test_parts_make_up_the_period(equation: PeriodicEquation) -> None:
    form = normal_form(equation)
    steps = PartsTaylor().steps(form)
    parts, times = parts_needed(steps, 3)
    assert 3 * parts * times >= steps
    assert parts <= MAX_PARTS
    grid = Grid.of(form, parts + parts % 2, 3 * times)
    whole = PartsTaylor()(form, grid)
    first = PartsTaylor()(form, Grid.of(form, parts + parts % 2, 3 * times, half=True))
    assert np.allclose(first, whole[: len(first)], rtol=0.0, atol=1e-13)
    assert len(first) == len(whole) // 2


@pytest.mark.parametrize("seed", range(10))
def test_discs_one_by_one_hold_the_eigenvalues(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = 3 + 4 * seed
    R = turned(n, seed)
    A = R @ np.diag(rng.uniform(-1.0, 1.0, n)) @ np.linalg.inv(R)
    if seed % 2:
        A = A + 0.3 * rng.standard_normal((n, n)) / np.sqrt(n)
    error = 1e-9 * rng.uniform(0.0, 1.0, (n, n))
    discs = discs_one_by_one(A, error)
    assert discs is not None
    for _ in range(20):
        true = np.linalg.eigvals(A + error * rng.choice([-1.0, 1.0], (n, n)))
        apart = np.abs(discs.centre[:, None] - true)
        assert np.all(apart.min(axis=1) <= discs.radius)
    # much smaller than a whole row
    assert n < 10 or np.max(discs.radius) < 0.5 * np.max(discs_from_matrix(A, error).radius)


def test_eigenvalues_that_meet_have_no_disc_of_their_own() -> None:
    assert discs_one_by_one(np.array([[1.0, 1.0], [0.0, 1.0]]), np.zeros((2, 2))) is None
    assert discs_one_by_one(np.diag([1.0, 1.0 + 1e-12]), 1e-9 * np.ones((2, 2))) is None
