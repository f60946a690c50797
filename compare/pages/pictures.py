"""What is drawn of a result: its multipliers, P where its roots lie, its motion."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.pages.drawing import (
    HEIGHT,
    WIDTH,
    Curve,
    Frame,
    Key,
    Label,
    Mark,
    Picture,
    power_of_ten,
    ticks,
)
from compare.pages.motion import Motion

Float = NDArray[np.floating[Any]]

FARTHEST = 5.0
"""Moduli beyond it are marked at the picture's edge."""

POINTS = 121
"""Of a curve: one every three dots."""

# A window on the closest roots is so many times as wide as they are apart, and never narrower.
AROUND, NARROWEST = 1.5, 2e-6

COLOURS = ("a", "b", "c", "d", "e", "f")
"""Classes of the style sheet, for a curve a coordinate."""


def _short(value: complex) -> str:
    if value.imag == 0.0:
        return f"{value.real:.6g}"
    return f"{value.real:.6g} {'-' if value.imag < 0.0 else '+'} {abs(value.imag):.6g}i"


def multipliers(hill: Sequence[complex], floquet: Sequence[complex]) -> Picture:
    """Both routes' multipliers and the unit circle."""
    largest = max((abs(mu) for mu in (*hill, *floquet)), default=1.0)
    reach = 1.15 * min(max(1.0, largest), FARTHEST)
    scale = (HEIGHT - 20.0) / (2.0 * reach)

    def at(mu: complex) -> tuple[float, float]:
        inside = mu if abs(mu) <= reach else mu / abs(mu) * reach
        x, y = WIDTH / 2 + scale * inside.real, HEIGHT / 2 - scale * inside.imag
        return round(x, 1), round(y, 1)

    turn = np.exp(2j * np.pi * np.arange(73) / 72)
    circle = Curve(" ".join(f"{x},{y}" for x, y in map(at, turn)), "circle")
    (left, middle), (right, _) = at(complex(-reach)), at(complex(reach))
    (centre, top), (_, bottom) = at(1j * reach), at(-1j * reach)
    cross = (
        Curve(f"{left},{middle} {right},{middle}", "guide"),
        Curve(f"{centre},{top} {centre},{bottom}", "guide"),
    )
    marks = [Mark(*at(mu), "dot", "a", _short(mu)) for mu in floquet]
    marks += [Mark(*at(mu), "ring", "b", _short(mu)) for mu in hill]
    x, y = at(1.0)
    labels = [Label(x + 6, y + 14, "1"), Label(centre + 8, at(1j)[1] - 5, "i")]
    for mu in (mu for mu in floquet if abs(mu) > reach and mu.imag >= 0.0):
        x, y = at(mu)
        labels.append(Label(x, y - 9.0 if y > HEIGHT / 2 else y + 18.0, f"{abs(mu):.3g}"))
    outside = sum(abs(mu) > 1.0 + 1e-9 for mu in floquet)
    beyond = sum(abs(mu) > reach for mu in floquet)
    description = (
        f"{len(floquet)} multipliers; {outside} outside the unit circle, the largest modulus is "
        f"{largest:.6g}"
        + (f"; {beyond} lie beyond the picture, in the direction of its edge" if beyond else "")
        + "."
    )
    return Picture(
        "multipliers",
        "Multipliers and the unit circle",
        description,
        curves=(*cross, circle),
        marks=tuple(marks),
        labels=tuple(labels),
        legend=(Key("a", "dot", "Floquet"), Key("b", "ring", "Hill")),
    )


@dataclass(frozen=True)
class Roots:
    """A polynomial of one route, and roots to be marked on its axis.

    Attributes
    ----------
    polynomial : tuple of float
        P's coefficients, highest power first.
    hill, floquet : tuple of complex
        The z of either route.
    printed : tuple of complex
    edge : float
        Stable z lie between it and its negative: cosh(pi eta/Omega), 1 without damping.
    """

    polynomial: tuple[float, ...]
    hill: tuple[complex, ...]
    floquet: tuple[complex, ...]
    printed: tuple[complex, ...] = ()
    edge: float = 1.0


def whole(r: Roots) -> Picture:
    """P between its edges and a little beyond."""
    reach = 1.12 * r.edge
    return _of_roots(r, -reach, reach, "polynomial", "P(z) where stable roots lie")


def closest(r: Roots) -> Picture:
    """P where it is decided: about a root that is off, or else the closest to be so."""
    middle, apart = _deciding(r)
    half = max(AROUND * apart, NARROWEST)
    return _of_roots(r, middle - half, middle + half, "closest", "P(z) where it is decided")


def _deciding(r: Roots) -> tuple[float, float]:
    """The middle of two points, and how far apart they are.

    A root beyond an edge and that edge, or a pair, the farthest off; or if there is none, those of
    the roots and edges that are closest to each other.
    """
    real = sorted(z.real for z in r.floquet if z.imag == 0.0)
    off = [
        (0.5 * (root + math.copysign(r.edge, root)), abs(root) - r.edge)
        for root in real
        if abs(root) > r.edge
    ]
    off += [(z.real, 2.0 * abs(z.imag)) for z in r.floquet if z.imag]
    if off:
        return max(off, key=lambda pair: pair[1])
    points = [-r.edge, *real, r.edge]
    near = [(0.5 * (one + other), other - one) for one, other in itertools.pairwise(points)]
    return min(near, key=lambda pair: pair[1])


def _of_roots(r: Roots, low: float, high: float, name: str, title: str) -> Picture:
    x = np.linspace(low, high, POINTS)
    P = np.polyval(r.polynomial, x)
    top = 1.1 * float(np.max(np.abs(P))) or 1.0
    frame = Frame(low, high, -top, top)
    curves, labels = frame.axes("z", "P(z)")
    guides = [frame.curve([low, high], [0.0, 0.0], "guide")]
    guides += [
        frame.curve([edge, edge], [-top, top], "edge")
        for edge in (-r.edge, r.edge)
        if low < edge < high
    ]
    marks = []
    for values, shape, look, who in (
        (r.floquet, "dot", "a", "Floquet"),
        (r.hill, "ring", "b", "Hill"),
        (r.printed, "diamond", "c", "printed"),
    ):
        marks += [
            frame.mark(
                z.real, 0.0, shape, look if not z.imag else f"{look} pair", f"{who}: {_short(z)}"
            )
            for z in values
            if low <= z.real <= high
        ]
    inside = [z for z in r.floquet if z.imag == 0.0 and abs(z.real) < r.edge]
    description = (
        f"P(z) from {low:.6g} to {high:.6g}. Roots: {', '.join(_short(z) for z in r.floquet)}; "
        f"{len(inside)} of {len(r.floquet)} real and between {-r.edge:.6g} and {r.edge:.6g}."
    )
    legend = [Key("a", "dot", "roots by Floquet"), Key("b", "ring", "by Hill")]
    legend += [Key("c", "diamond", "printed")] if r.printed else []
    if any(z.imag for z in (*r.floquet, *r.printed)):
        legend.append(Key("a pair", "dot", "pale: a conjugate pair, at its real part"))
    return Picture(
        name,
        title,
        description,
        curves=(*guides, *curves, frame.curve(x, P, "a")),
        marks=tuple(marks),
        labels=labels,
        legend=tuple(legend),
    )


def of_motion(m: Motion | str) -> tuple[Picture, ...]:
    """The first periods and all of them; nothing where there is no motion."""
    return (history(m), growth(m)) if isinstance(m, Motion) else ()


def history(m: Motion) -> Picture:
    """The coordinates over the first periods."""
    chosen = m.tau <= m.shown * m.period * (1.0 + 1e-12)
    periods, q = m.tau[chosen] / m.period, m.q[chosen]
    top = 1.05 * float(np.max(np.abs(q)))
    frame = Frame(0.0, float(m.shown), -top, top)
    curves, labels = frame.axes("periods of the thrust", "q")
    lines = [frame.curve(periods, q[:, k], _colour(k)) for k in range(q.shape[1])]
    return Picture(
        "history",
        f"The first {m.shown} periods",
        f"{q.shape[1]} coordinates over {m.shown} periods, {top / 1.05:.4g} in size at most.",
        curves=(frame.curve([0.0, m.shown], [0.0, 0.0], "guide"), *curves, *lines),
        labels=labels,
        legend=_coordinates(m),
    )


def growth(m: Motion) -> Picture:
    """The largest excursion in each period, on a logarithmic scale, and exp(T tau/2)."""
    size = np.log10(np.maximum(m.largest, np.finfo(float).tiny))
    periods = np.arange(1.0, len(m.largest) + 1.0)
    last = float(size[-1].max())
    grown = 0.5 * m.T * m.period * (len(periods) - 1.0) * math.log10(math.e)
    law = [last - grown, last]
    # the law's line is kept whole: cut off, it would have another slope
    low, high = _whole_decades(min(size.min(), law[0]), max(size.max(), law[0]))
    frame = Frame(0.0, float(len(periods)), low, high)
    decades = [(v, power_of_ten(round(v))) for v in ticks(low, high) if v == round(v)]
    curves, labels = frame.axes("periods of the thrust", "largest |q|", decades)
    lines = [frame.curve(periods, size[:, k], _colour(k)) for k in range(size.shape[1])]
    legend = list(_coordinates(m))
    if m.T:
        lines.insert(0, frame.curve(periods[[0, -1]], law, "law"))
        legend.append(Key("law", "line", "exp(Tτ/2)"))
    by = float(np.ptp(size))
    return Picture(
        "growth",
        f"{len(periods)} periods",
        f"The largest excursion of each coordinate in each of {len(periods)} periods, on a "
        f"logarithmic scale; over all of them it spans {by:.2g} powers of ten.",
        curves=(*curves, *lines),
        labels=labels,
        legend=tuple(legend),
    )


def _whole_decades(low: float, high: float) -> tuple[float, float]:
    low, high = math.floor(low - 0.05), math.ceil(high + 0.05)
    return (low, high) if high > low else (low, low + 1)


def _colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def _coordinates(m: Motion) -> tuple[Key, ...]:
    return tuple(Key(_colour(k), "line", name) for k, name in enumerate(m.names))
