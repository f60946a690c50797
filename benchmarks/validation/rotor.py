"""A rotor of the literature: Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines, 5.9.1.

A shaft of six Timoshenko elements with two discs in two isotropic bearings. In the planes' own
deflections u, v and their slopes,

    M u'' + speed G v' + K u = 0,   M v'' - speed G u' + K v = 0.

Numbers as in the tests of ROSS (petrobras/ross), 4000 rpm and standstill.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from hill import PeriodicEquation

Float = NDArray[np.float64]

RPM = 2.0 * np.pi / 60.0

LENGTH, DIAMETER, ELEMENTS = 1.5, 0.05, 6
E, SHEAR, DENSITY = 211e9, 81.2e9, 7810.0
# distance, outer diameter, width; all with the shaft's diameter for a bore
DISCS = ((0.5, 0.28, 0.07), (1.0, 0.35, 0.07))
BEARING = 1e6

# rad/s, as printed there.
PRINTED = {
    0.0: (86.66, 86.66, 274.31, 274.31, 716.78),
    4000.0: (85.39, 87.80, 251.78, 294.71, 600.18),
}


def matrices() -> tuple[Float, Float, Float]:
    """M, K and G of one plane, (14, 14): deflection and slope of each node."""
    count = 2 * (ELEMENTS + 1)
    M, K, G = np.zeros((3, count, count))
    length = LENGTH / ELEMENTS
    for k in range(ELEMENTS):
        at = slice(2 * k, 2 * k + 4)
        mass, turning, stiffness = _element(length)
        M[at, at] += mass + turning
        K[at, at] += stiffness
        G[at, at] += 2.0 * turning
    for x, outer, width in DISCS:
        node = 2 * round(x / length)
        disc = DENSITY * np.pi * (outer**2 - DIAMETER**2) * width / 4.0
        polar = disc * (outer**2 + DIAMETER**2) / 8.0
        M[node, node] += disc
        M[node + 1, node + 1] += 0.5 * polar + disc * width**2 / 12.0
        G[node + 1, node + 1] += polar
    for node in (0, count - 2):
        K[node, node] += BEARING
    return M, K, G


def _element(h: float) -> tuple[Float, Float, Float]:
    """Mass, rotary inertia and stiffness of a Timoshenko element (Przemieniecki)."""
    area, inertia = np.pi * DIAMETER**2 / 4.0, np.pi * DIAMETER**4 / 64.0
    nu = E / (2.0 * SHEAR) - 1.0
    # Cowper's coefficient of a round section
    p = 12.0 * E * inertia * (7.0 + 6.0 * nu) / (6.0 * (1.0 + nu) * SHEAR * area * h**2)
    a, b, c, d = (
        312 + 588 * p + 280 * p**2,
        44 + 77 * p + 35 * p**2,
        108 + 252 * p + 140 * p**2,
        (26 + 63 * p + 35 * p**2),
    )
    e, f = 8 + 14 * p + 7 * p**2, 6 + 14 * p + 7 * p**2
    mass = [[a, b, c, -d], [b, e, d, -f], [c, d, a, -b], [-d, -f, -b, e]]
    r, s, t = 3 - 15 * p, 4 + 5 * p + 10 * p**2, -1 - 5 * p + 5 * p**2
    turning = [[36, r, -36, r], [r, s, -r, t], [-36, -r, 36, -r], [r, t, -r, s]]
    stiffness = [[12, 6, -12, 6], [6, 4 + p, -6, 2 - p], [-12, -6, 12, -6], [6, 2 - p, -6, 4 + p]]
    slopes = np.array([1.0, h, 1.0, h])
    units = np.outer(slopes, slopes)
    return (
        DENSITY * area * h / (840 * (1 + p) ** 2) * units * np.array(mass),
        DENSITY * inertia / (30 * (1 + p) ** 2 * h) * units * np.array(turning),
        E * inertia / (h**3 * (1 + p)) * units * np.array(stiffness),
    )


def rotor(rpm: float, modes: int, Omega: float) -> PeriodicEquation:
    """In the lowest modes of the shaft at rest, as many in each plane; units of 1000 rad/s."""
    M, K, G = matrices()
    squares, shapes = eigh(K, M)
    turning = rpm * RPM / 1e3 * (shapes.T @ G @ shapes)[:modes, :modes]
    turning = 0.5 * (turning + turning.T)
    zero = np.zeros_like(turning)
    return PeriodicEquation(
        C=np.block([[zero, turning], [-turning, zero]]),
        K=np.diag(np.tile(squares[:modes], 2) / 1e6),
        Omega=Omega,
    )
