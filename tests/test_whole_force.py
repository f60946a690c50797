"""The damped bar's whole axial force, cosine and sine, by both routes: (4.2.39) as corrected."""

import numpy as np
import pytest

from compare import crosscheck
from compare.report.claims.resonance import bar
from floquet import beam_sensitivities, monodromy
from floquet.weak_form import galerkin
from hill import PeriodicEquation, UniformBeam, characteristic


def whole(g: float) -> UniformBeam:
    own = bar(g)
    return UniformBeam(
        T0=own.T0,
        K_theta=own.K_theta,
        xi_G=own.xi_G,
        omega_L=own.omega_L,
        g=g,
        modes=own.modes,
        quadrature_force=True,
    )


# T by scipy's DOP853, of the same force: `whole_force` in test_claims.
@pytest.mark.parametrize(
    ("g", "Omega", "T"),
    [(0.04, 2.0, 0.6753), (0.08, 2.0, 0.3105), (0.08, 2.05, 0.2104), (0.08, 4.0, 0.1476)],
)
def test_there_is_no_gap(g: float, Omega: float, T: float) -> None:
    """Stable in the report's equation, unstable with the whole force, by both routes."""
    report = crosscheck(bar(g), Omega=Omega, gamma=0.1)
    assert report.verdict == "stable"
    found = crosscheck(whole(g), Omega=Omega, gamma=0.1)
    assert found.routes_agree
    assert not found.shared_matrices
    assert found.verdict == "unstable"
    for route in (found.hill, found.floquet):
        assert pytest.approx(T, abs=1e-4) == route.T
    # Measured 2e-14: the two routes' own matrices, determinant against time.
    assert abs(found.hill.T - found.floquet.T) < 1e-11


def test_both_make_the_same_equation() -> None:
    closed, summed = whole(0.04).equation(2.0, 0.1, 0.01), galerkin(whole(0.04), 2.0, 0.1, 0.01)
    for one in (closed, summed):
        assert isinstance(one, PeriodicEquation)
        assert (one.K.harmonics, tuple(one.K.sin)) == ((1,), (1,))
    size = np.max(np.abs(closed.K.mean))
    for a, b in (
        (closed.K.mean, summed.K.mean),
        (closed.K.cos[1], summed.K.cos[1]),
        (closed.K.sin[1], summed.K.sin[1]),
        (closed.C.mean, summed.C.mean),
    ):
        assert np.max(np.abs(a - b)) < 1e-13 * size
    # at a resonance the sine is nearly the whole force
    assert np.max(np.abs(closed.K.sin[1])) > 5.0 * np.max(np.abs(closed.K.cos[1]))


def test_without_damping_there_is_no_such_part() -> None:
    plain = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=7.0)
    more = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=7.0, quadrature_force=True)
    one, two = plain.equation(1.1, 0.1).general(), more.equation(1.1, 0.1)
    assert np.array_equal(one.K.cos[1], two.K.cos[1])
    assert np.max(np.abs(two.K.sin[1])) < 1e-15
    found, other = monodromy(one), characteristic(two)
    assert abs(found.T - other.T) <= found.T_error + other.T_error


def test_refusals() -> None:
    with pytest.raises(ValueError, match="quadrature_force = 1: must be True or False"):
        UniformBeam(T0=1.0, K_theta=0.0, xi_G=0.0, quadrature_force=1)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="UniformBeam: must have a HillEquation"):
        beam_sensitivities(whole(0.04), Omega=2.0, gamma=0.1)
