"""Anybody's system by both routes: from Python, from a file, by the command."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import mmwrite, savemat

from compare import crosscheck
from compare.__main__ import main
from compare.system_file import read, with_settings
from hill import HillEquation, MatrixSystem, Parameter, System, UniformBeam
from hill.system import frequency_names, natural_frequencies, parameter_values, varied

F, G = [[2.0, -1.0], [-1.0, 2.0]], [[1.0, 0.0], [0.0, 1.0]]
SIMPLEST = """\
kind = "matrices"
[system]
F = [[2.0, -1.0], [-1.0, 2.0]]
G = [[1.0, 0.0], [0.0, 1.0]]
[forcing]
gamma = 0.15
Omega = 2.0
"""


@dataclass(frozen=True)
class CoupledMathieu:
    """Two Mathieu oscillators and a spring between them."""

    spring: float = 1.0
    parameters = (Parameter("spring", low=0.0, dependence="linear"),)

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
        k = self.spring
        return HillEquation([[1 + k, -k], [-k, 1 + k]], np.eye(2), gamma, Omega, eta)


def test_a_system_of_one_s_own() -> None:
    """Its modes are uncoupled Mathieu equations with the squares 1 and 1 + 2 k."""
    mine = CoupledMathieu(spring=0.8)
    assert isinstance(mine, System)
    x = crosscheck(mine, Omega=2.0, gamma=0.15)
    assert x.routes_agree
    assert x.shared_matrices
    alone = [crosscheck(HillEquation([[a]], [[1.0]], 0.15, 2.0)) for a in (1.0, 2.6)]
    expected = np.poly([one.hill.z[0].real for one in alone])
    assert np.abs(x.hill.polynomial - expected).max() <= x.hill.error + 1e-13
    assert x.verdict == "unstable"
    assert abs(x.T - alone[0].T) <= x.T_error + alone[0].T_error
    assert natural_frequencies(mine) == pytest.approx(np.sqrt([1.0, 2.6]))
    assert frequency_names(mine, 2) == ("1", "2")
    assert parameter_values(varied(mine, {"spring": 0.3})) == {"spring": 0.3}
    for name, value in (("sprung", 1.0), ("spring", -1.0), ("spring", float("nan"))):
        with pytest.raises(ValueError, match="spr"):
            varied(mine, {name: value})


def test_a_beam_has_two_sets_of_matrices() -> None:
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
    x = crosscheck(beam, Omega=1.1, gamma=0.1)
    assert x.routes_agree
    assert not x.shared_matrices
    assert 0.0 < x.matrices < 1e-13
    assert frequency_names(beam, 3) == ("B", "1", "2")


def test_an_equation_has_its_own_forcing() -> None:
    equation = HillEquation(F, G, 0.15, 2.0)
    assert crosscheck(equation).verdict == "unstable"
    with pytest.raises(ValueError, match="Omega"):
        crosscheck(equation, Omega=2.0)
    with pytest.raises(ValueError, match="gamma: has no value"):
        crosscheck(MatrixSystem(F, G), Omega=2.0)


def test_mass_and_terms() -> None:
    mass = [[2.0, 0.5], [0.5, 1.0]]
    one = MatrixSystem(F, G, M=mass, F_terms={"k": np.eye(2)}, values={"k": 0.5})
    other = np.linalg.solve(mass, np.add(F, 0.5 * np.eye(2)))
    assert pytest.approx(other, abs=1e-15) == one.equation(2.0, 0.1).F
    assert pytest.approx(np.linalg.solve(mass, F)) == one.varied(k=0.0).equation(2.0, 0.1).F
    assert [p.name for p in one.parameters] == ["k"]
    with pytest.raises(ValueError, match="M: must be nonsingular"):
        MatrixSystem(F, G, M=np.ones((2, 2)))
    with pytest.raises(ValueError, match="parameter = 'Omega'"):
        _ = MatrixSystem(F, G, F_terms={"Omega": np.eye(2)}).parameters


@pytest.fixture
def simplest(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(SIMPLEST)
    return path


def test_the_simplest_file(simplest: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["system", str(simplest), "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    expected = crosscheck(HillEquation(F, G, 0.15, 2.0))
    assert found["verdict"] == "unstable"
    assert found["routes_agree"]
    assert found["T"] == expected.T
    assert found["frequencies"]["2"][0] == pytest.approx(np.sqrt(3.0))
    assert len(found["floquet"]["multipliers"]) == 4
    assert found["doubling_time"] == pytest.approx(2.0 * np.log(2.0) / expected.T)


@pytest.mark.parametrize("form", ["text", "md", "csv"])
def test_forms(
    form: str, simplest: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["system", str(simplest), "--format", form]) == 0
    printed = capsys.readouterr().out
    assert "unstable" in printed.lower()
    target = tmp_path / f"out.{form}"
    assert main(["system", str(simplest), "--output", str(target)]) == 0
    assert "unstable" in target.read_text().lower()


def test_settings_change_what_is_asked(simplest: Path) -> None:
    found = with_settings(read(simplest), {"gamma": 0.0, "eta": 0.1})
    assert found.forcing == {"gamma": 0.0, "Omega": 2.0, "eta": 0.1}
    with pytest.raises(ValueError, match="did you mean Omega"):
        with_settings(read(simplest), {"Omgea": 1.0})


def write_npz(folder: Path) -> str:
    np.savez(folder / "m.npz", K=np.array(F))
    return "m.npz:K"


def write_mat(folder: Path) -> str:
    savemat(folder / "m.mat", {"K": np.array(F)})
    return "m.mat:K"


def write_mtx(folder: Path) -> str:
    mmwrite(folder / "m.mtx", np.array(F))
    return "m.mtx"


@pytest.mark.parametrize("write", [write_npz, write_mat, write_mtx])
def test_matrices_from_files(write: Any, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    name = write(tmp_path)
    path.write_text(SIMPLEST.replace("F = [[2.0, -1.0], [-1.0, 2.0]]", f'F = "{name}"'))
    assert read(path).system.equation(2.0, 0.1).F.tolist() == F


def test_beams_from_files(tmp_path: Path) -> None:
    path = tmp_path / "beam.toml"
    path.write_text(
        'kind = "uniform"\n[system]\nT0 = 20.0\nK_theta = 0.5\nxi_G = 0.5\nmodes = 3\n'
        "[forcing]\ngamma = 0.1\nOmega = 1.1\n"
    )
    assert read(path).system == UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=3)
    path.write_text('kind = "uniform"\n[system]\nT0 = 20.0\n')
    with pytest.raises(ValueError, match=r"system\.K_theta: has no value"):
        read(path)
