r"""The infinite determinant of a general periodic equation: det(mu I - Phi) at any mu.

With mu = exp(2 pi nu), nu = lambda/Omega, and T of `pencil`, each row of a harmonic j but 0 divided
by z_j^d,

    det(mu I - Phi) = exp pi (m nu - trace/Omega) (2 sinh(pi nu)/nu)^m det T

(docs/theory.md, section 10). T is folded from both ends towards the middle group,

    S_k = D_k - U_k S_(k+1)^-1 L_k,

from where `general_tail` knows S, and ln det of all that lies beyond. No rows are exchanged between
groups, so that many nu go side by side; where an S_k comes close to being singular digits are lost,
and `general_rounding` says how many.

Towards negative j all is the complex conjugate of the way up from conj(nu), the order within a
group turned round: both ways are gone as one, with twice the points.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill.arrays import Complex, Float
from hill.determinant.general_tail import Tail
from hill.determinant.pencil import Pencil
from hill.determinant.products import from_logs


@dataclass(frozen=True, eq=False)
class Rows:
    """The blocks of T on the way up, at s points.

    Attributes
    ----------
    nu : (s,) complex ndarray
    start : (s,) int ndarray
        Harmonic with which group 0 starts; group k starts ``reach`` k above.
    """

    p: Pencil
    nu: Complex
    start: NDArray[np.int_]

    def z(self, k: int) -> Complex:
        """Z_j of group k, (s, g)."""
        j = self.start[:, None] + self.p.reach * k + np.arange(self.p.reach)
        return np.asarray(self.p.Omega * (self.nu[:, None] + 1j * j))

    def block(self, off: int, k: int) -> Any:
        """Columns of group k, rows of the group before (0), of the same (1), of the next (2)."""
        return self._summed(self.p.stacks[off], self.z(k))

    def slope(self, off: int, k: int) -> Any:
        """Derivative of a block by nu."""
        d = np.arange(1, self.p.degree + 1)[:, None, None]
        return self._summed(d * self.p.Omega * self.p.stacks[off, 1:], self.z(k))

    def size(self, off: int, k: int) -> Float:
        """Moduli of what a block sums."""
        return np.asarray(self._summed(np.abs(self.p.stacks[off]), np.abs(self.z(k))))

    def _summed(self, X: Any, z: Any) -> Any:
        """Sum of X_d z^d, each column at its own z."""
        z = np.repeat(z, self.p.n, axis=1)[:, None, :]
        found: Any = 0.0
        for coefficient in X[::-1]:
            found = found * z + coefficient
        return found

    def scale(self, k: int) -> Complex:
        """What the rows of group k are multiplied with, (s, b, 1); 1/Omega^d for harmonic 0."""
        z = self.z(k)
        j = self.start[:, None] + self.p.reach * k + np.arange(self.p.reach)
        z = np.where(j == 0, self.p.Omega, z)
        return np.repeat(z, self.p.n, axis=1)[:, :, None] ** -self.p.degree

    def turned(self, block: Any) -> Any:
        """A block of the way up as one of the way down, or the reverse."""
        g, n = self.p.reach, self.p.n
        by_harmonics = block.conj().reshape(-1, g, n, g, n)
        return by_harmonics[:, ::-1, :, ::-1].reshape(block.shape)


@dataclass(frozen=True, eq=False)
class Folded:
    """T, folded at s points: of both ways together in `ways`, of the middle in the others.

    Attributes
    ----------
    ways : Rows
        At nu and at conj(nu).
    S, inverse, coupling : list of (2 s, b, b) complex ndarray
        S_k, its inverse, and what was taken from D_k, for k = 1, 2, ...; the inverses have one
        more, beyond which the series begin.
    middle, middle_coupling : (s, b, b) complex ndarray
    logs : (s, ...) ndarray
        ln of the moduli of all factors.
    mantissa : (s,) complex ndarray
    exponent : (s,) int ndarray
        Det(mu I - Phi)/exp pi (m Re nu - trace/Omega) as a mantissa and a power of two.
    """

    ways: Rows
    S: list[Complex]
    inverse: list[Complex]
    coupling: list[Complex]
    middle: Complex
    middle_coupling: Complex
    logs: Float
    mantissa: Complex
    exponent: NDArray[np.int_]


def folded(p: Pencil, t: Tail, K: int, nu: Complex) -> Folded:
    """Fold T at s points nu, with K groups kept on either side.

    Parameters
    ----------
    nu : (s,) complex ndarray
        With abs(Im nu) <= 1/2.
    """
    g, s = p.reach, len(nu)
    ways = Rows(p, np.concatenate([nu, nu.conj()]), np.repeat([-(g // 2), g // 2 - g + 1], s))
    end = ways.z(K + 1)[:, 0]
    inverses = [np.linalg.inv(t.matrix(end, p.degree))]
    found, couplings, phases, logs = [], [], [], []
    for k in range(K, 0, -1):
        couplings.append(ways.block(0, k + 1) @ inverses[-1] @ ways.block(2, k))
        found.append(ways.block(1, k) - couplings[-1])
        inverses.append(np.linalg.inv(found[-1]))
        phase, log = np.linalg.slogdet(found[-1] * ways.scale(k))
        phases += [phase[:s], phase[s:].conj()]
        logs += [log[:s], log[s:]]
    last = ways.block(0, 1) @ inverses[-1] @ ways.block(2, 0)
    coupling = last[:s] + ways.turned(last[s:])
    middle = ways.block(1, 0)[:s] - coupling
    phase, log = np.linalg.slogdet(middle * ways.scale(0)[:s])
    beyond = _beyond(p, t, end, ways.nu)
    factors = [(phase, log), (np.exp(1j * beyond.imag), beyond.real)]
    factors += [_free(nu)] * p.order
    phases += [phase for phase, _ in factors]
    logs += [log for _, log in factors]
    mantissa, exponent = from_logs(np.stack(phases, axis=1), np.stack(logs, axis=1))
    return Folded(
        ways=ways,
        S=found[::-1],
        inverse=inverses[::-1],
        coupling=couplings[::-1],
        middle=middle,
        middle_coupling=coupling,
        logs=np.stack(logs, axis=1),
        mantissa=mantissa,
        exponent=exponent,
    )


def _free(nu: Complex) -> tuple[Complex, Float]:
    """Phase and ln of modulus of 2 sinh(pi nu)/nu exp(i pi Im nu)."""
    up = np.where(nu.real < 0.0, -1.0, 1.0)
    # 2 sinh(pi x)/x is even
    x = up * nu
    large = np.abs(x) > 1.0
    far = np.where(large, x, 1.0)
    # exp(-pi x) of it, which no x is too large for
    rest = np.where(large, (1.0 - np.exp(-2.0 * np.pi * far)) / far, 1.0)
    near = 2.0 * np.pi * np.sinc(1j * np.where(large, 0.0, x)) * np.exp(-np.pi * x)
    rest = np.where(large, rest, near)
    phase = np.exp(1j * np.pi * (x.imag + nu.imag)) * rest / np.abs(rest)
    return phase, np.pi * x.real + np.log(np.abs(rest))


def _beyond(p: Pencil, t: Tail, end: Complex, nu: Complex) -> Complex:
    """Ln det T of the rows beyond the ends, (s,)."""
    half = len(end) // 2
    # end/(i Omega): the same as end but for the turn
    log = t.log(end) + 1j * t.first / (p.reach * p.Omega) * np.log(-1j * end)
    return np.asarray(log[:half] + log[half:].conj())
