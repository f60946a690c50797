"""Each part of the bounds of P by either route counts, alone where it can be had alone."""

from fractions import Fraction
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

from benchmarks.honesty.arbiter import largest_error, reference
from floquet import batch as floquet_batch
from floquet import monodromy
from floquet.accuracy import moved_by_data
from floquet.batch import equations as sweeps
from floquet.batch.numpy_kernel import Found, Points, _folded, terms_of
from floquet.data_errors import data_share, subtraction_error
from hill import HillEquation, characteristic
from hill.determinant import converged, finite, folding, rounding
from hill.determinant.finite import Blocks
from hill.determinant.rounding import coefficient_shifts

hill_batch = import_module("hill.batch")

EPS = 2.0**-52
Patch = pytest.MonkeyPatch

# ---- what rounding and errors of the data move P by ----------------------------------------------

BLOCKS = {
    "one row": Blocks(np.array([[2.3]]), {1: np.array([[0.8]])}),
    "neighbours": Blocks(
        np.array([[2.3, 0.4], [-0.7, 0.6]]), {1: np.array([[0.3, 0.9], [0.2, -0.5]])}
    ),
    "two apart": Blocks(
        np.array([[2.3, 0.4], [-0.7, 0.6]]),
        {1: np.array([[0.3, 0.9], [0.2, -0.5]]), 2: np.array([[0.1, -0.4], [0.6, 0.2]])},
    ),
}
ALPHA = np.arccos(np.exp(1j * np.pi * (np.arange(3) + 0.5) / 3)) / (2.0 * np.pi)


def P_at(system: Blocks) -> Any:
    """Values of P at the points of ALPHA."""
    return np.polyval(converged._converged(system)[0], np.cos(2.0 * np.pi * ALPHA))


def with_element(system: Blocks, p: int, j: int, k: int, by: float) -> Blocks:
    Fbar, B = system.Fbar.copy(), {q: M.copy() for q, M in system.B.items()}
    (Fbar if p == 0 else B[p])[j, k] += by
    return Blocks(Fbar, B)


@pytest.mark.parametrize("name", BLOCKS)
def test_an_error_of_one_element_moves_P_by_its_derivative(name: str, monkeypatch: Patch) -> None:
    """Against differences of P itself: as much for F, and no less for B."""
    # the rows beyond are left out, 1/m^2 each
    monkeypatch.setattr(rounding, "EXTRA_HARMONICS", 1000)
    system = BLOCKS[name]
    nothing = Blocks(0.0 * system.Fbar, {p: 0.0 * B for p, B in system.B.items()})
    for p in (0, *system.B):
        for j, k in np.ndindex(system.Fbar.shape):
            ends = [P_at(with_element(system, p, j, k, h)) for h in (1e-4, -1e-4)]
            slope = float(np.mean(np.abs(ends[0] - ends[1]))) / 2e-4
            one = with_element(nothing, p, j, k, 1.0)
            _, data = coefficient_shifts(system, one, one, ALPHA, P_at(system))
            assert data >= 0.99 * slope
            # harmonics that go together have their moduli taken one by one
            if system.reach == 1:
                assert data <= (1.01 if p == 0 else 2.1) * slope


def test_blocks_of_the_inverse_are_those_of_the_whole() -> None:
    """B_2 stands two harmonics apart, above and below, in even rows and in odd: by one inverse."""
    system, n = BLOCKS["two apart"], 2
    nothing = Blocks(0.0 * system.Fbar, {p: 0.0 * B for p, B in system.B.items()})
    m = np.arange(-40, 41)
    whole = np.kron(np.eye(81), system.Fbar).astype(complex)
    for p, B in system.B.items():
        whole += np.kron(np.eye(81, k=p) + np.eye(81, k=-p), B)
    values = P_at(system)
    for j, k in np.ndindex(n, n):
        expected = []
        for alpha, value in zip(ALPHA, values, strict=True):
            table = whole - np.diag(np.repeat((alpha + m) ** 2, n))
            inverse = np.linalg.inv(table).reshape(81, n, 81, n)
            above = np.array([inverse[i, k, i + 2, j] for i in range(79)])
            below = np.array([inverse[i + 2, k, i, j] for i in range(79)])
            sums = [part[odd::2].sum() for part in (above, below) for odd in (0, 1)]
            expected.append(abs(value) * np.abs(sums).sum())
        one = with_element(nothing, 2, j, k, 1.0)
        _, data = coefficient_shifts(system, one, one, ALPHA, values)
        # what the rows beyond add falls like m^-4
        assert data == pytest.approx(np.mean(expected), rel=5e-3)


@pytest.mark.parametrize("name", BLOCKS)
def test_rounding_of_the_data_is_four_half_ulps_of_what_it_sums(name: str) -> None:
    """F - eta^2/4 of terms a million times as large as what is left of them."""
    system = BLOCKS[name]
    nothing = Blocks(0.0 * system.Fbar, {p: 0.0 * B for p, B in system.B.items()})
    large = Blocks(1e6 * np.abs(system.Fbar), {p: np.abs(B) for p, B in system.B.items()})
    rounded, data = coefficient_shifts(system, large, large, ALPHA, P_at(system))
    assert rounded >= 2.0 * EPS * data
    least, _ = coefficient_shifts(system, nothing, nothing, ALPHA, P_at(system))
    assert rounded <= 2.0 * EPS * data + 1.01 * least


@pytest.mark.parametrize("w", [3.3, 30.3, 300.3])
def test_rows_are_rounded_one_by_one(w: float) -> None:
    """2 w rows of which each is off by an ulp, at random: the square root of so many."""
    nothing = Blocks(np.zeros((1, 1)), {})
    system = Blocks(np.array([[w * w]]), {})
    values = P_at(system)
    rounded, _ = coefficient_shifts(system, nothing, nothing, ALPHA, values)
    least = EPS * np.sqrt(2.0 * w) * np.mean(np.abs(values))
    assert least <= rounded <= 10.0 * least


# ---- the damping that F loses --------------------------------------------------------------------

ROUTES = {
    "hill": lambda e: (characteristic(e).polynomial, characteristic(e).error),
    "floquet": lambda e: (monodromy(e).polynomial, monodromy(e).error),
    "hill.batch": lambda e: first(hill_batch.polynomials([e])),
    "floquet.batch": lambda e: first(floquet_batch.polynomials([e])),
}
each_route = pytest.mark.parametrize("route", ROUTES)


def first(found: Any) -> Any:
    return found.coefficients[0], float(found.errors[0])


@each_route
@pytest.mark.parametrize("eta", [10.1, 30.3, 100.1, 1000.1])
def test_the_rounding_of_F_less_damping_is_in_the_bound(route: str, eta: float) -> None:
    """F - eta^2/4 is .3: of its digits up to six are lost."""
    equation = HillEquation([[0.25 * eta**2 + 0.3]], [[1.0]], 0.1, 13.0, eta)
    polynomial, error = ROUTES[route](equation)
    true = largest_error(polynomial, reference(equation))
    assert true <= error
    assert eta < 1000.0 or true > 1e-12


@each_route
@pytest.mark.parametrize("eta", [0.7, 1.3, 3.1])
def test_that_of_several_equations(route: str, eta: float) -> None:
    """F not diagonal, and Omega so slow that a little of F is much of P."""
    F = np.array([[0.25 * eta**2 + 0.3, 1e-3], [2e-3, 0.25 * eta**2 + 0.1]])
    equation = HillEquation(F, [[0.1, 0.2], [0.3, 0.1]], 0.01, 0.05, eta)
    polynomial, error = ROUTES[route](equation)
    assert largest_error(polynomial, reference(equation)) <= error


@each_route
def test_growth_that_the_end_does_not_show_is_in_the_bound(route: str) -> None:
    equation = HillEquation([[13.66]], [[-0.912]], 29.44, 1.41)
    polynomial, error = ROUTES[route](equation)
    assert largest_error(polynomial, reference(equation)) <= error


@pytest.mark.parametrize("eta", [100.1, 1000.1])
def test_what_the_subtraction_rounds_away(eta: float) -> None:
    """In A and in P, against P = z - cos 2 pi w with w off by just that."""
    f = 0.25 * eta**2 + 0.3
    equation = HillEquation([[f]], [[0.0]], 0.0, 13.0, eta)
    exact = Fraction(f) - Fraction(eta) ** 2 / 4
    with ctx.workprec(200):
        pair = (arb(exact.numerator) / exact.denominator, arb(f - 0.25 * eta**2))
        one, other = ((2 * arb.pi() * w2.sqrt() / arb(13.0)).cos() for w2 in pair)
        moved = float(abs(one - other))
    scale = np.abs(monodromy(equation).matrix)
    alone, share = subtraction_error(equation, np.maximum(scale, 1.0))
    assert alone[0, 0] >= moved > 0.0
    assert share * (1.0 + abs(np.cos(2.0 * np.pi * np.sqrt(0.3) / 13.0))) >= moved


def test_errors_of_the_data_are_those_of_what_pulsates() -> None:
    """gamma G and not G, and every H."""
    F = [[2.0]]
    still = HillEquation(F, [[1.0]], 0.0, 1.3, data_error=1e-10)
    assert data_share(still) == data_share(HillEquation(F, [[9.0]], 0.0, 1.3, data_error=1e-10))
    driven = data_share(HillEquation(F, [[6.0]], 1.0, 1.3, data_error=1e-10))
    # the largest element is 2 + 6 instead of 2
    assert driven == pytest.approx(4.0 * data_share(still))
    free = HillEquation(F, [[1.0]], 0.0, 1.3, H=[[[6.0]]], omega_L=1.3, data_error=1e-10)
    assert data_share(free) == pytest.approx(driven)


# ---- the determinant -----------------------------------------------------------------------------

EQUATION = HillEquation([[2.0, 0.3], [0.2, 1.0]], [[1.0, 2.0], [3.0, 1.0]], 0.3, 1.3)


def test_a_tail_left_out_shows(monkeypatch: Patch) -> None:
    """Without the coupling beyond M, P is wrong by M^-3, and the three sizes differ by that."""
    right = characteristic(EQUATION)
    monkeypatch.setattr(finite, "log_pair_tail", lambda system, alpha, M: 0.0 * alpha)
    wrong = characteristic(EQUATION)
    apart = np.max(np.abs(wrong.polynomial - right.polynomial))
    assert 1e-8 < apart <= wrong.error


def test_what_is_no_polynomial_shows(monkeypatch: Patch) -> None:
    """The same slip in all three sizes: only Liouville's theorem notices."""
    right, determinants = characteristic(EQUATION), finite.determinants

    def slipped(system: Any, alpha: Any, M: int, squares: Any) -> Any:
        return determinants(system, alpha, M, squares) * (1.0 + 1e-9 * np.cos(6 * np.pi * alpha))

    monkeypatch.setattr(finite, "determinants", slipped)
    wrong = characteristic(EQUATION)
    apart = np.max(np.abs(wrong.polynomial - right.polynomial))
    assert 1e-10 < apart <= wrong.error


def test_a_slip_that_is_a_polynomial_shows_in_the_sizes(monkeypatch: Patch) -> None:
    """It falls like M^-3, which no extrapolation expects, and is z times a number."""
    right, determinants = characteristic(EQUATION), finite.determinants

    def slipped(system: Any, alpha: Any, M: int, squares: Any) -> Any:
        slip = 1e-3 * float(M) ** -3 * np.cos(2.0 * np.pi * alpha)
        return determinants(system, alpha, M, squares) + slip

    monkeypatch.setattr(finite, "determinants", slipped)
    wrong = characteristic(EQUATION)
    apart = np.max(np.abs(wrong.polynomial - right.polynomial))
    assert 1e-9 < apart <= wrong.error


def test_what_rounding_does_is_added(monkeypatch: Patch) -> None:
    plain = characteristic(EQUATION)
    monkeypatch.setattr(converged, "coefficient_shifts", lambda *_: (1e-3, 1e-4))
    found = characteristic(EQUATION)
    assert found.error == pytest.approx(1e-3, rel=1e-6)
    assert found.data_error == 1e-4
    # a finite determinant is as far off as it is from the limit, and the limit as it is
    finite_one = characteristic(EQUATION, truncation=3)
    apart = np.max(np.abs(finite_one.polynomial - plain.polynomial))
    assert finite_one.error == pytest.approx(1e-3 + apart, rel=1e-3)


@pytest.mark.parametrize("w", [31.3, 100.3, 300.3, 700.3])
@pytest.mark.parametrize("luck", [False, True])
def test_an_argument_is_known_to_its_ulps(w: float, luck: bool, monkeypatch: Patch) -> None:
    """P = z - cos 2 pi w, w^2 a float: nothing is left to round but 2 pi w."""
    if luck:  # every sample is of the same polynomial, to the last bit
        value = -np.cos(2.0 * np.pi * w)
        monkeypatch.setattr(
            finite, "determinants", lambda _s, alpha, _M, _w: np.cos(2.0 * np.pi * alpha) + value
        )
    equation = HillEquation([[w * w]], [[0.0]], 0.0, 1.0)
    polynomial, error, _ = converged._converged(finite.blocks(equation))
    with ctx.workprec(200):
        true = float(abs((2 * arb.pi() * arb(w * w).sqrt()).cos() + arb(float(polynomial[1]))))
    assert luck or true <= error
    # each of its radians may be off by an ulp; that it was not is luck
    assert error >= 2.0 * np.pi * w * EPS


# ---- the determinant, many at once ---------------------------------------------------------------


def solved(
    monkeypatch: Patch, truncation: float, data: float, slip: float = 0.0, w: float = 1.0
) -> float:
    """The bound of z - .3, with samples that are exact but for what is said."""

    def exact(system: Any, alpha: Any, M: int) -> Any:
        z = np.cos(2.0 * np.pi * alpha)[:, None]
        return z - 0.3 + slip * z**2, np.array([truncation])

    monkeypatch.setattr(hill_batch, "samples", exact)
    one = np.ones((1, 1, 1, 1))
    squares = np.full((1, 1, 1), w * w)
    batch = folding.BlockBatch(one, one, np.ones(1), squares, np.array([data]))
    return float(hill_batch._solve(batch, 30)[1][0])


def test_a_batch_counts_what_it_leaves_out_and_what_it_rounds(monkeypatch: Patch) -> None:
    # samples of z - .3 on the unit circle are up to 1.3
    assert 0.0 < solved(monkeypatch, 0.0, 0.0) < 1e-13
    assert solved(monkeypatch, 1e-3, 0.0) >= 1e-3
    assert solved(monkeypatch, 0.0, 1e-3) >= 1e-3
    assert solved(monkeypatch, 0.0, 0.0, slip=1e-3) >= 4e-3
    assert solved(monkeypatch, 1e-3, 1e-3, slip=1e-3) >= 6e-3
    assert solved(monkeypatch, 0.0, 0.0, w=1e4) >= 2e4 * np.pi * EPS


def test_F_and_the_damping_are_both_rounded() -> None:
    """Of 3 - 2,500 either moves the square by its own rounding; with two by their eigenvectors."""
    shift = np.array([2500.0])
    coupling = np.array([[[5.0]]])
    _, moved = hill_batch._spectrum(np.array([[[3.0]]]), shift, coupling)
    assert moved[0, 0] == 2508.0
    F = np.array([[2.0, 1.0], [0.0, 3.0]])[:, :, None]
    _, moved = hill_batch._spectrum(F, 0.0 * shift, 0.0 * F)
    # 2 has l = (1, -1) and r = (1, 0), 3 has l = (0, 1) and r = (1, 1): |l| |F| |r| is 2 and 3
    assert np.sort(moved[:, 0]) == pytest.approx([2.0, 3.0])
    # a coupling from the first to the second is where F has nothing: 2 + |l_2| |r_1|, and 3 + 1
    _, moved = hill_batch._spectrum(F, 0.0 * shift, np.array([[0.0, 0.0], [1.0, 0.0]])[:, :, None])
    assert np.sort(moved[:, 0]) == pytest.approx([3.0, 4.0])
    for w, x, eta in ((2.0, 0.25, 0.0), (2.0, 0.25, 30.0), (0.0, 1.0, 0.0)):
        square = w * w / x
        rounding, every = moved_by_data(np.array([[square]]), np.array([x]), np.array([eta]))
        factor = np.pi / max(np.sqrt(abs(w * w - eta)), 0.5 / np.pi)
        assert rounding[0] == pytest.approx(factor * (w * w + eta))
        assert every[0] == pytest.approx(factor)


@pytest.mark.parametrize("w", [10.3, 45.3, 95.3])
def test_a_batch_knows_an_argument_to_its_ulps(w: float) -> None:
    equation = HillEquation([[w * w]], [[0.0]], 0.0, 1.0)
    polynomial, error = first(hill_batch.polynomials([equation]))
    assert largest_error(polynomial, reference(equation)) <= error
    assert error >= 2.0 * np.pi * w * EPS


@pytest.mark.parametrize("left", ["integral", "third", "last"])
def test_every_part_of_the_tail_counts(left: str, monkeypatch: Patch) -> None:
    """The integral to its quadrature's share, the third order, the midpoint rule's last term."""
    edges = (len(folding.EDGES), 1)
    value = np.ones(edges)
    parts = {"integral": 0.0, "third": 0.0, "last": 0.0} | {left: 1.0}
    monkeypatch.setattr(
        folding, "_integral", lambda *_: (parts["integral"] * value, parts["third"] * value)
    )
    monkeypatch.setattr(folding, "_differences", lambda *_: (0.0 * value, parts["last"] * value))
    one = np.ones((1, 1, 1, 1))
    batch = folding.BlockBatch(one, one, np.ones(1), np.ones((1, 1, 1)), np.zeros(1))
    _, error = folding._coupling_tail(batch, ALPHA[:, None], 30)
    # two ends; what is left of the integral by seven nodes is 2e-11 of it
    assert error[0] >= 2.0 * (2e-11 if left == "integral" else 1.0)


# ---- the time domain, many at once ---------------------------------------------------------------


def swept(monkeypatch: Patch, eta: float = 0.0, **found: float) -> tuple[float, list[float]]:
    """The bound of one equation, and which went to `monodromy`, with this for the march's word."""
    alone: list[float] = []

    def march(points: Points) -> Found:
        word = {"sensitivity": 1.0, "growth": 1.0, "rate": 1.0} | found
        return Found(np.array([[1.0, 0.0]]), *(np.array([word[k]]) for k in word))

    def asked(equation: HillEquation) -> Any:
        alone.append(equation.Omega)
        return np.array([1.0, 0.0]), 1.0

    monkeypatch.setattr(sweeps, "_march", lambda *_: march)
    monkeypatch.setattr(sweeps, "_bound", asked)
    equation = HillEquation([[1.0]], [[1.0]], 0.1, 1.0)
    result = floquet_batch.sweep(equation, Omega=1.0, gamma=0.1, eta=eta)
    return float(result.errors[0]), alone


def test_a_sweep_counts_what_the_march_says(monkeypatch: Patch) -> None:
    error, alone = swept(monkeypatch)
    assert not alone
    assert swept(monkeypatch, sensitivity=100.0)[0] > 50.0 * error
    # roundings that do not know of each other add up like the root of the time: measured 6.1
    assert swept(monkeypatch, rate=100.0)[0] > 4.0 * error
    assert swept(monkeypatch, eta=500.0)[0] > 20.0 * error  # F - eta^2/4 is rounded
    for word in ({"growth": 1e3}, {"growth": np.inf}, {"growth": np.nan}, {"sensitivity": 1e6}):
        assert swept(monkeypatch, **word)[1] == [1.0], word


def test_what_the_half_period_has_no_inverse_of_grows_without_bound() -> None:
    U = np.array([np.eye(2), np.ones((2, 2)), np.full((2, 2), np.nan)])
    _, _, growth = _folded(U, np.abs(U))
    assert growth[0] == pytest.approx(1.0)
    assert np.all(np.isinf(growth[1:]))


def test_the_largest_that_an_element_has_been_counts() -> None:
    """U ends as the identity, and was a thousand times as large before."""
    U = np.array([np.eye(2)])
    _, scale, growth = _folded(U, 1e3 * np.ones((1, 2, 2)))
    assert scale[0, 0, 0] >= 1e3
    assert growth[0] >= 1e3


def test_steps_are_for_F_and_the_damping_together() -> None:
    """Moduli: they may have either sign."""
    points = Points(np.array([[[3.0]], [[1.0]]]), np.ones((2, 2)), np.array([5.0, 7.0]), (1,))
    (F, _), (G, frequency) = terms_of(points)
    assert (F[0, 0], G[0, 0], frequency) == (10.0, 1.0, 1.0)
