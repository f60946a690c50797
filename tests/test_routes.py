"""Frequency domain and time domain, on hundreds of systems that neither was written for."""

import numpy as np
import pytest
from systems import grows, largest_coefficient, random_system

from floquet import monodromy
from hill import characteristic

# By size, so that the compiled steps of one are used for all; 306 of them do not grow.
SEEDS = sorted(range(340), key=lambda seed: (seed % 8, seed))

# Largest difference over these seeds, of the largest coefficient: measured 3e-12 (seed 150, whose
# w reaches 10 with two harmonics), 5e-13 without it; 2e-11 where the solution grows by up to 1e6
# within the period, and a rounding error early in it as much.
AGREE = 1e-11
AGREE_GROWN = 1e-10


@pytest.mark.parametrize("seed", SEEDS)
def test_hill_is_floquet(seed: int) -> None:
    equation = random_system(seed)
    hill, floquet = characteristic(equation), monodromy(equation)
    difference = np.max(np.abs(hill.polynomial - floquet.polynomial))
    tolerance = AGREE_GROWN if grows(seed) else AGREE
    assert difference <= tolerance * np.max(np.abs(hill.polynomial))
    assert difference <= hill.error + floquet.error
    # Two intervals that hold the same number.
    assert abs(hill.T - floquet.T) <= hill.T_error + floquet.T_error


@pytest.mark.parametrize("seed", SEEDS[::8])
def test_cvodes_is_taylor(seed: int) -> None:
    equation = random_system(seed)
    taylor, cvodes = monodromy(equation), monodromy(equation, method="cvodes")
    difference = np.max(np.abs(taylor.polynomial - cvodes.polynomial))
    # Measured 5e-12, and 5e-11 where the solution grows.
    tolerance = 5e-10 if grows(seed) else 5e-11
    assert difference <= tolerance * np.max(np.abs(taylor.polynomial))
    assert difference <= taylor.error + cvodes.error


def test_the_sample_is_a_sample() -> None:
    """Sizes, damping, harmonics, resonance counts and growth are all there."""
    systems = [random_system(seed) for seed in SEEDS]
    w = [np.sqrt(np.abs(np.linalg.eigvals(s.F)).max()) / s.Omega for s in systems]
    spectra = [np.linalg.eigvals(s.F) for s in systems]
    size = [largest_coefficient(s) for s in systems]
    assert {s.n for s in systems} == set(range(1, 9))
    assert {len(s.H) for s in systems} == {0, 1, 2, 3}
    assert {s.ratio for s in systems if s.H} == {1, 2, 3}
    assert 100 < sum(s.eta > 0 for s in systems) < 220
    assert min(w) < 0.5
    assert 9.0 < max(w) < 11.0
    assert sum(1e3 <= p <= 1e6 for p in size) >= 32
    assert sum(p < 10 for p in size) > 100
    assert sum(np.any(e.real < 0) for e in spectra) > 20
    assert sum(np.any(np.abs(e.imag) > 1e-3 * np.abs(e)) for e in spectra) > 20
    assert all(s.n == 1 or not np.allclose(s.F, s.F.T) for s in systems)


def test_the_sample_is_the_same_every_time() -> None:
    one, other = random_system(77), random_system.__wrapped__(77)
    np.testing.assert_array_equal(one.F, other.F)
    assert (one.gamma, one.Omega, one.eta) == (other.gamma, other.Omega, other.eta)
