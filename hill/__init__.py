"""Hill's determinant: equations, systems and the determinant's route to their stability."""

from hill.beams import SteppedBeam, UniformBeam
from hill.determinant.converged import characteristic
from hill.determinant.result import Characteristic
from hill.determinant.root_distance import RootDistance, root_distance
from hill.enclosure import enclose
from hill.equation import HillEquation
from hill.errors import LongitudinalResonance, Refused, Singular
from hill.periodic import Fourier, PeriodicEquation
from hill.periodic_system import PeriodicSystem
from hill.system import MatrixSystem, Parameter, System, parameter_values, varied
from hill.vehicle.convergence import Convergence, with_more_modes
from hill.vehicle.critical import CriticalThrust, critical_thrust
from hill.vehicle.parts import Damping, PointMass, Section, Sensor, Thrust
from hill.vehicle.units import Units
from hill.vehicle.vehicle import Vehicle

__all__ = [
    "Characteristic",
    "Convergence",
    "CriticalThrust",
    "Damping",
    "Fourier",
    "HillEquation",
    "LongitudinalResonance",
    "MatrixSystem",
    "Parameter",
    "PeriodicEquation",
    "PeriodicSystem",
    "PointMass",
    "Refused",
    "RootDistance",
    "Section",
    "Sensor",
    "Singular",
    "SteppedBeam",
    "System",
    "Thrust",
    "UniformBeam",
    "Units",
    "Vehicle",
    "characteristic",
    "critical_thrust",
    "enclose",
    "parameter_values",
    "root_distance",
    "varied",
    "with_more_modes",
]
