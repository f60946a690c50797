"""The monodromy matrix of the matrix Hill equation, its multipliers, z, T and residuals.

In u = exp(eta tau/2) q every coefficient is even in tau, so with S = diag(I, -I) the fundamental
matrix obeys U(-tau) = S U(tau) S, whether or not F and G are symmetric. Two things follow:

* the period's second half is the first one run backwards, Phi = S U(pi/Omega)^-1 S U(pi/Omega);
* (S Phi)^2 = I, so the multipliers come in pairs mu, 1/mu, and with Phi in n-by-n blocks
  [[A, B], [C, D]] the n values z = (mu + 1/mu)/2 = cos 2 pi alpha are the eigenvalues of A.

Neither holds for a general equation, nor for a damping matrix: `floquet.general.period`. The whole
period is integrated too where the solution grows so much that U cannot be inverted well.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, overload

import numpy as np

from floquet.accuracy import BASE_ULPS, OVERFLOW, Bounded, bounded
from floquet.arrays import Complex, Float
from floquet.data_errors import data_share, subtraction_error
from floquet.eigenvalues import Discs, discs_from_matrix, discs_from_polynomial, sorted_eigenvalues
from floquet.general.mode_bounds import discs_one_by_one
from floquet.general.of_time import EstimatedMonodromy, monodromy_of_time
from floquet.general.period import general_monodromy
from floquet.growth import growth_from_z, logarithm_error
from floquet.integrate.methods import METHODS, Method
from floquet.integrate.normal_form import normal_form
from floquet.integrate.ode import parameter_values, shape, terms
from floquet.integrate.step_length import fastest_rate, perron_root
from floquet.many import (
    MAX_FEW,
    ULPS,
    checked,
    integrated,
    rounded,
    second_half_rounding,
    without_damping,
)
from floquet.result import Monodromy
from hill import HillEquation, PeriodicEquation
from hill.precision import remark

# The terms that S U^-1 S U sums are this much larger than 1, 3 to 5 for the report's beam with 2 to
# 12 modes, twice the growth over a period where there is one. Beyond, the whole period loses less.
MAX_TERM_GROWTH = 100.0
# Of many coordinates the whole period costs no more than twice the half, and its rounding is known
# element by element: half of it loses 2 times more where terms grow by 4.4 (beams of 15 to 40
# modes), 9, 15 and 31 times more where by 31, 61 and 118 (coordinates that are all mixed).
MAX_TERM_GROWTH_OF_MANY = 10.0

# exp of it is still a float.
MAX_DECAY_EXPONENT = 700.0


@overload
def monodromy(equation: HillEquation | PeriodicEquation, *, method: str = "taylor") -> Monodromy:  # noqa: D418
    """Of an equation, with bounds."""


@overload
def monodromy(  # noqa: D418
    equation: Callable[[Any], Any], *, period: float, breaks: Iterable[float] = ()
) -> EstimatedMonodromy:
    """Of any A(t), with estimates."""


def monodromy(
    equation: Any,
    *,
    method: str = "taylor",
    period: float | None = None,
    breaks: Iterable[float] = (),
) -> Monodromy | EstimatedMonodromy:
    """Integrate a periodic equation over one period.

    Every result is checked by a second integration, of the damped equation as it stands, over the
    whole period, with other steps; `error` comes from their difference. Of any A(t) two methods'
    difference is an *estimate* of the error and no more.

    Parameters
    ----------
    equation : HillEquation, PeriodicEquation, or callable or casadi.Function
        The matrix Hill equation (6.1.1), of which `eta` may be a matrix; a general one; or A of
        x' = A(t) x, from the time, a CasADi symbol, to an (m, m) expression.
    method : {"taylor", "cvodes"}, optional
        A Taylor step of order 24 folded over the period, or SUNDIALS' Adams method.
    period : float, optional
        Of A(t), which needs one.
    breaks : iterable of float, optional
        Times within the period at which A(t) or a derivative of it jumps.

    Returns
    -------
    Monodromy
        Of A(t) an `EstimatedMonodromy`, whose verdict is always "undecided".

    Raises
    ------
    ValueError
        `method` unfound; an A(t) that has another period, is not smooth between the breaks, no
        (m, m) matrix or not finite; a period beside an equation, or none for A(t).
    OverflowError
        The growth or the decay over one period exceeds what a float can hold.
    """
    if not isinstance(equation, HillEquation | PeriodicEquation):
        if period is None:
            raise ValueError("period: has no value; A(t) needs one")
        return monodromy_of_time(equation, period, breaks)
    if period is not None or tuple(breaks):
        raise ValueError("period, breaks: an equation has its own; leave them out")
    return _of_equation(equation, method)


def _of_equation(equation: HillEquation | PeriodicEquation, method: str) -> Monodromy:
    if method not in METHODS:
        raise ValueError(f"method = {method!r}: must be one of {', '.join(METHODS)}")
    how = METHODS[method]
    if isinstance(equation, PeriodicEquation):
        return general_monodromy(equation, method)
    if np.ndim(equation.eta) > 0:
        return general_monodromy(equation.general(), method, rounded=rounded(equation))
    period, eta, n = equation.period, equation.damping, equation.n
    if abs(eta) * 0.5 * period > MAX_DECAY_EXPONENT:
        raise OverflowError(
            f"eta = {eta:g}, Omega = {equation.Omega:g}: the decay over one period, "
            "exp(-pi eta/Omega), exceeds what a float can hold"
        )
    many = n > MAX_FEW and method == "taylor"
    runs = _of_many(equation) if many else _of_few(equation, how)
    Phi_u, whole = runs.Phi_u, runs.whole
    whole_u = _undamp(whole, eta, period)
    A = Phi_u[:n, :n]
    found = bounded(
        A,
        whole_u[:n, :n],
        runs.rounding[:n, :n],
        runs.ulps,
        0.0,
        subtraction_error(equation, runs.scale) if eta else None,
    )
    z = sorted_eigenvalues(A)
    root = np.sqrt(z - 1.0) * np.sqrt(z + 1.0)
    outer = np.where(np.abs(z + root) >= np.abs(z - root), z + root, z - root)
    pairs = np.concatenate([outer, 1.0 / outer])  # z - root cancels where z is large
    order = np.argsort(-np.abs(pairs), kind="stable")
    pairs = pairs[order]
    decay = np.exp(-0.5 * eta * period)
    discs = _discs(z, A, found)
    growth = growth_from_z(discs, found.p, found.errors, period, eta)
    off = logarithm_error(z, discs)
    return Monodromy(
        matrix=_damp(Phi_u, eta, period),
        multipliers=decay * pairs,
        exponents=np.log(pairs) / period - 0.5 * eta,
        exponent_errors=np.concatenate([off, off])[order] / period,
        polynomial=found.p,
        errors=found.errors,
        matrix_error=found.matrix_error,
        data_error=data_share(equation) * float(np.sum(np.abs(found.p))),
        z=z,
        T=growth.T,
        T_error=growth.T_error,
        verdict=growth.verdict,
        liouville_defect=_liouville(whole, n * eta * period),
        reversibility_defect=_reversibility(whole_u),
        method=method,
        half_period=runs.half,
        remark=remark(
            growth.T,
            growth.T_error,
            equation.Omega,
            growth.verdict,
            found.p,
            float(np.max(found.errors)),
        ),
    )


@dataclass(frozen=True, eq=False)
class _Runs:
    """The period by a method, in u, and by its check, in q.

    Attributes
    ----------
    Phi_u, whole : (2n, 2n) ndarray
    scale : (2n, 2n) ndarray
        Size of the terms that Phi_u sums.
    rounding : (2n, 2n) ndarray
        What rounding may do to Phi_u, over so many `ulps`.
    ulps : float
    half : bool
        Whether Phi_u is made of half the period.
    """

    Phi_u: Float
    whole: Float
    scale: Float
    rounding: Float
    ulps: float
    half: bool


def _of_few(equation: HillEquation, how: Method) -> _Runs:
    size, period, n = shape(equation), equation.period, equation.n
    plain = parameter_values(equation)
    undamped = parameter_values(equation, undamped=True)
    whole = _finite(how.check(plain, size, period))
    U = _finite(how.run(undamped, size, 0.5 * period))
    Phi_u, scale, half = _from_half(U)
    fastest = fastest_rate(terms(undamped, size), undamped.C)
    if not half:
        Phi_u = _finite(how.run(undamped, size, period))
        # growth in the first half may not show at the end
        scale = np.maximum(np.abs(Phi_u), np.where(np.isfinite(scale), scale, 0.0))
        # nor an amplitude whose phase is near a zero, of columns or of rows
        scale[:n, :n] = np.maximum(scale[:n, :n], np.abs(Phi_u[n:, :n]) / fastest)
        scale[:n, :n] = np.maximum(scale[:n, :n], np.abs(Phi_u[:n, n:]) * fastest)
    return _Runs(Phi_u, whole, scale, scale, BASE_ULPS + fastest * period, half)


def _of_many(equation: HillEquation) -> _Runs:
    """In parts, of which rounding is known element by element."""
    form = without_damping(equation)
    whole = checked(normal_form(equation.general()))
    U, rounding = integrated(form, half=True)
    Phi_u, scale, half = _from_half(U, MAX_TERM_GROWTH_OF_MANY)
    if half:
        rounding = second_half_rounding(U, Phi_u, rounding)
    else:
        Phi_u, rounding = integrated(form)
        scale = rounding
    return _Runs(Phi_u, whole, scale, rounding, ULPS, half)


def _from_half(U: Float, most: float = MAX_TERM_GROWTH) -> tuple[Float, Float, bool]:
    """Phi and the size of its terms from half a period, and whether it is to be used."""
    try:
        Phi_u, scale = second_half(U)
        half = bool(np.all(np.isfinite(scale)) and perron_root(scale) < most)
    except np.linalg.LinAlgError:  # singular to rounding
        return U, np.zeros_like(U), False
    return Phi_u, scale, half


def second_half(U: Float) -> tuple[Float, Float]:
    """Phi = S U^-1 S U, and the same with moduli: the size of the terms that it sums."""
    n = len(U) // 2
    S = np.repeat([1.0, -1.0], [n, n])
    inverse = np.linalg.inv(U)
    return (S[:, None] * inverse * S) @ U, np.abs(inverse) @ np.abs(U)


def _discs(values: Complex, A: Float, found: Bounded) -> list[Discs]:
    """Where the true eigenvalues of A are, by its polynomial and by itself."""
    known = [
        discs_from_polynomial(values, found.p, found.errors),
        discs_from_matrix(A, found.matrix_error),
    ]
    alone = discs_one_by_one(A, found.matrix_error) if len(A) > MAX_FEW else None
    return known if alone is None else [*known, alone]


def _damp(Phi_u: Float, eta: float, period: float) -> Float:
    """Monodromy of (q, q') from that of (u, u'): q = exp(-eta tau/2) u."""
    n = len(Phi_u) // 2
    if eta == 0.0:
        return Phi_u
    to_q = np.eye(2 * n)
    to_q[n:, :n] -= 0.5 * eta * np.eye(n)
    from_q = 2.0 * np.eye(2 * n) - to_q
    result: Float = np.exp(-0.5 * eta * period) * to_q @ Phi_u @ from_q
    return result


def _undamp(Phi: Float, eta: float, period: float) -> Float:
    """Monodromy of (u, u') from that of (q, q')."""
    return _damp(Phi, -eta, period)


def _liouville(Phi: Float, decay: float) -> float:
    sign, log_det = np.linalg.slogdet(Phi)
    log_ratio = float(log_det + decay)
    return float("inf") if log_ratio > 700.0 else float(np.abs(sign * np.exp(log_ratio) - 1.0))


def _reversibility(Phi_u: Float) -> float:
    n = len(Phi_u) // 2
    S = np.repeat([1.0, -1.0], [n, n])
    size = max(1.0, float(np.max(np.abs(Phi_u))))
    turned = S[:, None] * (Phi_u / size)
    return float(np.max(np.abs(turned @ turned - np.eye(2 * n) / size / size)))


def _finite(Phi: Float) -> Float:
    if not np.all(np.isfinite(Phi)):
        raise OverflowError(OVERFLOW)
    return Phi
