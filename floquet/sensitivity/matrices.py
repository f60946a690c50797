"""A matrix whose eigenvalues are z, or the multipliers, and what moves its elements.

Three ways to it, as in :mod:`floquet.period`: half a period or a whole one in
``u = exp(eta tau/2) q``, and the whole period in q as it stands. Gradients are flat:
``Omega, gamma, eta, F, G, H``, row by row.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from floquet.arrays import Float
from floquet.integrate.ode import parameter_values, shape
from floquet.integrate.taylor import Taylor
from floquet.period import second_half
from floquet.sensitivity.tape import Gradient, Tape, record
from hill import HillEquation

Pull = Callable[[Float], tuple[Float, Float]]


@dataclass(frozen=True, eq=False)
class MatrixGradient:
    """A matrix and its gradients.

    Attributes
    ----------
    matrix : (m, m) float ndarray
        A, or the monodromy matrix with a damping matrix.
    scale : (m, m) float ndarray
        Size of the terms that each element sums.
    pull : callable
        For a seed of that shape the flat gradient of ``sum(seed * matrix)``, and the sum of the
        moduli of its terms.
    """

    matrix: Float
    scale: Float
    pull: Pull


def half_period(equation: HillEquation, method: Taylor) -> MatrixGradient:
    """A of Phi = S U^-1 S U, U over half a period in u."""
    t, n = _tape(equation, method, 0.5, undamped=True), len(equation.F)
    S = np.repeat([1.0, -1.0], [n, n])
    Phi, scale = second_half(t.end)
    first = S[:, None] * np.linalg.inv(t.end) * S

    def pull(seed: Float) -> tuple[Float, Float]:
        # dPhi = S U^-1 S dU - S U^-1 dU U^-1 S U, and with X = S U^-1 S the last is X S dU S Phi
        back = first.T @ _corner(seed)
        return _flat(t, equation, back - S[:, None] * (back @ Phi.T) * S, in_u=True)

    return MatrixGradient(Phi[:n, :n], scale[:n, :n], pull)


def whole_period(equation: HillEquation, method: Taylor) -> MatrixGradient:
    """A of the whole period in u."""
    t, n = _tape(equation, method, 1.0, undamped=True), len(equation.F)
    block = t.end[:n, :n]
    return MatrixGradient(
        block, np.abs(block), lambda seed: _flat(t, equation, _corner(seed), in_u=True)
    )


def damped_whole_period(equation: HillEquation, method: Taylor) -> MatrixGradient:
    """A from the whole period in q: u(0) = I and u'(0) = 0 are q(0) = I and q'(0) = -eta/2 I."""
    t, n, eta = _tape(equation, method, 1.0), len(equation.F), equation.damping
    swell = float(np.exp(0.5 * eta * t.time))
    beside = swell * t.end[:n, n:]
    A = swell * t.end[:n, :n] - 0.5 * eta * beside

    def pull(seed: Float) -> tuple[Float, Float]:
        found, moduli = _flat(t, equation, _corner(swell * seed, -0.5 * eta * swell * seed))
        for k, term in (
            (0, -0.5 * eta * t.time / equation.Omega * A),
            (2, 0.5 * (t.time * A - beside)),
        ):
            found[k] += np.sum(seed * term)
            moduli[k] += np.sum(np.abs(seed * term))
        return found, moduli

    return MatrixGradient(A, np.abs(A), pull)


def multipliers(equation: HillEquation, method: Taylor) -> MatrixGradient:
    """The monodromy matrix itself, for a damping matrix."""
    t = _tape(equation, method, 1.0)
    return MatrixGradient(t.end, np.abs(t.end), lambda seed: _flat(t, equation, seed))


def _tape(equation: HillEquation, method: Taylor, share: float, undamped: bool = False) -> Tape:
    p = parameter_values(equation, undamped=undamped)
    return record(method, p, shape(equation), share * 2.0 * np.pi / equation.Omega)


def _corner(left: Float, right: Float | None = None) -> Float:
    """A seed of the first n rows, as one of all 2n."""
    n = len(left)
    whole = np.zeros((2 * n, 2 * n))
    whole[:n, :n] = left
    if right is not None:
        whole[:n, n:] = right
    return whole


def _flat(
    t: Tape, equation: HillEquation, seed: Float, *, in_u: bool = False
) -> tuple[Float, Float]:
    """Flat gradient of ``sum(seed * t.end)`` and the moduli of its terms."""
    n, Omega = t.size.n, equation.Omega
    # the period follows Omega, and so does omega_L: H without a common period has no z
    ratio = equation.ratio if equation.H else 0

    def row(g: Gradient, time: float, eta: float) -> Float:
        p = g.parameters
        C = p.C if np.ndim(equation.eta) > 0 else np.trace(p.C)
        damping = eta * np.trace(p.F) if in_u else C
        H = p.H.reshape(n, t.size.terms, n).swapaxes(0, 1)
        numbers = (p.Omega + ratio * p.omega_L + time * g.time, p.gamma)
        return np.concatenate([np.ravel(x) for x in (*numbers, damping, p.F, p.G, H)])

    found, moduli = t.pull(seed)
    time = t.time / Omega
    # in u the stiffness is F - eta^2/4
    eta = 0.5 * equation.damping if in_u else 0.0
    return row(found, -time, -eta), row(moduli, time, abs(eta))
