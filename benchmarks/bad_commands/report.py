"""Wrong commands about the report: its rows, beams, charts, sensitivities, decks, simple files."""

from itertools import product
from pathlib import Path

import numpy as np

CHART = ["chart", "--x", "Omega", "0.9", "1.3", "5", "--y", "gamma", "0", "0.3", "4"]
NOT_NUMBERS = ("x", "", "1,5", "1e", "--", "0x10", "٣")
NOT_FINITE = ("nan", "inf", "-inf")
HUGE = ("1e300", "1e30")

UNIFORM = 'kind = "uniform"\n[system]\nT0 = 20.0\nK_theta = 0.5\nxi_G = 0.5'

FILES = {
    "empty.toml": "",
    "broken.toml": "kind = ",
    "old.toml": '[beam]\nkind = "uniform"\nT0 = 15.0',
    "number.toml": 'kind = "uniform"\nsystem = 1\nforcing = 2',
    "list.toml": 'kind = "uniform"\nsystem = [1]\naxis = 3',
    "string.toml": 'kind = "uniform"\nsystem = "uniform"',
    "forcing.toml": f'{UNIFORM}\n[forcing]\neta = "x"',
    "true.toml": 'kind = "uniform"\n[system]\nT0 = true\nK_theta = 0.5\nxi_G = 0.5',
    "kind.toml": 'kind = "wobbly"',
    "kinds.toml": "kind = [1]",
    "axis.toml": f'{UNIFORM}\n[[axis]]\nname = "Omega"\nlow = 1',
    "axes.toml": f'{UNIFORM}\n[axis]\nname = "Omega"',
    "axisname.toml": f"{UNIFORM}\n[[axis]]\nname = 3\nlow = 1\nhigh = 2\ncount = 3",
    "omega.toml": f"{UNIFORM}\n[forcing]\nOmega = -1\n[[axis]]\n"
    'name = "gamma"\nlow = 0\nhigh = 1\ncount = 3',
    "extra.toml": f"{UNIFORM}\n[beams]\nT0 = 1",
    "typo.toml": f"{UNIFORM}\nTO = 1.0",
    "deep.toml": "x = " + "[" * 5000 + "]" * 5000,
    "nothing.deck": "",
    "words.deck": "this is no deck\n" * 20,
    "digits.deck": "٣" * 80 + "\n",
    "good.toml": 'kind = "matrices"\n[system]\nF = [[1.0]]\nG = [[1.0]]\n'
    "[forcing]\ngamma = 0.1\nOmega = 2.0\n",
    "noforcing.toml": 'kind = "matrices"\n[system]\nF = [[1.0]]\nG = [[1.0]]\n',
    "notes.txt": "not a file of nodes",
}
SYSTEMS = {
    "F": "F = 1.0\nG = [[1.0]]",
    "noG": "F = [[1.0]]",
    "shape": "F = [[1.0, 2.0]]\nG = [[1.0]]",
    "sizes": "F = [[1.0]]\nG = [[1.0, 0.0], [0.0, 1.0]]",
    "ragged": "F = [[1.0, 2.0], [3.0]]\nG = [[1.0]]",
    "words": 'F = [["a"]]\nG = [[1.0]]',
    "nan": "F = [[nan]]\nG = [[1.0]]",
    "inf": "F = [[1.0]]\nG = [[inf]]",
    "true": "F = [[true]]\nG = [[1.0]]",
    "M": "F = [[1.0]]\nG = [[1.0]]\nM = [[0.0]]",
    "key": "F = [[1.0]]\nG = [[1.0]]\nK = [[1.0]]",
    "npz": 'F = "gone.npz:F"\nG = [[1.0]]',
    "array": 'F = "good.npz:A"\nG = [[1.0]]',
    "noarray": 'F = "good.npz"\nG = [[1.0]]',
    "notnpz": 'F = "notes.npz:F"\nG = [[1.0]]',
    "mat": 'F = "notes.mat:F"\nG = [[1.0]]',
    "mtx": 'F = "gone.mtx"\nG = [[1.0]]',
    "xls": 'F = "gone.xls:F"\nG = [[1.0]]',
    "H": "F = [[1.0]]\nG = [[1.0]]\nH = 3",
    "omega_L": "F = [[1.0]]\nG = [[1.0]]\nH = [[[1.0]]]\nomega_L = 3.3",
    "names": "F = [[1.0]]\nG = [[1.0]]\nfrequency_names = 3",
    "count": 'F = [[1.0]]\nG = [[1.0]]\nfrequency_names = ["a", "b"]',
    "terms": "F = [[1.0]]\nG = [[1.0]]\nF_terms = 1",
    "value": "F = [[1.0]]\nG = [[1.0]]\nvalues = { k = 1.0 }",
    "term": "F = [[1.0]]\nG = [[1.0]]\nF_terms = { Omega = [[1.0]] }",
}


def files(folder: Path) -> None:
    """Write what the commands ask for."""
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    for name, text in SYSTEMS.items():
        whole = f'kind = "matrices"\n[forcing]\ngamma = 0.1\nOmega = 2.0\n[system]\n{text}\n'
        (folder / f"system-{name}.toml").write_text(whole, encoding="utf-8")
    np.savez(folder / "good.npz", F=np.eye(1))
    for suffix in ("npz", "mat"):
        (folder / f"notes.{suffix}").write_text("these are notes")
    (folder / "folder").mkdir()
    read_only = folder / "locked.csv"
    read_only.write_text("mine")
    read_only.chmod(0o444)


def _all() -> dict[str, tuple[list[str], str]]:
    found: dict[str, tuple[list[str], str]] = {}

    def add(name: str, words: list[str], named: str = "") -> None:
        assert name not in found, name
        found[name] = (words, named)

    for word in ("row", "charts", "sistem", "listings", "figure", "claim", "verify", "run", "X"):
        add(f"command {word}", [word], word)
    for word in ("--tables", "--foo", "-z", "--rows=3", "--show=nothing", "--format=xml"):
        add(f"option {word}", [word])
    for value in ("0", "4", "x", "1.0", "-1", ""):
        add(f"table {value!r}", ["--table", value])
    for value in ("T9-01", "T1-99", "", "1", "T1", "T3-01c"):
        add(f"row {value!r}", ["--row", value], "row")
    for value in ("", "mathiu", "Kincaid", "all"):
        add(f"publication {value!r}", ["--publication", value], "publication")
    for value in ("0", "-1", "x", "1.5", "1000", "1e9", "99999999999"):
        add(f"modes {value}", ["--modes", value])
    for value in ("0", "-2", "x", "1e99"):
        add(f"workers {value}", ["--table", "1", "--workers", value])
    add("method", ["--method", "euler"])
    for output in ("folder", "gone/x.json", "locked.csv", "x" * 300 + ".json", "\0.json"):
        add(f"rows output {output[:12]!r}", ["--output", output], "output")

    parameters = ("T0", "K_theta", "xi_G", "omega_L", "g", "Omega", "gamma", "eta")
    for name, value in product(parameters, NOT_NUMBERS):
        add(f"sensitivity {name}={value!r}", ["sensitivity", "--set", f"{name}={value}"], "set")
    for name, value in product(parameters, NOT_FINITE):
        if (name, value) != ("omega_L", "inf"):
            add(f"sensitivity {name}={value}", ["sensitivity", "--set", f"{name}={value}"], name)
    for words in ("T0", "=1", "TO=1", "omega=1", "nothing=5", "modes=1.5", "modes=0", "modes=1000"):
        add(f"sensitivity {words}", ["sensitivity", "--set", words], "")
    for words in ("xi_G=2", "xi_G=-1", "omega_L=0", "omega_L=-3", "g=-1", "Omega=0", "Omega=-1"):
        add(f"sensitivity {words}", ["sensitivity", "--set", words], words.split("=")[0])
    for words in ("Omega=1e300", "Omega=1e-300", "eta=1e300", "gamma=1e300", "T0=1e300"):
        add(f"sensitivity {words}", ["sensitivity", "--set", words], "")
    at_a_pole = ["sensitivity", "--set", "omega_L=1.1", "--set", "Omega=1.1"]
    add("sensitivity at a pole", at_a_pole, "omega_L")
    add("sensitivity format", ["sensitivity", "--format", "csv"])
    add("sensitivity output", ["sensitivity", "--output", "gone/s.json"], "output")
    add("sensitivity beam", ["sensitivity", "--beam", "round"])

    row = ["simulate", "--row", "T1-12"]
    for value in ("T3-01", "T9-99", ""):
        add(f"simulate row {value!r}", ["simulate", "--row", value], "row")
    for name, value in product(("periods", "samples"), ("0", "-1", "x", "1.5", "1000000000")):
        add(f"simulate {name} {value}", [*row, f"--{name}", value], name)
    for name, value in product(("q0", "v0"), ("1", "nan 0 0", "0 inf 0", "a 0 0", "0 0 0 0", "")):
        add(f"simulate {name} {value!r}", [*row, f"--{name}", *value.split()], name)
    for words in ("--set gamma=1", "--beam stepped", "gone.toml"):
        add(f"simulate row and {words}", [*row, *words.split()], "row")
    add("simulate nothing", ["simulate"], "Omega")
    add("simulate gone", ["simulate", "gone.toml"], "gone.toml")
    add("simulate format", [*row, "--format", "xml"])
    add("simulate picture", [*row, "--format", "csv", "--output", "x.png"], "format")
    for output in ("gone/x.png", "locked.csv", "folder"):
        add(f"simulate output {output}", [*row, "--output", output], "output")
    for words in ("Omega=0", "Omega=nan", "Omega=1e-300", "gamma=1e300", "T0=1e300", "modes=0"):
        given = [w for name in ("Omega=1.1", "gamma=0.1") for w in ("--set", name)]
        named = "" if "1e300" in words else words.split("=")[0]
        add(f"simulate {words}", ["simulate", *given, "--set", words], named)

    axes = ("Omega", "gamma", "eta", "T0", "K_theta", "xi_G", "omega_L", "g")
    for name, (low, high) in product(axes, (("nan", "1"), ("0", "inf"), ("2", "1"), ("1", "1"))):
        other = "gamma" if name != "gamma" else "Omega"
        fixed = ["--set", "Omega=1.1"] if "Omega" not in (name, other) else []
        axis = ["chart", "--x", name, low, high, "5", "--y", other, "0.1", "0.2", "4", *fixed]
        add(f"axis {name} {low} {high}", axis, name)
    for name, value in product(axes, ("x", "")):
        add(f"axis {name} {value!r}", ["chart", "--x", name, value, "1", "5", *CHART[6:]], name)
    for count in ("0", "1", "-5", "x", "1.5", "1e9", "nan", "inf", "1e300", "99999999999999"):
        add(f"count {count}", [*CHART[:5], count, *CHART[6:]], "Omega")
    add("too many points", [*CHART[:5], "100000", *CHART[6:10], "100000"], "points")
    for low, high in (("1e-300", "2"), ("0", "2"), ("-1", "2"), ("0.5", "1e300"), ("1e-9", "1")):
        add(f"Omega {low} {high}", ["chart", "--x", "Omega", low, high, "5", *CHART[6:]], "Omega")
    for name, high in (("gamma", "1e10"), ("gamma", "1e300"), ("T0", "1e18"), ("T0", "1e300")):
        axis = ["chart", "--x", "Omega", "0.9", "1.3", "5", "--y", name, "0", high, "4"]
        add(f"axis to {name} {high}", [*axis, *(["--set", "gamma=0.1"] if name == "T0" else [])])
    for name, value in product(parameters, (*NOT_FINITE, *HUGE)):
        if name not in ("Omega", "gamma") and not (name == "omega_L" and value != "nan"):
            named = name if value in NOT_FINITE else ""
            add(f"chart {name}={value}", [*CHART, "--set", f"{name}={value}"], named)
    for words in ("Omega=1.5", "gamma=0.2", "nothing=5", "T0", "=3", "Tzero=4", "omega_l=3"):
        add(f"chart {words}", [*CHART, "--set", words], words.split("=")[0])
    add("chart without axes", ["chart"], "axes")
    add("chart twice", ["chart", "--x", *CHART[2:6], "--y", *CHART[2:6]], "Omega")
    add("chart no such axis", ["chart", "--x", "omega", "1", "2", "3", *CHART[6:]], "omega")
    add("chart modes axis", ["chart", "--x", "modes", "1", "2", "3", *CHART[6:]], "modes")
    add("chart three words", ["chart", "--x", "Omega", "1", "2"])
    add("chart without gamma", ["chart", "--x", "Omega", "1", "2", "5"], "gamma")
    for value in ("0", "-1", "1e-20", "nan", "inf", "1e300", "x", "1"):
        add(f"tolerance {value}", [*CHART, "--tolerance", value])
    for value in ("0", "-1", "x", "1.5"):
        add(f"order {value}", [*CHART, "--order", value], "")
    for output in (
        "x.gif",
        "x",
        "x.toml",
        "folder",
        "gone/x.csv",
        "locked.csv",
        "x" * 300 + ".csv",
    ):
        add(f"chart output {output[:12]}", [*CHART, "--output", output], "output")
    for tongues in ("t.png", "gone/t.csv", "locked.csv", "folder"):
        add(
            f"tongues {tongues}",
            [*CHART, "--tongues", tongues],
            "tongues",
        )
    for words in ("omega_L=3", "T0=30", "K_theta=-100"):
        add(f"certify {words}", [*CHART, "--certify", "--set", words], "")
    across = [*CHART[:6], "--y", "T0", "1", "20", "4", "--set", "gamma=0.1", "--certify"]
    add("certify other axes", across, "certify")
    add("certify too many cells", [*CHART[:10], "9000000", "--certify"], "certify")
    add("certify too near 0", [*CHART[:3], "0.001", *CHART[4:], "--certify"], "Omega")
    same = [*CHART, "--output", "a.csv"]
    add("same file", [*same, "--tongues", "a.csv"], "tongues")
    add("same file, other name", [*same, "--tongues", "./a.csv"], "tongues")
    add("same file resumed", [*same, "--resume", "a.csv"], "resume")
    add("show without a picture", [*CHART, "--show", "disagreement"], "show")
    add("show with a table", [*CHART, "--show", "disagreement", "--output", "a.csv"], "show")
    route = [*CHART, "--route", "hill", "--show", "disagreement", "--output", "a.png"]
    add("show of one route", route, "show")
    add("show nothing", [*CHART, "--show", "nothing"])
    three = [*CHART, "--also", "T0", "1", "2", "3"]
    add("picture of three", [*three, "--output", "a.png"], "output")
    one = [*CHART[:6], "--set", "gamma=0.1", "--output", "a.html"]
    add("page of one", one, "axes")
    more = ["--also", "T0", "1", "2", "3", "--also", "eta", "0", "1", "3"]
    five = [*CHART, *more, "--also", "g", "0", "1", "3", "--output", "a.html"]
    add("page of five", five, "axes")
    add("page of disagreement", [*CHART, "--show", "disagreement", "--output", "a.html"], "show")
    add("log from 0", [*CHART, "--output", "a.png", "--log", "gamma"], "gamma")
    add("log of none", [*CHART, "--output", "a.pdf", "--log", "T0"], "T0")
    for size in (("0", "3"), ("3", "1000"), ("nan", "3"), ("x", "3"), ("3",)):
        add(f"size {size}", [*CHART, "--output", "a.svg", "--size", *size], "")
    add("size of a table", [*CHART, "--output", "a.csv", "--size", "4", "3"], "--size")
    add("axis beside twice", [*three, "--also", "T0", "1", "2", "3"], "T0")
    add("tongues of three", [*three, "--tongues", "a.csv"], "tongues")
    no_Omega = ["chart", "--x", "T0", "1", "2", "3", *CHART[6:], "--set", "Omega=1"]
    add("tongues without Omega", [*no_Omega, "--tongues", "a.csv"], "tongues")
    add("resume a folder", [*CHART, "--resume", "folder"])
    add("resume another file", [*CHART, "--resume", "notes.txt"], "notes.txt")
    for value in ("0", "-2", "x", "1.5"):
        add(f"chart workers {value}", [*CHART, "--workers", value])
    add("chart route", [*CHART, "--route", "both ways"])
    add("beam and file", ["chart", "axis.toml", "--beam", "uniform"], "beam")
    for name in FILES:
        if name.endswith(".toml") and name not in ("empty.toml", "noforcing.toml"):
            add(f"chart {name}", ["chart", name], ".toml" if name != "omega.toml" else "Omega")
    for name in ("gone.toml", "folder", "good.npz", "x" * 300 + ".toml"):
        add(f"chart file {name[:12]}", ["chart", name, *CHART[1:]], name[:12])

    for name in (*(n for n in FILES if n.endswith(".toml") and n != "good.toml"), "gone.toml"):
        named = {"noforcing.toml": "Omega", "omega.toml": "gamma"}.get(name, name)
        add(f"system {name}", ["system", name], named)
    for name in SYSTEMS:
        add(f"system of {name}", ["system", f"system-{name}.toml"], "")
    for word in (
        "Omega=x",
        "Omega=nan",
        "Omega=-1",
        "Omega=0",
        "omega=1",
        "gamma",
        "k=3",
        "eta=nan",
    ):
        add(f"system {word}", ["system", "good.toml", "--set", word], word.split("=")[0])
    add("system without a file", ["system"])
    add("system format", ["system", "good.toml", "--format", "xml"])
    add("system output", ["system", "good.toml", "--output", "gone/x.json"], "output")

    for name in ("round", "nothing.deck", "words.deck", "digits.deck", "gone.deck", "folder"):
        add(f"listing {name}", ["listing", name], "")
    add("listing", ["listing"])
    add("listing route", ["listing", "uniform", "--route", "x"])
    add("figures", ["figures", "--figure", "2"])
    add("figures output", ["figures", "--output", "locked.csv"])
    add("claims", ["claims", "--format", "xml"])
    pages = ["report", "--output", "pages"]
    add("report without output", ["report"], "--output")
    for output in ("notes.txt", ".", "gone/pages", "x" * 300):
        add(f"report output {output[:12]}", ["report", "--output", output], "output")
    add("report figures gone", [*pages, "--figures", "gone"], "gone")
    add("report no figures", [*pages, "--figures", "folder"], "folder")
    add("report figures twice", [*pages, "--figures", "folder", "--draw"], "--figures")
    own = ["report", "good.toml", "--output", "pages"]
    add("report setting of rows", [*pages, "--set", "Omega=2"], "--set")
    add("report of nothing", ["report", "gone.toml", "--output", "pages"], "gone.toml")
    for option in ("--draw", "--no-claims"):
        add(f"report own {option}", [*own, option], option)
    add("report own figures", [*own, "--figures", "folder"], "--figures")
    add("report own nothing", [*own, "--set", "nothing=5"], "nothing")
    add("report own Omega", [*own, "--set", "Omega=0"], "Omega")
    add("report without Omega", ["report", "noforcing.toml", "--output", "pages"], "Omega")
    add("report workers", [*pages, "--workers", "0"], "workers")
    add("prove row", ["prove", "T1-7"], "T1-7")
    add("prove file and row", ["prove", "good.toml", "T1-01"], "good.toml")
    add("prove gone", ["prove", "gone.toml"], "gone.toml")
    add("prove interval of a file", ["prove", "good.toml", "--interval"], "--interval")
    add("prove setting of a row", ["prove", "T1-01", "--set", "Omega=2"], "--set")
    add("prove workers", ["prove", "T1-01", "--workers", "0"], "workers")
    add("prove output", ["prove", "T1-01", "--output", "gone/x.json"], "output")
    return found


COMMANDS = _all()
