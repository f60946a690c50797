"""Many general equations side by side: what each alone says, errors included."""

import re
from typing import Any

import numpy as np
import pytest
from periodic_balls import off, reference

from benchmarks.validation.literature import (
    BITTANTI_COLANERI,
    VINOGRAD,
    asymmetric_rotor,
    random_periodic,
)
from floquet import monodromy
from floquet.batch import polynomials
from hill import Fourier, HillEquation, PeriodicEquation


def of_size(order: int, first: bool, count: int) -> list[PeriodicEquation]:
    drawn = (random_periodic(seed, 8, 1.5) for seed in range(400))
    return [e for e in drawn if e.order == order and (e.A is not None) == first][:count]


@pytest.mark.parametrize(
    ("order", "first"), [(2, False), (4, False), (6, False), (1, True), (5, True)]
)
def test_together_as_each_alone(order: int, first: bool) -> None:
    equations = of_size(order, first, 12)
    assert len(equations) > 5
    found = polynomials(equations)
    assert found.coefficients.shape == (len(equations), order + 1)
    for p, error, one in zip(found.coefficients, found.errors, equations, strict=True):
        alone = monodromy(one)
        assert np.max(np.abs(p - alone.polynomial)) <= error + alone.error
        assert error < 1e-9 * np.sum(np.abs(p))


@pytest.mark.parametrize("seed", [0, 2, 6, 8, 13, 14, 22, 27, 31, 57])
def test_no_error_is_below_the_true_one(seed: int) -> None:
    equation = random_periodic(seed, 8, 1.5)
    p, _ = reference(equation)
    found = polynomials([equation])
    assert np.all(off(found.coefficients[0], p) <= found.errors[0])


def test_the_order_does_not_matter() -> None:
    equations = [asymmetric_rotor(c) for c in np.linspace(0.0, 0.3, 9)]
    one, other = polynomials(equations), polynomials(equations[::-1])
    apart = np.max(np.abs(one.coefficients - other.coefficients[::-1]), axis=1)
    assert np.all(apart <= one.errors + other.errors[::-1])
    assert np.max(apart) < 1e-12


def test_both_kinds_together_are_general() -> None:
    F, G = [[2.0, 0.3], [0.2, 1.0]], [[1.0, 2.0], [3.0, 1.0]]
    special = HillEquation(F, G, 0.3, 2.0)
    found = polynomials([special, asymmetric_rotor()])
    assert found.coefficients.shape == (2, 5)
    alone = monodromy(special.general())
    assert np.max(np.abs(found.coefficients[0] - alone.polynomial)) <= found.errors[0] + alone.error


def test_strong_decay_is_within_its_error() -> None:
    found = polynomials([BITTANTI_COLANERI])
    # mu = 1 and exp(-48 pi)
    assert np.max(np.abs(found.coefficients[0] - [1.0, -1.0, 0.0])) <= found.errors[0] < 1e-9


@pytest.mark.parametrize(
    ("equations", "more", "message"),
    [
        ([VINOGRAD, asymmetric_rotor()], {}, "equations: must all have the same number"),
        ([VINOGRAD, BITTANTI_COLANERI], {}, "equations: must all have the same number"),
        ([VINOGRAD], {"kernel": "compiled"}, "kernel = 'compiled': must be auto or numpy"),
    ],
)
def test_refusals(equations: Any, more: Any, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        polynomials(equations, **more)


def test_growth_beyond_a_float_is_refused() -> None:
    grows = PeriodicEquation.first_order(A=Fourier([[200.0]]), Omega=1.0)
    with pytest.raises(OverflowError, match="grows beyond what a float can hold"):
        polynomials([grows])
