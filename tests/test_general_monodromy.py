"""Any linear periodic equation in the time domain: closed forms, other solvers, ball arithmetic."""

import re
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from flint import acb, acb_mat, arb, ctx
from periodic_balls import off, reference
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from benchmarks.validation.literature import (
    BITTANTI_COLANERI,
    EXPONENTS,
    VINOGRAD,
    asymmetric_rotor,
    random_periodic,
)
from compare.report.row import equation
from compare.report.tables import all_rows
from floquet import monodromy
from floquet.general.modes import periodic_discs
from floquet.growth import logarithms
from floquet.integrate.division import divided
from floquet.products import chain, grouped
from hill import Fourier, HillEquation, PeriodicEquation

METHODS = ("taylor", "cvodes")
both_methods = pytest.mark.parametrize("method", METHODS)
EPS = float(np.finfo(float).eps)


def wrapped(difference: Any, Omega: float) -> Any:
    """Moduli of differences of exponents, which are known up to whole multiples of i Omega."""
    return abs(difference.real + 1j * (difference.imag - Omega * np.round(difference.imag / Omega)))


def nearest(found: Any, expected: Any, Omega: float) -> float:
    apart = wrapped(np.asarray(found)[:, None] - np.asarray(expected)[None, :], Omega)
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max()))


# ---- closed forms --------------------------------------------------------------------------------


@both_methods
@pytest.mark.parametrize("name", EXPONENTS)
def test_exponents_from_the_literature(name: str, method: str) -> None:
    given, expected = EXPONENTS[name]
    found = monodromy(given, method=method)
    apart = wrapped(found.exponents[:, None] - np.array(expected)[None, :], given.Omega)
    # Measured 7e-13 by taylor, of vinograd's -13; by cvodes 4e-12, of -24.
    assert apart.min(axis=0).max() < (1e-12 if method == "taylor" else 1e-11)
    assert np.all(apart.min(axis=1) <= found.exponent_errors)
    # Measured 2e-10, of vinograd's: one part in 6e10.
    assert np.max(found.exponent_errors) < 1e-9
    T = 2.0 * max(e.real for e in expected)
    assert abs(found.T - T) <= found.T_error
    assert found.verdict in ("undecided", "stable" if T < 0.0 else "unstable")


@both_methods
def test_what_one_period_loses_is_known_all_the_same(method: str) -> None:
    """exp(-48 pi) is 1e-66 of the other: the bound says 1e-10 relative and better."""
    found = monodromy(BITTANTI_COLANERI, method=method)
    assert found.exponent_errors[1] < 24.0 * 1e-10
    assert abs(found.exponents[1] + 24.0) <= found.exponent_errors[1]
    # of the product itself nothing is left: rounding of 1e-16 beside it, or nothing at all
    if method == "taylor":
        assert abs(np.linalg.eigvals(found.matrix)).min() > 1e-30


@pytest.mark.parametrize("damping", [200.0, 1e3])
def test_multipliers_below_a_float(damping: float) -> None:
    """x'' + c x' + x = 0: exp(-2 pi c) is no float; T = 2 (sqrt(c^2/4 - 1) - c/2) is known."""
    found = monodromy(PeriodicEquation(K=[[1.0]], C=[[damping]], Omega=1.0))
    slow, fast = np.roots([1.0, damping, 1.0])[::-1]
    slow = 1.0 / fast
    assert found.multipliers[1] == 0.0
    assert np.all(abs(found.exponents - [slow, fast]) <= found.exponent_errors)
    assert found.exponent_errors[1] < 1e-10 * damping
    assert abs(found.T - 2.0 * slow) <= found.T_error < 1e-10
    assert found.verdict == "stable"


@pytest.mark.parametrize("seed", range(6))
def test_constant_coefficients(seed: int) -> None:
    """Phi is the exponential of the first-order matrix, exponents its eigenvalues."""
    rng = np.random.default_rng(seed)
    n = 1 + seed % 4
    K, C = rng.standard_normal((n, n)) + 3.0 * np.eye(n), 0.3 * rng.standard_normal((n, n))
    M = rng.standard_normal((n, n)) + 2.0 * np.eye(n)
    found = monodromy(PeriodicEquation(K=K, C=C, M=M, Omega=1.7))
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    exact = expm(A * 2.0 * np.pi / 1.7)
    # Measured 8e-14, the exponential's own share included.
    assert np.max(np.abs(found.matrix - exact)) < 1e-12 * np.max(np.abs(exact))
    assert nearest(found.exponents, np.linalg.eigvals(A), 1.7) < 1e-12
    first = monodromy(PeriodicEquation.first_order(A=A, Omega=1.7))
    assert np.max(np.abs(first.matrix - exact)) < 1e-12 * np.max(np.abs(exact))


@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_rotor_in_a_frame_that_turns_with_it(damping: float) -> None:
    """There the coefficients are constant; c moves every exponent by -c/2, and c J in stiffness."""
    k, dk, c = 1.0, 0.2, damping
    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    stiffness = np.diag([k + dk, k - dk]) - np.eye(2) + c * J
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -(2.0 * J + c * np.eye(2))]])
    found = monodromy(asymmetric_rotor(c))
    # one turn of the rotor is two periods: exponents may differ by i Omega/2
    assert nearest(found.exponents, np.linalg.eigvals(A), 1.0) < 1e-13


# ---- the special equation ------------------------------------------------------------------------


@pytest.mark.parametrize("row", all_rows(), ids=lambda row: row.id)
def test_every_row_in_general_form(row: Any) -> None:
    """P(z) of half a period in u, and the polynomial of the multipliers of all of it in q."""
    own = equation(row, 2)
    special, found = monodromy(own), monodromy(own.general())
    d = np.exp(-0.5 * own.damping * own.period)
    p, errors = (turned(x, d) for x in (special.polynomial, special.errors))
    assert np.max(np.abs(found.polynomial - p) / (found.errors + errors + EPS)) <= 1.0
    # Measured 1.5e-12: a coefficient of P(z) counts up to 2^6 times.
    assert np.max(np.abs(found.polynomial - p)) < 2e-11
    assert abs(found.T - special.T) <= found.T_error + special.T_error
    assert {found.verdict, special.verdict} != {"stable", "unstable"}
    apart = np.abs(found.multipliers[:, None] - special.multipliers)
    # of two that meet only half the digits
    assert np.max(np.min(apart, axis=1)) < 1e-5


def turned(P: Any, d: float) -> Any:
    """Of P(z), or bounds: sum_j p_j (mu^2 + d^2)^(n - j) (2 d mu)^j, z = (mu/d + d/mu)/2."""
    n, total = len(P) - 1, np.zeros(1)
    for j, p in enumerate(P):
        term = np.array([float(p)])
        for _ in range(n - j):
            term = np.polymul(term, [1.0, 0.0, d * d])
        total = np.polyadd(total, np.polymul(term, [(2.0 * d) ** j, *np.zeros(j)]))
    return np.concatenate([np.zeros(2 * n + 1 - len(total)), total])


def test_exponents_of_the_special_equation() -> None:
    F, G = [[2.0, 0.3], [0.2, 1.0]], [[1.0, 2.0], [3.0, 1.0]]
    for eta in (0.0, 0.2, [[0.1, 0.5], [-0.4, 0.2]]):
        found = monodromy(HillEquation(F, G, 0.3, 1.3, eta))
        period = 2.0 * np.pi / 1.3
        assert np.max(np.abs(np.exp(found.exponents * period) - found.multipliers)) < 1e-14
        assert pytest.approx(2.0 * found.exponents.real.max(), abs=1e-14) == found.T
        general = monodromy(HillEquation(F, G, 0.3, 1.3, eta).general())
        apart = wrapped(found.exponents[:, None] - general.exponents, 1.3)
        allowed = found.exponent_errors[:, None] + general.exponent_errors
        assert np.all(np.any(apart <= allowed, axis=1))
        assert np.max(found.exponent_errors) < 1e-12


@pytest.mark.parametrize("change", [np.diag([1e-3, 40.0]), [[1.0, 0.5], [-0.2, 2.0]]])
def test_other_coordinates_change_nothing(change: Any) -> None:
    """q = R r, and the equations in the combination L: the same multipliers."""
    given = asymmetric_rotor(0.1)
    R, L = np.array(change), np.array([[1.0, 0.3], [0.0, -2.0]])

    def moved(x: Fourier) -> Fourier:
        parts = [{k: L @ part @ R for k, part in each.items()} for each in (x.cos, x.sin)]
        return Fourier(L @ x.mean @ R, cos=parts[0], sin=parts[1])

    other = PeriodicEquation(
        M=L @ given.M @ R, C=moved(given.C), K=moved(given.K), Omega=given.Omega
    )
    one, two = monodromy(given), monodromy(other)
    # the products with R and L are themselves rounded
    assert np.max(np.abs(one.polynomial - two.polynomial)) < 1e-11 * np.max(np.abs(one.polynomial))
    assert abs(one.T - two.T) < 1e-11


def test_time_may_begin_anywhere() -> None:
    """A quarter of a period later cosines are sines: the same multipliers."""
    cos, sin = np.array([[0.4, 0.2], [0.1, -0.3]]), np.array([[0.1, 0.5], [-0.4, 0.2]])
    K = np.diag([1.0, 2.3])
    here = PeriodicEquation(K=Fourier(K, cos={1: cos}, sin={1: sin}), Omega=1.7)
    later = PeriodicEquation(K=Fourier(K, cos={1: sin}, sin={1: -cos}), Omega=1.7)
    one, two = monodromy(here), monodromy(later)
    assert np.max(np.abs(one.polynomial - two.polynomial)) <= one.error + two.error < 1e-11


# ---- other solvers -------------------------------------------------------------------------------


def by_scipy(given: PeriodicEquation) -> Any:
    m = given.order

    def at(x: Fourier, t: float) -> Any:
        waves = [np.cos(k * given.Omega * t) * part for k, part in x.cos.items()]
        return x.mean + sum(waves + [np.sin(k * given.Omega * t) * p for k, p in x.sin.items()])

    def rise(t: float, y: Any) -> Any:
        X = y.reshape(m, m)
        if given.A is not None:
            return (at(given.A, t) @ X).ravel()
        n = given.K.n
        force = at(given.C, t) @ X[n:] + at(given.K, t) @ X[:n]
        return np.concatenate([X[n:], -np.linalg.solve(given.M, force)]).ravel()

    end = solve_ivp(rise, (0.0, given.period), np.eye(m).ravel(), "DOP853", rtol=1e-11, atol=1e-13)
    return end.y[:, -1].reshape(m, m)


@both_methods
@pytest.mark.parametrize("seed", range(16))
def test_against_scipy(seed: int, method: str) -> None:
    given = random_periodic(1000 + seed, most=1 + 2 * seed // 3)
    found, exact = monodromy(given, method=method), by_scipy(given)
    units = np.ones(given.order)
    if given.A is None:
        units[given.K.n :] = given.Omega
    else:
        units = np.sqrt(np.max(np.abs(exact), axis=1) / np.max(np.abs(exact), axis=0))
    apart = (found.matrix - exact) / units[:, None] * units
    # Measured 4e-9, scipy's own error.
    assert np.max(np.abs(apart)) < 5e-8 * np.max(np.abs(exact / units[:, None] * units))


# ---- bounds --------------------------------------------------------------------------------------


# Of `random_periodic(seed, 8, 1.5)`, those that balls are quick with.
JUDGED = (
    *(0, 1, 2, 3, 6, 7, 8, 10, 13, 14, 16, 17, 18, 19, 20, 21, 22, 23, 25, 27),
    *(28, 30, 31, 34, 35, 36, 38, 42, 43, 46, 47, 48, 49, 52, 54, 56, 57, 59, 61, 62),
)


@both_methods
@pytest.mark.parametrize("seed", JUDGED)
def test_no_bound_is_below_the_true_error(seed: int, method: str) -> None:
    given = random_periodic(seed, 8, 1.5)
    p, Phi = reference(given)
    found = monodromy(given, method=method)
    assert np.all(off(found.polynomial, p) <= found.errors)
    matrix_error = off(found.matrix, [x for row in Phi for x in row])
    assert np.all(matrix_error <= found.matrix_error.ravel())
    true = np.array(true_exponents(Phi, given.period))
    rounding = 4.0 * EPS * (1.0 + np.abs(true)).max()
    apart = wrapped(found.exponents[:, None] - true, given.Omega)
    assert np.all(apart.min(axis=1) <= found.exponent_errors + rounding)
    T = 2.0 * true.real.max()
    assert abs(found.T - T) <= found.T_error + rounding
    assert found.verdict in ("undecided", "unstable" if T > 0.0 else "stable")
    # of no use otherwise
    size = np.sum(np.abs(found.polynomial))
    assert found.error < 1e-9 * size


def true_exponents(Phi: list[list[arb]], period: float) -> list[complex]:
    with ctx.workprec(2048):
        values = acb_mat([[acb(x) for x in row] for row in Phi]).eig(multiple=True)
        return [logarithm(value) / period for value in values]


def logarithm(value: Any) -> complex:
    """Of a ball, which may lie on the cut."""
    return float(abs(value).log()) + 1j * float(np.angle(complex(value / abs(value))))


@pytest.mark.parametrize("seed", range(12))
def test_no_bound_on_a_product_is_below_the_true_error(seed: int) -> None:
    """Factors as floats, multiplied out in balls: their multipliers may be 1e-200 of each other."""
    rng = np.random.default_rng(seed)
    m, p = 1 + seed % 5, int(rng.integers(1, 40))
    basis = np.eye(m) + 0.3 * rng.standard_normal((m, m))
    rates = np.diag(np.exp(-rng.uniform(0.0, 4.0, m)))
    # each factor swings and decays, and what is slow at one time is fast at another
    factors = np.array(
        [
            basis @ rates @ expm(0.3 * rng.standard_normal((m, m))) @ np.linalg.inv(basis)
            for _ in range(p)
        ]
    )
    families = periodic_discs(factors, np.zeros_like(factors))
    assert families
    value, radius = logarithms(families)
    with ctx.workprec(2048):
        product = acb_mat(np.eye(m).tolist())
        for P in factors:
            product = acb_mat([[acb(float(x)) for x in row] for row in P]) * product
        true = np.array([logarithm(x) for x in product.eig(multiple=True)])
    apart = wrapped(value[:, None] - true, 2.0 * np.pi)
    assert np.all(apart.min(axis=1) <= radius + 1e-14)
    assert np.all(apart.min(axis=0) < 1e-8)
    assert np.max(radius) < 1e-8
    for discs in families:
        assert np.max(discs.most) >= true.real.max() - 1e-13


def test_errors_of_the_factors_move_multipliers_within_their_bounds() -> None:
    rng = np.random.default_rng(4)
    factors = np.array([expm(0.8 * rng.standard_normal((3, 3)) - np.eye(3)) for _ in range(12)])
    errors = 1e-6 * np.abs(factors)
    value, radius = logarithms(periodic_discs(factors, errors))
    worst = 0.0
    for _ in range(50):
        other = factors + errors * rng.choice([-1.0, 1.0], errors.shape)
        moved, _ = logarithms(periodic_discs(other, np.zeros_like(errors)))
        apart = wrapped(value[:, None] - moved, 2.0 * np.pi).min(axis=1)
        assert np.all(apart <= radius)
        worst = max(worst, float(np.max(apart / radius)))
    # the bound is of the size of what happens: 0.1 measured
    assert worst > 0.02


@pytest.mark.parametrize("seed", range(10))
def test_the_mass_is_divided_by_to_an_ulp(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = 1 + seed % 4
    left, right = (np.linalg.qr(rng.standard_normal((n, n)))[0] for _ in range(2))
    M = (
        left
        @ np.diag(np.geomspace(1.0, 10.0 ** -(1.5 * seed), n))
        @ right
        * 10.0 ** (40 * seed - 150)
    )
    B = rng.standard_normal((2, n, n))
    X, error = divided(M, B)
    # at a condition of 1e13 not all digits are known
    assert np.all(error <= (0.6 * EPS if seed < 7 else 1e-9) * np.abs(X))
    for x, b, e in zip(X, B, error, strict=True):
        exact = solved(M, b)
        apart = [[abs(Fraction(x[i, j]) - exact[i][j]) for j in range(n)] for i in range(n)]
        assert all(apart[i][j] <= Fraction(e[i, j]) for i in range(n) for j in range(n))


def solved(M: Any, B: Any) -> list[list[Fraction]]:
    """M^-1 B in fractions, by Gauss and Jordan."""
    n = len(M)
    rows = [[Fraction(float(x)) for x in (*M[i], *B[i])] for i in range(n)]
    for i in range(n):
        best = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[best] = rows[best], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for r in range(n):
            if r != i:
                rows[r] = [x - rows[r][i] * y for x, y in zip(rows[r], rows[i], strict=True)]
    return [row[n:] for row in rows]


def test_a_long_product_is_taken_in_groups() -> None:
    rng = np.random.default_rng(1)
    factors = np.eye(2) + 0.05 * rng.standard_normal((1000, 2, 2))
    scales = rng.uniform(0.0, 1.0, factors.shape)
    product, total = chain(factors, scales)
    expected = np.eye(2)
    for P in factors:
        expected = P @ expected
    assert np.allclose(product, expected, rtol=1e-11)
    # every factor off by its scale, one after the other and all at once
    epsilon = 1e-9
    signs = rng.choice([-1.0, 1.0], scales.shape)
    moved, _ = chain(factors + epsilon * signs * scales, scales)
    assert np.all(np.abs(moved - product) <= 1.01 * epsilon * total)
    (pairs,) = grouped(2, factors[:5])
    assert np.allclose(pairs, [factors[1] @ factors[0], factors[3] @ factors[2], factors[4]])


def test_data_errors_are_told_apart() -> None:
    """An equation known to 1e-6 only: P may move by data_error, and does."""
    K, pulse = np.array([[1.0, 0.3], [0.2, 2.0]]), np.array([[0.3, 0.1], [0.0, 0.2]])
    exact = monodromy(PeriodicEquation(K=Fourier(K, cos={1: pulse}), Omega=1.3))
    assert exact.data_error == 0.0
    rough = monodromy(PeriodicEquation(K=Fourier(K, cos={1: pulse}), Omega=1.3, data_error=1e-6))
    assert np.array_equal(rough.polynomial, exact.polynomial)
    off_by = 2e-6 * np.ones((2, 2))
    other = monodromy(PeriodicEquation(K=Fourier(K + off_by, cos={1: pulse}), Omega=1.3))
    moved = np.max(np.abs(other.polynomial - exact.polynomial))
    assert 0.01 * rough.data_error < moved <= rough.data_error


# ---- refusals ------------------------------------------------------------------------------------


def test_an_unknown_method_is_refused() -> None:
    with pytest.raises(
        ValueError, match=re.escape("method = 'euler': must be one of taylor, cvodes")
    ):
        monodromy(VINOGRAD, method="euler")


@both_methods
def test_growth_beyond_a_float_is_refused(method: str) -> None:
    with pytest.raises(OverflowError, match="grows beyond what a float can hold"):
        monodromy(PeriodicEquation.first_order(A=[[200.0]], Omega=1.0), method=method)


def test_too_many_steps_are_refused() -> None:
    with pytest.raises(ValueError, match=r"Omega = 1e-09: too small, one period needs"):
        monodromy(PeriodicEquation(K=[[1.0]], Omega=1e-9))


def test_a_quotient_beyond_a_float_is_refused() -> None:
    with pytest.raises(OverflowError, match=r"M: M\^-1 C or M\^-1 K exceeds what a float can hold"):
        monodromy(PeriodicEquation(K=[[1e200]], M=[[1e-200]], Omega=1.0))


def test_nothing_moves() -> None:
    found = monodromy(PeriodicEquation.first_order(A=np.zeros((2, 2)), Omega=1.0))
    assert np.array_equal(found.matrix, np.eye(2))
    assert (found.T, found.verdict) == (0.0, "undecided")
