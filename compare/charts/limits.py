"""What can be charted: a point's equation, or one line that says why there is none."""

import math
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from hill import HillEquation, PeriodicEquation, Singular, checks
from hill.averaging import fastest_motion
from hill.system import FORCING, parameter_values, varied

Values = Mapping[str, float]
Equation = HillEquation | PeriodicEquation

MAX_DECAY = 200.0
"""eta/Omega: exp(-pi eta/Omega) stays above 1e-273."""

MAX_RADIANS = 3000.0
"""Of the fastest motion in a period; one evaluation then takes a tenth of a second, and a growth as
fast as that leaves the floats four times over."""


def checked(system: Any, values: Values, fixed: Values) -> Equation:
    """The equation at a point.

    Raises
    ------
    Singular
        There is none.
    ValueError
        It would take for ever, or leave the floats; the system breaks a promise.
    """
    forcing = dict(fixed) | {k: v for k, v in values.items() if k in FORCING}
    there = varied(system, {k: v for k, v in values.items() if k not in FORCING})
    where = ", ".join(f"{k} = {v:g}" for k, v in (values or forcing).items())
    Omega, eta = forcing["Omega"], forcing["eta"]
    checks.positive("Omega", Omega)
    if abs(eta) > MAX_DECAY * Omega:
        raise ValueError(
            f"{where}: eta/Omega = {eta / Omega:.3g} must be at most {MAX_DECAY:g}, or a "
            "period's decay leaves the floats"
        )
    model = own_equation(there, **forcing)
    if isinstance(model, HillEquation):
        with suppress(Singular):  # the other forcing's own misfortune
            _check_promise(there, model, forcing)
    if model.Omega != Omega:
        raise ValueError(
            f"Omega = {Omega:g}: the equation's own is {model.Omega:g}; it must be as asked, or "
            "T is read with the wrong one"
        )
    if not slow_enough(model):
        radians = model.period * fastest_motion(model)
        raise ValueError(
            f"{where}: the motion turns by {radians:.1e} radians a period, and "
            f"{MAX_RADIANS:g} at most can be charted"
        )
    return model


def slow_enough(model: Equation, sizes: tuple[float, float] | None = None) -> bool:
    """Whether the motion turns by no more than `MAX_RADIANS` a period.

    Parameters
    ----------
    model : HillEquation or PeriodicEquation
    sizes : (float, float), optional
        `largest_elements` of it, where they are known: of many equations with the same matrices.
    """
    if isinstance(model, HillEquation):
        F, G = sizes or largest_elements(model)
        # no eigenvalue is larger than n times the largest element
        if model.period * math.sqrt(model.n * (F + abs(model.gamma) * G)) <= MAX_RADIANS:
            return True
    return model.period * fastest_motion(model) <= MAX_RADIANS


def largest_elements(model: HillEquation) -> tuple[float, float]:
    """Of F and all H together, and of G."""
    with np.errstate(over="ignore"):
        constant = sum((np.max(np.abs(H)) for H in model.H), np.max(np.abs(model.F)))
    return float(constant), float(np.max(np.abs(model.G)))


def _check_promise(system: Any, model: HillEquation, forcing: Values) -> None:
    """Refuse a `depends_on_Omega` that is not kept, as far as one other forcing tells."""
    moves = getattr(system, "depends_on_Omega", None)
    if moves is None or model.H:
        return
    Omega, gamma, eta = (forcing[name] for name in FORCING)
    asked = {
        "Omega": Omega if moves else 1.25 * Omega,
        "gamma": 0.5 * gamma + 0.125,
        "eta": 0.5 * eta + 0.03125 * Omega,
    }
    other = own_equation(system, **asked)
    kept = _same(other, model, asked)
    own = model.damping - eta if np.ndim(model.eta) == 0 else 0.0
    if own and _same(other, model, asked | {"eta": asked["eta"] + own}):
        raise ValueError(
            f"{type(system).__name__}: adds damping of its own, {own:g}, to eta; leave it out and "
            "give it as the forcing's eta, or T is read with the wrong one"
        )
    if not kept:
        raise ValueError(
            f"{type(system).__name__}.depends_on_Omega = {moves}: promises F and G that do not "
            f"move with {'' if moves else 'Omega, '}gamma and eta and a forcing as asked for; "
            "leave it out, or make them so"
        )
    for p in (p for p in system.parameters if moves and p.smooth == "ratio"):
        half = 0.5 * parameter_values(system)[p.name]
        asked["Omega"] = 0.5 * Omega
        if half >= p.low and not _same(
            own_equation(varied(system, {p.name: half}), **asked), model, asked
        ):
            raise ValueError(
                f"parameter {p.name!r}: says smooth = 'ratio': F and G must then be the same where "
                "Omega over it is; leave it out, or make them so"
            )


def _same(other: Equation, model: HillEquation, forcing: Values) -> bool:
    """Whether the matrices are, and the forcing is as asked."""
    return (
        isinstance(other, HillEquation)
        and np.array_equal(other.F, model.F)
        and np.array_equal(other.G, model.G)
        and (other.Omega, other.gamma, other.eta) == tuple(forcing.values())
    )


def own_equation(system: Any, Omega: float, gamma: float, eta: float) -> Equation:
    """The system's own equation.

    Raises
    ------
    ValueError
        It is none.
    """
    found = system.equation(Omega, gamma, eta)
    if not isinstance(found, HillEquation | PeriodicEquation):
        raise ValueError(
            f"{type(system).__name__}.equation: must give a HillEquation or a PeriodicEquation, "
            f"gave a {type(found).__name__}"
        )
    return found
