"""Derivatives of T and z, held against those of the arbiter."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from benchmarks.honesty.judge import EPS, Judged, Measured, one_number
from benchmarks.honesty.slopes import Slopes, slopes
from benchmarks.honesty.systems import CLASSES, GROUP, members
from benchmarks.honesty.trial import caught
from floquet import sensitivities
from floquet.enclosure.series import TooWide
from floquet.sensitivity.equation import Derivatives, Sensitivities
from hill import HillEquation

ROUTES = ("floquet",)
NAMES = tuple(CLASSES)
NUMBERS = ("dT", "dz")

# The remark is on derivatives of T; one of z stands beside its error, and above this share of the
# number the error itself is the word.
POOR = 1e-6


def trial(kind: str, seed: int, group: int, *, shrink: float = 1.0) -> list[Judged]:
    """Judge the derivatives of one group of systems, each in a direction of its own.

    Parameters
    ----------
    kind, seed, group
        As for `systems.members`.
    shrink : float, optional
        Multiplies every bound: below 1 the trial must find fault.
    """
    found = []
    rng = np.random.default_rng([seed, group])
    for place, equation in enumerate(members(kind, seed, group)):
        direction = drawn(equation, rng)
        answer = caught(lambda e=equation: sensitivities(e))  # type: ignore[misc]
        about: dict[str, Any] = {
            "kind": kind,
            "number": GROUP * group + place,
            "n": equation.n,
            "route": "floquet",
        }
        if isinstance(answer.found, Sensitivities):
            try:
                known = slopes(equation, direction)
            except TooWide:
                found.append(Judged(**about, status="answered", beyond=True))
                continue
            found.append(judged(about, answer.found, direction, known, shrink, answer.wrong))
        else:
            status = "refused" if answer.refused else "failed"
            found.append(Judged(**about, status=status, violations=answer.wrong))
    return found


def drawn(equation: HillEquation, rng: np.random.Generator) -> dict[str, Any]:
    """A direction in which everything moves, up or down, by about its own size."""
    found: dict[str, Any] = {}
    for name in ("Omega", "gamma", "eta", "F", "G", "H"):
        value = np.asarray(vars(equation)[name], float)
        if value.size:
            size = np.maximum(np.abs(value), 1e-3 * np.max(np.abs(value), initial=0.0))
            weight = rng.choice([-1.0, 1.0], value.shape) * 2.0 ** np.round(np.log2(size + 1e-300))
            found[name] = weight if value.ndim else float(weight)
    return found


def along(derivatives: Derivatives, direction: Mapping[str, Any]) -> Any:
    """Derivative in a direction; z stays as the leading axis."""
    total: Any = 0.0
    for name, weight in direction.items():
        product = vars(derivatives)[name] * np.asarray(weight)
        total = total + product.sum(axis=tuple(range(product.ndim - np.ndim(weight), product.ndim)))
    return total


def judged(
    about: Mapping[str, Any],
    answer: Sensitivities,
    direction: Mapping[str, Any],
    known: Slopes,
    shrink: float,
    wrong: dict[str, str],
) -> Judged:
    """Hold both derivatives against the arbiter's; of those of z the worst counts."""
    sizes = {name: np.abs(weight) for name, weight in direction.items()}
    measured: dict[str, Measured] = {}
    unjudged = []
    dT, dT_error = float(along(answer.dT, direction)), float(along(answer.dT_error, sizes))
    dz, dz_error = along(answer.dz, direction), along(answer.dz_error, sizes)
    if not all(np.all(np.isfinite(x)) for x in (dT, dT_error, dz, dz_error)):
        wrong["NaN"] = f"dT = {dT} +- {dT_error}"
        return Judged(**about, status="answered", violations=wrong)
    if known.dT is None:
        unjudged.append("dT")
    else:
        size = float(along(_moduli(answer.dT), sizes))
        error = shrink * (dT_error + 4.0 * EPS * size)  # the sum over the direction is rounded too
        told = bool(answer.remark)
        measured["dT"] = one_number("dT", dT, known.dT, error, size, told, wrong)
    each = []
    for k, z in enumerate(answer.z):
        nearest = min(range(len(known.z)), key=lambda j: abs(known.z[j] - z))
        truth = known.dz[nearest]
        if truth is None:
            unjudged.append("dz")
            continue
        size = float(along(_moduli(answer.dz), sizes)[k])
        error = shrink * (dz_error[k] + 4.0 * EPS * size)
        told = dz_error[k] > POOR * size
        each.append(one_number("dz", complex(dz[k]), truth, error, size, told, wrong))
    if each:
        measured["dz"] = max(each, key=lambda m: m.ratio)
    return Judged(
        **about,
        status="answered",
        violations=wrong,
        measured=measured,
        unjudged=tuple(dict.fromkeys(unjudged)),
    )


def _moduli(derivatives: Derivatives) -> Derivatives:
    return Derivatives(**{name: np.abs(value) for name, value in vars(derivatives).items()})
