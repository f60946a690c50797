"""A chart as a picture: T as colour, boundaries as lines, tongues named, printed rows as marks."""

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.boundaries import Tongue
from compare.charts.compute import Chart
from compare.tables import all_rows
from hill import SteppedBeam, UniformBeam

SYMBOLS = {
    "Omega": r"$\Omega$",
    "gamma": r"$\gamma$",
    "eta": r"$\eta$",
    "T0": r"$T_0$",
    "K_theta": r"$K_\theta$",
    "xi_G": r"$\xi_G$",
    "xi_c": r"$\xi_c$",
    "omega_L": r"$\omega_L$",
    "g": r"$g$",
}
STYLE: Any = {
    "font.family": "serif",
    "mathtext.fontset": "cm",
    "font.size": 9,
    "axes.linewidth": 0.6,
    "svg.hashsalt": "floquet-crosscheck",
}


def picture(chart: Chart, boundaries: Sequence[Tongue], kind: str) -> bytes:
    """The chart as PNG or SVG.

    Raises
    ------
    ValueError
        The chart has not two axes, or matplotlib is not installed.
    """
    if len(chart.axes) != 2:
        raise ValueError(f"a picture needs two axes, the chart has {len(chart.axes)}")
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.colors import LogNorm
        from matplotlib.figure import Figure
    except ImportError:
        raise ValueError(
            'pictures need matplotlib: pip install "floquet-crosscheck[plot]"'
        ) from None
    x, y = chart.axes
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(7.2, 4.6), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.add_subplot()
        unstable = np.ma.masked_less_equal(np.where(np.isfinite(chart.T), chart.T, 0.0), 1e-6)
        extent = (x.low, x.high, y.low, y.high)
        if unstable.count():
            top = float(unstable.max())
            norm = LogNorm(max(top / 300.0, 1e-5), top)
            shown = axes.imshow(
                unstable,
                extent=extent,
                origin="lower",
                aspect="auto",
                cmap="viridis_r",
                norm=norm,
                interpolation="none",
                rasterized=True,
            )
            figure.colorbar(shown, ax=axes, pad=0.015, label="$T$, twice the growth exponent")
        for tongue in boundaries:
            line: dict[str, Any] = {"color": "black", "linewidth": 0.6}
            axes.plot(tongue.lower, tongue.y, **line)
            axes.plot(tongue.upper, tongue.y, **line)
        _name(axes, boundaries, x.low, x.high, y.low, y.high)
        _marks(axes, chart)
        axes.set(xlim=(x.low, x.high), ylim=(y.low, y.high))
        axes.set_xlabel(SYMBOLS.get(x.name, x.name))
        axes.set_ylabel(SYMBOLS.get(y.name, y.name))
        axes.set_title(_title(chart), fontsize=8, loc="left")
        buffer = io.BytesIO()
        metadata = {"Date": None} if kind == "svg" else {"Software": None}
        figure.savefig(buffer, format=kind, dpi=200, metadata=metadata)
    return buffer.getvalue()


def _name(
    axes: Any, boundaries: Sequence[Tongue], left: float, right: float, low: float, high: float
) -> None:
    """Names of the wider tongues above the frame, no two on top of one another."""
    tops = []
    for tongue in boundaries:
        pair = tongue.at(high) or tongue.at(float(tongue.y[-1]))
        if pair and left < sum(pair) / 2 < right:
            tops.append((pair[1] - pair[0], sum(pair) / 2, tongue.resonance.name))
    taken: list[float] = []
    for _, centre, name in sorted(tops, reverse=True):
        if all(abs(centre - other) > 0.03 * (right - left) for other in taken):
            taken.append(centre)
            axes.annotate(
                _math(name),
                (centre, high),
                xytext=(0, -3),
                textcoords="offset points",
                rotation=90,
                ha="center",
                va="top",
                fontsize=6.5,
                bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7},
            )


def _math(name: str) -> str:
    return "$" + name.replace("omega_(", r"\omega_{(").replace(")", ")}", name.count("omega")) + "$"


def _marks(axes: Any, chart: Chart) -> None:
    """The printed rows of Table 1 or 2 that lie on this chart."""
    x, y = chart.axes
    if (x.name, y.name) != ("Omega", "gamma") or chart.family.forcing.get("eta", 0.0):
        return
    table = 1 if isinstance(chart.family.beam, UniformBeam) else 2
    for row in all_rows((table,)):
        if row.beam(chart.family.beam.modes) != chart.family.beam:
            return
        if x.low <= row.Omega <= x.high and y.low <= row.gamma <= y.high:
            fill = "black" if row.T > 0.0 else "white"
            axes.plot(row.Omega, row.gamma, "o", ms=2.6, mfc=fill, mec="black", mew=0.5)


def _title(chart: Chart) -> str:
    beam = chart.family.beam
    kind = "stepped beam" if isinstance(beam, SteppedBeam) else "uniform beam"
    varied = {axis.name for axis in chart.axes}
    fixed = {k: v for k, v in vars(beam).items() if k not in varied}
    fixed |= {k: v for k, v in chart.family.forcing.items() if k not in varied}
    text = ", ".join(
        f"{SYMBOLS.get(k, k.replace('_', ' '))} = {_value(v)}" for k, v in fixed.items()
    )
    words = f"{kind}: {text}"
    if chart.route == "both":
        words += f"; the routes differ by {chart.disagreement:.0e} of P at most"
    return words


def _value(value: float) -> str:
    return r"$\infty$" if value == np.inf else f"{value:g}"
