"""Many equations at once give what one at a time gives."""

import numpy as np
import pytest
from systems import random_system

from floquet import monodromy
from floquet.batch import polynomials
from floquet.steps import longest_step
from hill import HillEquation, UniformBeam
from hill.roots import growth, most_isolated_root
from hill.stability import modulus

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5).equation(1.0, 0.1)


@pytest.mark.parametrize("seeds", [range(30), range(30, 60)], ids=str)
def test_random_systems_within_both_bounds(seeds: range) -> None:
    for seed in seeds:
        equation = random_system(seed)
        many, one = polynomials([equation]), monodromy(equation)
        apart = np.abs(many.coefficients[0] - one.polynomial).max()
        assert apart <= many.errors[0] + one.error
        # measured: 0.38 of the batch's own bound at most over 200 systems
        assert apart <= many.errors[0]


def test_order_is_kept_and_neighbours_do_not_matter() -> None:
    rng = np.random.default_rng(5)
    equations = [
        HillEquation(F=BEAM.F, G=BEAM.G, gamma=g, Omega=o, eta=e)
        for o, g, e in zip(
            rng.uniform(0.36, 6, 40),
            rng.uniform(-0.5, 0.5, 40),
            rng.uniform(0, 0.1, 40),
            strict=True,
        )
    ]
    together = polynomials(equations)
    for k in (0, 7, 39):
        alone = polynomials([equations[k]])
        apart = np.abs(together.coefficients[k] - alone.coefficients[0]).max()
        assert apart <= together.errors[k] + alone.errors[0]
        m = monodromy(equations[k])
        assert np.abs(together.coefficients[k] - m.polynomial).max() <= together.errors[k] + m.error


def test_refusals() -> None:
    other = HillEquation(F=[[1.0]], G=[[1.0]], gamma=0.1, Omega=1.0)
    with pytest.raises(ValueError, match="same number of coordinates"):
        polynomials([BEAM, other])
    with pytest.raises(ValueError, match="eta is a matrix"):
        polynomials([HillEquation(F=[[1.0]], G=[[1.0]], gamma=0.1, Omega=1.0, eta=[[0.1]])])


def test_step_is_below_the_one_that_fails() -> None:
    """cos(p t) swells off the real axis: the step must know, or 1e-13 is lost."""
    one, none = np.array([[1.0]]), np.zeros((1, 1))
    plain = longest_step([(one, 0.0)], none, 24, 1e-17)
    forced = longest_step([(one, 0.0), (3.0 * one, 4.0)], none, 24, 1e-17)
    # without forcing the exact bound is (25!/1e17)^(1/25) = 2.3; Cauchy's is a little shorter
    assert 1.6 < plain < 2.3
    assert forced < 0.4 * plain


@pytest.mark.parametrize("n", [1, 2, 3, 5])
def test_growth_of_known_roots(n: int) -> None:
    rng = np.random.default_rng(n)
    z = rng.uniform(-1.3, 1.3, (400, n)).astype(complex)
    if n > 1:
        pairs = rng.random(400) < 0.5
        z[pairs, 0] = z[pairs, 0].real + 1j * 10 ** rng.uniform(-3, 0, pairs.sum())
        z[pairs, 1] = z[pairs, 0].conj()
    P = np.array([np.real(np.poly(roots)) for roots in z]).T
    true = np.log(modulus(z.ravel())).reshape(z.shape).max(axis=1)
    # a root's rounding is eps over its distance from the next, its square root near a double one
    # or near +-1: 1e-7 at worst, a hundredth of that for 99 of 100
    apart = np.abs(growth(P) - true)
    assert apart.max() < 1e-6
    assert np.quantile(apart, 0.95) < 1e-9


def test_isolated_root_is_a_root() -> None:
    a, b, c = np.random.default_rng(1).uniform(-2, 2, (3, 1000))
    z = most_isolated_root(a, b, c)
    assert np.abs(((z + a) * z + b) * z + c).max() < 1e-13
