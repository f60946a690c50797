"""What goes on the axes of each kind of figure."""

from typing import Any

from compare.report.figures import style
from compare.report.figures.catalogue import ORDER, Figure
from compare.report.figures.compliance import CLOSEST, HIGHEST
from compare.report.figures.critical import BOTTOM, TOP
from compare.report.figures.data import FigureData, Series
from compare.report.figures.frequencies import LOWER, UPPER

HOLLOW = style.MARK


def line(axes: Any, s: Series, colour: str, **more: Any) -> None:
    """A curve, solid or dashed."""
    dashes = {"ls": (0, (4, 2))} if s.damped else {}
    axes.plot(s.x, s.y, color=colour, **(dashes | more))


def dots(axes: Any, s: Series, colour: str) -> None:
    """Marks of the other route, both edges of a region."""
    for y in s.edges:
        axes.plot(s.x, y, mec=colour, zorder=4, **style.MARK)


def printed(axes: Any, s: Series, **more: Any) -> None:
    """As the report prints them."""
    axes.plot(s.x, s.y, zorder=5, **(style.PRINTED | more))


def title(axes: Any, text: str, x: float = 0.04, y: float = 0.95, **more: Any) -> None:
    """A panel's name, inside it."""
    axes.text(x, y, text, transform=axes.transAxes, va="top", fontsize=9.0, **more)


def frequencies(page: Any, figure: Figure, data: FigureData) -> None:
    """Two axes over T0: omega_(2) above, the lower two below."""
    top, bottom = page.subplots(2, 1, sharex=True, height_ratios=(1.0, 1.35))
    labels = [f"{figure.along} = {v:g}" for v in figure.values]
    colours = dict(zip(labels, style.SEQUENCE, strict=False))
    for axes, panel in ((top, UPPER), (bottom, LOWER)):
        for s in data.select(panel=panel):
            label = s.name.split(", ")[0]
            shade = colours.get(label, "black")
            if s.role == "curve":
                first = panel == UPPER
                line(axes, s, shade, label=style.value(label) if first else None)
            elif s.role == "mark":
                dots(axes, s, shade)
            elif s.role == "event":
                axes.plot(s.x, s.y, "x", color=shade, ms=5.5, mew=1.2, clip_on=False, zorder=6)
            else:
                printed(axes, s, clip_on=False)
    if figure.number in (3, 4):
        x = float(data.select("printed")[0].x[0])
        bottom.annotate(
            f"{x:g} (report)",
            (x, 0.0),
            (x - 2.6, 0.035),
            ha="right",
            fontsize=8.0,
            arrowprops={"arrowstyle": "-", "lw": 0.5, "shrinkB": 3.0},
        )
    top.legend(loc="lower left", bbox_to_anchor=(-0.01, 0.99), ncols=len(labels), columnspacing=1.2)
    top.set_ylabel(r"$\bar\omega_{(2)}$")
    bottom.set_ylabel(r"$\bar\omega_{(B)},\ \bar\omega_{(1)}$")
    bottom.set_xlabel(r"$\bar T_0$")
    bottom.set_xlim(0.0, figure.span[1])
    bottom.set_ylim(0.0, None)
    ends = [float(s.y[-1]) for s in data.select("curve", LOWER) if "omega_(1)" in s.name]
    beside = {"transform": bottom.get_yaxis_transform(), "va": "center"}
    bottom.text(1.008, 0.5 * (min(ends) + max(ends)), r"$\bar\omega_{(1)}$", **beside)
    bottom.text(1.008, 0.15, r"$\bar\omega_{(B)}$", **beside)


def growth(page: Any, figure: Figure, data: FigureData) -> None:
    """One panel a resonance, all to one scale of T."""
    grid = page.subplots(2, 3, sharey=True)
    for axes, name in zip(grid.flat, ORDER, strict=True):
        shade = style.colour(name)
        axes.axhline(0.0, color="0.6", lw=0.5)
        for s in data.select(panel=name):
            if s.role == "curve":
                line(axes, s, shade)
                axes.set_xlim(s.x[0], s.x[-1])
            elif s.role == "mark":
                dots(axes, s, shade)
            else:
                printed(axes, s)
        title(axes, style.resonance(name))
        axes.locator_params(axis="x", nbins=5)
    grid[0, 0].set_ylim(-0.015, 0.065)
    for axes in grid[:, 0]:
        axes.set_ylabel("$T$")
    for axes in grid[1]:
        axes.set_xlabel(r"$\bar\Omega$")


def critical(page: Any, figure: Figure, data: FigureData) -> None:
    """T_x above, the critical thrusts and ratios below, over the same gamma."""
    top, bottom = page.subplots(2, 1, sharex=True)
    names = [f"T0 = {v:g}" for v in figure.values]
    colours = dict(zip(names, style.SEQUENCE, strict=False))
    for s in data.select(panel=TOP):
        shade = colours[s.name]
        if s.role == "curve":
            line(top, s, shade, label=style.value(s.name))
        elif s.role == "mark":
            dots(top, s, shade)
        else:
            printed(top, s)
    top.axhline(figure.eta, color="black", lw=0.6, ls=(0, (4, 2)))
    top.text(
        figure.span[1] - 0.002,
        figure.eta,
        rf"$T_x=\eta={figure.eta:g}$",
        va="bottom",
        ha="right",
        fontsize=8.0,
    )
    top.legend(loc="upper left", bbox_to_anchor=(0.0, 0.97))
    top.set_ylabel("$T_x$")
    top.set_ylim(0.0, None)
    for s in data.select(panel=BOTTOM):  # here T0 is upright
        if s.role == "region":
            bottom.fill_betweenx(s.x, *s.edges, color="0.92", lw=0)
        elif s.role == "curve":
            bottom.plot(s.y, s.x, color="black")
        else:
            bottom.plot(s.y, s.x, mec="black", zorder=4, **style.MARK)
    bottom.set_xlim(*figure.span)
    bottom.set_ylim(0.0, 25.0)
    bottom.set_ylabel(r"$\bar T_0$")
    bottom.set_xlabel(r"$\gamma=T_1/T_0$")
    title(bottom, "stable", 0.04, 0.12)


def compliance(page: Any, figure: Figure, data: FigureData) -> None:
    """T_x over the longitudinal frequency; beyond the figure beside each resonance."""
    axes = page.subplots()
    for name in ORDER:
        shade = style.colour(name)
        curves = [s for s in data.select("curve") if s.name == name]
        for k, s in enumerate(curves):
            thin = {"lw": 0.6} if k == 0 else {"label": style.resonance(name)}
            line(axes, s, shade, **thin)
        pole = curves[0].x[-1] / (1.0 - CLOSEST)
        axes.axvline(pole, color=shade, lw=0.5, ls=":")
        for s in (s for s in data.series if s.name == name and s.role != "curve"):
            if s.role == "mark":
                dots(axes, s, shade)
            else:
                printed(axes, s, mfc=shade, ms=4.4)
    axes.set_xscale("log")
    axes.set_xlim(*figure.span)
    axes.set_ylim(0.0, HIGHEST)
    axes.set_xlabel(r"$\bar\omega_L$")
    axes.set_ylabel("$T_x$")
    ticks = (0.5, 1, 2, 5, 10, 20)
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.xaxis.set_minor_locator(_nothing())
    axes.legend(loc="upper right", title=r"$\bar\Omega$")


def _nothing() -> Any:
    from matplotlib.ticker import NullLocator

    return NullLocator()


def integral(page: Any, figure: Figure, data: FigureData) -> None:
    """Re of the integral of Phi* over sigma."""
    axes = page.subplots()
    axes.axhline(0.0, color="0.6", lw=0.5)
    axes.axvline(1.0, color="0.6", lw=0.5, ls=":")
    for shade, g in zip(style.SEQUENCE, figure.values, strict=False):
        for k, s in enumerate(s for s in data.select("curve") if s.name == f"g = {g:g}"):
            line(axes, s, shade, label=style.value(s.name) if k == 0 else None)
        for s in data.select("mark"):
            if s.name == f"g = {g:g}":
                dots(axes, s, shade)
    axes.set_xlim(0.0, 2.0)
    axes.set_ylim(-6.0, 6.0)
    axes.set_xlabel(r"$\bar\sigma=\Omega/\omega_L$")
    axes.set_ylabel(r"$\mathrm{Re}\int_0^1\Phi^{*}\,d\xi$")
    axes.legend(loc="upper right")


def resonant(page: Any, figure: Figure, data: FigureData) -> None:
    """T over Omega for several longitudinal damping factors."""
    axes = page.subplots()
    axes.axvline(figure.omega_L, color="0.6", lw=0.5, ls=":")
    for shade, g in zip(style.SEQUENCE, figure.values, strict=False):
        for k, s in enumerate(s for s in data.select("curve") if s.name == f"g = {g:g}"):
            line(axes, s, shade, label=style.value(s.name) if k == 0 else None)
        for s in data.select("mark"):
            if s.name == f"g = {g:g}":
                dots(axes, s, shade)
    axes.set_xlim(*figure.span)
    axes.set_ylim(0.0, 0.5)
    axes.set_xlabel(r"$\bar\Omega$")
    axes.set_ylabel("$T$")
    axes.legend(loc="upper left")
