"""The beam's equation on one element by a double power series, in the station and in lambda.

With s = (y, psi, Q, M), deflection, rotation, shear force and bending moment,

    y' = psi + Q/kGA,   psi' = M/EI,   Q' = -lambda m y,   M' = -Q - lambda r psi,

and, with an axial force P, ``(kGA - P) y' = Q + kGA psi`` and ``M' = -Q - P y' - lambda r psi``.
Q is then the whole lateral force. kGA may be infinite; all coefficients are polynomials in t.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hill.arrays import Float, frozen
from hill.vehicle.mesh import Mesh

# Half an element is half a radian at most: terms in t fall like 2^-n/n!, a taper's like .2^n; those
# in lambda like 2^-4n/(4 n)!, or with shear like 4^-n/(2 n)!.
TERMS = 26
LAMBDA_TERMS = 9

# s and the forces and displacements that belong together: s.T J s' is conserved.
J = frozen(np.block([[np.zeros((2, 2)), np.eye(2)], [-np.eye(2), np.zeros((2, 2))]]))


@dataclass(frozen=True, eq=False)
class Series:
    """Solutions on every element: coefficients of t^n and (lambda/most)^k.

    Attributes
    ----------
    coefficients : (elements, LAMBDA_TERMS, TERMS, 4, 4) ndarray
        Of s that grows out of each unit vector in the element's middle.
    most : float
        The mesh's.
    """

    coefficients: Float
    most: float

    def at(self, lam: float) -> Float:
        """Coefficients of t^n at one lambda, (elements, TERMS, 4, 4)."""
        return np.asarray(np.tensordot(self._powers(lam), self.coefficients, (0, 1)))

    @cached_property
    def _ends(self) -> tuple[Float, Float]:
        """At t = -1 and 1, (LAMBDA_TERMS, elements, 4, 4) each."""
        sign = (-1.0) ** np.arange(TERMS)
        moved = np.moveaxis(self.coefficients, 1, 0)
        return np.einsum("n,kenij->keij", sign, moved), moved.sum(axis=2)

    def transfers(self, lams: Float) -> Float:
        """What takes s from the start of every element to its end, (lams, elements, 4, 4)."""
        powers = self._powers(np.asarray(lams, float)[:, np.newaxis])
        start, end = (np.tensordot(powers, part, (1, 0)) for part in self._ends)
        return np.asarray(end @ inverse(start))

    @cached_property
    def static(self) -> Float:
        """The transfer matrices of lambda = 0."""
        return np.asarray(self.transfers(np.zeros(1))[0])

    def _powers(self, lam: Float | float) -> Float:
        return np.asarray((lam / self.most) ** np.arange(LAMBDA_TERMS))


def inverse(transfer: Float) -> Float:
    """Of transfer matrices, (..., 4, 4), exactly: they conserve J."""
    return np.asarray(-J @ np.swapaxes(transfer, -1, -2) @ J)


def series(mesh: Mesh, axial: Float | None = None) -> Series:
    """Solve on every element.

    Parameters
    ----------
    mesh : Mesh
    axial : (elements, 3) ndarray, optional
        P as a quadratic in t.
    """
    d = mesh.half[:, np.newaxis, np.newaxis]
    P = np.zeros((mesh.elements, 3)) if axial is None else axial
    flexibility, bend = _column(mesh.flexibility)
    shear, taper = _column(mesh.shear)
    (m0, m1), (r0, r1) = _column(mesh.m), _column(mesh.r)
    force = [P[:, j, np.newaxis, np.newaxis] for j in range(3)]
    # (1 + taper t - P shear) y' = shear Q + (1 + taper t) psi
    divisor = [1.0 - shear * force[0], taper - shear * force[1], -shear * force[2]]
    # axes: n, component, element, k, unit vector
    s = np.zeros((TERMS, 4, mesh.elements, LAMBDA_TERMS, 4))
    s[0, :, :, 0, :] = np.eye(4)[:, np.newaxis, :]
    y, psi, Q, M = s[:, 0], s[:, 1], s[:, 2], s[:, 3]

    def raised(x: Float) -> Float:
        """Times lambda."""
        out = np.zeros_like(x)
        out[:, 1:] = mesh.most * x[:, :-1]
        return out

    for n in range(TERMS - 1):
        last = n - 1 if n else TERMS - 1  # the last ones are still zero
        rise = d * (shear * Q[n] + psi[n] + taper * psi[last])
        for j in range(1, min(n, 2) + 1):
            rise -= divisor[j] * (n + 1 - j) * y[n + 1 - j]
        y[n + 1] = rise / (divisor[0] * (n + 1))
        psi[n + 1] = (d * flexibility * M[n] - bend * n * psi[n]) / (n + 1)
        Q[n + 1] = -d * raised(m0 * y[n] + m1 * y[last]) / (n + 1)
        pull = sum((force[j] * (n + 1 - j) * y[n + 1 - j] for j in range(min(n, 2) + 1)), 0.0 * d)
        M[n + 1] = -(d * Q[n] + pull + d * raised(r0 * psi[n] + r1 * psi[last])) / (n + 1)
    return Series(np.ascontiguousarray(s.transpose(2, 3, 0, 1, 4)), mesh.most)


def _column(pair: Float) -> tuple[Float, Float]:
    return pair[:, 0, np.newaxis, np.newaxis], pair[:, 1, np.newaxis, np.newaxis]
