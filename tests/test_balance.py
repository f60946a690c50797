"""Coordinates in units of their own: P stays, and its error is no longer the units'."""

import numpy as np
import pytest

from benchmarks.honesty import systems
from benchmarks.honesty.arbiter import largest_error, reference
from floquet.batch import c_kernel, sweep
from floquet.batch.balance import ALIKE, balanced

KERNELS = ("numpy", *(["compiled"] if c_kernel.march(3, 1) is not None else []))


def spread(n: int, most: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A matrix without preference for a coordinate, and the same in units far apart."""
    rng = np.random.default_rng(seed)
    D = 2.0 ** np.round(rng.uniform(-most, most, n))
    M = rng.standard_normal((2, n, n))
    return M, D[:, None] * M / D


@pytest.mark.parametrize("n", [2, 3, 6, 20])
def test_rows_and_columns_become_alike(n: int) -> None:
    _, far = spread(n, 40.0)
    found = balanced(far, np.ones((2, 4)))
    total = np.sum(np.abs(found), axis=0) * (1.0 - np.eye(n))
    assert np.all(np.abs(np.log2(total.max(axis=0) / total.max(axis=1))) <= ALIKE)
    before = np.sum(np.abs(far), axis=0) * (1.0 - np.eye(n))
    assert np.any(np.abs(np.log2(before.max(axis=0) / before.max(axis=1))) > 10.0)


def test_nothing_is_rounded_and_every_product_round_a_loop_stays() -> None:
    _, far = spread(3, 40.0)
    found = balanced(far, np.ones((2, 1)))
    assert np.all(np.frexp(found / far)[0] == 0.5)
    for M, N in zip(far, found, strict=True):
        assert np.all(np.diag(M) == np.diag(N))
        assert N[0, 1] * N[1, 2] * N[2, 0] == pytest.approx(M[0, 1] * M[1, 2] * M[2, 0], rel=1e-15)


def test_each_point_has_its_own() -> None:
    """Matrices side by side, (terms, k, n, n): as one by one."""
    every = np.stack(
        [spread(3, most, seed)[1] for seed, most in enumerate((0.0, 20.0, 40.0))], axis=1
    )
    together = balanced(every, np.ones((2, 3)))
    for k in range(3):
        assert np.array_equal(together[:, k], balanced(every[:, k], np.ones((2, 1))))


@pytest.mark.parametrize(
    "M",
    [
        np.ones((2, 1, 1)),
        np.ones((2, 3, 3)),
        np.stack([np.triu(np.ones((3, 3)), 1)] * 2),  # a column, and a row, of nothing
        np.zeros((2, 3, 3)),
        np.full((2, 2, 2), 1e300),
    ],
    ids=["one", "alike", "nilpotent", "nothing", "huge"],
)
def test_what_needs_none_is_left_as_it_is(M: np.ndarray) -> None:
    assert np.array_equal(balanced(M, np.ones((2, 4))), M)


@pytest.mark.parametrize("kernel", KERNELS)
def test_bounds_hold_where_units_are_far_apart(kernel: str) -> None:
    """Elements from 1e-9 to 1e4: inverted as it was, U moved P by 2.6 times its bound."""
    own = systems.members("mixed scales", 50, 2)[:4]
    found = sweep(
        own[0],
        Omega=[e.Omega for e in own],
        gamma=[e.gamma for e in own],
        eta=[e.damping for e in own],
        kernel=kernel,  # type: ignore[arg-type]
    )
    for P, error, equation in zip(found.coefficients, found.errors, own, strict=True):
        # measured .03 of the bound
        assert largest_error(P, reference(equation)) <= 0.3 * error
