"""The routes while they run: neither calls what the other computes with; the judge only asks."""

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from house import COMPUTED, DATA_MODULES, Call, own_physics, public, traced

import compare
import floquet
import floquet.batch
import floquet.unchecked
import hill
import hill.averaging
import hill.batch
from floquet import monodromy
from floquet.batch.equations import WORTH_COMPILING
from floquet.vehicle.discretise import discretised
from floquet.weak_form import galerkin
from hill import (
    Fourier,
    HillEquation,
    PeriodicEquation,
    Section,
    SteppedBeam,
    Thrust,
    UniformBeam,
    Vehicle,
    characteristic,
)

FORCING = (1.82, 0.1)
BEAMS = {
    "uniform": UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=2 * 1.82),
    "stepped": SteppedBeam(
        T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6
    ),
}
VEHICLE = Vehicle(
    sections=(Section(1.0, 1.0, 1.0), Section(2.0, (1.0, 0.5), 2.0, EA=3.0)),
    thrust=Thrust(1.0),
    g=0.1,
    modes=2,
)
EQUATION = HillEquation([[2.0, 0.3], [0.2, 1.0]], [[1.0, 2.0], [3.0, 1.0]], 0.3, 1.3, 0.05)
DASHPOT = HillEquation(EQUATION.F, EQUATION.G, 0.3, 1.3, [[0.2, 0.0], [0.0, 0.1]])
WITH_H = HillEquation(EQUATION.F, EQUATION.G, 0.3, 1.3, 0.05, [np.eye(2)], 2.6)

GENERAL = PeriodicEquation(
    C=Fourier(0.1 * np.eye(2), cos={1: [[0.1, 0.2], [0.0, 0.1]]}),
    K=Fourier([[2.0, 0.3], [0.2, 1.0]], cos={1: EQUATION.G * 0.1}, sin={2: 0.2 * np.eye(2)}),
    Omega=1.3,
)

BY_FLOQUET: dict[str, Callable[[], Any]] = {
    "half a period": lambda: monodromy(EQUATION),
    "with H": lambda: monodromy(WITH_H),
    "cvodes": lambda: monodromy(EQUATION, method="cvodes"),
    "general": lambda: monodromy(GENERAL),
    "general, cvodes": lambda: monodromy(GENERAL, method="cvodes"),
    "damping matrix": lambda: monodromy(DASHPOT),
    "batch": lambda: floquet.batch.polynomials([EQUATION, WITH_H]),
    "sweep": lambda: floquet.batch.sweep(EQUATION, Omega=[1.0, 1.3], gamma=0.3, kernel="numpy"),
    "compiled": lambda: floquet.batch.sweep(
        EQUATION, Omega=np.linspace(1.0, 2.0, WORTH_COMPILING), gamma=0.3
    ),
    "sensitivities": lambda: floquet.sensitivities(EQUATION),
    "sensitivities, damping matrix": lambda: floquet.sensitivities(DASHPOT),
    "galerkin, uniform": lambda: galerkin(BEAMS["uniform"], *FORCING, 0.01, 2),
    "galerkin, stepped": lambda: galerkin(BEAMS["stepped"], *FORCING, 0.01),
    "finite elements": lambda: discretised(VEHICLE, 30.0, 0.1),
    "beam sensitivities": lambda: floquet.beam_sensitivities(BEAMS["uniform"], *FORCING),
    "unchecked": lambda: floquet.unchecked.unchecked_growth(
        floquet.unchecked.unchecked_polynomials([EQUATION]), 1.3
    ),
}
BY_HILL: dict[str, Callable[[], Any]] = {
    "converged": lambda: characteristic(EQUATION),
    "with H": lambda: characteristic(WITH_H),
    "general": lambda: characteristic(GENERAL),
    "vehicle": lambda: VEHICLE.equation(30.0, 0.1),
    "residues": lambda: characteristic(EQUATION, truncation="report"),
    "samples": lambda: characteristic(HillEquation([[4.0]], [[1.0]], 0.3, 1.0), truncation=8),
    "batch": lambda: hill.batch.polynomials([EQUATION, WITH_H]),
    "uniform": lambda: BEAMS["uniform"].equation(*FORCING, 0.01, 2),
    "stepped": lambda: BEAMS["stepped"].equation(*FORCING, 0.01),
    "frequencies": lambda: [beam.natural_frequencies() for beam in BEAMS.values()],
    "averaging": lambda: hill.averaging.half_width(hill.averaging.Resonance(1, 0), EQUATION),
}


def computed_by_hill(calls: set[Call]) -> set[Call]:
    """Calls of what computes, not of data; a class's own machinery is data."""
    return {
        (caller, module, name)
        for caller, module, name in calls
        if module.split(".")[0] == "hill"
        and (module not in DATA_MODULES or set(name.split(".")) & COMPUTED)
    }


@pytest.mark.parametrize("what", BY_FLOQUET.values(), ids=BY_FLOQUET)
def test_the_witness_works_without_hill(what: Callable[[], Any]) -> None:
    with traced("hill", "floquet") as calls:
        what()
    assert any(module.startswith("floquet") for _, module, _ in calls)
    assert not computed_by_hill(calls)


@pytest.mark.parametrize("what", BY_HILL.values(), ids=BY_HILL)
def test_hill_works_without_the_witness(what: Callable[[], Any]) -> None:
    with traced("hill", "floquet") as calls:
        what()
    assert computed_by_hill(calls)
    assert not {call for call in calls if call[1].split(".")[0] == "floquet"}


CHEATS = {
    "a cache": "from hill.matrices.modes import mode\ndef cheat(): return mode(2)",
    "a made-up name": """
from importlib import import_module
def cheat(): return getattr(import_module("hill." + "stability"), "ro" + "ots")(P)""",
    "handed over": "def cheat(f=hill.stability.log_R): return list(map(f, [P], [P]))",
    "by the beam": "def cheat(): return BEAM.equation(1.82, .1)",
    "frequencies": "def cheat(): return BEAM.natural_frequencies()",
}


@pytest.mark.parametrize("source", CHEATS.values(), ids=CHEATS)
def test_a_witness_that_works_with_hill_is_seen(source: str) -> None:
    cheat = {"__name__": "floquet.cheat", "P": np.array([[1.0, 0.2]]), "hill": hill}
    exec(source, cheat | {"BEAM": BEAMS["uniform"]}, space := {})
    found = space["cheat"]
    found.__globals__.update(space)
    found()  # whatever has a cache has it filled
    with traced("hill", "floquet") as calls:
        found()
    assert computed_by_hill(calls)


def asked_by_the_judge(calls: set[Call]) -> set[str]:
    """What compare called that is neither an answer of a route nor harmless."""
    found: set[str] = set()
    for caller, module, name in calls:
        # numpy's dispatchers go before the function itself; a function within one belongs to it
        if caller.split(".")[0] == "compare" and "dispatcher" not in name:
            whole = public(f"{module}.{name.split('.<locals>')[0]}")
            found |= own_physics({whole}, caller.replace(".", "/") + ".py")
    return found


JUDGED: dict[str, Callable[[], Any]] = {
    "crosscheck": lambda: compare.crosscheck(BEAMS["stepped"], Omega=1.8, gamma=0.1),
    "crosscheck, general": lambda: compare.crosscheck(GENERAL),
    "rows": lambda: compare.verify(rows=["T1-01", "T3-01b"]),
    "chart": lambda: charted("uniform", "floquet"),
    "chart, hill": lambda: charted("uniform", "hill"),
    "tongues": lambda: import_module("compare.edges.instabilities").instabilities(
        charted("stepped", "both")
    ),
    "curves": lambda: import_module("compare.edges.curves").boundaries(charted("stepped", "hill")),
}


@cache
def charted(beam: str, route: str) -> Any:
    return compare.chart(
        BEAMS[beam], [("Omega", 3.0, 3.4, 12), ("gamma", 0.0, 0.3, 12)], route=route
    )


@pytest.mark.parametrize("what", JUDGED.values(), ids=JUDGED)
def test_the_judge_asks_and_does_not_compute(what: Callable[[], Any]) -> None:
    charted.cache_clear()
    with traced("compare") as calls:
        what()
    assert any(caller.startswith("compare") for caller, _, _ in calls)
    assert not asked_by_the_judge(calls)


@pytest.mark.parametrize(
    "source",
    [
        "import numpy as np\ndef cheat(): return getattr(np.linalg, 'd' + 'et')(np.eye(2))",
        "from hill.matrices import modes\ndef cheat(): return getattr(modes, 'mode')(1)",
        "from scipy.integrate import quad\ndef cheat(): return quad(abs, 0, 1)",
        "from floquet.period import second_half\ndef cheat(): return second_half(E)",
    ],
)
def test_a_judge_that_computes_is_seen(source: str) -> None:
    cheat = {"__name__": "compare.charts.cheat", "E": np.eye(2)}
    exec(source, cheat)
    with traced("compare", "hill") as calls:
        cheat["cheat"]()
    assert asked_by_the_judge(calls)
