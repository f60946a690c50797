"""A simulated motion and everything that is told about it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet import (
    FloquetModes,
    MeasuredGrowth,
    ModalContent,
    Monodromy,
    Simulation,
    floquet_modes,
    measured_growth,
    modal_content,
    monodromy,
    simulate,
)
from hill import HillEquation, PeriodicEquation

Float = NDArray[np.floating[Any]]

MANY = 2000
"""Periods over which a motion that does not grow is followed."""

FEW, GROWTH = 20, 50.0
"""One that grows or decays so many times is followed until it has, so many periods at least."""

SAMPLES, A_TURN, MOST_SAMPLES = 40, 16, 200
"""In a period at least, for each turn of the fastest mode, and at most."""


@dataclass(frozen=True)
class Subject:
    """What is simulated, in words and numbers.

    Attributes
    ----------
    title : str
    names : tuple of str
        Of the coordinates; as many as are given, and then q1, q2, ...
    about : dict
        For the record in files.
    printed : str
        T as it was printed, of a row of a table; else empty.
    time, frequency : str
        Units of a vehicle; empty for pure numbers.
    in_time : bool
        Whether time is told in the system's own unit and frequencies in cycles.
    """

    title: str
    names: tuple[str, ...] = ()
    about: dict[str, Any] = field(default_factory=dict)
    printed: str = ""
    time: str = ""
    frequency: str = ""
    in_time: bool = False


@dataclass(frozen=True, eq=False)
class Followed:
    """A motion and what is known of its growth.

    Attributes
    ----------
    subject : Subject
    history : Simulation
    modes : FloquetModes
    known : Monodromy
    measured : MeasuredGrowth or None
        None over too few periods to tell.
    content : ModalContent or None
        None where modes cannot be told apart.
    began : str
        In what the motion was begun, in words.
    """

    subject: Subject
    history: Simulation
    modes: FloquetModes
    known: Monodromy
    measured: MeasuredGrowth | None
    content: ModalContent | None
    began: str

    @property
    def names(self) -> tuple[str, ...]:
        """Of the coordinates."""
        given, count = self.subject.names, self.history.q.shape[1]
        letter = "q" if self.history.v.shape[1] else "x"
        return given if len(given) == count else tuple(f"{letter}{i + 1}" for i in range(count))

    @property
    def log_envelope(self) -> Float:
        """Ln of exp(T tau/2) times what touches each coordinate from above, (k, n)."""
        h = self.history
        exponent = 0.5 * self.known.T * h.tau[:, None]
        with np.errstate(divide="ignore"):
            return np.asarray(np.max(np.log(np.abs(h.q)) - exponent, axis=0) + exponent)

    @property
    def envelope(self) -> Float:
        """The same itself, infinite where it is beyond a float."""
        with np.errstate(over="ignore", under="ignore"):
            return np.asarray(np.exp(self.log_envelope))

    @property
    def print_is_wrong(self) -> bool:
        """Whether a printed T says the opposite of the verdict."""
        if not self.subject.printed or self.known.verdict == "undecided":
            return False
        return (float(self.subject.printed) > 0.0) != (self.known.verdict == "unstable")

    def largest(self, first: int, last: int) -> Float:
        """Of each coordinate over the periods from `first` to before `last`, (n,)."""
        h = self.history
        return np.asarray(np.max(np.abs(h.q[first * h.samples : last * h.samples + 1]), axis=0))


def follow(
    equation: HillEquation | PeriodicEquation,
    subject: Subject,
    *,
    q0: Sequence[float] | None = None,
    v0: Sequence[float] | None = None,
    periods: int | None = None,
    samples: int | None = None,
    long: bool = False,
) -> Followed:
    """Simulate, by default from the fastest growing mode, or from all modes where none grows.

    Parameters
    ----------
    equation : HillEquation or PeriodicEquation
    subject : Subject
    q0, v0 : sequence of float, optional
        The state to begin with; one without the other is at rest in the other.
    periods : int, optional
        2,000 or, but for `long`, fewer where the motion has grown or decayed 50 times by then.
    samples : int, optional
        40, or 16 for each turn of the fastest mode up to 200.
    long : bool, optional

    Raises
    ------
    ValueError, OverflowError
        As `simulate`, `floquet_modes` and `monodromy`.
    """
    known, modes = monodromy(equation), floquet_modes(equation)
    n, second = modes.shapes.shape[2], modes.states.shape[1] > modes.shapes.shape[2]
    if q0 is not None or v0 is not None:
        began = "the given state"
        start: Any = (
            np.zeros(n) if q0 is None else q0,
            (np.zeros(n) if second else None) if v0 is None else v0,
        )
    elif known.verdict == "unstable":
        began, start = "the fastest growing mode", modes.start(0)
    else:
        began, start = "all modes alike", modes.start()
    if periods is None:
        periods = _periods(known, equation.period, long=long)
    if samples is None:
        turns = float(np.max(modes.frequencies)) / equation.Omega
        samples = min(max(SAMPLES, 10 * math.ceil(A_TURN * turns / 10)), MOST_SAMPLES)
    history = simulate(equation, *start, periods=periods, samples=samples)
    return Followed(
        subject=subject,
        history=history,
        modes=modes,
        known=known,
        measured=_measured(history),
        content=_content(history, modes),
        began=began,
    )


def _periods(known: Monodromy, period: float, *, long: bool) -> int:
    rate = 0.5 * abs(known.T) * period
    if long or MANY * rate < math.log(GROWTH):
        return MANY
    return max(math.ceil(math.log(GROWTH) / rate), FEW)


def _measured(history: Simulation) -> MeasuredGrowth | None:
    try:
        return measured_growth(history)
    except ValueError:
        return None


def _content(history: Simulation, modes: FloquetModes) -> ModalContent | None:
    try:
        return modal_content(history, modes)
    except ValueError:
        return None
