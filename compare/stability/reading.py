"""How a chart's polynomial is come by and what it tells: the one place where that is chosen.

A `Reading` takes an equation to its polynomial, by either route, and the polynomial to T, to a
verdict and to what changes sign where stability ends. `IN_Z` is that of Hill's equation with one
number for damping, whose P is a polynomial in z = (mu + 1/mu)/2. Another kind of equation is
another `Reading`, and a line in `reading_of`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.stability.indicators import edge_function, growth, indicator
from compare.stability.points import Points, argument_errors, solve, verdicts
from compare.stability.roots import growth as log_R
from floquet import batch as by_floquet
from hill import HillEquation
from hill import batch as by_hill

Float = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Reading:
    """A kind of polynomial.

    Attributes
    ----------
    variable : str
        What it is a polynomial of.
    degree : callable
        An equation to the degree of its polynomial.
    polynomials : mapping of {"hill", "floquet"} to callable
        Equations to what has their `coefficients`, (k, degree + 1), monic, and `errors`, (k,).
    argument : callable
        Coefficients (degree + 1, k), Omega and eta (k,) to T (7.1.1), (k,); for many points.
    growth : callable
        Coefficients (k, degree + 1), Omega and eta to T; from the roots, for a few.
    verdicts : callable
        Coefficients (k, degree + 1), errors, T, Omega and eta (k,) to verdicts.
    argument_errors : callable
        The same to bounds on the errors of T.
    solve : callable
        Coefficients (k, degree + 1), errors, Omega and eta (k,) to `Points`.
    indicator, edge_function : callable
        As `compare.stability.indicators` has them.
    kinds : tuple of str
        Of edges: the first argument of `indicator` and `edge_function`.
    """

    variable: str
    degree: Callable[[Any], int]
    polynomials: Mapping[str, Callable[[Sequence[Any]], Any]]
    argument: Callable[[Float, Float, Float], Float]
    growth: Callable[[Float, Float, float], Float]
    verdicts: Callable[[Float, Float, Float, Float, Float], NDArray[np.str_]]
    argument_errors: Callable[[Float, Float, Float, Float, Float], Float]
    solve: Callable[[Float, Float, Float, Float], Points]
    indicator: Callable[[str, Float, Float, float], Float]
    edge_function: Callable[[str, Float, Float, Any], Float]
    kinds: tuple[str, ...]


def _argument(P: Float, Omega: Float, eta: Float) -> Float:
    """T = (Omega/pi) ln R - eta (7.1.1)."""
    return np.asarray(log_R(P) * (Omega / np.pi) - eta)


def _coordinates(equation: Any) -> int:
    return int(equation.n)


IN_Z = Reading(
    variable="z",
    degree=_coordinates,
    polynomials={"hill": by_hill.polynomials, "floquet": by_floquet.polynomials},
    argument=_argument,
    growth=growth,
    verdicts=verdicts,
    argument_errors=argument_errors,
    solve=solve,
    indicator=indicator,
    edge_function=edge_function,
    kinds=("+1", "-1", "discriminant"),
)


def reading_of(equation: Any) -> Reading:
    """The reading of an equation's polynomial.

    Raises
    ------
    ValueError
        A damping matrix, whose polynomial is not of z.
    """
    if isinstance(equation, HillEquation) and np.ndim(equation.eta) > 0:
        raise ValueError("eta: is a matrix; a chart needs one number, or its P(z) does not exist")
    return IN_Z
