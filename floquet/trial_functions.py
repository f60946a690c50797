"""The trial functions of the weak form, and the rule that integrates two of them times a wave."""

from functools import cache, lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from floquet.arrays import frozen

Array = NDArray[np.float64]

# Worst error measured for the mean of exp(i k xi) or exp(k xi) over a panel of k h <= PANEL_PHASE:
# 4e-9 with 10 points, 1e-12 with 12, 1e-15 with 14; two more are in hand. From 18 on, the rounding
# of numpy's weights grows to 1e-14.
POINTS = 16
# Panels whose nodes are remembered: a wave has 4 on the report's beams, with 80 modes 80.
MAX_KEPT_PANELS = 200
PANEL_PHASE = 4.0 * np.pi


def sampled(modes: int, wavenumber: float, step: float) -> tuple[Array, Array, Array]:
    """Nodes and weights for two modes times a wave, with a joint at the step; the shapes there."""
    joints = tuple(sorted({0.0, step, 1.0}))
    fastest = 2.0 * eigenvalues(modes)[-1] + wavenumber
    counts = tuple(int(np.ceil((q - p) * fastest / PANEL_PHASE)) for p, q in pairwise(joints))
    make = _on_panels if sum(counts) <= MAX_KEPT_PANELS else _made_on_panels
    return make(modes, joints, counts)


def _made_on_panels(
    modes: int, joints: tuple[float, ...], counts: tuple[int, ...]
) -> tuple[Array, Array, Array]:
    """Composite Gauss-Legendre nodes and weights on [0, 1], and `trial` there."""
    panels = [
        np.linspace(p, q, 1 + count) for (p, q), count in zip(pairwise(joints), counts, strict=True)
    ]
    edges = np.unique(np.concatenate(panels))
    half = 0.5 * np.diff(edges)[:, np.newaxis]
    node, weight = _gauss()
    xi = frozen((edges[:-1, np.newaxis] + half * (1.0 + node)).ravel())
    return xi, frozen((half * weight).ravel()), frozen(trial(eigenvalues(modes), xi))


_on_panels = lru_cache(maxsize=64)(_made_on_panels)


@lru_cache(maxsize=64)
def trial_at(modes: int, xi: float) -> Array:
    """`trial` at one station, (3, N + 2)."""
    return frozen(trial(eigenvalues(modes), np.array([xi]))[:, :, 0])


@cache
def _gauss() -> tuple[Array, Array]:
    node, weight = np.polynomial.legendre.leggauss(POINTS)
    return frozen(node), frozen(weight)


@lru_cache(maxsize=64)
def eigenvalues(count: int) -> Array:
    """lambda_n of cos x = 1/cosh x, as (n + 1/2) pi + d so that d is found to full precision."""

    def residual(d: float, n: int) -> float:
        decay = np.exp(-(n + 0.5) * np.pi - d)
        return float(-((-1) ** n) * np.sin(d) - 2.0 * decay / (1.0 + decay**2))

    pairs = [(n, (n + 0.5) * np.pi) for n in range(1, count + 1)]
    found = [c + brentq(residual, -1.0, 1.0, (n,), xtol=1e-20) for n, c in pairs]
    return frozen(np.array(found, float))


def trial(roots: Array, xi: Array) -> Array:
    """phi_1 .. phi_N, xi, 1 and their first two derivatives at xi: (3, N + 2, points)."""
    k = roots[:, np.newaxis]
    cos, sin = np.cos(k * xi), np.sin(k * xi)
    # cosh - s sinh in two exponentials; the growing one is measured from xi = 1, or it overflows
    # and its small coefficient (1 - s)/2 = far exp(-lambda) is lost in rounding.
    decay = np.exp(-k)
    far = (np.cos(k) - np.sin(k) - decay) / (1.0 - decay**2 - 2.0 * decay * np.sin(k))
    s = 1.0 - 2.0 * far * decay
    near, growing = (1.0 - far * decay) * np.exp(-k * xi), far * np.exp(k * (xi - 1.0))
    one, zero = np.ones((1, len(xi))), np.zeros((1, len(xi)))
    return np.array(
        [
            np.vstack([cos - s * sin + near + growing, xi[np.newaxis], one]),
            np.vstack([k * (-sin - s * cos - near + growing), one, zero]),
            np.vstack([k**2 * (-cos + s * sin + near + growing), zero, zero]),
        ]
    )
