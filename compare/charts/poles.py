"""Where a rectangle of a chart has a pole of its system, or one is near, and how to cut it then."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.charts.cuts import Cut
from compare.charts.scenario import Scenario
from compare.charts.surface import POLE
from hill.system import FORCING, singular_Omega, varied

Float = NDArray[np.floating[Any]]
Values = Mapping[str, float]

POLE_CLEARANCE = 0.25
"""Widths of a box: a series over it whose nearest pole is farther than this converges by 2.6 a
term, whatever the residue."""

GRADE = 0.3
"""Share of the way from a pole that is left with it: what is beyond has the pole .43 of its width
away, and a series over it converges by 3.4 a term."""

# Two floats that far apart are a pole met exactly, where neither Omega nor the pole is varied, or
# one pole seen from two corners.
SAME_OMEGA = 1e-9


@dataclass(frozen=True, eq=False)
class _Box:
    """A box of parameters, and where Omega is against the system's poles.

    Attributes
    ----------
    system : System
    low, high : dict of str to float
        Of the axes; Omega among them where it moves against the poles by itself.
    Omega : float
        Where it does not move.
    """

    system: Any
    low: Values
    high: Values
    Omega: float


def singular_across(of: Scenario, low: Float, high: Float) -> Cut | None:
    """How to cut a rectangle of smooth coordinates with a pole in it or near; None where none is.

    The system says where its poles are in Omega. Of a ratio they are where it says they are with
    the ratio's parameter held: Omega over it is all that counts.
    """
    if not hasattr(of.system, "singular_Omega"):
        return None
    smooth, names = of.smooth, of.names
    ends = smooth.from_smooth(np.array([low, high]))
    lo, hi = (dict(zip(names, map(float, e), strict=True)) for e in (ends.min(0), ends.max(0)))
    system, unit, axis = of.system, 1.0, names.index("Omega") if "Omega" in names else -1
    if smooth.ratio is not None:
        axis = smooth.ratio
        unit = of.axes[axis].high
        system = varied(system, {names[axis]: unit})
        for own, end in ((lo, low), (hi, high)):
            del own[names[axis]]
            own["Omega"] = unit * float(end[axis])
    box = _Box(system, lo, hi, of.forcing.get("Omega", float("nan")))
    poles = _poles(box)
    if poles is None:
        return None
    if not len(poles):
        name = _across(box)
        return Cut(axis if name == "Omega" else names.index(name), POLE)
    at = np.sort(poles / unit if smooth.ratio is not None else 1.0 / poles)
    return Cut(axis, POLE, _where(at, float(low[axis]), float(high[axis])), graded=True)


def _where(poles: Float, low: float, high: float) -> float:
    """To cut at: a pole within; or so that what lies away from the only one is well clear of it."""
    within = poles[(poles > low * (1.0 + SAME_OMEGA)) & (poles < high * (1.0 - SAME_OMEGA))]
    if len(within):
        return float(within[len(within) // 2])
    if len(poles) > 1:
        return 0.5 * (low + high)
    pole, far = float(poles[0]), high if poles[0] < 0.5 * (low + high) else low
    return pole + GRADE * (far - pole)


def _poles(box: _Box) -> Float | None:
    """In a box or close by: in Omega, where they are the same all over it; empty where not.

    None where there are none at all. The box counts with a margin of `POLE_CLEARANCE` on each side,
    so that a series over it has none at its door.
    """
    ends = {name: _widened(box, name) for name in box.low if name not in FORCING}
    if "Omega" in box.low:
        Omega = _widened(box, "Omega")
    else:
        Omega = box.Omega * (1.0 - SAME_OMEGA), box.Omega * (1.0 + SAME_OMEGA)
    corners = [
        varied(box.system, dict(zip(ends, corner, strict=True)))
        for corner in product(*ends.values())
    ]
    # a pole that is on another side of the box at another corner passes through
    below = {len(singular_Omega(system, 0.0, Omega[0])) for system in corners}
    found = [singular_Omega(system, *Omega) for system in corners]
    if len(below) == 1 and not any(map(len, found)):
        return None
    if "Omega" not in box.low or len(below) > 1 or len({len(poles) for poles in found}) > 1:
        return np.empty(0)
    apart = np.ptp(found, axis=0)
    return found[0] if np.all(apart <= SAME_OMEGA * found[0]) else np.empty(0)


def _widened(box: _Box, name: str) -> tuple[float, float]:
    low, high = box.low[name], box.high[name]
    margin = POLE_CLEARANCE * (high - low)
    if name == "Omega":
        return max(low - margin, 0.5 * low), high + margin
    own = next(p for p in box.system.parameters if p.name == name)
    return (
        low - margin if low - margin > own.low else low,
        high + margin if high + margin < own.high else high,
    )


def _across(box: _Box) -> str:
    """The parameter along which Omega and the poles move most against each other."""
    low, high = box.low, box.high
    middle = {name: 0.5 * (low[name] + high[name]) for name in low}
    Omega = middle.get("Omega", box.Omega)
    moved = {"Omega": high["Omega"] - low["Omega"]} if "Omega" in low else {}
    for name in (n for n in low if n not in FORCING):
        own = {k: v for k, v in middle.items() if k not in FORCING}
        first, last = (
            singular_Omega(varied(box.system, own | {name: end}), 0.0, 2.0 * Omega)
            for end in (low[name], high[name])
        )
        if len(first) == len(last):
            moved[name] = float(np.max(np.abs(last - first), initial=0.0))
    return max(moved, key=lambda name: moved[name]) if moved else next(iter(low))
