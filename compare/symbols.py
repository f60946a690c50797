"""Names and numbers as mathematics, for pictures."""

import re
import unicodedata

import numpy as np

from hill.averaging import Resonance

GREEK = frozenset(
    re.findall(
        r"\w+",
        """alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi rho sigma tau phi chi
        psi omega Gamma Delta Theta Lambda Xi Sigma Phi Psi Omega""",
    )
)


def symbol(name: str) -> str:
    """A parameter's name as mathematics, or as words where it is more than a letter."""
    found = re.fullmatch(r"([A-Za-z]+?)(?:_?(\d+)|_([A-Za-z]+))?", name)
    if found is None or not (len(found[1]) == 1 or found[1] in GREEK):
        return name.replace("_", " ").replace("$", r"\$")
    base, below = _letter(found[1]), found[2] or found[3]
    return f"${base}_{{{_subscript(below)}}}$" if below else f"${base}$"


def _letter(word: str) -> str:
    return f"\\{word}" if word in GREEK else word


def _subscript(word: str) -> str:
    if len(word) == 1 or word in GREEK or word.isdigit():
        return _letter(word)
    kept = re.sub(r"[^A-Za-z0-9 .+-]", " ", word).replace(" ", r"\ ")
    return rf"\mathrm{{{kept}}}"


def of_resonance(resonance: Resonance) -> str:
    """A resonance's name as mathematics."""
    first, second = (rf"\omega_{{({_subscript(name)})}}" for name in resonance.frequencies)
    pair = f"2 {first}" if first == second else f"{first} {'+-'[resonance.sign < 0]} {second}"
    return f"${pair}$" if resonance.order == 1 else f"$({pair})/{resonance.order}$"


def of_value(value: float) -> str:
    """A number, infinity among them."""
    return r"$\infty$" if value == np.inf else f"{value:g}"


def in_letters(name: str) -> str:
    """A parameter's name in Unicode's letters, for where there is no mathematics: "T₀", "K_θ"."""
    base, _, below = re.sub(r"^([A-Za-z])(\d+)$", r"\1_\2", name).partition("_")
    if not (len(base) == 1 or base in GREEK):
        return name.replace("_", " ")
    if below.isdecimal() and below.isascii():
        return _greek(base) + "".join(chr(0x2080 + int(digit)) for digit in below)
    return f"{_greek(base)}_{_greek(below)}" if below else _greek(base)


def _greek(word: str) -> str:
    if word not in GREEK:
        return word
    size = "SMALL" if word[0].islower() else "CAPITAL"
    # Unicode spells it in its own way
    return unicodedata.lookup(
        f"GREEK {size} LETTER {word.lower().replace('lambda', 'lamda').upper()}"
    )
