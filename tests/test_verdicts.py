"""Stable is shown, unstable is shown, and everything else is undecided."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from flint import fmpq, fmpq_poly
from systems import SPECIAL

from floquet import monodromy
from floquet.eigenvalues import discs_from_matrix, discs_from_polynomial
from floquet.growth import LogDiscs, growth_from_multipliers, growth_from_z, ln_mu
from hill import HillEquation, characteristic
from hill.stability import log_R, root_radii, roots, stabilities, stability_of

ROUTES: dict[str, Callable[[HillEquation], Any]] = {"hill": characteristic, "floquet": monodromy}
both = pytest.mark.parametrize("route", ROUTES)


def by_floquet(p: Any, error: Any, Omega: float, eta: float) -> Any:
    """The witness's judgement of a polynomial alone."""
    p = np.asarray(p, float)
    errors = np.broadcast_to(error, p.shape)
    z = roots(p[None])[0]
    return growth_from_z(
        (discs_from_polynomial(z, p, errors),), p, errors, 2.0 * np.pi / Omega, eta
    )


JUDGES: dict[str, Callable[..., Any]] = {"hill": stability_of, "floquet": by_floquet}
judges = pytest.mark.parametrize("judge_of", JUDGES.values(), ids=JUDGES)


@judges
@pytest.mark.parametrize(
    ("z", "eta", "expected"),
    [
        ([0.3, -0.2, 0.8], 0.0, "stable"),
        ([0.3, -0.2, 1.2], 0.0, "unstable"),
        ([0.3, -0.2, -1.2], 0.0, "unstable"),
        ([0.3 + 0.1j, 0.3 - 0.1j, 0.8], 0.0, "unstable"),
        ([0.3 + 0.1j, 0.3 - 0.1j, 0.8], 0.5, "stable"),  # ln R is .105, eta pi is 1.57
        ([0.3, 0.3, 0.8], 0.0, "undecided"),
        ([0.3, 0.3, 0.8], 0.5, "stable"),
        ([1.0, 0.5], 0.0, "undecided"),
        ([-1.0, 0.5], 0.0, "undecided"),
        ([1.0, 0.5], 0.01, "stable"),
        ([0.3, -0.2, 0.8], -0.01, "unstable"),
        ([0.3, 0.3, 1.8], 0.0, "unstable"),
    ],
)
def test_what_a_polynomial_shows(judge_of: Any, z: Any, eta: float, expected: str) -> None:
    found = judge_of(np.real(np.poly(z)), 1e-14, 1.0, eta)
    assert found.verdict == expected
    assert np.isfinite(found.T_error)


@judges
def test_a_larger_error_shows_less_and_never_the_opposite(judge_of: Any) -> None:
    p = np.real(np.poly([0.3, -0.2, 0.99]))
    verdicts = [judge_of(p, 10.0**k, 1.0, 0.0).verdict for k in range(-15, 3)]
    assert verdicts[0] == "stable"
    assert verdicts[-1] == "undecided"
    assert verdicts == sorted(verdicts)  # "stable" < "undecided"


@judges
def test_a_sign_alone_shows_an_instability(judge_of: Any) -> None:
    """Two roots close together, one of them beyond 1: where they are is not known, that is."""
    p = np.real(np.poly([1.0 + 1e-6, 1.0 - 1e-6]))
    found = judge_of(p, 1e-13, 1.0, 0.0)
    assert found.verdict == "unstable"
    # P(1) = -1e-12
    assert judge_of(p, 1e-12, 1.0, 0.0).verdict == "undecided"


@judges
def test_T_and_its_error_hold_for_all_that_the_error_allows(judge_of: Any) -> None:
    """The exact roots of polynomials moved by their whole error, on 400 seeded ones."""
    rng = np.random.default_rng(1)
    for _ in range(400):
        n, error = int(rng.integers(1, 6)), 10.0 ** rng.uniform(-14, -1)
        z = rng.uniform(-1.5, 1.5, n).astype(complex)
        if n > 1 and rng.uniform() < 0.5:
            z[:2] = z[0].real + 10.0 ** rng.uniform(-8, 0) * np.array([1j, -1j])
        if n > 2 and rng.uniform() < 0.3:
            z[2] = z[0].real
        eta, p = float(rng.choice([0.0, 0.1])), np.real(np.poly(z))
        moved = p + np.append(0.0, error * rng.choice([-1.0, 1.0], n))
        found = judge_of(p, error, 1.3, eta)
        T = exact_T(moved, 1.3) - eta
        assert abs(found.T - T) <= found.T_error
        if found.verdict == "unstable":
            assert T > 0.0
        if found.verdict == "stable":
            assert T < 1e-15


def exact_T(p: Any, Omega: float) -> float:
    """(Omega/pi) ln R of the floats p, from isolated roots of an exact polynomial."""
    exact = [fmpq(*float(c).as_integer_ratio()) for c in p]
    found = fmpq_poly(exact[::-1]).numer().complex_roots()
    z = np.array([complex(root) for root, _ in found])
    inside = (z.imag == 0.0) & (np.abs(z.real) <= 1.0)
    return float(Omega / np.pi * np.where(inside, 0.0, np.abs(np.arccosh(z).real)).max())


@pytest.mark.parametrize("of", [log_R, ln_mu])
def test_growth_of_a_z(of: Any) -> None:
    """|ln mu| of mu = R exp(i phi) comes back from z = (mu + 1/mu)/2."""
    rng = np.random.default_rng(2)
    ln_R, phi = 10.0 ** rng.uniform(-6, 2.5, 500), rng.uniform(0.0, 2.0 * np.pi, 500)
    z = np.cosh(ln_R + 1j * phi)
    # z itself is rounded: near [-1, 1] that moves ln R by an ulp over its distance from the edge
    unsure = 1e-15 * (1.0 + np.abs(z)) / np.abs(np.sinh(ln_R + 1j * phi)) + 4e-16 * ln_R
    assert np.all(np.abs(of(np.abs(z.real), np.abs(z.imag)) - ln_R) <= 2.0 * unsure)
    assert of(np.array([0.5, 1.0, 0.0]), np.zeros(3)).tolist() == [0.0, 0.0, 0.0]


def test_discs_from_a_matrix_hold_its_eigenvalues() -> None:
    """Every matrix within the error has one eigenvalue in each disc that stands alone."""
    rng = np.random.default_rng(3)
    for _ in range(300):
        n = int(rng.integers(1, 6))
        A = rng.standard_normal((n, n)) * 10.0 ** rng.uniform(-2, 2, (n, 1))
        error = np.abs(A) * 10.0 ** rng.uniform(-14, -2)
        discs = discs_from_matrix(A, error)
        moved = np.linalg.eigvals(A + error * rng.choice([-1.0, 1.0], (n, n)))
        # numpy's own eigenvalues, to a hundred ulps of the norm times the condition
        slack = 1e-13 * np.linalg.norm(A) * np.linalg.cond(np.linalg.eig(A)[1])
        apart = np.abs(moved - discs.centre[:, None])
        alone = np.sum(discs.together, axis=1) == 1
        assert np.all((apart <= discs.radius[:, None] + slack).any(axis=0))
        assert np.all(np.sum(apart <= discs.radius[:, None] + slack, axis=1)[alone] >= 1)


def test_discs_from_a_polynomial_hold_its_roots() -> None:
    """Clusters too: the radius of a double root is the square root of the error, not more."""
    p = np.real(np.poly([0.3, 0.3, -0.9]))
    errors = np.array([0.0, 1e-12, 1e-12, 1e-12])
    z = roots(p[None])
    radius = root_radii(p[None], errors[None], z)[0]
    assert np.sort(radius)[0] < 1e-11
    assert 1e-6 < radius.max() < 1e-5
    assert discs_from_polynomial(z[0], p, errors).radius.max() < 1e-5


def test_what_a_root_is_off_is_in_its_radius() -> None:
    """The roots handed over are 1e-6 off; nothing but the polynomial says so."""
    exact = np.array([0.9, 0.3, -0.4])
    p = np.poly(exact)[None]
    nothing = np.zeros_like(p)
    off = np.add(exact, [1e-6, -1e-6, 1e-6])[None].astype(complex)
    assert np.all(root_radii(p, nothing, off)[0] >= 1e-6)
    assert np.all(discs_from_polynomial(off[0], p[0], nothing[0]).radius >= 1e-6)


@judges
def test_two_real_roots_may_be_a_pair(judge_of: Any) -> None:
    """Computed real and apart, but an error of P away from z = .3 +- 1e-4 i."""
    z = np.array([0.3 + 1e-6, 0.3 - 1e-6])
    found = judge_of(np.poly(z), 1e-8, 1.0, 0.0)
    assert found.verdict == "undecided"
    pair = judge_of(np.real(np.poly([0.3 + 1e-4j, 0.3 - 1e-4j])), 0.0, 1.0, 0.0).T
    assert pair > 3e-5
    assert found.T + found.T_error >= pair


@both
@pytest.mark.parametrize("name", SPECIAL)
def test_a_number_is_a_number(name: str, route: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = ROUTES[route](SPECIAL[name])
    numbers = [found.T, found.T_error, found.error, *found.polynomial, *found.z]
    assert np.all(np.isfinite(numbers))
    assert found.verdict in ("stable", "unstable", "undecided")
    assert found.stable == (found.verdict == "stable")


@both
def test_a_beam_at_rest_is_not_unstable(route: str) -> None:
    """G = 0 and equal frequencies: bounded in theory, by nothing that P shows."""
    found = ROUTES[route](HillEquation(np.eye(2) / 16, np.zeros((2, 2)), 0.0, 2.0))
    assert found.verdict == "undecided"
    assert abs(found.T) <= found.T_error < 1e-6


@both
@pytest.mark.parametrize(
    "F", [np.diag([-3000.0, -2500.0, -2000.0]), -1e4 * np.eye(2)], ids=["three", "two"]
)
def test_growth_beyond_a_float_is_an_overflow(route: str, F: Any) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(OverflowError, match="float"):
            ROUTES[route](HillEquation(F, np.eye(len(F)), 0.3, 1.0))


def test_many_modes_are_known_by_the_matrix() -> None:
    """28 coordinates: P's coefficients know T to .08 at best, A's eigenvalues to an ulp or so."""
    w = np.linspace(1.0, 3.0, 28)
    found = monodromy(HillEquation(np.diag(w**2), np.diag(0.3 * w**2), 0.3, 2.0))
    assert found.verdict == "unstable"
    assert found.T_error < 1e-11
    # the equations are uncoupled: the largest T is the first coordinate's, alone
    alone = monodromy(HillEquation([[1.0]], [[0.3]], 0.3, 2.0))
    assert abs(found.T - alone.T) <= found.T_error + alone.T_error


def test_multipliers_of_a_damping_matrix_are_judged() -> None:
    calm = HillEquation(np.diag([1.0, 4.0]), np.eye(2), 0.1, 2.7, eta=np.diag([0.1, 0.2]))
    assert monodromy(calm).verdict == "stable"
    excited = HillEquation(np.diag([1.0, 4.0]), np.eye(2), 0.1, 2.7, eta=np.diag([-0.1, 0.2]))
    assert monodromy(excited).verdict == "unstable"
    free = HillEquation(np.diag([1.0, 4.0]), np.eye(2), 0.1, 2.7, eta=np.zeros((2, 2)))
    assert monodromy(free).verdict == "stable"  # on the circle, in pairs
    trace = np.diag([2.0**-60, -(2.0**-60)])
    nearly = HillEquation(np.diag([1.0, 4.0]), np.eye(2), 0.1, 2.7, eta=trace)
    assert monodromy(nearly).verdict == "undecided"
    nothing = discs_from_polynomial(np.ones(1, complex), np.array([1.0, -1.0]), np.zeros(2))
    assert growth_from_multipliers((LogDiscs.of(nothing),), 1.0, 0.0).verdict == "undecided"


def test_many_polynomials_are_judged_as_each_alone() -> None:
    rng = np.random.default_rng(5)
    p = np.array([np.real(np.poly(rng.uniform(-1.1, 1.1, 3))) for _ in range(2500)])
    errors = np.full(p.shape, 1e-6)
    Omega, eta = rng.uniform(0.5, 2.0, 2500), rng.choice([0.0, 0.05], 2500)
    found = stabilities(p, errors, Omega, eta)
    for k in range(0, 2500, 100):
        one = stability_of(p[k], 1e-6, Omega[k], eta[k])
        assert (one.T, one.T_error, one.verdict) == (
            found.T[k],
            found.T_error[k],
            found.verdict[k],
        )
