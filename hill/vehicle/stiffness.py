"""Dynamic stiffness of a chain of elements: how many frequencies lie below one, and mode vectors.

Between the displacements u = (y, psi) at an element's ends and the forces there, the exact solution
gives a symmetric matrix; assembled, K(lambda) u = 0 at a frequency. By Wittrick and Williams the
frequencies below lambda are as many as K has negative eigenvalues, plus those of the elements with
both ends clamped, of which the mesh sees to it that there are none.

References
----------
Wittrick, Williams, A general algorithm for computing natural frequencies of elastic structures,
Quarterly Journal of Mechanics and Applied Mathematics 24 (1971).
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.linalg import solve_banded

from hill.arrays import EPS, Float, frozen
from hill.vehicle.mesh import Mesh
from hill.vehicle.series import Series

# A group's stiffness this many times its static one has a pole nearby, and rounding with it.
NEAR_POLE = 3.0

# What is left of the two products in a determinant, over them; a uniform element has .2, a group
# with a soft joint inside next to nothing.
SOFT_JOINT = 0.02

# What an end lets move: y and psi, psi, nothing.
MOVES = {
    "free": frozen(np.eye(2)),
    "pinned": frozen(np.array([[0.0], [1.0]])),
    "clamped": frozen(np.zeros((2, 0))),
}

# K couples each displacement to 3 others each way at most.
BAND = 3
# Each falls the rest by the ratio of the two smallest eigenvalues, less than 1/30 where it is used.
ITERATIONS = 5

# Waves in a group of elements, as the integral of (lambda m/EI)^(1/4): what grows in it grows by
# exp(1.5), and its stiffness is not lost beside that of a short stiff element.
GROUP = 1.5


def blocks(transfer: Float) -> tuple[Float, Float, Float]:
    """K11, K12 and K22 of (-f1, f2) = K (u1, u2), from transfer matrices (..., 4, 4)."""
    A, B, D = transfer[..., :2, :2], transfer[..., :2, 2:], transfer[..., 2:, 2:]
    determinant = B[..., 0, 0] * B[..., 1, 1] - B[..., 0, 1] * B[..., 1, 0]
    adjoint = np.stack([B[..., 1, 1], -B[..., 0, 1], -B[..., 1, 0], B[..., 0, 0]], axis=-1)
    inverse = (adjoint / determinant[..., np.newaxis]).reshape(B.shape)
    return inverse @ A, -inverse, D @ inverse


def _left(transfer: Float) -> float:
    """How much of the flexibility's determinant its subtraction leaves."""
    one, other = transfer[0, 2] * transfer[1, 3], transfer[0, 3] * transfer[1, 2]
    return float(abs(one - other) / (abs(one) + abs(other)))


def count(series: Series, mesh: Mesh, ends: tuple[str, str], lams: Float) -> Float:
    """How many squares of frequencies lie below each lambda, rigid motions included.

    Element by element, for many lambda at once. The stiffest element's rounding moves the lambda at
    which a number changes; `Grouped.below` has it to rounding, for one lambda.
    """
    K11, K12, K22 = blocks(series.transfers(lams))
    lams = np.asarray(lams, float)
    below = np.zeros(len(lams), int)
    S: Float = np.zeros((len(lams), 2, 2))
    for k in range(mesh.elements + 1):
        S = S - lams[:, np.newaxis, np.newaxis] * np.diag([mesh.mass[k], mesh.inertia[k]])
        last = k == mesh.elements
        free = MOVES[ends[int(last)]] if k in (0, mesh.elements) else np.eye(2)
        pivot = free.T @ (S if last else S + K11[:, k]) @ free
        below += _negative(pivot)
        if not last:
            across = np.swapaxes(K12[:, k], 1, 2) @ free
            S = K22[:, k]
            if free.size:
                S = S - across @ np.linalg.solve(pivot, np.swapaxes(across, 1, 2))
            S = 0.5 * (S + np.swapaxes(S, 1, 2))
    return below


def _negative(pivot: Float) -> Float:
    """Negative eigenvalues of symmetric matrices of up to two rows."""
    if pivot.shape[-1] < 2:
        return np.asarray(np.sum(pivot < 0.0, axis=(1, 2)))
    determinant = pivot[:, 0, 0] * pivot[:, 1, 1] - pivot[:, 0, 1] ** 2
    trace = pivot[:, 0, 0] + pivot[:, 1, 1]
    return np.where(determinant < 0.0, 1, np.where(trace < 0.0, 2, 0))


@dataclass(frozen=True, eq=False)
class Grouped:
    """The assembled stiffness at one lambda, of groups of elements about a radian long.

    Attributes
    ----------
    K : (n, n) ndarray
        Symmetric, with the ends' conditions, in displacements v scaled so that K is about 1.
    basis : (2 (groups + 1), n) ndarray
        Displacements at the groups' ends of a unit v.
    """

    K: Float
    basis: Float
    _groups: list["_Group"]
    _chain: "_Chain"

    @property
    def below(self) -> int:
        """How many squares of frequencies lie below lambda, rigid motions included."""
        clamped = sum(self._chain.clamped(g.first, g.last) for g in self._groups)
        return int(np.sum(np.linalg.eigvalsh(self.K) < 0.0)) + clamped

    def null(self, count: int) -> Float:
        """Vectors v whose K v is the smallest, (n, count), orthonormal: by inverse iteration."""
        n = len(self.K)
        bands = np.zeros((2 * BAND + 1, n))
        for k in range(-min(BAND, n - 1), min(BAND, n - 1) + 1):
            bands[BAND - k, max(k, 0) : n + min(k, 0)] = np.diagonal(self.K, k)
        v = np.linalg.qr(np.cos(np.outer(np.arange(1, n + 1), np.arange(1, count + 1))))[0]
        for _ in range(ITERATIONS):
            try:
                v = np.linalg.qr(solve_banded((BAND, BAND), bands, v))[0]
            except np.linalg.LinAlgError:  # singular to the last bit: another one
                bands[BAND] += EPS * np.abs(bands).max()
        return np.asarray(v)

    def states(self, v: Float) -> Float:
        """What s is at the start of every element, (elements, 4), of scaled displacements v."""
        u = (self.basis @ v).reshape(-1, 2)
        found = np.empty((len(self._chain.transfer), 4))
        for g, group in enumerate(self._groups):
            s = np.concatenate([u[g], -group.K11 @ u[g] - group.K12 @ u[g + 1]])
            for k in range(group.first, group.last):
                if k > group.first:
                    s = self._chain.transfer[k - 1] @ s
                    s[2:] -= self._chain.points[k] * s[:2]
                found[k] = s
        return found


def grouped(series: Series, mesh: Mesh, ends: tuple[str, str], lam: float) -> Grouped:
    """Assemble K at one lambda."""
    points = lam * np.stack([mesh.mass, mesh.inertia], axis=1)
    chain = _Chain(series.transfers(np.array([lam]))[0], series.static, points)
    waves = 2.0 * mesh.half * (lam * mesh.m[:, 0] * mesh.flexibility[:, 0]) ** 0.25
    # as equal as the elements allow: a short group's stiffness would drown the others' by rounding
    past = np.cumsum(waves)
    shares = np.arange(1, int(past[-1] / GROUP) + 1) / (int(past[-1] / GROUP) + 1)
    inner = 1 + np.argmin(np.abs(past - past[-1] * shares[:, np.newaxis]), axis=1)
    bounds = sorted({0, *inner.tolist(), mesh.elements})
    groups = [g for first, last in pairwise(bounds) for g in chain.groups(first, last)]
    n = 2 * len(groups) + 2
    K, size = np.zeros((n, n)), np.zeros(n)
    for k, group in enumerate(groups):
        own = slice(2 * k, 2 * k + 4)
        K[own, own] += np.block([[group.K11, group.K12], [group.K12.T, group.K22]])
        size[own] += group.size
    rigid = points[[*(g.first for g in groups), mesh.elements]].ravel()
    K[np.diag_indices(n)] -= rigid
    size += np.abs(rigid)
    scale = np.diag(1.0 / np.sqrt(size))
    basis = np.hstack(
        [scale[:, :2] @ MOVES[ends[0]], scale[:, 2:-2], scale[:, -2:] @ MOVES[ends[1]]]
    )
    K = basis.T @ (0.5 * (K + K.T)) @ basis
    return Grouped(K, basis, groups, chain)


@dataclass(frozen=True, eq=False)
class _Group:
    """Elements first .. last - 1 as one: its stiffness, its static one's diagonal (4,)."""

    first: int
    last: int
    K11: Float
    K12: Float
    K22: Float
    size: Float


@dataclass(frozen=True, eq=False)
class _Chain:
    """Transfer matrices of the elements, at lambda and at 0, and lambda times the rigid masses."""

    transfer: Float
    static: Float
    points: Float

    @cached_property
    def start(self) -> Float:
        """K11 of every element."""
        return blocks(self.transfer)[0]

    def groups(self, first: int, last: int) -> list[_Group]:
        """Elements as one group, or as more where one has a clamped frequency near lambda."""
        whole, static = self.transfer[first], self.static[first]
        for k in range(first + 1, last):
            whole = self.transfer[k] @ self._past(k, whole)
            static = self.static[k] @ static
        K11, K12, K22 = blocks(whole)
        S11, _, S22 = blocks(static)
        size = np.concatenate([np.diag(S11), np.diag(S22)])
        dynamic = np.concatenate([np.diag(K11), np.diag(K22)])
        lost = _left(whole) < SOFT_JOINT or np.any(np.abs(dynamic) > NEAR_POLE * size)
        if lost and last - first > 1:
            middle = (first + last) // 2
            return self.groups(first, middle) + self.groups(middle, last)
        return [_Group(first, last, K11, K12, K22, size)]

    def clamped(self, first: int, last: int) -> int:
        """Frequencies below lambda of elements first .. last - 1 with both ends clamped."""
        whole, found = self.transfer[first], 0
        for k in range(first + 1, last):
            passed = self._past(k, whole)
            (a, b), (c, d) = blocks(passed)[2] + self.start[k]
            found += 1 if a * d < b * c else 2 * (a + d < 0.0)
            whole = self.transfer[k] @ passed
        return int(found)

    def _past(self, k: int, whole: Float) -> Float:
        """A transfer matrix that ends at node k, and on past the rigid mass there."""
        if not self.points[k].any():
            return whole
        passed = whole.copy()
        passed[2:] -= self.points[k][:, np.newaxis] * whole[:2]
        return passed
