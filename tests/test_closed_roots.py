"""What edges are read from, in closed form up to the third degree: held against roots chosen."""

import numpy as np
import pytest

from compare.stability.roots import discriminant, growth, growth_off_axis, real_range

RNG = np.random.default_rng(5)


def chosen(n: int, complex_pair: bool) -> tuple[np.ndarray, np.ndarray]:
    """Many polynomials and the roots that they are made of."""
    z = RNG.uniform(-1.5, 1.5, (200, n)).astype(complex)
    if complex_pair:
        y = RNG.uniform(0.05, 1.0, 200)
        z[:, 0], z[:, 1] = z[:, 0] + 1j * y, z[:, 0] - 1j * y
    return np.array([np.poly(line).real for line in z]), z


@pytest.mark.parametrize("n", [2, 3, 4])
@pytest.mark.parametrize("complex_pair", [False, True])
def test_closed_forms(n: int, complex_pair: bool) -> None:
    P, z = chosen(n, complex_pair)
    j, k = np.triu_indices(n, 1)
    gaps = np.abs(z[:, j] - z[:, k]).min(axis=1)
    # roots are known to P's rounding over the distances between them
    apart = 1e-13 / gaps ** (n - 1)
    least, largest = real_range(P)
    assert np.all(np.abs(least - z.real.min(axis=1)) <= apart)
    assert np.all(np.abs(largest - z.real.max(axis=1)) <= apart)
    product = np.prod((z[:, j] - z[:, k]) ** 2, axis=1).real
    assert np.allclose(discriminant(P), product, rtol=1e-6, atol=1e-11)
    if complex_pair:
        pair = z[:, 0]
        grows = np.log(np.abs(pair + np.sqrt(pair - 1.0) * np.sqrt(pair + 1.0)))
        assert np.all(np.abs(growth_off_axis(P) - grows) <= 1e2 * apart)
    else:
        clear = gaps > 1e-3
        assert np.all(growth_off_axis(P[clear]) == 0.0)


def test_first_degree() -> None:
    least, largest = real_range(np.array([[1.0, -0.3], [1.0, 2.0]]))
    assert least.tolist() == largest.tolist() == [0.3, -2.0]
    assert discriminant(np.array([[1.0, -0.3]])).tolist() == [1.0]


@pytest.mark.parametrize("large", [1e49, 1e120, -1e160, 1e290])
@pytest.mark.parametrize("others", [(), (0.5,), (0.5, -0.2), (0.5, -0.2, 3.0)])
def test_growth_of_what_a_square_would_take_out_of_the_floats(
    large: float, others: tuple[float, ...]
) -> None:
    p = np.poly([large, *others])
    found = growth(np.column_stack([p, np.poly([1.25, *others])]))
    largest = np.arccosh(max([1.25, *others]))
    assert found == pytest.approx([np.log(2.0) + np.log(abs(large)), largest], rel=1e-14)
