"""Floquet modes: what an exponent's motion looks like, and how often it turns in a period.

A solution exp(lambda tau) p(tau), p of the equation's period, is the same for lambda + i k Omega
and exp(-i k Omega tau) p, of any whole k. Which of them is named is a matter of sight: here the one
whose p has the most of its weight in its mean, so that its frequency is the one that is seen.
"""

from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil

import numpy as np
from scipy.optimize import linear_sum_assignment

from floquet.arrays import EPS, Complex, Float, frozen
from floquet.general.mode_bounds import NearlyDiagonal, nearly_diagonal
from floquet.general.modes import modal_bases
from floquet.integrate.normal_form import NormalForm
from floquet.integrate.parts_taylor import terms
from floquet.integrate.step_length import fastest_rate
from floquet.motion.history import MAX_SAMPLES, Equation, is_second_order
from floquet.motion.samples import parts_of_period
from floquet.period import monodromy
from hill import checks

SAMPLES = 64

# For each turn that anything makes in a period, so that no harmonic is taken for another.
SAMPLES_A_TURN = 4

# Weights of two harmonics that symmetry makes alike differ by rounding.
ALIKE = 1e-9


@dataclass(frozen=True, eq=False)
class FloquetModes:
    r"""The modes of a periodic equation, :math:`q = e^{\lambda \tau} p(\tau)`.

    By descending growth, then by ascending frequency. Of a complex pair both are there, and their
    shapes are each other's conjugates.

    Attributes
    ----------
    source : HillEquation or PeriodicEquation
        What was solved.
    tau : (k,) ndarray
        Equally spaced over one period, its end left out.
    exponents : (m,) complex ndarray
        lambda: growth in units of Omega, and the frequency of the harmonic with the most weight.
    exponent_errors : (m,) ndarray
        Bounds on their errors, as those of `monodromy`.
    multipliers : (m,) complex ndarray
        exp(lambda period).
    branches : (m,) int ndarray
        How many times i Omega is in lambda beyond the principal logarithm of the multiplier.
    harmonic_weights : (m,) ndarray
        The share of the harmonic with the most weight; where it is near 1/2 or below, others are
        nearly as good a name for the frequency.
    shapes : (m, k, n) complex ndarray
        p of the coordinates; of an equation of first order of x. The mean of the sum of `|p|^2` is
        1, and the largest element of its mean over the period is real and positive.
    states : (m, m) complex ndarray
        A row a mode: (p, p' + lambda p) at tau = 0, the initial conditions of its motion.
    participation : (m, n) ndarray
        The share of each coordinate in the mean of the sum of `|p|^2`, in the coordinates' own
        units.
    shape_error_estimate : (m,) ndarray
        An estimate, to first order, of what the shapes are off over their size; infinite where
        multipliers meet, whose shapes cannot be told apart.
    """

    source: Equation = field(repr=False)
    tau: Float
    exponents: Complex
    exponent_errors: Float
    multipliers: Complex
    branches: Float
    harmonic_weights: Float
    shapes: Complex
    states: Complex
    participation: Float
    shape_error_estimate: Float

    @property
    def frequencies(self) -> Float:
        """Moduli of the imaginary parts of the exponents, (m,), in units of Omega."""
        return np.abs(self.exponents.imag)

    def start(self, mode: int | None = None) -> tuple[Float, Float | None]:
        """Real initial conditions of a motion in one mode and its conjugate, or in all alike.

        Parameters
        ----------
        mode : int, optional
            Counted from 0, the fastest growing first; all of them by default.

        Returns
        -------
        q0, v0 : (n,) ndarray
            As `simulate` takes them; v0 is None for an equation of first order.

        Raises
        ------
        ValueError
            There is no such mode.
        """
        n, count = self.shapes.shape[2], len(self.exponents)
        if mode is None:
            # a pair's conjugate is in its real part already
            state = np.sum(self.states[self.exponents.imag >= 0.0].real, axis=0)
        else:
            mode = checks.count("mode", mode, least=0, most=count - 1)
            state = self.states[mode].real
        return state[:n], state[n:] if is_second_order(self.source) else None


def floquet_modes(equation: Equation, *, samples: int = SAMPLES) -> FloquetModes:
    """The modes of an equation: exponents with their frequencies, shapes, participation.

    They are found in the parts of the period without multiplying these out, so that shapes of what
    decays by many powers of ten are known too; the exponents are those of `monodromy`.

    Parameters
    ----------
    equation : HillEquation or PeriodicEquation
    samples : int, optional
        Of the shapes, at least; there are more where the motion turns fast.

    Returns
    -------
    FloquetModes

    Raises
    ------
    ValueError
        `samples` out of range; a motion that turns too often in a period to tell its harmonics.
    OverflowError
        The growth within one period is beyond a float.
    """
    samples = checks.count("samples", samples, least=1, most=MAX_SAMPLES)
    known = monodromy(equation)
    parts = parts_of_period(equation, lambda form: _count(samples, form))
    bases, logs = modal_bases(parts.matrices)
    count, n = len(bases), known.matrix.shape[0] // (2 if is_second_order(equation) else 1)
    near = nearly_diagonal(parts.matrices, parts.errors, bases, logs)
    estimate = _estimate(near) if near is not None else np.full(len(logs), np.inf)
    # after a whole period they are where they began; columns to rows
    bases = np.roll(parts.units[:, None] * bases, 1, axis=0).transpose(2, 0, 1)
    own = _own(logs, known.exponents * equation.period)
    logs, bases, estimate = logs[own], bases[own], estimate[own]
    q = bases[:, :, :n]
    harmonics = np.fft.fft(q, axis=1) / count
    branch, weights = _named(harmonics, logs.imag / (2.0 * np.pi))
    rows = np.arange(len(logs))
    mean = harmonics[rows, branch]
    largest = mean[rows, np.argmax(np.abs(mean), axis=1)]
    size = np.sqrt(np.mean(np.sum(np.abs(q) ** 2, axis=2), axis=1))
    bases = bases * (np.abs(largest) / largest / size)[:, None, None]
    phase = np.exp(-2j * np.pi / count * np.outer(branch, np.arange(count)))
    shapes = bases[:, :, :n] * phase[:, :, None]
    # what monodromy calls the logarithm may be a whole turn from what was found here
    turns = np.round((logs - known.exponents * equation.period).imag / (2.0 * np.pi)).astype(int)
    exponents = known.exponents + 1j * equation.Omega * (branch + turns)
    order = _order(exponents, known.exponent_errors)
    return FloquetModes(
        source=equation,
        tau=frozen(equation.period / count * np.arange(count)),
        exponents=frozen(exponents[order]),
        exponent_errors=frozen(known.exponent_errors[order]),
        multipliers=frozen(known.multipliers[order]),
        branches=frozen((branch + turns)[order]),
        harmonic_weights=frozen(weights[order]),
        shapes=frozen(shapes[order]),
        states=frozen(bases[order, 0]),
        participation=frozen(np.mean(np.abs(shapes[order]) ** 2, axis=1)),
        shape_error_estimate=frozen(estimate[order]),
    )


def _count(samples: int, form: NormalForm) -> int:
    """A multiple of the samples in which the fastest motion is told from all others."""
    radians = form.period * fastest_rate(*terms(form))
    needed = SAMPLES_A_TURN * radians / (2.0 * np.pi)
    if not needed <= MAX_SAMPLES:
        raise ValueError(
            f"equation: its motion may turn by {radians:.3g} radians a period, more than "
            f"{MAX_SAMPLES:,} samples tell; modes need a larger Omega"
        )
    return samples * max(ceil(needed / samples), 1)


def _order(exponents: Complex, errors: Float) -> list[int]:
    """By descending growth; of growth that may be the same the lowest frequency first, then -."""
    order = np.argsort(-exponents.real, kind="stable")
    group, groups = 0, np.zeros(len(order), int)
    for i, (a, b) in enumerate(pairwise(order), start=1):
        group += bool(exponents[a].real - exponents[b].real > errors[a] + errors[b])
        groups[i] = group
    # to so many digits a pair has the same frequency
    digits = np.array([float(f"{abs(z.imag):.9g}") for z in exponents[order]])
    signs = (exponents[order].imag < 0.0).astype(int)
    return list(order[np.lexsort((signs, digits, groups))])


def _own(logs: Complex, known: Complex) -> list[int]:
    """Which of the modes found belongs to each exponent."""
    apart = logs[None, :] - known[:, None]
    turn = 2.0 * np.pi
    distance = np.hypot(apart.real, apart.imag - turn * np.round(apart.imag / turn))
    # what has underflowed may be as far as it likes
    distance = np.where(np.isfinite(distance), distance, 1e300)
    return list(linear_sum_assignment(distance)[1])


def _named(harmonics: Complex, frequencies: Float) -> tuple[Float, Float]:
    """The harmonic with the most weight; of those alike that of the highest frequency, then of +.

    So a pair's names are each other's too.
    """
    m, count = harmonics.shape[:2]
    weights = np.sum(np.abs(harmonics) ** 2, axis=2)
    weights /= np.sum(weights, axis=1)[:, None]
    whole = np.fft.fftfreq(count, 1.0 / count).round().astype(int)
    most = np.max(weights, axis=1)
    branch = np.empty(m, int)
    for i in range(m):
        alike = whole[weights[i] >= (1.0 - ALIKE) * most[i]]
        turns = np.round(frequencies[i] + alike, 9)
        branch[i] = alike[np.lexsort((turns, np.abs(turns)))[-1]]
    return branch, most


def _estimate(near: NearlyDiagonal) -> Float:
    """What the bounds on the factors do to each mode, over its size, if nothing adds up worse."""
    size = np.abs(near.d)
    moved = np.sum(near.off / size[:, None, :], axis=0)
    apart = np.abs(np.expm1(near.value[:, None] - near.value[None, :]))
    reach = np.minimum(apart, 1.0 + 1.0 / EPS)
    np.fill_diagonal(moved, 0.0)
    np.fill_diagonal(reach, 1.0)
    with np.errstate(divide="ignore"):
        return np.asarray(np.sum(moved / reach, axis=0))
