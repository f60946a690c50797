"""Which resonances lie within a range, and which of them to look at closely."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from compare.vehicle.near import Near
from hill.averaging import Resonance, first_order
from hill.errors import Singular
from hill.oscillations.coupling import Coupled, Guess
from hill.oscillations.steady import Steady

# Growth, over the exponent, of an oscillation that steady thrust alone makes unstable.
GROWS = 1e-9

# Forcing frequencies at which the pulsating matrices are made for a first guess.
SAMPLES = 24


@dataclass(frozen=True)
class Candidate:
    """A resonance, and what averaging says of it.

    Attributes
    ----------
    resonance : Resonance
    Omega : float
    guess : Guess
    """

    resonance: Resonance
    Omega: float
    guess: Guess


def candidates(
    near: Near, names: tuple[str, ...], orders: int, low: float, high: float
) -> list[Candidate]:
    """Every resonance of the orders up to one, between two Omega, the most dangerous first.

    Those that nothing couples are left out, and those of oscillations that grow by themselves. The
    guesses take the pulsating matrices at the nearest of a few Omega.

    Parameters
    ----------
    near : Near
        The equation, of any resonance.
    names : tuple of str
        Of the oscillations, ascending.
    orders : int
    low, high : float
    """
    alone = near.alone
    count = len(alone.frequencies)
    found = []
    for first in first_order(count, names[:count]):
        for order in range(1, orders + 1):
            resonance = replace(first, order=order)
            Omega = resonance.Omega(alone.frequencies + 0j)
            exponents = [alone.exponents[alone.oscillations[k]] for k in (first.i, first.j)]
            grows = any(x.real > GROWS * abs(x) for x in exponents)
            if low <= Omega <= high and Omega > 0.0 and not grows:
                found.append((Omega, resonance))
    coupled = _coupled(near.equation, alone, np.array([Omega for Omega, _ in found]))
    guessed = [
        Candidate(resonance, Omega, at.guess(resonance))
        for (Omega, resonance), at in zip(found, coupled, strict=True)
    ]
    real = [c for c in guessed if np.isfinite(c.guess.critical)]
    return sorted(real, key=lambda c: (c.guess.critical, -c.guess.T))


def _coupled(equation: Any, alone: Steady, Omega: Any) -> list[Coupled]:
    """The equation in its modes at the nearest of some of these Omega."""
    if not len(Omega):
        return []
    ordered = np.unique(Omega)
    samples = ordered[np.unique(np.linspace(0, len(ordered) - 1, SAMPLES).astype(int))]
    made: list[Coupled] = []
    at = []
    for x in samples:
        try:
            made.append(Coupled(equation(float(x)), alone))
        except Singular:
            continue
        at.append(float(x))
    nearest = np.abs(np.array(at)[None, :] - Omega[:, None]).argmin(axis=1)
    return [made[k] for k in nearest]
