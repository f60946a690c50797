"""What docs/charts.md says runs, and prints what it says."""

import contextlib
import io
import re
import runpy
import shlex
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

from compare.__main__ import main
from compare.stability.roots import growth
from compare.system_file import read
from floquet.batch import polynomials
from hill import HillEquation, UniformBeam

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "charts.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, flags=re.M | re.S)


@pytest.fixture
def aside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty place with the examples in sight."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_python_blocks_print_what_they_say(aside: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="needs the extra: cluster")
    namespace: dict[str, object] = {}
    seen = 0
    with distributed.LocalCluster(
        n_workers=1, processes=False, dashboard_address=":0", protocol="tcp"
    ) as local:
        for block in blocks("python"):
            runs = block.replace("tcp://scheduler:8786", local.scheduler_address)
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile(runs, "charts.md", "exec"), namespace)
            said = re.findall(r"^print\(.*\)  # (.*)$", block, flags=re.M)
            assert printed.getvalue().splitlines() == said
            seen += len(said)
    assert seen >= 5
    assert {p.name for p in aside.glob("*.nodes")} == {"mine.nodes", "far.nodes"}


def replaced(model: HillEquation, Omega: float, gamma: float) -> HillEquation:
    return HillEquation(F=model.F, G=model.G, gamma=gamma, Omega=Omega)


COMMANDS = [line for block in blocks("sh") for line in block.splitlines()]


@pytest.mark.parametrize("line", [line for line in COMMANDS if line.startswith("verify")])
def test_commands_run(line: str, aside: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = shlex.split(line)[1:]
    assert main(words) == 0
    (written,) = (words[k + 1] for k, w in enumerate(words) if w in ("--output", "--tongues"))
    assert (aside / written).stat().st_size > 0
    assert "evaluations of P" in capsys.readouterr().out


def test_file_is_a_file(tmp_path: Path) -> None:
    (text,) = blocks("toml")
    assert set(tomllib.loads(text)) == {"kind", "system", "forcing", "axis"}
    path = tmp_path / "mine.toml"
    path.write_text(text)
    assert read(path).system == UniformBeam(T0=15.0, K_theta=0.5, xi_G=0.5)
    assert read(path).forcing == {"eta": 0.01}
    assert [name for name, *_ in read(path).axes] == ["Omega", "gamma"]


def test_three_parameters(
    aside: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (line,) = [line for line in COMMANDS if line.startswith("python ")]
    words = shlex.split(line)[1:]
    monkeypatch.setattr(sys, "argv", words)
    runpy.run_path(words[0], run_name="__main__")
    printed = capsys.readouterr().out
    assert printed in blocks("text")
    # ... and one of its lines by direct evaluation at every point
    wanted = read(aside / "examples" / "three_parameters.toml")
    Omega, gamma, T0 = (np.linspace(low, high, count) for _, low, high, count in wanted.axes)
    assert T0[15] == 20.0
    beam = wanted.system
    mesh = [m.ravel() for m in np.meshgrid(Omega, gamma)]
    model = beam.equation(1.0, 0.1)
    P = polynomials([replaced(model, o, g) for o, g in zip(*mesh, strict=True)]).coefficients
    T = growth(P.T) * mesh[0] / np.pi
    _, share, largest = printed.splitlines()[4].split()
    # printed to a digit of a percent and to five decimals
    assert float(share.rstrip("%")) == pytest.approx(100.0 * np.mean(T > 1e-6), abs=0.06)
    assert float(largest) == pytest.approx(T.max(), abs=6e-6)
