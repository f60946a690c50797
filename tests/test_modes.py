"""The mode shapes of the free-free beam."""

import numpy as np
import pytest
from scipy.optimize import brentq

from hill.matrices.modes import Exponentials, curvature, eigenvalue, mode, slope

# Two of the literature's eigenvalues differ from these in the seventeenth digit at most.
PUBLISHED = [4.7300407448627040, 7.8532046240958376, 10.995607838001671]


def root(n: int) -> float:
    """The n-th root of cos x = 1/cosh x by bisection, independent of Newton's start."""
    return brentq(lambda x: np.cos(x) - 1.0 / np.cosh(x), n * np.pi, (n + 1) * np.pi, xtol=1e-15)


def scaled(f: Exponentials, n: int, order: int, xi: float) -> float:
    """A derivative over lambda_n**order: of the order of the mode itself."""
    return f(xi) / eigenvalue(n) ** order


def quadrature(highest: float) -> tuple[np.ndarray, np.ndarray]:
    """Gauss nodes for a product of two modes: 20 points over each half wave and more."""
    panels = 2 * int(np.ceil(highest / np.pi))
    node, weight = np.polynomial.legendre.leggauss(20)
    edge = np.arange(panels)[:, None]
    xi = (edge + 0.5 * (1.0 + node)) / panels
    return xi.ravel(), np.tile(0.5 * weight / panels, panels)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_published_eigenvalues(n: int) -> None:
    # Rounded once, and so is the literal.
    assert eigenvalue(n) == pytest.approx(PUBLISHED[n - 1], rel=4.5e-16, abs=0.0)


@pytest.mark.parametrize("n", range(1, 61))
def test_eigenvalues_by_bisection(n: int) -> None:
    # cos x near its root is known to an ulp of x: 1.2e-16 x.
    assert eigenvalue(n) == pytest.approx(root(n), rel=5e-16, abs=0.0)


@pytest.mark.parametrize("n", [1, 2, 3, 7, 12, 20, 40, 60])
def test_free_ends(n: int) -> None:
    """No moment and no shear at either end: phi'' = phi''' = 0."""
    bend = curvature(n)
    for f, order in ((bend, 2), (bend.derivative, 3)):
        for xi in (0.0, 1.0):
            # lambda_n is known to half an ulp, and so is the phase at the far end.
            assert abs(scaled(f, n, order, xi)) < 4e-16 * eigenvalue(n) + 4e-16


@pytest.mark.parametrize("n", [1, 2, 3, 7, 20, 60])
def test_the_ends_move_by_two(n: int) -> None:
    """cosh + cos is 2 at the near end; the far one is its mirror image."""
    assert mode(n)(0.0) == pytest.approx(2.0, abs=1e-15)
    assert mode(n)(1.0) == pytest.approx(-2.0 * (-1.0) ** n, abs=1e-15 * eigenvalue(n))


@pytest.mark.parametrize("n", [1, 2, 5, 20])
def test_the_beam_equation(n: int) -> None:
    """phi'''' = lambda**4 phi."""
    fourth = curvature(n).derivative.derivative
    for xi in np.linspace(0.0, 1.0, 13):
        # kappa**4 is rounded four times.
        assert scaled(fourth, n, 4, xi) == pytest.approx(mode(n)(xi), abs=4e-15)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_the_textbook_form(n: int) -> None:
    """cosh + cos - alpha (sinh + sin), where its cancellation still leaves digits."""
    lam = eigenvalue(n)
    alpha = (np.cosh(lam) - np.cos(lam)) / (np.sinh(lam) - np.sin(lam))
    xi = np.linspace(0.0, 1.0, 41)
    x = lam * xi
    book = np.cosh(x) + np.cos(x) - alpha * (np.sinh(x) + np.sin(x))
    # An ulp of cosh(lambda): 3e-15 to 4e-12.
    found = [mode(n)(float(s)) for s in xi]
    np.testing.assert_allclose(found, book, atol=1e-15 * np.cosh(lam))


def test_orthonormal() -> None:
    """To each other, to translation and to rotation, up to n = 20."""
    count = 20
    xi, weight = quadrature(2.0 * eigenvalue(count))
    w = np.array([[mode(n)(float(s)) for s in xi] for n in range(1, count + 1)])
    rigid = np.array([xi, np.ones_like(xi)])
    # Measured 3e-15 and 3e-15.
    np.testing.assert_allclose((w * weight) @ w.T, np.eye(count), atol=2e-14)
    np.testing.assert_allclose((w * weight) @ rigid.T, 0.0, atol=2e-14)


def test_derivatives_are_slopes() -> None:
    h = 1e-5
    for n in (1, 3, 5):
        for xi in np.linspace(0.1, 0.9, 5):
            difference = (mode(n)(xi + h) - mode(n)(xi - h)) / (2 * h)
            # h**2 lambda_5**3/3 = 2e-7, rounding 1e-16/h = 1e-11.
            assert slope(n)(xi) == pytest.approx(difference, abs=1e-6)


@pytest.mark.parametrize("n", [13, 30, 60, 200])
def test_high_modes_stay_bounded(n: int) -> None:
    """cosh(lambda_60) is 1e82; the mode never exceeds 2."""
    values = np.array([mode(n)(float(xi)) for xi in np.linspace(0.0, 1.0, 1013)])
    assert np.all(np.isfinite(values))
    # 2 at the ends, sqrt(2) between: the bound is theirs and 4e-16 lambda.
    assert np.max(np.abs(values)) <= 2.0 + 4e-16 * eigenvalue(n)
    assert np.max(np.abs(values[300:700])) > 1.4
