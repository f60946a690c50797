"""z, R, T and the verdict of many P(z), with what the error of P allows."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.stability import by_signs, separators, stabilities

Complex = NDArray[np.complexfloating[Any]]
Float = NDArray[np.floating[Any]]
Codes = NDArray[np.int8]
EPS = float(np.finfo(float).eps)

# For roots a little beyond [-1, 1], whose polynomials are a little larger.
MARGIN = 4.0

# Above 1 for roundings: what it lets in besides is measured by its own size.
SIZE = 1.01

# A coefficient: Horner's rule at |x| <= 1 rounds by half an ulp twice; the rest is room.
ULPS = 8.0

VERDICTS = ("undecided", "stable", "unstable")
UNDECIDED, STABLE, UNSTABLE = range(len(VERDICTS))
"""A verdict as a byte: a word takes 36."""


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


def verdicts(p: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Codes:
    """The verdict of many P(z), (k, n + 1), as `solve` has it, at a hundredth of the price.

    Most are settled by P's signs or by a growth well beyond its error; only the others have discs
    put about their roots.

    Parameters
    ----------
    T : (k,) ndarray
        As computed from P's roots.

    Returns
    -------
    (k,) ndarray of int8
        Which of `VERDICTS`.
    """
    result = np.where(_inside(p, error) & (eta >= 0.0), STABLE, UNDECIDED).astype(np.int8)
    for step in (_by_growth, _by_signs, _by_discs):
        rest = np.flatnonzero(result == UNDECIDED)
        result[rest] = step(*(x[rest] for x in (p, error, T, Omega, eta)))
    return result


def _by_growth(p: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Codes:
    """What T beyond its error tells."""
    n = p.shape[1] - 1
    # the bound is for roots about [-1, 1], whose polynomials are no larger than this
    near = np.max(np.abs(p), axis=1) <= MARGIN * 2.0**n
    growth = T * (np.pi / Omega)
    rounding = 8.0 * EPS * (1.0 + np.abs(np.pi * eta / Omega) + np.abs(growth))
    grows = near & (growth > largest_error(n, error) + rounding)
    return np.where(grows, UNSTABLE, UNDECIDED).astype(np.int8)


def _by_signs(p: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Codes:
    """What P's signs at the edges and between its roots tell."""
    del T
    inside, beyond = by_signs(p, _errors(p, error), separators(p), np.pi * eta / Omega)
    unstable = np.where(beyond, UNSTABLE, UNDECIDED)
    return np.where(inside & (eta >= 0.0), STABLE, unstable).astype(np.int8)


def _by_discs(p: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Codes:
    """What discs about the roots tell."""
    del T
    return codes(stabilities(p, _errors(p, error), Omega, eta).verdict)


def _errors(p: Float, error: Float) -> Float:
    """One a coefficient, none of the leading 1."""
    errors = np.broadcast_to(error[:, None], p.shape).copy()
    errors[:, 0] = 0.0
    return errors


def _inside(p: Float, error: Float) -> NDArray[np.bool_]:
    """Whether P changes its sign n times within (-1, 1), by far: all z are there, real and simple.

    As `hill.stability.by_signs` with one margin for all points, no smaller than its own: it shows
    most of a chart to be stable for a twentieth of the price. Above the third degree nothing.
    """
    n, lines = p.shape[1] - 1, p.T
    if n > 3:
        return np.zeros(len(p), bool)
    sign = 1.0
    with np.errstate(over="ignore", invalid="ignore"):
        # of z within [-1, 1] the coefficients are binomials at most, 2^n in all
        inside = np.sum(np.abs(lines), axis=0) <= SIZE * 2.0**n
        margin = 1.01 * n * error + ULPS * (n + 1) * EPS * SIZE * 2.0**n
        for x in (1.0, *_between(lines), -1.0):
            value = lines[1] + x
            for line in lines[2:]:
                value *= x
                value += line
            value *= sign
            inside &= value > margin
            if isinstance(x, np.ndarray):
                inside &= np.abs(x) < 1.0
            sign = -sign
    return inside


def _between(lines: Float) -> tuple[Float, ...]:
    """`hill.stability.separators`, descending, of coefficients a line a power."""
    if len(lines) == 2:
        return ()
    if len(lines) == 3:
        return (-0.5 * lines[1],)
    spread = np.sqrt(np.maximum(lines[1] ** 2 - 3.0 * lines[2], 0.0))
    return (spread - lines[1]) / 3.0, (-lines[1] - spread) / 3.0


def codes(verdicts: NDArray[np.str_]) -> Codes:
    """Which of `VERDICTS` each is."""
    unstable = np.where(verdicts == VERDICTS[UNSTABLE], UNSTABLE, UNDECIDED)
    return np.where(verdicts == VERDICTS[STABLE], STABLE, unstable).astype(np.int8)


def argument_errors(p: Float, error: Float, T: Float, Omega: Float, eta: Float) -> Float:
    """Bounds on the errors of many T that were computed from P(z), (k, n + 1), as it is."""
    result = np.abs(T + eta) + 8.0 * EPS * (Omega / np.pi + np.abs(eta))
    # all z real and within [-1, 1]: T is -eta
    rest = np.flatnonzero(~_inside(p, error))
    still, _ = by_signs(
        p[rest], _errors(p[rest], error[rest]), separators(p[rest]), np.zeros(len(rest))
    )
    rest = rest[~still]
    found = stabilities(p[rest], _errors(p[rest], error[rest]), Omega[rest], eta[rest])
    result[rest] = found.T_error + np.abs(found.T - T[rest])
    return np.asarray(result)


def largest_error(n: int, error: Float) -> Float:
    """More than the error of ln R can be for roots near [-1, 1]: all n together, at +1 or -1.

    Within radius r of [-1, 1] ln R is at most arccosh(1 + r) < sqrt(2 r).
    """
    beyond = MARGIN * (error + 3 * n * EPS * 2.0**n)
    radius = (beyond * np.sum(2.0 ** np.arange(n))) ** (1.0 / n)
    return np.asarray(np.sqrt(2.0 * radius))
