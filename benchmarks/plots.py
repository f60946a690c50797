"""The page's figures as SVG, the same bytes for the same numbers; needs matplotlib."""

import io
from typing import Any

from benchmarks.measure import spread

STYLE: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.size": 8.0,
    "axes.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.0,
    "svg.fonttype": "none",
    "svg.hashsalt": "performance",
}
LOOKS = (
    ("chart", "black", "o"),
    ("floquet batch, numpy", "#3E95C7", "v"),
    ("floquet batch", "#0072B2", "s"),
    ("floquet", "#0072B2", "o"),
    ("hill batch", "#D55E00", "s"),
    ("hill", "#D55E00", "o"),
    ("heyoka", "#009E73", "D"),
    ("SciPy LSODA", "#7A7A7A", "^"),
    ("SciPy DOP853", "#A66E00", "P"),
    ("CasADi", "#B5568F", "X"),
)
"""Okabe and Ito's colours, darker where they carry thin lines: a contender's in every figure."""
LABELS = {
    "number": ("points", "microseconds a point"),
    "modes": ("bending modes", "microseconds a point"),
    "tolerance": ("microseconds a point", "error reached"),
}


def figures(results: dict[str, Any]) -> dict[str, bytes]:
    """File names with their contents; none where matplotlib is not installed."""
    try:
        import matplotlib
    except ImportError:
        return {}
    rc: Any = STYLE
    vectors = results["machine"]["vectors"]
    with matplotlib.rc_context(rc):
        return {
            f"performance-{vectors}-{name}.svg": _drawn(name, results[name]["curves"])
            for name in LABELS
            if name in results and shown(name, results[name]["curves"])
        }


def shown(name: str, curves: dict[str, list[dict[str, Any]]]) -> bool:
    """Whether there is anything to draw: errors are not known without the reference."""
    return any(curve(name, points)[0] for points in curves.values())


def curve(name: str, points: list[dict[str, Any]]) -> tuple[list[float], list[float]]:
    """Where the marks of a contender go in one of the figures: x, y."""
    times = [1e6 * spread(p["seconds"]).median for p in points]
    if name == "tolerance":
        known = [(t, p["error"]) for t, p in zip(times, points, strict=True) if p["error"]]
        return [t for t, _ in known], [e for _, e in known]
    return [p["points" if name == "number" else "modes"] for p in points], times


def look(name: str) -> tuple[str, str]:
    """Colour and mark of a contender."""
    return next((colour, mark) for start, colour, mark in LOOKS if name.startswith(start))


def _drawn(name: str, curves: dict[str, list[dict[str, Any]]]) -> bytes:
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    FigureCanvasSVG(figure)
    axes = figure.add_subplot()
    for label, points in curves.items():
        x, y = curve(name, points)
        colour, mark = look(label)
        axes.plot(x, y, marker=mark, color=colour, mfc="white", label=label)
    axes.set(xscale="log", yscale="log", xlabel=LABELS[name][0], ylabel=LABELS[name][1])
    if name == "modes":
        counts = sorted({p["modes"] for points in curves.values() for p in points})
        axes.set_xticks(counts, [str(c) for c in counts])
    axes.minorticks_off()
    axes.grid(True, which="major", linewidth=0.3, color="#cccccc")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    buffer = io.BytesIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    return buffer.getvalue()
