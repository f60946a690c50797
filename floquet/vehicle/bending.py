r"""A vehicle's bending modes, by mixed elements.

The strain energy is not of y'' but of four fields, deflection y, rotation psi, moment M and shear
force Q, which for every test function (w, chi, N, R) obey

.. math::

   \int (M/EI - \psi') N = 0 \qquad \int (Q/kGA - y' + \psi) R = 0
   \qquad \int M \chi' + Q (w' - \chi) = \omega^2 \int (m\, y w + \rho I\, \psi \chi)

with y and psi continuous of order p, M and Q of order p - 1 and free to jump. Shear that is rigid
is no limit but 1/kGA = 0. And only first derivatives enter: rounding grows like the square of the
number of elements, not like its fourth power as with elements of y'', Hermite's. Of a uniform free
beam of 200 elements Hermite's know the lowest frequency's square to 3e-10 and the tenth's to 1e-6,
these of order 6 know both to 3e-15.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.linalg import cholesky, eigh, solve_triangular
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from floquet.arrays import Float
from floquet.vehicle.mesh import Mesh, rule
from hill import Vehicle

Operator = Callable[[Float], Float]

# Block inverse iterations after Lanczos': one brings what Lanczos leaves to rounding, two in hand.
POLISH = 2


@dataclass(frozen=True, eq=False)
class Modes:
    """Mass-normalised shapes at the mesh's Gauss points and nodes, a row each.

    The elastic ones, ascending, then the rigid rotation if there is one. The aft end's deflection
    is positive; its rotation, if that end is pinned; its moment, if it is clamped.

    Attributes
    ----------
    square : (n,) ndarray
        omega^2, dimensionless; 0 for the rotation.
    y, slope, rotation : (n, k * POINTS) ndarray
        Deflection, its derivative, and the rotation of the cross-section.
    y_node, rotation_node : (n, k + 1) ndarray
    """

    square: Float
    y: Float
    slope: Float
    rotation: Float
    y_node: Float
    rotation_node: Float


def modes(vehicle: Vehicle, mesh: Mesh, order: int) -> Modes:
    """The vehicle's own lowest modes, without thrust.

    Parameters
    ----------
    vehicle : Vehicle
        Its ends, masses, and how many modes.
    mesh : Mesh
    order : int
        p, from 4 on.
    """
    from skfem import Basis, ElementDG
    from skfem.element import ElementLinePp

    node, weight = rule()
    motion = Basis(mesh.line, ElementLinePp(order), quadrature=(node[None], weight))
    stress = Basis(mesh.line, ElementDG(ElementLinePp(order - 1)), quadrature=(node[None], weight))
    at = motion.nodal_dofs[0]
    n = motion.N
    mass = _mass(mesh, motion)
    held = [int(n * k + at[j]) for j, end in ((0, 0), (-1, 1)) for k in _held(vehicle.ends[end])]
    rigid = _rigid(vehicle, mesh, at, n, mass)
    # a free vehicle is clamped at the nose instead, or at its pin: what it takes there is nothing
    support = held + [int(n * k + at[_pin(vehicle)]) for k in (0, 1)] if rigid.size else held
    flexibility = _flexibility(mesh, motion, stress, sorted(set(support)))
    square, shapes = _lowest(vehicle.modes, mass, _projected(flexibility, mass, rigid))
    if vehicle.rotates:
        square, shapes = np.append(square, 0.0), np.column_stack([shapes, rigid[:, -1]])
    shapes = shapes * _sign(vehicle, mesh, motion, shapes)
    y, psi = shapes[:n].T, shapes[n:].T
    field = [[motion.interpolate(row) for row in which] for which in (y, psi)]
    return Modes(
        square=square,
        y=np.array([np.ravel(f) for f in field[0]]),
        slope=np.array([np.ravel(f.grad[0]) for f in field[0]]),
        rotation=np.array([np.ravel(f) for f in field[1]]),
        y_node=y[:, at],
        rotation_node=psi[:, at],
    )


def _sign(vehicle: Vehicle, mesh: Mesh, motion: Any, shapes: Float) -> Float:
    """What makes the aft end as `Modes` says."""
    n, last = motion.N, motion.nodal_dofs[0][-1]
    if vehicle.ends[1] == "free":
        aft = shapes[last]
    elif vehicle.ends[1] == "pinned":
        aft = shapes[n + last]
    else:  # the rotation is -M d/EI at a distance d ahead, with shear too
        aft = np.array([-np.ravel(motion.interpolate(psi))[-1] for psi in shapes[n:].T])
    return np.where(aft < 0.0, -1.0, 1.0)


def _held(end: str) -> tuple[int, ...]:
    """Which of y (0) and psi (1) an end holds."""
    return {"free": (), "pinned": (0,), "clamped": (0, 1)}[end]


def _pin(vehicle: Vehicle) -> int:
    return -1 if vehicle.ends[1] == "pinned" else 0


def _mass(mesh: Mesh, motion: Any) -> Any:
    """Mass matrix of (y, psi), sparse."""
    y = _product().assemble(motion, c=mesh.properties["mass"])
    psi = _product().assemble(motion, c=mesh.properties["rotary_inertia"])
    points = np.zeros((2, motion.N))
    points[:, motion.nodal_dofs[0]] = mesh.point_mass, mesh.point_inertia
    return sparse.csr_array(sparse.block_diag([y, psi]) + sparse.diags_array(np.ravel(points)))


def _rigid(vehicle: Vehicle, mesh: Mesh, at: Any, n: int, mass: Any) -> Float:
    """Mass-normalised rigid motions: translation, if it is free, and rotation."""
    if not vehicle.rotates:
        return np.empty((2 * n, 0))
    free = vehicle.ends == ("free", "free")
    motions = np.zeros((2 * n, 1 + free))
    motions[at, 0] = 1.0
    motions[at, -1] = mesh.nodes - mesh.nodes[_pin(vehicle)]
    motions[n + at, -1] = 1.0
    # rotation is about the centre of mass once translation is taken off
    factor = cholesky(motions.T @ (mass @ motions), lower=True)
    return np.asarray(solve_triangular(factor, motions.T, lower=True).T)


def _flexibility(mesh: Mesh, motion: Any, stress: Any, support: list[int]) -> Operator:
    """Loads on (y, psi) to the motions they cause, held at the support."""
    shear = _product().assemble(stress, c=mesh.properties["shear_flexibility"])
    bending = _product().assemble(stress, c=mesh.properties["flexibility"])
    derivative = _derivative().assemble(motion, stress)
    value = _product().assemble(motion, stress, c=np.ones_like(mesh.x))
    whole = sparse.bmat(
        [
            [-shear, None, derivative, -value],
            [None, -bending, None, derivative],
            [derivative.T, None, None, None],
            [-value.T, derivative.T, None, None],
        ]
    ).tocsr()
    first = 2 * stress.N
    kept = np.setdiff1d(np.arange(whole.shape[0]), first + np.array(support, int))
    solve = splu(whole[kept][:, kept].tocsc()).solve

    def apply(load: Float) -> Float:
        full = np.zeros((whole.shape[0], *load.shape[1:]))
        full[first:] = load
        full[kept] = solve(full[kept])
        result: Float = full[first:]
        if support:
            result[support] = 0.0
        return result

    return apply


def _projected(flexibility: Operator, mass: Any, rigid: Float) -> Operator:
    """The same of what a load leaves once it has moved the rigid vehicle, motion included."""
    momentum = mass @ rigid

    def apply(load: Float) -> Float:
        moved = flexibility(load - momentum @ (rigid.T @ load))
        return moved - rigid @ (momentum.T @ moved)

    return apply


def _lowest(count: int, mass: Any, flexibility: Operator) -> tuple[Float, Float]:
    """The lowest omega^2 and mass-normalised shapes, as columns, ascending."""
    size = mass.shape[0]
    operator = LinearOperator((size, size), matvec=flexibility, dtype=float)
    # rotary inertia may be 0: Lanczos must start where the mass matrix has no kernel
    start = flexibility(mass @ np.cos(np.arange(size, dtype=float)))
    _, shapes = eigsh(operator, count, M=mass, sigma=0.0, OPinv=operator, v0=start)
    for _ in range(POLISH):
        shapes = flexibility(mass @ shapes)
        shapes /= np.sqrt(np.sum(shapes * (mass @ shapes), axis=0))
        again = flexibility(mass @ shapes)
        reach = (mass @ shapes).T @ again
        inverse, mix = eigh(0.5 * (reach + reach.T), shapes.T @ (mass @ shapes))
        shapes = shapes @ mix[:, ::-1]
    return 1.0 / inverse[::-1], shapes


def _product() -> Any:
    from skfem import BilinearForm

    return BilinearForm(lambda u, v, w: w["c"] * u * v)


def _derivative() -> Any:
    from skfem import BilinearForm

    return BilinearForm(lambda u, v, _: u.grad[0] * v)
