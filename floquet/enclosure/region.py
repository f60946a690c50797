"""Every point of a grid's cells, in Omega and gamma: proven stable, unstable, or undecided.

P over the whole rectangle by `surface`, each cell within each patch by `cells`.
"""

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import lru_cache, partial
from itertools import pairwise
from typing import Any

import numpy as np
from flint import ctx
from numpy.typing import NDArray

from floquet.enclosure import beams
from floquet.enclosure.balls import exact, identity, number
from floquet.enclosure.bound import bound_on
from floquet.enclosure.cells import Place, decided
from floquet.enclosure.discs import STABLE, UNDECIDED, UNSTABLE
from floquet.enclosure.result import RegionProof
from floquet.enclosure.surface import BITS, Packed, Patch, Rectangle, Surface, column, counts
from hill import HillEquation, SteppedBeam, UniformBeam
from hill.decimals import ExactBeam, Number, exact_beam, fraction

Float = NDArray[np.floating[Any]]
Over = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
Progress = Callable[[str, int, int], Any]

MAX_NODES = 200_000
"""Half an hour on one core."""

KINDS = {UNDECIDED: "undecided", STABLE: "stable", UNSTABLE: "unstable"}


def prove(
    what: UniformBeam | SteppedBeam | HillEquation,
    Omega: Sequence[Number],
    gamma: Sequence[Number],
    eta: Number,
    halvings: int,
    over: Over,
    progress: Progress | None,
) -> RegionProof:
    """As `floquet.enclosure.enclose_region`."""
    columns, rows = _ascending("Omega", Omega), _ascending("gamma", gamma)
    if columns[0] <= 0:
        raise ValueError(f"Omega = {float(columns[0]):g}: must be > 0")
    matrices, damping = _matrices(what, columns[-1], rows[-1], eta)
    s, levels = [1 / x for x in columns[::-1]], rows
    rectangle = Rectangle(*_middle(s[0], s[-1]), *_middle(levels[0], levels[-1]))
    told = progress or (lambda what, done, total: None)
    with ctx.workprec(BITS):
        known = bound_on(*matrices(BITS))
        nodes, remainder = counts(known, rectangle)
        if nodes[0] * nodes[1] > MAX_NODES:
            raise ValueError(
                f"Omega, gamma: P would be enclosed at {nodes[0]:,} times {nodes[1]:,} points, "
                f"{MAX_NODES:,} at most in all; take narrower ranges"
            )
        job = partial(column, matrices, rectangle, nodes)
        values: list[list[list[Packed]]] = []
        for found in over(job, range(nodes[0])):
            values.append(found)
            told("columns of enclosures", len(values), nodes[0])
        surface = Surface(rectangle, known, nodes, remainder, values)
        numbers, areas = _decided(surface, s, levels, float(damping), halvings, over, told)
    return RegionProof(
        Omega=tuple(map(float, columns)),
        gamma=tuple(map(float, rows)),
        cells=_verdicts(numbers)[:, ::-1],
        areas={kind: areas[code][:, ::-1] for code, kind in KINDS.items()},
        nodes=nodes[0] * nodes[1],
        remainder=float(remainder.upper()),
    )


def _matrices(
    what: UniformBeam | SteppedBeam | HillEquation, Omega: Fraction, gamma: Fraction, eta: Number
) -> tuple[Callable[[int], tuple[Any, Any]], Fraction]:
    """What makes F - eta^2/4 and G to so many bits, and eta."""
    if isinstance(what, HillEquation):
        if what.H or np.ndim(what.eta) > 0 or eta != 0:
            raise ValueError("equation: must have no H and a damping that is one number, its own")
        damping = Fraction(float(what.damping))
        return partial(_of_floats, what.F, what.G, damping), damping
    given, under = exact_beam(what, Omega, gamma, eta)
    if given.sigma:
        raise ValueError(f"omega_L = {what.omega_L:g}: must be infinite, or G moves with Omega")
    return partial(of_decimals, given, under.eta), under.eta


@lru_cache(maxsize=16)
def of_decimals(beam: ExactBeam, eta: Fraction, bits: int) -> tuple[Any, Any]:
    """Of a beam."""
    F, G, _ = beams.matrices(beam, bits)
    return _less(F, eta), G


def _of_floats(F: Any, G: Any, eta: Fraction, bits: int) -> tuple[Any, Any]:
    return _less(exact(F), eta), exact(G)


def _less(F: Any, eta: Fraction) -> Any:
    return F - identity(F.nrows()) * (number(eta) ** 2 / 4)


def _ascending(name: str, edges: Sequence[Number]) -> list[Fraction]:
    found = [fraction(name, x) for x in edges]
    if len(found) < 2 or any(a >= b for a, b in pairwise(found)):
        raise ValueError(f"{name} = {edges}: must be two numbers or more, ascending")
    return found


def _middle(low: Fraction, high: Fraction) -> tuple[Fraction, Fraction]:
    return (low + high) / 2, (high - low) / 2


def _decided(
    surface: Surface,
    s: list[Fraction],
    levels: list[Fraction],
    eta: float,
    halvings: int,
    over: Over,
    told: Progress,
) -> tuple[Any, Any]:
    """Parts of each cell by kind, and their areas: (3, rows, columns ascending in s)."""
    shape = 3, len(levels) - 1, len(s) - 1
    totals: tuple[Any, Any] = np.zeros(shape, np.intp), np.zeros(shape)
    x = [(place - surface.over.s) / surface.over.half_s for place in s]
    y = [(place - surface.over.gamma) / surface.over.half_gamma for place in levels]
    jobs, cells = [], []
    for patch in surface.patches():
        own_x, own_y = _within(x, patch.x), _within(y, patch.y)
        ends = np.array([(*a, *b) for _, b in own_y for _, a in own_x])
        jobs.append((patch, ends, _place(surface.over, patch)))
        cells.append(np.ix_(range(3), [k for k, _ in own_y], [k for k, _ in own_x]))
        told("patches", len(jobs), surface.cuts()[0] * surface.cuts()[1])
    for done, made in enumerate(over(partial(_job, eta, halvings), jobs), start=1):
        where = cells[done - 1]
        for total, part in zip(totals, made, strict=True):
            total[where] += part.reshape(total[where].shape)
        told("patches decided", done, len(jobs))
    return totals


def _job(eta: float, halvings: int, job: tuple[Patch, Float, Place]) -> tuple[Any, Any]:
    patch, ends, place = job
    return decided(patch, ends, place, eta, halvings)


def _within(
    edges: list[Fraction], part: tuple[Fraction, Fraction]
) -> list[tuple[int, tuple[float, float]]]:
    """The cells that reach into a part, and what of them is in it, from -1 to 1 over the part."""
    (low, high), found = part, []
    for k, (a, b) in enumerate(pairwise(edges)):
        if a < high and b > low:
            inside = max(a, low), min(b, high)
            found.append((k, tuple(float((2 * v - low - high) / (high - low)) for v in inside)))
    return found  # type: ignore[return-value]


def _place(over: Rectangle, patch: Patch) -> Place:
    s, half = _middle(*(over.s + over.half_s * v for v in patch.x))
    return Place(float(s), float(half), float(over.half_gamma * (patch.y[1] - patch.y[0]) / 2))


def _verdicts(numbers: Any) -> Any:
    """Of each cell: what all of its parts are."""
    found = np.full(numbers.shape[1:], "undecided")
    for kind, other in ((STABLE, UNSTABLE), (UNSTABLE, STABLE)):
        alone = (numbers[kind] > 0) & (numbers[other] == 0) & (numbers[UNDECIDED] == 0)
        found[alone] = KINDS[kind]
    return found
