"""The word that a result has for numbers whose bounds are wide: one rule, and no numbers made.

A bound holds for every system, so for some it is far too large, and nobody can tell without the
true value. What can be told is how large it is: a bound below `POOR` of its number cannot be more
than a million times the true error, an ulp being an error that nobody is spared. Above, the result
says what its numbers are known to.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

POOR = 1e6 * float(np.finfo(float).eps)
"""2e-10, nine digits and a half. Of the report's rows the time domain knows T to 3e-11 at worst,
the determinant to 1e-9 where a row is close to an edge."""


def poor_T(T: ArrayLike, T_error: ArrayLike, Omega: ArrayLike) -> NDArray[np.bool_]:
    """Whether T is known to less than nine digits of itself, or of Omega/pi, by which it is made.

    Parameters
    ----------
    T, T_error, Omega : array_like
        Broadcast against each other.
    """
    size = np.maximum(np.abs(np.asarray(T, float)), np.asarray(Omega, float) / np.pi)
    return np.asarray(~(np.asarray(T_error, float) <= POOR * size))


def poor_P(polynomial: ArrayLike, error: ArrayLike) -> NDArray[np.bool_]:
    """Whether the coefficients of P are known to less than nine digits of the largest.

    Parameters
    ----------
    polynomial : (..., n + 1) array_like
    error : (...) array_like
        Of every coefficient.
    """
    size = np.max(np.abs(np.asarray(polynomial, float)), axis=-1)
    return np.asarray(~(np.asarray(error, float) <= POOR * size))


def remark(
    T: float, T_error: float, Omega: float, verdict: str, polynomial: ArrayLike, error: float
) -> str:
    """What of a result is poorly known, in a sentence; empty where nothing is.

    Parameters
    ----------
    T, T_error, Omega, verdict
        Of a result; `T_error` may be infinite.
    polynomial : (n + 1,) array_like
    error : float
        Of every coefficient.
    """
    said = []
    if verdict == "undecided":
        said.append(f"whether T is above 0 is not shown: T = {T:.3g} +- {T_error:.1e}")
    elif poor_T(T, T_error, Omega):
        said.append(f"T is known to +- {T_error:.1e} only")
    if poor_P(polynomial, error):
        share = error / float(np.max(np.abs(np.asarray(polynomial, float))))
        said.append(f"P is known to +- {share:.1e} times its largest coefficient only")
    return "; ".join(said)


def remark_of_slopes(known: Mapping[str, tuple[ArrayLike, ArrayLike, ArrayLike]]) -> str:
    """Which derivatives of T are poorly known, in a sentence; empty where none is.

    One is where its error, times its parameter, is above nine digits of the largest product of a
    slope and its parameter: of what T owes to any of them.

    Parameters
    ----------
    known : mapping of str to (slope, error, value)
        By parameter: arrays of one shape where it is a matrix.
    """
    owed, doubt = (
        {name: float(np.vdot(np.abs(of[k]), np.abs(of[2]))) for name, of in known.items()}
        for k in (0, 1)
    )
    most = max(owed.values(), default=0.0)
    poor = [
        f"dT/d{name} to +- {np.max(np.asarray(error)):.1e}"
        for name, (_, error, _) in known.items()
        if not doubt[name] <= POOR * most
    ]
    return f"known only: {', '.join(poor)}" if poor else ""
