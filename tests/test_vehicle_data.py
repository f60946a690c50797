"""A vehicle's data: what is stored, where the parts are, and every line that refuses bad input."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.system_file import read, with_settings
from hill import Damping, PointMass, Section, Sensor, Thrust, Units, Vehicle
from hill.system import parameter_values, varied

EXAMPLES = Path(__file__).parents[1] / "examples"
VEHICLES = ("uniform", "stepped", "three_stage", "beck", "pflueger")

FILE = """\
kind = "vehicle"
title = "mine"
units = "SI"
modes = 3
ends = ["free", "free"]

[[section]]
name = "tank"
length = 2.0
mass_per_length = [3.0, 5.0]
EI = 7.0
EA = 90.0

[[section]]
start = 2.0
end = 5.0
mass_per_length = 4.0
EI = [7.0, 2.0]
rotary_inertia = 0.1
kGA = 60.0

[[mass]]
name = "engine"
station = 5.0
mass = 6.0
rotary_inertia = 0.2

[thrust]
mean = 0.5
station = 4.5
direction = "fixed"

[[sensor]]
station = 1.0
K_theta = 0.5

[[sensor]]
station = 3.0
K_rate = 0.25

[servo]
time_constant = 0.05

[damping]
ratios = [0.01, 0.02]
eta = 0.001

[axial]
g = 0.03
damping = "hysteretic"
quadrature_force = false

[forcing]
gamma = 0.1
Omega = 2.0
"""


def test_a_file_says_it_all(tmp_path: Path) -> None:
    (tmp_path / "v.toml").write_text(FILE)
    found = read(tmp_path / "v.toml")
    expected = Vehicle(
        sections=(
            Section(2.0, (3.0, 5.0), 7.0, 90.0, name="tank"),
            Section(3.0, 4.0, (7.0, 2.0), rotary_inertia=0.1, kGA=60.0),
        ),
        masses=(PointMass(5.0, 6.0, 0.2, "engine"),),
        thrust=Thrust(0.5, 4.5, "fixed"),
        sensors=(Sensor(1.0, K_theta=0.5), Sensor(3.0, K_rate=0.25)),
        servo_time=0.05,
        damping=Damping((0.01, 0.02), 0.001),
        g=0.03,
        axial_damping="hysteretic",
        quadrature_force=False,
        modes=3,
    )
    assert found.system == Vehicle.from_file(tmp_path / "v.toml") == expected
    assert found.forcing == {"gamma": 0.1, "Omega": 2.0}
    assert expected.edges == (0.0, 2.0, 5.0)
    assert expected.thrust_station == 4.5
    assert expected.coordinates == 4
    assert expected.frequency_names == ("B", "1", "2", "3")
    assert expected.depends_on_Omega
    assert expected.sections[0].EI == (7.0, 7.0)
    assert expected.units.frequency == "Hz"


@pytest.mark.parametrize("name", VEHICLES)
def test_the_examples_are_vehicles(name: str) -> None:
    found = read(EXAMPLES / f"{name}.toml")
    assert isinstance(found.system, Vehicle)
    assert found.forcing.keys() == {"gamma", "Omega"}


def test_the_three_stages_weigh_what_nastran_says() -> None:
    """Demonstration problem 10-1-1: mass 85000, centre at 116.1765 from the other end."""
    v = Vehicle.from_file(EXAMPLES / "three_stage.toml")
    mass = [s.length * s.mass_per_length[0] for s in v.sections]
    middle = [a + s.length / 2 for a, s in zip(v.edges, v.sections, strict=False)]
    assert sum(mass) == 85000.0
    assert 300.0 - np.dot(mass, middle) / 85000.0 == pytest.approx(116.1765, abs=5e-5)
    assert v.units.length == "in"


def test_ends_and_rotation() -> None:
    one = Section(1.0, 1.0, 1.0)
    for ends, rotates in (
        (("free", "free"), True),
        (("pinned", "free"), True),
        (("free", "pinned"), True),
        (("clamped", "free"), False),
        (("pinned", "pinned"), False),
        (("clamped", "pinned"), False),
    ):
        v = Vehicle(sections=(one,), ends=ends, modes=3)  # type: ignore[arg-type]
        assert v.rotates == rotates
        assert v.coordinates == 3 + rotates == len(v.frequency_names)


def test_what_varies() -> None:
    v = Vehicle.from_file(EXAMPLES / "three_stage.toml")
    values = parameter_values(v)
    assert values["thrust"] == 2e7
    assert values["EI_stage2"] == 2.08e11
    for name, value in values.items():
        other = varied(v, {name: 1.5 * value})
        assert parameter_values(other) == values | {name: 1.5 * value}
    two = Vehicle(
        sections=(Section(1.0, 1.0, 1.0, 5.0),) * 2,
        masses=(PointMass(0.5, 2.0, name="payload"), PointMass(2.0, 3.0)),
        sensors=(Sensor(0.1), Sensor(0.2)),
        thrust=Thrust(1.0, 1.5),
        servo_time=0.1,
    )
    names = {
        *("thrust", "thrust_station", "servo_time", "g", "mass_payload", "station_payload"),
        *("mass_2", "station_2", "K_theta_1", "K_rate_2", "sensor_station_2", "EA_1", "m_2"),
    }
    assert names <= set(two.values)
    for name in names:
        assert varied(two, {name: 0.75}).values == two.values | {name: 0.75}
    with pytest.raises(ValueError, match="thrust_station"):
        varied(two, {"thrust_station": 2.5})
    long = Vehicle(sections=(Section(1.0, 1.0, 1.0),) * 50)
    assert set(long.values) == {"thrust"}


def test_settings_reach_a_vehicle() -> None:
    found = with_settings(read(EXAMPLES / "beck.toml"), {"thrust": 12.0, "gamma": 0.3})
    assert found.system.thrust.mean == 12.0  # type: ignore[attr-defined]
    assert found.forcing["gamma"] == 0.3
    with pytest.raises(ValueError, match="did you mean thrust"):
        with_settings(found, {"trust": 1.0})


def test_the_aft_end_as_typed() -> None:
    """Ten times 0.1 is not 1, and 1 is the aft end all the same."""
    v = Vehicle(sections=(Section(0.1, 1.0, 1.0),) * 10, masses=(PointMass(1.0, 1.0),))
    assert v.length != 1.0
    assert v.masses[0].station == v.length == v.thrust_station


# ---- station tables ------------------------------------------------------------------------------

TABLE = """\
station, EI, mass_per_length, EA
0,   2.0, 1.0, 10
1.0, 2.5, 1.5, inf
# a step
1.0, 3.0, 1.5, 10

4.0, 3.0, 2.0, 20
"""


def described(folder: Path, table: str) -> Vehicle:
    (folder / "s.csv").write_text(table)
    (folder / "v.toml").write_text('kind = "vehicle"\nstations = "s.csv"\n')
    return Vehicle.from_file(folder / "v.toml")


def test_a_station_table(tmp_path: Path) -> None:
    v = described(tmp_path, TABLE.replace("inf", "12"))
    assert v.edges == (0.0, 1.0, 4.0)
    assert v.sections == (
        Section(1.0, (1.0, 1.5), (2.0, 2.5), (10.0, 12.0)),
        Section(3.0, (1.5, 2.0), 3.0, (10.0, 20.0)),
    )


BAD_TABLES = {
    "half infinite": (TABLE, "line 3: EA = [10.0, inf]"),
    "text": (TABLE.replace("2.5", "steel"), "line 3: EI = 'steel': must be a number"),
    "missing value": (TABLE.replace("2.5,", ","), "line 3: EI: has no value"),
    "short row": (TABLE.replace(", 12", "").replace(", inf", ""), "line 3: has 3 values"),
    "zero": (TABLE.replace("inf", "12").replace("2.5", "0"), "line 3: EI = 0"),
    "negative": (TABLE.replace("inf", "12").replace("2.0, 20", "-2.0, 20"), "mass_per_length = -2"),
    "descending": (TABLE.replace("4.0,", "0.5,").replace("inf", "12"), "line 7: station = 0.5"),
    "column": (TABLE.replace("EI", "ei"), "line 1: column ei: did you mean EI?"),
    "no EI": ("station,mass_per_length\n0,1\n1,1\n", "line 1: has no column EI"),
    "twice": ("station,EI,EI,mass_per_length\n0,1,1,1\n", "line 1: has a column twice"),
    "one": ("station,EI,mass_per_length\n0,1,1\n", "has fewer than two stations"),
    "empty": ("", "is empty"),
    "nose": (
        "station,EI,mass_per_length\n1,1,1\n2,1,1\n",
        "line 2: station = 1: the first must be",
    ),
    "thrice": (
        "station,EI,mass_per_length\n0,1,1\n1,1,1\n1,1,1\n1,1,1\n2,1,1\n",
        "line 5: station = 1: is there three times",
    ),
    "step at the end": (
        "station,EI,mass_per_length\n0,1,1\n1,1,1\n1,2,1\n",
        "line 4: station = 1: is there twice, at an end",
    ),
    "nan": (TABLE.replace("2.5", "nan"), "line 3: EI = nan: must be finite"),
}


@pytest.mark.parametrize("case", BAD_TABLES)
def test_a_bad_table_is_one_line(case: str, tmp_path: Path) -> None:
    table, named = BAD_TABLES[case]
    with pytest.raises(ValueError, match=r"s\.csv") as caught:
        described(tmp_path, table)
    line = str(caught.value)
    assert named in line
    assert line.startswith(f"{tmp_path / 'v.toml'}: stations = 's.csv': ")
    assert "\n" not in line


def test_no_table(tmp_path: Path) -> None:
    (tmp_path / "v.toml").write_text('kind = "vehicle"\nstations = "gone.csv"\n')
    with pytest.raises(ValueError, match=r"gone\.csv.*no such file"):
        Vehicle.from_file(tmp_path / "v.toml")


# ---- files ---------------------------------------------------------------------------------------

BAD_FILES = {
    "key": (FILE.replace("modes =", "mode ="), "mode: did you mean modes?"),
    "section key": (FILE.replace("EI = 7.0", "Ei = 7.0"), "section[1].Ei: did you mean EI?"),
    "mass key": (FILE.replace("mass = 6.0", "mas = 6.0"), "mass[1].mas: did you mean mass?"),
    "sensor key": (FILE.replace("K_theta", "K_teta"), "sensor[1].K_teta: did you mean K_theta?"),
    "thrust key": (FILE.replace("mean", "men"), "thrust.men: did you mean mean?"),
    "servo key": (
        FILE.replace("time_constant", "time_const"),
        "servo.time_const: did you mean time_constant?",
    ),
    "damping key": (FILE.replace("ratios", "ratio"), "damping.ratio: did you mean ratios?"),
    "axial key": (FILE.replace("g = 0.03", "G = 0.03"), "axial.G: did you mean g?"),
    "forcing key": (FILE.replace("gamma", "gama"), "forcing.gama: did you mean gamma?"),
    "no EI": (FILE.replace("EI = 7.0\n", ""), "section[1].EI: has no value"),
    "no length": (FILE.replace("length = 2.0\n", ""), "section[1].length: has no value"),
    "no station": (FILE.replace("station = 1.0\n", ""), "sensor[1].station: has no value"),
    "no mass": (FILE.replace("mass = 6.0\n", ""), "mass[1].mass: has no value"),
    "no section": ('kind = "vehicle"\n', "section: has none"),
    "overlap": (FILE.replace("start = 2.0", "start = 1.5"), "section[2].start = 1.5: overlaps"),
    "gap": (FILE.replace("start = 2.0", "start = 2.5"), "section[2].start = 2.5: leaves a gap"),
    "backwards": (FILE.replace("end = 5.0", "end = 1.0"), "section[2].length = -1: must be"),
    "length and end": (FILE.replace("end = 5.0", "end = 5.0\nlength = 3.0"), "section[2].length"),
    "zero stiffness": (FILE.replace("EI = 7.0", "EI = 0.0"), "section[1].EI = 0: must be greater"),
    "negative mass": (FILE.replace("[3.0, 5.0]", "[3.0, -5.0]"), "section[1].mass_per_length = -5"),
    "three values": (FILE.replace("[3.0, 5.0]", "[3.0, 4.0, 5.0]"), "section[1].mass_per_length ="),
    "text": (FILE.replace("EI = 7.0", 'EI = "stiff"'), "section[1].EI = 'stiff': must be a real"),
    "infinite EI": (FILE.replace("EI = 7.0", "EI = inf"), "section[1].EI = inf: must be finite"),
    "kGA": (FILE.replace("kGA = 60.0", "kGA = -1.0"), "section[2].kGA = -1"),
    "rotary": (FILE.replace("rotary_inertia = 0.1", "rotary_inertia = -0.1"), "section[2].rotary_"),
    "point mass": (FILE.replace("mass = 6.0", "mass = -6.0"), "mass[1].mass = -6: must be"),
    "mass outside": (
        FILE.replace("station = 5.0", "station = 5.1"),
        "mass[1].station = 5.1: is out",
    ),
    "sensor outside": (
        FILE.replace("station = 3.0", "station = 9"),
        "sensor[2].station = 9: is out",
    ),
    "thrust outside": (
        FILE.replace("station = 4.5", "station = -1"),
        "thrust.station = -1: is out",
    ),
    "direction": (FILE.replace('"fixed"', '"sideways"'), "thrust.direction = 'sideways'"),
    "ends": (
        FILE.replace('["free", "free"]', '["free", "fred"]'),
        "ends = 'fred': did you mean free",
    ),
    "one end": (FILE.replace('["free", "free"]', '"free"'), "ends = 'free': must be two words"),
    "modes": (FILE.replace("modes = 3", "modes = 0"), "modes = 0: must be at least 1"),
    "many modes": (FILE.replace("modes = 3", "modes = 600"), "modes = 600: must be at most 60"),
    "half a mode": (
        FILE.replace("modes = 3", "modes = 2.5"),
        "modes = 2.5: must be a whole number",
    ),
    "servo": (
        FILE.replace("time_constant = 0.05", "time_constant = -1"),
        "servo.time_constant = -1",
    ),
    "g": (FILE.replace("g = 0.03", "g = -1"), "axial.g = -1: must be between"),
    "axial damping": (
        FILE.replace('"hysteretic"', '"reported"'),
        "axial.damping = 'reported': did",
    ),
    "quadrature": (FILE.replace("= false", "= 0"), "axial.quadrature_force = 0: must be true or"),
    "ratios": (
        FILE.replace("[0.01, 0.02]", '[0.01, "x"]'),
        "damping.ratios[2] = 'x': must be a real",
    ),
    "matrix": (
        FILE.replace("eta = 0.001", "matrix = [[1.0]]"),
        "damping.matrix has 1 rows: must have 4",
    ),
    "units": (FILE.replace('"SI"', '"si"'), "units = 'si': did you mean"),
    "kind": (FILE.replace('"vehicle"', '"vehicel"'), "kind = 'vehicel': did you mean vehicle?"),
    "stations too": (FILE.replace("modes = 3", 'stations = "s.csv"'), "stations: must not stand"),
    "section table": (FILE.replace("[[section]]", "[section]", 1), "is not TOML"),
    "thrust twice": (FILE.replace("[thrust]", "[[thrust]]"), "thrust: must be a table"),
}


@pytest.mark.parametrize("case", BAD_FILES)
def test_a_bad_file_is_one_line(case: str, tmp_path: Path) -> None:
    text, named = BAD_FILES[case]
    path = tmp_path / "v.toml"
    path.write_text(text)
    assert text != FILE
    with pytest.raises(ValueError, match=r"v\.toml") as caught:
        read(path)
    line = str(caught.value)
    assert line.startswith(f"{path}: ")
    assert named in line
    assert "\n" not in line
    if case not in ("forcing key", "kind"):
        with pytest.raises(ValueError, match=r"v\.toml") as again:
            Vehicle.from_file(path)
        assert str(again.value) == line


def test_the_kind_of_a_file(tmp_path: Path) -> None:
    path = tmp_path / "v.toml"
    path.write_text(FILE.replace('"vehicle"', '"uniform"'))
    with pytest.raises(ValueError, match="kind = 'uniform': must be 'vehicle'"):
        Vehicle.from_file(path)


# ---- units ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "units",
    [
        Units(),
        Units(length="mm", mass="t"),
        Units(length="mm", mass="kg", time="ms", force="kN"),
        Units(length="in", mass="lbf s2/in", force="lbf"),
        Units(length="ft", mass="slug", force="lbf"),
        Units.named("none"),
    ],
)
def test_consistent_units(units: Units) -> None:
    v = Vehicle(sections=(Section(1.0, 1.0, 1.0),), units=units)
    assert v.units == units
    assert replace(v, units="in-lbf-s").units.mass == "lbf s2/in"  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"length": "mm"}, "units.force = 'N': is not consistent, 1 kg mm/s^2 is 0.001 N; it must"),
        ({"mass": "lb", "length": "ft", "force": "lbf"}, "units.force = 'lbf': is not consistent"),
        ({"length": "kg"}, "units.length = 'kg': is a unit of mass, must be one of m, mm"),
        ({"mass": "slugs"}, "units.mass = 'slugs': did you mean slug?"),
        ({"time": 3}, "units.time = 3: must be one of s, ms"),
        ({"force": ""}, "units.force = '': must be one of"),
    ],
)
def test_inconsistent_units(given: dict[str, Any], named: str) -> None:
    with pytest.raises(ValueError, match="units") as caught:
        Units(**given)
    assert str(caught.value).startswith(named)


def test_units_of_a_file(tmp_path: Path) -> None:
    path = tmp_path / "v.toml"
    path.write_text(FILE.replace('units = "SI"', 'units = {length = "mm", mass = "t"}'))
    assert Vehicle.from_file(path).units == Units.named("mm-t-s")
    path.write_text(FILE.replace('units = "SI"', 'units = {lenght = "mm"}'))
    with pytest.raises(ValueError, match=r"units\.lenght: did you mean length\?"):
        Vehicle.from_file(path)


# ---- from Python ---------------------------------------------------------------------------------

ONE = Section(1.0, 1.0, 1.0)


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"sections": ()}, "sections: must be at least one"),
        ({"sections": ONE}, "sections: must be a sequence of Section"),
        ({"sections": [ONE, 3]}, "sections[2] = 3: must be a Section"),
        ({"masses": [ONE]}, "masses[1] = "),
        ({"masses": [PointMass(2.0, 1.0)]}, "masses[1].station = 2: is outside the vehicle"),
        ({"sensors": [Sensor(-0.5)]}, "sensors[1].station = -0.5: is outside"),
        ({"thrust": 3.0}, "thrust = 3.0: must be a Thrust"),
        ({"damping": 0.1}, "damping = 0.1: must be a Damping"),
        ({"ends": ("free",)}, "ends = ('free',): must be two words"),
        ({"servo_time": math.nan}, "servo_time = nan: must be finite"),
        ({"modes": True}, "modes = True: must be a whole number"),
        ({"units": 3}, "units = 3: must be one of SI"),
        ({"g": math.inf}, "g = inf: must be finite"),
        ({"damping": Damping(matrix=np.eye(4))}, "damping.matrix has 4 rows: must have 5"),
    ],
)
def test_a_wrong_part_is_refused(given: dict[str, Any], named: str) -> None:
    with pytest.raises(ValueError, match=named.split()[0].split("[")[0]) as caught:
        Vehicle(**({"sections": [ONE]} | given))
    assert str(caught.value).startswith(named)


def test_vehicles_are_values() -> None:
    """Equal and hashable, whatever they were made from."""
    a = Vehicle(sections=[Section(1, [1, 2], 3)], damping=Damping(np.array([0.1]), matrix=None))  # type: ignore[arg-type]
    b = Vehicle(sections=(Section(1.0, (1.0, 2.0), 3.0),), damping=Damping(0.1))
    assert a == b
    assert len({a, b}) == 1
    assert PointMass(0.0, 0.0, 1.0).rotary_inertia == 1.0
    with pytest.raises(ValueError, match="mass = 0"):
        PointMass(0.0, 0.0)
