"""Systems of others, each to the digits that its source prints, by both routes.

Also: Meissner's equation in ``test_of_time.py``; Vinograd, Zhou and Hagiwara, Bittanti and
Colaneri, and the asymmetric rotor with bounds in ``test_general_determinant.py`` and
``test_general_monodromy.py``; Mathieu's characteristic values in ``compare/publications``.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from benchmarks.validation.literature import EXPONENTS
from benchmarks.validation.rotor import PRINTED, rotor
from floquet import monodromy
from hill import Fourier, HillEquation, PeriodicEquation, characteristic

ROUTES: dict[str, Callable[[Any], Any]] = {"hill": characteristic, "floquet": monodromy}
both = pytest.mark.parametrize("route", ROUTES)

# Above twice the highest frequency: no exponent is known but for a multiple of it.
UNFOLDED = 120.0


@both
def test_a_rotor_at_4000_rpm(route: str) -> None:
    """Friswell, example 5.9.1: 28 coordinates, gyroscopic; printed to a hundredth of rad/s."""
    found = ROUTES[route](rotor(4000.0, 14, 12.0))
    printed = np.array(PRINTED[4000.0])
    # faster modes are folded in between, none of them near
    off = np.abs(1e3 * found.exponents.imag[:, None] - printed).min(axis=0)
    assert np.all(off <= 0.0051)
    assert found.verdict == "stable"


@both
def test_the_rotor_at_rest(route: str) -> None:
    """Its planes are alike, and each is one of 14 coordinates: every value is printed twice.

    The third, 716.78, is a digit cut off and not rounded, if the matrices are these: their
    eigenvalue is 716.7863 by LAPACK too, and the seven other printed values are rounded.
    """
    stiffness = rotor(0.0, 14, UNFOLDED).K.mean[:14, :14]  # type: ignore[union-attr]
    found = ROUTES[route](PeriodicEquation(K=stiffness, Omega=UNFOLDED))
    exact = 1e3 * np.sqrt(np.linalg.eigvalsh(stiffness))[:3]
    off = np.abs(1e3 * found.exponents.imag[:, None] - exact).min(axis=0)
    assert np.all(off <= 1e-6)
    assert exact[:2] == pytest.approx(np.unique(PRINTED[0.0])[:2], abs=0.0051)
    assert exact[2] == pytest.approx(716.7863, abs=1e-4)
    assert np.floor(100.0 * exact[2]) == 71678


@both
@pytest.mark.parametrize("name", EXPONENTS)
def test_exponents(name: str, route: str) -> None:
    """Known exactly, up to whole multiples of i Omega."""
    e, expected = EXPONENTS[name]
    found = ROUTES[route](e)
    apart = found.exponents[:, None] - np.array(expected)
    apart -= 1j * e.Omega * np.round(apart.imag / e.Omega)
    assert np.max(np.abs(apart).min(axis=0)) < 1e-11


@both
def test_the_longer_period_of_zhou_and_hagiwara(route: str) -> None:
    """Over pi instead of pi/2 the exponents are printed as -1 and -2, without 2i."""
    twice = PeriodicEquation.first_order(
        A=Fourier(
            [[-1.5, 2.0], [-2.0, -1.5]],
            cos={2: [[0.5, 0.0], [0.0, -0.5]]},
            sin={2: [[0.0, -0.5], [-0.5, 0.0]]},
        ),
        Omega=2.0,
    )
    found = ROUTES[route](twice).exponents
    assert np.max(np.abs(found - [-1.0, -2.0])) < 1e-13


@both
@pytest.mark.parametrize("general", [False, True])
def test_coupled_mathieu_equations(general: bool, route: str) -> None:
    """Chicone, example 2.91: multipliers to the 13 digits known of them."""
    e = HillEquation([[2.0, -1.0], [-1.0, 2.0]], np.eye(2), 0.15, 2.0)
    found = ROUTES[route](e.general() if general else e)
    pair = 0.665180257006653 + 0.746682814646592j
    for mu in (-1.124942799147935, -0.888934086921956, pair, pair.conjugate()):
        assert np.min(np.abs(found.multipliers - mu)) < 1e-13
