"""Systems of general periodic matrices: from Python, from files, by the command."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.io import mmwrite, savemat

from compare import crosscheck
from compare.__main__ import main
from compare.system_file import read
from hill import Fourier, PeriodicSystem
from hill.system import natural_frequencies

K1 = [[0.2, 0.0], [0.0, -0.2]]
S1 = [[0.0, 0.2], [0.2, 0.0]]

# An asymmetric rotor in the fixed frame: its stiffness turns with the shaft, twice a turn.
ROTOR = """\
kind = "matrices"
title = "asymmetric rotor"
[system]
K = { mean = [[1.0, 0.0], [0.0, 1.0]], cos.1 = [[0.2, 0.0], [0.0, -0.2]], sin.1 = "turned.mtx" }
[forcing]
Omega = 2.0
"""


def rotor(folder: Path) -> Path:
    mmwrite(str(folder / "turned.mtx"), np.array(S1))
    path = folder / "rotor.toml"
    path.write_text(ROTOR)
    return path


def test_a_rotor_from_a_file(tmp_path: Path) -> None:
    """In the rotating frame it has constant coefficients: +-sqrt(-2 + sqrt(4.04))."""
    found = read(rotor(tmp_path))
    assert found.forcing == {"gamma": 1.0, "Omega": 2.0}
    x = crosscheck(found.system, **found.forcing)
    assert x.routes_agree
    assert x.verdict == "unstable"
    assert abs(x.T - 2.0 * np.sqrt(-2.0 + np.sqrt(4.04))) <= x.T_error + 1e-15


def test_damping_that_pulsates(tmp_path: Path) -> None:
    """x'' + (24 + 10 sin t) x' + 10 cos t x = 0: exponents 0 and -24 (Bittanti, Colaneri)."""
    savemat(tmp_path / "mine.mat", {"S": [[10.0]]})
    (tmp_path / "mine.toml").write_text(
        'kind = "matrices"\n[system]\nK = { mean = [[0.0]], cos.1 = [[10.0]] }\n'
        'C = { mean = [[24.0]], sin.1 = "mine.mat:S" }\n[forcing]\nOmega = 1.0\n'
    )
    found = read(tmp_path / "mine.toml")
    x = crosscheck(found.system, **found.forcing)
    assert x.routes_agree
    assert x.verdict == "undecided"  # a multiplier is 1
    for route in (x.hill, x.floquet):
        assert np.abs(route.exponents - [0.0, -24.0]).max() < 24e-10


def test_first_order(tmp_path: Path) -> None:
    """Exponents -1 and -2 over the period pi (Zhou, Hagiwara)."""
    np.savez(tmp_path / "a.npz", c=[[0.5, 0.0], [0.0, -0.5]], s=[[0.0, -0.5], [-0.5, 0.0]])
    (tmp_path / "a.toml").write_text(
        'kind = "matrices"\n[system.A]\nmean = [[-1.5, 2.0], [-2.0, -1.5]]\n'
        'cos.1 = "a.npz:c"\nsin.1 = "a.npz:s"\n[forcing]\nOmega = 4.0\n'
    )
    found = read(tmp_path / "a.toml")
    x = crosscheck(found.system, **found.forcing)
    assert (x.routes_agree, x.verdict) == (True, "stable")
    assert abs(x.T + 2.0) <= x.T_error + 1e-15


def test_gamma_scales_the_harmonics_and_eta_adds_damping() -> None:
    M = np.diag([1.0, 2.0])
    system = PeriodicSystem(M=M, K=Fourier(np.diag([1.0, 8.0]), cos={1: K1}, sin={2: S1}))
    e = system.equation(1.3, 0.5, 0.1)
    assert np.array_equal(e.K.cos[1], 0.5 * np.array(K1))
    assert np.array_equal(e.K.sin[2], 0.5 * np.array(S1))
    assert np.array_equal(e.C.mean, 0.1 * M)
    assert natural_frequencies(system) == pytest.approx([1.0, 2.0])


@pytest.mark.parametrize("kind", ["text", "json", "md", "csv"])
def test_the_command(kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["system", str(rotor(tmp_path)), "--format", kind]) == 0
    said = capsys.readouterr().out
    assert "unstable" in said.lower()
    if kind == "json":
        found = json.loads(said)
        assert found["routes_agree"] is True
        assert len(found["hill"]["multipliers"]) == len(found["floquet"]["exponents"]) == 4


@pytest.mark.parametrize(
    ("system", "message"),
    [
        ("K = [[1.0]]\nF = [[1.0]]", "system.F, system.G: go without C, K and A"),
        ("C = [[1.0]]", "K, A: one of them must be there"),
        ("A = [[1.0]]\nM = [[1.0]]", "A: is of first order"),
        ("K = { cos.1 = [[1.0]] }", "system.K.mean: has no value"),
        ("K = { mean = [[1.0]], cos.0 = [[1.0]] }", "system.K.cos.0: the index must be a whole"),
        ("K = { mean = [[1.0]], sin.x = [[1.0]] }", "system.K.sin.x: the index must be a whole"),
        ("K = { mean = [[1.0]], cosine.1 = [[1.0]] }", "system.K.cosine: "),
        ("K = { mean = [[1.0]], cos = 1.0 }", "cos: must be a table"),
        ("K = [[1.0]]\nM = { mean = [[1.0]] }", "system.M: must be constant"),
        ("K = [[1.0]]\nM = [[0.0]]", "M: is singular"),
        ("K = [[1.0]]\nC = [[1.0, 0.0], [0.0, 1.0]]", "C has shape (2, 2): must be (1, 1) like K"),
        ('K = "none.npz:K"', "cannot be read"),
    ],
)
def test_bad_files(
    system: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(f'kind = "matrices"\n[system]\n{system}\n[forcing]\nOmega = 1.0\n')
    assert main(["system", str(path)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert re.search(re.escape(message), said), said
