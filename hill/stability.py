"""From P(z) to R, T and a verdict, with what the error of P allows (sections 6.4 and 7.1)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complexfloating[Any, Any]]
Float = NDArray[np.floating[Any]]
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Stability:
    """Roots z of P, T and its error."""

    z: Complex
    T: float
    T_error: float

    @property
    def stable(self) -> bool:
        """Whether T could be zero or less, as far as its error tells."""
        return self.T_error >= self.T


def stability(polynomial: Float, error: float, Omega: float, eta: float) -> Stability:
    """Roots of P and the characteristic argument T = (Omega/pi) ln R - eta, Eq. (7.1.1)."""
    z = np.roots(polynomial).astype(complex)
    z = z[np.lexsort((z.imag, -z.real))]
    T = float(Omega / np.pi * np.log(modulus(z)).max() - eta)
    discs, equal = root_discs(polynomial, error, z)
    ends = [argument_between(z, radius, Omega, eta) for radius in (discs, equal)]
    low, high = max(end[0] for end in ends), min(end[1] for end in ends)
    rounding = 4.0 * EPS * (Omega / np.pi + abs(eta))
    return Stability(z=z, T=T, T_error=max(high - T, T - low) + rounding)


def argument_between(
    z: Complex, radius: Float | float, Omega: float, eta: float
) -> tuple[float, float]:
    """Least and largest T of (7.1.1) that values within `radius` of z can have.

    ln R is harmonic off the segment [-1, 1], and least on it: the extremes over a disc are on its
    rim, or zero where the disc meets the segment.
    """
    radius = np.broadcast_to(radius, z.shape)
    rim = z[:, None] + radius[:, None] * np.exp(2j * np.pi * np.arange(16) / 16)
    growth = np.log(modulus(np.column_stack([z, rim])))
    least = np.where(np.abs(z - np.clip(z.real, -1.0, 1.0)) <= radius, 0.0, growth.min(axis=1))
    to_T = Omega / np.pi
    return float(to_T * least.max() - eta), float(to_T * growth.max() - eta)


def modulus(z: Complex) -> Float:
    """R = max |z +- sqrt(z^2 - 1)| >= 1, Eq. (7.1.2)."""
    root = np.sqrt(z - 1.0) * np.sqrt(z + 1.0)
    return np.maximum(np.abs(z + root), np.abs(z - root))


def root_discs(polynomial: Float, error: float, z: Complex) -> tuple[Float, float]:
    """Two sets of discs about the computed roots, each of which holds every true root.

    Smith's theorem (1970): a monic p of degree n has its roots in the discs
    |z - z_j| <= n |p(z_j)| / prod_(k != j) |z_j - z_k|. In a cluster these are large; there equal
    discs are better: at a true root prod_j |z - z_j| is no more than the computed polynomial's
    error, so the nearest z_j is within its n-th root.
    """
    n = len(z)
    slack = error + 2 * n * EPS * float(np.max(np.abs(polynomial)))
    size = np.sum(np.abs(z)[:, None] ** np.arange(n), axis=1)
    residual = np.abs(np.polyval(polynomial, z)) + slack * size
    gaps = np.abs(z[:, None] - z[None, :]) + np.eye(n)
    with np.errstate(divide="ignore"):
        smith = n * residual / gaps.prod(axis=1)
    # np.roots is backward stable: its z are the exact roots of a polynomial within this of p
    backward = slack + n * EPS * float(np.max(np.abs(polynomial)))
    farthest = float(np.max(np.abs(z))) + 1.0
    equal = (backward * np.sum(farthest ** np.arange(n))) ** (1.0 / n)
    # a disc that only touches [-1, 1] must not be lost to rounding
    return smith * (1.0 + 1e-9), equal * (1.0 + 1e-9)
