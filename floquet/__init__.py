"""The witness: a periodic system in the time domain, its monodromy matrix, what follows from it."""

from floquet.enclosure import enclose, enclose_interval, enclose_region
from floquet.general.of_time import EstimatedMonodromy
from floquet.motion.content import MeasuredGrowth, ModalContent, measured_growth, modal_content
from floquet.motion.history import Simulation, simulate
from floquet.motion.shapes import FloquetModes, floquet_modes
from floquet.period import monodromy
from floquet.result import Monodromy
from floquet.sensitivity.equation import Derivatives, Sensitivities, sensitivities
from floquet.sensitivity.general import GeneralSensitivities, general_sensitivities
from floquet.sensitivity.system import (
    BeamSensitivities,
    SystemSensitivities,
    beam_sensitivities,
    system_sensitivities,
)

__all__ = [
    "BeamSensitivities",
    "Derivatives",
    "EstimatedMonodromy",
    "FloquetModes",
    "GeneralSensitivities",
    "MeasuredGrowth",
    "ModalContent",
    "Monodromy",
    "Sensitivities",
    "Simulation",
    "SystemSensitivities",
    "beam_sensitivities",
    "enclose",
    "enclose_interval",
    "enclose_region",
    "floquet_modes",
    "general_sensitivities",
    "measured_growth",
    "modal_content",
    "monodromy",
    "sensitivities",
    "simulate",
    "system_sensitivities",
]
