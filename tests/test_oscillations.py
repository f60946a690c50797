"""Oscillations one by one and two at a time, against closed forms and the whole determinant."""

from math import log, pi, sqrt
from typing import Any

import numpy as np
import pytest

from hill import Fourier, HillEquation, PeriodicEquation, Refused, UniformBeam, characteristic
from hill.averaging import Resonance, first_order
from hill.oscillations.pair import Pair, pair
from hill.oscillations.steady import steady

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=2)

# Mathieu's equation x'' + (1 - 2 q cos 2 t) x = 0: its multiplier over pi
MULTIPLIER = {0.1: -0.85479289278902375, 1.0: -4.1560549385828014}


def at_resonance(equation: Any, resonance: Resonance) -> Pair:
    return pair(equation, resonance, steady(equation))


# ---- without pulsation ---------------------------------------------------------------------------


def test_a_damped_oscillator_and_an_overdamped_one() -> None:
    e = PeriodicEquation(K=[[4.0, 0.0], [0.0, 9.0]], C=[[0.4, 0.0], [0.0, 10.0]], Omega=1.0)
    found = steady(e)
    np.testing.assert_allclose(found.frequencies, [sqrt(4.0 - 0.04)], rtol=1e-14)
    assert found.growth == pytest.approx(-0.2, abs=1e-14)
    np.testing.assert_allclose(np.sort(found.exponents.real), [-9.0, -1.0, -0.2, -0.2], rtol=1e-13)


def test_vectors_of_both_sides() -> None:
    A = np.array([[0.0, 1.0, 0.2], [-4.0, -0.1, 0.3], [0.5, 0.0, -1.0]])
    found = steady(PeriodicEquation.first_order(A=A, Omega=1.0))
    np.testing.assert_allclose(A @ found.right, found.right * found.exponents, atol=1e-13)
    np.testing.assert_allclose(A.T @ found.left, found.left * found.exponents, atol=1e-13)


def test_a_mass_matrix_divides() -> None:
    e = PeriodicEquation(M=[[2.0, 0.0], [0.0, 0.5]], K=[[8.0, 0.0], [0.0, 4.5]], Omega=1.0)
    np.testing.assert_allclose(steady(e).frequencies, [2.0, 3.0], rtol=1e-14)


def test_a_steady_flutter_grows() -> None:
    e = HillEquation([[1.0, 0.5], [-0.5, 1.0]], np.zeros((2, 2)), 0.0, 1.0)
    # omega^2 = 1 +- i/2
    assert steady(e).growth == pytest.approx(np.sqrt(1.0 + 0.5j).imag, rel=1e-13)


# ---- two at a time -------------------------------------------------------------------------------


@pytest.mark.parametrize("q", MULTIPLIER)
def test_mathieu(q: float) -> None:
    found = at_resonance(HillEquation([[1.0]], [[1.0]], -2.0 * q, 2.0), Resonance(0, 0))
    assert abs(found.T - 2.0 * abs(log(-MULTIPLIER[q])) / pi) < 1e-11
    assert found.error < 1e-10


def hidden_mathieu(q: float, c0: float, c1: float) -> PeriodicEquation:
    """Mathieu's equation for exp(integral of c) x, c = c0 + c1 cos 2 t: damping that pulsates."""
    mean = [[1.0 + c0**2 + 0.5 * c1**2]]
    cos = {1: [[2.0 * c0 * c1 - 2.0 * q]], 2: [[0.5 * c1**2]]}
    return PeriodicEquation(
        K=Fourier(mean, cos=cos, sin={1: [[-2.0 * c1]]}),
        C=Fourier([[2.0 * c0]], cos={1: [[2.0 * c1]]}),
        Omega=2.0,
    )


def first_order_form(e: PeriodicEquation) -> PeriodicEquation:
    assert e.K is not None
    assert e.C is not None

    def block(K: Any, C: Any, one: float) -> Any:
        return [[0.0, one], [-float(K[0, 0]), -float(C[0, 0])]]

    none = np.zeros((1, 1))
    cos = {k: block(e.K.cos.get(k, none), e.C.cos.get(k, none), 0.0) for k in {*e.K.cos, *e.C.cos}}
    sin = {k: block(K, none, 0.0) for k, K in e.K.sin.items()}
    return PeriodicEquation.first_order(
        A=Fourier(block(e.K.mean, e.C.mean, 1.0), cos=cos, sin=sin), Omega=e.Omega
    )


@pytest.mark.parametrize("form", [lambda e: e, first_order_form], ids=["second", "first"])
def test_damping_that_pulsates(form: Any) -> None:
    e = form(hidden_mathieu(0.1, 0.03, 0.2))
    found = at_resonance(e, Resonance(0, 0))
    assert abs(found.T + 0.06 - 2.0 * abs(log(-MULTIPLIER[0.1])) / pi) < 1e-11


WITHIN_ANOTHER = Resonance(1, 0, -1, 2)
RESONANCES = [
    *first_order(3),
    *(Resonance(r.i, r.j, r.sign, 2) for r in first_order(3)),
    Resonance(1, 1, 1, 3),
]
RESONANCES.remove(WITHIN_ANOTHER)


@pytest.mark.parametrize("eta", [0.0, 0.01])
@pytest.mark.parametrize("resonance", RESONANCES, ids=lambda r: r.name)
def test_the_whole_determinant_says_the_same(resonance: Resonance, eta: float) -> None:
    alone = steady(BEAM.equation(1.0, 0.0, eta))
    e = BEAM.equation(resonance.Omega(alone.frequencies), 0.1, eta)
    found = pair(e, resonance, alone)
    whole = characteristic(e)
    assert abs(found.T - whole.T) <= 2.0 * found.error + whole.T_error + 1e-12


def test_through_an_edge_both_halves_are_smooth() -> None:
    """T goes like a root where the tongue begins; mean and square are a parabola there."""
    resonance = Resonance(1, 0)
    alone = steady(BEAM.equation(1.0, 0.0))
    centre = resonance.Omega(alone.frequencies)
    off = np.linspace(-0.06, 0.06, 9)
    pairs = [pair(BEAM.equation(centre + x, 0.1), resonance, alone) for x in off]
    square = np.array([p.square.real for p in pairs])
    assert square.min() < 0.0 < square.max()
    fit = np.polynomial.Polynomial.fit(off, square, 4)
    np.testing.assert_allclose(fit(off), square, atol=1e-3 * np.ptp(square))
    assert max(abs(p.square.imag) for p in pairs) < 1e-12
    assert max(abs(p.mean.real) for p in pairs) < 1e-12


def test_far_from_resonance_they_are_the_two_oscillations() -> None:
    alone = steady(BEAM.equation(1.0, 0.0))
    e = BEAM.equation(2.0, 1e-9)
    found = pair(e, Resonance(1, 0), alone).exponents
    own = sorted([1j * alone.frequencies[1], 2j - 1j * alone.frequencies[0]], key=lambda x: x.imag)
    np.testing.assert_allclose(sorted(found, key=lambda x: x.imag), own, atol=1e-8)


def test_within_another_instability_three_take_part() -> None:
    """At (omega_1 - omega_B)/2 = .359, beside 2 omega_B = .383, omega_B is coupled to itself."""
    alone = steady(BEAM.equation(1.0, 0.0))
    Omega = WITHIN_ANOTHER.Omega(alone.frequencies)
    with pytest.raises(Refused, match="third oscillation cannot be told"):
        pair(BEAM.equation(Omega, 0.1), WITHIN_ANOTHER, alone)
    # with little pulsation they are apart
    assert pair(BEAM.equation(Omega, 0.001), WITHIN_ANOTHER, alone).T < 1e-5


def test_a_frequency_far_too_low_is_refused() -> None:
    e = HillEquation([[1.0]], [[1.0]], 0.9, 0.03)
    with pytest.raises(Refused, match=r"at Omega = 0\.03"):
        pair(e, Resonance(0, 0, 1, 1), steady(e))


def test_another_oscillation_passes_between_the_two() -> None:
    """Coupled to nothing, with an exponent between theirs, beside the shift: it is left alone."""
    resonance = Resonance(1, 0)
    F, G = np.diag([1.0, 4.0]), np.array([[0.0, 1.0], [1.0, 0.0]])
    alone = steady(HillEquation(F, G, 0.0, 1.0))
    expected = pair(HillEquation(F, G, 0.2, 3.05), resonance, alone)
    # the two are at 2 i and 2.05 i; a third at 2.03 i in harmonic 1
    more = np.diag([1.0, 4.0, (3.05 - 2.03) ** 2])
    coupled = np.zeros((3, 3))
    coupled[:2, :2] = G
    alone = steady(HillEquation(more, coupled, 0.0, 1.0))
    found = pair(HillEquation(more, coupled, 0.2, 3.05), Resonance(2, 0), alone)
    assert abs(found.mean - expected.mean) < 1e-12
    assert abs(found.square - expected.square) < 1e-13
