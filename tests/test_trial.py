"""The trial of the bounds on a sample, its arbiter against closed forms, and what it catches."""

import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh_tridiagonal

from hill import HillEquation

# last, so that what is installed comes before what lies beside it
sys.path.append(str(Path(__file__).parents[1]))

arbiter = import_module("benchmarks.honesty.arbiter")
run = import_module("benchmarks.honesty.run")


def test_the_arbiter_on_constant_coefficients() -> None:
    """z = cos(2 pi w/Omega), w^2 = F - eta^2/4."""
    w = np.array([0.7, 1.9])
    equation = HillEquation(np.diag(w**2), np.eye(2), 0.0, 1.3)
    truth = arbiter.reference(equation)
    expected = np.poly(np.cos(2.0 * np.pi * w / 1.3))
    # the squares and the cosines are rounded: ten ulps of w^2 and of z
    assert arbiter.largest_error(expected, truth) < 1e-14


def test_the_arbiter_on_mathieu() -> None:
    """At a characteristic value a_0(q) of x'' + (a - 2 q cos 2t) x = 0 z is 1."""
    q, size = 3.0, 40
    # Fourier's matrix of the even solutions of period pi, made symmetric
    off = np.full(size - 1, q)
    off[0] *= np.sqrt(2.0)
    a = eigh_tridiagonal((2.0 * np.arange(size)) ** 2, off, eigvals_only=True)[0]
    truth = arbiter.reference(HillEquation([[a]], [[1.0]], -2.0 * q, 2.0))
    # dz/da is 18 there, and a is known to 2e-14
    assert arbiter.largest_error([1.0, -1.0], truth) < 1e-12


@pytest.mark.parametrize("seed", [1, 2])
def test_no_bound_is_too_small(seed: int, capsys: pytest.CaptureFixture[str]) -> None:
    assert run.main(["--count", "160", "--seed", str(seed), "--jobs", "1"]) == 0
    assert "ill-conditioned" in capsys.readouterr().out


def test_a_bound_that_was_shrunk_is_caught(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--count", "32", "--jobs", "1", "--classes", "ordinary", "growth"]
    assert run.main([*words, "--shrink", "1e-3"]) == 1
    assert "off by" in capsys.readouterr().out
