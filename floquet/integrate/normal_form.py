"""A periodic equation divided by its mass, in units that balance it: what the methods integrate."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import matrix_balance

from floquet.arrays import EPS, Float
from floquet.integrate.division import divided
from hill import Fourier, PeriodicEquation

Harmonic = tuple[int, bool]
"""Which of the frequencies, counted from 0, and whether it is a sine."""


Pair = tuple[Float, Float]
"""Of stiffness and damping, (n, n) each."""


@dataclass(frozen=True)
class Layout:
    """What a compiled CasADi function depends on.

    Attributes
    ----------
    n : int
        Rows of the matrices.
    first_order : bool
        Whether there is only x' = A x; `stiffness` then means A.
    harmonics : int
        How many different ones there are.
    stiffness, damping : tuple of Harmonic
        What pulsates.
    damped : bool
        Whether there is any damping.
    """

    n: int
    first_order: bool
    harmonics: int
    stiffness: tuple[Harmonic, ...]
    damping: tuple[Harmonic, ...]
    damped: bool

    @property
    def order(self) -> int:
        """Rows of the state."""
        return self.n if self.first_order else 2 * self.n


@dataclass(frozen=True, eq=False)
class NormalForm:
    """q'' + C q' + K q = 0, or x' = A x with `stiffness` for A.

    Attributes
    ----------
    layout : Layout
    Omega : float
    harmonics : tuple of int
        The frequencies, over Omega.
    stiffness, damping : (1 + terms, n, n) ndarray
        The mean, then what pulsates, in the order of the layout.
    rounded, data : Pair
        Bounds on what stiffness and damping are off at any time: by rounding, and by the
        equation's own `data_error`.
    units : (n,) ndarray
        Powers of two: the coordinate as given is this many times the one here.
    """

    layout: Layout
    Omega: float
    harmonics: tuple[int, ...]
    stiffness: Float
    damping: Float
    rounded: Pair
    data: Pair
    units: Float

    @property
    def period(self) -> float:
        """2 pi / Omega."""
        return 2.0 * np.pi / self.Omega

    @property
    def trace(self) -> float:
        """Of the mean of the first-order matrix: det Phi = exp(period trace), by Liouville."""
        return float(np.trace(self.stiffness[0] if self.layout.first_order else -self.damping[0]))

    @property
    def largest(self) -> Pair:
        """Bounds on the elements of stiffness and damping at any time, (n, n) each."""
        return np.sum(np.abs(self.stiffness), axis=0), np.sum(np.abs(self.damping), axis=0)

    def companion(self, pair: Pair, unit: float, *, change: bool = False) -> Float:
        """The first-order matrix of (q, unit q') over time in `unit`, of bounds on K and C.

        Of bounds on a `change` of them, q' stays the derivative of q.
        """
        stiffness, damping = pair
        if self.layout.first_order:
            return stiffness * unit
        n = self.layout.n
        top = np.hstack([np.zeros((n, n)), np.zeros((n, n)) if change else np.eye(n)])
        return np.vstack([top, np.hstack([stiffness * unit * unit, damping * unit])])

    def state_units(self, unit: float) -> Float:
        """A state as given is this many times the balanced one of (q, unit q')."""
        if self.layout.first_order:
            return self.units
        return np.concatenate([self.units, self.units / unit])


def normal_form(
    equation: PeriodicEquation, rounded: Float | float = 0.0, *, every: bool = False
) -> NormalForm:
    """Divide by the mass, to an ulp of each element, and balance by powers of two.

    Parameters
    ----------
    equation : PeriodicEquation
    rounded : (n, n) ndarray, optional
        What K is off already, at any time; the mass is the identity then.
    every : bool, optional
        Whether terms that are zero are kept.
    """
    first, second = (equation.A, None) if equation.A else (equation.K, equation.C)
    assert first is not None
    n = first.n
    harmonics = sorted({*first.harmonics, *(second.harmonics if second else ())})
    K, stiffness_terms = _stacked(first, harmonics, every)
    C, damping_terms = _stacked(second, harmonics, every) if second else (np.zeros((1, n, n)), ())
    off = equation.data_error * np.array([np.max(np.abs(K)), np.max(np.abs(C))])
    data = np.ones((2, n, n)) * off[:, None, None]
    lost = np.array([np.zeros((n, n)) + rounded, np.zeros((n, n))])
    if equation.M is not None and not np.array_equal(equation.M, np.eye(n)):
        K, K_lost = divided(equation.M, K)
        C, C_lost = divided(equation.M, C)
        lost += np.array([K_lost.sum(axis=0), C_lost.sum(axis=0)])
        data = np.abs(np.linalg.inv(equation.M)) @ data
    units = _balance(K, C)
    scale = units[None, :] / units[:, None]
    return NormalForm(
        layout=Layout(
            n=n,
            first_order=second is None,
            harmonics=len(harmonics),
            stiffness=stiffness_terms,
            damping=damping_terms,
            damped=second is not None and (every or bool(np.any(C))),
        ),
        Omega=equation.Omega,
        harmonics=tuple(harmonics),
        stiffness=K * scale,
        damping=C * scale,
        rounded=(lost[0] * scale, lost[1] * scale),
        data=(data[0] * scale, data[1] * scale),
        units=units,
    )


def _stacked(
    matrix: Fourier, harmonics: list[int], every: bool
) -> tuple[Float, tuple[Harmonic, ...]]:
    parts, terms = [matrix.mean], []
    for is_sine, given in ((False, matrix.cos), (True, matrix.sin)):
        for k, part in given.items():
            if every or np.any(part):
                parts.append(part)
                terms.append((harmonics.index(k), is_sine))
    return np.array(parts), tuple(terms)


def _balance(K: Float, C: Float) -> Float:
    """Powers of two that make rows and columns alike in size, of K and C together."""
    stiffness, damping = np.abs(K).sum(axis=0), np.abs(C).sum(axis=0)
    size = max(float(np.sqrt(np.max(stiffness))), float(np.max(damping)), 1e-300)
    together = stiffness / size / size + damping / size
    _, (scale, _) = matrix_balance(together + EPS, permute=False, separate=True)
    return np.asarray(scale, float)
