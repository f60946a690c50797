"""How the figures look: type, colours, symbols, captions."""

import re
from collections.abc import Callable
from typing import Any

from compare.report.figures.catalogue import Figure
from compare.report.figures.data import FigureData
from compare.report.tables import ETA, GAMMA

WIDTH = 7.1
"""Inches: the width of a page's text."""

RC: dict[str, Any] = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 9.0,
    "axes.labelsize": 9.5,
    "axes.titlesize": 9.0,
    "axes.linewidth": 0.6,
    "axes.formatter.use_mathtext": True,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.5,
    "ytick.major.width": 0.5,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.4,
    "hatch.linewidth": 0.45,
    "savefig.dpi": 300,
    "svg.hashsalt": "figures",
}

COLOURS = {
    "2 omega_(B)": "#0072B2",
    "omega_(1) + omega_(B)": "#D55E00",
    "omega_(2) - omega_(1)": "#A66E00",
    "2 omega_(1)": "#009E73",
    "(2 omega_(1))/3": "#009E73",
    "2 omega_(1) and omega_L": "#009E73",
    "2 omega_L": "#555555",
    "omega_(2) - omega_(B)": "#7A7A7A",
    "omega_(2) + omega_(B)": "#B5568F",
    "omega_(2) + omega_(1)": "#444444",
    "2 omega_(2)": "#3E95C7",
}
"""Okabe and Ito's, told apart by everybody; darker where they carry thin lines."""

SEQUENCE = ("#0072B2", "#D55E00", "#009E73", "#B5568F", "#444444")
"""Of a family of curves."""

PRINTED: dict[str, Any] = {
    "marker": "D",
    "ms": 3.6,
    "mfc": "black",
    "mec": "white",
    "mew": 0.5,
    "ls": "none",
}
MARK: dict[str, Any] = {"marker": "o", "ms": 3.4, "mfc": "white", "mew": 0.7, "ls": "none"}

SYMBOLS = {
    "T0": r"\bar T_0",
    "K_theta": r"K_\theta",
    "xi_G": r"\xi_G",
    "xi_c": r"\xi_c",
    "area_ratio": r"A_1/A_2",
    "inertia_ratio": r"I_1/I_2",
    "gamma": r"\gamma",
    "eta": r"\eta",
    "g": "g",
}
ROUTES = {"hill": "Hill's determinant", "floquet": "the monodromy matrix"}


def resonance(name: str) -> str:
    """A resonance's name as mathematics."""
    text = re.sub(r"omega_\((\w)\)", r"\\bar\\omega_{(\1)}", name)
    text = text.replace("omega_L", r"\bar\omega_L").replace(" and ", r"\ \mathrm{and}\ ")
    if text.startswith("("):
        text = re.sub(r"^\((.*)\)/(\d)$", r"\1/\2", text)
    return f"${text}$"


def value(name: str) -> str:
    """A parameter and its value, T0 = 5, as mathematics."""
    symbol, number = name.split(" = ")
    return f"${SYMBOLS[symbol]}={number}$"


def colour(name: str) -> str:
    """Of a resonance."""
    return COLOURS.get(name, "black")


def parameters(figure: Figure) -> str:
    """What was held constant."""
    varied = {figure.along} | ({"T0"} if figure.kind in ("frequencies", "critical") else set())
    held = {name: v for name, v in figure.beam.items() if name not in varied}
    if figure.kind == "integral":
        return ""
    text = [f"${SYMBOLS[name]}={v:g}$" for name, v in held.items()]
    if figure.kind not in ("frequencies", "critical") and figure.along != "gamma":
        text.append(rf"$\gamma={GAMMA:g}$")
    if figure.kind == "frequencies":
        text.append(r"$\eta=0$")
    elif figure.eta:
        text.append(rf"$\eta={ETA:g}$" + (" (dashed)" if figure.kind == "growth" else ""))
    else:
        text.append(r"$\eta=0$")
    if figure.kind not in ("frequencies", "compliance"):
        rigid = figure.omega_L == float("inf")
        text.append(r"$\bar\omega_L=\infty$" if rigid else rf"$\bar\omega_L={figure.omega_L:g}$")
    return "$N=2$, " + ", ".join(text) + "."


def caption(figure: Figure, data: FigureData) -> str:
    """The report's caption, what was assumed, the routes and their largest disagreement."""
    parts = [rf"$\bf{{Figure\ {figure.number}.}}$ {figure.caption}", parameters(figure)]
    if figure.assumed:
        parts.append(f"Not in the report and assumed: {figure.assumed}.")
    if note := NOTES.get(figure.number, ""):
        parts.append(note)
    parts.append(_routes(data))
    return " ".join(part for part in parts if part)


def _routes(data: FigureData) -> str:
    sources = {role: {s.source for s in data.select(role)} for role in ("curve", "region", "mark")}
    curves = (sources["curve"] | sources["region"]) & set(ROUTES)
    marks = sources["mark"]
    if data.quantity in ("omega", "the integral"):
        names = {"hill": "closed form", "floquet": "Galerkin quadrature"}
    else:
        names = ROUTES
    quantity = {"T": "$T$", "Omega": r"$\bar\Omega$", "omega": r"$\bar\omega$"}
    text = f"Curves: {names[curves.pop()]}; circles: {names[marks.pop()]}; "
    text += f"largest disagreement in {quantity.get(data.quantity, data.quantity)} "
    text += _power(data.disagreement) + "."
    tables = sorted({s.source for s in data.select("printed") if len(s.x)})
    if tables:
        text += f" Diamonds: as printed in {', '.join(tables)}.".replace("Table ", "Table\u00a0")
    return text


def _power(number: float) -> str:
    if number == 0.0:
        return "0"
    mantissa, exponent = f"{number:.0e}".split("e")
    return rf"${mantissa}\times10^{{{int(exponent)}}}$"


def wrapped(text: str, width: Callable[[str], float], room: float) -> str:
    """Lines no wider than `room`; mathematics is not broken."""
    lines: list[str] = []
    used, space = room, 0.55 * width("n")
    for word in re.findall(r"(?:\$[^$]*\$|[^ $])+", text):
        size = width(word)
        if used + space + size > room:
            lines.append(word)
            used = size
        else:
            lines[-1] += " " + word
            used += space + size
    return "\n".join(lines)


FIRST_ORDER = (
    "First order only, as in the report: narrow instabilities of higher order, not drawn, "
    "cross and notch these."
)
HOLLOW = r"Open diamonds are printed with no growth."
REPELS = (
    r"The first panel also has $2\bar\omega_{(1)}/3$, which $2\bar\omega_{(B)}$ meets and repels."
)
OUTLINES = "Grey: without damping."
TRUNCATED = (
    r"The printed $T$ come from a determinant cut short, which matters most near "
    r"$2\bar\omega_{(B)}$."
)
SHADED = "Shaded: stable at this and every smaller $\\gamma$."
NOTES = {
    3: "Crosses: inertial buckling, at 26.58 with two modes; the report's 25.67 is close to the "
    "limit of many modes, 25.64.",
    8: TRUNCATED + " The diamond at 4.975 is a misprint for 4.979.",
    9: f"{FIRST_ORDER} {HOLLOW}",
    10: f"{FIRST_ORDER} {HOLLOW}",
    4: r"Crosses: inertial buckling at 26.58, coalescence at 14.66 ($\xi_G=0$) and 17.15 (0.25).",
    5: "Crosses: inertial buckling.",
    6: "Crosses: inertial buckling.",
    7: "Crosses: inertial buckling.",
    11: f"{SHADED} {TRUNCATED}",
    **dict.fromkeys((12, 13, 14, 22, 23), SHADED),
    21: f"{SHADED} {TRUNCATED}",
    15: f"{FIRST_ORDER} {OUTLINES} Open diamonds: $T\\leq\\eta$.",
    16: f"{FIRST_ORDER} {OUTLINES} Open diamonds: $T\\leq\\eta$.",
    17: TRUNCATED,
    18: f"{FIRST_ORDER} {REPELS} {HOLLOW}",
    19: f"{FIRST_ORDER} {REPELS} {HOLLOW}",
    20: f"{SHADED} Spikes: instabilities of higher order that cross the resonance. {TRUNCATED}",
    24: f"{FIRST_ORDER} {REPELS} {OUTLINES} Open diamonds: $T\\leq\\eta$.",
    25: f"{FIRST_ORDER} {REPELS} {OUTLINES} Open diamonds: $T\\leq\\eta$.",
    26: r"Dotted: $\bar\omega_L=\bar\Omega$, where $G$ is infinite; curves begin at three quarters "
    f"of it. {TRUNCATED}",
    27: r"Both pass through $\bar\sigma=2$ without a pole, which is in off-diagonal elements only.",
    28: r"At $\bar\Omega=2$ the bar resonates.",
    29: "Filled: unstable with $g=0.08$. Hatched: only without longitudinal damping. "
    + FIRST_ORDER,
}
"""What is seen in a figure and needs a word."""
