"""Mode shapes as power series on the elements: their values, integrals and products."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hill.arrays import Float, frozen
from hill.vehicle.mesh import Mesh
from hill.vehicle.series import TERMS, Series, inverse

# Gauss points of an element: two modes turn by less than 4 radians there, and 28 powers are exact.
POINTS = 14
NODES, WEIGHTS = map(frozen, np.polynomial.legendre.leggauss(POINTS))

Y, PSI, Q, M = range(4)


@dataclass(frozen=True, eq=False)
class Shapes:
    """Some shapes on a mesh.

    Attributes
    ----------
    mesh : Mesh
    coefficients : (shapes, elements, TERMS, 4) ndarray
        Of t^n in y, psi, Q and M.
    """

    mesh: Mesh
    coefficients: Float

    def __len__(self) -> int:
        return len(self.coefficients)

    def points(self, panels: int = 1) -> tuple[Float, Float]:
        """Stations t and weights of Gauss's rule in equal panels of an element, (points,) each."""
        edges = np.linspace(-1.0, 1.0, panels + 1)
        half = 1.0 / panels
        t = (edges[:-1, np.newaxis] + half * (1.0 + NODES)).ravel()
        return t, np.tile(half * WEIGHTS, panels)

    def values(self, t: Float) -> Float:
        """y, psi, Q and M at t of every element, (shapes, elements, 4, points)."""
        powers = t ** np.arange(TERMS)[:, np.newaxis]
        return np.asarray(np.swapaxes(self.coefficients, 2, 3) @ powers)

    @cached_property
    def _at_points(self) -> tuple[Float, Float]:
        t, weight = self.points()
        return self.values(t), weight * self.mesh.half[:, np.newaxis]

    @cached_property
    def mass(self) -> Float:
        """Integrals of m y_i y_j + r psi_i psi_j and the rigid masses' share, (shapes, shapes)."""
        t, _ = self.points()
        at, weight = self._at_points
        found = _inner(at[:, :, Y], at[:, :, Y], weight * _linear(self.mesh.m, t))
        found += _inner(at[:, :, PSI], at[:, :, PSI], weight * _linear(self.mesh.r, t))
        nodes = self.nodes
        for row, rigid in ((Y, self.mesh.mass), (PSI, self.mesh.inertia)):
            found += (nodes[:, :, row] * rigid) @ nodes[:, :, row].T
        return found

    @cached_property
    def stiffness(self) -> Float:
        """Integrals of M_i M_j/EI + Q_i Q_j/kGA, (shapes, shapes)."""
        t, _ = self.points()
        at, weight = self._at_points
        bend, shear = (_compliance(p, t) for p in (self.mesh.flexibility, self.mesh.shear))
        return _inner(at[:, :, M], at[:, :, M], weight * bend) + _inner(
            at[:, :, Q], at[:, :, Q], weight * shear
        )

    def slope_products(self, force: Float, panels: int = 1) -> Float:
        """Integrals of P y_i' y_j', for P at the points of every element, (shapes, shapes)."""
        t, weight = self.points(panels)
        slope = self._slope if panels == 1 else self._slopes(t, self.values(t))
        return _inner(slope, slope, weight * self.mesh.half[:, np.newaxis] * force)

    @cached_property
    def _slope(self) -> Float:
        return self._slopes(self.points()[0], self._at_points[0])

    def _slopes(self, t: Float, at: Float) -> Float:
        """Y' at t of every element, of the values there, (shapes, elements, points)."""
        return np.asarray(at[:, :, PSI] + at[:, :, Q] * _compliance(self.mesh.shear, t))

    @cached_property
    def nodes(self) -> Float:
        """y, psi, Q, M at the nodes, behind the first, (shapes, elements + 1, 4)."""
        sign = (-1.0) ** np.arange(TERMS)
        first = np.einsum("n,snj->sj", sign, self.coefficients[:, 0])
        return np.concatenate([first[:, np.newaxis], self.coefficients.sum(axis=2)], axis=1)

    def at(self, x: float) -> Float:
        """y, psi, Q and M at a station, (shapes, 4)."""
        nodes = self.mesh.nodes
        k = int(np.clip(np.searchsorted(nodes, x) - 1, 0, self.mesh.elements - 1))
        t = (x - nodes[k]) / self.mesh.half[k] - 1.0
        return np.asarray(np.einsum("n,snj->sj", t ** np.arange(TERMS), self.coefficients[:, k]))

    def combined(self, weights: Float) -> "Shapes":
        """Sums of the shapes, one for each column of `weights`."""
        return Shapes(self.mesh, np.tensordot(weights.T, self.coefficients, (1, 0)))


def from_states(solutions: Series, mesh: Mesh, lam: float, states: Float) -> Shapes:
    """Shapes at one lambda from their s at the start of every element, (shapes, elements, 4)."""
    coefficients = solutions.at(lam)
    sign = (-1.0) ** np.arange(TERMS)
    start = np.einsum("n,enij->eij", sign, coefficients)
    middle = np.einsum("eij,sej->sei", inverse(start), states)
    return Shapes(mesh, np.einsum("enij,sej->seni", coefficients, middle))


def straight(mesh: Mesh, centre: float) -> Shapes:
    """The rigid rotation x - centre."""
    found = np.zeros((1, mesh.elements, TERMS, 4))
    found[0, :, 0, Y] = mesh.nodes[:-1] + mesh.half - centre
    found[0, :, 1, Y] = mesh.half
    found[0, :, 0, PSI] = 1.0
    return Shapes(mesh, found)


def _inner(f: Float, g: Float, weight: Float) -> Float:
    return np.asarray((f * weight).reshape(len(f), -1) @ g.reshape(len(g), -1).T)


def _linear(pair: Float, t: Float) -> Float:
    return np.asarray(pair[:, :1] + pair[:, 1:] * t)


def _compliance(pair: Float, t: Float) -> Float:
    """1/EI or 1/kGA at t, from the middle's and the taper."""
    return np.asarray(pair[:, :1] / (1.0 + pair[:, 1:] * t))
