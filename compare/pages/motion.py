"""The motion of a system over many periods, as pages show it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.floating[Any]]

PERIODS = 200
SHOWN = 8
"""Periods of which the history is drawn, sample by sample."""

SAMPLES = 24
"""A period: the highest frequency of the tables' rows turns 12 times in one at most."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Coordinates in time.

    Attributes
    ----------
    tau : (k,) ndarray
    q : (k, n) ndarray
    period : float
    largest : (periods, n) ndarray
        Of each coordinate's modulus in each period, among the samples.
    T : float
        The characteristic argument, for comparison.
    names : tuple of str
        Of the coordinates.
    shown : int
        Periods whose history is drawn.
    """

    tau: Float
    q: Float
    period: float
    largest: Float
    T: float
    names: tuple[str, ...]
    shown: int = SHOWN
