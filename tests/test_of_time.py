"""x' = A(t) x for any A of time: switching coefficients, CasADi functions, refusals."""

import re
from typing import Any

import casadi as ca
import numpy as np
import pytest
from scipy.linalg import expm

from benchmarks.validation.literature import EXPONENTS, VINOGRAD, random_periodic
from floquet import EstimatedMonodromy, monodromy
from hill import Fourier, PeriodicEquation


def meissner(t: Any) -> Any:
    """x'' + (1 - 0.2 psi) x = 0, psi = 1 on a third of the period pi and -1 on the rest."""
    within = t - np.pi * ca.floor(t / np.pi)
    return [[0, 1], [-1 + 0.2 * ca.if_else(within < np.pi / 3, 1, -1), 0]]


def of_time(given: PeriodicEquation) -> Any:
    def at(x: Fourier, t: Any) -> Any:
        total = ca.SX(ca.DM(x.mean))
        for wave, parts in ((ca.cos, x.cos), (ca.sin, x.sin)):
            for k, part in parts.items():
                total += wave(k * given.Omega * t) * ca.DM(part)
        return total

    def A(t: Any) -> Any:
        if given.A is not None:
            return at(given.A, t)
        inverse = ca.DM(np.linalg.inv(given.M))
        K, C = inverse @ at(given.K, t), inverse @ at(given.C, t)
        n = given.K.n
        top = ca.horzcat(ca.SX(n, n), ca.SX(ca.DM.eye(n)))
        return ca.vertcat(top, ca.horzcat(-K, -C))

    return A


def test_meissner_to_fifteen_digits() -> None:
    """Richards 1983, Figure 3.1, as printed in PeriodicMatrices.jl."""
    found = monodromy(meissner, period=np.pi, breaks=[np.pi / 3])
    assert isinstance(found, EstimatedMonodromy)
    expected = 0.041379744661220644
    # Measured 5e-17.
    assert abs(found.exponents[0] - (expected + 1j)) < 1e-15
    assert abs(found.T - 2.0 * expected) < 1e-15
    halves = [expm([[0.0, 1.0], [-a, 0.0]] @ np.eye(2) * t)
              for a, t in ((0.8, np.pi / 3), (1.2, 2 * np.pi / 3))]  # fmt: skip
    assert np.max(np.abs(found.matrix - halves[1] @ halves[0])) < 2e-15
    assert 0.0 < found.error_estimate < 1e-10


@pytest.mark.parametrize("name", EXPONENTS)
def test_exponents_from_the_literature(name: str) -> None:
    given, expected = EXPONENTS[name]
    found = monodromy(of_time(given), period=given.period)
    apart = found.exponents[:, None] - np.array(expected)
    turns = np.round(apart.imag / given.Omega)
    apart = np.abs(apart - 1j * given.Omega * turns)
    # Measured 2e-14; -24 of Bittanti and Colaneri is lost by one period
    assert np.max(apart.min(axis=0)) < 1e-12
    assert np.all(apart.min(axis=1) <= found.exponent_error_estimates)


@pytest.mark.parametrize("seed", range(8))
def test_as_the_equation_with_bounds(seed: int) -> None:
    given = random_periodic(seed, 4, 2.0)
    found, exact = monodromy(of_time(given), period=given.period), monodromy(given)
    apart = np.max(np.abs(found.polynomial - exact.polynomial))
    assert apart < 1e-11 * np.sum(np.abs(exact.polynomial))
    # an estimate, but not of another size: SUNDIALS is the worst of three
    assert apart <= found.error_estimate + exact.error
    assert abs(found.T - exact.T) <= found.T_error_estimate + exact.T_error
    assert found.T_error_estimate < 1e-8


def test_an_estimate_shows_nothing() -> None:
    for A in (lambda t: -1.0 + ca.cos(t), lambda t: 1.0 + ca.cos(t)):
        found = monodromy(A, period=2.0 * np.pi)
        assert (found.verdict, found.stable) == ("undecided", False)
    assert abs(found.T - 2.0) < 1e-13


def test_a_casadi_function_will_do() -> None:
    t = ca.MX.sym("t")
    A = ca.Function("A", [t], [ca.vertcat(ca.horzcat(0, 1), ca.horzcat(-2 - ca.cos(3 * t), -0.1))])
    found = monodromy(A, period=2.0 * np.pi / 3.0)
    same = PeriodicEquation(K=Fourier([[2.0]], cos={1: [[1.0]]}), C=[[0.1]], Omega=3.0)
    assert np.max(np.abs(found.matrix - monodromy(same).matrix)) < 1e-13


@pytest.mark.parametrize(
    ("A", "more", "message"),
    [
        (meissner, {"period": np.pi}, "A: is not smooth near t = 1.0472; list where it jumps"),
        (meissner, {"period": 3.0, "breaks": [1.0]}, "period = 3: A differs by 0.4 at t ="),
        (lambda t: [[1.0, 2.0]], {"period": 1.0}, "A has shape (1, 2): must be square"),
        (lambda t: [[1.0, 2.0], [3.0]], {"period": 1.0}, "A: must return an (m, m) CasADi"),
        (lambda t: "A", {"period": 1.0}, "A: must return an (m, m) CasADi"),
        (lambda t: ca.log(t - 0.5), {"period": 1.0}, "A: is not finite at t ="),
        (lambda t: 0.0 * t + np.nan, {"period": 1.0}, "A: is not finite at t ="),
        (np.eye(2), {"period": 1.0}, "A: must be an equation, a casadi.Function or a function"),
        (meissner, {}, "period: has no value; A(t) needs one"),
        (meissner, {"period": -1.0}, "period = -1: must be greater than 0"),
        (
            meissner,
            {"period": np.pi, "breaks": [4.0]},
            "breaks: 4 must be between 0 and",
        ),
        (meissner, {"period": np.pi, "breaks": [np.nan]}, "breaks = nan: must be finite"),
        (VINOGRAD, {"period": 1.0}, "period, breaks: an equation has its own"),
    ],
)
def test_refusals(A: Any, more: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        monodromy(A, **more)


def test_growth_beyond_a_float_is_refused() -> None:
    with pytest.raises(OverflowError, match="grows beyond what a float can hold"):
        monodromy(lambda t: 200.0 + ca.cos(t), period=2.0 * np.pi)
