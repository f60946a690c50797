"""P and T without the check: what the checked route finds, to within its bounds."""

import numpy as np
import pytest
from systems import random_system

from floquet import monodromy
from floquet.unchecked import TOGETHER, unchecked_growth, unchecked_polynomials
from hill import HillEquation

# sizes 1 to 8, with and without damping, harmonics and growth
SEEDS = range(40)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_same_P_as_with_the_check(seed: int) -> None:
    equation = random_system(seed)
    checked = monodromy(equation)
    (found,) = unchecked_polynomials([equation])
    size = np.max(np.abs(checked.polynomial))
    # np.poly rounds where the checked P is exact; measured 4e-14 of the largest coefficient
    assert np.max(np.abs(found - checked.polynomial)) <= checked.error + 1e-12 * size


@pytest.mark.parametrize("count", [TOGETHER - 1, TOGETHER, 3 * TOGETHER])
def test_equations_come_back_in_order(count: int) -> None:
    F, G = np.array([[1.0, 0.3], [-0.2, 4.0]]), np.array([[0.5, 0.1], [0.2, -0.4]])
    equations = [
        HillEquation(F, G + 0.1 * k * np.eye(2), 0.4, 0.7 + (1.7 * k) % 2.3, 0.02)
        for k in range(count)
    ]
    together = unchecked_polynomials(equations)
    for equation, found in zip(equations, together, strict=True):
        checked = monodromy(equation)
        assert np.max(np.abs(found - checked.polynomial)) <= checked.error + 1e-13


def test_growth_is_the_larger_multiplier_s() -> None:
    """Z = cosh a makes T = Omega a/pi; z within [-1, 1] makes none."""
    P = np.array(
        [np.poly([np.cosh(0.7), 0.2]), np.poly([-np.cosh(0.3), -0.9]), np.poly([0.1, 0.9])]
    )
    Omega = np.array([2.0, 1.0, 3.0])
    expected = Omega / np.pi * np.array([0.7, 0.3, 0.0]) - 0.01
    assert unchecked_growth(P, Omega, 0.01) == pytest.approx(expected, abs=1e-14)


def test_growth_is_what_the_checked_route_finds() -> None:
    for seed in SEEDS:
        equation = random_system(seed)
        m = monodromy(equation)
        (T,) = unchecked_growth(m.polynomial[None], equation.Omega, equation.damping)
        assert abs(T - m.T) <= m.T_error
