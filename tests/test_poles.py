"""Charts across the poles of the axial force: their bounds, their points, and what is shared."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from benchmarks.honesty.arbiter import largest_error, reference
from compare import Chart, chart
from compare.charts import grid
from compare.charts.axis import Axis
from compare.charts.result import directly
from compare.charts.scenario import scenario
from compare.charts.smooth import Smooth
from floquet import batch, monodromy
from floquet.batch import equations as sweeps
from floquet.data_errors import data_share
from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic
from hill.system import Parameter

BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
STEPPED = SteppedBeam(T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6)
# Omega = omega_L runs from one corner to near the other
AXES = [("Omega", 1.6, 2.4, 71), ("omega_L", 1.5, 3.0, 61)]


@cache
def made(route: str) -> Chart:
    return chart(BEAM, AXES, forcing={"gamma": 0.1}, route=route)


@pytest.mark.parametrize("route", ["floquet", "hill"])
def test_far_from_a_pole_and_near_it_P_is_within_its_bound_of_the_other_route(route: str) -> None:
    c, rng = made(route), np.random.default_rng(3)
    omega_L = rng.uniform(1.5, 3.0, 160)
    # a hundred anywhere, sixty by the pole, on either side
    Omega = np.where(
        np.arange(160) < 100,
        rng.uniform(1.6, 2.4, 160),
        omega_L * (1.0 + rng.choice([-1, 1], 160) * 10.0 ** rng.uniform(-3, -1, 160)),
    )
    there = (Omega > 1.6) & (Omega < 2.4)
    found = c.at(Omega=Omega[there], omega_L=omega_L[there])
    for k, (x, y) in enumerate(zip(Omega[there], omega_L[there], strict=True)):
        beam = replace(BEAM, omega_L=float(y))
        if route == "hill":
            other = monodromy(galerkin(beam, float(x), 0.1))
        else:
            other = characteristic(beam.equation(float(x), 0.1))
        # each with matrices of its own, which near the pole are not known to the last digit
        data = 2.0 * data_share(beam.equation(float(x), 0.1)) * np.abs(other.polynomial).sum()
        allowed = found.error[k] + other.error + data
        assert np.abs(found.polynomial[k] - other.polynomial).max() <= allowed
    assert np.median(found.error) < 1e-10


def test_the_grid_is_that_of_its_points() -> None:
    c = made("floquet")
    x, y = np.meshgrid(*(axis.points for axis in c.axes))
    there = np.isfinite(c.T)
    # Omega = omega_L on the grid: 1.6, 1.8, 2.0, 2.2, 2.4
    assert 0 < np.count_nonzero(~there) < 12
    assert np.all(np.abs(x - y)[~there] < 0.01)
    assert np.all(there[np.abs(x - y) > 0.05])
    on = np.abs(x - y) < 1e-12
    assert np.all(np.isinf(c.T[on]))
    series = c.at(Omega=x[there], omega_L=y[there])
    apart = np.abs(series.T - c.T[there])
    assert np.all(apart <= 2.0 * series.T_error + 1e-9)
    assert c.direct < 0.7 * c.T.size


def test_points_that_overlap_no_piece_are_none() -> None:
    c = made("floquet")
    count = np.zeros([axis.count for axis in c.axes], int)
    for cells in grid.from_series(c.surface, c.scenario.smooth):
        count[cells.where] += 1
    for cells in c.alone:
        count[cells.where] += 1
    # on a seam twice
    assert count.min() == 1
    assert np.mean(count == 1) > 0.95


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_parts_of_a_skew_grid(order: tuple[int, ...]) -> None:
    axes = (
        Axis("Omega", 1.0, 2.0, 23),
        Axis("omega_L", 0.9, 3.0, 31, "ratio"),
        Axis("gamma", 0.0, 0.1, 5),
    )
    smooth = Smooth(tuple(axes[k] for k in order))
    points = np.stack(np.meshgrid(*(a.points for a in smooth.axes), indexing="ij"), axis=-1)
    at = smooth.to_smooth(points.reshape(-1, 3))
    assert smooth.from_smooth(at) == pytest.approx(points.reshape(-1, 3), rel=1e-15)
    low, high = smooth.span
    assert np.all((at >= low) & (at <= high))
    rng = np.random.default_rng(5)
    seen = 0
    for _ in range(40):
        a, b = np.sort(low + (high - low) * rng.random((2, 3)), axis=0)
        inside = np.all((at >= a) & (at <= b), axis=1).reshape(points.shape[:-1])
        corners = smooth.kept(a, b)
        part = smooth.part(*corners) if corners else None
        picked = np.zeros(inside.shape, bool)
        if part is not None:
            picked[part.where()] = True
            assert part.count == np.count_nonzero(picked)
            seen += 1
        assert np.array_equal(picked, inside)
    assert seen > 10


def test_three_axes_in_any_order_are_one_chart() -> None:
    axes = [("Omega", 1.7, 2.0, 25), ("gamma", 0.0, 0.02, 9), ("omega_L", 2.5, 3.1, 24)]
    one = chart(BEAM, axes, route="hill", tolerance=1e-8)
    other = chart(BEAM, axes[::-1], route="hill", tolerance=1e-8)
    assert one.direct == 0
    # roots of P's 1e-8
    assert np.transpose(other.T) == pytest.approx(one.T, abs=1e-3)
    P, error = directly(one, np.array([[1.7, 0.02, 2.5]]))
    at = one.at(Omega=1.7, gamma=0.02, omega_L=2.5)
    assert np.abs(at.polynomial[0] - P[0]).max() <= at.error[0] + error[0]


def test_workers_and_a_file_of_nodes_change_no_bit(tmp_path, monkeypatch) -> None:
    path = tmp_path / "nodes"
    first = chart(BEAM, AXES, forcing={"gamma": 0.1}, route="floquet", resume=path)
    again = chart(BEAM, AXES, forcing={"gamma": 0.1}, route="floquet", resume=path)
    assert again.resumed == again.nodes == first.nodes

    def backwards(function, jobs):
        return [function(job) for job in reversed(list(jobs))]

    other = chart(BEAM, AXES, forcing={"gamma": 0.1}, route="floquet", workers=backwards)
    for c in (first, again, other):
        assert np.array_equal(c.T, made("floquet").T)


def test_a_stepped_bar_s_poles_are_straight_too() -> None:
    axes = [("Omega", 2.0, 2.6, 61), ("omega_L", 1.6, 2.6, 41)]
    c = chart(STEPPED, axes, forcing={"gamma": 0.05}, route="hill", tolerance=1e-9)
    assert 0 < c.direct < 0.6 * c.T.size
    poles = replace(STEPPED, omega_L=1.0).singular_Omega(0.7, 1.7)
    assert len(poles)
    x, y = np.meshgrid(*(axis.points for axis in c.axes))
    away = np.min(np.abs(x[..., None] / y[..., None] - poles), axis=-1)
    assert np.all(np.isfinite(c.T[away > 0.1]))
    rng = np.random.default_rng(8)
    where = rng.uniform(2.0, 2.6, 40), rng.uniform(1.6, 2.6, 40)
    at = c.at(Omega=where[0], omega_L=where[1])
    for P, error, Omega, omega_L in zip(at.polynomial, at.error, *where, strict=True):
        m = monodromy(galerkin(replace(STEPPED, omega_L=float(omega_L)), float(Omega), 0.05))
        assert np.abs(P - m.polynomial).max() <= error + m.error + 2.0 * m.data_error


# ---- what shares matrices ------------------------------------------------------------------------


def test_equations_of_one_ratio_share_their_matrices() -> None:
    own = scenario(BEAM, AXES, {"gamma": 0.1})
    Omega = np.array([1.6, 2.0, 2.4])
    points = {"Omega": Omega, "omega_L": 1.25 * Omega}
    for route in ("hill", "floquet"):
        shared = own.equations(points, route)
        for x, e in zip(Omega, shared, strict=True):
            beam = replace(BEAM, omega_L=1.25 * x)
            alone = beam.equation(x, 0.1) if route == "hill" else galerkin(beam, x, 0.1)
            assert np.array_equal(e.G, alone.G)
            assert np.array_equal(e.F, alone.F)
            assert (e.Omega, e.omega_L) == pytest.approx((x, 1.25 * x), rel=1e-15)
        assert shared[0].G is shared[1].G


@dataclass(frozen=True)
class Tuned:
    """Of the square of its frequency, and not of what Omega is of it."""

    tuning: float = 1.0

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        return (Parameter("tuning", 0.0, smooth="ratio"),)

    depends_on_Omega = True

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
        return HillEquation([[self.tuning]], [[1.0]], gamma, Omega, eta)


def test_a_ratio_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match="'tuning': says smooth = 'ratio'"):
        scenario(Tuned(), [("tuning", 1.0, 2.0, 5)], {"Omega": 1.0, "gamma": 0.1})


# ---- growth, many at once ------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [0.0, 0.3])
def test_what_grows_is_within_its_bound_side_by_side(eta: float, monkeypatch) -> None:
    """By the whole period: against the determinant in arithmetic of 600 bits."""
    monkeypatch.setattr(sweeps, "_bound", lambda _: 1 / 0)
    beams = [
        replace(BEAM, omega_L=2.0 * (1.0 + d)) for d in (3e-4, 1e-3, 2e-3, -4e-4, -1.5e-3, 4e-3)
    ]
    several = [beam.equation(2.0, 0.1, eta) for beam in beams]
    found = batch.polynomials(several, kernel="numpy")
    for e, P, error in zip(several, found.coefficients, found.errors, strict=True):
        off = largest_error(P, reference(e))
        assert off <= error
        assert error < 1e-8 * np.abs(P).max()


def test_the_routes_are_compared_where_both_know_P() -> None:
    """Next to a pole growth makes much of the matrices' last digits; elsewhere they agree."""
    both = made("both")
    assert both.routes_agree
    told = np.isfinite(both.apart)
    assert 0.99 < told.mean() < 1.0
    Omega, omega_L = both.sampled[~told].T
    assert np.abs(Omega / omega_L - 1.0).max() < 2e-3
