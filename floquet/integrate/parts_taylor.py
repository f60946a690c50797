"""Taylor steps over each part of the period, from the identity: their coefficients in CasADi."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import ceil
from typing import Any

import casadi as ca
import numpy as np

from floquet.arrays import EPS, Float
from floquet.integrate import recurrence
from floquet.integrate.normal_form import Harmonic, Layout, NormalForm
from floquet.integrate.parts import Grid, Parts
from floquet.integrate.step_length import longest_step
from floquet.integrate.taylor import MAX_STEPS, SX_OPERATIONS
from floquet.products import chain

# Numbers held side by side in one call.
CHUNK_NUMBERS = 1 << 20

# Of the exponential of a step's matrix, whose Perron root is below 3: 3^40/40! is 1e-29.
EXPONENTIAL_TERMS = 40


@dataclass(frozen=True)
class PartsTaylor:
    """Taylor steps of fixed order.

    Parameters
    ----------
    order : int
        Highest power of the step kept.
    tolerance : float
        What a step may leave out, of the solution's size; the default is below an ulp.
    """

    order: int = 24
    tolerance: float = 1e-17

    def steps(self, form: NormalForm) -> int:
        """How many the period takes.

        Raises
        ------
        ValueError
            More than `MAX_STEPS`.
        """
        longest = longest_step(*terms(form), self.order, self.tolerance)
        needed = form.period / longest
        if not needed <= MAX_STEPS:
            raise ValueError(
                f"Omega = {form.Omega:g}: too small, one period needs {needed:.3g} Taylor steps "
                f"(at most {MAX_STEPS:,})"
            )
        return max(ceil(needed), 1)

    def __call__(self, form: NormalForm, grid: Grid) -> Float:
        """Fundamental matrix of each part, (parts, m, m)."""
        return self.bounded(form, grid).matrices

    def bounded(self, form: NormalForm, grid: Grid) -> Parts:
        """The same with the size of what its errors are made of."""
        layout, unit, m = form.layout, grid.unit, form.layout.order
        total = grid.parts * grid.steps
        h = form.period / total / unit
        stiffness = form.stiffness * (unit if layout.first_order else unit * unit)
        given = [np.hstack(list(stiffness))]
        if layout.damped:
            given.append(np.hstack(list(form.damping * unit)))
        turn = 2.0 * np.pi / total * np.array(form.harmonics, float)
        scales = step_scales(form, unit, h)
        chunk = max(CHUNK_NUMBERS // (m * m * grid.steps), 1)
        found = []
        for first in range(0, grid.parts, chunk):
            count = min(chunk, grid.parts - first) * grid.steps
            at = first * grid.steps + np.arange(count)
            # in whole numbers the phase of a high harmonic loses nothing
            turns = (np.outer(np.array(form.harmonics, int), at) + total // 2) % total - total // 2
            phase = 2.0 * np.pi / total * turns
            wide = _mapped(layout, self.order, count)(h, turn, *given, np.cos(phase), np.sin(phase))
            each = np.asarray(wide).reshape(m, -1, grid.steps, m).transpose(2, 1, 0, 3)
            found.append(chain(each, *(np.broadcast_to(scale, each.shape) for scale in scales)))
        return Parts(*(np.concatenate(pieces) for pieces in zip(*found, strict=True)))


def step_scales(form: NormalForm, unit: float, h: float) -> tuple[Float, Float]:
    """What rounding may do to a step, in ulps, and the data's own errors."""
    # no step sums more than the exponential of the moduli
    most = _exponential(form.companion(form.largest, unit) * h)
    rounded = form.companion(form.rounded, unit, change=True) * (h / EPS)
    data = form.companion(form.data, unit, change=True) * h
    return most + most @ rounded @ most, most @ data @ most


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


@lru_cache(maxsize=256)
def _mapped(layout: Layout, order: int, count: int) -> Any:
    """`count` steps side by side; only the phases differ."""
    shared = 4 if layout.damped else 3
    return _step(layout, order).map("steps", "serial", count, list(range(shared)), [])


@lru_cache(maxsize=64)
def _step(layout: Layout, order: int) -> Any:
    """A step from the identity, in units of time in which its length is `h`."""
    n, m = layout.n, layout.order
    pulsating = 2 + len(layout.stiffness) + len(layout.damping)
    operations = n * m * order * (order + 2 * m) * pulsating // 2
    kind: Any = ca.SX if operations < SX_OPERATIONS else ca.MX
    h, turn = kind.sym("h"), kind.sym("turn", layout.harmonics)
    c, s = kind.sym("c", layout.harmonics), kind.sym("s", layout.harmonics)

    def system(matrix: Any, harmonics: Sequence[Harmonic]) -> tuple[Any, list[recurrence.Term]]:
        mean, *parts = ca.horzsplit(matrix, n)
        found = []
        for part, (k, is_sine) in zip(parts, harmonics, strict=True):
            series = recurrence.sine if is_sine else recurrence.cosine
            found.append((part, series(c[k], s[k], turn[k], order)))
        return mean, found

    K = kind.sym("K", n, n * (1 + len(layout.stiffness)))
    stiffness, given = system(K, layout.stiffness), [h, turn, K]
    damping = None
    if layout.damped:
        C = kind.sym("C", n, n * (1 + len(layout.damping)))
        damping = system(C, layout.damping)
        given.append(C)
    start = kind(ca.DM(np.eye(m)))
    if layout.first_order:
        end = recurrence.first_order(start, h, order, stiffness)
    else:
        Q, V = start[:n, :], start[n:, :]
        end = ca.vertcat(*recurrence.second_order(Q, V, h, order, stiffness, damping))
    return ca.Function("step", [*given, c, s], [ca.densify(end)])
