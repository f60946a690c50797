"""How far multipliers, or z, that were found by other means are from the true ones at most."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hill.arrays import Complex, Float
from hill.determinant.general_values import determinant
from hill.determinant.roots import Evaluate, at, discs, monic_in_y, monic_in_z
from hill.equation import HillEquation
from hill.periodic import PeriodicEquation

# Of P' by rounding: beyond it nothing is said.
MAX_OFF = 0.5


@dataclass(frozen=True, eq=False)
class RootDistance:
    """What the determinant and its derivative say at k points.

    Attributes
    ----------
    points : (k,) complex ndarray
        As given: multipliers, or z.
    newton : (k,) complex ndarray
        P/P': a root is about that much less than the point.
    distance : (k,) ndarray
        Bound on the distance to the nearest root, `n |P/P'|` for a polynomial of degree n, rounding
        included; infinite where rounding hides P'.
    error : (k,) ndarray
        The part of `distance` that is due to rounding.
    radius : (k,) ndarray
        Where as many points were given as there are roots: the disc of this radius about each holds
        a root of its own, so that none is missing. Empty otherwise.
    """

    points: Complex
    newton: Complex
    distance: Float
    error: Float
    radius: Float


def root_distance(
    equation: HillEquation | PeriodicEquation,
    *,
    multipliers: ArrayLike | None = None,
    z: ArrayLike | None = None,
) -> RootDistance:
    """Evaluate the infinite determinant and its derivative at points.

    What a determinant of many coordinates knows of its coefficients says little of the roots. At a
    root itself it knows them to rounding, wherever the point came from.

    Parameters
    ----------
    equation : HillEquation or PeriodicEquation
    multipliers : (k,) array_like, optional
    z : (k,) array_like, optional
        cos 2 pi alpha instead, of a `HillEquation` whose damping is one number.

    Returns
    -------
    RootDistance

    Raises
    ------
    ValueError
        Neither or both given; a point that is not finite, or a multiplier 0; z of an equation that
        has none; an `Omega` too small for the determinant.
    """
    if (multipliers is None) == (z is None):
        raise ValueError("multipliers, z: give one of them")
    name, given = ("z", z) if multipliers is None else ("multipliers", multipliers)
    points = _points(name, given)
    has_z = isinstance(equation, HillEquation) and np.ndim(equation.eta) == 0
    if name == "z" and not has_z:
        raise ValueError("z: the equation has none; give multipliers")
    if name == "multipliers" and np.any(points == 0.0):
        raise ValueError("multipliers: must not be 0")
    d = determinant(equation)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        if name == "z":
            return _measured(monic_in_z(d), points, points, 1.0, d.order // 2)
        scale = float(np.exp(2.0 * np.pi * d.mean))
        return _measured(monic_in_y(d), points, points / scale, scale, d.order)


def _points(name: str, given: Any) -> Complex:
    try:
        points = np.asarray(given, complex)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be numbers") from None
    if points.ndim != 1 or not np.all(np.isfinite(points)):
        raise ValueError(f"{name}: must be a sequence of finite numbers")
    return points


def _measured(
    evaluate: Evaluate, points: Complex, v: Complex, scale: float, degree: int
) -> RootDistance:
    """At points v = points/scale of a monic polynomial."""
    here, moved = at(evaluate, v)
    newton = 1.0 / here.slope
    size = np.abs(newton)
    # what rounding adds to P is a polynomial too, whose derivative Markov bounds
    off = degree**2 * here.rounding * size / here.unit
    known = off < MAX_OFF
    reach = np.where(known, degree * size / (1.0 - np.where(known, off, 0.0)), np.inf)
    error = reach * here.rounding + here.blur + np.abs(moved - v)
    return RootDistance(
        points=points,
        newton=scale * newton,
        distance=scale * (reach + error),
        error=scale * error,
        radius=scale * discs(evaluate, v).radius if len(v) == degree else np.empty(0),
    )
