"""Names and numbers as HTML: Greek letters, subscripts, powers; whatever else is escaped."""

import math
import re
from html import escape, unescape

_NAMES = """
alpha beta gamma delta epsilon zeta eta theta lambda mu nu xi pi rho sigma tau phi chi psi omega
Gamma Delta Theta Lambda Xi Sigma Phi Psi Omega
"""
GREEK = dict(zip(_NAMES.split(), "αβγδεζηθλμνξπρστφχψωΓΔΘΛΞΣΦΨΩ", strict=True))

_LETTER = rf"{'|'.join(GREEK)}|Fbar|[A-Za-z]"
_SUBSCRIPT = re.compile(
    rf"(?<![A-Za-z0-9_])({_LETTER})_(\([^()\s]*\)|[A-Za-z0-9]+)(?![A-Za-z0-9_])"
)
_WORD = re.compile(rf"(?<![A-Za-z0-9_])({'|'.join(GREEK)}|Fbar)(?![A-Za-z0-9_])")
_THRUST = re.compile(r"(?<![A-Za-z0-9_])T([01])(?![A-Za-z0-9_-])")
_POWER = re.compile(r"\^(\([^()]*\)|-?[A-Za-z0-9]+)")
_MINUS = re.compile(r"(?<![\w)\]])-(?=[.\d])")
_SMALL = re.compile(r"(?<![\w.])([+−-]?\d*\.?\d+)e([+-])0*(\d+)(?!\w)")
_TIMES = "\N{NO-BREAK SPACE}×\N{NO-BREAK SPACE}10"
_SIGNS = (("+-", "±"), ("-&gt;", "→"), ("&gt;=", "≥"), ("&lt;=", "≤"))


def as_html(text: str) -> str:
    """Words with the formulas in them, escaped: ``omega_(1)^2`` as ω with (1) below and 2 above.

    What stands between backticks is code, and left as it is.
    """
    parts = re.split(r"`([^`]*)`", text)
    return "".join(
        f"<code>{escape(part)}</code>" if k % 2 else _formulas(escape(part))
        for k, part in enumerate(parts)
    )


def _formulas(text: str) -> str:
    for sign, letter in _SIGNS:
        text = text.replace(sign, letter)
    text = _SMALL.sub(lambda m: f"{m[1]}{_TIMES}<sup>{_exponent(m[2], m[3])}</sup>", text)
    text = _SUBSCRIPT.sub(lambda m: f"<var>{_letter(m[1])}</var><sub>{_below(m[2])}</sub>", text)
    text = _THRUST.sub(r"<var>T</var><sub>\1</sub>", text)
    text = _WORD.sub(lambda m: f"<var>{_letter(m[1])}</var>", text)
    text = _POWER.sub(lambda m: f"<sup>{m[1].strip('()').replace('-', '−')}</sup>", text)
    return _MINUS.sub("−", text)


def _letter(name: str) -> str:
    return "F̄" if name == "Fbar" else GREEK.get(name, name)


def _below(name: str) -> str:
    return GREEK.get(name, name)


def _exponent(sign: str, digits: str) -> str:
    return ("−" if sign == "-" else "") + digits


def plain(text: str) -> str:
    """The same without marks, for where only letters can stand: ω_(1)."""
    text = _WORD.sub(lambda m: _letter(m[1]), text)
    return _SUBSCRIPT.sub(lambda m: f"{_letter(m[1])}_{m[2]}", text)


def number(value: float | None, digits: int = 9) -> str:
    """A number to so many significant digits; without one, a dash."""
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0.0 else "−∞"
    mantissa, _, exponent = f"{value + 0.0:.{digits}g}".partition("e")
    shown = mantissa.replace("-", "−")
    if not exponent:
        return shown
    return f"{shown}{_TIMES}<sup>{int(exponent)}</sup>".replace("<sup>-", "<sup>−")


def complex_number(value: complex, digits: int = 9) -> str:
    """A complex number; a real one without its imaginary part."""
    if value.imag == 0.0:
        return number(value.real, digits)
    sign = "−" if value.imag < 0.0 else "+"
    return f"{number(value.real, digits)} {sign} {number(abs(value.imag), digits)}<var>i</var>"


_MATHTEXT = (
    (r"\\bf\{((?:[^{}]|\{[^{}]*\})*)\}", r"<b>\1</b>"),
    (r"\\mathrm\{([^{}]*)\}", r"\1"),
    (r"\\bar\s*", "BAR"),
    (r"\\times", "×"),
    (r"\\leq", "≤"),
    (r"\\infty", "∞"),
    (r"\\ ", " "),
    (r"_\{([^{}]*)\}", r"<sub>\1</sub>"),
    (r"\^\{([^{}]*)\}", r"<sup>\1</sup>"),
    (r"_(\\[A-Za-z]+|\w)", r"<sub>\1</sub>"),
    (r"\^(\w)", r"<sup>\1</sup>"),
)


def from_mathtext(text: str) -> str:
    r"""A caption with formulas as ``$\bar\Omega$`` as HTML, escaped."""
    parts = escape(text, quote=False).split("$")
    return "".join(_of_mathtext(part) if k % 2 else part for k, part in enumerate(parts))


def _of_mathtext(formula: str) -> str:
    for pattern, made in _MATHTEXT:
        formula = re.sub(pattern, made, formula)
    formula = re.sub(r"\\([A-Za-z]+)", lambda m: GREEK.get(m[1], m[1]), formula)
    formula = re.sub(r"BAR(\w)", "\\1\N{COMBINING MACRON}", formula).replace("-", "−")
    return re.sub(r"(?<=\S)=(?=\S)", " = ", formula)


def words_of_mathtext(text: str) -> str:
    """The same without marks, for the words that stand for a picture."""
    made = re.sub(r"</?(?:b|sub|sup)>", "", from_mathtext(text))
    return unescape(made).replace("\N{COMBINING MACRON}", "")
