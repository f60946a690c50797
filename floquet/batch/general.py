"""The polynomial of the multipliers of many general equations at once, by numpy.

All steps of all equations are found side by side, each from the identity, in the phase Omega tau,
in which every period is 2 pi; then the steps of each are multiplied.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, factorial, floor, log2

import numpy as np

from floquet.arrays import EPS, Float
from floquet.charpoly import characteristic_polynomials
from floquet.general.period import general_monodromy
from floquet.integrate.normal_form import NormalForm, normal_form
from floquet.integrate.parts_taylor import PartsTaylor, step_scales
from floquet.integrate.phases import Whole
from floquet.products import chain
from hill import PeriodicEquation

ORDER = 24
"""As for `floquet.integrate.parts_taylor.PartsTaylor`."""

# Numbers of the series held side by side: they stay in the cache.
CHUNK_NUMBERS = 1 << 18

# Rounding, in ulps of the moduli summed: what `monodromy` takes for it where its two runs differ by
# an ulp. Over 50 random equations, held against ball arithmetic, 0.06 of the bound at most.
ULPS = 12.5

# Relative bound above which `monodromy` is asked, whose two runs know better.
REFINE_ABOVE = 1e-10


@dataclass(frozen=True, eq=False)
class _Matrices:
    """Of several equations: (k, n, n) for each of the same harmonics, in units of the step."""

    mean: Float
    pulsating: list[tuple[int, bool, Float]]


def general_polynomials(equations: Sequence[PeriodicEquation]) -> tuple[Float, Float]:
    """Coefficients (k, m + 1), monic, highest power first, and bounds on their errors (k,).

    Raises
    ------
    ValueError
        Equations of different sizes, or of first and second order together.
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    forms = [normal_form(e) for e in equations]
    kinds = {(form.layout.n, form.layout.first_order) for form in forms}
    if len(kinds) > 1:
        raise ValueError("equations: must all have the same number of coordinates and one order")
    m = forms[0].layout.order
    P, errors = np.empty((len(forms), m + 1)), np.empty(len(forms))
    needed = np.array([PartsTaylor().steps(form) for form in forms])
    # neighbours need like steps
    ordered = np.argsort(needed, kind="stable")
    group = max(CHUNK_NUMBERS // (int(needed.max()) * m * m), 1)
    for first in range(0, len(forms), group):
        members = ordered[first : first + group]
        P[members], errors[members] = _together(
            [forms[i] for i in members], int(needed[members].max())
        )
    size = np.sum(np.abs(P), axis=1)
    for i in map(int, np.flatnonzero(~(errors <= REFINE_ABOVE * size))):
        found = general_monodromy(equations[i], "taylor")
        P[i], errors[i] = found.polynomial, found.error
    return P, errors


def _together(forms: list[NormalForm], steps: int) -> tuple[Float, Float]:
    unit = 2.0 ** floor(log2(2.0 * np.pi / steps))
    h = 2.0 * np.pi / steps / unit
    with np.errstate(over="ignore", invalid="ignore"):
        factors = _steps(forms, steps, unit, h)
        scale = np.array([step_scales(form, unit / form.Omega, h)[0] for form in forms])
        product, rounding = chain(factors, np.broadcast_to(scale, factors.shape))
    P = np.zeros((len(forms), product.shape[-1] + 1))
    errors = np.full(len(forms), np.inf)
    sound = np.all(np.isfinite(product) & np.isfinite(rounding), axis=(1, 2))
    if np.any(sound):
        with np.errstate(over="ignore", invalid="ignore"):
            P[sound], moved = characteristic_polynomials(product[sound], rounding[sound])
        errors[sound] = ULPS * EPS * moved
    errors[~np.isfinite(errors) | ~np.all(np.isfinite(P), axis=1)] = np.inf
    P[~np.isfinite(errors)] = 0.0
    return P, errors


def _stacked(forms: list[NormalForm], damping: bool, factor: Float) -> _Matrices:
    n = forms[0].layout.n
    mean = np.zeros((len(forms), n, n))
    found: dict[tuple[int, bool], Float] = {}
    for i, form in enumerate(forms):
        layout = form.layout
        matrices, terms = (
            (form.damping, layout.damping) if damping else (form.stiffness, layout.stiffness)
        )
        mean[i] = matrices[0] * factor[i]
        for (k, is_sine), matrix in zip(terms, matrices[1:], strict=True):
            key = form.harmonics[k], is_sine
            found.setdefault(key, np.zeros_like(mean))[i] = matrix * factor[i]
    return _Matrices(mean, [(k, is_sine, matrix) for (k, is_sine), matrix in found.items()])


def _steps(forms: list[NormalForm], steps: int, unit: float, h: float) -> Float:
    """All steps of all equations, (steps, k, m, m)."""
    n, m = forms[0].layout.n, forms[0].layout.order
    per = unit / np.array([form.Omega for form in forms])
    if forms[0].layout.first_order:
        A = _stacked(forms, False, per)
        return np.concatenate(
            [_first_order(A, at, steps, h, m) for at in _chunks(steps, len(forms) * m * m)]
        )
    K, C = _stacked(forms, False, per * per), _stacked(forms, True, per)
    return np.concatenate(
        [_second_order(K, C, at, steps, h, n) for at in _chunks(steps, len(forms) * n * m)]
    )


def _chunks(steps: int, numbers: int) -> list[Whole]:
    size = max(CHUNK_NUMBERS // numbers, 1)
    return np.array_split(np.arange(steps), ceil(steps / size))


def _waves(matrices: _Matrices, at: Whole, steps: int) -> list[tuple[Float, Float]]:
    """Each matrix with the series of its cosine or sine at each step, last power first."""
    found = []
    for k, is_sine, matrix in matrices.pulsating:
        turns = (k * at + steps // 2) % steps - steps // 2
        c, s = np.cos(2.0 * np.pi / steps * turns), np.sin(2.0 * np.pi / steps * turns)
        cycle = (s, c, -s, -c) if is_sine else (c, -s, -c, s)
        turn = 2.0 * np.pi * k / steps
        series = [cycle[j % 4] * turn**j / factorial(j) for j in range(ORDER)]
        found.append((matrix, np.array(series[::-1])))
    return found


def _moved(waves: list[tuple[Float, Float]], a: Float, j: int) -> Float | float:
    """Sum over the waves of M sum_i w_i a_(j - i); a is (order, steps, k, rows, columns)."""
    total: Float | float = 0.0
    for matrix, series in waves:
        total = total + matrix @ np.einsum("is,iskrc->skrc", series[ORDER - 1 - j :], a[: j + 1])
    return total


def _second_order(K: _Matrices, C: _Matrices, at: Whole, steps: int, h: float, n: int) -> Float:
    k = len(K.mean)
    a = np.zeros((ORDER + 1, len(at), k, n, 2 * n))
    slopes = np.zeros((ORDER, *a.shape[1:]))
    a[0, ..., :n] = np.eye(n)
    a[1, ..., n:] = slopes[0, ..., n:] = h * np.eye(n)
    stiffness, drag = _waves(K, at, steps), _waves(C, at, steps)
    for j in range(ORDER - 1):
        force = h * h * (K.mean @ a[j] + _moved(stiffness, a, j))
        force = force + h * (C.mean @ slopes[j] + _moved(drag, slopes, j))
        a[j + 2] = -force / ((j + 1) * (j + 2))
        slopes[j + 1] = (j + 2) * a[j + 2]
    Q, V = a[::-1].sum(axis=0), slopes[::-1].sum(axis=0) / h
    return np.concatenate([Q, V], axis=2)


def _first_order(A: _Matrices, at: Whole, steps: int, h: float, m: int) -> Float:
    a = np.zeros((ORDER + 1, len(at), len(A.mean), m, m))
    a[0] = np.eye(m)
    waves = _waves(A, at, steps)
    for j in range(ORDER):
        a[j + 1] = h / (j + 1) * (A.mean @ a[j] + _moved(waves, a, j))
    return np.asarray(a[::-1].sum(axis=0))
