"""Hill's determinant: equations, systems and the determinant's route to their stability."""

from hill.beams import SteppedBeam, UniformBeam
from hill.determinant.converged import Characteristic, characteristic
from hill.equation import HillEquation
from hill.errors import LongitudinalResonance, Refused
from hill.system import MatrixSystem, Parameter, System

__all__ = [
    "Characteristic",
    "HillEquation",
    "LongitudinalResonance",
    "MatrixSystem",
    "Parameter",
    "Refused",
    "SteppedBeam",
    "System",
    "UniformBeam",
    "characteristic",
]
