"""A vehicle's exact lateral modes: every frequency found and counted, shapes as power series."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from hill.arrays import EPS, Float
from hill.errors import Refused
from hill.vehicle.mesh import Mesh, mesh
from hill.vehicle.series import Series, series
from hill.vehicle.shapes import Shapes, from_states, straight
from hill.vehicle.stiffness import count, grouped
from hill.vehicle.vehicle import Vehicle

# Width of a bracket of one frequency, over it, from which Newton's method is tried.
ISOLATED = 3e-3
# Frequencies that a bracket of this width still holds together are found together.
TOGETHER = 1e-7
# How near an end of a bracket one must be not to be told from one outside.
EDGE = 1e-10
# Newton's method doubles the digits; more steps than these it takes only where it is lost.
STEPS = 12
# Steps below this share, no longer halved, are rounding.
SETTLED = 1e-11
# A uniform free beam's first lambda is 500, in the same units; a vehicle's is not so far from it.
MIN_LAMBDA, MAX_LAMBDA = 1e-7, 1e16


@dataclass(frozen=True, eq=False)
class Modes:
    """The lowest elastic modes, mass-normalised, and the rigid rotation after them, if any.

    Attributes
    ----------
    lam : (modes,) ndarray
        Squares of the frequencies of the elastic modes, ascending, in units of the mesh.
    shapes : Shapes
        The elastic modes, then the rotation.
    defect : float
        Largest of the products that should vanish: orthogonality of the shapes in mass and in
        stiffness, and with the rigid motions.
    """

    lam: Float
    shapes: Shapes
    defect: float

    @property
    def mesh(self) -> Mesh:
        """Where the shapes are given."""
        return self.shapes.mesh


def modes(vehicle: Vehicle, number: int) -> Modes:
    """The `number` lowest elastic modes.

    Every frequency is counted: as many lie below each as its number says.

    Raises
    ------
    Refused
        The vehicle's properties change too much for it.
    """
    rigid = rigid_motions(vehicle.ends)
    cut, solutions, counters = _long_enough(vehicle, number + rigid)
    for last, counted in ((False, counters[0]), (True, counters[1])):
        brackets = _brackets(counted, cut.most, rigid, number)
        found = [_inside(solutions, cut, vehicle.ends, counters[1], *b) for b in brackets]
        shapes = Shapes(cut, np.concatenate([x.coefficients for x in found])[:number])
        made = _normalised(number, shapes, vehicle.ends)
        if _counted(made, counters[1], rigid):
            return made
        if last:
            break
    raise Refused("modes: the frequencies found are not those counted, the vehicle is too uneven")


def rigid_motions(ends: tuple[str, str]) -> int:
    """Translation and rotation that the ends leave free."""
    held = sum({"free": 0, "pinned": 1, "clamped": 2}[end] for end in ends)
    return max(2 - held, 0)


Count = Callable[[Float], Float]


def _long_enough(vehicle: Vehicle, wanted: int) -> tuple[Mesh, Series, tuple[Count, Count]]:
    """A mesh fine enough for `wanted` frequencies; what counts on it, fast and with care."""
    first = mesh(vehicle, 1.0)
    waves = float(np.sum(2.0 * first.half * (first.m[:, 0] * first.flexibility[:, 0]) ** 0.25))
    most = ((wanted + 0.5) * np.pi / waves) ** 4
    while most < MAX_LAMBDA * wanted**4:
        cut = mesh(vehicle, most)
        solutions = series(cut)

        def fast(lams: Float, cut: Mesh = cut, solutions: Series = solutions) -> Float:
            return count(solutions, cut, vehicle.ends, lams)

        def careful(lams: Float, cut: Mesh = cut, solutions: Series = solutions) -> Float:
            return np.array([grouped(solutions, cut, vehicle.ends, float(x)).below for x in lams])

        if careful(np.array([most]))[0] >= wanted:
            return cut, solutions, (fast, careful)
        most *= 2.0
    raise Refused(f"modes: fewer than {wanted} can be found, the vehicle is too uneven")


def _counted(made: Modes, careful: Count, rigid: int) -> bool:
    """Whether as many frequencies lie below and above each as its place says."""
    groups = np.flatnonzero(np.diff(made.lam) > 4.0 * TOGETHER * made.lam[1:]) + 1
    starts, stops = np.array([0, *groups]), np.array([*groups, len(made.lam)])
    under = careful(made.lam[starts] * (1.0 - TOGETHER))
    # a bracket may have held more than were asked for
    over = careful(made.lam[stops - 1] * (1.0 + TOGETHER))
    return bool(
        np.all(np.diff(made.lam) > -1e-12 * made.lam[1:])
        and np.all(under == rigid + starts)
        and np.all(over[:-1] == rigid + stops[:-1])
        and over[-1] >= rigid + stops[-1]
    )


def _brackets(
    counted: Count, most: float, rigid: int, number: int
) -> list[tuple[float, float, int]]:
    """(low, high, how many) of the lambda 1 .. number, one or some inseparable ones in each."""
    low = 1.0
    while counted(np.array([low]))[0] > rigid:
        low *= 0.1
        if low < MIN_LAMBDA:
            raise Refused("modes: the lowest is too soft for its mass to be told from a rigid one")
    known = {low: rigid, most: int(counted(np.array([most]))[0])}
    targets = np.arange(rigid + 1, rigid + number + 1)
    while True:
        lams = np.array(sorted(known))
        counts = np.maximum.accumulate([known[x] for x in lams])
        above = np.searchsorted(counts, targets)
        pairs = sorted({(int(k) - 1, int(k)) for k in above})
        open_ = [
            (lams[a], lams[b])
            for a, b in pairs
            if lams[b] - lams[a] > (TOGETHER if counts[b] - counts[a] > 1 else ISOLATED) * lams[b]
        ]
        if not open_:
            return [(lams[a], lams[b], int(counts[b] - counts[a])) for a, b in pairs]
        middle = np.array([np.sqrt(a * b) for a, b in open_])
        known |= dict(zip(middle.tolist(), counted(middle).tolist(), strict=True))


def _inside(
    solutions: Series,
    cut: Mesh,
    ends: tuple[str, str],
    careful: Count,
    low: float,
    high: float,
    several: int,
) -> Shapes:
    """Shapes of the lambda between low and high, narrowed where Newton's method leaves them."""
    under = None
    while True:
        shapes = _refined(solutions, cut, ends, low, high, several)
        lam = np.diag(shapes.stiffness) / np.diag(shapes.mass)
        slack = EDGE * high
        width = high - low
        if np.all((lam > low - slack) & (lam < high + slack)) or width <= slack:
            return shapes
        if under is None:
            under, over = careful(np.array([low, high]))
            if over - under != several:  # the bracket was wrong, as the caller will see
                return shapes
        while high - low > width / 32.0:
            middle = 0.5 * (low + high)
            below = careful(np.array([middle]))[0] - under
            if 0 < below < several:  # they are apart, and each is found in its turn
                return Shapes(
                    cut,
                    np.concatenate(
                        [
                            _inside(solutions, cut, ends, careful, a, b, n).coefficients
                            for a, b, n in ((low, middle, below), (middle, high, several - below))
                        ]
                    ),
                )
            low, high = (low, middle) if below else (middle, high)


def _refined(
    solutions: Series, cut: Mesh, ends: tuple[str, str], low: float, high: float, several: int
) -> Shapes:
    """Shapes of the lambda between low and high.

    Near one, K(lam) v = kappa v with a small kappa, and lam + kappa/(v's mass) is nearer: the mass
    is -dK/dlam. Several are told apart by the same quotient of matrices.
    """
    lam, before = np.sqrt(low * high), np.inf
    for _ in range(STEPS):
        at = grouped(solutions, cut, ends, float(lam))
        vectors = at.null(several)
        states = np.array([at.states(v) for v in vectors.T])
        shapes = from_states(solutions, cut, float(lam), states)
        change, mixed = eigh(vectors.T @ at.K @ vectors, shapes.mass)
        step = float(np.mean(change))
        if abs(step) <= 8.0 * EPS * lam or (2.0 * abs(step) > before < SETTLED * lam):
            break
        lam, before = lam + step, abs(step)
    return shapes.combined(mixed)


def _normalised(n: int, shapes: Shapes, ends: tuple[str, str]) -> Modes:
    """Shapes of unit mass, the aft end (or its rotation) positive, the rotation added."""
    cut = shapes.mesh
    one = straight(cut, 0.0)
    if rigid_motions(ends):
        # the rotation about the centre of mass, or about the pin
        centre = {("pinned", "free"): 0.0, ("free", "pinned"): 1.0}.get(ends)
        if centre is None:
            unit = Shapes(cut, np.zeros_like(one.coefficients))
            unit.coefficients[:, :, 0, 0] = 1.0
            both = Shapes(cut, np.concatenate([one.coefficients, unit.coefficients])).mass
            centre = both[0, 1] / both[1, 1]
        shapes = Shapes(
            cut, np.concatenate([shapes.coefficients, straight(cut, float(centre)).coefficients])
        )
    size = np.sqrt(np.diag(shapes.mass))
    last = shapes.nodes[:, -1]
    end = last[:, 0] if ends[1] == "free" else last[:, 1] if ends[1] == "pinned" else last[:, 3]
    sign = np.where(end < 0.0, -1.0, 1.0)
    shapes = Shapes(cut, shapes.coefficients * (sign / size)[:, np.newaxis, np.newaxis, np.newaxis])
    # to rounding, for an error of the shape counts twice here
    lam = np.diag(shapes.stiffness)[:n].copy()
    unit_mass = shapes.mass - np.eye(len(shapes))
    energy = shapes.stiffness[:n, :n] / np.sqrt(np.outer(lam, lam)) - np.eye(n)
    return Modes(lam, shapes, float(max(np.abs(unit_mass).max(), np.abs(energy).max())))
