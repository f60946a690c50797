"""A rectangle of Omega and gamma: parts are what their points are, by the other route too."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

import hill
from floquet import enclose_region
from floquet.enclosure import region
from floquet.enclosure.result import RegionProof
from hill import UniformBeam

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=1)
LOW, HIGH = Fraction(9, 5), Fraction(46, 25)
LEAST, MOST = Fraction(1, 20), Fraction(1, 5)


@pytest.fixture(scope="module")
def found() -> RegionProof:
    """About 2 omega_(1) of one mode, which is quick."""
    return enclose_region(BEAM, Omega=(LOW, HIGH), gamma=(LEAST, MOST), strips=5)


def test_parts_are_what_their_points_are(found: RegionProof) -> None:
    rng = np.random.default_rng(1)
    seen = set()
    for least, most, parts in found.strips:
        assert (parts[0][0], parts[-1][1]) == (1.8, 1.84)
        assert all(a[1] == b[0] for a, b in pairwise(parts))
        for low, high, kind in parts:
            if kind == "undecided":
                continue
            seen.add(kind)
            for share in rng.uniform(0.01, 0.99, 2):
                Omega = float(low + share * (high - low))
                gamma = float(least + rng.uniform(0.01, 0.99) * (most - least))
                point = hill.enclose(BEAM, Omega=Omega, gamma=gamma, bits=60)
                assert point.verdict == kind
    assert seen == {"stable", "unstable"}


def test_shares_and_cells(found: RegionProof) -> None:
    shares = [found.share(kind) for kind in ("stable", "unstable", "undecided")]
    assert sum(shares) == pytest.approx(1.0)
    # strips of 0.03 are wide: the edges move by some thousandths within one
    assert shares[2] < 0.3
    cells = found.cells(20)
    assert (len(cells), {len(row) for row in cells}) == (5, {20})
    parts = [kind for row in cells for kind in row]
    for kind in ("stable", "unstable"):
        # a cell that is decided lies within one part
        assert 0 < parts.count(kind) / len(parts) <= found.share(kind)


def block() -> Any:
    with ctx.workprec(region.BITS):
        return region.Block(BEAM, LOW, HIGH, LEAST, MOST)


def held(known: Any, Omega: Fraction, gamma: Fraction) -> bool:
    """Whether the polynomials and their remainder meet the determinant's balls."""
    with ctx.workprec(region.BITS):
        x = region.number((1 / Omega**2 - known.middle) / known.half)
        y = region.number((2 * gamma - LEAST - MOST) / (MOST - LEAST))
        off = arb(0, known.remainder.upper())
        values = [
            sum((c * x**a * y**b for a, row in enumerate(W.tolist()) for b, c in enumerate(row)))
            + off
            for W in known.powers
        ]
    other = hill.enclose(BEAM, Omega=Omega, gamma=gamma)
    return all(p.overlaps(q) for p, q in zip(values, other.polynomial, strict=True))


POINTS = [(Fraction(181, 100), Fraction(1, 7)), (Fraction(1839, 1000), Fraction(3, 50))]


def test_the_polynomials_meet_the_determinant() -> None:
    known = block()
    assert float(known.remainder) < 1e-11
    assert all(held(known, *point) for point in POINTS)


def test_a_wrong_remainder_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(region, "_count", lambda size: (4, arb(0)))
    known = block()
    assert not any(held(known, *point) for point in POINTS)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"Omega": (1.2, 1.1)}, "ascending"),
        ({"gamma": (0.2, 0.2)}, "ascending"),
        ({"strips": 0}, "strips"),
        ({"omega_L": 3.0}, "omega_L = 3: must be infinite"),
    ],
)
def test_refusals(given: dict[str, Any], words: str) -> None:
    elastic = {"omega_L": given.pop("omega_L")} if "omega_L" in given else {}
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, **elastic)
    with pytest.raises(ValueError, match=words):
        enclose_region(beam, **({"Omega": (1.1, 1.2), "gamma": (0.0, 0.2)} | given))
