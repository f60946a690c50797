"""Wrong commands about one's own systems: general matrices, files of them, Python files."""

from pathlib import Path
from typing import Any

import numpy as np

Commands = dict[str, tuple[list[str], str]]

FORCING = "[forcing]\ngamma = 0.1\nOmega = 2.0\n"
GOOD_K = "K.mean = [[2.0, -1.0], [-1.0, 2.0]]\n"

# Each with what its line must name.
GENERAL = {
    "singular M": ("M = [[1.0, 1.0], [1.0, 1.0]]\n" + GOOD_K, "M"),
    "zero M": ("M = [[0.0, 0.0], [0.0, 0.0]]\n" + GOOD_K, "M"),
    "M of another size": ("M = [[1.0]]\n" + GOOD_K, "M"),
    "M not square": ("M = [[1.0, 0.0]]\n" + GOOD_K, "M"),
    "M with harmonics": ("M.mean = [[1.0]]\nM.cos.1 = [[0.1]]\nK = [[1.0]]\n", "M"),
    "M alone": ("M = [[1.0]]\n", ""),
    "C alone": ("C = [[1.0]]\n", ""),
    "C of another size": ("C = [[1.0]]\n" + GOOD_K, "C"),
    "K not square": ("K = [[1.0, 2.0]]\n", "K"),
    "K ragged": ("K = [[1.0, 2.0], [1.0]]\n", "K"),
    "K empty": ("K = []\n", "K"),
    "K empty rows": ("K = [[]]\n", "K"),
    "K a number": ("K = 1.0\n", "K"),
    "K nan": ("K = [[nan]]\n", "K"),
    "K inf": ("K.mean = [[1.0]]\nK.cos.1 = [[inf]]\n", "K"),
    "K words": ('K = [["x"]]\n', "K"),
    "K true": ("K = [[true]]\n", "K"),
    "K without mean": ("K.cos.1 = [[1.0]]\n", "mean"),
    "K tan": ("K.mean = [[1.0]]\nK.tan.1 = [[1.0]]\n", "tan"),
    "K cosine": ("K.mean = [[1.0]]\nK.cosine.1 = [[1.0]]\n", "cosine"),
    "K cos 0": ("K.mean = [[1.0]]\nK.cos.0 = [[1.0]]\n", "cos"),
    "K cos -1": ("K.mean = [[1.0]]\nK.cos.-1 = [[1.0]]\n", "cos"),
    "K cos x": ("K.mean = [[1.0]]\nK.cos.x = [[1.0]]\n", "cos.x"),
    "K cos 1.5": ("K.mean = [[1.0]]\nK.cos.1.5 = [[1.0]]\n", "cos"),
    "K cos digits": ('K.mean = [[1.0]]\nK.cos."٣" = [[1.0]]\n', "cos"),
    "K cos a list": ("K.mean = [[1.0]]\nK.cos = [[1.0]]\n", "cos"),
    "K cos of another size": (GOOD_K + "K.cos.1 = [[1.0]]\n", "K"),
    "K cos far": ("K.mean = [[1.0]]\nK.cos.1000000000 = [[1.0]]\n", ""),
    "K sin farther": ("K.mean = [[1.0]]\nK.sin.99999999999999999999 = [[1.0]]\n", ""),
    "K huge": ("K = [[1e300]]\n", ""),
    "K negative and huge": ("K = [[-1e12]]\n", ""),
    "K tiny M": ("M = [[1e-300]]\nK = [[1.0]]\n", ""),
    "F beside K": ("F = [[1.0]]\nK = [[1.0]]\n", "F"),
    "H beside K": ("H = [[[1.0]]]\nK = [[1.0]]\n", "H"),
    "A beside K": ("A = [[1.0]]\nK = [[1.0]]\n", "A"),
    "A beside M": ("A = [[1.0]]\nM = [[1.0]]\n", "A"),
    "A not square": ("A = [[1.0, 2.0]]\n", "A"),
    "A huge": ("A = [[1e9]]\n", ""),
    "k in small": ("k = [[1.0]]\n", "k"),
    "values": ("K = [[1.0]]\nvalues = { k = 1.0 }\n", "values"),
    "names": ('K = [[1.0]]\nfrequency_names = ["a", "b"]\n', ""),
    "npz without": ('K = "good.npz:K"\n', "must be one of F"),
    "npz without a name": ('K = "good.npz"\n', "array"),
    "npz not there": ('K = "none.npz:K"\n', "none.npz"),
    "npz a folder": ('K = "folder.npz:K"\n', "folder.npz"),
    "npz of objects": ('K = "odd.npz:objects"\n', "odd.npz"),
    "npz of complex": ('K = "odd.npz:complex"\n', "K"),
    "npz of words": ('K = "odd.npz:words"\n', "K"),
    "npz of three axes": ('K = "odd.npz:cube"\n', "K"),
    "npz of nan": ('K = "odd.npz:nan"\n', "K"),
    "npz cut off": ('K = "cut.npz:F"\n', "cut.npz"),
    "npy": ('K = "single.npy:F"\n', "single.npy"),
    "npy called npz": ('K = "single.npz:F"\n', "single.npz"),
    "mat without": ('K = "good.mat:K"\n', "must be one of F"),
    "mat not there": ('K = "none.mat:K"\n', "none.mat"),
    "mat 7.3": ('K = "new.mat:K"\n', "7.3"),
    "mat cut off": ('K = "cut.mat:F"\n', "cut.mat"),
    "mat of words": ('K = "good.mat:words"\n', "K"),
    "mat of a struct": ('K = "good.mat:struct"\n', "K"),
    "mat empty": ('K = "empty.mat:F"\n', "empty.mat"),
    "mtx not there": ('K = "none.mtx"\n', "none.mtx"),
    "mtx of notes": ('K = "notes.mtx"\n', "notes.mtx"),
    "mtx cut off": ('K = "cut.mtx"\n', "cut.mtx"),
    "mtx of complex": ('K = "complex.mtx"\n', "K"),
    "mtx empty": ('K = "empty.mtx"\n', "empty.mtx"),
    "mtx beyond memory": ('K = "wide.mtx"\n', "wide.mtx"),
}

MODULE = """\
from dataclasses import dataclass
from hill import HillEquation, Parameter

@dataclass(frozen=True)
class Good:
    k: float = 1.0
    parameters = (Parameter("k"),)
    def equation(self, Omega, gamma, eta=0.0):
        return HillEquation([[self.k]], [[1.0]], gamma, Omega, eta)

class Nothing:
    pass

class Stubborn(Good):
    def __init__(self):
        raise RuntimeError("will not be made")

class NoNumber(Good):
    def equation(self, Omega, gamma, eta=0.0):
        return 3.0

class Lost(Good):
    def equation(self, Omega, gamma, eta=0.0):
        return {}["lost"]

class Shape(Good):
    def equation(self, Omega, gamma, eta=0.0):
        return HillEquation([[1.0, 2.0]], [[1.0]], gamma, Omega, eta)

class Nan(Good):
    def equation(self, Omega, gamma, eta=0.0):
        return HillEquation([[float("nan")]], [[1.0]], gamma, Omega, eta)

class Positional(Good):
    def equation(self):
        return None

class Words(Good):
    parameters = ("k",)

class NoList(Good):
    parameters = 3

value = 3
"""
PYTHON = {
    "no class": ("", "class"),
    "a number": ("class = 3", "class"),
    "no colon": ('class = "mine.py"', "class"),
    "no name": ('class = "mine.py:"', "class"),
    "no such class": ('class = "mine.py:God"', "God"),
    "no such file": ('class = "none.py:Good"', "none.py"),
    "no such module": ('class = "no_such_module:Good"', "no_such_module"),
    "a folder": ('class = "folder.py:Good"', "folder.py"),
    "no module's name": ('class = "my-own.py:Good"', "my-own.py"),
    "a module of Python's": ('class = "tabnanny.py:Good"', "tabnanny"),
    "syntax": ('class = "broken_file.py:Good"', "broken_file"),
    "raises": ('class = "raising_file.py:Good"', "raising_file"),
    "exits": ('class = "leaving_file.py:Good"', "leaving_file"),
    "a value": ('class = "mine.py:value"', "value"),
    "no System": ('class = "mine.py:Nothing"', "Nothing"),
    "another's class": ('class = "json:JSONDecoder"', "JSONDecoder"),
    "unknown key": ('class = "mine.py:Good"\nK = 1.0', "did you mean"),
    "no number": ('class = "mine.py:Good"\nk = "x"', "k"),
    "nan": ('class = "mine.py:Good"\nk = nan', "k"),
    "a list": ('class = "mine.py:Good"\nk = [1.0]', "k"),
    "refuses": ('class = "mine.py:Stubborn"', "Stubborn"),
    "no equation": ('class = "mine.py:NoNumber"', "equation"),
    "a bug": ('class = "mine.py:Lost"', "mine.py, line"),
    "a wrong shape": ('class = "mine.py:Shape"', "F"),
    "nan matrices": ('class = "mine.py:Nan"', "F"),
    "no arguments": ('class = "mine.py:Positional"', "Positional"),
    "parameters of words": ('class = "mine.py:Words"', "parameters"),
    "parameters a number": ('class = "mine.py:NoList"', "parameters"),
}


def files(folder: Path) -> None:
    """Write what the commands ask for."""
    from scipy.io import savemat

    for k, (text, _) in enumerate(GENERAL.values()):
        whole = f'kind = "matrices"\n[forcing]\nOmega = 2.0\n[system]\n{text}'
        (folder / f"general-{k}.toml").write_text(whole, encoding="utf-8")
    for k, (text, _) in enumerate(PYTHON.values()):
        whole = f'kind = "python"\n{FORCING}[system]\n{text}\n'
        (folder / f"python-{k}.toml").write_text(whole, encoding="utf-8")
    python = {
        "mine.py": MODULE,
        "my-own.py": MODULE,
        "tabnanny.py": MODULE,
        "broken_file.py": "class Good(:",
        "raising_file.py": 'raise RuntimeError("two\\nlines")',
        "leaving_file.py": "import sys\nsys.exit(3)",
    }
    for name, text in python.items():
        (folder / name).write_text(text, encoding="utf-8")
    for name in ("folder.py", "folder.npz"):
        (folder / name).mkdir()
    odd: dict[str, Any] = {
        "objects": np.array([[None]], dtype=object),
        "complex": np.array([[1.0 + 1.0j]]),
        "words": np.array([["x"]]),
        "cube": np.ones((2, 2, 2)),
        "nan": np.array([[np.nan]]),
    }
    np.savez(folder / "odd.npz", **odd)
    np.save(folder / "single.npy", np.eye(1))
    (folder / "single.npz").write_bytes((folder / "single.npy").read_bytes())
    (folder / "cut.npz").write_bytes((folder / "odd.npz").read_bytes()[:200])
    named = {"F": np.eye(2), "words": "some words", "struct": {"K": np.eye(2)}}
    savemat(folder / "good.mat", named)
    (folder / "cut.mat").write_bytes((folder / "good.mat").read_bytes()[:150])
    (folder / "empty.mat").write_bytes(b"")
    # MATLAB's header of version 7.3: HDF5 behind it
    header = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
    (folder / "new.mat").write_bytes(header.ljust(512, b"\x00") + b"\x89HDF\r\n\x1a\n")
    matrix_market = "%%MatrixMarket matrix"
    market = {
        "notes": "these are notes\n",
        "cut": f"{matrix_market} coordinate real general\n3 3 3\n1 1 1.0\n",
        "complex": f"{matrix_market} coordinate complex general\n1 1 1\n1 1 1.0 1.0\n",
        "wide": f"{matrix_market} coordinate real general\n9999999 9999999 1\n1 1 1.0\n",
        "empty": "",
    }
    for name, text in market.items():
        (folder / f"{name}.mtx").write_text(text, encoding="utf-8")


def commands() -> Commands:
    """Each file by `verify system`; some by the commands that take any system too."""
    found: Commands = {}
    for kind, cases in (("general", GENERAL), ("python", PYTHON)):
        for k, (name, (_, named)) in enumerate(cases.items()):
            found[f"{kind} {name}"] = (["system", f"{kind}-{k}.toml"], named)
    axes = ["--x", "Omega", "1", "2", "4", "--y", "gamma", "0", "0.2", "3"]
    general, python = list(GENERAL), list(PYTHON)
    for name in ("singular M", "K cos far", "npz without", "mat 7.3"):
        file = f"general-{general.index(name)}.toml"
        found[f"chart of {name}"] = (["chart", file, *axes], "")
        found[f"sensitivity of {name}"] = (["sensitivity", file], "")
    for name in ("no such class", "exits", "no equation", "a bug", "a wrong shape", "no arguments"):
        file = f"python-{python.index(name)}.toml"
        found[f"chart of python {name}"] = (["chart", file, *axes], "")
        found[f"sensitivity of python {name}"] = (["sensitivity", file], "")
    good = f"python-{len(PYTHON)}.toml"
    assert good not in found
    for value in ("mathieu,kincaid", "Mathieu", "kincade", "kincaid ", "../mathieu", "1"):
        found[f"publication of {value!r}"] = (["--publication", value], "publication")
    mathieu = ["--publication", "mathieu"]
    for words in (["--table", "9"], ["--row", "T1-01"], ["--modes", "3"], ["--more-terms"]):
        found[f"mathieu {words[0]}"] = ([*mathieu, *words], words[0].strip("-"))
    return found
