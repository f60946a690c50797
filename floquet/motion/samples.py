"""The fundamental matrix at equally spaced times of one period, each element with a bound.

A run by Taylor steps of order 24 is checked by one of order 29 with other steps, between each two
samples; what that leaves unsure is carried to all later ones by the products that carry the motion.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil

import numpy as np

from floquet.accuracy import OVERFLOW, ROUNDING_SAFETY, SAFETY, largest_share
from floquet.arrays import EPS, Float
from floquet.general.period import ULPS
from floquet.integrate.normal_form import NormalForm, normal_form
from floquet.integrate.parts import Grid
from floquet.integrate.parts_taylor import PartsTaylor
from floquet.many import rounded
from hill import HillEquation, PeriodicEquation

CHECK = PartsTaylor(order=29)

# Between blocks of samples errors are carried by the products themselves, which takes the square of
# this many; within one by moduli, over so short a time that these grow little.
MAX_BLOCKS = 128
# Of large matrices fewer: numbers in all products side by side.
BLOCK_NUMBERS = 1 << 17

# Products that carry errors are rounded themselves.
WIDENED = 1.01


@dataclass(frozen=True, eq=False)
class SampledPeriod:
    """The fundamental matrix of (q, q'), or of x, at the samples of one period.

    Attributes
    ----------
    matrices, errors : (samples + 1, m, m) ndarray
        From the identity on to the monodromy matrix; bounds on the error of each element.
    """

    matrices: Float
    errors: Float


@dataclass(frozen=True, eq=False)
class PartsOfPeriod:
    """What takes each sample to the next, in units that balance the state.

    Attributes
    ----------
    matrices, errors : (samples, m, m) ndarray
        Bounds on the error of each element.
    units : (m,) ndarray
        A state as given is this many times the balanced one.
    """

    matrices: Float
    errors: Float
    units: Float


def sampled_period(equation: HillEquation | PeriodicEquation, samples: int) -> SampledPeriod:
    """Integrate one period from each sample to the next.

    Raises
    ------
    OverflowError
        The growth within the period is beyond a float.
    """
    parts = parts_of_period(equation, lambda form: samples)
    with np.errstate(over="ignore", invalid="ignore"):
        Phi, unsure = _products(parts.matrices, parts.errors)
    if not (np.all(np.isfinite(Phi)) and np.all(np.isfinite(unsure))):
        raise OverflowError(OVERFLOW)
    units = parts.units
    return SampledPeriod(units[:, None] * Phi / units, units[:, None] * unsure / units)


def parts_of_period(
    equation: HillEquation | PeriodicEquation, count: Callable[[NormalForm], int]
) -> PartsOfPeriod:
    """Integrate from each of `count(form)` samples of a period to the next.

    Raises
    ------
    OverflowError
        The growth between two samples is beyond a float.
    """
    if isinstance(equation, HillEquation):
        form = normal_form(equation.general(), rounded(equation))
    else:
        form = normal_form(equation)
    samples = count(form)
    grid = Grid.of(form, samples, ceil(PartsTaylor().steps(form) / samples))
    with np.errstate(over="ignore", invalid="ignore"):
        matrices, errors = _checked_parts(form, grid)
    if not (np.all(np.isfinite(matrices)) and np.all(np.isfinite(errors))):
        raise OverflowError(OVERFLOW)
    return PartsOfPeriod(matrices, errors, form.state_units(grid.unit))


def _checked_parts(form: NormalForm, grid: Grid) -> tuple[Float, Float]:
    """Each sample from the one before it, and bounds on the errors of that."""
    own = PartsTaylor().bounded(form, grid)
    # orders 24 and 29 need steps as 3 to 2; of one and two steps the check has one more
    steps = grid.steps + 1 if grid.steps < 3 else ceil(2 * grid.steps / 3)
    apart = np.abs(own.matrices - CHECK(form, grid.again(steps)))
    of_all = largest_share(apart, own.rounding) * own.rounding
    rounding = ROUNDING_SAFETY * EPS * ULPS * own.rounding
    return own.matrices, SAFETY * np.maximum(apart, of_all) + rounding


def _products(P: Float, E: Float) -> tuple[Float, Float]:
    """P_j ... P_1 of all j, with bounds on their errors, from those of the P."""
    count, m = P.shape[:2]
    blocks = max(min(count, MAX_BLOCKS, BLOCK_NUMBERS // (m * m)), 1)
    edges = np.linspace(0, count, blocks + 1).astype(int)
    Phi, S = np.empty((2, count + 1, m, m))
    Phi[0], S[0] = np.eye(m), 0.0
    # what takes each block's end to the present, and what that block added to the error there
    carried, added = np.empty((0, m, m)), np.empty((0, m, m))
    for a, b in itertools.pairwise(edges):
        Psi, L = np.eye(m), np.zeros((m, m))
        for j in range(a, b):
            size = np.abs(P[j])
            L = size @ L + E[j] @ (np.abs(Psi) + L) + (m + 2) * EPS * size @ np.abs(Psi)
            Psi = P[j] @ Psi
            here = L @ (np.abs(Phi[a]) + S[a]) + (m + 2) * EPS * np.abs(Psi) @ np.abs(Phi[a])
            Phi[j + 1] = Psi @ Phi[a]
            S[j + 1] = WIDENED * (np.sum(np.abs(Psi @ carried) @ added, axis=0) + here)
        carried = np.concatenate([Psi @ carried, np.eye(m)[None]])
        added = np.concatenate([added, here[None]])
    return Phi, S
