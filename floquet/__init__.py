from floquet.beam_sensitivity import BeamSensitivities as BeamSensitivities
from floquet.beam_sensitivity import beam_sensitivities as beam_sensitivities
from floquet.monodromy import Monodromy as Monodromy
from floquet.monodromy import monodromy as monodromy
from floquet.sensitivity import Derivatives as Derivatives
from floquet.sensitivity import Sensitivities as Sensitivities
from floquet.sensitivity import sensitivities as sensitivities
