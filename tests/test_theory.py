"""What docs/theory.md asserts, checked where no other test does."""

import numpy as np
import pytest

from floquet import monodromy
from hill import HillEquation, characteristic


@pytest.fixture(scope="module")
def equation() -> HillEquation:
    rng = np.random.default_rng(20)
    F = np.diag([1.0, 2.0, 5.0]) + 0.2 * rng.standard_normal((3, 3))
    return HillEquation(F=F, G=rng.standard_normal((3, 3)), gamma=0.7, Omega=1.3)


def test_half_sum_of_phi_and_its_inverse_is_block_diagonal(equation: HillEquation) -> None:
    Phi = monodromy(equation).matrix
    half = 0.5 * (Phi + np.linalg.inv(Phi))
    # rounding of the inverse: 1e-14 here, while the blocks themselves are of order 1 to 10
    assert np.abs(half[:3, 3:]).max() < 1e-12
    assert np.abs(half[3:, :3]).max() < 1e-12
    assert np.allclose(np.poly(half[:3, :3]), np.poly(half[3:, 3:]), rtol=0, atol=1e-11)


def modal(gamma: float, Omega: float, G: np.ndarray, omega: np.ndarray) -> HillEquation:
    return HillEquation(F=np.diag(omega**2), G=G, gamma=gamma, Omega=Omega)


@pytest.mark.parametrize(("i", "j", "sign"), [(0, 0, 1), (1, 1, 1), (0, 1, 1), (0, 1, -1)], ids=str)
def test_half_circles(i: int, j: int, sign: int) -> None:
    omega = np.array([1.0, 2.7])
    # G_ij G_ji > 0 makes the sum unstable, < 0 the difference
    G = np.array([[0.9, 0.8], [0.5 * sign, -1.3]])
    centre = 2 * omega[i] if i == j else omega[1] + sign * omega[0]
    size = abs(G[i, i]) if i == j else np.sqrt(abs(G[0, 1] * G[1, 0]))
    misses = []
    for gamma in (0.08, 0.04, 0.02):
        T_x = 0.5 * gamma * size / np.sqrt(omega[i] * omega[j])
        T = [
            characteristic(modal(gamma, centre + x * T_x, G, omega)).T / T_x
            for x in (-0.6, 0.0, 0.6)
        ]
        misses.append(np.abs(np.array(T) - [0.8, 1.0, 0.8]).max())
    # averaging is first order in gamma: the miss halves with it
    assert misses[-1] < 0.02
    assert misses[0] / misses[1] == pytest.approx(2.0, rel=0.35)
    assert misses[1] / misses[2] == pytest.approx(2.0, rel=0.35)


def test_a_pair_is_unstable_at_the_sum_or_at_the_difference_not_at_both() -> None:
    omega, gamma = np.array([1.0, 2.7]), 0.04
    for sign in (1, -1):
        G = np.array([[0.9, 0.8], [0.5 * sign, -1.3]])
        there = characteristic(modal(gamma, omega[1] + sign * omega[0], G, omega))
        other = characteristic(modal(gamma, omega[1] - sign * omega[0], G, omega))
        assert there.verdict == "unstable"
        assert other.stable
