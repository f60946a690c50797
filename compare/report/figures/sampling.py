"""Where to evaluate a curve so that straight lines between its points look like it."""

import numpy as np

from compare.report.figures.data import Float
from compare.stability.indicators import Function

# Largest distance of a curve from its chord, as a share of the axis: half a printed line's width.
FLATNESS = 5e-4
ROUNDS = 8


def adaptive(f: Function, x: Float, height: float) -> tuple[Float, Float]:
    """Halve intervals until the middle of each is on its chord; above `height` nothing is shown.

    Parameters
    ----------
    f : callable
        Many x to many values.
    x : (k,) ndarray
        Ascending points to start from, fine enough to see every feature.
    height : float
        Top of the axis.
    """
    y = f(x)
    new = np.ones(len(x) - 1, bool)
    for _ in range(ROUNDS):
        left = np.flatnonzero(new)
        shown = np.minimum(y[left], y[left + 1]) < height
        left = left[shown]
        if not len(left):
            break
        middle = 0.5 * (x[left] + x[left + 1])
        value = f(middle)
        off = np.abs(value - 0.5 * (y[left] + y[left + 1])) > FLATNESS * height
        order = np.argsort(np.append(x, middle), kind="stable")
        flags = np.append(np.zeros(len(x), bool), off)[order]
        x, y = np.append(x, middle)[order], np.append(y, value)[order]
        new = flags[:-1] | flags[1:]
    return x, y
