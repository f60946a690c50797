"""General periodic equations as data: what is kept, what is refused."""

import re
from typing import Any

import numpy as np
import pytest

from hill import Fourier, HillEquation, PeriodicEquation

TWO = np.array([[1.0, 0.2], [0.3, 2.0]])


def test_what_is_left_out_has_its_default() -> None:
    e = PeriodicEquation(K=TWO, Omega=1.3)
    assert np.array_equal(e.M, np.eye(2))
    assert np.array_equal(e.C.mean, np.zeros((2, 2)))
    assert (e.order, e.A) == (4, None)
    assert e.period == 2.0 * np.pi / 1.3


def test_first_order() -> None:
    e = PeriodicEquation.first_order(A=Fourier(TWO, sin={3: TWO}), Omega=2.0)
    assert e.order == 2
    assert e.A.harmonics == (3,)
    assert (e.M, e.C, e.K) == (None, None, None)


def test_the_special_equation_in_general_form() -> None:
    """gamma cos(Omega tau) G and H_s cos(s omega_L tau), added where they meet."""
    H = [3.0 * TWO, 5.0 * TWO]
    e = HillEquation(TWO, 2.0 * TWO, 0.5, 1.1, 0.1, H, 1.1).general()
    assert e.K.harmonics == (1, 2)
    assert np.allclose(e.K.cos[1], TWO + 3.0 * TWO, rtol=1e-15)
    assert np.array_equal(e.K.cos[2], 5.0 * TWO)
    assert np.array_equal(e.C.mean, 0.1 * np.eye(2))
    assert (len(e.K.sin), e.Omega) == (0, 1.1)


def test_a_damping_matrix_in_general_form() -> None:
    assert np.array_equal(HillEquation(TWO, TWO, 0.0, 1.0, TWO).general().C.mean, TWO)


def test_nothing_can_be_changed() -> None:
    e = PeriodicEquation(K=Fourier(TWO, cos={1: TWO}), Omega=1.3)
    with pytest.raises(ValueError, match="read-only"):
        e.K.cos[1][0, 0] = 1.0
    with pytest.raises(TypeError):
        e.K.cos[2] = TWO  # type: ignore[index]
    with pytest.raises(AttributeError):
        e.Omega = 2.0  # type: ignore[misc]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"Omega": 0.0}, "Omega = 0: must be greater than 0"),
        ({"Omega": float("nan")}, "Omega = nan: must be finite"),
        ({"K": [[1.0, 2.0]]}, "K has shape (1, 2): must be square"),
        ({"C": [[1.0]]}, "C has shape (1, 1): must be (2, 2) like K"),
        ({"C": Fourier([[1.0]])}, "C has shape (1, 1): must be (2, 2) like K"),
        ({"M": np.ones((2, 2))}, "M: is singular"),
        ({"M": np.eye(3)}, "M has shape (3, 3): must be (2, 2) like K"),
        ({"K": TWO + 1j}, "K: must be a matrix of real numbers"),
        ({"K": [[1.0, np.inf], [0.0, 1.0]]}, "K[0, 1] = inf: every element must be finite"),
        ({"data_error": -1.0}, "data_error = -1: must be between 0 and 1"),
    ],
)
def test_bad_input(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        PeriodicEquation(**({"K": TWO, "Omega": 1.3} | given))


@pytest.mark.parametrize(
    ("harmonics", "message"),
    [
        ({0: TWO}, "Fourier.cos[0]: the index must be a whole number >= 1"),
        ({-1: TWO}, "Fourier.cos[-1]: the index must be a whole number >= 1"),
        ({1.5: TWO}, "Fourier.cos[1.5]: the index must be a whole number >= 1"),
        ({True: TWO}, "Fourier.cos[True]: the index must be a whole number >= 1"),
        ({10**9: TWO}, "Fourier.cos[1000000000]: the index must be at most 10,000"),
        ({1: [[1.0]]}, "Fourier.cos[1] has shape (1, 1): must be (2, 2) like the mean"),
        ([TWO], "Fourier.cos: must be a mapping"),
    ],
)
def test_bad_harmonics(harmonics: Any, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        Fourier(TWO, cos=harmonics)
