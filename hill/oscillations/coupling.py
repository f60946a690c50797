r"""How strongly pulsation couples two oscillations, to the lowest order in it that does.

In the steady system's modes x' = diag(mu) x + sum_k A_k exp(i k Omega t) x, the oscillations of a
resonance of order k are coupled by A_1 taken k times, the harmonics between following at once, and
by A_k. Averaged, their exponents s, measured from mu_i, obey

.. math:: (s + a) (s + b + i \delta) = c^2, \qquad a = -\Re \mu_i, \quad b = -\Re \mu_j .

A guess of where to look closely: Hsu's of the first order, for k = 1 and no damping.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hill.arrays import EPS, Complex
from hill.averaging import Resonance
from hill.equation import HillEquation
from hill.oscillations.steady import Steady
from hill.periodic import Fourier, PeriodicEquation

# Decay, over the exponent, that is none: of two that are rounding only the ratio would matter.
UNDAMPED = 1e-10


@dataclass(frozen=True)
class Guess:
    """What averaging says of one resonance.

    Attributes
    ----------
    coupling : complex
        c^2; an instability where its real part is positive and large enough.
    T : float
        Twice the growth exponent where Omega is worst, as in (7.1.1).
    half_width : float
        Half the width in Omega of the band where the two grow, 0 where there is none.
    critical : float
        The pulsation from which they grow, over the equation's own: 0 without damping, infinite
        where they never do.
    """

    coupling: complex
    T: float
    half_width: float
    critical: float


@dataclass(frozen=True, eq=False)
class Coupled:
    """An equation in the modes of its mean.

    Attributes
    ----------
    equation : HillEquation or PeriodicEquation
    alone : Steady
        Its mean.
    """

    equation: HillEquation | PeriodicEquation
    alone: Steady

    @cached_property
    def terms(self) -> dict[int, Complex]:
        """A_k in the modes, by k of either sign."""
        R = self.alone.right
        return {k: np.linalg.solve(R, A @ R) for k, A in _pulsation(self.equation).items()}

    def guess(self, resonance: Resonance) -> Guess:
        """What averaging says of a resonance at the equation's Omega."""
        mu, k = self.alone.exponents, resonance.order
        i, j = (self.alone.oscillations[x] for x in (resonance.i, resonance.j))
        if resonance.sign > 0:
            j = int(np.argmin(np.abs(mu - np.conj(mu[j]))))
        exponent = complex(mu[i])
        with np.errstate(over="ignore", invalid="ignore"):
            square = self._passed(j, i, range(-k, 1), exponent)
            square *= self._passed(i, j, range(0, -k - 1, -1), exponent)
        if not np.isfinite(square):
            raise OverflowError(
                f"{resonance.name}: stiffness or pulsation is beyond what a float can hold"
            )
        a, b = (float(-x.real) if -x.real > UNDAMPED * abs(x) else 0.0 for x in (mu[i], mu[j]))
        c2 = float(square.real)
        growth = np.sqrt(max(0.25 * (a - b) ** 2 + c2, 0.0)) - 0.5 * (a + b)
        grows = c2 > a * b
        # s is imaginary where delta^2 = (a + b)^2 (c^2/(a b) - 1), or 4 c^2
        detuned = 4.0 * c2 if a * b == 0.0 else (a + b) ** 2 * (c2 / (a * b) - 1.0)
        return Guess(
            coupling=complex(square),
            T=2.0 * float(growth),
            half_width=float(np.sqrt(detuned)) / k if grows else 0.0,
            critical=float((a * b / c2) ** (0.5 / k)) if c2 > 0.0 else float("inf"),
        )

    def _passed(self, start: int, end: int, harmonics: range, exponent: complex) -> complex:
        """From one oscillation to the other, through the harmonics between theirs.

        Harmonic m follows what drives it as (exponent + i m Omega - mu)^-1.
        """
        step, mu = harmonics.step, self.alone.exponents
        none = np.zeros((len(mu), len(mu)))
        one = self.terms.get(step, none)
        x = one[:, start]
        for m in harmonics[1:-1]:
            far = exponent + 1j * m * self.equation.Omega - mu
            # one on the way resonates too: large, and what is solved then is not this guess
            x = one @ (x / np.where(far == 0.0, EPS * self.equation.Omega, far))
        direct = self.terms.get(harmonics[-1] - harmonics[0], none) if len(harmonics) > 2 else none
        return complex(x[end] + direct[end, start])


def _pulsation(equation: HillEquation | PeriodicEquation) -> dict[int, Complex]:
    """A_k of x' = (A_0 + sum A_k exp(i k Omega t)) x, in the states (q, q') or x."""
    e = equation.general() if isinstance(equation, HillEquation) else equation
    if e.A is not None:
        return _complex(e.A)
    assert e.K is not None
    assert e.C is not None
    n = e.K.n
    K, C = _complex(e.K), _complex(e.C)
    found: dict[int, Complex] = {}
    for k in {*K, *C}:
        part = np.zeros((2 * n, 2 * n), complex)
        part[n:, :n] = -K.get(k, np.zeros((n, n)))
        part[n:, n:] = -C.get(k, np.zeros((n, n)))
        if e.M is not None:
            part[n:] = np.linalg.solve(e.M, part[n:])
        found[k] = part
    return found


def _complex(matrix: Fourier) -> dict[int, Complex]:
    """Coefficients of exp(i k Omega t), k of either sign and not 0."""
    found: dict[int, Complex] = {}
    for parts, unit in ((matrix.cos, 0.5 + 0.0j), (matrix.sin, -0.5j)):
        for k, part in parts.items():
            for p, factor in ((k, unit), (-k, unit.conjugate())):
                found[p] = np.asarray(found.get(p, 0.0) + factor * part)
    return found
