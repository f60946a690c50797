"""A chart as a picture: T as colour, boundaries as lines, tongues named, printed rows as marks."""

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.charts.result import Chart
from compare.report.tables import all_rows
from compare.tongues.boundaries import Tongue
from compare.tongues.curves import Curve
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


NO_PICTURES = 'pictures need matplotlib: pip install "floquet-crosscheck[plot]"'

QUANTITIES = ("T", "disagreement")

LEAST = 1e-17
"""Where the routes agree to the last bit, a disagreement is drawn as this."""


def picture(
    chart: Chart, boundaries: Sequence[Tongue | Curve], kind: str, quantity: str = "T"
) -> bytes:
    """The chart as PNG or SVG.

    Parameters
    ----------
    chart : Chart
    boundaries : sequence of Tongue or Curve
        Drawn as lines; tongues with their names.
    kind : {"png", "svg"}
    quantity : {"T", "disagreement"}, optional
        T over the chart, or how far the two routes differ at its nodes.

    Raises
    ------
    ValueError
        The chart has not two axes, or no disagreement to draw; matplotlib is not installed.
    """
    if len(chart.axes) != 2:
        raise ValueError(f"a picture needs two axes, the chart has {len(chart.axes)}")
    if quantity == "disagreement" and chart.route != "both":
        raise ValueError(f"disagreement: needs route = 'both', the chart has {chart.route!r}")
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise ValueError(NO_PICTURES) from None
    x, y = chart.axes
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(7.2, 4.6), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.add_subplot()
        (_growth if quantity == "T" else _disagreement)(figure, axes, chart)
        for boundary in boundaries:
            for along, across in _lines(boundary, x.name):
                axes.plot(along, across, color="black", linewidth=0.6)
        if quantity == "T":
            _name(axes, chart, [b for b in boundaries if isinstance(b, Tongue)])
            _marks(axes, chart)
        axes.set(xlim=(x.low, x.high), ylim=(y.low, y.high))
        axes.set_xlabel(SYMBOLS.get(x.name, x.name))
        axes.set_ylabel(SYMBOLS.get(y.name, y.name))
        axes.set_title(_title(chart), fontsize=8, loc="left")
        buffer = io.BytesIO()
        metadata = {"Date": None} if kind == "svg" else {"Software": None}
        figure.savefig(buffer, format=kind, dpi=200, metadata=metadata)
    return buffer.getvalue()


def _lines(boundary: Tongue | Curve, x: str) -> list[tuple[Any, Any]]:
    """What to draw of a boundary, whichever axis Omega is."""
    if isinstance(boundary, Curve):
        return [(boundary.x, boundary.y)]
    edges = [(edge, boundary.y) for edge in (boundary.lower, boundary.upper)]
    return edges if x == "Omega" else [(y, edge) for edge, y in edges]


def _growth(figure: Any, axes: Any, chart: Chart) -> None:
    """T as colour, white where the beam is stable."""
    from matplotlib.colors import LogNorm

    x, y = chart.axes
    unstable = np.ma.array(chart.T, mask=~(chart.unstable() & np.isfinite(chart.T)))
    if unstable.count():
        top = float(unstable.max())
        shown = axes.imshow(
            unstable,
            extent=(x.low, x.high, y.low, y.high),
            origin="lower",
            aspect="auto",
            cmap="viridis_r",
            norm=LogNorm(max(top / 300.0, 1e-5), top),
            interpolation="none",
            rasterized=True,
        )
        figure.colorbar(shown, ax=axes, pad=0.015, label="$T$, twice the growth exponent")
    _states(axes, chart)


def _states(axes: Any, chart: Chart) -> None:
    """Where no verdict is shown, and where T is beyond a float or there is no equation."""
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    x, y = chart.axes
    infinite = np.isinf(chart.T)
    found = (
        (chart.undecided() & ~infinite, "undecided", "0.55"),
        (chart.undecided() & infinite, "longitudinal resonance", "tab:orange"),
        (chart.unstable() & infinite, "growth beyond a float", "tab:red"),
    )
    patches = [Patch(fc="white", ec="black", lw=0.4, label="stable")]
    for where, label, colour in found:
        if np.any(where):
            axes.imshow(
                np.ma.array(np.ones(where.shape), mask=~where),
                extent=(x.low, x.high, y.low, y.high),
                origin="lower",
                aspect="auto",
                cmap=ListedColormap([colour]),
                interpolation="none",
                rasterized=True,
            )
            patches.append(Patch(fc=colour, ec="none", label=label))
    if len(patches) > 1:
        axes.legend(
            handles=patches,
            loc="upper left",
            bbox_to_anchor=(0.0, -0.12),
            ncols=len(patches),
            fontsize=6.5,
            frameon=False,
        )


def _disagreement(figure: Any, axes: Any, chart: Chart) -> None:
    """How far the routes differ, at every node."""
    from matplotlib.colors import LogNorm

    apart = np.maximum(chart.apart, LEAST)
    shown = axes.scatter(*chart.sampled.T, c=apart, s=7, cmap="magma_r", norm=LogNorm(), lw=0)
    label = "largest difference of a coefficient of $P(z)$,\nover the largest coefficient"
    figure.colorbar(shown, ax=axes, pad=0.015, label=label)


def _name(axes: Any, chart: Chart, boundaries: Sequence[Tongue]) -> None:
    """Names of the wider tongues along the far side of the frame, none on top of another."""
    x, y = chart.axes
    along, other = (x, y) if x.name == "Omega" else (y, x)
    tops = []
    for tongue in boundaries:
        pair = tongue.at(other.high) or tongue.at(float(tongue.y[-1]))
        if pair and along.low < sum(pair) / 2 < along.high:
            tops.append((pair[1] - pair[0], sum(pair) / 2, tongue.resonance.name))
    taken: list[float] = []
    upright = along is x
    for _, centre, name in sorted(tops, reverse=True):
        if all(abs(centre - t) > 0.03 * (along.high - along.low) for t in taken):
            taken.append(centre)
            axes.annotate(
                _math(name),
                (centre, other.high) if upright else (other.high, centre),
                xytext=(0, -3) if upright else (-3, 0),
                textcoords="offset points",
                rotation=90 if upright else 0,
                ha="center" if upright else "right",
                va="top" if upright else "center",
                fontsize=6.5,
                bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7},
            )


def _math(name: str) -> str:
    return "$" + name.replace("omega_(", r"\omega_{(").replace(")", ")}", name.count("omega")) + "$"


def _marks(axes: Any, chart: Chart) -> None:
    """The printed rows of Table 1 or 2 that lie on this chart."""
    x, y = chart.axes
    if {x.name, y.name} != {"Omega", "gamma"} or chart.family.forcing.get("eta", 0.0):
        return
    table = 1 if isinstance(chart.family.beam, UniformBeam) else 2
    for row in all_rows((table,)):
        if row.beam(chart.family.beam.modes) != chart.family.beam:
            return
        at = [getattr(row, axis.name) for axis in (x, y)]
        if x.low <= at[0] <= x.high and y.low <= at[1] <= y.high:
            fill = "black" if row.T > 0.0 else "white"
            axes.plot(*at, "o", ms=2.6, mfc=fill, mec="black", mew=0.5)


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
