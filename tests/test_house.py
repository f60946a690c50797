"""The house: which floor may look at which, and what every module owes its reader."""

import ast
import inspect
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import compare
import floquet
import hill
from floquet import monodromy
from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam, characteristic

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
}

# The modules of hill that hold data; every other one computes.
DATA = {
    "hill",
    "beam_common",
    "beams",
    "checks",
    "equation",
    "errors",
    "periodic",
    "system",
    "toml",
    "vehicle.parts",
    "vehicle.units",
    "vehicle.vehicle",
}

LONGEST = 300
# The two programs of the report, routine by routine: split, they would not read like the listing.
LONGER = {"compare/report/program/listing.py": 480}


def name_of(floor: str, path: Path) -> str:
    return f"{floor}/{path.relative_to(ROOTS[floor]).as_posix()}"


each_module = pytest.mark.parametrize(
    ("floor", "path"), MODULES, ids=[name_of(floor, path) for floor, path in MODULES]
)


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def imports(path: Path) -> Iterator[tuple[str, str]]:
    """(module, name) of every import, wherever in the file; the name of "import m" is empty."""
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            yield from ((node.module or "", alias.name) for alias in node.names)


def uses(path: Path, floor: str) -> list[tuple[str, str]]:
    return [(m, n) for m, n in imports(path) if m.split(".")[0] == floor]


def test_all_floors_are_seen() -> None:
    assert len(MODULES) >= 25
    assert {floor for floor, _ in MODULES} == set(FLOORS)


# ---- imports -------------------------------------------------------------------------------------


@each_module
def test_each_floor_only_looks_down(floor: str, path: Path) -> None:
    if floor == "hill":
        assert not uses(path, "floquet")
    if floor != "compare":
        assert not uses(path, "compare")


@pytest.mark.parametrize("path", [path for floor, path in MODULES if floor == "floquet"], ids=str)
def test_the_witness_takes_data_only(path: Path) -> None:
    for module, name in uses(path, "hill"):
        assert (module, name in SHARED) == ("hill", True), f"from {module} import {name}"
    asked = {node.attr for node in ast.walk(tree(path)) if isinstance(node, ast.Attribute)}
    assert not asked & {"equation", "natural_frequencies"}
    called = {node.id for node in ast.walk(tree(path)) if isinstance(node, ast.Name)}
    # no way round the rule
    assert not called & {"__import__", "import_module", "getattr", "eval", "exec"}


def test_the_shared_data_computes_nothing() -> None:
    """Equations and checks stand on their own, and so may go to both routes."""
    own = {"checks", "equation", "periodic"}
    for name in own:
        for module, imported in uses(ROOTS["hill"] / f"{name}.py", "hill"):
            assert module.removeprefix("hill.") in own or (module, imported) == ("hill", "checks")


def test_the_judge_computes_no_physics() -> None:
    """It finds roots and pairs values; determinants and integrations are the two routes' own."""
    for floor, path in MODULES:
        if floor == "compare":
            assert not uses(path, "casadi")
            assert not {m for m, _ in uses(path, "scipy")} & {"scipy.linalg", "scipy.integrate"}


# ---- manners -------------------------------------------------------------------------------------


def may_print(name: str) -> bool:
    return (
        name in ("compare/__main__.py", "compare/report/recover.py")
        or name.startswith(
            ("compare/report/render", "compare/crosscheck_text", "compare/commands/")
        )
        or name.endswith("_page.py")
    )


@each_module
def test_only_the_command_prints(floor: str, path: Path) -> None:
    printing = any(
        isinstance(node, ast.Call)
        and (
            (isinstance(node.func, ast.Name) and node.func.id == "print")
            or (isinstance(node.func, ast.Attribute) and node.func.attr == "print")
        )
        for node in ast.walk(tree(path))
    )
    assert not printing or may_print(name_of(floor, path))


@each_module
def test_public_names_have_docstrings(floor: str, path: Path) -> None:
    module = tree(path)
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    bodies = [module, *(node for node in module.body if isinstance(node, ast.ClassDef))]
    for body in bodies:
        for node in body.body:
            if isinstance(node, kinds) and not node.name.startswith("_"):
                assert ast.get_docstring(node), f"{node.name}, line {node.lineno}"
    reexports = all(isinstance(node, (ast.Import, ast.ImportFrom)) for node in module.body)
    assert ast.get_docstring(module) or reexports


@each_module
def test_modules_are_short(floor: str, path: Path) -> None:
    lines = len(path.read_text(encoding="utf-8").splitlines())
    assert lines <= LONGER.get(name_of(floor, path), LONGEST)


def test_exceptions_are_needed() -> None:
    for name in LONGER:
        path = ROOTS[name.split("/")[0]] / name.split("/", 1)[1]
        assert len(path.read_text(encoding="utf-8").splitlines()) > LONGEST


# ---- independence at run time --------------------------------------------------------------------

FORCING = (1.82, 0.1)
BEAMS = (
    UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=2 * 1.82),
    SteppedBeam(T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6),
)


def dotted(floor: str, path: Path) -> str:
    """The name a module is imported by."""
    parts = path.relative_to(ROOTS[floor]).with_suffix("").parts
    return ".".join([floor, *(part for part in parts if part != "__init__")])


def broken(*_: Any, **__: Any) -> Any:
    raise AssertionError("this floor was not to be asked")


def break_functions(monkeypatch: pytest.MonkeyPatch, floor: str, spared: set[str]) -> list[str]:
    """Every function of a floor's other modules raises, under every name the floor has for it."""
    names = {dotted(floor, path) for other, path in MODULES if other == floor}
    sources = {name for name in names if name.removeprefix(f"{floor}.") not in spared}
    hit = []
    for module in map(import_module, sorted(names)):
        for name, value in list(vars(module).items()):
            owner = getattr(value, "__module__", None)
            function = inspect.isfunction(value) or hasattr(value, "cache_info")
            if function and owner in sources:
                hit.append(f"{module.__name__}.{name}")
                monkeypatch.setattr(module, name, broken)
    return hit


@pytest.mark.parametrize("beam", BEAMS, ids=["uniform", "stepped"])
def test_the_witness_works_without_hill(
    beam: UniformBeam | SteppedBeam, monkeypatch: pytest.MonkeyPatch
) -> None:
    terms = 2 if isinstance(beam, UniformBeam) else 0
    before = monodromy(galerkin(beam, *FORCING, 0.01, terms))
    hit = break_functions(monkeypatch, "hill", DATA)
    for place in (
        "matrices.uniform.steady",
        "matrices.stepped.reduce",
        "matrices.integrals.integral",
    ):
        assert f"hill.{place}" in hit
    for place in (
        "determinant.converged.characteristic",
        "stability.stability_of",
        "matrices.uniform.mode",
    ):
        assert f"hill.{place}" in hit
    with pytest.raises(AssertionError, match="not to be asked"):
        beam.equation(*FORCING)
    after = monodromy(galerkin(beam, *FORCING, 0.01, terms))
    assert np.array_equal(before.polynomial, after.polynomial)
    assert before.T == after.T
    # nor does it ask the beam
    monkeypatch.setattr(type(beam), "equation", broken)
    monkeypatch.setattr(type(beam), "natural_frequencies", broken)
    galerkin(beam, *FORCING, 0.01, terms)


def test_hill_works_without_the_witness(monkeypatch: pytest.MonkeyPatch) -> None:
    beam = BEAMS[0]
    before = characteristic(beam.equation(*FORCING, 0.01, 2))
    hit = break_functions(monkeypatch, "floquet", {"floquet"})
    assert {"floquet.weak_form.galerkin", "floquet.period.monodromy"} <= set(hit)
    with pytest.raises(AssertionError, match="not to be asked"):
        import_module("floquet.period").monodromy(beam.equation(*FORCING))
    after = characteristic(beam.equation(*FORCING, 0.01, 2))
    assert np.array_equal(before.polynomial, after.polynomial)
    assert isinstance(beam.equation(*FORCING), HillEquation)
    beam.natural_frequencies()
