"""Equations whose multipliers come in pairs: stable is shown, by both routes, and never wrongly."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from benchmarks.honesty.symmetric import KINDS, broken, system, truth_of
from compare.report.row import equation
from compare.report.tables import all_rows
from floquet import monodromy
from floquet.enclosure import general as general_arbiter
from floquet.general.symmetry import pairs_decay
from floquet.growth import LogDiscs, growth_from_multipliers
from hill import Fourier, HillEquation, PeriodicEquation, characteristic
from hill.symmetry import damping_of_pairs

ROUTES: dict[str, Callable[[Any], Any]] = {"hill": characteristic, "floquet": monodromy}
both = pytest.mark.parametrize("route", ROUTES)
kinds = pytest.mark.parametrize("kind", KINDS)

# Of each class; `python -m benchmarks.routes` asks many more.
SEEDS = range(3)


@both
@pytest.mark.parametrize("row", all_rows(), ids=lambda row: row.id)
def test_every_row_has_the_special_verdict(row: Any, route: str) -> None:
    """Tables 1 to 3 in general form; none of their verdicts is undecided."""
    own = equation(row, 2)
    special, found = ROUTES[route](own), ROUTES[route](own.general())
    assert found.verdict == special.verdict != "undecided"
    assert abs(found.T - special.T) <= found.T_error + special.T_error


@kinds
@pytest.mark.parametrize("seed", SEEDS)
def test_no_verdict_is_wrong(kind: str, seed: int) -> None:
    """Against the arbiter; and one is given, as no system here is at an edge."""
    e = system(kind, seed)
    known = truth_of(e, general_arbiter.reference(e))
    for route in ROUTES.values():
        found = route(e)
        assert found.verdict == known.verdict
        assert float(abs(found.T - known.T).upper()) <= found.T_error


@kinds
@pytest.mark.parametrize("seed", range(20))
def test_both_see_the_symmetry_and_that_it_is_broken(kind: str, seed: int) -> None:
    e = system(kind, seed)
    eta = damping_of_pairs(e)
    assert eta is not None
    assert pairs_decay(e) == float(eta)
    # with one coordinate a little damping is proportional damping
    if e.order > 2:
        off = broken(kind, seed)
        assert damping_of_pairs(off) is None
        assert pairs_decay(off) is None


@both
@pytest.mark.parametrize("kind", ["conservative", "conservative, C pulsating", "reversible"])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_trace_of_damping_leaves_it_undecided(kind: str, seed: int, route: str) -> None:
    """1e-17, far below every bound: stable with it, unstable with its opposite."""
    e = system(kind, seed)
    if e.order > 2 and ROUTES[route](e).verdict == "stable":
        for by in (2.0**-56, -(2.0**-56)):
            assert ROUTES[route](broken(kind, seed, by)).verdict == "undecided"


@both
def test_flutter_is_unstable(route: str) -> None:
    """Two coordinates coupled against each other: reversible, and a follower force's flutter."""

    def force(p: float) -> PeriodicEquation:
        return PeriodicEquation(
            K=Fourier([[1.0, p], [-p, 2.0]], cos={1: [[0.125, 0.0], [0.0, 0.0]]}), Omega=1.0
        )

    assert damping_of_pairs(force(0.25)) == 0
    assert ROUTES[route](force(0.25)).verdict == "stable"
    assert ROUTES[route](force(0.75)).verdict == "unstable"


@both
def test_multipliers_that_meet_are_undecided(route: str) -> None:
    """Two equal oscillators: bounded, but the least coupling may tear them apart."""
    e = PeriodicEquation(K=Fourier(np.eye(2), cos={1: 0.25 * np.eye(2)}), Omega=3.0)
    assert damping_of_pairs(e) == 0
    assert ROUTES[route](e).verdict == "undecided"


@both
def test_a_symmetry_that_one_ulp_breaks(route: str) -> None:
    K = np.array([[1.0, 0.3], [0.3, 2.5]])
    G = np.array([[0.0, 0.7], [-0.7, 0.0]])
    turning = Fourier(K, cos={1: [[0.2, 0.1], [0.1, 0.3]]}, sin={2: [[0.1, 0.0], [0.0, 0.2]]})
    off = K.copy()
    off[0, 1] = np.nextafter(0.3, 1.0)
    said = {
        name: ROUTES[route](PeriodicEquation(C=G, K=stiffness, Omega=3.9)).verdict
        for name, stiffness in {
            "symmetric": turning,
            "an ulp off": Fourier(off, cos=turning.cos, sin=turning.sin),
        }.items()
    }
    assert said == {"symmetric": "stable", "an ulp off": "undecided"}


@pytest.mark.parametrize("see", [damping_of_pairs, pairs_decay])
@pytest.mark.parametrize(
    ("made", "eta"),
    [
        # a sine, about a quarter of the period later
        ({"K": Fourier([[1.0]], sin={1: [[0.3]]})}, 0.0),
        ({"K": Fourier([[1.0]], sin={2: [[0.3]]})}, 0.0),
        # one coordinate has a potential
        ({"K": Fourier([[1.0]], cos={1: [[0.2]]}, sin={2: [[0.3]]})}, 0.0),
        ({"K": [[1.0]], "C": [[0.375]], "M": [[0.75]]}, 0.5),
        # an odd damping is reversible, an even one not
        ({"K": [[1.0]], "C": Fourier([[0.0]], sin={1: [[0.3]]})}, 0.0),
        ({"K": [[1.0]], "C": Fourier([[0.0]], cos={2: [[0.3]], 1: [[0.3]]})}, None),
        # Ziegler's column between a symmetric and a skew part; its damping not proportional
        ({"K": [[1.0, 0.5], [-0.5, 2.0]]}, 0.0),
        ({"K": [[1.0, 0.5], [-0.5, 2.0]], "C": [[0.1, 0.0], [0.0, 0.2]]}, None),
        # gyroscopic terms with circulatory ones: no
        ({"K": [[1.0, 0.5], [-0.5, 2.0]], "C": [[0.0, 1.0], [-1.0, 0.0]]}, None),
        # three signs that cannot be
        (
            {
                "K": [[1.0, 0.5, 0.5], [0.25, 2.0, 0.5], [0.25, 0.25, 3.0]],
                "C": [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
            },
            None,
        ),
    ],
)
def test_what_has_pairs(see: Any, made: Any, eta: float | None) -> None:
    assert see(PeriodicEquation(Omega=1.5, **made)) == eta


@both
def test_many_coordinates(route: str) -> None:
    """Thirty gyroscopic ones, whose polynomial knows none of its roots."""
    n = 30
    rng = np.random.default_rng(0)
    some = rng.standard_normal((3, n, n)) / n
    e = PeriodicEquation(
        C=some[0] - some[0].T,
        K=Fourier(np.diag(np.linspace(1.0, 5.0, n) ** 2), cos={1: some[1] + some[1].T}),
        Omega=1.3,
    )
    found = ROUTES[route](e)
    # and no minus sign before the 0
    assert (found.verdict, str(found.T)) == ("stable", "0.0")
    assert found.T_error < 1e-14


@both
def test_a_matrix_of_proportional_damping(route: str) -> None:
    """0.2 times the identity is damping by one number; its multipliers are on a circle."""
    e = HillEquation([[1.0, 0.25], [0.125, 2.0]], np.eye(2), 0.1, 3.0, 0.2 * np.eye(2))
    found = ROUTES[route](e)
    assert found.verdict == "stable"
    assert abs(found.T + 0.2) <= found.T_error


def test_a_partner_in_another_disc_shows_nothing() -> None:
    """Discs about two multipliers close together, either of which may be the other's partner."""

    def judged(*angles: float, radius: float) -> str:
        value = 1j * np.array([*angles, *(-x for x in angles)])
        r = np.full(len(value), radius)
        least, most = np.log1p(-r), np.log1p(r)
        discs = LogDiscs(value, r, least, most, np.eye(len(value), dtype=bool))
        return growth_from_multipliers((discs,), 1.0, 0.0, 0.0).verdict

    assert judged(1.0, 2.0, radius=0.1) == "stable"
    # apart, and the partner of each may still be within the other
    assert judged(1.0, 1.2, radius=0.099) == "undecided"
    assert judged(0.1, radius=0.099) == "undecided"
