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
    """Roots z of P, discs that hold the true ones, T and its error."""

    z: Complex
    radius: Float
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
    radius = root_radius(polynomial, error, z)
    T = float(Omega / np.pi * np.log(modulus(z)).max() - eta)
    low, high = argument_between(z, radius, Omega, eta)
    rounding = 4.0 * EPS * (Omega / np.pi + abs(eta))
    return Stability(z=z, radius=radius, T=T, T_error=max(high - T, T - low) + rounding)


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


def root_radius(polynomial: Float, error: float, z: Complex) -> Float:
    """Radii of discs about the computed roots whose union holds every true root.

    Smith's theorem (1970): a monic p of degree n has its roots in the discs
    |z - z_j| <= n |p(z_j)| / prod_(k != j) |z_j - z_k|. For a cluster the plain bound by the
    n-th root of |p(z_j)| is smaller and is used instead.
    """
    n = len(z)
    powers = np.abs(z)[:, None] ** np.arange(n)
    residual = np.abs(np.polyval(polynomial, z)) + (error + 2 * n * EPS) * powers.sum(axis=1)
    gaps = np.abs(z[:, None] - z[None, :]) + np.eye(n)
    with np.errstate(divide="ignore"):
        smith = n * residual / gaps.prod(axis=1)
    radius: Float = np.minimum(smith, residual ** (1.0 / n))
    return radius
