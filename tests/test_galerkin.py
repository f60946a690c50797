"""The two routes to the coefficient matrices, closed form and quadrature, must meet."""

import importlib
import math
import re
from typing import Any

import numpy as np
import pytest

from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam

# The module, whatever name the package may give to the function in it.
inside = importlib.import_module("floquet.weak_form")
shapes = importlib.import_module("floquet.trial_functions")

# Largest difference measured over the grid below, relative to the largest element of the matrix:
# 6e-15 for F and G, 1.2e-14 for H (N = 20); the rest is for other BLAS and libm.
TOLERANCE = 5e-14
INF = math.inf


def uniform(**changes: Any) -> UniformBeam:
    return UniformBeam(**({"T0": 20.0, "K_theta": 0.5, "xi_G": 0.3} | changes))


def stepped(**changes: Any) -> SteppedBeam:
    ratios = {"xi_c": 0.6, "area_ratio": 0.6, "inertia_ratio": 0.6}
    return SteppedBeam(**({"T0": 20.0, "K_theta": 1.0, "xi_G": 0.3} | ratios | changes))


def difference(one: HillEquation, other: HillEquation) -> float:
    """Largest difference of F, G, H, each relative to its own largest element."""
    pairs = zip((one.F, one.G, *one.H), (other.F, other.G, *other.H), strict=True)
    return max(float(np.max(np.abs(a - b)) / np.max(np.abs(b))) for a, b in pairs)


def disagreement(beam: UniformBeam | SteppedBeam, *forcing: Any) -> float:
    return difference(galerkin(beam, *forcing), beam.equation(*forcing))


@pytest.mark.parametrize("modes", [1, 2, 4, 12, 20])
@pytest.mark.parametrize("omega_L", [INF, 100.0, 3.3, 1e6, 0.07])
@pytest.mark.parametrize("g", [0.0, 0.04])
@pytest.mark.parametrize(("K_theta", "xi_G"), [(0.0, 0.5), (0.5, 0.0), (0.5, 0.37), (1.0, 1.0)])
def test_uniform(modes: int, omega_L: float, g: float, K_theta: float, xi_G: float) -> None:
    beam = uniform(modes=modes, omega_L=omega_L, g=g, K_theta=K_theta, xi_G=xi_G)
    assert disagreement(beam, 1.7, -0.3) < TOLERANCE


@pytest.mark.parametrize(
    ("modes", "terms"), [*((2, s) for s in range(1, 8)), (1, 7), (4, 7), (12, 7), (20, 7)]
)
@pytest.mark.parametrize("ratio", [2, 3])
@pytest.mark.parametrize("gamma", [0.4, -0.3, 0.0])
def test_vibration_from_an_unstrained_bar(modes: int, terms: int, ratio: int, gamma: float) -> None:
    beam = uniform(modes=modes, omega_L=ratio * 1.7)
    assert len(galerkin(beam, 1.7, gamma, 0.0, terms).H) == terms
    assert disagreement(beam, 1.7, gamma, 0.0, terms) < TOLERANCE


@pytest.mark.parametrize(
    ("modes", "xi_c"), [*((2, c) for c in (0.0, 0.1, 0.37, 0.6, 1.0)), (1, 0.6), (12, 0.6)]
)
@pytest.mark.parametrize("omega_L", [INF, 3.3, 1e6, 0.07])
@pytest.mark.parametrize(("area", "inertia"), [(0.6, 0.6), (2.0, 0.3), (1.0, 1.0)])
@pytest.mark.parametrize("K_theta", [0.0, 1.0])
def test_stepped(
    modes: int, omega_L: float, xi_c: float, area: float, inertia: float, K_theta: float
) -> None:
    shape = {"xi_c": xi_c, "area_ratio": area, "inertia_ratio": inertia}
    beam = stepped(modes=modes, omega_L=omega_L, K_theta=K_theta, **shape)
    assert disagreement(beam, 1.7, 0.4) < TOLERANCE


@pytest.mark.parametrize("omega_L", [INF, 0.07])
def test_stepped_with_twenty_modes(omega_L: float) -> None:
    assert disagreement(stepped(modes=20, omega_L=omega_L), 1.7, 0.4) < TOLERANCE


@pytest.mark.parametrize("omega_L", [INF, 100.0, 3.3])
@pytest.mark.parametrize("xi_c", [0.0, 0.37, 1.0])
def test_unit_ratios_are_the_uniform_beam(omega_L: float, xi_c: float) -> None:
    beam = stepped(modes=4, omega_L=omega_L, xi_c=xi_c, area_ratio=1.0, inertia_ratio=1.0)
    plain = uniform(modes=4, omega_L=omega_L, K_theta=1.0)
    assert difference(galerkin(beam, 1.7, 0.4), galerkin(plain, 1.7, 0.4)) < TOLERANCE


@pytest.mark.parametrize("beam", [uniform(omega_L=3.4), stepped(omega_L=3.4)])
def test_the_scalars_are_passed_on(beam: UniformBeam | SteppedBeam) -> None:
    equation = galerkin(beam, 1.7, -0.3, 0.02)
    assert (equation.Omega, equation.gamma, equation.eta) == (1.7, -0.3, 0.02)
    assert (equation.omega_L, equation.n, equation.H) == (3.4, 3, ())


def test_roots() -> None:
    published = [4.7300407448627040, 7.8532046240958376, 10.995607838001671]
    # Each is rounded once, and so is the literal: two units in the last place.
    np.testing.assert_allclose(shapes.eigenvalues(3), published, rtol=4e-16)


def test_modes_are_orthonormal_and_free_of_translation_and_rotation() -> None:
    roots = shapes.eigenvalues(20)
    _, weight, (w, _, _) = shapes.sampled(len(roots), 0.0, 0.0)
    rigid = [[1 / 3, 1 / 2], [1 / 2, 1.0]]
    expected = np.block([[np.eye(20), np.zeros((20, 2))], [np.zeros((2, 20)), np.array(rigid)]])
    # Measured 2e-15; lambda_20 xi reaches 64, known to half an ulp of that, 7e-15.
    np.testing.assert_allclose((w * weight) @ w.T, expected, atol=2e-14)


def test_modes_are_free_at_both_ends_and_start_at_two() -> None:
    roots = shapes.eigenvalues(20)
    w, _, curvature = shapes.trial(roots, np.array([0.0, 1.0]))
    # At xi = 1 the mode has the rounding of lambda_20, 7e-15, twice over: measured 1.6e-14.
    signs = (-1.0) ** np.arange(20)
    np.testing.assert_allclose(w[:20], 2.0 * np.stack([np.ones(20), signs], axis=1), atol=5e-14)
    np.testing.assert_allclose(curvature[:20] / roots[:, np.newaxis] ** 2, 0.0, atol=5e-14)


def test_derivatives_of_the_modes_are_those_of_the_modes() -> None:
    roots, h = shapes.eigenvalues(5), 1e-5
    xi = np.linspace(0.1, 0.9, 9)
    below, at, above = (shapes.trial(roots, x) for x in (xi - h, xi, xi + h))
    # Central difference: h**2 lambda_5**5 / 6 = 2e-5 of the curvature's slope.
    np.testing.assert_allclose((above[:2] - below[:2]) / (2 * h), at[1:], atol=1e-4)


def test_translation_enters_no_stiffness() -> None:
    _, slope, curvature = shapes.trial(shapes.eigenvalues(3), np.linspace(0.0, 1.0, 7))
    assert not np.any(slope[-1])
    assert not np.any(curvature[-1])


@pytest.mark.parametrize("beam", [uniform(modes=20), stepped(modes=20, omega_L=0.07)])
def test_more_points_change_nothing(
    beam: UniformBeam | SteppedBeam, monkeypatch: pytest.MonkeyPatch
) -> None:
    rule = galerkin(beam, 1.7, 0.4)
    monkeypatch.setattr(shapes, "PANEL_PHASE", 0.5 * shapes.PANEL_PHASE)
    assert difference(galerkin(beam, 1.7, 0.4), rule) < TOLERANCE


@pytest.mark.parametrize("beam", [uniform(omega_L=3.3), stepped(omega_L=3.3)])
@pytest.mark.parametrize(
    ("name", "altered", "least"),
    [
        ("_axial_end", lambda w, slope: np.zeros((len(w), len(w))), 0.1),
        ("_axial_end", lambda w, slope: np.outer(slope, w), 0.1),
        ("_uniform_force", lambda *_: lambda xi: xi, 0.01),
        ("_stepped_force", lambda *_: lambda xi: xi, 0.01),
        ("eigenvalues", lambda n, roots=shapes.eigenvalues: roots(n) * (1 + 1e-11), 1e-12),
    ],
    ids=["no follower thrust", "transposed", "rigid uniform", "rigid stepped", "roots"],
)
def test_an_altered_weak_form_is_seen(
    beam: UniformBeam | SteppedBeam,
    name: str,
    altered: Any,
    least: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if name == "_uniform_force" and isinstance(beam, SteppedBeam):
        pytest.skip("the stepped beam has its own")
    if name == "_stepped_force" and isinstance(beam, UniformBeam):
        pytest.skip("the uniform beam has its own")
    monkeypatch.setattr(shapes if name == "eigenvalues" else inside, name, altered)
    # what is remembered knows nothing of it
    for remembered in ("_on_panels", "trial_at"):
        monkeypatch.setattr(shapes, remembered, getattr(shapes, remembered).__wrapped__)
    assert disagreement(beam, 1.7, 0.4) > least > 10 * TOLERANCE


@pytest.mark.parametrize(
    ("beam", "forcing", "message"),
    [
        (uniform(), (0.0, 0.1), "Omega = 0"),
        (uniform(), (-1.0, 0.1), "Omega = -1"),
        (uniform(), (INF, 0.1), "Omega = inf"),
        (uniform(), (1.0, math.nan), "gamma = nan"),
        (uniform(), (1.0, "0.1"), "gamma = '0.1'"),
        (uniform(), (1.0, 0.1, math.nan), "eta = nan"),
        (uniform(), (1.0, 0.1, 0.0, -1), "initial_terms = -1"),
        (uniform(), (1.0, 0.1, 0.0, 1.0), "initial_terms = 1.0"),
        (uniform(), (1.0, 0.1, 0.0, 3), "initial_terms = 3: needs a finite omega_L"),
        (uniform(omega_L=2.0, g=0.04), (1.0, 0.1, 0.0, 3), "initial_terms = 3: must be 0 with"),
        (uniform(omega_L=2.5), (1.0, 0.1, 0.0, 1), "omega_L/Omega = 2.5"),
        (stepped(omega_L=2.0), (1.0, 0.1, 0.0, 1), "initial_terms = 1: must be 0"),
        (uniform(omega_L=2.0), (2.0, 0.1), "Omega = 2 is a longitudinal resonance"),
        (uniform(omega_L=0.1), (0.3, 0.1), "Omega = 0.3 is a longitudinal resonance"),
        (stepped(omega_L=3.3, xi_c=0.5), (3.3, 0.1), "longitudinal resonance"),
        (stepped(omega_L=0.05), (1.75, 0.1), "longitudinal resonance"),
        (stepped(omega_L=2.0, xi_c=1.0, area_ratio=2.0), (4.0, 0.1), "longitudinal resonance"),
    ],
)
def test_refusals(beam: UniformBeam | SteppedBeam, forcing: tuple[Any, ...], message: str) -> None:
    """Both routes refuse, each with one line that names the parameter."""
    for route in (beam.equation, lambda *given: galerkin(beam, *given)):
        with pytest.raises(ValueError, match=re.escape(message)) as refusal:
            route(*forcing)
        assert "\n" not in str(refusal.value)


def test_damping_carries_the_beam_through_resonance() -> None:
    assert disagreement(uniform(omega_L=2.0, g=0.04), 2.0, 0.1) < TOLERANCE


@pytest.mark.parametrize("offset", [1e-3, 1e-6, 1e-9])
def test_near_resonance_the_routes_still_meet(offset: float) -> None:
    """The force is large there, but both routes see the same rounded Omega/omega_L."""
    # Uniform: 4e-15 at any offset. Stepped: nu xi_c and nu (1 - xi_c) are rounded apart, measured
    # 5e-17 / offset.
    tolerance = max(TOLERANCE, 1e-15 / offset)
    assert disagreement(uniform(omega_L=1.0), 1.0 + offset, 0.1) < TOLERANCE
    resonant = stepped(omega_L=1.0, xi_c=0.37, area_ratio=1.0)
    assert disagreement(resonant, 1.0 + offset, 0.1) < tolerance


# ---- where the stepped bar resonates -------------------------------------------------------------


def bar_with(sigma: float, xi_c: float, area_ratio: float) -> float:
    """Free end to free end: the force at xi = 1 of a bar that starts with u = 1, P = 0."""
    nu = np.pi * sigma
    u, P = np.cos(nu * xi_c), -area_ratio * nu * np.sin(nu * xi_c)
    rest = nu * (1.0 - xi_c)
    return float(P * np.cos(rest) - nu * u * np.sin(rest)) / nu


@pytest.mark.parametrize("xi_c", [0.0, 0.3, 0.5, 0.6, 0.999])
@pytest.mark.parametrize("area_ratio", [1e-6, 1e-3, 0.6, 1.0, 7.0, 1e6])
def test_a_stepped_bar_has_one_resonance_beside_every_whole_number(
    xi_c: float, area_ratio: float
) -> None:
    found = stepped(xi_c=xi_c, area_ratio=area_ratio, omega_L=1.0).singular_Omega(0.0, 40.49)
    assert np.array_equal(np.round(found), np.arange(1, 41))
    for sigma in found:
        # on both sides of a change of sign, by the wave equation
        values = [bar_with(sigma + d, xi_c, area_ratio) for d in (-1e-9, 1e-9)]
        assert values[0] * values[1] <= 0.0 or min(map(abs, values)) < 1e-12 * (1.0 + area_ratio)


def test_two_resonances_close_together_are_both_found() -> None:
    """A thin bar on a thick one: at 2.5 one of each would meet."""
    beam = stepped(xi_c=0.6, area_ratio=1e-4, omega_L=1.0)
    found = beam.singular_Omega(2.008, 3.008)
    assert len(found) == 2
    assert 0.005 < found[1] - found[0] < 0.015
    assert beam.singular_Omega(found[0] + 1e-6, 2.5).size == 0


def test_a_uniform_bar_resonates_at_whole_numbers() -> None:
    found = stepped(xi_c=0.3, area_ratio=1.0, omega_L=1.0).singular_Omega(0.5, 30.0)
    np.testing.assert_allclose(found, np.arange(1, 31), rtol=1e-14)
