"""A study's bands over the pulsation ratio: tongues by Hill's matrix, without a chart."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from compare.edges.tongue import RANGE, TIP, UNSEEN, Tongue
from compare.vehicle.near import Band, Near
from compare.vehicle.study import Row, Study
from hill.errors import Refused

STATIONS = 25
"""Ratios at which a band is solved for, closer together where it opens: its edges meet there like a
parabola."""

# The first of them where a band opens at 0, over the largest.
FIRST = 1e-2


def outlines(study: Study, top: float, progress: Callable[[int, int], Any]) -> list[Tongue]:
    """The bands of the resonances looked at closely that open below a ratio.

    Parameters
    ----------
    study : Study
    top : float
    progress : callable
        Called with how many resonances are done, and how many there are.
    """
    rows = [row for row in study.rows if row.critical is not None and row.critical < top]
    found = []
    for done, row in enumerate(rows):
        progress(done, len(rows))
        tongue = _outline(study, row, top)
        if tongue is not None:
            found.append(tongue)
    return found


def _outline(study: Study, row: Row, top: float) -> Tongue | None:
    """One band from where it opens on, as far as it has two edges of its own."""
    opens = row.critical or 0.0
    first = opens if opens else FIRST * top
    gammas = first + (top - first) * np.linspace(0.0, 1.0, STATIONS) ** 2
    bands = list(_bands(study, row, gammas))
    edges = [band.edges for band in bands if band.edges]
    y = [float(g) for g, band in zip(gammas, bands, strict=False) if band.edges]
    if opens and bands and y:
        edges, y = [(bands[0].middle,) * 2, *edges], [opens, *y]
    if len(y) < 2:
        return None
    lower, upper = np.array(edges).T
    return Tongue(
        row.resonance,
        np.array(y),
        lower,
        upper,
        begins=TIP if opens else RANGE,
        ends=RANGE if y[-1] == gammas[-1] else UNSEEN,
    )


def _bands(study: Study, row: Row, gammas: Any) -> Iterator[Band]:
    """At one ratio after another, until it has none of its own; the first may not be open yet."""
    last = row.band
    for k, gamma in enumerate(map(float, gammas)):
        near = Near(
            lambda x, at=gamma: study.vehicle.equation(x, at, study.eta),  # type: ignore[misc]
            row.resonance,
            study.alone,
        )
        try:
            last = near.band(last)
        except Refused:
            return
        if k and last.edges is None:
            return
        yield last
