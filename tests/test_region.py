"""Cells of Omega and gamma: what is proven of them holds at their points, by the other route."""

from fractions import Fraction
from functools import cache, partial
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

import hill
from floquet import enclose, enclose_region
from floquet.enclosure import cells, local, region, surface
from floquet.enclosure.balls import number
from floquet.enclosure.bound import bound_on
from floquet.enclosure.result import RegionProof
from hill import UniformBeam
from hill.decimals import exact_beam

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
OMEGA = [Fraction(1) + Fraction(k, 60) for k in range(13)]
GAMMA = [Fraction(k, 40) for k in range(9)]


@pytest.fixture(scope="module")
def found() -> RegionProof:
    """About omega_(B) + omega_(1), with 2 omega_(B)/2 and more beside it."""
    return enclose_region(BEAM, Omega=OMEGA, gamma=GAMMA, halvings=8)


def inside(edges: tuple[float, ...], k: int, share: float) -> float:
    return float(edges[k] + share * (edges[k + 1] - edges[k]))


def some_cells(of: RegionProof, kind: str, many: int) -> list[tuple[int, int]]:
    every = np.argwhere(of.cells == kind)
    chosen = np.random.default_rng(3).choice(len(every), min(many, len(every)), replace=False)
    return [(int(i), int(k)) for i, k in every[chosen]]


@pytest.mark.parametrize("kind", ["stable", "unstable"])
def test_cells_are_what_their_points_are(found: RegionProof, kind: str) -> None:
    rng = np.random.default_rng(1)
    for i, k in some_cells(found, kind, 8):
        # corners too: a cell is closed
        for across, up in [rng.random(2), (0.0, 1.0), (1.0, 1.0)]:
            Omega, gamma = inside(found.Omega, k, across), inside(found.gamma, i, up)
            assert hill.enclose(BEAM, Omega=Omega, gamma=gamma, bits=60).verdict == kind


def test_shares(found: RegionProof) -> None:
    assert found.cells.shape == (8, 12)
    shares = {kind: found.share(kind) for kind in ("stable", "unstable", "undecided")}
    assert sum(shares.values()) == pytest.approx(1.0)
    assert shares["undecided"] < 0.08
    widths = np.diff(found.gamma)[:, None] * np.diff(found.Omega)
    assert np.allclose(sum(found.areas.values()), widths, rtol=1e-12)
    assert found.whole == np.mean(found.cells != "undecided") > 0.5
    # a cell that an edge goes through is not called either
    mixed = (found.areas["stable"] > 0.0) & (found.areas["unstable"] > 0.0)
    assert set(found.cells[mixed]) == {"undecided"}


def test_halving_only_adds(found: RegionProof) -> None:
    coarse = enclose_region(BEAM, Omega=OMEGA, gamma=GAMMA, halvings=2)
    known = coarse.cells != "undecided"
    assert np.all(found.cells[known] == coarse.cells[known])
    assert coarse.share("undecided") > 2.0 * found.share("undecided")


def test_damping_moves_the_edges() -> None:
    damped, free = (
        enclose_region(BEAM, Omega=OMEGA[3:10], gamma=GAMMA[:5], eta=eta, halvings=7)
        for eta in ("0.01", 0)
    )
    assert damped.share("unstable") < free.share("unstable")
    # most of it between where z meet and where T is 0
    assert damped.share("undecided") < 0.25
    rng = np.random.default_rng(2)
    for kind in ("stable", "unstable"):
        for i, k in some_cells(damped, kind, 4):
            Omega, gamma = (
                inside(damped.Omega, k, rng.random()),
                inside(damped.gamma, i, rng.random()),
            )
            assert enclose(BEAM, Omega=Omega, gamma=gamma, eta="0.01").verdict == kind
    # what grows without damping need not with it
    assert np.any((damped.areas["stable"] > 0.0) & (free.areas["unstable"] > 0.0))


@pytest.mark.parametrize("modes", [1, 3])
def test_other_numbers_of_modes(modes: int) -> None:
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=modes)
    proof = enclose_region(beam, Omega=[1.75, 1.8, 1.85, 1.9], gamma=[0.1, 0.15, 0.2], halvings=4)
    assert {"stable", "unstable"} <= {k for k in proof.areas if proof.share(k) > 0.0}
    for kind in ("stable", "unstable"):
        for i, k in some_cells(proof, kind, 3):
            Omega, gamma = inside(proof.Omega, k, 0.7), inside(proof.gamma, i, 0.3)
            assert hill.enclose(beam, Omega=Omega, gamma=gamma, bits=60).verdict == kind


@cache
def made(eta: str = "0") -> surface.Surface:
    given, _ = exact_beam(BEAM, 1, 0)
    over = surface.Rectangle(*region._middle(1 / OMEGA[-1], 1 / OMEGA[0]), GAMMA[-1] / 2,
                             GAMMA[-1] / 2)  # fmt: skip
    with ctx.workprec(surface.BITS):
        make = partial(region.of_decimals, given, Fraction(eta))
        known = bound_on(*make(surface.BITS))
        nodes, left = surface.counts(known, over)
        values = [surface.column(make, over, nodes, i) for i in range(nodes[0])]
        return surface.Surface(over, known, nodes, left, values)


def patches_of(whole: surface.Surface) -> list[surface.Patch]:
    with ctx.workprec(surface.BITS):
        return list(whole.patches())


def held(over: surface.Rectangle, patches: list[surface.Patch], at: Any) -> bool:
    """Whether a patch's polynomials and what they leave out meet the determinant's balls."""
    Omega, gamma = at
    x, y = (1 / Omega - over.s) / over.half_s, (gamma - over.gamma) / over.half_gamma
    patch = next(p for p in patches if p.x[0] <= x <= p.x[1] and p.y[0] <= y <= p.y[1])
    with ctx.workprec(surface.BITS):
        own = [number((2 * v - a - b) / (b - a)) for v, (a, b) in ((x, patch.x), (y, patch.y))]
        values = [
            sum(
                (arb(c) * own[0] ** i * own[1] ** j for (i, j), c in np.ndenumerate(powers)),
                start=arb(0, float(rest)),
            )
            for powers, rest in zip(patch.powers, patch.rest, strict=True)
        ]
    other = hill.enclose(BEAM, Omega=Omega, gamma=gamma).polynomial[1:]
    return all(p.overlaps(q) for p, q in zip(values, other, strict=True))


POINTS = [
    (Fraction(201, 200), Fraction(1, 7)),
    (Fraction(1117, 1000), Fraction(3, 50)),
    (Fraction(23, 20), Fraction(1, 5)),
]


def test_the_patches_meet_the_determinant() -> None:
    whole = made()
    patches = patches_of(whole)
    assert float(whole.remainder) < 1e-11
    assert all(held(whole.over, patches, point) for point in POINTS)
    assert all(np.all(p.rest < 1e-9) for p in patches)


def test_a_wrong_remainder_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Too few nodes, and none of what they leave out."""
    monkeypatch.setattr(surface, "_count", lambda size: (4, arb(0)))
    whole = made.__wrapped__()
    patches = patches_of(whole)
    assert not any(held(whole.over, patches, point) for point in POINTS)


def test_a_series_cut_off_in_silence_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Too few terms in a patch, and none of what they leave out."""
    from flint import arb_mat

    monkeypatch.setattr(surface, "_cut", lambda series: (arb_mat(series.tolist()[:4]), arb(0)))
    whole = made()
    patches = patches_of(whole)
    assert not any(held(whole.over, patches, point) for point in POINTS)


def test_the_bound_holds_for_complex_parameters() -> None:
    """P's coefficients where s and gamma are complex, from CasADi-free matrices of one period."""
    from scipy.integrate import solve_ivp

    given, _ = exact_beam(BEAM, 1, 0)
    with ctx.workprec(128):
        F, G = region.of_decimals(given, Fraction(0), 128)
        known = bound_on(F, G)
        F, G = (np.array([[float(x) for x in r] for r in M.tolist()]) for M in (F, G))
    rng = np.random.default_rng(4)
    tightest = 0.0
    for _ in range(6):
        s = complex(rng.uniform(0.2, 1.5), rng.uniform(-1.0, 1.0))
        gamma = complex(*rng.uniform(-1.0, 1.0, 2))

        def slope(theta: float, flat: Any, s: Any = s, gamma: Any = gamma) -> Any:
            u = flat.reshape(6, 6)
            return np.vstack([u[3:], -(s**2) * (F + gamma * np.cos(theta) * G) @ u[:3]]).ravel()

        end = solve_ivp(slope, (0.0, 2.0 * np.pi), np.eye(6, dtype=complex).ravel(), rtol=1e-8)
        P = np.poly(end.y[:, -1].reshape(6, 6)[:3, :3])
        share = np.log(np.max(np.abs(P))) / known.log(abs(s), abs(s.imag), abs(gamma))
        assert share <= 1.0
        tightest = max(tightest, share)
    # and it is not idle
    assert tightest > 0.3


@pytest.mark.parametrize("eta", ["0", "0.01"])
def test_small_parts_are_what_their_corners_are(eta: str) -> None:
    """Rectangles of any size within patches, where verdicts change; by the whole enclosure."""
    whole = made(eta)
    over, rng, seen = whole.over, np.random.default_rng(6), {cells.STABLE: 0, cells.UNSTABLE: 0}
    for patch in patches_of(whole):
        low = rng.uniform(-1.0, 0.9, (60, 2))
        high = np.minimum(low + 10.0 ** rng.uniform(-4.0, 0.0, (60, 2)), 1.0)
        ends = np.column_stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]])
        place = region._place(over, patch)
        edges = cells._edges(ends, place, float(eta)) if float(eta) else None
        kinds = cells.verdicts(local.about(patch, ends), edges)
        for kind in seen:
            for x0, x1, y0, y1 in ends[kinds == kind][:6]:
                x, y = Fraction(float(rng.choice([x0, x1]))), Fraction(float(rng.choice([y0, y1])))
                own_x = (sum(patch.x) + x * (patch.x[1] - patch.x[0])) / 2
                own_y = (sum(patch.y) + y * (patch.y[1] - patch.y[0])) / 2
                Omega = 1 / (over.s + over.half_s * own_x)
                gamma = over.gamma + over.half_gamma * own_y
                found = enclose(BEAM, Omega=Omega, gamma=gamma, eta=eta).verdict
                assert found == region.KINDS[kind]
                seen[kind] += 1
    assert min(seen.values()) > 5


def random_local(rng: Any, m: int) -> tuple[surface.Patch, Any]:
    powers = rng.normal(size=(3, 6, 5)) * 0.3 ** np.add.outer(np.arange(6), np.arange(5))
    patch = surface.Patch((Fraction(-1), Fraction(1)), (Fraction(-1), Fraction(1)), powers,
                          np.zeros(3))  # fmt: skip
    low = rng.uniform(-1.0, 0.8, (m, 2))
    high = np.minimum(low + rng.uniform(1e-6, 0.5, (m, 2)), 1.0)
    return patch, np.column_stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]])


def test_ranges_hold_their_points() -> None:
    """P, a derivative and a product over rectangles, at points by the plain sums."""
    rng = np.random.default_rng(5)
    m = 200
    patch, ends = random_local(rng, m)
    p, z = local.about(patch, ends), rng.uniform(-1.2, 1.2, m)
    shares = np.concatenate([rng.random((40, 2)), [(0, 0), (0, 1), (1, 0), (1, 1)]])
    x = ends[:, 0] + shares[:, :1] * (ends[:, 1] - ends[:, 0])
    y = ends[:, 2] + shares[:, 1:] * (ends[:, 3] - ends[:, 2])
    own = [np.polynomial.polynomial.polyval2d(x, y, c) for c in patch.powers]
    value = z**3 + sum(c * z ** (2 - k) for k, c in enumerate(own))
    slope = 3 * z**2 + 2 * z * own[0] + own[1]
    P, D = local.at(p, z), local.at(p, z, 1)
    for moved, truth in ((P, value), (D, slope), (local.product(P, D), value * slope)):
        low, high = moved.ends
        assert np.all((truth >= low) & (truth <= high))
        assert np.all(np.abs(truth) <= moved.size)
        # narrow: no more than twice what the points span, where that is seen
        span = truth.max(axis=0) - truth.min(axis=0)
        assert np.median((high - low) / span) < 2.0


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"Omega": (1.2, 1.1)}, "ascending"),
        ({"gamma": (0.2,)}, "two numbers or more"),
        ({"Omega": (0.0, 1.1)}, "Omega = 0: must be > 0"),
        ({"Omega": (0.001, 1.1)}, "narrower ranges"),
        ({"halvings": -1}, "halvings"),
        ({"omega_L": 3.0}, "omega_L = 3: must be infinite"),
        ({"T0": 30.0}, "F: must have real, positive eigenvalues"),
    ],
)
def test_refusals(given: dict[str, Any], words: str) -> None:
    own = {name: given.pop(name) for name in ("omega_L", "T0") if name in given}
    beam = UniformBeam(**({"T0": 20.0, "K_theta": 0.5, "xi_G": 0.5} | own))
    with pytest.raises(ValueError, match=words):
        enclose_region(beam, **({"Omega": (1.1, 1.2), "gamma": (0.0, 0.2)} | given))
