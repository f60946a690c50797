"""Wrong commands about vehicles: `verify vehicle`, its options and its files."""

from pathlib import Path

Commands = dict[str, tuple[list[str], str]]

SECTION = "[[section]]\nlength = 1.0\nmass_per_length = 1.0\nEI = 1.0\n"
REST = "[thrust]\nmean = 1.0\n[forcing]\ngamma = 0.1\nOmega = 3.0\n"
HEADER = "station,mass_per_length,EI\n"

# Above the sections, the sections, and below them; each with what its line must name.
FILES = {
    "no section": ("", "", "", "section"),
    "section a number": ("section = 3\n", "", "", "section"),
    "section a table": ("", "[section]\nlength = 1.0\n", "", "section"),
    "sections": ("", SECTION.replace("[[section]]", "[[sections]]"), "", "section"),
    "no length": ("", SECTION.replace("length = 1.0\n", "", 1), "", "length"),
    "no mass": ("", SECTION.replace("mass_per_length = 1.0\n", ""), "", "mass_per_length"),
    "no EI": ("", SECTION.replace("EI = 1.0\n", ""), "", "EI"),
    "zero length": ("", SECTION.replace("length = 1.0", "length = 0.0", 1), "", "length"),
    "zero mass": ("", SECTION.replace("h = 1.0\nEI", "h = 0.0\nEI"), "", "mass_per_length"),
    "negative mass": ("", SECTION.replace("h = 1.0\nEI", "h = -1.0\nEI"), "", "mass_per_length"),
    "mass nan": ("", SECTION.replace("h = 1.0\nEI", "h = nan\nEI"), "", "mass_per_length"),
    "mass text": ("", SECTION.replace("h = 1.0\nEI", 'h = "x"\nEI'), "", "mass_per_length"),
    "mass true": ("", SECTION.replace("h = 1.0\nEI", "h = true\nEI"), "", "mass_per_length"),
    "mass of three": ("", SECTION.replace("h = 1.0\nEI", "h = [1, 2, 3]\nEI"), "", "mass_per"),
    "zero EI": ("", SECTION.replace("EI = 1.0", "EI = 0.0"), "", "EI"),
    "EI inf": ("", SECTION.replace("EI = 1.0", "EI = inf"), "", "EI"),
    "EI huge": ("", SECTION.replace("EI = 1.0", "EI = 1e300"), "", ""),
    "unknown key": ("", SECTION.replace("mass_per", "mas_per"), "", "did you mean mass_per_length"),
    "ei": ("", SECTION.replace("EI", "ei"), "", "EI"),
    "overlap": ("", SECTION + SECTION + "start = 0.5\n", "", "overlaps"),
    "gap": ("", SECTION + SECTION + "start = 1.5\n", "", "gap"),
    "end before start": ("", SECTION.replace("length = 1.0", "end = -1.0", 1), "", "length"),
    "end beside length": ("", SECTION + "end = 1.0\n", "", "length"),
    "units": ('units = "metric"\n', SECTION, "", "units"),
    "units table": ('units = { lenght = "m" }\n', SECTION, "", "length"),
    "ends": ('ends = ["free"]\n', SECTION, "", "ends"),
    "ends loose": ('ends = ["free", "loose"]\n', SECTION, "", "loose"),
    "ends a word": ('ends = "free"\n', SECTION, "", "ends"),
    "modes 0": ("modes = 0\n", SECTION, "", "modes"),
    "modes 1.5": ("modes = 1.5\n", SECTION, "", "modes"),
    "modes many": ("modes = 1000000000\n", SECTION, "", "modes"),
    "modes too many": ("modes = 5000\n", SECTION, "", "modes"),
    "mode": ("mode = 3\n", SECTION, "", "did you mean modes"),
    "mass outside": ("", SECTION, "[[mass]]\nstation = 2.0\nmass = 1.0\n", "mass[1].station"),
    "mass below 0": ("", SECTION, "[[mass]]\nstation = 0.5\nmass = -1.0\n", "mass[1].mass"),
    "mass nowhere": ("", SECTION, "[[mass]]\nmass = 1.0\n", "mass[1].station"),
    "mass without": ("", SECTION, "[[mass]]\nstation = 0.5\n", "mass[1].mass"),
    "mass text at": ("", SECTION, '[[mass]]\nstation = "x"\nmass = 1.0\n', "mass[1].station"),
    "mass a table": ("", SECTION, "[mass]\nstation = 0.5\nmass = 1.0\n", "mass"),
    "mass key": ("", SECTION, "[[mass]]\nstation = 0.5\nmasse = 1.0\n", "did you mean mass"),
    "sensor outside": ("", SECTION, "[[sensor]]\nstation = -1.0\n", "sensor[1].station"),
    "sensor key": ("", SECTION, "[[sensor]]\nstation = 0.5\nangel = 1.0\n", "angel"),
    "thrust twice": ("", SECTION, "[thrust]\nmean = 1.0\n", "toml"),
    "servo": ("", SECTION, "[servo]\ntime_constant = -1.0\n", "servo.time_constant"),
    "servo key": ("", SECTION, "[servo]\ntime = 1.0\n", "servo.time"),
    "damping key": ("", SECTION, "[damping]\nratio = 0.1\n", "ratios"),
    "damping text": ("", SECTION, '[damping]\nratios = "x"\n', "damping"),
    "damping matrix": ("modes = 2\n", SECTION, "[damping]\nmatrix = [[0.1]]\n", "matrix"),
    "axial key": ("", SECTION, "[axial]\nG = 0.1\n", "axial"),
    "axial g": ("", SECTION, "[axial]\ng = -0.1\n", "axial.g"),
    "stations beside": ('stations = "good.csv"\n', SECTION, "", "stations"),
    "stations a number": ("stations = 3\n", "", "", "stations"),
    "stations not there": ('stations = "none.csv"\n', "", "", "none.csv"),
    "stations a folder": ('stations = "folder"\n', "", "", "folder"),
}
THRUST = {
    "nan": ("[thrust]\nmean = nan\n", "thrust"),
    "text": ('[thrust]\nmean = "x"\n', "thrust"),
    "key": ("[thrust]\nmaen = 1.0\n", "did you mean mean"),
    "a number": ("thrust = 3\n", "thrust"),
    "huge": ("[thrust]\nmean = 1e300\n", ""),
    "above what steady flight bears": ("[thrust]\nmean = 1e9\n", ""),
}
CSV = {
    "empty": ("", "empty"),
    "header alone": (HEADER, "stations"),
    "one": (HEADER + "0,1,1\n", "stations"),
    "text": (HEADER + "0,1,1\n1,x,1\n", "mass_per_length"),
    "a gap": (HEADER + "0,1,1\n1,,1\n", "mass_per_length"),
    "nan": (HEADER + "0,1,1\n1,nan,1\n", "mass_per_length"),
    "zero mass": (HEADER + "0,0,1\n1,0,1\n", "mass_per_length"),
    "negative": (HEADER + "0,1,1\n1,-1,1\n", "mass_per_length"),
    "descends": (HEADER + "0,1,1\n1,1,1\n0.5,1,1\n", "ascend"),
    "no nose": (HEADER + "1,1,1\n2,1,1\n", "nose"),
    "three times": (HEADER + "0,1,1\n1,1,1\n1,1,1\n1,1,1\n2,1,1\n", "three times"),
    "twice at the end": (HEADER + "0,1,1\n1,1,1\n1,1,1\n", "twice"),
    "column": ("station,mass,EI\n0,1,1\n1,1,1\n", "column"),
    "no column": ("station,EI\n0,1\n1,1\n", "mass_per_length"),
    "column twice": ("station,mass_per_length,EI,EI\n0,1,1,1\n1,1,1,1\n", "twice"),
    "too few": (HEADER + "0,1,1\n1,1\n", "values"),
    "semicolons": ("station;mass_per_length;EI\n0;1;1\n1;1;1\n", "column"),
    "too many rows": (HEADER + "".join(f"{k},1,1\n" for k in range(6002)), "5,000"),
}
OPTIONS = (
    ["--range", "5", "1"], ["--range", "nan", "2"], ["--range", "-1", "3"], ["--range", "x", "y"],
    ["--range", "0", "inf"], ["--range", "1"], ["--range", "1", "1"], ["--order", "0"],
    ["--order", "11"], ["--order", "x"], ["--order", "1.5"], ["--closely", "0"],
    ["--closely", "x"], ["--both", "-1"], ["--both", "x"], ["--format", "csv"], ["--chart"],
    ["--output", "folder"], ["--output", "gone/v.md"], ["--output", "locked.csv"],
    ["--set", "gama=1"], ["--set", "gamma=nan"], ["--set", "gamma=x"], ["--set", "gamma"],
    ["--set", "Omega=-1"], ["--set", "Omega=0"], ["--set", "eta=nan"], ["--set", "modes=0"],
    ["--set", "modes=1.5"], ["--set", "modes=1e9"], ["--set", "modes=3000"],
    ["--chart", "x.gif"], ["--chart", "x"], ["--chart", "folder"], ["--chart", "gone/x.png"],
    ["--chart", "locked.csv"], ["--chart", "x.png", "--set", "gamma=0"], ["--more-modes", "-1"],
    ["--more-modes", "x"], ["--more-modes", "1.5"], ["--more-modes", "1000000000"],
    ["--set", "gamma=1e300"], ["--set", "Omega=1e-300"], ["--modes", "3"],
)  # fmt: skip


HUGE = ["gamma=1e300"]


def _whole(above: str, sections: str, below: str) -> str:
    return f'kind = "vehicle"\n{above}{sections}{REST}{below}'


def files(folder: Path) -> None:
    """Write what the commands ask for."""
    texts = {f"vehicle-{k}": _whole(*case[:3]) for k, case in enumerate(FILES.values())}
    bare = f'kind = "vehicle"\n{SECTION}'
    forced = REST.partition("[forcing]")[2]
    for k, (text, _) in enumerate(THRUST.values()):
        top = text if text.startswith("thrust") else ""
        rest = "" if top else text
        texts[f"thrust-{k}"] = f'kind = "vehicle"\n{top}{SECTION}{rest}[forcing]{forced}'
    for k, (text, _) in enumerate(CSV.values()):
        (folder / f"stations-{k}.csv").write_text(text, encoding="utf-8")
        texts[f"csv-{k}"] = _whole(f'stations = "stations-{k}.csv"\n', "", "")
    (folder / "binary.csv").write_bytes(bytes(range(256)))
    (folder / "good.csv").write_text(HEADER + "0,1,1\n1,1,1\n", encoding="utf-8")
    texts["csv-binary"] = _whole('stations = "binary.csv"\n', "", "")
    texts["vehicle-good"] = _whole("", SECTION, "")
    texts["vehicle-no-gamma"] = f"{bare}[thrust]\nmean = 1.0\n"
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")


def commands() -> Commands:
    """Each file by `verify vehicle` and by `verify system`."""
    found: Commands = {}
    for kind, cases in (("vehicle", FILES), ("thrust", THRUST), ("csv", CSV)):
        for k, (name, case) in enumerate(cases.items()):
            for command in ("vehicle", "system"):
                words = [command, f"{kind}-{k}.toml"]
                found[f"{command} {kind} {name}"] = (words, str(case[-1]))
    found["vehicle csv binary"] = (["vehicle", "csv-binary.toml"], "binary.csv")
    found["vehicle without gamma"] = (["vehicle", "vehicle-no-gamma.toml"], "gamma")
    for words in OPTIONS:
        named = words[-1].partition("=")[0] if "--set" in words else words[0].strip("-")
        named = "pulsation" if words[1:] == HUGE else named if words[1:] else ""
        found[f"vehicle {' '.join(words)}"] = (["vehicle", "vehicle-good.toml", *words], named)
    for name in ("good.toml", "empty.toml", "broken.toml", "gone.toml", "folder", "good.npz"):
        found[f"vehicle of {name}"] = (["vehicle", name], name)
    found["vehicle"] = (["vehicle"], "")
    return found
