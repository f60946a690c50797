"""Random general systems by both routes: a small sample of `python -m benchmarks.routes`."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from flint import arb

from benchmarks.routes import run
from benchmarks.routes.systems import KINDS, system
from compare import crosscheck


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_both_routes_agree(kind: str, seed: int) -> None:
    found = run.outcome(kind, seed, judge=False)
    assert found.agree
    assert not found.refused
    assert found.apart <= run.ASKED


def test_what_is_asked_for_is_drawn() -> None:
    """One to twelve multipliers, four harmonics, sines, and C that pulsates or decays strongly."""
    drawn = [system(kind, seed) for kind in KINDS for seed in range(20)]
    assert {e.order for e in drawn} == set(range(1, 13))
    second = [e for e in drawn if e.K is not None and e.C is not None]
    assert max(len(e.K.harmonics) for e in second) == 4
    assert any(e.C.harmonics and e.K.sin for e in second)
    assert max(np.max(e.C.mean) for e in second) > 15.0


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "found.json"
    words = ["--count", "2", "--classes", "sines", "reversible", "--json", str(path)]
    assert run.main(words) == 0
    told = capsys.readouterr().out
    assert all(len(line.rstrip()) <= 80 for line in told.splitlines())
    assert told.count("\nsines ") == 1
    assert len(json.loads(path.read_text())) == 4


def test_what_is_wrong_is_told() -> None:
    e = system("reversible", 2)
    x: Any = crosscheck(e)
    known = run.reference(e)
    assert known is not None
    assert run.wrong(x, e, known, paired=True) == ()
    # without its symmetry nothing would show that it is stable
    assert run.wrong(x, e, known, paired=False) == (
        "hill: stable, is boundary",
        "floquet: stable, is boundary",
    )
    off = [t + arb(1e-6) for t in known[:-1]] + known[-1:]
    assert "hill: a bound of P" in run.wrong(x, e, off, paired=True)
    other = SimpleNamespace(**{**vars(x.hill), "T": 1.0})
    told = run.wrong(SimpleNamespace(hill=other, floquet=x.floquet), e, known, paired=True)  # type: ignore[arg-type]
    assert told == ("hill: the bound of T",)
