"""Hill's determinant: equations, systems and the determinant's route to their stability."""

from hill.beams import SteppedBeam, UniformBeam
from hill.determinant.converged import Characteristic, characteristic
from hill.equation import HillEquation
from hill.errors import LongitudinalResonance, Refused
from hill.periodic import Fourier, PeriodicEquation
from hill.system import MatrixSystem, Parameter, System

__all__ = [
    "Characteristic",
    "Fourier",
    "HillEquation",
    "LongitudinalResonance",
    "MatrixSystem",
    "Parameter",
    "PeriodicEquation",
    "Refused",
    "SteppedBeam",
    "System",
    "UniformBeam",
    "characteristic",
]
