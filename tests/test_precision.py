"""The word that results have for numbers whose bounds are wide."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import floquet.batch
import hill.batch
from compare import crosscheck
from compare.__main__ import main
from floquet import monodromy
from hill import Fourier, HillEquation, PeriodicEquation, characteristic
from hill.precision import POOR, poor_P, poor_T, remark
from hill.stability import stabilities

ORDINARY = HillEquation([[1.0, 0.3], [-0.2, 4.0]], [[0.5, 0.1], [0.2, -0.4]], 0.4, 2.1, 0.02)
# a double root on the boundary: T is 0, and nothing shows it
DOUBLE = HillEquation(np.eye(2) / 16, np.zeros((2, 2)), 0.0, 2.0)
GENERAL = PeriodicEquation(C=Fourier([[0.1]]), K=Fourier([[1.0]], cos={1: [[0.2]]}), Omega=1.3)
UNDAMPED = PeriodicEquation(C=Fourier([[0.0]]), K=Fourier([[1.0]]), Omega=1.0)


@pytest.mark.parametrize(
    ("T_error", "verdict", "error", "said"),
    [
        (0.9 * POOR, "unstable", 1e-15, ""),
        (1.1 * POOR, "unstable", 1e-15, "T is known to +- 2.4e-10 only"),
        (float("inf"), "unstable", 1e-15, "T is known to +- inf only"),
        (float("nan"), "unstable", 1e-15, "T is known to +- nan only"),
        (0.1, "undecided", 1e-15, "whether T is above 0 is not shown: T = 0.2 +- 1.0e-01"),
        (1e-13, "stable", 2e-8, "P is known to +- 1.0e-08 times its largest coefficient only"),
        (1e-3, "stable", 1.0, "T is known to +- 1.0e-03 only; P is known to +- 5.0e-01 times"),
    ],
)
def test_the_sentence(T_error: float, verdict: str, error: float, said: str) -> None:
    """Of T in units of Omega/pi, here 1, and of P in those of its largest coefficient, here 2."""
    found = remark(0.2, T_error, np.pi, verdict, [1.0, -2.0], error)
    assert found.startswith(said)
    assert bool(found) == bool(said)


def test_size_is_of_T_where_that_is_larger() -> None:
    assert poor_T([0.0, 1e3], 1e-8, np.pi).tolist() == [True, False]
    assert poor_P([[1.0, 0.0], [1.0, 1e3]], np.full(2, 1e-8)).tolist() == [True, False]


@pytest.mark.parametrize("solve", [characteristic, monodromy, crosscheck])
def test_every_result_has_a_word(solve: Any) -> None:
    for equation in (ORDINARY, GENERAL):
        assert solve(equation).verdict != "undecided"
        assert solve(equation).remark == ""
    for equation in (DOUBLE, UNDAMPED):
        found = solve(equation)
        assert found.verdict == "undecided"
        assert found.remark.startswith("whether T is above 0 is not shown: T = ")
        assert f"+- {found.T_error:.1e}" in found.remark


@pytest.mark.parametrize("batch", [floquet.batch, hill.batch])
def test_batches_mark_what_is_poor(batch: Any) -> None:
    """Each by its own size; and T of each, where two z meet too."""
    hard = HillEquation([[13.66, 0.0], [1.0, 1.0]], [[-0.912, 1.0], [0.0, 0.4]], 29.44, 1.41)
    found = batch.polynomials([ORDINARY, hard])
    expected = found.errors > POOR * np.max(np.abs(found.coefficients), axis=1)
    assert found.poor.tolist() == expected.tolist()
    errors = np.array([[0.0, 1e-15, 1e-15], [0.0, 1e-5, 1e-5]])
    judged = stabilities(
        np.tile(found.coefficients[0], (2, 1)), errors, np.full(2, 2.1), np.full(2, 0.02)
    )
    assert judged.poor.tolist() == [False, True]


def test_the_command_says_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = tmp_path / "double.toml"
    given.write_text(
        'kind = "matrices"\n[system]\nF = [[0.0625, 0.0], [0.0, 0.0625]]\n'
        "G = [[0.0, 0.0], [0.0, 0.0]]\n[forcing]\ngamma = 0.0\nOmega = 2.0\n"
    )
    for words, mark in (([], "Note: "), (["--format", "md"], "Note: "), (["--format", "csv"], "")):
        assert main(["system", str(given), *words]) == 0
        assert f"{mark}whether T is above 0 is not shown" in capsys.readouterr().out
    assert main(["system", str(given), "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    for found in (told, told["hill"], told["floquet"]):
        assert found["remark"].startswith("whether T is above 0 is not shown")
