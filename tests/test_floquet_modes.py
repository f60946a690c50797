"""Modes against closed forms, simulation and the literature; growth against the other route."""

from typing import Any

import numpy as np
import pytest

from benchmarks.validation.literature import EXPONENTS, asymmetric_rotor, random_periodic
from compare.publications import find
from compare.report.row import equation as by_closed_form
from compare.report.row import witness
from floquet import floquet_modes, measured_growth, modal_content, monodromy, simulate
from hill import HillEquation, UniformBeam, characteristic

ROWS = {row.id: row for row in find("kincaid").all_rows()}
FLIPPED = ("T1-07", "T1-14", "T2-02", "T3-02b", "T3-04b", "T3-05b")
MANY = 2000


@pytest.mark.parametrize("name", EXPONENTS)
def test_exponents_of_the_literature(name: str) -> None:
    equation, known = EXPONENTS[name]
    modes = floquet_modes(equation)
    left = list(known)
    for value, error in zip(modes.exponents, modes.exponent_errors, strict=True):
        apart = [(value - k) / (1j * equation.Omega) for k in left]
        # up to whole multiples of i Omega
        off = [abs(a - round(a.real)) * equation.Omega for a in apart]
        best = int(np.argmin(off))
        assert off[best] <= error + 1e-14 * (1.0 + abs(value))
        left.pop(best)
    assert modes.multipliers == pytest.approx(np.exp(modes.exponents * equation.period), rel=1e-9)


def test_without_pulsation_modes_are_those_of_the_stiffness() -> None:
    """Frequencies beyond Omega/2 too, each coordinate's share that of an eigenvector's square."""
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=float("inf"), modes=2)
    equation = beam.equation(Omega=0.7, gamma=0.0)
    modes = floquet_modes(equation)
    squares, vectors = np.linalg.eig(equation.F)
    order = np.argsort(squares)
    w, shares = np.sqrt(squares[order]), np.abs(vectors[:, order].T) ** 2
    assert modes.exponents.imag == pytest.approx([s * x for x in w for s in (1, -1)], rel=1e-12)
    assert abs(modes.exponents.real).max() < 1e-12
    assert modes.frequencies == pytest.approx(np.repeat(beam.natural_frequencies(), 2), rel=1e-12)
    assert modes.participation == pytest.approx(np.repeat(shares, 2, axis=0), abs=1e-10)
    assert modes.harmonic_weights == pytest.approx(1.0)
    assert modes.branches.tolist() == [0, 0, 1, -1, 4, -4]


@pytest.mark.parametrize("name", ["T1-12", "T1-07", "T2-27", "T3-01b", "rotor", 2, 11])
def test_a_motion_in_one_mode_is_what_the_mode_says(name: Any) -> None:
    if isinstance(name, int):
        equation: Any = random_periodic(name, 6, 3.0)
    else:
        equation = asymmetric_rotor(0.1) if name == "rotor" else witness(ROWS[name], 2)
    modes = floquet_modes(equation)
    n, k = modes.shapes.shape[2], len(modes.tau)
    for i, exponent in enumerate(modes.exponents):
        s = simulate(equation, *modes.start(i), periods=2, samples=k)
        shape = np.tile(modes.shapes[i], (2, 1))
        said = (np.exp(exponent * s.tau[:-1])[:, None] * shape).real
        # what grows faster is begun by rounding and overtakes what decays
        size = np.max(np.abs(said)) + np.max(np.abs(np.exp(modes.exponents[0] * s.tau[-1])))
        assert np.max(np.abs(said - s.q[:-1])) < 1e-9 * size
        assert s.q.shape[1] == n
    assert np.mean(np.sum(np.abs(modes.shapes) ** 2, axis=2), axis=1) == pytest.approx(1.0)
    assert np.sum(modes.participation, axis=1) == pytest.approx(1.0)
    assert modes.shape_error_estimate.max() < 1e-7


def test_shapes_of_what_decays_by_sixty_powers_of_ten_are_known() -> None:
    """x'' + (24 + 10 sin t) x' + 10 cos t x = (x' + (24 + 10 sin t) x)'."""
    equation, _ = EXPONENTS["bittanti-colaneri"]
    modes = floquet_modes(equation, samples=100)
    # x' = -(24 + 10 sin t) x, so p = exp(10 cos t)
    p = np.exp(10.0 * np.cos(modes.tau))
    p /= np.sqrt(np.mean(p**2))
    assert modes.shapes[1, :, 0] == pytest.approx(p, abs=1e-9)


def test_the_branch_is_the_harmonic_with_the_most_weight() -> None:
    modes = floquet_modes(witness(ROWS["T3-01b"], 2))
    for i, shape in enumerate(modes.shapes):
        weights = np.sum(np.abs(np.fft.fft(shape, axis=0)) ** 2, axis=1)
        assert weights[0] >= (1.0 - 1e-8) * weights.max()
        assert modes.harmonic_weights[i] == pytest.approx(weights[0] / weights.sum())
        mean = shape.mean(axis=0)
        assert mean[np.argmax(np.abs(mean))].imag == pytest.approx(0.0, abs=1e-12)
    # real multipliers: as much of it turns one way as the other, and the positive one is named
    assert modes.exponents[0].imag == pytest.approx(ROWS["T3-01b"].Omega)
    assert np.iscomplexobj(modes.multipliers)
    assert modes.multipliers[0].imag == pytest.approx(0.0, abs=1e-9)


def test_modes_that_meet_are_not_told_apart_and_say_so() -> None:
    free = HillEquation(F=[[0.0]], G=[[0.0]], gamma=0.0, Omega=0.7)
    modes = floquet_modes(free)
    assert np.all(modes.shape_error_estimate > 1e-3)
    s = simulate(free, [1.0], [1.0], periods=10)
    with pytest.raises(ValueError, match="multipliers of its equation meet"):
        modal_content(s)


def unstable() -> list[str]:
    return [name for name, row in ROWS.items() if characteristic(by_closed_form(row, 2)).T > 0.0]


def test_measured_growth_is_T_on_every_unstable_row() -> None:
    """The time domain's history against the determinant's T; 7e-14 apart at most."""
    rows = unstable()
    assert len(rows) == 57
    for name in rows:
        equation = witness(ROWS[name], 2)
        s = simulate(equation, *floquet_modes(equation).start(0), periods=MANY, samples=1)
        assert bool(s.stopped) == (name == "T3-01b")
        found, T = measured_growth(s), characteristic(by_closed_form(ROWS[name], 2)).T
        assert pytest.approx(T, abs=1e-6) == found.T
        assert found.error_estimate < 1e-7


def test_growth_from_any_start_is_that_of_the_leading_mode_once_it_leads() -> None:
    equation = witness(ROWS["T1-12"], 2)
    n = equation.n
    s = simulate(equation, 0.01 * np.ones(n), np.zeros(n), periods=MANY, samples=1)
    assert pytest.approx(monodromy(equation).T, abs=1e-6) == measured_growth(s).T
    damped = HillEquation(F=[[1.0]], G=[[0.0]], gamma=0.0, Omega=0.9, eta=0.02)
    s = simulate(damped, [1.0], [0.0], periods=200, samples=1)
    assert pytest.approx(-0.02, abs=1e-9) == measured_growth(s).T


@pytest.mark.parametrize("name", FLIPPED)
def test_rows_that_print_calls_unstable_stay_bounded(name: str) -> None:
    row = ROWS[name]
    assert row.T > 0.001
    equation = witness(row, 2)
    modes = floquet_modes(equation)
    s = simulate(equation, *modes.start(), periods=MANY, samples=40)
    # each of three pairs alone is no larger than its shape
    largest = np.sum(np.max(np.abs(modes.shapes), axis=1)[modes.exponents.imag > 0.0], axis=0)
    assert np.all(np.max(np.abs(s.q) + s.errors, axis=0) <= largest * (1.0 + 1e-8))
    assert abs(measured_growth(s).T) < 1e-6
    # as printed it would have grown
    grown = np.exp(0.5 * row.T * s.tau[-1])
    assert np.max(np.abs(s.q[-400:])) < 2.0 * np.max(np.abs(s.q[:400])) < grown


def test_the_row_that_print_calls_stable_grows() -> None:
    equation = witness(ROWS["T2-27"], 2)
    assert ROWS["T2-27"].T == 0.0
    s = simulate(equation, *floquet_modes(equation).start(), periods=MANY, samples=40)
    assert np.max(np.abs(s.q[-400:])) > 1e3 * np.max(np.abs(s.q[:400]))


def test_content_is_what_the_motion_was_begun_with() -> None:
    equation = witness(ROWS["T1-12"], 2)
    modes = floquet_modes(equation)
    alone = modal_content(simulate(equation, *modes.start(4), periods=5))
    assert alone.shares == pytest.approx([0, 0, 0, 0, 0.5, 0.5], abs=1e-9)
    # a real motion of a pair has half of each
    assert alone.amplitudes[4:] == pytest.approx([0.5, 0.5], abs=1e-9)
    both = modal_content(simulate(equation, *modes.start(), periods=300), modes)
    assert both.amplitudes == pytest.approx(np.full(6, 0.5), abs=1e-9)
    assert both.last_shares == pytest.approx([0.5, 0.5, 0, 0, 0, 0], abs=1e-9)
    # growth by exp(2 pi 300 T/Omega) over the history: what leads has nearly all of it
    assert both.shares[:2] == pytest.approx([0.5, 0.5], abs=1e-9)
    assert both.coordinates == pytest.approx(modes.participation[0], abs=2e-3)
    assert np.sum(both.coordinates) == pytest.approx(1.0)


def test_content_over_a_short_history_is_the_mean_of_exponentials() -> None:
    equation = HillEquation(
        F=[[1.0, 0.0], [0.0, 4.0]],
        G=np.zeros((2, 2)),
        gamma=0.0,
        Omega=0.9,
        eta=[[0.02, 0.0], [0.0, 0.2]],
    )
    content = modal_content(simulate(equation, [1.0, 1.0], [0.0, 0.0], periods=3))
    x = np.array([0.02, 0.02, 0.2, 0.2]) * 3 * equation.period
    expected = (1.0 - np.exp(-x)) / x
    # starting amplitudes of cos: 1/2 and 1/2 but for the damping
    assert content.shares == pytest.approx(expected / expected.sum(), rel=0.01)
    assert np.all(np.diff(content.shares[[0, 2]]) < 0.0)


def test_bad_input() -> None:
    equation = HillEquation(F=[[1.0]], G=[[0.3]], gamma=0.1, Omega=0.9)
    for bad, says in ((0, "at least 1"), (1.5, "whole number"), (10**6, "at most 10,000")):
        with pytest.raises(ValueError, match=f"samples = .*{says}"):
            floquet_modes(equation, samples=bad)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="mode = 2: must be at most 1"):
        floquet_modes(equation).start(2)
    slow = HillEquation(F=[[1.0]], G=[[0.3]], gamma=0.1, Omega=1e-4)
    with pytest.raises(ValueError, match="radians a period, more than 10,000 samples tell"):
        floquet_modes(slow)
    s = simulate(equation, [0.0], [0.0], periods=20)
    with pytest.raises(ValueError, match="is at rest, nothing has a share"):
        modal_content(s)
    with pytest.raises(ValueError, match="is at rest, or decays to nothing"):
        measured_growth(s)
    with pytest.raises(ValueError, match="has 3 periods; growth is measured over 8"):
        measured_growth(simulate(equation, [1.0], [0.0], periods=3))
