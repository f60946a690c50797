from hill.beams import SteppedBeam as SteppedBeam
from hill.beams import UniformBeam as UniformBeam
from hill.characteristic import Characteristic as Characteristic
from hill.characteristic import characteristic as characteristic
from hill.equation import HillEquation as HillEquation
