"""The equation both routes are handed: data only, validated, nothing that computes a solution."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hill import checks

# omega_L and Omega are each rounded once and so is their quotient: three half-ulps, doubled.
COMMENSURATE_ULPS = 3

# Omega is squared and divided by.
SQUARABLE = (1e-100, 1e100)


@dataclass(frozen=True, eq=False)
class HillEquation:
    r"""A matrix Hill equation, Eq. (6.1.1) of the report.

    .. math::

       \ddot q + \eta \dot q + F q + \gamma \cos(\Omega \tau) G q
               + \sum_{s \ge 1} H_s \cos(s \omega_L \tau) q = 0

    Parameters
    ----------
    F, G : (n, n) array_like
        Constant and pulsating stiffness, over ``omega_1**2`` (dimensionless).
    gamma : float
        Thrust ratio T1/T0, any sign.
    Omega : float
        Forcing frequency over ``omega_1``, > 0.
    eta : float or (n, n) array_like, optional
        Transverse damping over ``omega_1``. With a matrix there is no z, as the report's
        transformation (6.1.2) needs one number: both routes give the polynomial of the multipliers.
    H : sequence of (n, n) array_like, optional
        ``H[s - 1]`` multiplies ``cos(s omega_L tau)``.
    omega_L : float, optional
        Fundamental longitudinal frequency over ``omega_1``. With `H` it must be a whole multiple
        of `Omega`, or the equation has no common period (6.2.4).
    data_error : float, optional
        Bound on the error of each element of F, G and H, over that matrix's largest element.
        Results say what it may add to their own error, which is for the numbers as given.

    Raises
    ------
    ValueError
        A matrix that is not square, finite and of F's size; `Omega` or `omega_L` <= 0; a number
        that is not finite; `H` without a common period.
    """

    F: NDArray[np.float64]
    G: NDArray[np.float64]
    gamma: float
    Omega: float
    eta: float | NDArray[np.float64] = 0.0
    H: tuple[NDArray[np.float64], ...] = ()
    omega_L: float = math.inf
    data_error: float = 0.0

    def __init__(
        self,
        F: ArrayLike,
        G: ArrayLike,
        gamma: float,
        Omega: float,
        eta: float | ArrayLike = 0.0,
        H: Sequence[ArrayLike] = (),
        omega_L: float = math.inf,
        data_error: float = 0.0,
    ) -> None:
        checked = checks.square("F", F)
        n = len(checked)
        try:
            one_number = np.ndim(eta) == 0
        except ValueError:
            raise ValueError(f"eta = {eta!r}: must be a number or an ({n}, {n}) matrix") from None
        checks.store(
            self,
            F=checked,
            G=checks.square("G", G, n=n),
            gamma=checks.number("gamma", gamma),
            Omega=checks.between("Omega", checks.positive("Omega", Omega), *SQUARABLE),
            eta=checks.number("eta", eta) if one_number else checks.square("eta", eta, n=n),
            H=checks.matrices("H", H, n=n),
            omega_L=checks.positive("omega_L", omega_L, or_infinite=True),
            data_error=checks.between("data_error", data_error, 0.0, 1.0),
        )
        if self.H:
            _ = self.ratio

    def forced(
        self, *, Omega: float, gamma: float, eta: float, omega_L: float | None = None
    ) -> "HillEquation":
        """The same matrices under another forcing; they are not checked again.

        `omega_L` is another one too, where that is given.

        Raises
        ------
        ValueError
            A value out of range; `H`, whose period must be a whole part of the new one.
        """
        if self.H:
            raise ValueError("H: belongs to its own Omega; make a new HillEquation")
        other = object.__new__(HillEquation)
        checks.store(
            other,
            F=self.F,
            G=self.G,
            gamma=checks.number("gamma", gamma),
            Omega=checks.between("Omega", checks.positive("Omega", Omega), *SQUARABLE),
            eta=checks.number("eta", eta),
            H=(),
            omega_L=self.omega_L
            if omega_L is None
            else checks.positive("omega_L", omega_L, or_infinite=True),
            data_error=self.data_error,
        )
        return other

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.F.shape[0])

    @property
    def period(self) -> float:
        """Common period of all coefficients, 2 pi / Omega, in units of ``1 / omega_1``."""
        return 2.0 * math.pi / self.Omega

    def general(self) -> Any:
        """The same system as a `PeriodicEquation`."""
        # that module knows this one
        from hill.periodic import general

        return general(self)

    @property
    def damping(self) -> float:
        """`eta` where it is one number.

        Raises
        ------
        ValueError
            `eta` is a matrix: no change of variable removes it.
        """
        if isinstance(self.eta, np.ndarray):
            raise ValueError(
                "eta is a matrix: z and half a period need one number; "
                "characteristic and monodromy do without"
            )
        return self.eta

    @property
    def ratio(self) -> int:
        """The whole number omega_L / Omega of Eq. (6.2.4).

        Raises
        ------
        ValueError
            omega_L / Omega is not a whole number.
        """
        quotient = self.omega_L / self.Omega
        whole = round(quotient) if math.isfinite(quotient) else 0
        if whole < 1 or abs(quotient - whole) > COMMENSURATE_ULPS * math.ulp(whole):
            raise ValueError(
                f"omega_L/Omega = {quotient:.9g} (omega_L = {self.omega_L:g}, "
                f"Omega = {self.Omega:g}): must be a whole number when H is present, "
                "or the terms have no common period"
            )
        return whole
