"""dT with respect to every number of a general equation, against differences and closed forms."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from benchmarks.validation.literature import VINOGRAD, asymmetric_rotor, random_periodic
from floquet import general_sensitivities, monodromy, sensitivities
from floquet.sensitivity.general import Coefficients, GeneralDerivatives
from hill import Fourier, HillEquation, PeriodicEquation

# Of a number of the size 1, for differences to the sixth order.
STEP = 5e-4


def numbers(d: GeneralDerivatives) -> dict[str, Any]:
    """Every derivative by the name of what is varied."""
    found: dict[str, Any] = {"Omega": np.array(d.Omega)}
    if d.M is not None:
        found["M"] = d.M
    for name in ("C", "K", "A"):
        part = vars(d)[name]
        if isinstance(part, Coefficients):
            found[name] = part.mean
            found |= {f"{name}.cos.{k}": x for k, x in part.cos.items()}
            found |= {f"{name}.sin.{k}": x for k, x in part.sin.items()}
    return found


def varied(e: PeriodicEquation, name: str, at: tuple[int, ...], by: float) -> PeriodicEquation:
    """The equation with one number moved."""
    kind, *rest = name.split(".")
    given: dict[str, Any] = {"Omega": e.Omega}
    given |= {"A": e.A} if e.A is not None else {"M": e.M, "C": e.C, "K": e.K}
    if kind == "Omega":
        given["Omega"] = e.Omega + by
    elif kind == "M":
        given["M"] = e.M.copy()
        given["M"][at] += by
    else:
        x = given[kind]
        parts = {"mean": x.mean, "cos": dict(x.cos), "sin": dict(x.sin)}
        place: Any = parts["mean"] if not rest else parts[rest[0]][int(rest[1])]
        moved = place.copy()
        moved[at] += by
        if rest:
            parts[rest[0]][int(rest[1])] = moved
        else:
            parts["mean"] = moved
        given[kind] = Fourier(parts["mean"], cos=parts["cos"], sin=parts["sin"])
    if e.A is not None:
        return PeriodicEquation.first_order(**given)
    return PeriodicEquation(**given)


def difference(
    e: PeriodicEquation, name: str, at: tuple[int, ...], h: float
) -> tuple[float, float]:
    """Central differences by Richardson, with what the last extrapolation moved and rounding."""
    T = [[monodromy(varied(e, name, at, s * h / k)) for s in (1.0, -1.0)] for k in (1.0, 2.0, 4.0)]
    table = [(a.T - b.T) * (k / (2.0 * h)) for (a, b), k in zip(T, (1.0, 2.0, 4.0), strict=True)]
    second = [(4.0 * b - a) / 3.0 for a, b in pairwise(table)]
    third = (16.0 * second[1] - second[0]) / 15.0
    rounding = 4.0 * max(a.T_error + b.T_error for a, b in T) / h
    return third, abs(third - second[1]) + rounding


ROTOR = PeriodicEquation(
    M=[[2.0, 0.1], [0.0, 1.0]],
    C=Fourier([[0.1, 0.4], [-0.4, 0.1]], sin={1: [[0.05, 0.0], [0.0, 0.0]]}),
    K=Fourier(
        [[1.0, 0.2], [0.2, 4.0]],
        cos={1: [[0.3, 0.1], [0.0, 0.1]], 3: np.zeros((2, 2))},
        sin={2: [[0.0, 0.1], [0.1, 0.0]]},
    ),
    Omega=1.3,
)
# of third order, its leading multipliers a pair
TURNING = PeriodicEquation.first_order(
    A=Fourier(
        [[-0.1, 2.0, 0.1], [-1.5, 0.1, 0.0], [0.3, 0.2, -1.0]],
        cos={1: 0.2 * np.eye(3)},
        sin={2: [[0.0, 0.3, 0.1], [0.1, 0.0, 0.0], [0.0, 0.2, 0.1]]},
    ),
    Omega=1.1,
)


@pytest.mark.parametrize("given", [ROTOR, TURNING, VINOGRAD], ids=["rotor", "turning", "vinograd"])
def test_every_number(given: PeriodicEquation) -> None:
    found = general_sensitivities(given)
    slopes, errors = numbers(found.dT), numbers(found.dT_error)
    assert found.T == monodromy(given).T
    for name, slope in slopes.items():
        for at in np.ndindex(slope.shape):
            expected, unsure = difference(given, name, at, STEP)
            # Measured 1e-10: what differences are good for
            assert abs(slope[at] - expected) <= errors[name][at] + unsure, (name, at)
            assert unsure < 1e-6
            assert errors[name][at] < 1e-10


@pytest.mark.parametrize("seed", [0, 7, 13, 18, 25, 35])
def test_random_equations(seed: int) -> None:
    given = random_periodic(seed, 4, 1.5)
    found = general_sensitivities(given)
    slopes, errors = numbers(found.dT), numbers(found.dT_error)
    rng = np.random.default_rng(seed)
    for name, slope in slopes.items():
        at = tuple(int(rng.integers(0, k)) for k in slope.shape)
        size = {"Omega": given.Omega}.get(name)
        if size is None:
            matrix = given.M if name == "M" else vars(given)[name[0]].mean
            size = float(np.max(np.abs(matrix)))
        # so little that T moves by a ten-thousandth of Omega at most
        h = min(1e-3 * max(size, 1e-3), 1e-4 * given.Omega / max(abs(slope[at]), 1e-9))
        expected, unsure = difference(given, name, at, h)
        assert abs(slope[at] - expected) <= errors[name][at] + unsure, (name, at)


def test_as_the_special_equation() -> None:
    """F, Omega and eta as `sensitivities` has them; gamma G is one matrix here."""
    F, G = [[1.0, 0.1], [0.1, 4.0]], [[1.0, 0.3], [0.2, 1.0]]
    special = HillEquation(F, G, 0.3, 2.0, 0.05)
    one, two = sensitivities(special), general_sensitivities(special.general())
    assert monodromy(special).verdict == "unstable"
    pairs = [
        (one.dT.Omega, two.dT.Omega, one.dT_error.Omega + two.dT_error.Omega),
        (one.dT.F, two.dT.K.mean, one.dT_error.F + two.dT_error.K.mean),
        (one.dT.G, 0.3 * two.dT.K.cos[1], one.dT_error.G + 0.3 * two.dT_error.K.cos[1]),
        (one.dT.eta, np.trace(two.dT.C.mean), one.dT_error.eta + np.sum(two.dT_error.C.mean)),
    ]
    for a, b, allowed in pairs:
        assert np.all(np.abs(a - b) <= allowed)
        assert np.max(allowed) < 1e-10


def test_a_constant_equation_in_closed_form() -> None:
    """x'' + c x' + k x = 0, c > 2 sqrt(k): T = -c + sqrt(c^2 - 4 k), whatever Omega."""
    c, k = 3.0, 1.0
    found = general_sensitivities(PeriodicEquation(K=[[k]], C=[[c]], Omega=1.7))
    root = np.sqrt(c * c - 4.0 * k)
    # Measured 4e-15.
    assert abs(found.dT.K.mean[0, 0] + 2.0 / root) < 1e-13
    assert abs(found.dT.C.mean[0, 0] - (c / root - 1.0)) < 1e-13
    assert abs(found.dT.Omega) < 1e-13
    # m q'' + c q' + k q: the same of c/m and k/m
    assert abs(found.dT.M[0, 0] - (-(c / root - 1.0) * c + 2.0 / root * k)) < 1e-12


def test_what_ties_is_refused() -> None:
    with pytest.raises(ValueError, match="tie for the largest growth"):
        general_sensitivities(PeriodicEquation(K=np.diag([1.0, 2.3]), Omega=1.7))
    with pytest.raises(ValueError, match="tie for the largest growth"):
        general_sensitivities(PeriodicEquation.first_order(A=0.1 * np.eye(2), Omega=1.0))
    # a pair that grows alike is one
    general_sensitivities(asymmetric_rotor(0.1))
