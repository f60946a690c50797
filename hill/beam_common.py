"""What the report's two beams have in common: parameters, limits, names, refusals."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill import checks
from hill.arrays import Complex, Float
from hill.errors import LongitudinalResonance
from hill.system import Parameter

# Omega, omega_L and their quotient are rounded, each by half an ulp, and pi sigma by one: below so
# many ulps of it sin(pi sigma) may be zero, and the undamped axial force infinite.
RESONANCE_ULPS = 4

COMMON = (
    Parameter("T0", dependence="linear"),
    Parameter("K_theta", dependence="linear"),
    Parameter("xi_G", 0.0, 1.0),
    Parameter("omega_L", 0.0, smooth="ratio", moves=("G", "H")),
)

# Rounding of the closed forms, over the largest element: against ball arithmetic they were off by
# half of it at most over 1,000 beams of up to 8 modes. Near a longitudinal resonance the force adds
# its own.
MATRIX_ERROR = 32.0 * 2.0**-52

# What the reduction of a stepped beam may make of an ulp before its matrices are further off: 116
# for the report's beam. Over 700 with ratios of areas and of inertias from 1e-4 to 1e4 they were
# off by 15 ulps at most where it was less, and beyond by .12 times it.
STEEP = 125.0

# Over it is divided: a matrix without an element has no error.
SMALLEST = 1e-300

# Closed forms and quadrature are within twice `MATRIX_ERROR` of each other: 50 ulps with so many.
# With 59 the time domain takes 5 s of processor time and knows T to 3e-11, P to 0.09 only.
MAX_MODES = 80

# Beyond it exp(pi sqrt(g)) overflows; a structure's g is below 1.
MAX_G = 1e4


def frequencies(
    F: NDArray[np.floating[Any]],
) -> Float | Complex:
    """Natural frequencies, ascending by real part; real where all of them are."""
    roots = np.sqrt(np.linalg.eigvals(F).astype(complex))
    roots = roots[np.lexsort((roots.imag, roots.real))]
    return roots if np.any(roots.imag) else roots.real.copy()


def forcing(Omega: float, omega_L: float) -> tuple[float, float]:
    """Checked Omega, and sigma = Omega/omega_L of Eq. (4.4.8)."""
    Omega = checks.positive("Omega", Omega)
    return Omega, Omega / omega_L


def names(modes: int) -> tuple[str, ...]:
    """What the report calls the frequencies: rotation, then bending."""
    return ("B", *(str(n) for n in range(1, modes + 1)))


def matrix_error(nu: float, divisor: float, hidden: float = 0.0, steep: float = 0.0) -> float:
    """Rounding of the matrices; the force is divided by what vanishes at a resonance.

    `hidden` is the size of what was computed with the largest element and then left out, over it:
    of a damped bar's force the part out of phase, the larger one near a resonance. `steep` is what
    the reduction of a stepped beam makes of an ulp.
    """
    near = 1.0 + nu / divisor * (1.0 + hidden) if nu else 1.0
    return min(MATRIX_ERROR * near * max(steep / STEEP, 1.0), 1.0)


def refuse_resonance(resonant: bool, Omega: float, omega_L: float) -> None:
    """Raise `LongitudinalResonance` where there is one."""
    if resonant:
        raise LongitudinalResonance(
            f"Omega = {Omega:g} is a longitudinal resonance (omega_L = {omega_L:g}): "
            "the undamped axial force is infinite there"
        )
