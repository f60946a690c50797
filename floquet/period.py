"""The monodromy matrix of the matrix Hill equation, its multipliers, z, T and residuals.

In u = exp(eta tau/2) q every coefficient is even in tau, so with S = diag(I, -I) the fundamental
matrix obeys U(-tau) = S U(tau) S, whether or not F and G are symmetric. Two things follow:

* the period's second half is the first one run backwards, Phi = S U(pi/Omega)^-1 S U(pi/Omega);
* (S Phi)^2 = I, so the multipliers come in pairs mu, 1/mu, and with Phi in n-by-n blocks
  [[A, B], [C, D]] the n values z = (mu + 1/mu)/2 = cos 2 pi alpha are the eigenvalues of A.

Neither holds for a damping matrix: then the whole period is integrated and there is no z. The
whole period is integrated too where the solution grows so much that U cannot be inverted well.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.accuracy import OVERFLOW, amplitudes, known, moved_by_data, moved_by_diagonal
from floquet.eigenvalues import eigenvalues, from_matrix, from_polynomial
from floquet.growth import Verdict, from_multipliers, from_z
from floquet.integrate.methods import METHODS, Method
from floquet.integrate.ode import Parameters, shape, terms, values
from floquet.integrate.step_length import perron, rate
from floquet.integrate.taylor import Taylor
from hill import HillEquation

Complex = NDArray[np.complexfloating[Any]]
Float = NDArray[np.floating[Any]]

# The terms that S U^-1 S U sums are this much larger than 1, 3 to 5 for the report's beam with 2 to
# 12 modes, twice the growth over a period where there is one. Beyond, the whole period loses less.
WELL = 100.0

# By its modes a change of F moves P so far without pulsation. With it, it moved P three times as
# far in one of 9,849 systems (`benchmarks.honesty --seed 40`); in the others the rest covered it.
MODES = 4.0

# exp of it is still a float.
MOST_DECAY = 700.0


@dataclass(frozen=True, eq=False)
class Monodromy:
    """What one period does to (q, q'), and what follows from it.

    Attributes
    ----------
    matrix : (2n, 2n) float ndarray
        Phi: (q, q') at tau + 2 pi/Omega is Phi times (q, q') at tau = 0.
    multipliers : (2n,) complex ndarray
        Eigenvalues of Phi, by descending modulus.
    polynomial : (n + 1,) float ndarray
        P(z) = det(z I - A), monic, highest power first. With a damping matrix, which has no z,
        the polynomial of the multipliers themselves, (2n + 1,).
    errors : (n + 1,) float ndarray
        Bound on the absolute error of each coefficient of `polynomial`, for the matrices F, G and H
        to the last bit as they are given.
    matrix_error : (n, n) float ndarray
        Bound on the error of each element of A; of `matrix` with a damping matrix.
    data_error : float
        What the equation's own `data_error` may add to that, to first order; 0 where it has none.
    z : (n,) complex ndarray
        cos 2 pi alpha, by descending real part; empty with a damping matrix.
    T : float
        Characteristic argument (7.1.1): twice the growth exponent of q, over ``omega_1``.
    T_error : float
        Bound on the error of `T` that `errors` and `matrix_error` allow.
    verdict : {"stable", "unstable", "undecided"}
        What is shown: all z real, simple and within (-1, 1), or no growth with damping; growth; or
        neither.
    liouville_defect : float
        |det Phi / exp(-period tr C) - 1| of the run that checks, which takes no symmetry for
        granted.
    reversibility_defect : float
        Largest element of (S Phi_u)^2 - I of that run, over the square of the largest of Phi_u;
        nan with a damping matrix.
    method : str
        The CasADi method.
    half_period : bool
        Whether reversibility was used.
    """

    matrix: Float
    multipliers: Complex
    polynomial: Float
    errors: Float
    matrix_error: Float
    data_error: float
    z: Complex
    T: float
    T_error: float
    verdict: Verdict
    liouville_defect: float
    reversibility_defect: float
    method: str
    half_period: bool

    @property
    def error(self) -> float:
        """Bound on the absolute error of every coefficient of `polynomial`: largest of `errors`."""
        return float(np.max(self.errors))

    @property
    def stable(self) -> bool:
        """Whether the system is shown to be stable."""
        return self.verdict == "stable"


def monodromy(equation: HillEquation, *, method: str = "taylor") -> Monodromy:
    """Integrate the matrix Hill equation (6.1.1) over one period.

    Every result is checked by a second integration, of the damped equation as it stands, over the
    whole period, with other steps; `error` comes from their difference.

    Parameters
    ----------
    equation : HillEquation
        `eta` may be a matrix here.
    method : {"taylor", "cvodes"}, optional
        A Taylor step of order 24 folded over the period, or SUNDIALS' Adams method.

    Returns
    -------
    Monodromy

    Raises
    ------
    ValueError
        `method` unfound.
    OverflowError
        The growth or the decay over one period exceeds what a float can hold.
    """
    if method not in METHODS:
        raise ValueError(f"method = {method!r}: must be one of {', '.join(METHODS)}")
    how = METHODS[method]
    size, period = shape(equation), 2.0 * np.pi / equation.Omega
    plain = values(equation)
    if how.diverges:
        _finite(Taylor()(plain, size, period))
    if np.ndim(equation.eta) > 0:
        return _damping_matrix(equation, how, _finite(how.check(plain, size, period)), method)

    eta, n = equation.damping, size.n
    if abs(eta) * 0.5 * period > MOST_DECAY:
        raise OverflowError(
            f"eta = {eta:g}, Omega = {equation.Omega:g}: the decay over one period, "
            "exp(-pi eta/Omega), exceeds what a float can hold"
        )
    undamped = values(equation, undamped=True)
    if 0.5 * eta * period > how.most_decay:
        whole = _damp(_finite(how.check(undamped, size, period)), eta, period)
    else:
        whole = _finite(how.check(plain, size, period))
    U = _finite(how.run(undamped, size, 0.5 * period))
    try:
        Phi_u, scale = second_half(U)
        half = bool(np.all(np.isfinite(scale)) and perron(scale) < WELL)
    except np.linalg.LinAlgError:  # singular to rounding
        scale, half = np.zeros_like(U), False
    if not half:
        Phi_u = _finite(how.run(undamped, size, period))
        # growth in the first half may not show at the end
        scale = np.maximum(np.abs(Phi_u), np.where(np.isfinite(scale), scale, 0.0))
        # nor an amplitude whose phase is near a zero, of columns or of rows
        fastest = rate(terms(undamped, size), undamped.C)
        scale[:n, :n] = np.maximum(scale[:n, :n], np.abs(Phi_u[n:, :n]) / fastest)
        scale[:n, :n] = np.maximum(scale[:n, :n], np.abs(Phi_u[:n, n:]) * fastest)
    A = Phi_u[:n, :n]
    ulps = 8.0 + rate(terms(undamped, size), undamped.C) * period
    found = known(
        A,
        _undamp(whole, eta, period)[:n, :n],
        scale[:n, :n],
        ulps,
        how.floor,
        _by_subtraction(equation, scale) if eta else None,
    )
    z = eigenvalues(A)
    root = np.sqrt(z - 1.0) * np.sqrt(z + 1.0)
    outer = np.where(np.abs(z + root) >= np.abs(z - root), z + root, z - root)
    pairs = np.concatenate([outer, 1.0 / outer])  # z - root cancels where z is large
    decay = np.exp(-0.5 * eta * period)
    families = from_polynomial(z, found.p, found.errors), from_matrix(A, found.matrix_error)
    growth = from_z(families, found.p, found.errors, period, eta)
    return Monodromy(
        matrix=_damp(Phi_u, eta, period),
        multipliers=_descending(decay * pairs),
        polynomial=found.p,
        errors=found.errors,
        matrix_error=found.matrix_error,
        data_error=_data(equation) * float(np.sum(np.abs(found.p))),
        z=z,
        T=growth.T,
        T_error=growth.T_error,
        verdict=growth.verdict,
        liouville_defect=_liouville(whole, plain, period),
        reversibility_defect=_reversibility(_undamp(whole, eta, period)),
        method=method,
        half_period=half,
    )


def second_half(U: Float) -> tuple[Float, Float]:
    """Phi = S U^-1 S U, and the same with moduli: the size of the terms that it sums."""
    n = len(U) // 2
    S = np.repeat([1.0, -1.0], [n, n])
    inverse = np.linalg.inv(U)
    return (S[:, None] * inverse * S) @ U, np.abs(inverse) @ np.abs(U)


def _damping_matrix(equation: HillEquation, how: Method, checked: Float, method: str) -> Monodromy:
    """A damping matrix: the whole period, and the multipliers as they are."""
    p, size = values(equation), shape(equation)
    period = 2.0 * np.pi / equation.Omega
    Phi = _finite(how.run(p, size, period))
    ulps = 8.0 + rate(terms(p, size), p.C) * period
    found = known(Phi, checked, amplitudes(Phi, rate(terms(p, size), p.C)), ulps, how.floor)
    mu = eigenvalues(Phi)
    families = from_polynomial(mu, found.p, found.errors), from_matrix(Phi, found.matrix_error)
    # Liouville: the product of all mu is exp(-period tr C)
    growth = from_multipliers(families, period, -0.5 * period * float(np.trace(p.C)) / size.n)
    return Monodromy(
        matrix=Phi,
        multipliers=_descending(mu),
        polynomial=found.p,
        errors=found.errors,
        matrix_error=found.matrix_error,
        data_error=_data(equation) * float(np.sum(np.abs(found.p))),
        z=np.empty(0, complex),
        T=growth.T,
        T_error=growth.T_error,
        verdict=growth.verdict,
        liouville_defect=_liouville(checked, p, period),
        reversibility_defect=float("nan"),
        method=method,
        half_period=False,
    )


def _by_subtraction(e: HillEquation, scale: Float) -> tuple[Float, float]:
    """What the rounding of F - eta^2/4 adds to A, and to P over its size, to first order.

    By Duhamel's formula a change dF moves A by the integral over the period of B dF A, and `scale`
    has the sizes of A and B. That counts every element as if it stood alone; by the modes of F it
    is far less, where F has modes.
    """
    n, eta = e.n, e.damping
    quarter, exact = 0.25 * eta**2, Fraction(eta) ** 2 / 4
    off = [abs(Fraction(f) - exact - Fraction(f - quarter)) for f in np.diag(e.F)]
    rounded = np.array([float(x) for x in off])
    alone = e.period * scale[:n, n:] @ (rounded[:, None] * scale[:n, :n])
    share = moved_by_diagonal(e.F, rounded, quarter, e.Omega)
    return alone, MODES * share


def _data(e: HillEquation) -> float:
    """What the errors of the matrices move P by, over its size."""
    if e.data_error == 0.0:
        return 0.0
    largest = np.max(np.abs(e.F)) + sum(np.max(np.abs(H)) for H in (e.gamma * e.G, *e.H))
    x = np.array([1.0 / e.Omega**2])
    shift = 0.25 * e.damping**2 * x if np.ndim(e.eta) == 0 else 0.0 * x
    return float(e.data_error * largest * x[0] * moved_by_data(e.F, x, shift)[1][0])


def _damp(Phi_u: Float, eta: float, period: float) -> Float:
    """Monodromy of (q, q') from that of (u, u'): q = exp(-eta tau/2) u."""
    n = len(Phi_u) // 2
    to_q = np.eye(2 * n)
    to_q[n:, :n] -= 0.5 * eta * np.eye(n)
    from_q = 2.0 * np.eye(2 * n) - to_q
    result: Float = np.exp(-0.5 * eta * period) * to_q @ Phi_u @ from_q
    return result


def _undamp(Phi: Float, eta: float, period: float) -> Float:
    """Monodromy of (u, u') from that of (q, q')."""
    return _damp(Phi, -eta, period)


def _liouville(Phi: Float, p: Parameters, period: float) -> float:
    sign, log_det = np.linalg.slogdet(Phi)
    log_ratio = float(log_det + period * np.trace(p.C))
    return float("inf") if log_ratio > 700.0 else float(np.abs(sign * np.exp(log_ratio) - 1.0))


def _reversibility(Phi_u: Float) -> float:
    n = len(Phi_u) // 2
    S = np.repeat([1.0, -1.0], [n, n])
    size = max(1.0, float(np.max(np.abs(Phi_u))))
    turned = S[:, None] * (Phi_u / size)
    return float(np.max(np.abs(turned @ turned - np.eye(2 * n) / size / size)))


def _descending(mu: Complex) -> Complex:
    ordered: Complex = mu[np.argsort(-np.abs(mu), kind="stable")]
    return ordered


def _finite(Phi: Float) -> Float:
    if not np.all(np.isfinite(Phi)):
        raise OverflowError(OVERFLOW)
    return Phi
