"""Histories against closed forms and against powers of a monodromy matrix made of balls."""

import itertools
import re
from typing import Any

import numpy as np
import pytest
from flint import arb, arb_mat, ctx
from periodic_balls import reference

from benchmarks.routes.systems import system
from benchmarks.validation.literature import VINOGRAD, asymmetric_rotor
from floquet import Simulation, simulate
from hill import Fourier, HillEquation, PeriodicEquation

BITS = 200
MANY = 2000

# No error may be larger than its bound; none of these is a tenth of it, as docs/simulation.md says.
TRUE = 0.1


@pytest.fixture(autouse=True)
def _precise() -> Any:
    with ctx.workprec(BITS):
        yield


def distance(s: Simulation, k: int, true: list[arb]) -> tuple[float, float]:
    """How far a sample is off, over its bound and over its size."""
    found = np.concatenate([s.q[k], s.v[k]])
    bounds = np.concatenate([s.errors[k], s.v_errors[k]])
    off = np.array(
        [float(abs(arb(float(x)) - t).upper()) for x, t in zip(found, true, strict=True)]
    )
    size = max(float(abs(t).mid()) for t in true) or 1.0
    return float(np.max(off / bounds)), float(np.max(bounds)) / size


def sampled(s: Simulation, step: int = 7) -> range:
    """Samples of all phases, from the first that is computed to the last."""
    assert np.gcd(step, s.samples) == 1
    return range(1, len(s.tau), step)


def time(s: Simulation, k: int) -> arb:
    return 2 * arb.pi() / arb(s.source.Omega) * k / s.samples


def exact(matrix: Any) -> arb_mat:
    return arb_mat([[arb(float(x)) for x in row] for row in np.atleast_2d(matrix)])


@pytest.mark.parametrize(
    ("F", "eta"),
    [(1.3, 0.0), (1.3, 0.1), (1.3, -0.0015), (-0.0001, 0.0), (-0.0002, 1.5)],
    ids=["cos", "damped", "growing", "cosh", "creeping"],
)
def test_one_coordinate_without_pulsation_stays_within_its_bound(F: float, eta: float) -> None:
    equation = HillEquation(F=[[F]], G=[[0.7]], gamma=0.0, Omega=0.9, eta=eta)
    s = simulate(equation, [0.8], [-0.3], periods=MANY, samples=4)
    assert (s.periods, s.stopped, len(s.tau)) == (MANY, "", 4 * MANY + 1)
    half = arb(eta) / 2
    square = arb(F) - half * half
    for k in sampled(s):
        t = time(s, k)
        if square > 0:
            w = square.sqrt()
            c, u = (w * t).cos(), (w * t).sin() / w
        else:
            w = (-square).sqrt()
            c, u = (w * t).cosh(), (w * t).sinh() / w
        a, b = arb(0.8), arb(-0.3) + half * arb(0.8)
        y, dy = a * c + b * u, -a * square * u + b * c
        decay = (-half * t).exp()
        share, wide = distance(s, k, [decay * y, decay * (dy - half * y)])
        assert share <= TRUE
        # 1e-8 over 2,000 periods; of what has decayed no more is known than of its start
        assert wide < 1e-7 or eta > 0.0


def test_what_the_integration_of_a_long_period_loses_is_in_the_bound() -> None:
    """Two thousand radians in one: what the products alone may lose would not cover it."""
    equation = HillEquation(F=[[1.3]], G=[[0.7]], gamma=0.0, Omega=0.0035)
    s = simulate(equation, [0.8], [-0.3], periods=3, samples=7)
    w = arb(1.3).sqrt()
    a, b = arb(0.8), arb(-0.3)
    lost = []
    for k in range(1, len(s.tau)):
        c, u = (w * time(s, k)).cos(), (w * time(s, k)).sin()
        true = [a * c + b / w * u, b * c - a * w * u]
        share, wide = distance(s, k, true)
        assert share <= TRUE
        assert wide < 1e-8
        lost.append(share * wide)
    # nor could so much be within bounds of an integration without error
    assert max(lost) > 100.0 * np.finfo(float).eps


def test_a_free_body_and_a_chain_of_them_grow_by_powers_of_time() -> None:
    """One eigenvector for two and for four multipliers at 1."""
    one = simulate(
        HillEquation(F=[[0.0]], G=[[0.0]], gamma=0.0, Omega=0.7), [1.0], [2.0], periods=MANY
    )
    chain = HillEquation(F=[[0.0, 1.0], [0.0, 0.0]], G=np.zeros((2, 2)), gamma=0.0, Omega=0.7)
    two = simulate(chain, [1.0, 0.5], [2.0, 1.0], periods=MANY, samples=3)
    for k in sampled(one):
        share, wide = distance(one, k, [1 + 2 * time(one, k), arb(2)])
        assert share <= TRUE
        assert wide < 1e-6
    for k in sampled(two):
        t = time(two, k)
        q = [1 + 2 * t - t * t / 4 - t**3 / 6, t / 1 + arb(0.5)]
        share, wide = distance(two, k, [*q, 2 - t / 2 - t * t / 2, arb(1)])
        assert share <= TRUE
        assert wide < 1e-6


def turned(angle: arb) -> arb_mat:
    s, c = angle.sin_cos()
    return arb_mat([[c, -s], [s, c]])


def test_a_rotor_in_turning_coordinates_is_one_with_constant_ones() -> None:
    """The asymmetric rotor seen from the frame that turns with it, at the speed 1."""
    rotor = asymmetric_rotor()
    s = simulate(rotor, [0.3, -0.2], [0.1, 0.4], periods=300, samples=5)
    # q = R r: r'' + 2 J r' + (diag(1.2, 0.8) - 1) r = 0
    A = exact([[0, 0, 1, 0], [0, 0, 0, 1], [0, 0, 0, 2], [0, 0, -2, 0]])
    with ctx.workprec(BITS):
        A[2, 0], A[3, 1] = 1 - (1 + arb(0.2)), 1 - (1 - arb(0.2))
    J = exact([[0, -1], [1, 0]])
    start = exact([[0.3], [-0.2], [0.1], [0.4]])
    q0, v0 = start.tolist()[:2], start.tolist()[2:]
    state = arb_mat(q0 + (arb_mat(v0) - J * arb_mat(q0)).tolist())
    for k in sampled(s):
        t = time(s, k)
        found = ((A * t).exp() * state).tolist()
        r, dr = arb_mat(found[:2]), arb_mat(found[2:])
        R = turned(t)
        q, v = R * r, R * (dr + J * r)
        share, wide = distance(s, k, [row[0] for row in q.tolist() + v.tolist()])
        assert share <= TRUE
        assert wide < 1e-8


@pytest.mark.parametrize("half", [1.1, 1.6], ids=["stable", "unstable"])
def test_meissners_equation_half_by_half(half: float) -> None:
    """q'' + 1.5 q = 0 and q'' + .5 q = 0 by turns: no Fourier sum, but each half is a period.

    E. Meissner's closed form, of which the trace over both halves decides.
    """
    halves = [HillEquation([[a]], [[0.0]], 0.0, 2.0 * np.pi / half) for a in (1.5, 0.5)]
    Phi = [by_cosines(e) for e in halves]
    both = Phi[1] * Phi[0]
    grows = bool(abs(both[0, 0] + both[1, 1]) > 2)
    assert grows == (half == 1.6)
    true, found = arb_mat([[1], [0]]), np.array([1.0, 0.0])
    since: list[tuple[arb_mat, np.ndarray]] = []
    for k in range(60):
        s = simulate(halves[k % 2], found[:1], found[1:], periods=1, samples=1)
        found = np.concatenate([s.q[-1], s.v[-1]])
        true = Phi[k % 2] * true
        # an error of one half goes on as the motion does
        since = [(Phi[k % 2] * P, e) for P, e in since]
        since.append((arb_mat([[1, 0], [0, 1]]), np.concatenate([s.errors[-1], s.v_errors[-1]])))
        bound = np.sum([upper_moduli(P) @ e for P, e in since], axis=0)
        off = [float(abs(arb(float(x)) - true[i, 0]).upper()) for i, x in enumerate(found)]
        assert np.all(off <= bound)
    # measured 7e-12 and 6e-12
    assert np.max(bound) < 1e-10 * max(1.0, np.max(np.abs(found)))
    assert (np.max(np.abs(found)) > 1e3) == grows


def upper_moduli(P: arb_mat) -> np.ndarray:
    return np.array([[float(abs(x).upper()) for x in row] for row in P.tolist()])


def by_cosines(e: HillEquation) -> arb_mat:
    """The fundamental matrix of q'' + F q = 0 over the equation's period."""
    w = arb(float(e.F[0, 0])).sqrt()
    c, s = (w * 2 * arb.pi() / arb(e.Omega)).cos(), (w * 2 * arb.pi() / arb(e.Omega)).sin()
    return arb_mat([[c, s / w], [-w * s, c]])


def test_an_equation_of_first_order_has_no_velocities() -> None:
    """Vinograd's: turned by 6 t it is constant; it grows by exp(2 t), stable as it looks."""
    s = simulate(VINOGRAD, [1.0, 0.5], periods=300, samples=5)
    assert s.v.shape == s.v_errors.shape == (1501, 0)
    # x = R(-6 t) y, y' = (A(0) - B) y with x' = -6 J x of the frame
    A, J = exact([[-10.0, 12.0], [0.0, -1.0]]), exact([[0, -1], [1, 0]])
    C = A + J * arb(6)
    for k in sampled(s):
        t = time(s, k)
        x = turned(-6 * t) * ((C * t).exp() * exact([[1.0], [0.5]]))
        share, wide = distance(s, k, [row[0] for row in x.tolist()])
        assert share <= TRUE
        assert wide < 1e-8


# Of each kind one whose reference takes a fraction of a second; growth, decay and neither.
SYSTEMS = {
    "one harmonic": 3, "sines": 12, "gyroscopic": 2, "pulsating damping": 8, "mass matrix": 10,
    "negative damping": 11, "first order": 10, "first order, strong damping": 7,
    "proportional damping": 11, "conservative": 11, "Hamilton": 1, "reversible": 10,
    "reversible, first order": 4, "all at once": 2,
}  # fmt: skip


@pytest.mark.parametrize("kind", SYSTEMS)
def test_any_equation_once_a_period_against_balls(kind: str) -> None:
    seed = SYSTEMS[kind]
    equation = system(kind, seed)
    Phi = centres(arb_mat(reference(equation, work=3e6)[1]))
    rng = np.random.default_rng(seed)
    m = equation.order
    x = rng.standard_normal(m)
    parts = (x,) if equation.A is not None else (x[: m // 2], x[m // 2 :])
    s = simulate(equation, *parts, periods=MANY, samples=1)
    fine = simulate(equation, *parts, periods=1, samples=9)
    state = exact(x[:, None])
    # known to 30 digits, that is to 1e-27 after so many periods; the balls of a product would grow
    for k in range(1, s.periods + 1):
        state = centres(Phi * state)
        if k % 97 == 1 or k == s.periods:
            true = [row[0] for row in state.tolist()]
            assert distance(s, k, true)[0] <= TRUE
            if k == 1:
                assert distance(fine, 9, true)[0] <= TRUE


def centres(matrix: arb_mat) -> arb_mat:
    return arb_mat([[x.mid() for x in row] for row in matrix.tolist()])


def test_samples_of_different_grids_agree_within_their_bounds() -> None:
    equation = HillEquation(
        F=[[1.0, 0.3], [-0.2, 4.0]], G=[[0.5, 0.1], [0.2, -0.4]], gamma=0.4, Omega=0.3, eta=0.02
    )
    fine = simulate(equation, [1.0, 0.0], [0.0, 1.0], periods=30, samples=280)
    for samples in (1, 2, 7, 40):
        s, step = simulate(equation, [1, 0], [0, 1], periods=30, samples=samples), 280 // samples
        assert np.all(np.abs(s.q - fine.q[::step]) <= s.errors + fine.errors[::step])
        assert np.all(np.abs(s.v - fine.v[::step]) <= s.v_errors + fine.v_errors[::step])
        assert s.tau == pytest.approx(fine.tau[::step], rel=1e-15)


def test_a_million_periods_are_twenty_squarings() -> None:
    equation = HillEquation(F=[[1.3]], G=[[0.7]], gamma=0.0, Omega=0.9)
    s = simulate(equation, [1.0], [0.0], periods=1_000_000, samples=1)
    assert s.q.shape == (1_000_001, 1)
    w = arb(1.3).sqrt()
    for k in (1, 999, 524_288, 1_000_000):
        t = time(s, k)
        share, wide = distance(s, k, [(w * t).cos(), -w * (w * t).sin()])
        assert share <= TRUE
        assert wide < 1e-5


def test_a_motion_beyond_a_float_stops_and_says_so() -> None:
    equation = HillEquation(F=[[-1.0]], G=[[0.0]], gamma=0.0, Omega=0.9)
    s = simulate(equation, [1.0], [1.0], periods=500, samples=3)
    # exp(2 pi/.9 k) is a float up to k = 101
    assert s.periods == 101
    assert s.stopped == (
        "stopped after 101 of 500 periods: the motion exceeds what a float can hold"
    )
    assert len(s.tau) == len(s.q) == len(s.v) == len(s.error) == 304
    assert np.all(np.isfinite(s.q))
    assert np.all(np.isfinite(s.v))
    far = HillEquation(F=[[-1e6]], G=[[0.0]], gamma=0.0, Omega=1.0)
    with pytest.raises(OverflowError, match="within one period"):
        simulate(far, [1.0], [0.0])
    with pytest.raises(OverflowError, match=r"q0, v0.*within one period"):
        simulate(equation, [1e307], [1e307])


def test_history_begins_where_it_is_told_and_scales_with_it() -> None:
    equation = HillEquation(F=[[1.3]], G=[[0.7]], gamma=0.3, Omega=0.9)
    s = simulate(equation, [0.7], [-0.1], periods=5, samples=3)
    assert (s.q[0, 0], s.v[0, 0], s.error[0]) == (0.7, -0.1, 0.0)
    large = simulate(equation, [0.7 * 2.0**70], [-0.1 * 2.0**70], periods=5, samples=3)
    assert np.array_equal(large.q, s.q * 2.0**70)
    still = simulate(equation, [0.0], [0.0], periods=5, samples=3)
    assert not np.any(still.q)
    assert not np.any(still.v)
    with pytest.raises(ValueError, match="read-only"):
        s.q[0, 0] = 1.0


EQUATION = HillEquation(F=np.eye(2), G=np.eye(2), gamma=0.1, Omega=1.0)
GOOD: dict[str, Any] = {"q0": [0.0, 1.0], "v0": [0.0, 0.0]}


@pytest.mark.parametrize(
    ("bad", "says"),
    [
        ({"q0": [1.0]}, "q0 has shape (1,): must be (2,)"),
        ({"q0": [[1.0, 2.0]]}, "q0 has shape (1, 2): must be (2,)"),
        ({"q0": 1.0}, "q0 has shape (): must be (2,)"),
        ({"q0": [0.0, np.nan]}, "q0[1] = nan: every element must be finite"),
        ({"v0": [np.inf, 0.0]}, "v0[0] = inf: every element must be finite"),
        ({"v0": [1j, 0.0]}, "v0: must be a vector of real numbers"),
        ({"v0": ["a", "b"]}, "v0: must be a vector of real numbers"),
        ({"v0": [True, False]}, "v0: must be a vector of real numbers"),
        ({"v0": [[1.0], [1.0, 2.0]]}, "v0: must be a vector of real numbers"),
        ({"v0": None}, "v0: has no value; an equation of second order needs 2 velocities"),
        ({"periods": 0}, "periods = 0: must be at least 1"),
        ({"periods": -3}, "periods = -3: must be at least 1"),
        ({"periods": 2.5}, "periods = 2.5: must be a whole number"),
        ({"periods": True}, "periods = True: must be a whole number"),
        ({"periods": 10**9}, "periods = 1000000000: must be at most 100,000,000"),
        ({"samples": 0}, "samples = 0: must be at least 1"),
        ({"samples": float("nan")}, "samples = nan: must be a whole number"),
        ({"samples": 10**6}, "samples = 1000000: must be at most 10,000"),
        (
            {"periods": 10**7, "samples": 100},
            "periods = 10000000, samples = 100: a history of 4 values a sample would have more "
            "than 50,000,000 numbers; take fewer of either",
        ),
    ],
    ids=itertools.count(),
)
def test_bad_input_is_one_line_before_the_work(bad: dict[str, Any], says: str) -> None:
    with pytest.raises(ValueError, match=re.escape(says) + "$"):
        simulate(EQUATION, **{**GOOD, **bad})


def test_wrong_kinds_of_equation() -> None:
    with pytest.raises(ValueError, match="equation: is of type function; must be a HillEquation"):
        simulate(lambda t: t, [1.0], [0.0])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="v0: an equation of first order has no velocities"):
        simulate(VINOGRAD, [1.0, 0.0], [0.0, 0.0])
    both = PeriodicEquation(K=Fourier([[1.0]], sin={2: [[0.2]]}), M=[[2.0]], Omega=1.0)
    with pytest.raises(ValueError, match=re.escape("q0 has shape (2,): must be (1,)")):
        simulate(both, [1.0, 0.0], [0.0])
