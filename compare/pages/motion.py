"""The motion of a system over many periods, as pages show it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet import simulate
from hill import HillEquation

Float = NDArray[np.floating[Any]]

PERIODS = 200
SHOWN = 4
"""Periods of which the history is drawn, sample by sample."""

SAMPLES = 64
"""A period. Of the tables' rows the fastest frequency turns 6.7 times in one (T1-01), 9 samples a
turn: what lies between two of them is larger by 1/16 at most."""


MOST_DRAWN = 6
"""Coordinates that are drawn, the largest ones: as many as colours can be told apart."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Coordinates in time, from 1 each and at rest.

    Attributes
    ----------
    tau : (k,) ndarray
    q : (k, n) ndarray
        Of the first periods, `shown` of them.
    period : float
    largest : (periods, n) ndarray
        Of each coordinate's modulus in each period, among the samples.
    known_to : float
        Bound on the error of every sample, over the largest in its period.
    T : float
        The characteristic argument, for comparison.
    names : tuple of str
        Of the coordinates that are drawn, `MOST_DRAWN` of them at most.
    of : int
        How many there are.
    stopped : str
        Why there are fewer periods than were asked for; empty where there are not.
    """

    tau: Float
    q: Float
    period: float
    largest: Float
    known_to: float
    T: float
    names: tuple[str, ...]
    of: int
    stopped: str = ""

    @property
    def shown(self) -> int:
        """Periods whose history is drawn."""
        return round(float(self.tau[-1]) / self.period)


def let_go(equation: Any, T: float, names: tuple[str, ...] = ()) -> Motion | str:
    """Let every coordinate go at 1, from rest; or in words why there is no motion to be shown.

    Parameters
    ----------
    equation : HillEquation or PeriodicEquation
    T : float
    names : tuple of str, optional
        Of the coordinates; q_1, q_2, ... without.
    """
    first_order = getattr(equation, "A", None) is not None
    n = equation.n if isinstance(equation, HillEquation) else (equation.A or equation.K).n
    try:
        s = simulate(
            equation,
            np.ones(n),
            None if first_order else np.zeros(n),
            periods=PERIODS,
            samples=SAMPLES,
        )
    except (OverflowError, ValueError) as why:
        return f"No motion is shown: {why}."
    blocks = (s.periods, s.samples, -1)
    largest = np.abs(s.q[1:]).reshape(blocks).max(axis=1)
    drawn = np.sort(np.argsort(-np.max(largest, axis=0), kind="stable")[:MOST_DRAWN])
    own = names or tuple(f"{'x' if first_order else 'q'}_{k}" for k in range(1, n + 1))
    errors = s.errors[1:].reshape(blocks).max(axis=(1, 2))
    shown = min(SHOWN, s.periods) * s.samples + 1
    return Motion(
        tau=s.tau[:shown],
        q=s.q[:shown, drawn],
        period=equation.period,
        largest=largest[:, drawn],
        known_to=float(np.max(errors / np.max(largest, axis=1))),
        T=T,
        names=tuple(own[k] for k in drawn),
        of=n,
        stopped=s.stopped,
    )
