"""z, R, T and the verdict of many P(z), with what the error of P allows."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.stability import by_signs, separators, stabilities

Complex = NDArray[np.complexfloating[Any]]
Float = NDArray[np.floating[Any]]
EPS = float(np.finfo(float).eps)

# For roots a little beyond [-1, 1], whose polynomials are a little larger.
MARGIN = 4.0


@dataclass(frozen=True, eq=False)
class Points:
    """The solution at k points.

    Attributes
    ----------
    polynomial : (k, n + 1) ndarray
        P(z), or P(mu) of the multipliers, monic, highest power first.
    error : (k,) ndarray
        Bound on the absolute error of its coefficients.
    z : (k, n) complex ndarray
        Empty, (k, 0), where P is of the multipliers.
    multipliers : (k, m) complex ndarray
    R : (k,) ndarray
        Largest |z +- sqrt(z^2 - 1)|, (7.1.2); without z the largest multiplier's modulus.
    T : (k,) ndarray
        Characteristic argument (7.1.1).
    T_error : (k,) ndarray
        Bound on the error of `T`.
    verdict : (k,) ndarray of str
        "stable", "unstable" or "undecided": what P and its error show.
    """

    polynomial: Float
    error: Float
    z: Complex
    multipliers: Complex
    R: Float
    T: Float
    T_error: Float
    verdict: NDArray[np.str_]

    @property
    def stable(self) -> NDArray[np.bool_]:
        """Where the system is shown to be stable."""
        return np.asarray(self.verdict == "stable")

    @property
    def unstable(self) -> NDArray[np.bool_]:
        """Where it is shown to be unstable."""
        return np.asarray(self.verdict == "unstable")


def solve(polynomial: Float, error: Float, Omega: Float, eta: Float) -> Points:
    """Roots and growth of many P(z), (k, n + 1), each with its own error, Omega and eta."""
    errors = np.broadcast_to(error[:, None], polynomial.shape)
    found = stabilities(polynomial, errors, Omega, eta)
    root = np.sqrt(found.z - 1.0) * np.sqrt(found.z + 1.0)
    decay = np.exp(-np.pi * eta / Omega)[:, None]
    return Points(
        polynomial=polynomial,
        error=error,
        z=found.z,
        multipliers=decay * np.hstack([found.z + root, found.z - root]),
        R=np.exp((found.T + eta) * np.pi / Omega),
        T=found.T,
        T_error=found.T_error,
        verdict=found.verdict,
    )


def verdicts(p: Float, error: Float, T: Float, Omega: Float, eta: Float) -> NDArray[np.str_]:
    """The verdict of many P(z), (k, n + 1), as `solve` has it, at a hundredth of the price.

    Most are settled by P's signs or by a growth well beyond its error; only the others have discs
    put about their roots.

    Parameters
    ----------
    T : (k,) ndarray
        As computed from P's roots.
    """
    n = p.shape[1] - 1
    errors = np.broadcast_to(error[:, None], p.shape).copy()
    errors[:, 0] = 0.0
    decay = np.pi * eta / Omega
    inside, beyond = by_signs(p, errors, separators(p), decay)
    # the bound is for roots about [-1, 1], whose polynomials are no larger than this
    near = np.max(np.abs(p), axis=1) <= MARGIN * 2.0**n
    growth = T * (np.pi / Omega)
    rounding = 8.0 * EPS * (1.0 + np.abs(decay) + np.abs(growth))
    grows = near & (growth > largest_error(n, error) + rounding)
    stable = inside & (eta >= 0.0)
    result = np.where(stable, "stable", np.where(beyond | grows, "unstable", "undecided"))
    rest = np.flatnonzero(result == "undecided")
    result[rest] = stabilities(p[rest], errors[rest], Omega[rest], eta[rest]).verdict
    return np.asarray(result)


def argument_errors(p: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Float:
    """Bounds on the errors of many T that were computed from P(z), (k, n + 1), as it is."""
    errors = np.broadcast_to(error[:, None], p.shape).copy()
    errors[:, 0] = 0.0
    # all z real and within [-1, 1]: T is -eta
    still, _ = by_signs(p, errors, separators(p), np.zeros(len(p)))
    result = np.abs(T + eta) + 8.0 * EPS * (Omega / np.pi + np.abs(eta))
    rest = np.flatnonzero(~still)
    found = stabilities(p[rest], errors[rest], Omega[rest], eta[rest])
    result[rest] = found.T_error + np.abs(found.T - T[rest])
    return np.asarray(result)


def largest_error(n: int, error: Float) -> Float:
    """More than the error of ln R can be for roots near [-1, 1]: all n together, at +1 or -1.

    Within radius r of [-1, 1] ln R is at most arccosh(1 + r) < sqrt(2 r).
    """
    beyond = MARGIN * (error + 3 * n * EPS * 2.0**n)
    radius = (beyond * np.sum(2.0 ** np.arange(n))) ** (1.0 / n)
    return np.asarray(np.sqrt(2.0 * radius))
