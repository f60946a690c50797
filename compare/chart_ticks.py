"""Ticks of a picture's axis of Omega at round numbers of cycles."""

import math
from typing import Any


def ticks_in_cycles(axes: Any, x: str, name: str) -> None:
    """Label Omega's axis, which runs in radians, in cycles per unit of time.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x : str
        What runs along the picture: "Omega", or else Omega runs up it.
    name : str
        What the axis is called.
    """
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

    along = x == "Omega"
    axis = axes.xaxis if along else axes.yaxis
    low, high = (value / (2.0 * math.pi) for value in (axes.get_xlim, axes.get_ylim)[not along]())
    every = MaxNLocator(9, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    rounds = [value for value in every if low <= value <= high]
    axis.set_major_locator(FixedLocator([2.0 * math.pi * value for value in rounds]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / (2.0 * math.pi):.6g}"))
    axis.set_label_text(name)
