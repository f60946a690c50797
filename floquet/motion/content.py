"""What a simulated history is made of, coordinates and Floquet modes, and how fast it grows."""

from dataclasses import dataclass, field

import numpy as np

from floquet.arrays import Complex, Float, frozen
from floquet.motion.history import Simulation
from floquet.motion.shapes import FloquetModes, floquet_modes

# Strobes over which a history is averaged; with fewer its growth is not told from its swing.
FEWEST_PERIODS = 8

# Of the trend, each of which leaves a small part of what it was off; and what is left of squares.
ROUNDS, LOWEST = 4, 600.0


# Shapes off by more may be any mixture of two. Of a free body, whose two are one, it is 1.2; of the
# report's rows 9e-10 at most.
TOLD_APART = 1e-3


@dataclass(frozen=True, eq=False)
class ModalContent:
    """What has a share in a history.

    Attributes
    ----------
    modes : FloquetModes
    amplitudes : (m,) complex ndarray
        At tau = 0: the history is the sum of amplitude exp(lambda tau) p(tau).
    coordinates : (n,) ndarray
        The share of each coordinate in the sum of squares of all samples, in its own units.
    shares : (m,) ndarray
        The share of each mode in the sum of squares of all modes, each taken alone: modes are not
        orthogonal, and where two are much alike both shares may be large that nearly cancel.
    last_shares : (m,) ndarray
        The same in the last period.
    """

    modes: FloquetModes = field(repr=False)
    amplitudes: Complex
    coordinates: Float
    shares: Float
    last_shares: Float


@dataclass(frozen=True)
class MeasuredGrowth:
    """How fast a history grows, by its own numbers.

    Attributes
    ----------
    T : float
        Twice the exponent, as the characteristic argument.
    error_estimate : float
        How far another way to average is from it, and what the bounds on the history allow. The
        growth of the leading mode is only seen where the history has little of others.
    """

    T: float
    error_estimate: float


def modal_content(result: Simulation, modes: FloquetModes | None = None) -> ModalContent:
    """The share of each coordinate, and of each Floquet mode, in a history.

    Parameters
    ----------
    result : Simulation
    modes : FloquetModes, optional
        Of its equation, if they are known already.

    Returns
    -------
    ModalContent

    Raises
    ------
    ValueError
        Multipliers meet so that the modes do not span all motions; a history that is at rest.
    """
    size = float(np.max(np.abs(result.q)))
    start = np.concatenate([result.q[0], result.v[0]])
    if not np.any(start):
        raise ValueError("result: is at rest, nothing has a share in it")
    found = floquet_modes(result.source) if modes is None else modes
    if not np.all(found.shape_error_estimate < TOLD_APART):
        raise ValueError("result: two multipliers of its equation meet, and so do their modes")
    amplitudes = np.linalg.solve(found.states.T, start.astype(complex))
    with np.errstate(under="ignore"):
        squares = np.mean((result.q / (size or 1.0)) ** 2, axis=0)
        whole = result.periods * result.source.period
        growth = 2.0 * found.exponents.real * whole
        log = 2.0 * np.log(np.maximum(np.abs(amplitudes), np.finfo(float).tiny))
        return ModalContent(
            modes=found,
            amplitudes=frozen(amplitudes),
            coordinates=frozen(squares / (np.sum(squares) or 1.0)),
            shares=frozen(_shared(log + _mean_of_exponential(growth))),
            last_shares=frozen(_shared(log + growth)),
        )


def measured_growth(result: Simulation) -> MeasuredGrowth:
    """How fast the state grows from period to period, by the history alone.

    The square of its size about the trend, averaged over the first half of the history and over the
    second with weights that leave swings out; velocities count in units of Omega.

    Parameters
    ----------
    result : Simulation

    Returns
    -------
    MeasuredGrowth

    Raises
    ------
    ValueError
        Fewer than 8 periods; a history that is at rest, or decays to nothing.
    """
    if result.periods < FEWEST_PERIODS:
        raise ValueError(
            f"result: has {result.periods} periods; growth is measured over {FEWEST_PERIODS} "
            "at least"
        )
    e, step = result.source, result.samples
    strobes = np.hstack([result.q[::step], result.v[::step] / e.Omega])
    largest = np.max(np.abs(strobes), axis=1)
    if not np.all(largest > 0.0):
        raise ValueError("result: is at rest, or decays to nothing; it has no growth to measure")
    # of the size beside the largest, so that no square overflows
    log = np.log(largest) + np.log(np.linalg.norm(strobes / largest[:, None], axis=1))
    a, b = (_slope(log, power) for power in (4, 8))
    errors = np.hstack([result.errors[::step], result.v_errors[::step] / e.Omega])
    unsure = float(np.max(np.max(errors, axis=1) / largest)) / (len(log) // 2)
    return MeasuredGrowth(2.0 * a / e.period, 2.0 * (abs(a - b) + unsure) / e.period)


def _slope(log: Float, power: int) -> float:
    """By how much a logarithm rises a step: its square's mean over both halves, about its trend.

    The square of a pair of modes swings as one cosine about its mean, its logarithm as many.
    """
    half = len(log) // 2
    steps, between = np.arange(len(log)), len(log) - half
    weights = np.sin(np.pi * (np.arange(half) + 0.5) / half) ** power
    first = np.average(log[:half], weights=weights)
    slope = (np.average(log[-half:], weights=weights) - first) / between
    for _ in range(ROUNDS):
        level = 2.0 * (log - slope * steps)
        squares = np.exp(np.maximum(level - np.max(level), -LOWEST))
        means = (np.average(x, weights=weights) for x in (squares[-half:], squares[:half]))
        slope += 0.5 * float(np.subtract(*np.log(list(means)))) / between
    return float(slope)


def _mean_of_exponential(x: Float) -> Float:
    """Ln of the mean of exp(x s), 0 < s < 1."""
    small = np.abs(x) < 1e-8
    safe = np.where(small, 1.0, x)
    rest = np.log(-np.expm1(-np.abs(safe)) / np.abs(safe))
    return np.where(small, 0.5 * x, np.maximum(x, 0.0) + rest)


def _shared(log: Float) -> Float:
    shares = np.exp(log - np.max(log))
    return np.asarray(shares / np.sum(shares))
