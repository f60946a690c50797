"""Enclosures: both routes' balls meet, hold what is known, and wrong bounds are caught."""

from fractions import Fraction
from math import inf
from typing import Any

import numpy as np
import pytest
from flint import acb, arb, ctx
from systems import random_system

import floquet
import hill
from compare.report.row import TERMS
from compare.report.tables import Row, all_rows
from floquet.enclosure import beams as of_time
from floquet.enclosure import steps
from hill import HillEquation, LongitudinalResonance, SteppedBeam, UniformBeam
from hill.decimals import exact_beam, fraction
from hill.enclosure import beams as closed
from hill.enclosure import polynomial as folded
from hill.enclosure import tail
from hill.enclosure.rows import floats, number, rows

ROWS = {row.id: row for row in all_rows()}

# The uniform and the stepped beam, a verdict that print has wrong each way, an elastic bar.
SAMPLE = ("T1-01", "T1-07", "T2-02", "T2-27", "T3-01a")


def forcing(row: Row) -> dict[str, Any]:
    terms = TERMS if row.initial_conditions else 0
    ratio = 2 if row.table == 3 else None
    return {"Omega": row.Omega, "gamma": row.gamma, "initial_terms": terms, "ratio": ratio}


def meet(one: Any, other: Any) -> bool:
    pairs = zip(one.polynomial, other.polynomial, strict=True)
    return all(a.overlaps(b) for a, b in pairs) and bool(one.T.overlaps(other.T))


# ---- the two routes meet -------------------------------------------------------------------------


@pytest.mark.parametrize("name", SAMPLE)
def test_rows_meet_from_the_decimals_on(name: str) -> None:
    row = ROWS[name]
    by_time = floquet.enclose(row.beam(2), **forcing(row))
    by_determinant = hill.enclose(row.beam(2), **forcing(row))
    assert meet(by_time, by_determinant)
    assert by_time.decimals
    assert by_determinant.decimals
    # 140 and 100 bits were asked for, of coefficients of about 1
    assert by_time.radius < 1e-40
    assert by_determinant.radius < 1e-28
    assert by_time.verdict == by_determinant.verdict != "undecided"


def test_many_terms_of_an_elastic_bar() -> None:
    """Ten harmonics in a group, as T3-01b has, here with fewer digits."""
    row = ROWS["T3-03b"]
    few = forcing(row) | {"initial_terms": 2}
    by_determinant = hill.enclose(row.beam(2), **few, bits=40)
    assert meet(floquet.enclose(row.beam(2), **few), by_determinant)
    assert by_determinant.radius < 1e-10


# Many coordinates with many harmonics take a minute; those are `python -m benchmarks.enclosures`'s.
@pytest.mark.parametrize("seed", [s for s in range(40) if s % 8 < 5 and s not in (28, 35, 36)])
def test_random_systems_meet(seed: int) -> None:
    e = random_system(seed)
    by_time, by_determinant = floquet.enclose(e), hill.enclose(e, bits=60)
    assert meet(by_time, by_determinant)
    size = max(abs(float(c)) for c in by_time.polynomial)
    assert by_determinant.radius < 2.0**-60 * size
    assert not by_time.decimals


def test_the_matrices_meet_and_are_those_of_the_floats() -> None:
    """Closed forms against rigorous quadrature: a damped bar, a stepped elastic one."""
    common = {"T0": 12.5, "K_theta": 0.3, "xi_G": 0.4, "omega_L": 3.7, "modes": 3}
    damped = UniformBeam(**common, g=0.05)  # type: ignore[arg-type]
    stepped = SteppedBeam(**common, xi_c=0.35, area_ratio=0.7, inertia_ratio=1.4)  # type: ignore[arg-type]
    for beam in (damped, stepped):
        given, _ = exact_beam(beam, 1.1, 0.2)
        equation = beam.equation(1.1, 0.2)
        one, other = closed.matrices(given, 200), of_time.matrices(given, 200)
        for a, b, known in zip(one[:2], other[:2], (equation.F, equation.G), strict=True):
            assert all(p.overlaps(q) for p, q in zip(a.entries(), b.entries(), strict=True))
            assert max(float(p.rad()) for p in (*a.entries(), *b.entries())) < 1e-45
            middle = np.array([float(p) for p in a.entries()]).reshape(known.shape)
            assert np.abs(middle - known).max() < 1e-13 * np.abs(known).max()


# ---- what is known otherwise ---------------------------------------------------------------------


def test_constant_coefficients() -> None:
    """z = cos(2 pi w/Omega): a determinant that is a product of sines, and its tail."""
    e = HillEquation(np.diag([2.0, 5.0]), np.zeros((2, 2)), 0.0, 1.25)
    for found in (hill.enclose(e), floquet.enclose(e)):
        with ctx.workprec(300):
            z = [(2 * arb.pi() * arb(f).sqrt() / arb(1.25)).cos() for f in (2.0, 5.0)]
            expected = [arb(1), -(z[0] + z[1]), z[0] * z[1]]
            assert all(p.contains(q) for p, q in zip(found.polynomial, expected, strict=True))


def test_the_tail_is_the_product_of_its_groups() -> None:
    """Against a thousand groups folded one by one, and what is beyond them by the same series."""
    F, G = [[2.0, 0.3], [0.2, 1.0]], [[1.0, 2.0], [3.0, 1.0]]
    with ctx.workprec(128):
        system = rows(floats(F), {1: floats(G), 2: floats(G)}, number(0.8), arb(0))
        known = tail.tail(system, 60)
        U, L = system.between(2, 1)
        x = acb(known.start, 0.3) + 0.25
        beyond = x + 2 * 1000
        S, direct = tail.eliminated(system, beyond, 5), tail.logarithm(known, 2, beyond)
        for k in range(999, -1, -1):
            harmonics = tail.group(system, x + 2 * k)
            S = system.block(harmonics) - U * S.inv() * L
            direct += tail.divided(system, S, harmonics).log()
        series = tail.logarithm(known, 2, x)
        assert series.overlaps(direct)
        assert float(series.real.rad()) < 1e-17


def test_a_verdict_on_the_edge_is_undecided() -> None:
    """Omega = 1, F = 1/4: z = -1 exactly, which no ball tells from its neighbours."""
    e = HillEquation([[0.25]], [[1.0]], 0.0, 1.0)
    for found in (hill.enclose(e), floquet.enclose(e)):
        assert found.verdict == "undecided"
        assert found.T.contains(0)


def test_two_roots_that_meet_within_are_undecided() -> None:
    e = HillEquation(np.diag([2.0, 2.0]), np.zeros((2, 2)), 0.0, 1.25)
    for found in (hill.enclose(e), floquet.enclose(e)):
        assert found.verdict == "undecided"
        assert found.T.contains(0)


def test_a_decimal_is_no_float() -> None:
    """1/10 and its nearest float are told apart, by both routes."""
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
    for enclose in (floquet.enclose, hill.enclose):
        one = enclose(beam, Omega="0.4", gamma=0.1)
        other = enclose(beam, Omega="0.4", gamma=Fraction(0.1))
        assert not all(a.overlaps(b) for a, b in zip(one.polynomial, other.polynomial, strict=True))
    assert fraction("gamma", 0.1) == fraction("gamma", "0.1") == Fraction(1, 10)


# ---- wrong bounds are caught ---------------------------------------------------------------------


def test_a_wrong_remainder_of_the_steps_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few terms a step: with the bound balls are wide and right, without narrow and wrong."""
    e = HillEquation([[2.0, 0.3], [0.2, 1.0]], [[1.0, 2.0], [3.0, 1.0]], 0.4, 1.3, np.eye(2) * 0.1)
    true = floquet.enclose(e)
    plan = steps.Plan(order=16, steps=40, R=2.0, rho=1.5)
    monkeypatch.setattr(steps, "_plan", lambda *_: plan)
    honest = floquet.enclose(e, bits=15)
    assert all(a.overlaps(b) for a, b in zip(honest.polynomial, true.polynomial, strict=True))
    monkeypatch.setattr(steps, "_remainder", lambda problem, plan, h: of_zeros(2 * problem.n))
    wrong = floquet.enclose(e, bits=15)
    assert not all(a.overlaps(b) for a, b in zip(wrong.polynomial, true.polynomial, strict=True))


def of_zeros(n: int) -> Any:
    from flint import arb_mat

    return arb_mat(n, n)


@pytest.mark.parametrize("wrong", ["no steps", "short series"])
def test_a_wrong_tail_of_the_determinant_is_caught(
    wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Either the routes' balls no longer meet, or Liouville's theorem fails."""
    e = random_system(3)
    true = floquet.enclose(e)
    if wrong == "no steps":
        monkeypatch.setattr(tail, "_steps_left_out", lambda *_: (arb(0), arb(0)))
    else:
        whole = tail._coefficients
        monkeypatch.setattr(tail, "_coefficients", lambda *a: whole(*a)[:6])

    def compared() -> None:
        found = hill.enclose(e, bits=60)
        pairs = zip(found.polynomial, true.polynomial, strict=True)
        assert all(a.overlaps(b) for a, b in pairs), "apart"

    with pytest.raises(AssertionError, match=r"Liouville|apart"):
        compared()


# ---- refusals ------------------------------------------------------------------------------------

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
ELASTIC = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=1.5)


@pytest.mark.parametrize("enclose", [floquet.enclose, hill.enclose])
@pytest.mark.parametrize(
    ("what", "given", "words"),
    [
        (BEAM, {"gamma": 0.1}, "Omega: must be given"),
        (BEAM, {"Omega": "x", "gamma": 0.1}, "Omega = 'x': must be a decimal number"),
        (BEAM, {"Omega": -1.0, "gamma": 0.1}, "Omega = -1.0: must be > 0"),
        (BEAM, {"Omega": 1.0, "gamma": inf}, "gamma = inf"),
        (BEAM, {"Omega": 1.0, "gamma": 0.1, "initial_terms": 2}, "initial_terms = 2: needs"),
        (ELASTIC, {"Omega": 1.1, "gamma": 0.1, "initial_terms": 2}, "15/11"),
        (random_system(1), {"Omega": 1.0}, "an equation has its own"),
        ("beam", {"Omega": 1.0, "gamma": 0.1}, "str: must be a HillEquation"),
    ],
)
def test_refusals(enclose: Any, what: Any, given: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        enclose(what, **given)


@pytest.mark.parametrize("enclose", [floquet.enclose, hill.enclose])
def test_a_longitudinal_resonance_is_refused(enclose: Any) -> None:
    with pytest.raises(LongitudinalResonance):
        enclose(ELASTIC, Omega=3.0, gamma=0.1)


def test_a_damping_matrix_has_no_z() -> None:
    e = HillEquation(np.eye(2), np.eye(2), 0.1, 1.3, np.eye(2) * 0.1)
    with pytest.raises(ValueError, match="eta is a matrix"):
        hill.enclose(e)


@pytest.mark.parametrize("package", [floquet, hill])
def test_without_the_extra_one_line_says_how(package: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{package.__name__}.enclosure.find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"pip install 'floquet-crosscheck\[proof\]'"):
        package.enclose(random_system(1))


def test_what_a_value_takes_is_bounded() -> None:
    with pytest.raises(tail.TooWide, match="harmonics"):
        hill.enclose(HillEquation([[1e12]], [[1e12]], 1.0, 1.0))
    assert folded.MAX_BITS < 10_000
