"""The house: which floor may look at which, and what every module owes its reader."""

import ast
import inspect
import re
from dataclasses import is_dataclass
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from house import (
    COMPUTED,
    EXCUSED,
    FLOORS,
    MODULES,
    ROOTS,
    beyond_data,
    dotted,
    floors_above,
    home,
    name_of,
    named,
    own_physics,
    references,
    tree,
)

# What serves any System, and must not know the one report.
GENERIC = ("charts/", "edges/", "jobs/", "stability/", "chart_", "both_routes", "system_file")

LONGEST = 300
# The two programs of the report, routine by routine: split, they would not read like the listing.
LONGER = {"compare/report/program/listing.py": 480}


each_module = pytest.mark.parametrize(
    ("floor", "path"), MODULES, ids=[name_of(floor, path) for floor, path in MODULES]
)


def test_all_floors_are_seen() -> None:
    assert len(MODULES) >= 25
    assert {floor for floor, _ in MODULES} == set(FLOORS)


# ---- who looks at whom ---------------------------------------------------------------------------


@each_module
def test_each_floor_only_looks_down(floor: str, path: Path) -> None:
    assert not floors_above(floor, path)


@pytest.mark.parametrize("path", [path for floor, path in MODULES if floor == "floquet"], ids=str)
def test_the_witness_takes_data_only(path: Path) -> None:
    assert not beyond_data(path)
    asked = {node.attr for node in ast.walk(tree(path)) if isinstance(node, ast.Attribute)}
    # a system that the witness has no matrices for is asked for its own, in one place
    allowed = {"equation"} if name_of("floquet", path) == "floquet/witness.py" else set()
    assert asked & COMPUTED == allowed
    called = {node.id for node in ast.walk(tree(path)) if isinstance(node, ast.Name)}
    # no way round the rule
    assert not called & {"__import__", "import_module", "getattr", "eval", "exec"}


def test_the_shared_data_computes_nothing() -> None:
    """Equations and checks stand on their own, and so may go to both routes."""
    own = {"hill", "hill.checks", "hill.equation", "hill.periodic"}
    for module in own - {"hill"}:
        path = ROOTS["hill"] / f"{module.split('.')[1]}.py"
        known = {name for name in references(path) if name.split(".")[0] in FLOORS}
        assert all(any(home(n).startswith(m) for m in own - {"hill"}) for n in known - {"hill"})


@pytest.mark.parametrize("path", [path for floor, path in MODULES if floor == "compare"], ids=str)
def test_the_judge_computes_no_physics(path: Path) -> None:
    """It finds roots and pairs values; matrices, determinants and integrations are the routes'."""
    assert not own_physics(set(map(home, references(path))), name_of("compare", path))


def test_every_excuse_is_needed() -> None:
    for place, whats, why in EXCUSED:
        assert why
        used = {
            home(reference)
            for floor, path in MODULES
            if name_of(floor, path).startswith(place)
            for reference in references(path)
        }
        assert set(whats) <= used, place


VIOLATIONS = {
    "a determinant": "import numpy as np\ndef f(A): return np.linalg.det(A)",
    "by another name": "from numpy.linalg import det as size\ndef f(A): return size(A)",
    "handed on": "import numpy.linalg as la\nCHOICES = [la.slogdet]",
    "an integration": "def f():\n    from scipy import integrate\n    return integrate.quad",
    "a Galerkin rule": "from numpy.polynomial import legendre as p\nNODES = p.leggauss(9)",
    "modes": "from hill.matrices import modes as m\ndef f(): return m.mode(1)",
    "inside a route": "from hill.determinant.finite import blocks as data",
    "through a door": "from floquet import period\ndef f(U): return period.second_half(U)",
    "an ODE": "import casadi",
}


@pytest.mark.parametrize("source", VIOLATIONS.values(), ids=VIOLATIONS)
def test_physics_of_the_judge_is_found(source: str, tmp_path: Path) -> None:
    path = tmp_path / "cheat.py"
    path.write_text(source)
    assert own_physics(set(map(home, references(path))), "compare/charts/deep/cheat.py")


@pytest.mark.parametrize(
    ("source", "floor"),
    [
        ("import floquet.period as p", "hill"),
        ("def f():\n    from compare import chart", "floquet"),
        ("import compare.charts", "hill"),
    ],
)
def test_a_look_up_is_found(source: str, floor: str, tmp_path: Path) -> None:
    path = tmp_path / "cheat.py"
    path.write_text(source)
    assert floors_above(floor, path)


@pytest.mark.parametrize(
    "source",
    [
        "from hill.matrices import uniform",
        "import hill.stability as s",
        "import hill\nf = hill.characteristic",
        "from hill import averaging",
    ],
)
def test_a_witness_that_asks_hill_is_found(source: str, tmp_path: Path) -> None:
    path = tmp_path / "cheat.py"
    path.write_text(source)
    assert beyond_data(path)


def of_this_report(path: Path) -> set[str]:
    return {name for name in references(path) if name.startswith("compare.report")}


@pytest.mark.parametrize(
    "path",
    [
        path
        for floor, path in MODULES
        if name_of(floor, path).startswith(tuple(f"compare/{part}" for part in GENERIC))
    ],
    ids=str,
)
def test_what_is_for_any_system_knows_no_report(path: Path) -> None:
    assert not of_this_report(path)


# ---- manners -------------------------------------------------------------------------------------


def may_print(name: str) -> bool:
    return (
        name in ("compare/__main__.py", "compare/report/recover.py")
        or name.startswith(
            (
                "compare/console",
                "compare/verification_text",
                "compare/crosscheck_text",
                "compare/simulation/text",
                "compare/vehicle/write",
                "compare/commands/",
            )
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


# ---- what is shared ------------------------------------------------------------------------------


# their caches are of three tables
OF_PAPERS = ("compare/report/", "compare/publications/")


def arrays_of(thing: object) -> list[np.ndarray]:
    """An array, or those that a tuple, a mapping or a dataclass has."""
    if isinstance(thing, np.ndarray):
        return [thing]
    if isinstance(thing, dict):
        return [array for value in thing.values() for array in arrays_of(value)]
    if isinstance(thing, tuple):
        return [array for value in thing for array in arrays_of(value)]
    inside = vars(thing).values() if is_dataclass(thing) and not isinstance(thing, type) else ()
    return [value for value in inside if isinstance(value, np.ndarray)]


@pytest.mark.parametrize(
    "name",
    sorted(dotted(*module) for module in MODULES if not name_of(*module).startswith(OF_PAPERS)),
)
def test_what_a_module_shares_cannot_be_written_to(name: str) -> None:
    for key, value in vars(import_module(name)).items():
        if key == "__builtins__":  # not the module's own
            continue
        assert not any(array.flags.writeable for array in arrays_of(value)), key
        if hasattr(value, "cache_info") and inspect.signature(value).parameters:
            assert value.cache_info().maxsize is not None, f"{key} grows without end"


@pytest.mark.parametrize(
    ("cached", "given"),
    [
        ("floquet.trial_functions._gauss", ()),
        ("floquet.trial_functions._on_panels", (2, (0.0, 1.0), (1,))),
        ("floquet.trial_functions.eigenvalues", (3,)),
        ("floquet.trial_functions.trial_at", (2, 0.5)),
        ("hill.determinant.finite._gauss", ()),
        ("hill.matrices.modes.mode", (2,)),
        ("hill.matrices.stepped._bends", (2, 0.0, 0.6)),
        ("hill.matrices.stepped._mass_part", (2, 0.0, 0.6)),
        ("hill.matrices.stepped._pairs", (2, 0.0, 0.6)),
        ("hill.matrices.stepped._products", (2,)),
        ("hill.matrices.uniform._pairs", (2, 0.3)),
        ("hill.matrices.uniform._products", (2,)),
        ("hill.matrices.uniform.steady", (2, 20.0, 0.5, 0.5)),
    ],
)
def test_what_is_remembered_cannot_be_written_to(cached: str, given: tuple[float, ...]) -> None:
    found = arrays_of(named(cached)(*given))
    assert found
    assert not any(array.flags.writeable for array in found)


@pytest.mark.parametrize("name", sorted(dotted(*module) for module in MODULES))
def test_a_module_is_had_by_its_name(name: str) -> None:
    """No function of a package is called like a module in it: ``import name`` gives the module."""
    before, _, last = name.rpartition(".")
    if before:
        module = import_module(name)
        assert getattr(import_module(before), last) is module


def of_the_readme() -> set[str]:
    """Modules and folders that its table names; beside the first of a row, the others stand."""
    text = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
    found = set()
    for line in text.splitlines():
        parts = re.findall(r"`([\w/]+(?:\.py|/))`", line.split("|")[1]) if line[:3] == "| `" else []
        floor = parts[0].split("/")[0] if parts else ""
        if floor in FLOORS:
            found |= {part if part.startswith(floor) else f"{floor}/{part}" for part in parts}
    return found


def test_what_the_readme_names_is_there() -> None:
    there = {
        f"{floor}/{path.name}" + "/" * path.is_dir()
        for floor, root in ROOTS.items()
        for path in root.iterdir()
    }
    assert len(of_the_readme()) > 30
    assert of_the_readme() <= there
