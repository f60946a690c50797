"""What averaging expects of a resonance, of any linear equation: how wide, from which pulsation on.

Of a `HillEquation` Hsu's formulas (`hill.averaging`); of a `PeriodicEquation` the coupling of the
two oscillations to the lowest order that has one (`hill.oscillations.coupling`).
"""

import numpy as np

from hill.averaging import Resonance
from hill.averaging import critical_gamma as critical_gamma_of_Hsu
from hill.averaging import half_width as half_width_of_Hsu
from hill.equation import HillEquation
from hill.oscillations.coupling import Coupled, Guess
from hill.oscillations.steady import steady
from hill.periodic import PeriodicEquation

Equation = HillEquation | PeriodicEquation


def half_width(resonance: Resonance, equation: Equation, *, damped: bool = True) -> float:
    """Half the width in Omega; 0 where no instability is expected.

    Of a `HillEquation` to the first order in gamma, whatever the resonance's own order.
    """
    if isinstance(equation, HillEquation):
        return half_width_of_Hsu(resonance, equation, damped=damped)
    guess = _guess(resonance, equation)
    if guess is None:
        return 0.0
    if damped:
        return guess.half_width
    return float(2.0 * np.sqrt(max(guess.coupling.real, 0.0))) / resonance.order


def critical_gamma(resonance: Resonance, equation: Equation, gamma: float) -> float:
    """The gamma from which damping is overcome; nan without damping, and where none is expected.

    Of a `PeriodicEquation` if all of its pulsation is in proportion to gamma.
    """
    if isinstance(equation, HillEquation):
        return critical_gamma_of_Hsu(resonance, equation)
    guess = _guess(resonance, equation)
    found = np.nan if guess is None else gamma * guess.critical
    return float(found) if 0.0 < found < np.inf else float("nan")


def damping(resonance: Resonance, equation: Equation) -> float:
    """Twice the rate at which the two oscillations decay by themselves, their geometric mean.

    0 where one of them does not.
    """
    if isinstance(equation, HillEquation):
        return equation.damping
    alone, both = steady(equation), _both(resonance, equation)
    if both is None:
        return 0.0
    rates = [-alone.exponents[alone.oscillations[k]].real for k in both]
    return float(2.0 * np.sqrt(np.prod(rates))) if min(rates) > 0.0 else 0.0


def strength(equation: Equation) -> float:
    """How strong the pulsation is, in proportion to gamma: what it shifts goes with its square.

    Of a `PeriodicEquation` the most that a harmonic couples two oscillations by, over Omega, scaled
    to be gamma for x'' + (1 + gamma cos 2 tau) x = 0.
    """
    if isinstance(equation, HillEquation):
        return equation.gamma
    alone = steady(equation)
    terms = Coupled(equation, alone).terms.values()
    own = list(alone.oscillations)
    most = max((float(np.max(np.abs(x[np.ix_(own, own)]), initial=0.0)) for x in terms), default=0)
    return 8.0 * most / equation.Omega


def _guess(resonance: Resonance, equation: PeriodicEquation) -> Guess | None:
    both = _both(resonance, equation)
    if both is None:
        return None
    own = Resonance(*both, sign=resonance.sign, order=resonance.order)
    return Coupled(equation, steady(equation)).guess(own)


def _both(resonance: Resonance, equation: PeriodicEquation) -> tuple[int, int] | None:
    """Which oscillations of the mean: frequencies that are 0 come first, and are none."""
    count = len(steady(equation).oscillations)
    i, j = (k - (equation.order // 2 - count) for k in (resonance.i, resonance.j))
    return (i, j) if min(i, j) >= 0 else None
