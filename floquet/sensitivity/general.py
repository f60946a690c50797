"""How T and the leading exponent move with every number of a general periodic equation.

With the factors P_k of the period, the leading eigenvector's steps x_k = P_k x_(k-1)/s_k and the
left one's y_(k-1) = P_k' y_k/s_k, y_k' x_k = 1, the multiplier is the product of the s_k and

    d ln mu = sum_k y_k' dP_k x_(k-1)/s_k.

CasADi differentiates the Taylor step in reverse mode: one sweep over all steps at once gives what
ln mu owes to every Fourier coefficient, and to the step's length, which is all that Omega moves.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np

from floquet.accuracy import SAFETY
from floquet.arrays import EPS, Complex, Float
from floquet.general.period import general_monodromy
from floquet.integrate.normal_form import Layout, NormalForm, normal_form
from floquet.integrate.parts import Grid
from floquet.integrate.parts_taylor import PartsTaylor
from floquet.integrate.steps import Steps, step_function
from floquet.result import Monodromy
from hill import Fourier, PeriodicEquation
from hill.precision import remark_of_slopes

# Steps side by side in one reverse sweep.
CHUNK = 512

# Rounding of a derivative, in ulps of the moduli of its terms, for each radian of fastest motion.
ULPS = 16.0


@dataclass(frozen=True, eq=False)
class Coefficients:
    """A number for each Fourier coefficient of a matrix, shaped like `hill.Fourier`."""

    mean: Float
    cos: Mapping[int, Float]
    sin: Mapping[int, Float]


@dataclass(frozen=True, eq=False)
class GeneralDerivatives:
    """Derivatives of T, or bounds on their errors; None for what the equation does not have."""

    Omega: float
    M: Float | None
    C: Coefficients | None
    K: Coefficients | None
    A: Coefficients | None


@dataclass(frozen=True, eq=False)
class GeneralSensitivities:
    """T, the exponent that it comes from, and derivatives of T with error estimates.

    Attributes
    ----------
    T : float
        Twice the largest growth exponent.
    exponent : complex
    dT, dT_error : GeneralDerivatives
        The errors are estimates: the difference of two runs with other steps, times 8, and rounding
        by a model, as for the special equation.
    remark : str
        Which derivatives are known to less than nine digits; empty where none is.
    """

    T: float
    exponent: complex
    dT: GeneralDerivatives
    dT_error: GeneralDerivatives
    remark: str


@dataclass(frozen=True, eq=False)
class _Gradient:
    """Of Re ln mu in the normal form's numbers, and the sums of the moduli of its terms."""

    stiffness: Float
    damping: Float
    h: float
    sizes: tuple[Float, Float, float]
    log: complex


def general_sensitivities(equation: PeriodicEquation) -> GeneralSensitivities:
    """Differentiate T with respect to every number of a general equation.

    Raises
    ------
    ValueError
        Another multiplier may be as large, or meet the largest: T has no derivative there.
    OverflowError
        As for `floquet.monodromy`.
    """
    found = general_monodromy(equation, "taylor")
    _refuse_ties(found, equation.Omega)
    form = normal_form(equation, every=True)
    run, check = (_gradient(form, method) for method in (PartsTaylor(), PartsTaylor(order=29)))
    slope, other = (_of_T(equation, form, g.stiffness, g.damping, g.h, g.log) for g in (run, check))
    radians = 1.0 + 2.0 * PartsTaylor().steps(form)
    size = _of_T(equation, form, *run.sizes, run.log, moduli=True)
    unsure = ULPS * EPS * radians + _turned(found, form.period)
    error = [SAFETY * abs(a - b) + unsure * c for a, b, c in zip(slope, other, size, strict=True)]
    return GeneralSensitivities(
        T=found.T,
        exponent=complex(found.exponents[0]),
        dT=_shaped(equation, slope),
        dT_error=_shaped(equation, error),
        remark=remark_of_slopes(_known(equation, slope, error)),
    )


def _known(equation: PeriodicEquation, slope: list[Any], error: list[Any]) -> dict[str, Any]:
    """Slope, error and value by name, in the order of `_of_T`."""
    names = ("A",) if equation.A is not None else ("M", "C", "K")
    given = [vars(equation)[name] for name in names]
    values = [
        np.stack([x.mean, *x.cos.values(), *x.sin.values()]) if isinstance(x, Fourier) else x
        for x in given
    ]
    found = zip(("Omega", *names), slope, error, (equation.Omega, *values), strict=True)
    return {name: parts for name, *parts in found}


def _refuse_ties(found: Monodromy, Omega: float) -> None:
    exponents, off = found.exponents, found.exponent_errors
    lead = exponents[0]
    for other, error in zip(exponents[1:], off[1:], strict=True):
        if other.real + error < lead.real - off[0]:
            continue
        between = other - lead.conj()
        twin = abs(between.real + 1j * (between.imag - Omega * round(between.imag / Omega)))
        apart = other - lead
        same = abs(apart.real + 1j * (apart.imag - Omega * round(apart.imag / Omega)))
        if twin > error + off[0] or same <= 8.0 * (error + off[0]):
            raise ValueError(
                f"exponents {lead:.6g} and {other:.6g} tie for the largest growth as far as their "
                "errors tell: T has no derivative there"
            )


def _turned(found: Monodromy, period: float) -> float:
    """How far the leading eigenvectors may have turned towards others, to first order."""
    apart = np.abs(-np.expm1((found.exponents[1:] - found.exponents[0]) * period))
    return float(2.0 * found.exponent_errors[0] * period * np.sum(1.0 / apart))


def _gradient(form: NormalForm, method: PartsTaylor) -> _Gradient:
    total = max(method.steps(form), 2)
    unit = Grid.of(form, total, 1).unit
    step = Steps(form, method.order, total, unit)
    P = step(np.arange(total), total)
    x, y, s, log = _vectors(P)
    seeds = y[1:, :, None] * x[:-1, None, :] / s[:, None, None]
    K, C, h = _pulled(step, P, seeds.real)
    # Re(ln mu) is real: the imaginary parts of y dP x with real dP do not count
    scale = unit if form.layout.first_order else unit * unit
    return _Gradient(
        stiffness=scale * K.sum(axis=0),
        damping=unit * C.sum(axis=0),
        h=float(step.h * h.sum()),
        sizes=(
            scale * np.abs(K).sum(axis=0),
            unit * np.abs(C).sum(axis=0),
            float(step.h * np.abs(h).sum()),
        ),
        log=log,
    )


def _vectors(P: Float) -> tuple[Complex, Complex, Complex, complex]:
    """Steps of the leading eigenvectors, x and y before each factor and at the end, s and ln mu."""
    count, m = len(P), P.shape[-1]
    right = _leading(P)
    x, y = np.empty((count + 1, m), complex), np.empty((count + 1, m), complex)
    s = np.empty(count, complex)
    x[0] = right / np.linalg.norm(right)
    for k in range(count):
        moved = P[k] @ x[k]
        s[k] = np.linalg.norm(moved)
        x[k + 1] = moved / s[k]
    # once round the vector has turned by the multiplier's phase
    turn = complex(np.vdot(x[0], x[count]))
    left = _leading(P[::-1].transpose(0, 2, 1))
    y[count] = left if abs(left @ x[count]) > 0.0 else left.conj()
    y[count] = y[count] / (y[count] @ x[count])
    for k in reversed(range(count)):
        y[k] = P[k].T @ y[k + 1] / s[k]
    return x, y, s, complex(np.sum(np.log(s.real)) + 1j * np.angle(turn))


def _leading(P: Float) -> Complex:
    whole = np.eye(P.shape[-1])
    for factor in P:
        whole = factor @ whole
        whole = whole / np.max(np.abs(whole))
    values, vectors = np.linalg.eig(whole)
    # of a pair the one above, in whichever order they come
    lead = int(np.lexsort((-values.imag, -np.round(np.log(np.abs(values) + 1e-300), 9)))[0])
    return vectors[:, lead].astype(complex)


def _pulled(step: Steps, P: Float, seeds: Float) -> tuple[Float, Float, Float]:
    """What sum(seeds * P) owes to K, C and h, of each step: (count, 1 + terms, n, n), (count,)."""
    layout, total = step.form.layout, step.total
    n, m = layout.n, layout.order
    pieces = []
    for first in range(0, total, CHUNK):
        at = np.arange(first, min(first + CHUNK, total))
        function = _reverse(layout, step.order, len(at))
        wide = [x[at].transpose(1, 0, 2).reshape(m, -1) for x in (P, seeds)]
        found = [np.asarray(x) for x in function(*step.inputs(at, total), *wide)]
        each = [x.reshape(n, len(at), -1, n).transpose(1, 2, 0, 3) for x in found[2:-2]]
        pieces.append((each[0], each[1] if layout.damped else 0.0 * each[0][:, :1], found[0][0]))
    K, C, h = (np.concatenate(x) for x in zip(*pieces, strict=True))
    return K, C, h


@lru_cache(maxsize=64)
def _reverse(layout: Layout, order: int, count: int) -> Any:
    shared = 4 if layout.damped else 3
    return (
        step_function(layout, order)
        .reverse(1)
        .map("back", "serial", count, list(range(shared)), [])
    )


def _of_T(
    equation: PeriodicEquation,
    form: NormalForm,
    stiffness: Float,
    damping: Float,
    h: float,
    log: complex,
    *,
    moduli: bool = False,
) -> list[Any]:
    """Of T = (Omega/pi) Re ln mu by Omega, M, C, K or A; or the moduli of what is summed."""
    per = equation.Omega / np.pi
    # elements in the given units
    scale = form.units[None, :] / form.units[:, None]
    K, C = per * stiffness * scale, per * damping * scale
    own = np.abs if moduli else np.asarray
    Omega = (abs(h) + abs(log.real) if moduli else log.real - h) / np.pi
    if equation.A is not None:
        return [Omega, K]
    assert equation.M is not None
    inverse = own(np.linalg.inv(equation.M)).T
    back = 1.0 / scale
    M = 0.0
    for slopes, given in ((K, form.stiffness * back), (C, form.damping * back)):
        M = M + sum(a @ own(b).T for a, b in zip(slopes, given, strict=True))
    return [Omega, (inverse @ M) if moduli else -(inverse @ M), inverse @ C, inverse @ K]


def _shaped(equation: PeriodicEquation, values: list[Any]) -> GeneralDerivatives:
    Omega, *rest = values
    if equation.A is not None:
        return GeneralDerivatives(float(Omega), None, None, None, _like(equation.A, rest[0]))
    M, C, K = rest
    assert equation.C is not None
    assert equation.K is not None
    return GeneralDerivatives(float(Omega), M, _like(equation.C, C), _like(equation.K, K), None)


def _like(given: Fourier, stacked: Float) -> Coefficients:
    """Mean, cosines, sines, as `normal_form` stacks them."""
    count = len(given.cos)
    cos = dict(zip(given.cos, stacked[1 : 1 + count], strict=True))
    sin = dict(zip(given.sin, stacked[1 + count :], strict=True))
    return Coefficients(stacked[0], MappingProxyType(cos), MappingProxyType(sin))
