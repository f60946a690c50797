"""The axial force of a unit thrust along the vehicle: in steady acceleration, and pulsating.

With U = s u, u the axial displacement and s = Omega^2 (complex with structural damping),

    P' = m U,   U' = -s P/EA,

so that s = 0 and EA infinite need no other formula: U is then the acceleration. P grows by M U at a
rigid mass and falls by 1 at the thrust. A free end has P = 0, a held one U = 0.
"""

from dataclasses import dataclass

import numpy as np

from hill.arrays import EPS, Complex, Float
from hill.errors import LongitudinalResonance, Refused
from hill.vehicle.mesh import Mesh
from hill.vehicle.series import TERMS
from hill.vehicle.shapes import NODES

# |s| m h^2/EA of a panel: its series ends like 2^-n/n!, or like the taper's.
MAX_WAVES = 1.0
MAX_PANELS = 1000

# What is left of two products that cancel at a resonance, over them, when it is rounding.
CANCELLED = 16.0 * EPS


@dataclass(frozen=True, eq=False)
class Axial:
    """The force at Gauss's points of every panel of every element.

    Attributes
    ----------
    force : (elements, panels * points) ndarray
        Compression positive, of a unit thrust; complex with structural damping.
    panels : int
        Equal parts of an element.
    amplified : float
        By how much rounding is amplified next to a resonance, >= 1.
    """

    force: Complex
    panels: int
    amplified: float


def held(ends: tuple[str, str]) -> tuple[bool, bool]:
    """Whether the nose and the aft end hold the vehicle along its axis; one of them at most."""
    nose = ends[0] != "free"
    return nose, ends[1] != "free" and not nose


def axial(mesh: Mesh, ends: tuple[str, str], thrust: int, s: complex) -> Axial:
    """The force of a unit thrust at a node.

    Parameters
    ----------
    mesh : Mesh
    ends : (str, str)
    thrust : int
        The node where it acts.
    s : complex
        Omega^2, dimensionless, 0 for steady thrust.

    Raises
    ------
    LongitudinalResonance
        The force is infinite.
    """
    panels = _panels(mesh, s)
    coefficients = _series(mesh, s, panels)
    start, end = _at_start(coefficients), coefficients.sum(axis=1)
    joints = thrust * panels
    left, right = _swept(mesh, ends, start, end, joints, panels)
    # what leaves the thrust on either side is met there: P jumps by 1, U does not
    (P1, U1), (P2, U2) = left[-1], right[0]
    cancels = P1 * U2 - U1 * P2
    most, others = np.abs(left).max(axis=0), np.abs(right).max(axis=0)
    size = most[0] * others[1] + most[1] * others[0]
    if abs(cancels) <= CANCELLED * size:
        raise LongitudinalResonance("the undamped axial force is infinite")
    before = left[:-1] * (U2 / cancels)
    after = right[:-1] * (U1 / cancels)
    states = np.concatenate([before, after])
    middle = np.einsum("eij,ej->ei", _inverse(start), states)
    powers = NODES ** np.arange(TERMS)[:, np.newaxis]
    force = (coefficients[:, :, 0] @ middle[..., np.newaxis])[..., 0] @ powers
    return Axial(force.reshape(mesh.elements, -1), panels, float(size / abs(cancels)))


def lowest(mesh: Mesh, ends: tuple[str, str]) -> float:
    """Square of the lowest elastic axial frequency, dimensionless; infinite of a rigid vehicle."""
    travel = _travel(mesh)
    if travel == 0.0:
        return np.inf
    rigid = int(not any(held(ends)))
    high = (np.pi / travel) ** 2
    while _count(mesh, ends, high) <= rigid:
        high *= 4.0
    low = 0.0
    while high - low > 2.0 * EPS * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _count(mesh, ends, middle) <= rigid else (low, middle)
    return high


def _travel(mesh: Mesh) -> float:
    """Integral of sqrt(m/EA): the time of a wave from end to end."""
    return float(np.sum(2.0 * mesh.half * np.sqrt(mesh.m[:, 0] / mesh.EA[:, 0])))


def _panels(mesh: Mesh, s: complex) -> int:
    """Panels of an element, short enough for the force's waves."""
    waves = (mesh.m[:, 0] + abs(mesh.m[:, 1])) / (mesh.EA[:, 0] - abs(mesh.EA[:, 1]))
    most = float(np.max(abs(s) * waves * (2.0 * mesh.half) ** 2))
    panels = max(1, int(np.ceil(np.sqrt(most / MAX_WAVES))))
    if panels > MAX_PANELS:
        raise Refused(
            "Omega: the axial force has more waves along the vehicle than can be followed"
        )
    return panels


def _series(mesh: Mesh, s: complex, panels: int) -> Complex:
    """Coefficients of t^n in (P, U) of each panel, (elements * panels, TERMS, 2, 2)."""
    shift = (2.0 * np.arange(panels) + 1.0) / panels - 1.0

    def part(pair: Float) -> tuple[Float, Float]:
        return (pair[:, :1] + pair[:, 1:] * shift).ravel(), np.repeat(pair[:, 1] / panels, panels)

    (m0, m1), (E0, E1) = part(mesh.m), part(mesh.EA)
    d = np.repeat(mesh.half / panels, panels)
    kind = complex if np.iscomplexobj(s) else float
    both = np.zeros((TERMS, len(d), 2, 2), kind)
    both[0] = np.eye(2)
    P, U = both[:, :, 0], both[:, :, 1]
    inertia, lean = (d * m0)[:, np.newaxis], (d * m1)[:, np.newaxis]
    soft, taper = (s * d / E0)[:, np.newaxis], (E1 / E0)[:, np.newaxis]
    for n in range(TERMS - 1):
        last = n - 1 if n else TERMS - 1
        P[n + 1] = (inertia * U[n] + lean * U[last]) / (n + 1)
        U[n + 1] = (-soft * P[n] - taper * n * U[n]) / (n + 1)
    return np.ascontiguousarray(np.swapaxes(both, 0, 1))


def _at_start(coefficients: Complex) -> Complex:
    """(P, U) at t = -1 of each panel, (panels, 2, 2)."""
    return np.asarray(coefficients[:, ::2].sum(axis=1) - coefficients[:, 1::2].sum(axis=1))


def _inverse(matrix: Complex) -> Complex:
    """Of (..., 2, 2) matrices of determinant 1."""
    out = np.empty_like(matrix)
    out[..., 0, 0], out[..., 1, 1] = matrix[..., 1, 1], matrix[..., 0, 0]
    out[..., 0, 1], out[..., 1, 0] = -matrix[..., 0, 1], -matrix[..., 1, 0]
    return out


def _swept(
    mesh: Mesh, ends: tuple[str, str], start: Complex, end: Complex, thrust: int, panels: int
) -> tuple[Complex, Complex]:
    """(P, U) from the nose to the thrust, whose node's mass it takes in, and from there to the end.

    At the start of each panel, and last at the thrust; the second at the thrust, and so on, and
    last at the end.
    """
    forward = end @ _inverse(start)
    mass = np.zeros(len(start) + 1)
    mass[::panels] = mesh.mass
    nose, aft = held(ends)
    # numbers one by one: an array of two takes ten times as long to be made
    loads = mass.tolist()
    P: complex
    U: complex
    P, U = (1.0, 0.0) if nose else (loads[0], 1.0)
    left: list[tuple[complex, complex]] = [(P, U)]
    for k, (a, b, c, d) in enumerate(forward[:thrust].reshape(-1, 4).tolist(), start=1):
        P, U = a * P + b * U, c * P + d * U
        P += loads[k] * U
        left.append((P, U))
    P, U = (1.0, 0.0) if aft else (-loads[-1] * (thrust < len(start)), 1.0)
    right: list[tuple[complex, complex]] = [(P, U)]
    backward = _inverse(forward).reshape(-1, 4).tolist()
    for k in range(len(start) - 1, thrust - 1, -1):
        a, b, c, d = backward[k]
        P, U = a * P + b * U, c * P + d * U
        right.append((P, U))
        if k > thrust:
            P -= loads[k] * U
    return np.array(left, start.dtype), np.array(right[::-1], start.dtype)


def _chain(mesh: Mesh, ends: tuple[str, str], s: float) -> Complex:
    """(P, U) at the nodes behind their masses, from the nose's condition."""
    panels = _panels(mesh, s)
    coefficients = _series(mesh, s, panels)
    start = _at_start(coefficients)
    return _swept(mesh, ends, start, coefficients.sum(axis=1), len(start), panels)[0]


def _count(mesh: Mesh, ends: tuple[str, str], s: float) -> int:
    """Axial frequencies whose square is below s, by the signs of a Sturm sequence."""
    P, U = _chain(mesh, ends, s).T
    inner = U[1:] if held(ends)[0] else U
    return int(np.sum(inner[1:] * inner[:-1] < 0.0)) + (
        0 if held(ends)[1] else int(P[-1] * U[-1] > 0.0)
    )
