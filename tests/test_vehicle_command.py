"""``verify vehicle``: what it says of the examples, and that both routes say it."""

import json
import re
from dataclasses import replace
from math import log, pi
from pathlib import Path
from typing import Any

import pytest

from compare import crosscheck
from compare.__main__ import main
from compare.vehicle.sensitivity import effects, same_effects
from compare.vehicle.study import Study, study
from compare.vehicle.words import moved, summary
from hill import Section, Sensor, Thrust, Vehicle

pytest.importorskip("skfem")

EXAMPLES = Path(__file__).parent.parent / "examples"
UNIFORM = str(EXAMPLES / "uniform.toml")


@pytest.fixture(scope="module")
def pulsed() -> Study:
    """Appendix A's first vehicle under three times its pulsation: some bands are open."""
    return study(Vehicle.from_file(UNIFORM), gamma=0.3, Omega=2.0 * pi, span=(1.0, 40.0), orders=1)


def answered(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str]:
    status = main(["vehicle", *words])
    return status, capsys.readouterr().out


def test_the_bands_are_the_routes_own(pulsed: Study) -> None:
    opened = [row for row in pulsed.rows if row.opens]
    assert opened
    for row in opened:
        assert row.band.edges is not None
        low, high = row.band.edges
        inside = crosscheck(pulsed.vehicle, Omega=row.band.Omega, gamma=0.3)
        assert inside.verdict == "unstable"
        assert pytest.approx(row.band.T, abs=1e-9) == inside.T
        off = 1e-3 * row.band.width
        for Omega, expected in ((low + off, "unstable"), (high - off, "unstable")):
            assert crosscheck(pulsed.vehicle, Omega=Omega, gamma=0.3).verdict == expected
        for Omega in (low - off, high + off):
            assert crosscheck(pulsed.vehicle, Omega=Omega, gamma=0.3).verdict == "stable"
        assert row.critical is not None
        assert 0.0 < row.critical < 0.3


def test_the_time_domain_agrees_on_every_band_it_is_asked_of(pulsed: Study) -> None:
    asked = [row.witnessed for row in pulsed.rows if row.witnessed]
    assert asked
    assert all(w.agrees and not w.another for w in asked)
    assert pulsed.routes_agree
    for row in pulsed.rows:
        if row.witnessed:
            assert row.witnessed.verdict == ("unstable" if row.opens else "stable")


def test_what_closes_a_band_is_not_open(pulsed: Study) -> None:
    closed = [row for row in pulsed.rows if not row.opens]
    assert closed
    assert all(row.critical is None or row.critical > 0.3 for row in closed)


def test_effects_are_slopes_of_T(pulsed: Study) -> None:
    """By the whole determinant, with other steps and on both sides."""
    row = next(row for row in pulsed.rows if row.opens)
    (found,) = effects(pulsed.vehicle, 0.3, 0.0, [row.band])
    assert len(found) == 3
    for effect in found:
        h = 1e-3 * effect.value
        sides = [
            crosscheck(
                pulsed.vehicle.varied(**{effect.name: effect.value + d}),
                Omega=row.band.Omega,
                gamma=0.3,
            ).T
            for d in (-h, h)
        ]
        assert effect.slope == pytest.approx((sides[1] - sides[0]) / (2.0 * h), rel=0.02)


def test_the_first_effects_are_both_routes(pulsed: Study) -> None:
    """The time domain's slopes, on its own elements; one that is wrong is told of."""
    asked = [row for row in pulsed.rows if any(e.witness is not None for e in row.effects)]
    assert len(asked) == 1
    (row,) = asked
    assert row.resonance == pulsed.rows[0].resonance
    assert same_effects(row.effects)
    for effect in row.effects:
        assert effect.witness == pytest.approx(effect.slope, rel=1e-3)
    first = row.effects[0]
    wrong = (replace(first, slope=1.01 * first.slope), *row.effects[1:])
    assert not same_effects(wrong)
    rows = tuple(replace(r, effects=wrong) if r is row else r for r in pulsed.rows)
    assert pulsed.routes_agree
    assert not replace(pulsed, rows=rows).routes_agree
    assert "THE ROUTES DISAGREE" in moved(replace(row, effects=wrong))
    assert moved(row).endswith(", by both routes")


def test_the_nearest_danger_is_the_nearest(pulsed: Study) -> None:
    _, danger = summary("it", pulsed)
    nearest = pulsed.open_rows[0]
    assert nearest.resonance.name in danger
    assert f"doubles every {2.0 * log(2.0) / nearest.band.T:.4g} s" in danger
    gaps = [abs(row.band.Omega - 2.0 * pi) for row in pulsed.rows if row.opens]
    assert abs(nearest.band.Omega - 2.0 * pi) <= min(gaps) + nearest.band.width


def test_appendix_A_is_safe(capsys: pytest.CaptureFixture[str]) -> None:
    status, out = answered(capsys, UNIFORM, "--order", "1")
    assert status == 0
    first, second = out.splitlines()[:2]
    assert first == (
        "Appendix A, example 1: SAFE at 1 Hz and a pulsation ratio of 0.1; both routes agree."
    )
    assert second.startswith("Nearest danger: omega_(1) + omega_(B) at 1.132 Hz, which opens at")
    assert "centre of mass 2400 in from the nose" in out
    # 26.58 of the report's two modes over its 5.1, test_the_report_s_buckling has the digits
    assert "buckling from 1.56952e+08 lbf, 5.213 times" in out
    assert "(shown safe below, but for gaps of up to 3e+04" in out


def test_the_readme_s_first_screen(capsys: pytest.CaptureFixture[str]) -> None:
    words = (str(EXAMPLES / "three_stage.toml"), "--closely", "6", "--both", "0")
    status, out = answered(capsys, *words, "--more-modes", "3")
    assert status == 0
    readme = (EXAMPLES.parent / "README.md").read_text(encoding="utf-8").splitlines()
    for line in out.splitlines()[:2]:
        assert f"> {line}" in readme[:40]


def test_a_vehicle_that_its_thrust_alone_shakes_apart(capsys: pytest.CaptureFixture[str]) -> None:
    # 26.58/5.1 of Appendix A's thrust is the limit of its beam with two modes
    status, out = answered(
        capsys, UNIFORM, "--set", "thrust=1.7e8", "--range", "4", "6", "--both", "0"
    )
    assert status == 0
    first, second = out.splitlines()[:2]
    assert "NOT SAFE at 1 Hz" in first
    assert "steady thrust alone is too much, from 1.57e+08 lbf on (buckling)" in second


def test_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    status, out = answered(
        capsys, UNIFORM, "--set", "gamma=0.3", "--range", "1", "1.3", "--format", "json"
    )
    assert status == 0
    content = json.loads(out)
    assert content["mass"] == pytest.approx(15600.0)
    assert content["units"]["frequency"] == "Hz"
    assert content["frequencies_without_thrust"][0] == pytest.approx(1.0, abs=1e-5)
    row = content["resonances"][0]
    assert row["name"] == "omega_(1) + omega_(B)"
    assert row["band"][0] < row["frequency"] < row["band"][1]
    assert row["doubling_time"] == pytest.approx(log(2.0) * row["time_constant"])
    assert row["witness"]["verdict"] == "unstable"
    assert len(row["effects"]) == 3
    more = {(x["resonance"], x["what"]): x for x in content["more_modes"]}
    own = more[row["name"], "width"]
    assert own["modes"] == [2, 4, 6, 8, 10, 12]
    assert own["values"][0] == pytest.approx(row["band"][1] - row["band"][0], rel=1e-9)
    assert more[row["name"], "T"]["values"][0] == row["T"]
    # 25.638 of the literature, in the file's units
    thrust, unit = more[None, "critical thrust"], 1.360644e14 / 4800.0**2
    assert abs(thrust["limit"] - 25.638 * unit) <= thrust["error_estimate"] + 5e-4 * unit
    assert content["steady_thrust"]["critical"] == thrust["values"][0]
    assert 0.0 < content["steady_thrust"]["resolution"] < 1e-3 * thrust["values"][0]


def test_more_modes_in_words(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    words = (UNIFORM, "--order", "1", "--both", "0", "--more-modes", "3")
    _, out = answered(capsys, *words)
    assert "With more modes, and the limit of all of them" in out
    assert re.search(r"2 modes +4 modes +8 modes +limit", out)
    assert re.search(r"steady thrust +critical +1.5695e\+08 +1.5261e\+08 +1.5162e\+08", out)
    path = tmp_path / "study.md"
    assert main(["vehicle", *words, "--output", str(path)]) == 0
    assert "2 modes | 4 modes | 6 modes | 8 modes | limit | +-" in path.read_text()


def test_the_study_of_a_damping_matrix(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = Path(UNIFORM).read_text()
    matrix = "matrix = [[0.06, 0.0, 0.0], [0.0, 0.06, 0.0], [0.0, 0.0, 0.06]]"
    path = tmp_path / "own.toml"
    path.write_text(text.replace("eta = 0.0628319", matrix))
    status, out = answered(capsys, str(path), "--order", "1", "--both", "0")
    assert status == 0
    assert "not known: the damping matrix fixes their number" in out


def test_as_markdown_into_a_file(tmp_path: Path) -> None:
    path = tmp_path / "study.md"
    assert main(["vehicle", UNIFORM, "--order", "1", "--both", "0", "--output", str(path)]) == 0
    lines = path.read_text().splitlines()
    assert lines[0].startswith("Appendix A, example 1: SAFE")
    assert "| resonance | type | at |" in path.read_text()
    assert "not asked" in path.read_text()


def test_without_an_operating_pulsation_the_range_is_judged() -> None:
    found = study(
        Vehicle(
            sections=(Section(1.0, 1.0, 1.0),),
            thrust=Thrust(5.0),
            sensors=(Sensor(0.5, 0.5),),
            modes=2,
            units="none",  # type: ignore[arg-type]
        ),
        gamma=0.1,
        orders=1,
        witness=0,
    )
    first, second = summary("it", found)
    assert "unstable bands" in first
    assert "no operating frequency is given" in first
    assert "unstable from" in second
    # without damping every resonance opens at once
    assert all(row.critical == 0.0 for row in found.rows if row.opens)


def test_routes_that_disagree_are_status_1(
    pulsed: Study, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = [
        replace(row, witnessed=replace(row.witnessed, agrees=False)) if row.witnessed else row
        for row in pulsed.rows
    ]
    monkeypatch.setattr(
        "compare.commands.vehicle.study", lambda *_, **__: replace(pulsed, rows=tuple(wrong))
    )
    status, out = answered(capsys, UNIFORM)
    assert status == 1
    assert "DISAGREE" in out


# What is wrong in a file, instead of what would be right; and what is said, behind its name.
WRONG = [
    ("EI = 1.0", "EJ = 1.0", "section[1].EJ: did you mean EI? It must be one of length, mass"),
    ("EI = 1.0", "EI = -1.0", "section[1].EI = -1: must be greater than 0"),
    ("EI = 1.0", "EI = nan", "section[1].EI = nan: must be finite"),
    ("mass_per_length = 1.0", "mass_per_length = 0.0", "section[1].mass_per_length = 0: must be"),
    ("length = 1.0", "length = '1'", "section[1].length = '1': must be a real number"),
    ("start = 1.0", "start = 0.5", "section[2].start = 0.5: overlaps the one ahead, which ends at"),
    ("start = 1.0", "start = 1.5", "section[2].start = 1.5: leaves a gap, which ends at 1"),
    ("station = 1.5", "station = 2.5", "sensor[1].station = 2.5: is outside the vehicle, must be"),
    ("station = 1.5", "", "sensor[1].station: has no value"),
    ("modes = 2", "modes = 61", "modes = 61: must be at most 60"),
    ("modes = 2", "modus = 2", "modus: did you mean modes? It must be one of"),
    ("units = 'SI'", "units.length = 'kg'", "units.length = 'kg': is a unit of mass, must be one"),
    ("units = 'SI'", "units.mass = 'lb'", "units.force = 'N': is not consistent, 1 lb m/s^2 is"),
    ("Omega = 5.0", "Omega = -5.0", "forcing.Omega = -5: must be greater than 0"),
    ("Omega = 5.0", "omega = 5.0", "forcing.omega: did you mean Omega? It must be one of"),
    ("[thrust]", "[thrust", "is not TOML"),
]

WHOLE = """kind = "vehicle"
modes = 2
units = 'SI'
[[section]]
length = 1.0
mass_per_length = 1.0
EI = 1.0
[[section]]
start = 1.0
end = 2.0
mass_per_length = 3.0
EI = 2.0
[[sensor]]
station = 1.5
[thrust]
mean = 3.0
[forcing]
gamma = 0.1
Omega = 5.0
"""


@pytest.mark.parametrize(("right", "wrong", "message"), WRONG, ids=[w for _, w, _ in WRONG])
def test_a_bad_file_is_one_line_with_file_key_and_value(
    right: str,
    wrong: str,
    message: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("compare.commands.vehicle.study", None)
    path = tmp_path / "mine.toml"
    path.write_text(WHOLE.replace(right, wrong, 1))
    assert right in WHOLE
    assert main(["vehicle", str(path)]) == 2
    caught = capsys.readouterr()
    assert caught.out == ""
    assert f"mine.toml: {message}" in caught.err
    assert len(caught.err.strip().splitlines()) == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([UNIFORM, "--set", "gamma=0"], "gamma = 0: must not be 0"),
        ([UNIFORM, "--range", "4", "2"], "--range 4 2: must ascend"),
        ([UNIFORM, "--range", "nan", "2"], "--range = nan: must be finite"),
        ([UNIFORM, "--order", "0"], "--order = 0: must be at least 1"),
        ([UNIFORM, "--both", "-1"], "--both = -1: must be at least 0"),
        ([UNIFORM, "--more-modes", "2"], "--more-modes = 2: must be at least 3"),
        ([UNIFORM, "--closely", "0"], "--closely = 0: must be at least 1"),
        ([UNIFORM, "--set", "Omega=-5"], "--set Omega = -5: must be greater than 0"),
        ([UNIFORM, "--set", "trust=3"], "did you mean thrust"),
        (["gone.toml"], "cannot be read"),
        ([str(EXAMPLES / "three_parameters.toml")], "must be 'vehicle'"),
        ([UNIFORM, "--output", "gone/s.md"], "cannot be written"),
    ],
)
def test_bad_input_is_one_line(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status: Any = None
    try:
        status = main(["vehicle", *words])
    except SystemExit as stop:
        status = stop.code
    caught = capsys.readouterr()
    assert status == 2
    assert caught.out == ""
    assert message in caught.err
    assert len(caught.err.strip().splitlines()) == 1


@pytest.mark.parametrize(
    "rest",
    ["", "[thrust]\nmean = 1.0\n", "[thrust]\nmean = 1.0\n[damping]\nratios = [0.1, 1.5]\n"],
    ids=["no thrust", "no sensor", "damped"],
)
def test_a_rigid_rotation_is_no_oscillation(
    rest: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Rounding makes its exponents 1e-7 or so, of any phase: no frequency, and no resonance."""
    given = tmp_path / "bar.toml"
    given.write_text(
        'kind = "vehicle"\nmodes = 2\n[[section]]\nlength = 1.0\nmass_per_length = 1.0\nEI = 1.0\n'
        f"[forcing]\ngamma = 0.1\nOmega = 3.0\n{rest}"
    )
    assert main(["vehicle", str(given), "--closely", "3", "--both", "3"]) == 0
    told = capsys.readouterr().out
    assert "both routes agree" in told
    assert "omega_(2)" not in told
