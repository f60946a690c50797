"""A system of somebody's own: charted, followed, differentiated, spread over workers, resumed.

Nothing here is known to the package: the classes are those of a user's script. Files of the package
to be changed for a new system: none.
"""

import json
import subprocess
import sys
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare import Chart, boundaries, chart, crosscheck, instabilities
from compare.__main__ import main
from compare.charts.identity import code_fingerprint, value_fingerprint
from compare.charts.nodes import Nodes
from compare.charts.scenario import scenario
from floquet import sensitivities, system_sensitivities
from hill import HillEquation, MatrixSystem, Parameter, Singular, characteristic
from hill.averaging import half_width
from hill.system import natural_frequencies

Float = np.ndarray[Any, Any]

M, K = np.array([[3.0, 1.0], [1.0, 1.0]]), np.array([[2.0, -1.0], [-1.0, 1.0]])
FOLLOWER = np.array([[1.0, -1.0], [0.0, 0.0]])


@dataclass(frozen=True)
class Ziegler:
    """Ziegler's column under P l/k = p (1 + gamma cos Omega t), which follows the upper rod.

    Rods of length l, masses 2m and m, springs k. H. Ziegler, Die Stabilitaetskriterien der
    Elastomechanik, Ingenieur-Archiv 20 (1952): flutter from p = 7/2 - sqrt 2 on.
    """

    p: float
    parameters = (Parameter("p", low=0.0, dependence="linear"),)
    frequency_names = ("low", "high")

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
        F, G = np.linalg.solve(M, K - self.p * FOLLOWER), np.linalg.solve(M, -self.p * FOLLOWER)
        return HillEquation(F, G, gamma, Omega, eta)


COLUMN = Ziegler(p=1.0)
AXES = [("Omega", 0.5, 3.5, 60), ("gamma", 0.0, 0.8, 40)]


@cache
def charted() -> Chart:
    return chart(COLUMN, AXES)


def test_its_frequencies_are_known() -> None:
    """2 w^4 - (7 - 2p) w^2 + 1 = 0: they meet at p = 7/2 - sqrt 2."""
    squares = np.roots([2.0, -5.0, 1.0])
    assert natural_frequencies(COLUMN) == pytest.approx(np.sqrt(np.sort(squares)), abs=1e-14)
    flutter = 3.5 - np.sqrt(2.0)
    assert np.all(natural_frequencies(Ziegler(flutter - 1e-6)).imag == 0.0)
    assert np.any(natural_frequencies(Ziegler(flutter + 1e-6)).imag != 0.0)


def test_a_chart_by_both_routes() -> None:
    c = charted()
    assert c.shared_matrices
    # the routes' own rounding: measured 6e-15
    assert 0.0 < c.disagreement < 1e-12
    assert c.routes_agree
    assert c.checked is not None
    assert c.checked <= c.error < 1e-10
    rng = np.random.default_rng(7)
    Omega, gamma = rng.uniform(0.5, 3.5, 30), rng.uniform(0.0, 0.8, 30)
    points = c.at(Omega=Omega, gamma=gamma)
    for k in range(30):
        own = crosscheck(COLUMN, Omega=float(Omega[k]), gamma=float(gamma[k]))
        assert own.shared_matrices
        assert abs(points.T[k] - own.T) <= points.T_error[k] + own.T_error
        assert "undecided" in (points.verdict[k], own.verdict) or points.verdict[k] == own.verdict
    assert 0.05 < c.unstable().mean() < 0.5


def test_T_has_its_own_error_on_the_grid() -> None:
    c = charted()
    x, y = (axis.points for axis in c.axes)
    inner = np.argwhere(c.T > 1e-3)
    for j, i in inner[:: len(inner) // 15]:
        own = characteristic(COLUMN.equation(float(x[i]), float(y[j])))
        assert abs(c.T[j, i] - own.T) <= c.T_error()[j, i] + own.T_error
    # z real, simple and within (-1, 1): T is 0 and known to be
    assert np.all(c.T_error()[c.verdict() == "stable"] < 1e-14)


def test_its_tongues_have_its_own_names() -> None:
    found = {i.resonance.name: i for i in instabilities(charted(), orders=1)}
    assert set(found) >= {"2 omega_(high)", "2 omega_(low)", "omega_(high) - omega_(low)"}
    # the sum is no instability where G_ij G_ji is negative, and the difference is
    assert "omega_(high) + omega_(low)" not in found
    for name, i in found.items():
        k = 4
        equation = COLUMN.equation(1.0, float(i.tongue.y[k]))
        # first order; gamma is .084 there, and the miss of second order
        expected = 2.0 * half_width(i.resonance, equation)
        assert i.tongue.upper[k] - i.tongue.lower[k] == pytest.approx(expected, rel=0.06), name
        middle = 0.5 * (i.tongue.lower[k] + i.tongue.upper[k])
        inside = crosscheck(COLUMN, Omega=middle, gamma=float(i.tongue.y[k]))
        assert inside.verdict == "unstable"


def test_where_flutter_begins_is_a_boundary() -> None:
    """Without pulsation at p = 7/2 - sqrt 2, whatever Omega is taken for the period."""
    pytest.importorskip("contourpy")
    c = chart(
        COLUMN, [("p", 1.8, 2.3, 20), ("eta", 0.0, 0.02, 20)], forcing={"Omega": 3, "gamma": 0}
    )
    at = [curve for curve in boundaries(c) if np.ptp(curve.x) < 1e-2 and curve.y.min() < 1e-9]
    (edge,) = (float(curve.x[curve.y.argmin()]) for curve in at if curve.kind == "pair")
    assert edge == pytest.approx(3.5 - np.sqrt(2.0), abs=1e-8)


# ---- sensitivities -------------------------------------------------------------------------------


@dataclass(frozen=True)
class Rotor:
    """Everything moves: F with Omega, the pulsation and the damping with parameters of its own."""

    stiffness: float = 1.3
    depth: float = 0.7
    loss: float = 0.02
    length: float = 2.0
    parameters = (
        Parameter("stiffness", dependence="linear", moves=("F",)),
        Parameter("depth", 0.0, 1.0),
        Parameter("loss", 0.0),
        Parameter("length", 0.0, smooth="reciprocal"),
    )

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
        spin = 0.05 * Omega**2
        F = [[self.stiffness + spin, 0.2], [0.1, 1.0 / self.length**2 + 2.0]]
        G = [[1.0, 0.3 * np.sin(self.length)], [0.4, 0.5]]
        return HillEquation(F, G, self.depth * gamma, Omega, eta + self.loss)


def T_of(system: Any, **forcing: float) -> float:
    return characteristic(system.equation(**forcing)).T


@pytest.mark.parametrize(
    ("system", "forcing"),
    [
        (Rotor(), {"Omega": 2.6, "gamma": 0.6, "eta": 0.0}),
        (Rotor(length=0.8), {"Omega": 2.4, "gamma": 0.8, "eta": 0.01}),
        (COLUMN, {"Omega": 3.0, "gamma": 0.3, "eta": 0.01}),
        (
            MatrixSystem(
                [[2, -1], [-1, 2]], [[1, 0], [0, 1]], F_terms={"k": np.eye(2)}, values={"k": 0.1}
            ),
            {"Omega": 2.1, "gamma": 0.3, "eta": 0.01},
        ),
    ],
    ids=["rotor", "short rotor", "Ziegler", "matrices"],
)
def test_derivatives_are_differences_of_the_other_route(
    system: Any, forcing: dict[str, float]
) -> None:
    s = system_sensitivities(system, **forcing)
    assert s.shared_matrices
    assert s.T > 1e-3
    names = [p.name for p in system.parameters]
    assert list(s.values) == ["Omega", "gamma", "eta", *names]
    for name in s.values:
        step = 1e-4
        sides = []
        for sign in (2, 1, -1, -2):
            at = forcing | ({name: forcing[name] + sign * step} if name in forcing else {})
            own = {name: s.values[name] + sign * step} if name in names else {}
            moved = system.varied(**own) if hasattr(system, "varied") else replace(system, **own)
            sides.append(T_of(moved, **at))
        far, near, back, rear = sides
        expected = (8.0 * (near - back) - (far - rear)) / (12.0 * step)
        # fourth order in 1e-4 and T's own 1e-13 over it: 1e-9
        assert abs(s.dT[name] - expected) <= s.dT_error[name] + 1e-8, name
        assert s.dT_error[name] < 1e-9
    assert sum(abs(s.dT[name]) > 1e-4 for name in s.values) >= 3


@pytest.mark.parametrize(
    ("parameter", "says"),
    [
        (Parameter("x", dependence="linear"), "x: says that its dependence is linear"),
        (Parameter("x", moves=("G",)), "x: says that it moves G, and it moves others too"),
    ],
)
def test_what_a_parameter_says_is_held_against_the_matrices(
    parameter: Parameter, says: str
) -> None:
    @dataclass(frozen=True)
    class Liar:
        x: float = 1.0
        parameters = (parameter,)

        def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
            return HillEquation([[1.0 + self.x**2]], [[1.0]], gamma, Omega, eta)

    with pytest.raises(ValueError, match=says):
        system_sensitivities(Liar(), Omega=2.8, gamma=0.3)


def test_a_kink_has_no_derivative() -> None:
    @dataclass(frozen=True)
    class Kinked:
        x: float = 1.0
        parameters = (Parameter("x"),)

        def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
            return HillEquation([[2.0 + abs(self.x - 1.0)]], [[1.0]], gamma, Omega, eta)

    own = sensitivities(Kinked().equation(2.8, 0.3)).dT.F[0, 0]
    assert abs(own) > 1e-3
    # whichever side is meant, the bound has it
    assert system_sensitivities(Kinked(), Omega=2.8, gamma=0.3).dT_error["x"] > abs(own)
    assert abs(system_sensitivities(Kinked(1.2), Omega=2.8, gamma=0.3).dT_error["x"]) < 1e-9


# ---- promises, poles, refusals -------------------------------------------------------------------


def test_a_broken_promise_is_refused() -> None:
    class Promising(Rotor):
        depends_on_Omega = False

    with pytest.raises(ValueError, match=r"Promising\.depends_on_Omega = False: promises F and G"):
        chart(Promising(), AXES)


@dataclass(frozen=True)
class Absorber:
    """A mass with an undamped absorber condensed out: G has a pole at the absorber's frequency."""

    tuning: float
    parameters = (Parameter("tuning", 0.0),)
    depends_on_Omega = True

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
        gap = 1.0 - (Omega / self.tuning) ** 2
        if gap == 0.0:
            raise Singular(f"Omega = {Omega:g}: is the absorber's own frequency")
        return HillEquation([[1.0]], [[1.0 + 0.01 / gap]], gamma, Omega, eta)

    def singular_Omega(self, low: float, high: float) -> list[float]:
        return [self.tuning] if low <= self.tuning <= high else []


def test_poles_are_where_the_system_says() -> None:
    c = chart(Absorber(2.2), [("Omega", 1.6, 2.6, 101), ("gamma", 0.0, 0.3, 20)], route="hill")
    assert 0 < c.direct < c.T.size / 2
    assert "a pole is near" in c.one_by_one
    on = np.flatnonzero(np.isclose(c.axes[0].points, 2.2))
    assert np.all(c.undecided()[:, on] | (c.T[:, on] < np.inf))
    with pytest.raises(ValueError, match=r"Omega = 2\.2: is the absorber's own frequency"):
        c.at(Omega=2.2, gamma=0.1)
    there = c.at(Omega=[1.9, 2.19, 2.3], gamma=0.3)
    for Omega, T, error in zip((1.9, 2.19, 2.3), there.T, there.T_error, strict=True):
        own = characteristic(Absorber(2.2).equation(Omega, 0.3))
        assert abs(T - own.T) <= error + own.T_error


def test_a_pole_that_passes_through_is_seen() -> None:
    """The pole is where the tuning is: in no corner of the first box, and in its middle."""
    c = chart(
        Absorber(2.0), [("Omega", 1.9, 2.1, 30), ("tuning", 1.7, 2.4, 30)], forcing={"gamma": 0.2}
    )
    assert c.direct > 0
    assert c.error < 1e-6


def test_refusals() -> None:
    with pytest.raises(ValueError, match="system = int: must have parameters and equation"):
        chart(3, AXES)  # type: ignore[arg-type]

    class Odd(Ziegler):
        def equation(self, *_: Any) -> Any:  # type: ignore[override]
            return "no equation"

    with pytest.raises(
        ValueError,
        match=r"Odd\.equation: must give a HillEquation or a Peri",
    ):
        chart(Odd(1.0), AXES)
    dashpots = MatrixSystem([[1.0]], [[1.0]])
    other = type("Other", (Ziegler,), {})(1.0)
    object.__setattr__(other, "equation", lambda x, g, e=0.0: HillEquation(K, M, g, 2.0 * x, e))
    with pytest.raises(ValueError, match=r"Omega = 0\.5: the equation's own is 1; it must be"):
        chart(other, AXES)
    with pytest.raises(ValueError, match="axis = 'p'"):
        chart(dashpots, [("p", 0.0, 1.0, 5), ("Omega", 1.0, 2.0, 5)], forcing={"gamma": 0.1})
    with pytest.raises(ValueError, match="length from 0: must be greater than 0"):
        chart(Rotor(), [("length", 0.0, 1.0, 5), ("Omega", 1.0, 2.0, 5)], forcing={"gamma": 0.1})


# ---- whose nodes ---------------------------------------------------------------------------------


def test_two_systems_never_share_a_file(tmp_path: Path) -> None:
    path = tmp_path / "nodes"

    def held(system: Any) -> Nodes:
        return Nodes(scenario(system, AXES), "hill", map, path)

    held(COLUMN)
    assert held(Ziegler(p=1.0)).resumed == 0
    with pytest.raises(ValueError, match=r"another chart \(fixed = "):
        held(Ziegler(p=1.5))
    with pytest.raises(ValueError, match=r"another chart \(system = "):
        held(Rotor())
    # the same name, the same numbers, another equation
    other = type("Ziegler", (), dict(vars(Ziegler)) | {"equation": Rotor.equation})
    assert code_fingerprint(object.__new__(other)) != code_fingerprint(COLUMN)
    one, two = (MatrixSystem(np.eye(2) * k, np.eye(2)) for k in (1.0, 2.0))
    path.unlink()
    held(one)
    with pytest.raises(ValueError, match=r"another chart \(values = "):
        held(two)


def test_a_varied_parameter_s_own_value_does_not_matter() -> None:
    axes = [("p", 0.5, 1.5, 5), ("Omega", 1.0, 2.0, 5)]
    owners = [
        Nodes(scenario(Ziegler(p), axes, {"gamma": 0.1}), "hill", map).owner for p in (0.7, 1.2)
    ]
    assert owners[0] == owners[1]


def test_fingerprints_see_code_and_what_it_names() -> None:
    source = """
from hill import HillEquation, Parameter
SCALE = {scale}
def helper(x):
    return x * SCALE{more}
class Mine:
    parameters = (Parameter("x"),)
    x = 1.0
    def equation(self, Omega, gamma, eta=0.0):
        # {comment}
        return HillEquation([[helper(self.x)]], [[1.0]], gamma, Omega, eta)
"""

    def print_of(**words: Any) -> str:
        space: dict[str, Any] = {}
        exec(source.format(**({"scale": 2.0, "more": "", "comment": "one"} | words)), space)
        return code_fingerprint(space["Mine"]())

    assert print_of() == print_of(comment="another")
    assert len({print_of(), print_of(scale=3.0), print_of(more=" + 1.0")}) == 3


def test_values_are_told_apart() -> None:
    values: list[Any] = [1, 1.0, True, "1", [1], (1,), {"a": 1}, {"a": 2}, {1}, None, np.eye(2)]
    values += [np.eye(3), np.zeros((2, 2)), COLUMN, Ziegler(2.0), [COLUMN], np.inf, -0.0, 0.0]
    assert len({value_fingerprint(value) for value in values}) == len(values)
    with pytest.raises(ValueError, match="cannot be told apart"):
        value_fingerprint(x for x in ())


# ---- a script of the user's, workers, a cluster, files -------------------------------------------

MODULE = '''
from dataclasses import dataclass
import numpy as np
from hill import HillEquation, Parameter

@dataclass(frozen=True)
class Column:
    """A double pendulum under a pulsating follower force."""
    p: float = 1.0
    parameters = (Parameter("p", low=0.0, dependence="linear"),)
    frequency_names = ("low", "high")

    def equation(self, Omega, gamma, eta=0.0):
        M, K, S = [[3, 1], [1, 1]], np.array([[2, -1], [-1, 1]]), np.array([[1, -1], [0, 0]])
        F, G = np.linalg.solve(M, K - self.p * S), np.linalg.solve(M, -self.p * S)
        return HillEquation(F, G, gamma, Omega, eta)
'''

SCRIPT = """
import sys
import numpy as np
from compare import chart, over
{own}
AXES = [("Omega", 1.0, 3.5, 9), ("gamma", 0.0, 0.5, 9), ("p", 0.5, 1.5, 5)]

def made(**words):
    return chart(Column(), AXES, tolerance=1e-6, **words)

if __name__ == "__main__":
    here = made(resume="here.nodes")
    assert here.nodes > 512 and here.resumed == 0
    again = made(resume="here.nodes")
    assert again.resumed == again.nodes == here.nodes
    two = made(workers=2)
    assert np.array_equal(here.T, two.T)
    from distributed import Client, LocalCluster
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as local:
        with Client(local) as client:
            far = made(workers=over(client), resume="far.nodes")
            assert np.array_equal(here.T, far.T)
            assert made(workers=over(client), resume="far.nodes").resumed == here.nodes
    print("the same", here.nodes, float(np.max(here.T)))
"""


@pytest.mark.parametrize("own", ["script", "module"])
def test_workers_a_cluster_and_resume(own: str, tmp_path: Path) -> None:
    """In the script itself, or in a module beside it that no worker of the cluster has."""
    pytest.importorskip("distributed")
    (tmp_path / "columns.py").write_text(MODULE)
    head = MODULE if own == "script" else "from columns import Column"
    script = tmp_path / "run.py"
    script.write_text(SCRIPT.format(own=head))
    found = subprocess.run(
        [sys.executable, str(script)], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert found.returncode == 0, found.stderr
    assert found.stdout.startswith("the same ")


def test_a_class_that_no_process_can_have_is_one_line() -> None:
    @dataclass(frozen=True)
    class Local(Ziegler):
        pass

    with pytest.raises(ValueError, match="workers: a job cannot be sent to another process"):
        chart(Local(1.0), AXES, route="hill", workers=2)


FILE = """
kind = "python"
title = "Ziegler's column"
[system]
class = "columns.py:Column"
p = 1.0
[forcing]
gamma = 0.3
Omega = 3.0
eta = 0.01
[[axis]]
name = "Omega"
low = 0.9
high = 3.5
count = 60
[[axis]]
name = "gamma"
low = 0.0
high = 0.5
count = 40
"""


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "columns", raising=False)
    (tmp_path / "columns.py").write_text(MODULE)
    path = tmp_path / "column.toml"
    path.write_text(FILE)
    return path


def test_the_commands_take_it_from_a_file(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["system", str(file), "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["verdict"], told["shared_matrices"]) == ("unstable", True)
    assert list(told["frequencies"]) == ["low", "high"]

    assert main(["sensitivity", str(file), "--format", "json"]) == 0
    rows = {row["name"]: row for row in json.loads(capsys.readouterr().out)["parameters"]}
    s = system_sensitivities(COLUMN, Omega=3.0, gamma=0.3, eta=0.01)
    assert rows["p"]["dT"] == s.dT["p"] != 0.0

    for suffix in ("png", "json", "csv", "npz"):
        words = ["chart", str(file), "--output", str(tmp_path / f"c.{suffix}")]
        assert main([*words, "--tongues", str(tmp_path / "t.csv")]) == 0
        out = capsys.readouterr().out
        assert "2 omega_(high)" in out
        assert "with the same matrices" in out
    content = json.loads((tmp_path / "c.json").read_text())
    assert content["system"] == "columns.Column"
    assert content["schema"] == 1
    assert np.shape(content["T"]) == np.shape(content["T_error"]) == (40, 60)
    first, head, *lines = (tmp_path / "t.csv").read_text().splitlines()
    assert json.loads(first.removeprefix("# "))["parameters"] == {"p": 1.0}
    assert head.startswith("resonance,type,order,crossing,gamma")
    assert lines[0].startswith("2 omega_(high)")


def test_an_axis_may_be_typed_in_place_of_the_file_s(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["chart", str(file), "--x", "p", "0.5", "1.5", "9", "--y", "gamma", "0", "0.5", "8"]
    assert main([*words, "--route", "hill"]) == 0
    assert "9 x 8 points" in capsys.readouterr().out
    assert main([*words, "--set", "p=1"]) == 2
    assert "--set p: is an axis" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (('"columns.py:Column"', '"columns.py:Columns"'), "columns.py has no class Columns"),
        (('"columns.py:Column"', '"gone.py:Column"'), "gone.py is not there"),
        (('"columns.py:Column"', '"columns.py"'), 'must be "file.py:Class"'),
        (('"columns.py:Column"', '"nowhere.at_all:X"'), "nowhere.at_all cannot be imported"),
        (("p = 1.0", "q = 1.0"), "system.q: must be one of p"),
        (("p = 1.0", 'p = "x"'), ""),
    ],
)
def test_a_file_that_is_wrong_is_one_line(
    change: tuple[str, str], says: str, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file.write_text(FILE.replace(*change))
    assert main(["chart", str(file), "--route", "hill"]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert says in error
