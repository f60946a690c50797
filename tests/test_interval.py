"""Every Omega of an interval: the polynomial in 1/Omega^2, its remainder, and what it proves."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest
from flint import arb, ctx

import floquet
import hill
from compare.report.tables import Row, all_rows
from floquet.enclosure import enclose_interval, interval
from hill import UniformBeam
from hill.decimals import exact_beam

ROWS = {row.id: row for row in all_rows()}
HALF = Fraction(1, 2000)


def printed(row: Row) -> tuple[Fraction, Fraction]:
    Omega = Fraction(row.Omega_printed)
    return Omega - HALF, Omega + HALF


@pytest.mark.parametrize(
    ("name", "verdict"), [("T1-14", "both"), ("T2-27", "unstable"), ("T1-07", "stable")]
)
def test_parts_are_what_their_points_are(name: str, verdict: str) -> None:
    """Also by the other route, at points of each part."""
    row = ROWS[name]
    found = enclose_interval(row.beam(2), Omega=printed(row), gamma=row.gamma)
    assert found.verdict == verdict
    assert found.parts[0][0] == found.Omega[0] < found.Omega[1] == found.parts[-1][1]
    assert all(a[1] == b[0] for a, b in pairwise(found.parts))
    assert found.share("undecided") < 1e-9
    for low, high, kind in found.parts:
        for share in (0.01, 0.5, 0.99) if kind != "undecided" else ():
            Omega = low + share * (high - low)
            assert hill.enclose(row.beam(2), Omega=Omega, gamma=row.gamma).verdict == kind


def test_damping_moves_the_edge() -> None:
    """Within the interval the damped beam has an edge of its own; parts are told by T there."""
    row = ROWS["T1-14"]
    damped = enclose_interval(row.beam(2), Omega=(1.81, 1.83), gamma=row.gamma, eta=0.003)
    assert {kind for _, _, kind in damped.parts} == {"stable", "unstable", "undecided"}
    assert damped.share("undecided") < 1e-9
    for low, high, kind in damped.parts:
        middle = floquet.enclose(row.beam(2), Omega=(low + high) / 2, gamma=row.gamma, eta=0.003)
        assert kind in ("undecided", middle.verdict)


def series(name: str) -> tuple[Row, Any]:
    row = ROWS[name]
    low, high = printed(row)
    given, under = exact_beam(row.beam(2), high, row.gamma)
    with ctx.workprec(interval.BITS):
        return row, interval.Series(given, under, low, high)


def held(row: Row, known: Any, Omega: Fraction) -> bool:
    """Whether the polynomial and its remainder meet the determinant's balls."""
    with ctx.workprec(interval.BITS):
        x = interval.number((1 / Omega**2 - known.middle) / known.half)
        off = arb(0, known.remainder.upper())
        values = [p(x) + off for p in known.coefficients]
    other = hill.enclose(row.beam(2), Omega=Omega, gamma=row.gamma)
    return all(a.overlaps(b) for a, b in zip(values, other.polynomial, strict=True))


PLACES = (Fraction(3), Fraction(-7, 3), Fraction(499, 100))


def test_the_polynomial_meets_the_determinant() -> None:
    row, known = series("T1-01")
    middle = Fraction(row.Omega_printed)
    assert float(known.remainder) < 1e-20
    assert all(held(row, known, middle + place / 10_000) for place in PLACES)


def test_a_wrong_remainder_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Too few nodes, and none of what they leave out."""
    monkeypatch.setattr(interval, "_remainder", lambda *_: (4, arb(0)))
    row, known = series("T1-01")
    middle = Fraction(row.Omega_printed)
    assert not any(held(row, known, middle + place / 10_000) for place in PLACES)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"Omega": (1.2, 1.1)}, "0 < low < high"),
        ({"Omega": (1.1, 1.2), "omega_L": 3.0}, "F and G move with Omega"),
    ],
)
def test_refusals(given: dict[str, Any], words: str) -> None:
    elastic = {"omega_L": given.pop("omega_L")} if "omega_L" in given else {}
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, **elastic)
    with pytest.raises(ValueError, match=words):
        enclose_interval(beam, **given, gamma=0.1)
