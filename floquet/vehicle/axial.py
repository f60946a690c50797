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

# Solutions of what is left, the first of the whole.
SOLVED = 3

# Rounding of Omega decides a force that is this many times the thrust.
LARGEST_FORCE = 1e12


@dataclass(frozen=True, eq=False)
class Bar:
    """The vehicle as a bar, discretised; dimensionless as its `Mesh`.

    Attributes
    ----------
    inertia, flexibility : (d, d) sparse
        The two sides of the weak form in the independent forces.
    gradient : (k * POINTS, c) sparse
        P' at the Gauss points from coefficients, exactly 0 where P is constant.
    mobility : (k * POINTS,) ndarray
        Weights of Gauss's rule over the mass per length.
    jump : (k + 1, c) sparse
        P's jumps at the nodes.
    node_mobility, thrust : (k + 1,) ndarray
        1 over the point masses, and what of a thrust of 1 acts there.
    compliance : (c, c) sparse
        Integrals of P Q/EA.
    spread : (c, d) sparse
        Coefficients of P in the elements from the independent forces.
    offset : (c,) ndarray
        And from a thrust of 1.
    basis : skfem.Basis
    """

    inertia: Any
    flexibility: Any
    gradient: Any
    mobility: Float
    jump: Any
    node_mobility: Float
    thrust: Float
    compliance: Any
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
            solve = splu(matrix).solve
            found = np.zeros(matrix.shape[0], complex)
            # the matrix's rounding moves a force between held ends by EPS over an element's length
            for _ in range(SOLVED):
                found = found + solve(self._residual(found, square))
        except RuntimeError:  # singular to the last bit
            found = np.array([np.inf])
        if not np.max(np.abs(found)) < LARGEST_FORCE:
            raise LongitudinalResonance(
                "Omega is a longitudinal resonance: the undamped axial force is infinite"
            )
        P = self._coefficients(found)
        real, imag = (np.ravel(self.basis.interpolate(part)) for part in (P.real, P.imag))
        return np.asarray(real + 1j * imag)

    def _coefficients(self, found: Complex) -> Complex:
        return np.asarray(self.spread @ found + self.offset)

    def _residual(self, found: Complex, square: complex) -> Complex:
        """What the weak form leaves, from P' itself: a constant force leaves exactly nothing."""
        P = self._coefficients(found)
        slope = self.gradient.T @ (self.mobility * (self.gradient @ P))
        jumps = self.jump.T @ (self.node_mobility * (self.jump @ P + self.thrust))
        return np.asarray(self.spread.T @ (square * (self.compliance @ P) - slope - jumps))

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
    rows = np.arange(mesh.x.size).reshape(mesh.x.shape)
    slopes = [np.broadcast_to(part[0].grad[0], mesh.x.shape) for part in basis.basis]
    columns = [np.broadcast_to(dofs[:, None], mesh.x.shape) for dofs in basis.element_dofs]
    places = (np.tile(rows.ravel(), len(slopes)), np.ravel(columns))
    return Bar(
        inertia=sparse.csc_array(spread.T @ stiff @ spread),
        flexibility=sparse.csc_array(spread.T @ flexibility @ spread),
        gradient=sparse.csr_array((np.ravel(slopes), places), shape=(mesh.x.size, basis.N)),
        mobility=np.ravel(mesh.weight / mesh.properties["mass"]),
        jump=jump,
        node_mobility=mobility,
        thrust=thrust,
        compliance=flexibility,
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
