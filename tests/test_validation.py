"""Every bad input is refused: `ValueError`, one line, the parameter by name and its value."""

import dataclasses
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from floquet import monodromy
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic

NAN, INF = math.nan, math.inf
TWO = np.array([[1.0, 0.2], [0.3, 2.0]])
WITH_NAN = [[1.0, 0.0], [NAN, 1.0]]
WITH_INF = [[1.0, -INF], [0.0, 1.0]]


def equation(**changes: Any) -> HillEquation:
    return HillEquation(**({"F": TWO, "G": TWO, "gamma": 0.1, "Omega": 1.1} | changes))


def uniform(**changes: Any) -> UniformBeam:
    return UniformBeam(**({"T0": 20.0, "K_theta": 0.5, "xi_G": 0.5} | changes))


def stepped(**changes: Any) -> SteppedBeam:
    ratios = {"xi_c": 0.6, "area_ratio": 0.6, "inertia_ratio": 0.6}
    return SteppedBeam(**({"T0": 20.0, "K_theta": 1.0, "xi_G": 0.5} | ratios | changes))


def refused(call: Callable[..., Any], *given: Any, message: str, **named: Any) -> None:
    with pytest.raises(ValueError, match=re.escape(message)) as refusal:
        call(*given, **named)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"F": [[1.0, 2.0]]}, "F has shape (1, 2): must be square"),
        ({"F": [1.0, 2.0]}, "F has shape (2,): must be square"),
        ({"F": 3.0}, "F has shape (): must be square"),
        ({"F": np.ones((2, 2, 2))}, "F has shape (2, 2, 2): must be square"),
        ({"F": np.empty((0, 0))}, "F has shape (0, 0): must be square and not empty"),
        ({"F": [[1.0], [1.0, 2.0]]}, "F: must be a matrix of real numbers"),
        ({"F": [["1", "x"], ["2", "y"]]}, "F: must be a matrix of real numbers"),
        ({"F": TWO + 0j}, "F: must be a matrix of real numbers"),
        ({"F": TWO > 0.5}, "F: must be a matrix of real numbers"),
        ({"F": None}, "F"),
        ({"F": WITH_NAN}, "F[1, 0] = nan"),
        ({"F": WITH_INF}, "F[0, 1] = -inf"),
        ({"G": [[1.0]]}, "G has shape (1, 1): must be (2, 2) like F"),
        ({"G": [[1.0, 2.0]]}, "G has shape (1, 2): must be square"),
        ({"G": 1j * TWO}, "G: must be a matrix of real numbers"),
        ({"G": WITH_NAN}, "G[1, 0] = nan"),
        ({"G": WITH_INF}, "G[0, 1] = -inf"),
        ({"H": [TWO, [[1.0]]], "omega_L": 2.2}, "H[1] has shape (1, 1): must be (2, 2) like F"),
        ({"H": [WITH_NAN], "omega_L": 2.2}, "H[0][1, 0] = nan"),
        ({"H": [TWO, WITH_INF], "omega_L": 2.2}, "H[1][0, 1] = -inf"),
        ({"H": [TWO * 1j], "omega_L": 2.2}, "H[0]: must be a matrix of real numbers"),
        ({"H": TWO, "omega_L": 2.2}, "H[0] has shape (2,): must be square"),
        ({"H": 3, "omega_L": 2.2}, "H: must be a sequence of (2, 2) matrices"),
        ({"eta": [[0.1]]}, "eta has shape (1, 1): must be (2, 2) like F"),
        ({"eta": [0.1, 0.2]}, "eta has shape (2,): must be square"),
        ({"eta": WITH_NAN}, "eta[1, 0] = nan"),
        ({"eta": WITH_INF}, "eta[0, 1] = -inf"),
        ({"eta": 1j * TWO}, "eta: must be a matrix of real numbers"),
        ({"eta": NAN}, "eta = nan"),
        ({"eta": -INF}, "eta = -inf"),
        ({"eta": 0.1j}, "eta = 0.1j"),
        ({"gamma": NAN}, "gamma = nan"),
        ({"gamma": INF}, "gamma = inf"),
        ({"gamma": "0.1"}, "gamma = '0.1'"),
        ({"gamma": True}, "gamma = True"),
        ({"gamma": 0.1 + 0j}, "gamma = (0.1+0j)"),
        ({"gamma": None}, "gamma = None"),
        ({"Omega": 0.0}, "Omega = 0"),
        ({"Omega": -1.1}, "Omega = -1.1"),
        ({"Omega": NAN}, "Omega = nan"),
        ({"Omega": INF}, "Omega = inf"),
        ({"omega_L": 0.0}, "omega_L = 0"),
        ({"omega_L": -2.2}, "omega_L = -2.2"),
        ({"omega_L": NAN}, "omega_L = nan"),
        ({"omega_L": -INF}, "omega_L = -inf"),
        ({"H": [TWO]}, "omega_L/Omega = inf"),
        ({"H": [TWO], "omega_L": 2.0}, "omega_L/Omega = 1.81818182"),
        ({"H": [TWO], "omega_L": 0.55}, "omega_L/Omega = 0.5"),
        ({"H": [TWO], "omega_L": 2.2 * (1 + 1e-12)}, "omega_L/Omega = 2 (omega_L = 2.2"),
    ],
)
def test_equation(changes: dict[str, Any], message: str) -> None:
    refused(equation, message=message, **changes)


@pytest.mark.parametrize("beam", [uniform, stepped])
@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"T0": NAN}, "T0 = nan"),
        ({"T0": INF}, "T0 = inf"),
        ({"T0": "20"}, "T0 = '20'"),
        ({"K_theta": NAN}, "K_theta = nan"),
        ({"K_theta": 1j}, "K_theta = 1j"),
        ({"xi_G": -0.01}, "xi_G = -0.01"),
        ({"xi_G": 1.01}, "xi_G = 1.01"),
        ({"xi_G": NAN}, "xi_G = nan"),
        ({"omega_L": 0.0}, "omega_L = 0"),
        ({"omega_L": -1.0}, "omega_L = -1"),
        ({"omega_L": NAN}, "omega_L = nan"),
        ({"modes": 0}, "modes = 0"),
        ({"modes": -2}, "modes = -2"),
        ({"modes": 2.0}, "modes = 2.0"),
        ({"modes": True}, "modes = True"),
        ({"modes": "2"}, "modes = '2'"),
    ],
)
def test_beams(beam: Callable[..., Any], changes: dict[str, Any], message: str) -> None:
    refused(beam, message=message, **changes)


@pytest.mark.parametrize(
    ("beam", "changes", "message"),
    [
        (uniform, {"g": -0.04}, "g = -0.04"),
        (uniform, {"g": NAN}, "g = nan"),
        (uniform, {"g": INF}, "g = inf"),
        (stepped, {"xi_c": -0.1}, "xi_c = -0.1"),
        (stepped, {"xi_c": 1.1}, "xi_c = 1.1"),
        (stepped, {"xi_c": NAN}, "xi_c = nan"),
        (stepped, {"area_ratio": 0.0}, "area_ratio = 0"),
        (stepped, {"area_ratio": -0.6}, "area_ratio = -0.6"),
        (stepped, {"area_ratio": INF}, "area_ratio = inf"),
        (stepped, {"inertia_ratio": 0.0}, "inertia_ratio = 0"),
        (stepped, {"inertia_ratio": -1.0}, "inertia_ratio = -1"),
        (stepped, {"inertia_ratio": NAN}, "inertia_ratio = nan"),
    ],
)
def test_parameters_of_one_beam(
    beam: Callable[..., Any], changes: dict[str, Any], message: str
) -> None:
    refused(beam, message=message, **changes)


@pytest.mark.parametrize(
    ("beam", "forcing", "message"),
    [
        (uniform(), {"Omega": 0.0}, "Omega = 0"),
        (stepped(), {"Omega": -1.0}, "Omega = -1"),
        (uniform(), {"Omega": NAN}, "Omega = nan"),
        (uniform(), {"gamma": NAN}, "gamma = nan"),
        (stepped(), {"gamma": INF}, "gamma = inf"),
        (uniform(), {"eta": INF}, "eta = inf"),
        (stepped(), {"eta": NAN}, "eta = nan"),
        (uniform(omega_L=2.2), {"initial_terms": -1}, "initial_terms = -1"),
        (uniform(omega_L=2.2), {"initial_terms": 2.5}, "initial_terms = 2.5"),
        (uniform(), {"initial_terms": 3}, "initial_terms = 3: needs a finite omega_L"),
        (uniform(omega_L=2.2, g=0.1), {"initial_terms": 3}, "initial_terms = 3: must be 0 with g"),
        (uniform(omega_L=2.0), {"initial_terms": 3}, "omega_L/Omega = 1.81818182"),
        (stepped(omega_L=2.2), {"initial_terms": 1}, "initial_terms = 1: must be 0"),
        (uniform(omega_L=1.1), {}, "Omega = 1.1 is a longitudinal resonance (omega_L = 1.1)"),
        (uniform(omega_L=0.1), {"Omega": 0.3}, "Omega = 0.3 is a longitudinal resonance"),
        (stepped(omega_L=3.3, xi_c=0.5), {"Omega": 3.3}, "Omega = 3.3 is a longitudinal resonance"),
    ],
)
def test_forcing_of_a_beam(beam: Any, forcing: dict[str, Any], message: str) -> None:
    refused(beam.equation, message=message, **({"Omega": 1.1, "gamma": 0.1} | forcing))


@pytest.mark.parametrize("truncation", ["exact", "", "REPORT"])
def test_unknown_truncation(truncation: Any) -> None:
    refused(characteristic, equation(), truncation=truncation, message=f"'{truncation}'")


@pytest.mark.parametrize("truncation", [0, -3, 2.0, True, None])
def test_truncation_is_a_positive_whole_number(truncation: Any) -> None:
    message = f"truncation = {truncation}"
    refused(characteristic, equation(), truncation=truncation, message=message)


@pytest.mark.parametrize("method", ["rk4", "", "TAYLOR", None])
def test_unknown_method(method: Any) -> None:
    refused(monodromy, equation(), method=method, message=f"method = {method!r}")


@pytest.mark.parametrize("truncation", ["report", 5])
def test_finite_determinants_refuse_a_damping_matrix(truncation: Any) -> None:
    damped = equation(eta=0.1 * np.eye(2))
    message = f'truncation = {truncation!r}: must be "converged"'
    refused(characteristic, damped, truncation=truncation, message=message)


def test_without_H_omega_L_is_free() -> None:
    assert equation(omega_L=2.0).omega_L == 2.0


@pytest.mark.parametrize("whole", [1, 2, 3, 7])
@pytest.mark.parametrize("Omega", [1.1, 0.38, 1 / 3, math.pi])
def test_a_product_rounded_once_is_a_whole_multiple(whole: int, Omega: float) -> None:
    assert equation(Omega=Omega, H=[TWO], omega_L=whole * Omega).ratio == whole


@pytest.mark.parametrize("name", ["F", "G", "eta", "H"])
def test_inputs_are_copied(name: str) -> None:
    """What the caller does to an array afterwards changes nothing."""
    mine = TWO.copy()
    given = {name: [mine] if name == "H" else mine, "omega_L": 2.2}
    taken = equation(**given)
    mine[:] = 99.0
    kept = taken.H[0] if name == "H" else getattr(taken, name)
    np.testing.assert_array_equal(kept, TWO)


@pytest.mark.parametrize("name", ["F", "G", "eta", "H"])
def test_matrices_are_read_only(name: str) -> None:
    taken = equation(F=TWO, eta=TWO, H=[TWO], omega_L=2.2)
    matrix = taken.H[0] if name == "H" else getattr(taken, name)
    with pytest.raises(ValueError, match="read-only"):
        matrix[0, 0] = 1.0
    assert TWO.flags.writeable


def test_lists_and_integers_will_do() -> None:
    taken = HillEquation([[1, 2], [3, 4]], [[1, 0], [0, 1]], 1, 2, np.float32(0.5))
    assert taken.F.dtype == np.float64
    assert (taken.gamma, taken.Omega, taken.eta, taken.n) == (1.0, 2.0, 0.5, 2)


@pytest.mark.parametrize(
    "instance",
    [
        equation(),
        uniform(),
        stepped(),
        characteristic(equation()),
        monodromy(equation()),
    ],
    ids=lambda instance: type(instance).__name__,
)
def test_frozen(instance: Any) -> None:
    for field in dataclasses.fields(instance):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(instance, field.name, 1.0)


def test_no_attribute_is_added() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        equation().omega = 1.0  # type: ignore[attr-defined]
