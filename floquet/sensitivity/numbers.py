"""What the numbers of a system's equation owe to one parameter: F, G, H and the forcing itself.

Linear parameters take two evaluations far apart; the others the derivative of a Chebyshev series.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from floquet.arrays import EPS, Float
from floquet.sensitivity.derivative import differentiate
from floquet.witness import matrices_of
from hill import HillEquation, PeriodicEquation, varied

FORCING = ("Omega", "gamma", "eta")

FAR = 2.0**30
"""Two values of what F and G are linear in are so far apart, where its range allows it: then no
digit cancels."""

LINEAR_ULPS = 32.0
"""Rounding of matrices, over their largest element: of the witness's own 21 ulps were seen, over
200 beams against the closed forms."""

# A secant near the parameter's value may differ from the slope by so many ulps of the matrices.
NEARBY_ULPS = 256.0


@dataclass(frozen=True, eq=False)
class Moved:
    """Derivatives of an equation's numbers, and bounds on the error of each of their elements.

    Both have the keys "F", "G" (n, n), "H" (terms, n, n), "gamma", "Omega" (numbers) and "eta" (a
    number, or (n, n) for a damping matrix); of the forcing only what is beside the values asked
    for: an equation with the forcing it is asked for has 0 there.
    """

    slope: dict[str, Any]
    error: dict[str, Any]


def moved_by(
    system: Any, name: str, *, Omega: float, gamma: float, eta: float, value: float
) -> Moved:
    """Differentiate the numbers of a system's equation.

    Parameters
    ----------
    system : System
    name : str
        One of its parameters, "Omega", "gamma" or "eta".
    Omega, gamma, eta : float
        The forcing.
    value : float
        Of the parameter.

    Raises
    ------
    OutOfForm
        With other values of the parameter the equation is not Hill's.
    ValueError
        The value is too close to where an element is singular; an element is not linear that the
        parameter says is.
    """
    make, _ = matrices_of(system)
    asked = {"Omega": Omega, "gamma": gamma, "eta": eta}
    base = make(system, **asked)

    def at(x: float) -> Float:
        if name in FORCING:
            forcing = asked | {name: x}
            return _stack(make(system, **forcing), forcing)
        return _stack(make(varied(system, {name: x}), **asked), asked)

    ways, here = _ways(system, name), at(value)
    found, error = np.zeros_like(here), np.zeros(len(here))
    width = _width(ways, value, scale=Omega if name == "eta" else 1.0)
    # H stays with its Omega: without a common period there is no equation to be had
    try:
        moving = [] if base.H and name == "Omega" else _moving(at, ways, here, value, width)
    except _Moves:
        raise ValueError(
            f"{name}: says that it moves {', '.join(ways.moves)}, and it moves others too"
        ) from None
    except _General:
        raise OutOfForm(f"{name}: with other values of it the equation is not Hill's") from None
    if moving:

        def inner(x: float) -> Float:
            return at(x)[moving]

        try:
            if ways.linear:
                found[moving], error[moving] = _linear(inner, ways, value, width)
            else:
                found[moving], error[moving] = differentiate(
                    inner, value, ways.low, ways.high, width
                )
        except _NotLinear:
            raise ValueError(
                f"{name}: says that its dependence is linear, and the matrices are not"
            ) from None
        except ValueError:
            raise ValueError(
                f"{name} = {value:g}: is too close to where a coefficient is singular to "
                "differentiate"
            ) from None
    return _named(base, found, error)


class OutOfForm(ValueError):
    """A parameter, zero as a rule, that takes an equation out of Hill's form: no F, no G."""


class _General(Exception):
    """Not Hill's form."""


class _NotLinear(Exception):
    """Said to be linear, and not."""


class _Moves(Exception):
    """Said to stay, and does not."""


@dataclass(frozen=True)
class _Ways:
    """How the matrices move with a parameter, and where they may be asked for."""

    low: float
    high: float
    linear: bool = False
    moves: tuple[str, ...] = ("F", "G", "H")


def _ways(system: Any, name: str) -> _Ways:
    for p in system.parameters:
        if p.name == name:
            return _Ways(p.low, p.high, p.dependence == "linear", p.moves)
    return _Ways(0.0 if name == "Omega" else -np.inf, np.inf)


def _stack(e: HillEquation | PeriodicEquation, asked: Mapping[str, float]) -> Float:
    """F, G, each H, then the forcing less what was asked for, (k, n, n)."""
    if not isinstance(e, HillEquation):
        raise _General
    n = len(e.F)
    corner = np.zeros((n, n))
    corner[0, 0] = 1.0
    damping = np.asarray(e.eta, float)
    beside = (
        damping - asked["eta"] * np.eye(n) if damping.ndim else (damping - asked["eta"]) * corner
    )
    numbers = [(e.gamma - asked["gamma"]) * corner, (e.Omega - asked["Omega"]) * corner, beside]
    return np.array([e.F, e.G, *e.H, *numbers])


def _named(base: HillEquation, found: Float, error: Float) -> Moved:
    terms = len(base.H)
    matrix = np.ndim(base.eta) > 0
    slope = {"F": found[0], "G": found[1], "H": found[2 : 2 + terms]}
    slope |= {"gamma": found[-3, 0, 0], "Omega": found[-2, 0, 0]}
    slope |= {"eta": found[-1] if matrix else found[-1, 0, 0]}
    keys = ("gamma", "Omega", "eta")
    bounds: dict[str, Any] = {"F": error[0], "G": error[1], "H": error[2 : 2 + terms, None, None]}
    return Moved(slope, bounds | dict(zip(keys, error[-3:], strict=True)))


def _width(ways: _Ways, value: float, scale: float) -> float:
    """Half the widest interval to try."""
    width = 0.5 * abs(value) if value else 0.5 * scale
    if np.isfinite(ways.low) and np.isfinite(ways.high):
        # a station or a share: its range is a scale of its own
        width = min(0.5 * (ways.high - ways.low), max(width, 0.5 * scale))
    return width


def _moving(
    at: Callable[[float], Float], ways: _Ways, here: Float, value: float, width: float
) -> list[int]:
    """Which of the stack the parameter moves: those it says, unless they stay bit by bit."""
    terms = len(here) - 5
    said = ["F" in ways.moves, "G" in ways.moves, *(["H" in ways.moves] * terms), True, True, True]
    apart = np.zeros(len(here), bool)
    for share in (0.37, 0.0037):
        for x in (max(ways.low, value - share * width), min(ways.high, value + share * width)):
            # it may be refused there
            with suppress(ValueError):
                there = at(float(x))
                apart |= np.any(there != here, axis=(1, 2))
                by = _size(there - here) - NEARBY_ULPS * EPS * _size(there, here)
                if np.any(by[~np.array(said)] > 0.0):
                    raise _Moves
    return [int(k) for k in np.flatnonzero(apart) if said[k]]


def _linear(
    f: Callable[[float], Float], ways: _Ways, value: float, width: float
) -> tuple[Float, Float]:
    """Slope from two values far apart; a look at the neighbourhood for what is not linear."""
    low, high = max(ways.low, -FAR), min(ways.high, FAR)
    # an end itself may be refused
    step = (high - low) * 2.0**-60
    low, high = (
        (low + step if low == ways.low else low),
        (high - step if high == ways.high else high),
    )
    first, last = f(low), f(high)
    found = (last - first) / (high - low)
    error = LINEAR_ULPS * EPS * _size(first, last) / (high - low)
    left, right = max(low, value - width), min(high, value + width)
    a, b, middle = f(left), f(right), f(0.5 * (left + right))
    near = NEARBY_ULPS * EPS * _size(a, b) / (right - left)
    if np.any(_size((b - a) / (right - left) - found) > near + error) or np.any(
        _size(middle - 0.5 * (a + b)) > near * (right - left)
    ):
        raise _NotLinear
    return found, error


def _size(*stacks: Float) -> Float:
    """Largest element of each matrix."""
    return np.max([np.abs(stack).max(axis=(1, 2)) for stack in stacks], axis=0)
