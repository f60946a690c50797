"""Who asks whom: what a module refers to, read from its source, and who calls whom, while it runs.

Names are followed through imports and their renamings to where a thing is defined, so that a rule
is about what is called and not about how it was imported. What is called by a name made up at run
time only the trace sees.
"""

import ast
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import _lru_cache_wrapper, cache
from importlib import import_module
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any

import compare
import floquet
import hill

FLOORS = ("hill", "floquet", "compare")
ROOTS = {p.__name__: Path(next(iter(p.__path__))) for p in (hill, floquet, compare)}
MODULES = sorted((floor, path) for floor, root in ROOTS.items() for path in root.rglob("*.py"))

# Data only: what floquet may know of hill.
SHARED = {
    "Damping",
    "Fourier",
    "HillEquation",
    "LongitudinalResonance",
    "PeriodicEquation",
    "PointMass",
    "Section",
    "Sensor",
    "SteppedBeam",
    "Thrust",
    "UniformBeam",
    "Vehicle",
    "checks",
    "decimals",
    "notebook",
    "parameter_values",
    "precision",
    "varied",
}

# The modules of hill that hold data; every other one computes.
DATA_MODULES = {
    "hill",
    "hill.beam_common",
    "hill.beams",
    "hill.checks",
    "hill.decimals",
    "hill.equation",
    "hill.errors",
    "hill.notebook",
    "hill.periodic",
    "hill.periodic_system",
    "hill.precision",
    "hill.system",
    "hill.toml",
    "hill.vehicle.file",
    "hill.vehicle.parts",
    "hill.vehicle.units",
    "hill.vehicle.validate",
    "hill.vehicle.vehicle",
}
# What the data's own modules do compute: the determinant's side of a beam.
COMPUTED = {"equation", "frequencies", "natural_frequencies", "singular_Omega"}

# What the judge may ask a route for: P, T, z and their bounds, the witness's own matrices, and
# where theory expects an instability.
ANSWERS = {
    "floquet.batch.equations.Polynomials",
    "floquet.batch.equations.polynomials",
    "floquet.batch.which_kernel.kernel_in_use",
    "floquet.data_errors.data_share",
    "floquet.enclosure.enclose",
    "floquet.enclosure.enclose_interval",
    "floquet.enclosure.enclose_region",
    "floquet.enclosure.result.IntervalProof",
    "floquet.enclosure.result.RegionProof",
    "floquet.frequencies.natural_frequencies",
    "floquet.motion.content.MeasuredGrowth",
    "floquet.motion.content.ModalContent",
    "floquet.motion.content.measured_growth",
    "floquet.motion.content.modal_content",
    "floquet.motion.history.Simulation",
    "floquet.motion.history.simulate",
    "floquet.motion.shapes.FloquetModes",
    "floquet.motion.shapes.floquet_modes",
    "floquet.period.monodromy",
    "floquet.result.Monodromy",
    "floquet.sensitivity.equation.Sensitivities",
    "floquet.sensitivity.system.BeamSensitivities",
    "floquet.sensitivity.system.SystemSensitivities",
    "floquet.sensitivity.system.beam_sensitivities",
    "floquet.sensitivity.system.system_sensitivities",
    "floquet.unchecked.unchecked_growth",
    "floquet.unchecked.unchecked_polynomials",
    "floquet.vehicle.discretise.discretised",
    "floquet.vehicle.discretise.rougher",
    "floquet.weak_form.galerkin",
    "floquet.weak_form.out_of_phase",
    "floquet.witness.maker",
    "floquet.witness.rougher_maker",
    "hill.averaging.Resonance",
    "hill.averaging.critical_gamma",
    "hill.averaging.fastest_motion",
    "hill.averaging.first_order",
    "hill.averaging.half_width",
    "hill.averaging.modal",
    "hill.axial_force.out_of_phase",
    "hill.batch.Polynomials",
    "hill.batch.polynomials",
    "hill.determinant.converged.characteristic",
    "hill.determinant.result.Characteristic",
    "hill.determinant.residues.as_the_report",
    "hill.enclosure.enclose",
    "hill.oscillations.coupling.Coupled",
    "hill.oscillations.coupling.Guess",
    "hill.oscillations.expected.critical_gamma",
    "hill.oscillations.expected.damping",
    "hill.oscillations.expected.half_width",
    "hill.oscillations.expected.strength",
    "hill.oscillations.pair.Pair",
    "hill.oscillations.pair.pair",
    "hill.oscillations.steady.Steady",
    "hill.oscillations.steady.mean_frequencies",
    "hill.oscillations.steady.steady",
    "hill.vehicle.convergence.Convergence",
    "hill.vehicle.convergence.extrapolated",
    "hill.vehicle.critical.CriticalThrust",
    "hill.vehicle.critical.critical_thrust",
    "hill.vehicle.inertia.RigidBody",
    "hill.vehicle.inertia.rigid_body",
    "hill.stability.root_radii",
    "hill.symmetry.damping_of_pairs",
    "hill.stability.Stabilities",
    "hill.stability.Stability",
    "hill.stability.Verdict",
    "hill.stability.arguments",
    "hill.stability.by_signs",
    "hill.stability.separators",
    "hill.stability.stabilities",
    "hill.stability.stability_of",
}

# With which a judge would compute for itself what it is to judge.
PHYSICS = (
    "casadi",
    "numpy.fft",
    "numpy.linalg",
    "numpy.polynomial.legendre",
    "scipy.integrate",
    "scipy.linalg",
    "scipy.special",
)
HARMLESS = ("numpy.linalg.norm", "numpy.linalg.LinAlgError")

# (where, what, why)
EXCUSED = (
    (
        "compare/stability/",
        {"numpy.linalg.eigvals"},
        "roots of a given P, as eigenvalues of its companion matrix",
    ),
    (
        "compare/report/program/",
        {"numpy.linalg.det", "numpy.linalg.eigvals", "numpy.linalg.solve"},
        "the report's own program, line by line: it is what is judged",
    ),
    (
        "compare/report/claims/frequencies.py",
        {"scipy.special.jn_zeros", "scipy.special.jv"},
        "the critical thrust of a free beam from the literature, in closed form",
    ),
    (
        "compare/report/claims/examples.py",
        {"hill.matrices.modes.eigenvalue"},
        "lambda_1, from which the report's units are made",
    ),
)


def dotted(floor: str, path: Path) -> str:
    """The name that a module is imported by."""
    parts = path.relative_to(ROOTS[floor]).with_suffix("").parts
    return ".".join([floor, *(part for part in parts if part != "__init__")])


def name_of(floor: str, path: Path) -> str:
    return f"{floor}/{path.relative_to(ROOTS[floor]).as_posix()}"


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


Call = tuple[str, str, str]
"""Module that calls, module that is called, and what of it."""


def references(path: Path) -> set[str]:
    """Dotted names, imports resolved: "numpy.linalg.det" for ``la.det`` and for ``det``."""
    known: dict[str, str] = {}
    found: set[str] = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                whole = alias.name if alias.asname else alias.name.split(".")[0]
                known[alias.asname or whole] = whole
                found.add(alias.name)
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                known[alias.asname or alias.name] = f"{node.module}.{alias.name}"
                found.add(f"{node.module}.{alias.name}")

    def whole_name(node: ast.AST) -> str | None:
        if isinstance(node, ast.Name):
            return known.get(node.id)
        if isinstance(node, ast.Attribute):
            before = whole_name(node.value)
            return before and f"{before}.{node.attr}"
        return None

    return found | {name for node in ast.walk(tree(path)) if (name := whole_name(node))}


@cache
def home(name: str) -> str:
    """Where a dotted name is defined: ``hill.characteristic`` in ``hill.determinant.converged``.

    A constant, and what is not there, keeps the name it has. Private modules of numpy are left out:
    ``numpy.linalg.det`` is ``numpy.linalg._linalg.det``.
    """
    thing = named(name)
    if isinstance(thing, ModuleType):
        return thing.__name__
    module, own = getattr(thing, "__module__", None), getattr(thing, "__qualname__", None)
    return public(f"{module}.{own}") if module and own else name


@cache
def named(name: str) -> Any:
    """What has this dotted name; None where nothing has."""
    before, _, last = name.rpartition(".")
    owner = named(before) if before else None
    if hasattr(owner, last):
        return getattr(owner, last)
    if before and not hasattr(owner, "__path__"):
        return None
    try:
        return import_module(name)
    except ImportError:
        return None


def public(name: str) -> str:
    """A dotted name of numpy or scipy without their private modules."""
    private = name.startswith(("numpy.", "scipy."))
    return re.sub(r"\._\w+(?=\.)", "", name) if private else name


@contextmanager
def traced(*floors: str) -> Iterator[set[Call]]:
    """Every call of a Python function by, or of, a module of these packages, as it happens.

    Caches are emptied before, or what they remember would be used without a call.
    """
    calls: set[Call] = set()

    def of(frame: FrameType | None) -> str:
        return str(frame.f_globals.get("__name__", "")) if frame else ""

    def note(frame: FrameType, event: str, _: Any) -> None:
        if event == "call":
            caller, called = of(frame.f_back), of(frame)
            if {caller.split(".")[0], called.split(".")[0]} & set(floors):
                calls.add((caller, called, frame.f_code.co_qualname))

    forget(*floors)
    before = sys.getprofile()
    sys.setprofile(note)
    try:
        yield calls
    finally:
        sys.setprofile(before)


def forget(*floors: str) -> None:
    """Empty the cache of every function that a module of these packages has."""
    for name, module in list(sys.modules.items()):
        if name.split(".")[0] in floors:
            for thing in list(vars(module).values()):
                if isinstance(thing, _lru_cache_wrapper):
                    thing.cache_clear()


def floors_above(floor: str, path: Path) -> set[str]:
    """What a module refers to of the floors that it must not know."""
    unknown = {"hill": ("floquet", "compare"), "floquet": ("compare",), "compare": ()}[floor]
    return {name for name in references(path) if name.split(".")[0] in unknown}


def beyond_data(path: Path) -> set[str]:
    """What a module of the witness knows of hill beside data."""
    found = {name for name in references(path) if name.split(".")[0] == "hill"}
    return {name for name in found if name != "hill" and name.split(".")[1] not in SHARED}


def own_physics(names: set[str], place: str) -> set[str]:
    """What of these a module of the judge must neither compute by itself nor ask a route for."""
    excused = {what for where, whats, _ in EXCUSED if place.startswith(where) for what in whats}
    wrong = {
        name
        for name in names
        if (not is_answer(name) if name.split(".")[0] in ("hill", "floquet") else is_physics(name))
    }
    return wrong - excused


def is_physics(name: str) -> bool:
    """Whether it is mathematics that only the routes are to do."""
    if name.startswith(HARMLESS) or (name.startswith("numpy.") and is_module(name)):
        return False
    return name.startswith(PHYSICS)


def is_answer(name: str) -> bool:
    """Whether the judge may ask for it: data, or what a route has to say."""
    doors = ANSWERS | (DATA_MODULES - {"hill"})
    return is_module(name) or any(f"{name}.".startswith(f"{door}.") for door in doors)


def is_module(name: str) -> bool:
    """Whether it is a module: to have one is nothing yet, what it is asked for counts."""
    return isinstance(named(name), ModuleType)
