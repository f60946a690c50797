"""From a figure's data to PNG and SVG. matplotlib is imported here, and only when asked."""

import io
from collections.abc import Callable
from typing import Any

from compare.provenance import picture_metadata
from compare.report.figures import maps, panels, style
from compare.report.figures.catalogue import FIGURES
from compare.report.figures.data import FigureData, about

MISSING = 'matplotlib is not installed: pip install "floquet-crosscheck[plot]"'
LINE = 0.158
"""Inches from one line of a caption to the next."""
CAPTION = 8.2
"""Points."""
INDENT = 0.012
"""Margin of the caption, as a share of the width."""

DRAWERS: dict[str, tuple[Callable[..., None], float]] = {
    "frequencies": (panels.frequencies, 5.2),
    "growth": (panels.growth, 4.3),
    "regions": (maps.regions, 6.6),
    "critical": (panels.critical, 5.4),
    "compliance": (panels.compliance, 3.9),
    "integral": (panels.integral, 3.5),
    "resonant": (panels.resonant, 3.7),
    "coupled": (maps.coupled, 6.6),
}
"""What draws each kind, and the height of its axes in inches."""


def require() -> None:
    """Raise ValueError where matplotlib is missing."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise ValueError(MISSING) from None


def draw(data: FigureData, formats: tuple[str, ...], *, captioned: bool = True) -> dict[str, bytes]:
    """The figure in each format; the same bytes every time.

    Parameters
    ----------
    data : FigureData
    formats : tuple of {"png", "svg"}
    captioned : bool, optional
        With the caption in the picture, below the axes.
    """
    require()
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = FIGURES[data.number]
    drawer, height = DRAWERS[figure.kind]
    rc: Any = style.RC
    with matplotlib.rc_context(rc):
        text = style.wrapped(style.caption(figure, data), _width(), 1.0 - 2.0 * INDENT)
        below = LINE * (text.count("\n") + 1) + 0.12 if captioned else 0.0
        page = Figure(figsize=(style.WIDTH, height + below))
        FigureCanvasAgg(page)
        share = below / (height + below)
        page.set_layout_engine(
            "constrained", rect=(0.0, share, 1.0, 1.0 - share), w_pad=0.04, h_pad=0.04
        )
        if captioned:
            page.text(
                INDENT,
                share - 0.06 / (height + below),
                text,
                fontsize=CAPTION,
                va="top",
                linespacing=1.25,
            )
        drawer(page, figure, data)
        page.draw_without_rendering()  # lay out once, not for every format
        page.set_layout_engine("none")
        return {kind: _saved(page, kind, about(data)) for kind in formats}


def _width() -> Callable[[str], float]:
    """Width of a caption's words, as a share of the page's."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    page = Figure(figsize=(style.WIDTH, 1.0))
    canvas: Any = FigureCanvasAgg(page)
    renderer = canvas.get_renderer()
    probe = page.text(0.0, 0.0, "", fontsize=CAPTION)

    def width(word: str) -> float:
        probe.set_text(word)
        return float(probe.get_window_extent(renderer).width) / float(page.bbox.width)

    return width


def _saved(page: Any, kind: str, of: dict[str, Any]) -> bytes:
    buffer = io.BytesIO()
    page.savefig(buffer, format=kind, metadata=picture_metadata(of, kind))
    return buffer.getvalue()
