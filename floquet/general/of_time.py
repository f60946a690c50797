"""The monodromy matrix of x' = A(t) x for any A of time, with estimates of its error."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import casadi as ca
import numpy as np
from scipy.linalg import matrix_balance

from floquet.accuracy import OVERFLOW
from floquet.arrays import EPS, Complex, Float
from floquet.charpoly import characteristic_polynomial
from floquet.general.modes import merged, periodic_discs
from floquet.general.panels import at_nodes, by_cvodes, by_picard, evaluated, panels
from floquet.growth import TINY, Verdict, logarithms
from floquet.products import chain
from hill import checks

# As for equations in Fourier series.
MAX_SPREAD = 1e4

# Times at which A is compared with itself a period later, and by how much it may differ.
COMPARED = 64
PERIODIC = 1e-9

TOLERANCE = 1e-14
"""SUNDIALS'; 1e-12 is about what it gives over a period."""


@dataclass(frozen=True, eq=False)
class EstimatedMonodromy:
    """What one period does to x, and estimates of how far off it is.

    The estimates are differences between Picard's iteration, the same on panels half as long, and
    SUNDIALS' Adams method at two tolerances. They bound nothing: what all three get wrong alike,
    such as a narrow pulse that none of them met, they do not see. So nothing is shown of stability
    and `verdict` is always "undecided"; with Fourier coefficients a `PeriodicEquation` has bounds.

    Attributes
    ----------
    matrix : (m, m) float ndarray
        Phi: x at t + period is Phi times x at t = 0.
    multipliers : (m,) complex ndarray
        Eigenvalues of Phi, by descending modulus; one that is too small for a float is 0.
    exponents : (m,) complex ndarray
        ln mu over the period, in the same order.
    exponent_error_estimates : (m,) float ndarray
    polynomial : (m + 1,) float ndarray
        det(mu I - Phi), monic, highest power first.
    T : float
        Twice the largest growth exponent.
    T_error_estimate : float
    error_estimate : float
        Of every coefficient of `polynomial`.
    matrix_error_estimate : (m, m) float ndarray
    verdict : "undecided"
    """

    matrix: Float
    multipliers: Complex
    exponents: Complex
    exponent_error_estimates: Float
    polynomial: Float
    T: float
    T_error_estimate: float
    error_estimate: float
    matrix_error_estimate: Float
    verdict: Verdict = "undecided"

    @property
    def stable(self) -> bool:
        """Never: an estimate shows nothing."""
        return False


def monodromy_of_time(
    A: Callable[[Any], Any] | Any, period: float, breaks: Iterable[float] = ()
) -> EstimatedMonodromy:
    """Integrate x' = A(t) x over one period by two methods.

    Parameters
    ----------
    A : callable or casadi.Function
        From the time, a CasADi symbol, to an (m, m) expression, array or nested sequence.
    period : float
    breaks : iterable of float, optional
        Times between 0 and `period` at which A, or a derivative of it, jumps.

    Raises
    ------
    ValueError
        A is no (m, m) expression, not finite, not smooth between the breaks, or not the same one
        period later; a break out of range.
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    period = checks.positive("period", period)
    function = _function(A)
    edges = _edges(period, breaks)
    _refuse_another_period(function, period, edges)
    ends = panels(function, edges)
    with np.errstate(over="ignore", invalid="ignore"):
        units = _units(function, ends)
        own = _in_units(by_picard(function, ends), units)
        product = chain(own)[0]
        if not np.all(np.isfinite(product)):
            raise OverflowError(OVERFLOW)
        others = [_in_units(x, units) for x in _others(function, ends)]
        products = [chain(x)[0] for x in others]
    apart = np.max([np.abs(x - own) for x in others], axis=0) + EPS * np.abs(own)
    matrix_error = np.max([np.abs(x - product) for x in products], axis=0)
    try:
        p, _, _ = characteristic_polynomial(product, np.abs(product))
        others_p = [characteristic_polynomial(x, np.abs(x))[0] for x in products]
    except OverflowError:
        raise OverflowError(OVERFLOW) from None
    logs, off = _exponents(own, apart, product, matrix_error)
    with np.errstate(under="ignore"):
        multipliers = np.exp(logs)
    return EstimatedMonodromy(
        matrix=_in_units(product, 1.0 / units),
        multipliers=multipliers,
        exponents=logs / period,
        exponent_error_estimates=off / period,
        polynomial=p,
        T=2.0 * float(logs[0].real) / period,
        T_error_estimate=2.0 * float(off[0]) / period,
        error_estimate=float(np.max([np.max(np.abs(x - p)) for x in others_p])),
        matrix_error_estimate=_in_units(matrix_error, 1.0 / units),
    )


def _others(function: Any, ends: Float) -> list[Float]:
    """The panels again: in halves, and by SUNDIALS at two tolerances."""
    middle = ends.mean(axis=1)
    first = by_picard(function, np.stack([ends[:, 0], middle], 1))
    second = by_picard(function, np.stack([middle, ends[:, 1]], 1))
    rough = by_cvodes(function, ends, 10.0 * TOLERANCE)
    return [second @ first, by_cvodes(function, ends, TOLERANCE), rough]


def _exponents(
    factors: Float, errors: Float, product: Float, matrix_error: Float
) -> tuple[Complex, Float]:
    """Ln mu by descending modulus, and how far off they may be by these errors, if they are it."""
    values = np.linalg.eigvals(product)
    size = np.abs(values)
    if np.min(size) * MAX_SPREAD > np.max(size):
        families = periodic_discs(product[None], matrix_error[None] + EPS * np.abs(product)[None])
    else:
        families = periodic_discs(*merged(factors, errors))
    if families:
        return logarithms(families)
    order = np.argsort(-size, kind="stable")
    logs = np.log(np.maximum(size, TINY)) + 1j * np.angle(values)
    return logs[order], np.full(len(logs), np.inf)


def _function(A: Any) -> Any:
    """A as a CasADi function of one time."""
    if not isinstance(A, ca.Function):
        if not callable(A):
            raise ValueError("A: must be an equation, a casadi.Function or a function of time")
        t = ca.SX.sym("t")
        A = ca.Function("A", [t], [_expression(A(t))])
    if (A.n_in(), A.n_out()) != (1, 1) or A.size_in(0) != (1, 1):
        raise ValueError("A: must be a function of one time that returns one matrix")
    rows, columns = A.size_out(0)
    if rows != columns or rows == 0:
        raise ValueError(f"A has shape ({rows}, {columns}): must be square and not empty")
    time = ca.MX.sym("t")
    return ca.Function("A", [time], [ca.densify(A(time))])


def _expression(value: Any) -> Any:
    if isinstance(value, (ca.SX, ca.DM)):
        return value
    try:
        rows = [row if isinstance(row, (list, tuple, np.ndarray)) else [row] for row in value]
        if len({len(row) for row in rows}) != 1:
            raise TypeError
        return ca.vertcat(*(ca.horzcat(*row) for row in rows))
    except (TypeError, NotImplementedError):
        raise ValueError("A: must return an (m, m) CasADi expression, array or lists") from None


def _edges(period: float, breaks: Iterable[float]) -> list[float]:
    found = sorted({checks.number("breaks", x) for x in breaks})
    for x in found:
        if not 0.0 < x < period:
            raise ValueError(f"breaks: {x:g} must be between 0 and the period, {period:g}")
    return [0.0, *found, period]


def _refuse_another_period(function: Any, period: float, edges: list[float]) -> None:
    """Where A is not the same one period later, at times that are no simple part of it."""
    golden = 0.5 * (np.sqrt(5.0) - 1.0)
    share = np.modf(golden * np.arange(1, COMPARED + 1))[0]
    each = [a + (b - a) * share for a, b in pairwise(edges)]
    t = np.concatenate(each)
    now, later = evaluated(function, t), evaluated(function, t + period)
    bad = ~np.all(np.isfinite(now), axis=(1, 2))
    if np.any(bad):
        raise ValueError(f"A: is not finite at t = {t[bad][0]:.6g}")
    apart = np.max(np.abs(now - later), axis=(1, 2))
    k = int(np.argmax(apart))
    if not apart[k] <= PERIODIC * max(float(np.max(np.abs(now))), TINY):
        raise ValueError(
            f"period = {period:g}: A differs by {apart[k]:.3g} at t = {t[k]:.6g} and a period "
            "later; it must be the same"
        )


def _units(function: Any, ends: Float) -> Float:
    """Powers of two that balance A."""
    largest = np.max(np.abs(at_nodes(function, ends)), axis=(0, 1))
    size = max(float(np.max(largest)), TINY)
    _, (scale, _) = matrix_balance(largest / size + EPS, permute=False, separate=True)
    return np.asarray(scale, float)


def _in_units(matrices: Float, units: Float) -> Float:
    return matrices * units / units[:, None]
