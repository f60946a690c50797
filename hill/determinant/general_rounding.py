r"""The inverse of T by groups: how ln det T moves with mu, by rounding, and with the data.

d ln det T = tr(T^-1 dT). Once T is folded the blocks of its inverse come from the middle outwards,

    G_00 = S_0^-1,     G_(k,k-1) = -S_k^-1 L G,     G_(k-1,k) = -G U S_k^-1,
    G_kk = S_k^-1 - G_(k,k-1) U S_k^-1,     G that of group k - 1.

What stands in every row, an error of a coefficient, moves ln det T by the sum of the blocks; what
is rounded in each row anew, by their root mean square.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from hill.arrays import EPS, Complex, Float
from hill.determinant.general import Folded, Rows
from hill.determinant.general_tail import Tail
from hill.determinant.pencil import Pencil, Terms, stacked

# A row's own roundings, in ulps of its elements.
ROW = 2.0


@dataclass(frozen=True, eq=False)
class Motion:
    """How ln det(mu I - Phi) moves at s points.

    Attributes
    ----------
    slope : (s,) complex ndarray
        With nu.
    rounding : (s,) ndarray
        By rounding, the division by M included.
    data : (s,) ndarray
        By the errors that the data came with. Both are empty if not asked for.
    """

    slope: Complex
    rounding: Float
    data: Float


def motion(p: Pencil, t: Tail, f: Folded, *, bounds: bool = True) -> Motion:
    """Go through the inverse from the middle outwards; `bounds` asks for more than the slope."""
    s, ways, K = len(f.middle), f.ways, len(f.S)
    sums = _Sums(ways, bounds)
    S, coupling = (np.concatenate([x, ways.turned(x)]) for x in (f.middle, f.middle_coupling))
    G = np.linalg.inv(S)
    # the middle is met on both ways
    sums.add(1, 0, G, 0.5)
    sums.eliminated(0, S, G, G, coupling, 0.5)
    for k in range(1, K + 2):
        inverse = f.inverse[k - 1]
        beside = ways.block(0, k) @ inverse
        ahead, behind = -inverse @ ways.block(2, k - 1) @ G, -G @ beside
        G = inverse - ahead @ beside
        sums.add(0, k, ahead)
        sums.add(2, k - 1, behind)
        if k <= K:
            sums.add(1, k, G)
            sums.eliminated(k, f.S[k - 1], inverse, G, f.coupling[k - 1])
    # what lies beyond has its determinant in the series
    end = ways.z(K + 1)[:, 0]
    slope = sums.slope + p.Omega * _trace(G - inverse, t.matrix_slope(end, p.degree))
    slope = slope + _series_slope(p, t, end)
    slope = slope[:s] + slope[s:].conj() + _own_slope(p, ways, K)
    if not bounds:
        return Motion(slope, np.empty(0), np.empty(0))
    square = sums.square[:s] + sums.square[s:] + np.sum(f.logs**2, axis=1)
    nu = ways.nu[:s]
    return Motion(
        slope=slope,
        rounding=EPS * (ROW * np.sqrt(square) + p.order + np.abs(slope * nu))
        + sums.moved(p.rounded),
        data=sums.moved(p.given),
    )


class _Sums:
    """What the blocks of the inverse add up to, both ways side by side."""

    def __init__(self, ways: Rows, bounds: bool) -> None:
        p, count = ways.p, len(ways.nu)
        b = p.reach * p.n
        weighed = bounds and any(map(bool, (*p.rounded, *p.given)))
        self.ways, self.bounds = ways, bounds
        self.slope = np.zeros(count, complex)
        self.square = np.zeros(count)
        self.weights = np.zeros((3, p.degree, count, b, b), complex) if weighed else None

    def add(self, off: int, k: int, G: Complex, share: float = 1.0) -> None:
        """The block of the inverse against the block `off` of T with columns in group k."""
        ways = self.ways
        self.slope += share * _trace(G, ways.slope(off, k))
        if self.bounds:
            self._own(np.abs(G), ways.size(off, k), share)
        if self.weights is not None:
            z = np.repeat(ways.z(k), ways.p.n, axis=1)[:, :, None]
            for d in range(ways.p.degree):
                self.weights[off, d] += share * z**d * G

    def eliminated(
        self, k: int, S: Complex, inverse: Complex, G: Complex, taken: Complex, share: float = 1.0
    ) -> None:
        """Rounding of S_k's own determinant and inverse, and of what was taken from D_k."""
        if self.bounds:
            self._own(np.abs(inverse), np.abs(S), share)
            self._own(np.abs(G), np.abs(taken), share)

    def _own(self, G: Float, size: Float, share: float) -> None:
        rows = np.einsum("scr,src->sr", G, size)
        self.square += share * np.sum(rows**2, axis=1)

    def moved(self, errors: tuple[Terms, ...]) -> Float:
        """By errors of the coefficients."""
        ways = self.ways
        p, s = ways.p, len(ways.nu) // 2
        if self.weights is None or not any(map(bool, errors)):
            return np.zeros(s)
        # det(mu I - Phi) has the trace in a factor too
        moved = np.full(s, np.pi / p.Omega * np.trace(errors[-1].get(0, np.zeros((1, 1)))))
        every = stacked(errors, p.reach, p.n).real
        for off in range(3):
            for d in range(p.degree):
                # what comes after on one way comes before on the other
                other = ways.turned(self.weights[2 - off, d, s:])
                weight = np.abs(self.weights[off, d, :s] + other)
                moved += np.einsum("scr,rc->s", weight, every[off, d])
        return moved


def _trace(G: Complex, change: Any) -> Complex:
    change = np.broadcast_to(change, G.shape)
    return np.asarray(np.einsum("scr,src->s", G, change))


def _series_slope(p: Pencil, t: Tail, end: Complex) -> Complex:
    """Of ln det T of the rows beyond the end, by nu."""
    x = 1.0 / end
    of_h = np.polyval((t.h * np.arange(len(t.h)))[::-1], x) * -x
    return np.asarray(p.Omega * of_h + 1j * t.first / p.reach * x)


def _own_slope(p: Pencil, ways: Rows, K: int) -> Complex:
    """Of exp pi m nu (2 sinh(pi nu)/nu)^m and of the rows' division by z^d, by nu."""
    s = len(ways.nu) // 2
    nu = ways.nu[:s]
    # pi coth(pi nu) - 1/nu, which is pi^2 nu/3 near 0
    small = np.abs(nu) < 1e-3
    safe = np.where(small, 1.0, nu)
    first = np.where(small, np.pi**2 * nu / 3.0, np.pi / np.tanh(np.pi * safe) - 1.0 / safe)
    low, high = ways.start[0] - K * p.reach, ways.start[0] + (K + 1) * p.reach
    j = np.arange(low, high)
    j = j[j != 0]
    return p.order * (np.pi + first - np.sum(1.0 / (nu[:, None] + 1j * j), axis=1))
