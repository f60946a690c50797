"""The arbiter against closed forms, against itself by other means, and its bounds by themselves."""

from typing import Any

import numpy as np
import pytest
from flint import arb, arb_mat, ctx
from scipy.linalg import eigh_tridiagonal
from systems import SPECIAL, random_system

from benchmarks.honesty import arbiter, systems, trial
from benchmarks.honesty.slopes import slopes
from floquet.enclosure import steps
from floquet.enclosure.balls import exact, problem
from floquet.enclosure.series import first_block
from hill import HillEquation

PAIR = ([[2.0, 0.3], [0.2, 1.0]], [[1.0, 2.0], [3.0, 1.0]])
MATRIX = [[0.1, 0.5], [-0.5, 0.2]]


def contains(balls: Any, narrow: Any) -> bool:
    """Whether each ball holds all of the narrower one."""
    pairs = zip(balls.tolist(), narrow.tolist(), strict=True)
    return all(a.contains(b) for one, other in pairs for a, b in zip(one, other, strict=True))


def overlap(one: list[Any], other: list[Any]) -> bool:
    return all(a.overlaps(b) for a, b in zip(one, other, strict=True))


# ---- closed forms --------------------------------------------------------------------------------


def test_constant_coefficients() -> None:
    """z = cos(2 pi w/Omega), w^2 = F - eta^2/4."""
    w = np.array([0.7, 1.9])
    equation = HillEquation(np.diag(w**2), np.eye(2), 0.0, 1.3)
    truth = arbiter.reference(equation)
    expected = np.poly(np.cos(2.0 * np.pi * w / 1.3))
    # the squares and the cosines are rounded: ten ulps of w^2 and of z
    assert arbiter.largest_error(expected, truth) < 1e-14


def test_forty_digits() -> None:
    """P = z - cos(2 pi w/Omega) to the last of them, and in a ball that is as narrow."""
    constant = arbiter.reference(HillEquation([[2.0]], [[1.0]], 0.0, 1.3))[1]
    with ctx.workprec(600):
        expected = -(2 * arb.pi() * arb(2.0).sqrt() / arb(1.3)).cos()
        assert constant.contains(expected)
        assert float(constant.rad()) < 1e-42


def test_mathieu() -> None:
    """At a characteristic value a_0(q) of x'' + (a - 2 q cos 2t) x = 0 z is 1."""
    q, size = 3.0, 40
    # Fourier's matrix of the even solutions of period pi, made symmetric
    off = np.full(size - 1, q)
    off[0] *= np.sqrt(2.0)
    a = eigh_tridiagonal((2.0 * np.arange(size)) ** 2, off, eigvals_only=True)[0]
    truth = arbiter.reference(HillEquation([[a]], [[1.0]], -2.0 * q, 2.0))
    # dz/da is 18 there, and a is known to 2e-14
    assert arbiter.largest_error([1.0, -1.0], truth) < 1e-12


def test_a_damping_matrix_without_pulsation() -> None:
    """The monodromy matrix is the exponential of a matrix."""
    F, C, Omega = [[2.0, 0.3], [0.2, 1.0]], MATRIX, 1.3
    first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.array(F), -np.array(C)]])
    found = arbiter.reference(HillEquation(F, np.eye(2), 0.0, Omega, C))
    with ctx.workprec(600):
        Phi: arb_mat = (exact(first_order) * (2 * arb.pi() / arb(Omega))).exp()
        expected = Phi.charpoly().coeffs()[::-1]
        assert all(p.contains(q) for p, q in zip(found, expected, strict=True))
        assert max(float(p.rad()) for p in found) < 1e-42


def test_a_damping_matrix_that_is_a_number() -> None:
    """T through z and T through the multipliers: by the series, and by Taylor steps."""
    equation = systems.members("ordinary", 3, 1)[0]
    e = HillEquation(equation.F, equation.G, equation.gamma, equation.Omega, 0.2)
    same = HillEquation(e.F, e.G, e.gamma, e.Omega, 0.2 * np.eye(e.n))
    series, stepped = trial.truth(e).growth, trial.truth(same).growth
    assert series is not None
    assert stepped is not None
    assert series.T.overlaps(stepped.T)
    assert series.truth == stepped.truth


# ---- by other means ------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["ordinary", "growth", "nonnormal", "damping matrices"])
def test_twice_the_work_says_the_same(kind: str) -> None:
    equation = systems.members(kind, 3, 1)[0]
    assert overlap(arbiter.reference(equation), arbiter.reference(equation, refine=2))


@pytest.mark.parametrize("kind", ["ordinary", "growth", "harmonics", "mixed scales"])
def test_the_series_and_the_steps_agree(kind: str) -> None:
    """A power series that uses every symmetry, and steps that use none."""
    equation = systems.members(kind, 6, 1)[0]
    with ctx.workprec(400):
        given = problem(equation)
        A, Phi = first_block(given), steps.monodromy(given)
        n = equation.n
        assert overlap(A.entries(), arb_mat([r[:n] for r in Phi.tolist()[:n]]).entries())


@pytest.mark.parametrize("name", ["w = 1/2", "defective F", "report's beam", "seed 9"])
def test_the_balls_are_as_narrow_as_asked(name: str) -> None:
    equation = SPECIAL[name] if name in SPECIAL else random_system(int(name.split()[1]))
    P, finer = (arbiter.reference(equation, narrow=bits) for bits in (160, 320))
    size = max(float(p.abs_upper()) for p in P)
    assert max(float(p.rad()) for p in P) < 2.0**-160 * size
    assert all(p.contains(q) for p, q in zip(P, finer, strict=True))


# ---- what the steps leave out --------------------------------------------------------------------


@pytest.mark.parametrize("order", [6, 12, 30])
@pytest.mark.parametrize("kind", ["damping matrices", "harmonics", "growth"])
def test_what_a_step_leaves_out_is_bounded(kind: str, order: int) -> None:
    """A step cut off early, with its balls, holds the step that is not."""
    for group in range(3):
        with ctx.workprec(400):
            given = problem(systems.members(kind, 8, group)[0])
            fine = steps._plan(given, 8)
            h = 2 * arb.pi() / fine.steps
            plan = steps.Plan(order, fine.steps, fine.R, fine.rho)
            left = steps._remainder(given, plan, h)
            cut = steps._step(given, order, h, 3)
            true = steps._step(given, fine.order, h, 3) + steps._remainder(given, fine, h)
            assert contains(cut + left, true)
            # and it does leave something out
            assert not contains(cut, true)


SKEW = np.array([[0.0, 0.4], [-0.4, 0.0]])


@pytest.mark.parametrize(
    ("equation", "truth"),
    [
        (HillEquation([[1.7]], [[1.0]], 0.1, 2.1, np.zeros((1, 1))), "stable"),
        (HillEquation(np.diag([1.0, 2.3]), [[1.0, 0.2], [0.2, -1.0]], 0.1, 1.37, SKEW), "boundary"),
    ],
    ids=["none", "gyroscopic"],
)
def test_what_truncation_leaves_is_no_verdict(equation: HillEquation, truth: str) -> None:
    """Reversible, with all multipliers on the circle: T is 0, the series only near it.

    Without damping they come in pairs, so that simple ones on the circle stay there.
    """
    found = trial.truth(equation).growth
    assert found is not None
    assert found.truth == truth
    assert found.T.contains(0)


# ---- derivatives ---------------------------------------------------------------------------------

STEP = 2.0**-40
DIRECTIONS: dict[str, dict[str, Any]] = {
    "Omega": {"Omega": 1.0},
    "gamma": {"gamma": -1.0},
    "eta": {"eta": 1.0},
    "F": {"F": [[1.0, -1.0], [0.5, 2.0]]},
    "G": {"G": [[0.5, 1.0], [1.0, -1.0]]},
    "H": {"H": [[[1.0, 1.0], [0.0, 1.0]]]},
}
MOVED = {
    "number": HillEquation(*PAIR, 0.3, 2.4, 0.05, [[[0.1, 0.2], [0.0, 0.3]]], 4.8),
    "matrix": HillEquation(*PAIR, 0.3, 1.3, MATRIX, [[[0.1, 0.2], [0.0, 0.3]]], 2.6),
}


def there(e: HillEquation, direction: dict[str, Any], sign: int) -> HillEquation:
    """The equation moved by STEP, which is exact; omega_L keeps its ratio to Omega."""
    at = {name: np.asarray(vars(e)[name], float) for name in DIRECTIONS}
    for name, weight in direction.items():
        at[name] = at[name] + sign * STEP * np.asarray(weight)
    Omega, eta = float(at["Omega"]), at["eta"] if at["eta"].ndim else float(at["eta"])
    H = list(at["H"])
    return HillEquation(at["F"], at["G"], float(at["gamma"]), Omega, eta, H, e.ratio * Omega)


@pytest.mark.parametrize("name", DIRECTIONS)
@pytest.mark.parametrize("damping", MOVED)
def test_derivatives_are_those_of_the_values(name: str, damping: str) -> None:
    """Central differences: off by STEP^2 = 1e-24 times a third derivative."""
    e, direction = MOVED[damping], DIRECTIONS[name]
    if name == "eta" and damping == "matrix":
        direction = {"eta": [[1.0, 0.5], [-1.0, 1.0]]}
    found = slopes(e, direction)
    up, down = (trial.truth(there(e, direction, sign)) for sign in (1, -1))
    assert up.growth is not None
    assert down.growth is not None
    with ctx.workprec(400):
        dT = (up.growth.T - down.growth.T) / (2.0 * STEP)
        assert found.dT is not None
        assert abs(float(found.dT - dT)) < 1e-20
        assert abs(float(dT)) > 1e-3


@pytest.mark.parametrize(
    "equation",
    [
        HillEquation(np.diag([1.0, 1.0]), np.eye(2), 0.1, 1.3),  # two z are one
        HillEquation([[1.0]], [[1.0]], 0.0, 2.0),  # at z = -1
    ],
    ids=["double root", "edge"],
)
def test_no_derivative_where_there_is_none(equation: HillEquation) -> None:
    assert slopes(equation, {"F": np.eye(equation.n)}).dT is None
