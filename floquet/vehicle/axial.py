r"""The axial force in a vehicle whose thrust pulsates, by finite elements of the force itself.

A force P, compression positive, moves what is between loads by m u'' = -P', and shortens it by
P/EA: so (P'/m)' + omega^2 P/EA = 0. For every test force Q

.. math::

   \int P' Q'/m + \sum_k ([P]_k + T_k) [Q]_k/M_k = \omega^2 \int P Q/EA

where [P] is the jump at a point mass M and T_k the thrust that acts on it. P jumps by the thrust
where there is no mass, is 0 beyond a free end and anything where an end is held. A rigid section is
no limit but 1/EA = 0, and steady acceleration is omega = 0: nothing special is done for either.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from floquet.arrays import EPS, Complex, Float
from floquet.vehicle.mesh import Mesh, rule
from hill import LongitudinalResonance, Vehicle

# Inverse iterations for the lowest frequency, whose square they know like (omega_1/omega_2)^4k.
MAX_ITERATIONS = 500

# Rounding of Omega decides a force that is this many times the thrust.
LARGEST_FORCE = 1e12


@dataclass(frozen=True, eq=False)
class Bar:
    """The vehicle as a bar, discretised; dimensionless as its `Mesh`.

    Attributes
    ----------
    inertia, flexibility : (d, d) sparse
        The two sides of the weak form in the independent forces.
    load, load_square : (d,) ndarray
        What a thrust of 1 puts on the right, and per omega^2 besides.
    spread : (c, d) sparse
        Coefficients of P in the elements from the independent forces.
    offset : (c,) ndarray
        And from a thrust of 1.
    basis : skfem.Basis
    """

    inertia: Any
    flexibility: Any
    load: Float
    load_square: Float
    spread: Any
    offset: Float
    basis: Any

    def force(self, square: complex) -> Complex:
        """P per thrust at the Gauss points, (k * POINTS,), where omega^2 is `square`.

        Raises
        ------
        LongitudinalResonance
            It is infinite as far as rounding can tell.
        """
        matrix = sparse.csc_array(self.inertia - square * self.flexibility, dtype=complex)
        try:
            found = splu(matrix).solve(self.load + square * self.load_square)
        except RuntimeError:  # singular to the last bit
            found = np.array([np.inf])
        if not np.max(np.abs(found)) < LARGEST_FORCE:
            raise LongitudinalResonance(
                "Omega is a longitudinal resonance: the undamped axial force is infinite"
            )
        P = self.spread @ found + self.offset
        real, imag = (np.ravel(self.basis.interpolate(part)) for part in (P.real, P.imag))
        return np.asarray(real + 1j * imag)

    @cached_property
    def lowest(self) -> float:
        """The lowest omega^2 of free vibration; infinite where nothing can be shortened."""
        if not np.any(self.flexibility.data):
            return float("inf")
        # where one section alone gives way there are too few vectors for Lanczos
        solve = splu(sparse.csc_array(self.inertia)).solve
        load = self.flexibility @ np.cos(np.arange(self.inertia.shape[0], dtype=float))
        value = 0.0
        for _ in range(MAX_ITERATIONS):
            force = solve(load)
            again = self.flexibility @ force
            before, value = value, float(force @ load) / float(force @ again)
            if abs(value - before) <= 4.0 * EPS * value:
                break
            load = again / np.linalg.norm(again)
        return value


def bar(vehicle: Vehicle, mesh: Mesh, order: int) -> Bar:
    """Discretise the vehicle's axial force with elements of an order, from 3 on."""
    from skfem import Basis, BilinearForm, ElementDG
    from skfem.element import ElementLinePp

    node, weight = rule()
    basis = Basis(mesh.line, ElementDG(ElementLinePp(order)), quadrature=(node[None], weight))
    inertia = BilinearForm(lambda u, v, w: w["c"] * u.grad[0] * v.grad[0]).assemble(
        basis, c=1.0 / mesh.properties["mass"]
    )
    flexibility = BilinearForm(lambda u, v, w: w["c"] * u * v).assemble(
        basis, c=mesh.properties["axial_flexibility"]
    )
    left, right, *inner = basis.element_dofs
    joints = _joints(vehicle, mesh, left, right)
    spread, offset = _spread(joints, np.ravel(inner), basis.N)
    jump = sparse.csr_array(
        (
            [1.0 if plus else -1.0 for j in joints for _, plus in j.sides],
            (
                [k for k, j in enumerate(joints) for _ in j.sides],
                [dof for j in joints for dof, _ in j.sides],
            ),
        ),
        shape=(len(joints), basis.N),
    )
    mobility = np.array([1.0 / j.mass if j.mass else 0.0 for j in joints])
    thrust = np.array([j.thrust for j in joints])
    stiff = inertia + jump.T @ sparse.diags_array(mobility) @ jump
    return Bar(
        inertia=sparse.csc_array(spread.T @ stiff @ spread),
        flexibility=sparse.csc_array(spread.T @ flexibility @ spread),
        load=-(spread.T @ (stiff @ offset + jump.T @ (mobility * thrust))),
        load_square=spread.T @ (flexibility @ offset),
        spread=spread,
        offset=offset,
        basis=basis,
    )


@dataclass(frozen=True)
class Joint:
    """A node: the coefficients that are P ahead of it (False) and behind it (True), what is there.

    Attributes
    ----------
    sides : tuple of (int, bool)
        One at an end.
    mass, thrust : float
    held : bool
    """

    sides: tuple[tuple[int, bool], ...]
    mass: float
    thrust: float
    held: bool


def _joints(vehicle: Vehicle, mesh: Mesh, left: Any, right: Any) -> list[Joint]:
    count = len(mesh.nodes)
    thrust = np.zeros(count)
    thrust[mesh.node(vehicle.thrust_station)] = 1.0
    nose, aft = (end != "free" for end in vehicle.ends)
    # the nose takes the thrust where both are held
    held = {0: nose, count - 1: aft and not nose}
    return [
        Joint(
            sides=(
                *(((int(right[k - 1]), False),) if k > 0 else ()),
                *(((int(left[k]), True),) if k < count - 1 else ()),
            ),
            # a mass that is held moves nothing
            mass=0.0 if held.get(k, False) else float(mesh.point_mass[k]),
            thrust=float(thrust[k]),
            held=held.get(k, False),
        )
        for k in range(count)
    ]


def _spread(joints: list[Joint], inner: Any, size: int) -> tuple[Any, Float]:
    """Every coefficient of P from the independent ones, and from a thrust of 1.

    Where there is a mass, or an end is held, P on either side is its own; elsewhere it jumps by the
    thrust, which leaves one to choose in the vehicle and none at a free end.
    """
    offset = np.zeros(size)
    pairs: list[tuple[int, int]] = []
    count = 0
    for joint in joints:
        own = bool(joint.mass) or joint.held
        for dof, behind in joint.sides:
            if own:
                pairs.append((dof, count))
                count += 1
            elif len(joint.sides) == 2:
                pairs.append((dof, count))
                offset[dof] = -joint.thrust if behind else 0.0
            else:
                offset[dof] = -joint.thrust if behind else joint.thrust
        if not own and len(joint.sides) == 2:
            count += 1
    pairs += [(int(dof), count + k) for k, dof in enumerate(inner)]
    rows, columns = np.array(pairs).T
    shape = (size, count + len(inner))
    return sparse.csr_array((np.ones(len(pairs)), (rows, columns)), shape=shape), offset
