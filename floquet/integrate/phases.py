"""Many stretches of time from few: a short one is a short Fourier series in its phase.

Two stretches make one of twice the length, and that one is a series again, until the equation
changes too much in it. So a period of thousands of steps is a product of some dozens of matrices.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from floquet.arrays import EPS, Complex, Float

Whole = NDArray[np.integer[Any]]

# Phases at which stretches are found, to begin with; doubled while they do not tell all others.
FIRST_PHASES = 8

# Others than these few must be so many times as many, or it is not tried.
WORTH = 4

# A harmonic below so many ulps of what is summed is rounding.
NOISE = 8.0


class Stretch(Protocol):
    """What a stretch of a certain length does, by the phase at which it begins."""

    def __call__(self, at: Whole, of: int) -> Float:
        """Matrices (k, m, m) of those that begin at these `of`-ths of the period."""
        ...


@dataclass(frozen=True, eq=False)
class Series:
    """A stretch by the Fourier series in its phase.

    Attributes
    ----------
    series : (1 + harmonics, m, m) complex ndarray
        The mean, and twice the amplitude of exp(i k phase).
    largest : (m, m) ndarray
        Moduli of the elements, the largest over the phases looked at.
    """

    series: Complex
    largest: Float

    def __call__(self, at: Whole, of: int) -> Float:
        """As `Stretch`."""
        k = np.arange(len(self.series))
        phase = 2.0 * np.pi / of * (np.outer(at, k) % of)
        flat = self.series.reshape(len(k), -1)
        found = np.cos(phase) @ flat.real - np.sin(phase) @ flat.imag
        return found.reshape(len(at), *self.series.shape[1:])


@dataclass(frozen=True, eq=False)
class Pair:
    """Two stretches of one length, one after the other; that is one of `parts` of the period."""

    half: Stretch
    parts: int

    def __call__(self, at: Whole, of: int) -> Float:
        """As `Stretch`."""
        return self.half(at * self.parts + of, of * self.parts) @ self.half(at, of)


def series(stretch: Stretch, scale: Float, wanted: int) -> Series | None:
    """The Fourier series of a stretch, where few phases tell it.

    It is known when its upper half is rounding.

    Parameters
    ----------
    stretch : Stretch
    scale : (m, m) ndarray
        What a stretch sums, in ulps.
    wanted : int
        How many are wanted in all.
    """
    count = FIRST_PHASES
    known = np.empty((0, *scale.shape))
    while WORTH * count <= wanted:
        if len(known):
            between = stretch(np.arange(1, count, 2), count)
            known = np.stack([known, between], axis=1).reshape(count, *scale.shape)
        else:
            known = stretch(np.arange(count), count)
        found = np.fft.rfft(known, axis=0) / count
        if np.all(np.abs(found[count // 4 :]) <= NOISE * EPS * scale):
            # what is counted twice is the other half, that of -k
            return Series(np.concatenate([found[:1], 2.0 * found[1:-1]]), np.max(np.abs(known), 0))
        count *= 2
    return None


def condensed(
    stretch: Stretch, scales: Sequence[Float], total: int, each: int, first: int
) -> tuple[Stretch, int, list[Float]]:
    """A longer stretch in the place of a step, where there is one that few phases tell.

    Parameters
    ----------
    stretch : Stretch
        A step.
    scales : sequence of (m, m) ndarray
        Bounds on what it may be off, the first in ulps.
    total, each, first : int
        Steps in the period, in a part of it, and to be taken.

    Returns
    -------
    stretch : Stretch
    length : int
        How many steps it is: a power of two that divides `each`.
    scales : list of (m, m) ndarray
        Bounds on what it may be off.
    """
    length, bounds = 1, list(scales)
    while True:
        known = series(stretch, bounds[0], first // length)
        if known is None:
            return stretch, length, bounds
        stretch = known
        if each % (2 * length):
            return stretch, length, bounds
        A = known.largest
        bounds = [A @ scale + scale @ A for scale in bounds]
        # the sum of a series, and the product
        bounds[0] = bounds[0] + A @ A
        stretch, length = Pair(known, total // length), 2 * length
