"""What rounding does to the witness's matrices: how far they are from the beam's."""

import numpy as np

from floquet.arrays import Complex, Float

# Rounding of the matrices, over the largest element: against ball arithmetic 23 ulps at most over
# 1,000 beams of up to 8 modes, but for what follows.
MATRIX_ERROR = 32.0 * 2.0**-52

# What the division by a stepped beam's mass may make of an ulp before its matrices are further off,
# 116 for the report's beam: 31 ulps were seen where it was less, beyond it .16 times it, over 700
# beams with ratios of areas and of inertias from 1e-4 to 1e4.
STEEP = 125.0


def matrix_error(wave: complex, force: Float, complete: Complex | None, steep: float) -> float:
    """Bound on the rounding of a beam's matrices, over the largest element.

    Parameters
    ----------
    wave : complex
        z = pi `wave` moves the force by z times its square.
    force : (k,) ndarray
        The axial force at the nodes.
    complete : (k,) complex ndarray or None
        Of a damped bar the force of which `force` is the real part; its modulus counts.
    steep : float
        What the division by a stepped beam's mass makes of an ulp.
    """
    size = left = float(np.max(np.abs(force)))
    if complete is not None:
        size = float(np.max(np.abs(complete)))
    moved = np.pi * abs(wave) * size * (size / left if left else 1.0)
    return min(MATRIX_ERROR * (1.0 + moved) * max(steep / STEEP, 1.0), 1.0)


def amplification(mass: Float, stiffness: Float, mass_size: float, size: float) -> float:
    """What an ulp of these sizes in the mass and the stiffness makes of their quotient.

    To first order, over its largest element, the translation left out. The sizes are of what the
    elements sum: short of it where one section is light, weak or short.
    """
    whole = np.abs(np.linalg.solve(mass, stiffness))
    moved = np.max(mass_size * whole.sum(axis=0)[:-1]) + size
    rows = np.max(np.abs(np.linalg.inv(mass)).sum(axis=1)[:-1])
    largest = np.max(whole[:-1, :-1])
    return float(rows * moved / largest) if largest else 0.0
