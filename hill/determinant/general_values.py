"""Det(mu I - Phi) at any points, how it moves there, and what is known of it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hill.arrays import EPS, Complex, Float
from hill.determinant.general import folded
from hill.determinant.general_rounding import motion
from hill.determinant.general_tail import REMAINDER, Tail, kept, tail
from hill.determinant.pencil import Pencil, pencil
from hill.equation import HillEquation
from hill.periodic import PeriodicEquation

# Elements of the groups' matrices that are kept at a time, in each of three lists.
MEMORY = 3_000_000


@dataclass(frozen=True, eq=False)
class Determinant:
    """All of an equation that no mu changes.

    Attributes
    ----------
    p : Pencil
    t : Tail
    K : int
        Groups of rows kept on either side.
    """

    p: Pencil
    t: Tail
    K: int

    @property
    def order(self) -> int:
        """Number of multipliers m."""
        return self.p.order

    @property
    def mean(self) -> float:
        """Ln r/2 pi, r^m the product of all multipliers."""
        return -self.p.trace / (self.p.order * self.p.Omega)

    @property
    def mean_error(self) -> float:
        """What m ln r is off: the trace's own error, and roundings of it."""
        return 2.0 * np.pi * (self.p.trace_error + 4.0 * EPS * abs(self.p.trace)) / self.p.Omega

    @property
    def harmonics(self) -> int:
        """Kept on either side, where they are fewer."""
        return (self.K + 1) * self.p.reach - self.p.reach // 2 - 1


@dataclass(frozen=True, eq=False)
class Values:
    """Det(mu I - Phi)/(r^m |y|^(m/2)) at k points y = mu/r.

    Attributes
    ----------
    mantissa : (k,) complex ndarray
    exponent : (k,) int ndarray
        A power of two.
    slope : (k,) complex ndarray
        Of ln det(mu I - Phi), by ln mu/2 pi.
    rounding, data : (k,) ndarray
        What rounding, and errors of the data, may have moved the logarithm by; empty if not asked.
    """

    mantissa: Complex
    exponent: NDArray[np.int_]
    slope: Complex
    rounding: Float
    data: Float


def determinant(equation: HillEquation | PeriodicEquation) -> Determinant:
    """Prepare an equation.

    Raises
    ------
    ValueError
        Omega is too small for the determinant.
    """
    if isinstance(equation, HillEquation):
        # gamma G is rounded, and its sum with some H
        p = pencil(equation.general(), ulps=1.0)
    else:
        p = pencil(equation)
    t = tail(p)
    try:
        return Determinant(p, t, kept(p, t))
    except ValueError as refused:
        raise ValueError(f"Omega = {equation.Omega:g}: {refused}") from None


def values(d: Determinant, log_y: Complex, *, bounds: bool = True) -> Values:
    """Evaluate at points with abs(Im ln y) <= pi.

    Parameters
    ----------
    d : Determinant
    log_y : (k,) complex ndarray
        Where r y = mu, over 2 pi.
    bounds : bool, optional
        Ask for `rounding` and `data`.

    Raises
    ------
    numpy.linalg.LinAlgError
        A group of rows is singular at a point.
    """
    b = d.p.reach * d.p.n
    some = max(1, MEMORY // (2 * (d.K + 1) * b * b))
    found = []
    for start in range(0, len(log_y), some):
        f = folded(d.p, d.t, d.K, d.mean + log_y[start : start + some])
        m = motion(d.p, d.t, f, bounds=bounds)
        found.append(
            (f.mantissa, f.exponent, m.slope, m.rounding + bounds * 10.0 * REMAINDER, m.data)
        )
    return Values(*(np.concatenate(parts) for parts in zip(*found, strict=True)))
