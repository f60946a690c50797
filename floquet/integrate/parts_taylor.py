"""Taylor steps over each part of the period, from the identity: their coefficients in CasADi."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from floquet.arrays import EPS, Float
from floquet.integrate.normal_form import Harmonic, NormalForm
from floquet.integrate.parts import Grid, Parts
from floquet.integrate.phases import condensed
from floquet.integrate.step_length import TaylorSteps
from floquet.integrate.steps import Steps
from floquet.products import chain

# Numbers held side by side in one call.
CHUNK_NUMBERS = 1 << 20

# Of the exponential of a step's matrix, whose Perron root is below 3: 3^40/40! is 1e-29.
EXPONENTIAL_TERMS = 40


@dataclass(frozen=True)
class PartsTaylor(TaylorSteps):
    """Taylor steps over each part of the period."""

    def steps(self, form: NormalForm) -> int:
        """How many the period takes; see `TaylorSteps.count`."""
        return self.count(*terms(form), form.period, form.Omega)

    def __call__(self, form: NormalForm, grid: Grid) -> Float:
        """Fundamental matrix of each part, (parts, m, m)."""
        return self.bounded(form, grid).matrices

    def bounded(self, form: NormalForm, grid: Grid) -> Parts:
        """The same with the size of what its errors are made of."""
        m, total = form.layout.order, grid.parts * grid.steps
        step = Steps(form, self.order, total, grid.unit)
        scales = step_scales(form, grid.unit, step.h)
        stretch, length, scales = condensed(
            step, scales, total, grid.steps, grid.first * grid.steps
        )
        each = grid.steps // length
        chunk = max(CHUNK_NUMBERS // (m * m * each), 1)
        found = []
        for first in range(0, grid.first, chunk):
            count = min(chunk, grid.first - first) * each
            factors = stretch(first * each + np.arange(count), total // length)
            factors = np.moveaxis(factors.reshape(-1, each, m, m), 1, 0)
            found.append(chain(factors, *(np.broadcast_to(x, factors.shape) for x in scales)))
        matrices, rounding, *data = (np.concatenate(x) for x in zip(*found, strict=True))
        return Parts(matrices, rounding, data[0] if data else None)


def step_scales(form: NormalForm, unit: float, h: float) -> list[Float]:
    """What rounding may do to a step, in ulps, and the data's own errors, where there are any."""
    # no step sums more than the exponential of the moduli
    most = _exponential(form.companion(form.largest, unit) * h)
    rounded = form.companion(form.rounded, unit, change=True) * (h / EPS)
    data = form.companion(form.data, unit, change=True) * h
    scales: list[Float] = [most + most @ rounded @ most]
    if np.any(data):
        scales.append(most @ data @ most)
    return scales


def terms(form: NormalForm) -> tuple[list[tuple[Float, float]], list[tuple[Float, float]]]:
    """Stiffness and damping matrices with the frequencies of their cosines and sines.

    Those of an equation of first order are all damping.
    """

    def pairs(matrices: Float, harmonics: Sequence[Harmonic]) -> list[tuple[Float, float]]:
        frequencies = [0.0, *(form.harmonics[k] * form.Omega for k, _ in harmonics)]
        return list(zip(matrices, frequencies, strict=True))

    stiffness = pairs(form.stiffness, form.layout.stiffness)
    if form.layout.first_order:
        return [(np.zeros_like(form.stiffness[0]), 0.0)], stiffness
    damping = pairs(form.damping, form.layout.damping)
    return stiffness, damping


def _exponential(matrix: Float) -> Float:
    """Of a matrix without negative elements whose Perron root is near 1; nothing cancels."""
    total = term = np.eye(len(matrix))
    for k in range(1, EXPONENTIAL_TERMS):
        term = term @ matrix / k
        total = total + term
    return total
