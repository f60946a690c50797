"""Mode shapes of the uniform free-free beam, written so that no exponential ever grows.

Eq. (4.5.31) as corrected, phi = cosh + cos - alpha (sinh + sin), loses every digit to cancellation
beyond the tenth mode. Here the growing part is written from the far end instead:

    phi_n(xi) = sum_p c_p exp(kappa_p xi + o_p),   kappa_p = lambda_n i^p,  p = 0..3,

with o_0 = -lambda_n and the other o_p = 0, so that every exponential is at most 1 in modulus.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hill.arrays import Complex, frozen


def eigenvalue(n: int) -> float:
    """lambda_n: the n-th positive root of cosh(lambda) cos(lambda) = 1 (reference 7)."""
    x = (n + 0.5) * np.pi
    for _ in range(4):  # Newton doubles the digits; lambda_1 starts with two, the others with more
        sech = 2.0 * np.exp(-x) / (1.0 + np.exp(-2.0 * x))
        x -= (np.cos(x) - sech) / (-np.sin(x) + np.tanh(x) * sech)
    return float(x)


@dataclass(frozen=True, eq=False)
class Exponentials:
    """f(xi) = sum_p c_p exp(kappa_p xi + o_p): a mode shape, a derivative or a product of them."""

    c: Complex
    kappa: Complex
    o: Complex

    def __post_init__(self) -> None:
        for array in (self.c, self.kappa, self.o):
            frozen(array)

    def __call__(self, xi: float) -> float:
        """Value at the station `xi`."""
        return float(np.real(self.c @ np.exp(self.kappa * xi + self.o)))

    @property
    def derivative(self) -> "Exponentials":
        """d/dxi, Eq. (4.5.34)."""
        return Exponentials(self.c * self.kappa, self.kappa, self.o)

    def __mul__(self, other: "Exponentials") -> "Exponentials":
        """Pointwise product, as a sum of exponentials again, Eq. (4.5.36)."""
        return Exponentials(
            np.multiply.outer(self.c, other.c).ravel(),
            np.add.outer(self.kappa, other.kappa).ravel(),
            np.add.outer(self.o, other.o).ravel(),
        )


@lru_cache(maxsize=256)
def mode(n: int) -> Exponentials:
    """phi_n, Eq. (4.5.31), normalised by (4.5.4): the integral of phi_n**2 is 1."""
    lam = eigenvalue(n)
    decay = np.exp(-lam)
    # 1 - alpha_n and 1 + alpha_n over 2, with exp(lambda) taken out of the first
    denominator = 1.0 - decay**2 - 2.0 * decay * np.sin(lam)
    grown = (np.cos(lam) - np.sin(lam) - decay) / denominator
    alpha = 1.0 - 2.0 * decay * grown
    c: Complex = np.array(
        [grown, 0.5 * (1 + 1j * alpha), 0.5 * (1 + alpha), 0.5 * (1 - 1j * alpha)]
    )
    kappa: Complex = np.array([lam, 1j * lam, -lam, -1j * lam])
    return Exponentials(c, kappa, np.array([-lam, 0, 0, 0], complex))


def slope(n: int) -> Exponentials:
    """phi_n', Eq. (4.5.32)."""
    return mode(n).derivative


def curvature(n: int) -> Exponentials:
    """phi_n''."""
    return slope(n).derivative


_NOTHING = np.zeros(1, complex)
ZERO = Exponentials(_NOTHING, _NOTHING, _NOTHING)
"""The slope of the translation mode 1."""

UNIT = Exponentials(np.ones(1, complex), ZERO.kappa, ZERO.o)
"""The slope of the rotation mode xi, and the translation mode itself."""
