"""How a chart's polynomial is come by and what it tells: the one place where that is chosen.

A `Reading` takes an equation to its polynomial, by either route, and the polynomial to T, to a
verdict and to what changes sign where stability ends. `IN_Z` is that of Hill's equation with one
number for damping, whose P is a polynomial in z = (mu + 1/mu)/2; `IN_PAIRS` of any other whose
multipliers come in pairs as well; `IN_MU` of all others, whose P is of the multipliers themselves.
Another kind of equation is another
`Reading`, and a line in `reading_of`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.stability import multipliers
from compare.stability.indicators import edge_function, growth, indicator
from compare.stability.pairs import folded, has_pairs
from compare.stability.points import Codes, Points, argument_errors, solve, verdicts
from compare.stability.roots import growth as log_R
from floquet import batch as by_floquet
from hill import HillEquation, PeriodicEquation
from hill import batch as by_hill

Float = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Reading:
    """A kind of polynomial.

    Attributes
    ----------
    variable : str
        What it is a polynomial of.
    general : bool
        Whether it is one of a `PeriodicEquation`; a `HillEquation` is then taken as such.
    pairs : bool
        Whether that must have multipliers in pairs.
    degree : callable
        An equation to the degree of its polynomial.
    polynomials : mapping of {"hill", "floquet"} to callable
        Equations to what has their `coefficients`, (k, degree + 1), monic, and `errors`, (k,).
    argument : callable
        Coefficients (degree + 1, k), Omega and eta (k,) to T (7.1.1), (k,); for many points.
    growth : callable
        Coefficients (k, degree + 1), Omega and eta to T; from the roots, for a few.
    verdicts : callable
        Coefficients (k, degree + 1), errors, T, Omega and eta (k,) to which of
        `compare.stability.points.VERDICTS`.
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
    general: bool
    pairs: bool
    degree: Callable[[Any], int]
    polynomials: Mapping[str, Callable[[Sequence[Any]], Any]]
    argument: Callable[[Float, Float, Float], Float]
    growth: Callable[[Float, Float, float], Float]
    verdicts: Callable[[Float, Float, Float, Float, Float], Codes]
    argument_errors: Callable[[Float, Float, Float, Float, Float], Float]
    solve: Callable[[Float, Float, Float, Float], Points]
    indicator: Callable[[str, Float, Float, float], Float]
    edge_function: Callable[[str, Float, Float, Any], Float]
    kinds: tuple[str, ...]

    def form(self, equation: HillEquation | PeriodicEquation, eta: float) -> Any:
        """An equation, asked for at this eta, in the form in which it has such a polynomial.

        Raises
        ------
        ValueError
            It has none.
        """
        if self.general and isinstance(equation, HillEquation):
            return self.form(equation.general(), eta)
        if isinstance(equation, HillEquation) and not np.array_equal(equation.eta, eta):
            raise ValueError(
                f"eta = {eta:g}: the equation's own is another one, as it is not at the corners of "
                "the chart; T would be read with the wrong one"
            )
        if self.pairs and not has_pairs(equation, eta):  # type: ignore[arg-type]
            raise ValueError(
                f"Omega = {equation.Omega:g}: the multipliers come in no pairs, as they do at the "
                "corners of the chart; leave out where the equation is another one"
            )
        return equation


def _argument(P: Float, Omega: Float, eta: Float) -> Float:
    """T = (Omega/pi) ln R - eta (7.1.1)."""
    return np.asarray(log_R(P) * (Omega / np.pi) - eta)


def _coordinates(equation: HillEquation) -> int:
    return equation.n


def _order(equation: PeriodicEquation) -> int:
    return equation.order


def _half_order(equation: PeriodicEquation) -> int:
    return equation.order // 2


IN_Z = Reading(
    variable="z",
    general=False,
    pairs=False,
    degree=_coordinates,
    polynomials={"hill": by_hill.polynomials, "floquet": by_floquet.polynomials},
    argument=_argument,
    growth=growth,
    verdicts=verdicts,
    argument_errors=argument_errors,
    solve=solve,
    indicator=indicator,
    edge_function=edge_function,
    kinds=("+1", "-1", "pair"),
)

IN_MU = Reading(
    variable="mu",
    general=True,
    pairs=False,
    degree=_order,
    polynomials=IN_Z.polynomials,
    argument=multipliers.argument,
    growth=multipliers.growth,
    verdicts=multipliers.verdicts,
    argument_errors=multipliers.argument_errors,
    solve=multipliers.solve,
    indicator=multipliers.indicator,
    edge_function=multipliers.edge_function,
    kinds=IN_Z.kinds,
)


IN_PAIRS = replace(
    IN_Z,
    general=True,
    pairs=True,
    degree=_half_order,
    polynomials={route: partial(folded, own) for route, own in IN_Z.polynomials.items()},
)


def reading_of(
    equations: Sequence[HillEquation | PeriodicEquation], eta: Sequence[float]
) -> Reading:
    """What all of these have polynomials of, each forced at its own eta."""
    pairs = list(zip(equations, eta, strict=True))
    if all(isinstance(e, HillEquation) and np.array_equal(e.eta, own) for e, own in pairs):
        return IN_Z
    general = [e.general() if isinstance(e, HillEquation) else e for e in equations]
    paired = all(has_pairs(e, own) for e, own in zip(general, eta, strict=True))
    return IN_PAIRS if paired else IN_MU
