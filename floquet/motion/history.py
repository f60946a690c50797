"""The motion from given initial conditions, sample by sample, over any number of periods."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from floquet.arrays import EPS, Complex, Float, frozen
from floquet.motion.samples import SampledPeriod, sampled_period
from floquet.motion.strobes import UNDERFLOW, Strobes, strobes
from hill import HillEquation, PeriodicEquation, checks

Equation = HillEquation | PeriodicEquation

MAX_PERIODS = 100_000_000
MAX_SAMPLES = 10_000
MAX_NUMBERS = 50_000_000
"""Values in a history: it takes some 40 bytes for each."""


def is_second_order(equation: Equation) -> bool:
    """Whether the state has velocities."""
    return isinstance(equation, HillEquation) or equation.A is None


@dataclass(frozen=True, eq=False)
class Simulation:
    """A time history, every value with a bound on its error.

    Attributes
    ----------
    source : HillEquation or PeriodicEquation
        What was solved.
    tau : (k,) ndarray
        Dimensionless time, in the units of 1/Omega; k = periods samples + 1. What is bounded is the
        motion at the exact times, whole parts of the period 2 pi/Omega, of which these are rounded.
    q, v : (k, n) ndarray
        Coordinates and their derivatives q'. Of an equation of first order q is x, and v has no
        columns.
    errors, v_errors : (k, n) ndarray
        Bounds on the absolute errors of q and v, for the equation's numbers and the initial
        conditions as they are given; infinite where nothing is known.
    periods, samples : int
        How many periods there are, and samples in each.
    stopped : str
        Why there are fewer periods than were asked for, in a sentence; empty where there are not.
    """

    source: Equation = field(repr=False)
    tau: Float
    q: Float
    v: Float
    errors: Float
    v_errors: Float
    periods: int
    samples: int
    stopped: str

    @property
    def error(self) -> Float:
        """Bound on the error of every coordinate at each sample, (k,): the largest of `errors`."""
        return np.asarray(np.max(self.errors, axis=1))


def simulate(
    equation: Equation,
    q0: ArrayLike,
    v0: ArrayLike | None = None,
    *,
    periods: int = 50,
    samples: int = 40,
) -> Simulation:
    """Follow the motion from initial conditions.

    One period is integrated, by Taylor steps from each sample to the next and checked as
    `monodromy` is; whole periods are powers of the monodromy matrix. What one period is off is
    carried through these powers in a basis of Floquet modes, so the bounds grow with the number of
    periods and with the motion, and no faster. The history stops where it is beyond a float.

    Parameters
    ----------
    equation : HillEquation or PeriodicEquation
    q0 : (n,) array_like
        Coordinates at tau = 0; x of an equation of first order.
    v0 : (n,) array_like, optional
        Their derivatives; an equation of first order has none.
    periods : int, optional
    samples : int, optional
        In each period, equally spaced; 1 gives the state once a period, of a million periods too.

    Returns
    -------
    Simulation

    Raises
    ------
    ValueError
        Initial conditions of another shape, or not finite; a number of periods or samples below 1,
        or beyond what can be held.
    OverflowError
        The growth within the first period is beyond a float.

    Examples
    --------
    >>> s = simulate(equation, q0=[0.01, 0.0], v0=[0.0, 0.0], periods=200)
    >>> s.q.shape, s.error.max() < 1e-10
    """
    if not isinstance(equation, HillEquation | PeriodicEquation):
        raise ValueError(
            f"equation: is of type {type(equation).__name__}; "
            "must be a HillEquation or a PeriodicEquation"
        )
    x0 = _state(equation, q0, v0)
    periods = checks.count("periods", periods, least=1, most=MAX_PERIODS)
    samples = checks.count("samples", samples, least=1, most=MAX_SAMPLES)
    if periods * samples * len(x0) > MAX_NUMBERS:
        raise ValueError(
            f"periods = {periods}, samples = {samples}: a history of {len(x0)} values a sample "
            f"would have more than {MAX_NUMBERS:,} numbers; take fewer of either"
        )
    # by a power of two nothing is rounded
    largest = float(np.max(np.abs(x0)))
    unit = 2.0 ** math.frexp(largest)[1] if largest else 1.0
    states, errors = _states(equation, x0 / unit, periods, samples)
    with np.errstate(over="ignore"):
        states, errors = states * unit, errors * unit
    finite = np.all(np.isfinite(states), axis=1)
    held = (len(states) if np.all(finite) else int(np.argmin(finite))) - 1
    whole = held // samples
    if whole < 1:
        raise OverflowError("q0, v0: the motion is beyond what a float can hold within one period")
    states[0], errors[0] = x0, 0.0
    states, errors = (frozen(x[: whole * samples + 1]) for x in (states, errors))
    n = states.shape[1] // 2 if is_second_order(equation) else states.shape[1]
    return Simulation(
        source=equation,
        tau=frozen(equation.period / samples * np.arange(len(states))),
        q=states[:, :n],
        v=states[:, n:],
        errors=errors[:, :n],
        v_errors=errors[:, n:],
        periods=whole,
        samples=samples,
        stopped=_why(whole, periods),
    )


def _states(equation: Equation, x0: Float, periods: int, samples: int) -> tuple[Float, Float]:
    """States at all samples, whole periods of them, and bounds on their errors."""
    one = sampled_period(equation, samples)
    s = strobes(*_monodromy(equation, one), x0, periods)
    m, whole = len(x0), len(s.y) - 1
    found, unsure = np.empty((2, whole * samples + 1, m))
    start, start_error = _between(s, np.eye(m), np.zeros((m, m)))
    found[::samples], unsure[::samples] = start, start_error
    for j in range(1, samples):
        # of the last strobe only itself
        own = Strobes(s.X, s.y[:-1], s.error[:-1])
        x, e = _between(own, one.matrices[j], one.errors[j])
        found[j::samples], unsure[j::samples] = x, e
    return found, unsure


def _monodromy(equation: Equation, one: SampledPeriod) -> tuple[Float, Float]:
    """After a whole period, and its error: every sample adds rounding, and one step need not."""
    whole = sampled_period(equation, 1)
    best = min((one, whole), key=lambda p: float(np.max(p.errors[-1])))
    return best.matrices[-1], best.errors[-1]


def _between(s: Strobes, Phi: Float, error: Float) -> tuple[Float, Float]:
    """The states so long after the strobes: Phi times them."""
    ulps = 4.0 * (len(Phi) + 2) * EPS
    size = np.abs(s.X)
    Z: Complex = Phi @ s.X
    with np.errstate(over="ignore", invalid="ignore"):
        x = (s.y @ Z.T).real
        rounding = ulps * (np.abs(Phi) @ size + np.abs(Z))
        e = s.error @ (np.abs(Z) + error @ size + rounding).T + np.abs(s.y) @ rounding.T
        e += (np.abs((s.y @ s.X.T).real) + ulps * np.abs(s.y) @ size.T) @ error.T
    return x, np.where(np.isnan(e), np.inf, 1.01 * e + UNDERFLOW)


def _state(equation: Equation, q0: ArrayLike, v0: ArrayLike | None) -> Float:
    if isinstance(equation, PeriodicEquation) and equation.A is not None:
        if v0 is not None:
            raise ValueError("v0: an equation of first order has no velocities; leave it out")
        return _vector("q0", q0, equation.order)
    n = equation.n if isinstance(equation, HillEquation) else equation.order // 2
    if v0 is None:
        raise ValueError(f"v0: has no value; an equation of second order needs {n} velocities")
    return np.concatenate([_vector("q0", q0, n), _vector("v0", v0, n)])


def _vector(name: str, value: ArrayLike, n: int) -> Float:
    try:
        raw = np.asarray(value)
        if np.iscomplexobj(raw) or raw.dtype == bool or np.ma.is_masked(value):
            raise TypeError
        vector = np.array(raw, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be a vector of real numbers") from None
    if vector.shape != (n,):
        raise ValueError(f"{name} has shape {vector.shape}: must be ({n},)")
    if not np.all(np.isfinite(vector)):
        i = int(np.argmin(np.isfinite(vector)))
        raise ValueError(f"{name}[{i}] = {vector[i]}: every element must be finite")
    return vector


def _why(whole: int, periods: int) -> str:
    if whole == periods:
        return ""
    return f"stopped after {whole} of {periods} periods: the motion exceeds what a float can hold"
