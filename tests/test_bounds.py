"""Each part of a bound counts: what only that part covers, against exact arithmetic."""

from collections.abc import Callable
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from flint import acb_mat, arb, ctx, fmpq, fmpq_poly

from floquet.accuracy import amplitudes, bounded
from floquet.charpoly import MAX_EXACT, characteristic_polynomial, characteristic_polynomials
from floquet.eigenvalues import discs_from_matrix, discs_from_polynomial
from floquet.growth import _beyond
from floquet.integrate.step_length import fastest_rate
from floquet.sensitivity.equation import _of_multiplier, _of_z
from hill.stability import by_signs, root_radii, separators

EPS = 2.0**-52


def by_hill(z: Any, p: Any, errors: Any) -> Any:
    return root_radii(p[None], errors[None], z[None])[0]


def by_floquet(z: Any, p: Any, errors: Any) -> Any:
    return discs_from_polynomial(z, p, errors).radius


RADII: dict[str, Callable[..., Any]] = {"hill": by_hill, "floquet": by_floquet}
both = pytest.mark.parametrize("radii", RADII.values(), ids=RADII)


def exact_roots(p: Any) -> Any:
    """Of the floats p, to the last bit."""
    whole = fmpq_poly([fmpq(*float(c).as_integer_ratio()) for c in p[::-1]]).numer()
    return np.array([complex(z) for z, count in whole.complex_roots() for _ in range(count)])


# ---- discs about roots ---------------------------------------------------------------------------


@both
@pytest.mark.parametrize("which", [1, 2, 3])
def test_a_disc_holds_a_root_wherever_a_coefficient_is(radii: Any, which: int) -> None:
    """One coefficient off by so much that the roots move as far as they are apart, on 300 cubics.

    On the circle about a root the power of z beside that coefficient is as large as |z| + r.
    """
    rng = np.random.default_rng(which)
    for _ in range(300):
        z = (rng.standard_normal(3) * 10.0 ** rng.uniform(-2, 1, 3)).astype(complex)
        p, errors = np.real(np.poly(z)), np.zeros(4)
        errors[which] = abs(p[which]) * 10.0 ** rng.uniform(-2, 0.5)
        radius = radii(z, p, errors)
        for share in (-1.0, -0.5, 0.5, 1.0):
            found = np.roots(p + share * errors)
            # numpy's roots of three are good to 1e-8 where two of them meet
            apart = np.abs(z[:, None] - found).min(axis=1)
            assert np.all(apart <= radius + 1e-7 * (1.0 + np.abs(z)))


@both
def test_roots_are_off_by_what_multiplying_them_out_rounds(radii: Any) -> None:
    """P is what the roots give back, to the last bit: that they are not its roots is rounding."""
    z = np.linspace(-1.0, 1.0, 12).astype(complex)
    p = np.ones(1)
    for root in z.real:
        p = np.append(p, 0.0) - np.append(0.0, root * p)
    found = exact_roots(p)
    apart = np.abs(z[:, None] - found).min(axis=1)
    assert apart.max() > 1e-14
    assert np.all(apart <= radii(z, p, np.zeros(13)))


def test_where_derivatives_vanish() -> None:
    """The points between the roots, where P' does: by hand for two and three of them."""
    P = np.array([np.poly([0.9, 0.2, -0.7]), np.poly([0.5, 0.4, -0.9])])
    for p, between in zip(P, separators(P), strict=True):
        assert np.polyval(np.polyder(p), between) == pytest.approx([0.0, 0.0], abs=1e-15)
        assert between[0] > between[1]
    assert separators(np.array([[1.0, -0.6, 0.1]])).tolist() == [[0.3]]


# ---- signs ---------------------------------------------------------------------------------------


def nearly_zero_at(c: float, n: int, rng: np.random.Generator) -> Any:
    """A polynomial whose value at c is of the size of its rounding."""
    p = np.append(1.0, rng.uniform(-2.0, 2.0, n))
    p[-1] = -np.polyval(np.append(p[:-1], 0.0), c)
    p[-1] += int(rng.integers(-4, 5)) * np.spacing(p[-1])
    return p


def value(p: Any, x: float) -> Fraction:
    total = Fraction(0)
    for c in p:
        total = total * Fraction(x) + Fraction(float(c))
    return total


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_sign_is_right_or_not_given(side: float) -> None:
    """P(1) and P(-1) of the order of their rounding, 2,000 times, and their exact signs."""
    rng = np.random.default_rng(8)
    wrong = 0
    for _ in range(2000):
        n = int(rng.integers(1, 12))
        p = nearly_zero_at(side, n, rng)
        beyond = value(p, 1.0) < 0 or (-1) ** n * value(p, -1.0) < 0
        nothing = np.zeros(n + 1)
        between = np.sort(rng.uniform(-1.0, 1.0, (1, n - 1)))[:, ::-1]
        inside, outside = by_signs(p[None], nothing[None], between, np.zeros(1))
        assert beyond or not (outside[0] or _beyond(p, nothing, 0.0))
        if inside[0]:
            assert not beyond
        shown = np.polyval(p, side) * (side if n % 2 else 1.0)
        wrong += not beyond and shown < 0.0
    assert wrong >= 5  # so many would be, by the computed value alone


@pytest.mark.parametrize("decay", [0.3, 3.0, 30.0, 300.0])
def test_the_edge_is_known_as_well_as_its_exponent(decay: float) -> None:
    """P = z - c with c a float beside cosh(decay): which side the true edge is on is not known."""
    with ctx.workprec(200):
        edge = arb(decay).cosh()
        for ulps in range(-4, 5):
            c = float(edge.mid()) * (1.0 + ulps * (2.0 + decay) * EPS)
            p = np.array([1.0, -c])
            beyond = bool(edge - arb(c) < 0)
            _, outside = by_signs(p[None], np.zeros((1, 2)), np.empty((1, 0)), np.array([decay]))
            assert beyond or not (outside[0] or _beyond(p, np.zeros(2), decay))


@pytest.mark.parametrize("decay", [100.0, 300.0, 600.0])
def test_the_rounding_of_the_edge_counts(decay: float) -> None:
    """The computed edge an ulp of `decay` below c: P is negative there, and shows nothing."""
    c = float(np.cosh(decay * (1.0 + EPS)))
    assert c > np.cosh(decay)
    p = np.array([1.0, -c])
    _, outside = by_signs(p[None], np.zeros((1, 2)), np.empty((1, 0)), np.array([decay]))
    assert not outside[0]
    assert not _beyond(p, np.zeros(2), decay)


# ---- discs of a matrix ---------------------------------------------------------------------------


def exact_eigenvalues(A: Any) -> Any:
    with ctx.workprec(300):
        return np.array([complex(z) for z in acb_mat(A.tolist()).eig()])


@pytest.mark.parametrize("n", [2, 3, 6])
def test_eigenvalues_are_off_by_rounding(n: int) -> None:
    """Nothing is unsure of the matrix, and still no eigenvalue is where it was computed."""
    rng = np.random.default_rng(n)
    off = 0.0
    for _ in range(100):
        A = rng.standard_normal((n, n)) * 10.0 ** rng.uniform(-3, 3, (n, 1))
        discs = discs_from_matrix(A, np.zeros((n, n)))
        apart = np.abs(discs.centre[:, None] - exact_eigenvalues(A)).min(axis=1)
        assert np.all(apart <= discs.radius)
        off = max(off, float(apart.max()))
    assert off > 1e-13


def test_what_an_eigenvalue_is_off_is_in_its_radius(monkeypatch: pytest.MonkeyPatch) -> None:
    """They come 1e-6 off; only A X - X L says so."""
    A, right = np.array([[1.0, 0.3], [0.2, 3.0]]), np.linalg.eig

    def off(matrix: Any) -> Any:
        values, X = right(matrix)
        return values + 1e-6, X

    monkeypatch.setattr(np.linalg, "eig", off)
    assert np.all(discs_from_matrix(A, np.zeros((2, 2))).radius >= 1e-6)


def test_an_inverse_that_is_none_is_made_up_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """W is .7 of the inverse: the radius is as large as with the inverse itself."""
    A, error = np.diag([1.0, 3.0]), np.diag([0.1, 0.2])
    right = np.linalg.inv
    monkeypatch.setattr(np.linalg, "inv", lambda X: 0.7 * right(X))
    radius = discs_from_matrix(A, error).radius
    assert np.all(radius >= [0.2, 0.1])
    # half of the inverse is none
    monkeypatch.setattr(np.linalg, "inv", lambda X: 0.4 * right(X))
    assert np.all(discs_from_matrix(A, error).radius > 3.0)


def test_without_eigenvectors_a_disc_holds_every_eigenvalue(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A defective matrix, moved to where its eigenvalues are +-sqrt(10), and far from another."""

    def singular(_: Any) -> Any:
        raise np.linalg.LinAlgError

    monkeypatch.setattr(np.linalg, "inv", singular)
    jordan = np.array([[0.0, 1.0], [0.0, 0.0]])
    discs = discs_from_matrix(jordan, np.array([[0.0, 0.0], [10.0, 0.0]]))
    assert np.all(discs.radius >= np.sqrt(10.0))
    A = np.array([[-5.0, 0.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])
    discs = discs_from_matrix(A, np.diag([1.0, 0.0, 0.0]))
    every = np.array([-6.0, -4.0, 1.0])
    assert np.all(np.abs(discs.centre[:, None] - every).max(axis=1) <= discs.radius)
    assert np.all(discs.together)


def test_discs_hang_together_through_others() -> None:
    """A chain of nine, each of which meets the next alone, and one that is apart."""
    together = apart(np.append(1.5 * np.arange(9.0), 20.0), np.full(10, 0.8))
    assert np.all(together[1:, 1:])
    assert not np.any(together[0, 1:])  # by descending centre
    # one disc reaches, the other does not
    assert np.all(apart(np.array([0.0, 1.0]), np.array([0.9, 0.2])))


def apart(centre: Any, radius: Any) -> Any:
    """Which of these discs form a region."""
    return discs_from_matrix(np.diag(centre), np.diag(radius)).together


# ---- coefficients --------------------------------------------------------------------------------

A2 = np.array([[2.0, 3.0], [5.0, 7.0]])
SCALE = np.array([[1.0, 10.0], [100.0, 1000.0]])
# |dp_1| <= |da| + |dd|; |dp_2| <= |d da| + |a dd| + |c db| + |b dc|
MOVED = np.array([0.0, 1.0 + 1000.0, 7.0 * 1.0 + 2.0 * 1000.0 + 5.0 * 10.0 + 3.0 * 100.0])
# where the four do not know of each other
APART = float(np.hypot(np.hypot(7.0 * 1.0, 2.0 * 1000.0), np.hypot(5.0 * 10.0, 3.0 * 100.0)))


@pytest.mark.parametrize("n", [2, 3, MAX_EXACT, MAX_EXACT + 1, MAX_EXACT + 5])
def test_how_coefficients_move(n: int) -> None:
    """Two rows by hand, the others zero; as one matrix and as many."""
    A, scale = np.zeros((n, n)), np.zeros((n, n))
    A[:2, :2], scale[:2, :2] = A2, SCALE
    p, sensitivity, _ = characteristic_polynomial(A, scale)
    assert p[:3] == pytest.approx([1.0, -9.0, -1.0])
    assert sensitivity[:3] == pytest.approx(MOVED)
    # for many at once what rounding adds comes on top, here a millionth
    _, largest = characteristic_polynomials(A[None], 1e6 * scale[None])
    assert largest[0] == pytest.approx(1e6 * APART, rel=1e-5)


def exact_coefficients(A: Any) -> Any:
    with ctx.workprec(600):
        return [arb(c.real) for c in acb_mat(A.tolist()).charpoly().coeffs()[::-1]]


def off_by(p: Any, A: Any) -> Any:
    with ctx.workprec(600):
        pairs = zip(p, exact_coefficients(A), strict=True)
        return np.array([float(abs(arb(float(x)) - y)) for x, y in pairs])


@pytest.mark.parametrize("n", [2, 3, 8, MAX_EXACT + 1, MAX_EXACT + 4])
def test_rounding_of_one_characteristic_polynomial(n: int) -> None:
    """Of floats, normal and far from it, with large and with cancelling coefficients."""
    rng = np.random.default_rng(n)
    kinds = [rng.standard_normal((n, n)) for _ in range(6)]
    kinds += [A + A.T for A in kinds[:3]] + [np.triu(A) * 30.0 for A in kinds[:3]]
    kinds += [np.ones((n, n)) + 1e-6 * A for A in kinds[:3]]
    for A in kinds:
        p, _, rounding = characteristic_polynomial(A, np.zeros((n, n)))
        off = off_by(p, A)
        assert np.all(off <= rounding)
        assert rounding[0] == 0.0
        if n <= MAX_EXACT:
            assert np.all(rounding <= 0.5 * EPS * np.abs(p))


@pytest.mark.parametrize("n", [2, 3, 4, 8])
def test_rounding_of_many_characteristic_polynomials(n: int) -> None:
    """What they cancel is in the second number: twelve ulps of it, as `floquet.batch` has them."""
    rng = np.random.default_rng(n)
    A = rng.standard_normal((60, n, n))
    A[20:40] = 1.0 + 1e-7 * A[20:40]
    A[40:] = np.triu(A[40:]) * 30.0
    p, largest = characteristic_polynomials(A, np.zeros_like(A) + 1e-300)
    off = np.array([off_by(x, one).max() for x, one in zip(p, A, strict=True)])
    if n > 2:
        assert np.all(off <= 24.0 * EPS * largest)


def test_what_two_runs_know_of_two_rows() -> None:
    """The same twice: the floor, three times the ulps, and half an ulp of P for each run."""
    known = bounded(A2, A2, SCALE, 0.0, 0.0)
    assert known.errors == pytest.approx(EPS * np.array([0.0, 9.0, 1.0]), rel=1e-9, abs=0.0)
    assert not np.any(known.matrix_error)
    known = bounded(A2, A2, SCALE, 0.0, 1e-3)
    assert known.errors == pytest.approx(1e-3 * MOVED, rel=1e-9)
    assert known.matrix_error == pytest.approx(1e-3 * SCALE)
    known = bounded(A2, A2, SCALE, 1e9, 0.0)
    assert np.all(known.errors >= 1e9 * EPS * MOVED)
    assert np.all(known.matrix_error >= 1e9 * EPS * SCALE)


def test_what_two_runs_differ_by_counts_everywhere() -> None:
    """One element differs by 1e-3: every coefficient and element may be as far off, by its size."""
    check = A2 + np.array([[0.0, 0.0], [0.0, 1e-3]])
    known = bounded(A2, check, SCALE, 0.0, 0.0)
    # p_1 differs by 1e-3 of 1001, p_2 by 2e-3 of 2357
    share = 1e-3 / 1001.0
    assert np.all(known.errors[1:] >= share * MOVED[1:])
    assert np.all(known.matrix_error >= share * SCALE)
    assert known.matrix_error[1, 1] >= 1e-3
    # no more than eight times that, or it would say nothing
    assert np.all(known.errors[1:] <= 8.1 * share * MOVED[1:])
    # an element alone, by which P does not move
    flat = bounded(A2, A2 + np.array([[1e-3, 0.0], [0.0, -1e-3]]), 0.0 * SCALE, 0.0, 0.0)
    assert np.all(np.diag(flat.matrix_error) >= 1e-3)


def test_what_the_data_were_off_adds_to_both() -> None:
    """In A by `alone`, or in P by a share of its size: whichever says less."""
    plain = bounded(A2, A2, SCALE, 0.0, 1e-3)
    size = 1.0 + 9.0 + 1.0
    little = bounded(A2, A2, SCALE, 0.0, 1e-3, (1e-6 * SCALE, 1.0))
    assert little.errors - plain.errors == pytest.approx(1e-6 * MOVED, rel=1e-6)
    assert little.matrix_error - plain.matrix_error == pytest.approx(1e-6 * SCALE, rel=1e-6)
    little = bounded(A2, A2, SCALE, 0.0, 1e-3, (SCALE, 1e-6))
    assert (little.errors - plain.errors)[1:] == pytest.approx([1e-6 * size] * 2, rel=1e-6)
    assert little.matrix_error - plain.matrix_error == pytest.approx(1e-6 * SCALE, rel=1e-6)


@pytest.mark.parametrize("w", [0.2, 3.0])
def test_what_swings_is_as_large_as_a_moment_before(w: float) -> None:
    """cos w tau and its kin at a quarter of the period, where half of them are zero."""
    quarter = np.array([[0.0, 1.0 / w], [-w, 0.0]])
    assert amplitudes(quarter, w) == pytest.approx(np.array([[1.0, 1.0 / w], [w, 1.0]]))
    start = np.eye(2)
    assert amplitudes(start, w) == pytest.approx(np.array([[1.0, 1.0 / w], [w, 1.0]]))


def test_signs_of_all_corners_are_tried() -> None:
    """The discs hold for every corner of what the errors allow, real or paired, on 200 quartics."""
    rng = np.random.default_rng(6)
    for _ in range(200):
        z = rng.uniform(-1.2, 1.2, 4).astype(complex)
        z[:2] = z[0].real + 10.0 ** rng.uniform(-4, 0) * np.array([1j, -1j])
        p = np.real(np.poly(z))
        errors = np.append(0.0, 10.0 ** rng.uniform(-8, -1, 4))
        tried = [radii(z, p, errors) for radii in RADII.values()]
        for signs in product((-1.0, 1.0), repeat=4):
            found = np.roots(p + np.append(0.0, signs) * errors)
            apart = np.abs(z[:, None] - found).min(axis=1)
            for radius in tried:
                assert np.all(apart <= radius + 1e-6)


def ln_larger(z: Any) -> tuple[Any, Any]:
    """Ln |mu| of z = (mu + 1/mu)/2, and its derivative."""
    mu = np.exp(np.arccosh(z))
    return np.abs(np.log(np.abs(mu))), 2.0 / np.where(np.abs(mu) > 1.0, mu - 1 / mu, 1 / mu - mu)


@pytest.mark.parametrize("of", ["z", "multiplier"])
def test_growth_and_its_slope_are_bounded_in_the_whole_disc(of: str) -> None:
    """At 400 points on the rim of each of 300 discs, up to an eighth of what T is refused at."""
    rng = np.random.default_rng(4)
    z = rng.uniform(-1.6, 1.6, 300) + 1j * rng.choice([0.0, 0.01, 0.5], 300)
    nearest = np.minimum(np.abs(z - 1.0), np.abs(z + 1.0)) if of == "z" else np.abs(z)
    radius = nearest * 10.0 ** rng.uniform(-8, -1, 300)
    rim = z[:, None] + 0.999999 * radius[:, None] * np.exp(
        2j * np.pi * rng.uniform(size=(300, 400))
    )
    found = (_of_z if of == "z" else _of_multiplier)(z, radius)
    value, slope = ln_larger(rim) if of == "z" else (np.log(np.abs(rim)), 1.0 / rim)
    rounding = 1e-14 / nearest[:, None] ** 2
    assert np.all(value >= found.least[:, None] - rounding)
    assert np.all(value <= found.most[:, None] + rounding)
    # across the cut [-1, 1] the larger mu is the other one, and the slope changes its sign
    signs = (1.0, -1.0) if of == "z" else (1.0,)
    apart = np.min([np.abs(slope - sign * found.slope[:, None]) for sign in signs], axis=0)
    assert np.all(apart <= found.slope_error[:, None] + rounding)


def test_the_fastest_rate_is_of_all_that_moves() -> None:
    """4 + 2 cos 3 tau and a damping of 5: sqrt 6, and 5, and 3; of moduli, whatever their sign."""
    four, two, five = (np.array([[x]]) for x in (4.0, -2.0, -5.0))
    found = fastest_rate([(four, 0.0), (two, 3.0)], five)
    assert found == pytest.approx(np.sqrt(6.0) + 5.0 + 3.0)
