"""An integration by Taylor steps run backwards: what its end owes to every parameter.

CasADi differentiates the step in reverse mode and runs through the fold from its end. One sweep
gives the gradient of one number made of the fundamental matrix with respect to everything.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil
from typing import Any

import numpy as np

from floquet.arrays import Float
from floquet.integrate.ode import Parameters, Shape, terms
from floquet.integrate.step_length import longest_step
from floquet.integrate.taylor import MAX_FOLD_STEPS, Taylor, folded, rounded_up


@dataclass(frozen=True, eq=False)
class Gradient:
    """Derivatives of one number with respect to the parameters and to the end time.

    Attributes
    ----------
    parameters : Parameters
        Arrays shaped like the parameters.
    time : float
        With respect to the time integrated over, the number of steps kept.
    """

    parameters: Parameters
    time: float


@dataclass(frozen=True, eq=False)
class Tape:
    """An integration from the identity, with what is needed to run it backwards.

    Attributes
    ----------
    p : Parameters
    size : Shape
    time : float
        How far it goes.
    order, steps, folds : int
        Taylor order; steps in a fold; folds.
    states : tuple of (2n, 2n) float ndarray
        The fundamental matrix before each fold, and at the end.
    """

    p: Parameters
    size: Shape
    time: float
    order: int
    steps: int
    folds: int
    states: tuple[Float, ...]

    @property
    def end(self) -> Float:
        """The fundamental matrix at `time`."""
        return self.states[-1]

    def pull(self, seed: Float) -> tuple[Gradient, Gradient]:
        """Gradient of ``sum(seed * end)``, and the sum of the moduli of its terms.

        The second is what the rounding of the first is measured by: each step adds a term.
        """
        function = _reverse(self.size, self.order, self.steps)
        totals = [np.zeros((1, 1)), *(np.zeros(np.atleast_2d(value).shape) for value in self.p)]
        moduli = [np.zeros_like(total) for total in totals]
        back = seed
        for k in reversed(range(self.folds)):
            inputs = _inputs(self, k)
            back, tau, h, *found = map(
                np.asarray, function(self.states[k], *inputs, self.states[k + 1], back)
            )
            share = np.vstack([tau * inputs[0], h * inputs[1]]) / self.time
            totals[0] = totals[0] + share.sum()
            moduli[0] = moduli[0] + np.abs(share).sum()
            for i, wide in enumerate(found, start=1):
                each = wide.reshape(len(wide), self.steps, -1)
                totals[i] = totals[i] + each.sum(axis=1)
                moduli[i] = moduli[i] + np.abs(each).sum(axis=1)
        return _gradient(totals), _gradient(moduli)


def record(method: Taylor, p: Parameters, size: Shape, time: float) -> Tape:
    """Integrate over `time` with the steps that `method` itself takes."""
    needed = ceil(time / longest_step(terms(p, size), p.C, method.order, method.tolerance))
    steps = rounded_up(min(needed, MAX_FOLD_STEPS))
    empty = Tape(p, size, time, method.order, steps, ceil(needed / steps), ())
    fold = folded(size, method.order, steps)
    states = [np.eye(2 * size.n)]
    for k in range(empty.folds):
        states.append(np.asarray(fold(states[-1], *_inputs(empty, k))))
    return Tape(p, size, time, method.order, steps, empty.folds, tuple(states))


@lru_cache(maxsize=64)
def _reverse(size: Shape, order: int, steps: int) -> Any:
    # CasADi itself forgets a derivative that nobody holds
    return folded(size, order, steps).reverse(1)


def _inputs(t: Tape, k: int) -> list[Float]:
    """Starts, lengths and parameters of the steps of fold k, side by side."""
    h = t.time / (t.folds * t.steps)
    start = h * np.arange(k * t.steps, (k + 1) * t.steps)[None, :]
    return [start, np.full((1, t.steps), h), *(np.tile(value, (1, t.steps)) for value in t.p)]


def _gradient(found: list[Any]) -> Gradient:
    F, G, H, C, *numbers = found[1:]
    return Gradient(
        Parameters(F, G, H, C, *(float(x[0, 0]) for x in numbers)), float(found[0][0, 0])
    )
