"""The part of a damped bar's axial force that is a quarter of a period behind the thrust.

The report keeps Re Phi* cos(Omega t) (4.2.39). The motion (4.2.34) has -Im Phi* sin(Omega t) too.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.beams import UniformBeam
from hill.matrices import uniform

Float = NDArray[np.floating[Any]]


def out_of_phase(beam: UniformBeam, Omega: float) -> Float:
    """What stands beside -gamma sin(Omega tau) as G stands beside gamma cos(Omega tau).

    Parameters
    ----------
    beam : UniformBeam
    Omega : float
        Forcing frequency over ``omega_1``.

    Returns
    -------
    (modes + 1, modes + 1) ndarray
        In closed form; zero to rounding for an undamped bar.
    """
    wave = complex(np.sqrt((Omega / beam.omega_L) ** 2 - 1j * beam.g))
    return uniform.out_of_phase(beam.modes, beam.T0, wave)
