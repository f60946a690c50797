"""General linear periodic equations: data only, validated, nothing that computes a solution."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Integral
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hill import checks
from hill.equation import SQUARABLE, HillEquation

Float = NDArray[np.float64]

# Beyond this an element of M^-1 K has lost every digit.
WORST_CONDITION = 1e15

MAX_HARMONICS = 10_000
"""An index above it is taken for a mistake: the motion is followed through every oscillation."""


@dataclass(frozen=True, eq=False)
class Fourier:
    r"""A matrix that is periodic in time, by its Fourier coefficients.

    .. math:: A(\tau) = A_0 + \sum_k A_k \cos k \Omega \tau + \sum_k B_k \sin k \Omega \tau

    Parameters
    ----------
    mean : (n, n) array_like
        A_0.
    cos, sin : mapping of int to (n, n) array_like, optional
        A_k and B_k by k >= 1.

    Raises
    ------
    ValueError
        A matrix that is not square, real, finite and of `mean`'s size; an index that is not a
        whole number >= 1.
    """

    mean: Float
    cos: Mapping[int, Float]
    sin: Mapping[int, Float]

    def __init__(
        self,
        mean: ArrayLike,
        cos: Mapping[int, ArrayLike] | None = None,
        sin: Mapping[int, ArrayLike] | None = None,
        *,
        name: str = "Fourier",
    ) -> None:
        first = checks.square(f"{name}.mean", mean)
        n = len(first)
        checks.store(
            self,
            mean=first,
            cos=_harmonics(f"{name}.cos", cos, n),
            sin=_harmonics(f"{name}.sin", sin, n),
        )

    @property
    def n(self) -> int:
        """Rows."""
        return len(self.mean)

    @property
    def harmonics(self) -> tuple[int, ...]:
        """Every k of a cosine or a sine that is there, ascending."""
        return tuple(sorted({*self.cos, *self.sin}))


@dataclass(frozen=True, eq=False)
class PeriodicEquation:
    r"""A linear equation with periodic coefficients, of second order or of first.

    .. math:: M \ddot q + C(\tau) \dot q + K(\tau) q = 0 \qquad \dot x = A(\tau) x

    Parameters
    ----------
    K : (n, n) array_like or Fourier
        Stiffness; any consistent units.
    C : (n, n) array_like or Fourier, optional
        Damping and gyroscopic terms; none by default.
    M : (n, n) array_like, optional
        Mass, constant and nonsingular; the identity by default.
    Omega : float
        Forcing frequency, > 0: everything has the period 2 pi / Omega.
    data_error : float, optional
        Bound on the error of each element of C and K, over the largest element of that one's
        coefficients. Results say what it may add to their own error, which is for the numbers as
        given.

    Attributes
    ----------
    A : Fourier or None
        Of an equation of first order, made by `first_order`; M, C and K are None then.

    Raises
    ------
    ValueError
        A matrix that is not square, real, finite and of K's size; a singular M; `Omega` <= 0.
    """

    M: Float | None
    C: Fourier | None
    K: Fourier | None
    A: Fourier | None
    Omega: float
    data_error: float

    def __init__(
        self,
        *,
        K: ArrayLike | Fourier,
        Omega: float,
        C: ArrayLike | Fourier | None = None,
        M: ArrayLike | None = None,
        data_error: float = 0.0,
    ) -> None:
        stiffness = _fourier("K", K)
        n = stiffness.n
        damping = _fourier("C", np.zeros((n, n)) if C is None else C, n)
        mass = checks.square("M", np.eye(n) if M is None else M, n=n, like="K")
        if not np.linalg.cond(mass) < WORST_CONDITION:
            raise ValueError("M: is singular to rounding; it must have an inverse")
        checks.store(
            self,
            M=mass,
            C=damping,
            K=stiffness,
            A=None,
            Omega=_forcing_frequency(Omega),
            data_error=checks.between("data_error", data_error, 0.0, 1.0),
        )

    @classmethod
    def first_order(
        cls, *, A: ArrayLike | Fourier, Omega: float, data_error: float = 0.0
    ) -> "PeriodicEquation":
        """An equation of first order, x' = A(tau) x.

        Parameters
        ----------
        A : (m, m) array_like or Fourier
        Omega : float
        data_error : float, optional
            As for an equation of second order, of A.

        Raises
        ------
        ValueError
            As for an equation of second order.
        """
        made = object.__new__(cls)
        checks.store(
            made,
            M=None,
            C=None,
            K=None,
            A=_fourier("A", A),
            Omega=_forcing_frequency(Omega),
            data_error=checks.between("data_error", data_error, 0.0, 1.0),
        )
        return made

    @property
    def order(self) -> int:
        """Number of multipliers m: 2 n, or the rows of A."""
        return self.A.n if self.A is not None else 2 * self.K.n  # type: ignore[union-attr]

    @property
    def period(self) -> float:
        """2 pi / Omega."""
        return 2.0 * math.pi / self.Omega


def general(equation: HillEquation) -> PeriodicEquation:
    """The same system in general form: K = F + gamma cos(Omega tau) G + sum H_s, C = eta."""
    n = equation.n
    cosines: dict[int, Float] = {}
    parts = [(1, equation.gamma * equation.G)]
    if equation.H:
        ratio = equation.ratio
        parts += [(s * ratio, H_s) for s, H_s in enumerate(equation.H, start=1)]
    for k, matrix in parts:
        if np.any(matrix):
            cosines[k] = cosines[k] + matrix if k in cosines else matrix
    return PeriodicEquation(
        K=Fourier(equation.F, cos=cosines, name="K"),
        C=equation.eta * np.eye(n) if np.ndim(equation.eta) == 0 else equation.eta,
        Omega=equation.Omega,
        data_error=equation.data_error,
    )


def with_sine(equation: HillEquation, matrix: ArrayLike) -> PeriodicEquation:
    """The equation in general form with sin(Omega tau) times a matrix in its stiffness."""
    made = general(equation)
    assert made.K is not None
    return PeriodicEquation(
        K=Fourier(made.K.mean, cos=made.K.cos, sin={1: matrix}, name="K"),
        C=made.C,
        Omega=made.Omega,
        data_error=made.data_error,
    )


def _forcing_frequency(Omega: float) -> float:
    return checks.between("Omega", checks.positive("Omega", Omega), *SQUARABLE)


def _fourier(name: str, value: Any, n: int | None = None) -> Fourier:
    if not isinstance(value, Fourier):
        return Fourier(checks.square(name, value, n=n, like="K"), name=name)
    if n is not None and value.n != n:
        raise ValueError(f"{name} has shape {value.mean.shape}: must be ({n}, {n}) like K")
    return value


def _harmonics(
    name: str, given: Mapping[int, ArrayLike] | None, n: int
) -> MappingProxyType[int, Float]:
    if given is None:
        given = {}
    if not isinstance(given, Mapping):
        raise ValueError(f"{name}: must be a mapping of whole numbers to matrices")
    found: dict[int, Float] = {}
    for k, matrix in given.items():
        if isinstance(k, (bool, np.bool_)) or not isinstance(k, Integral) or k < 1:
            raise ValueError(f"{name}[{k!r}]: the index must be a whole number >= 1")
        if k > MAX_HARMONICS:
            raise ValueError(f"{name}[{k}]: the index must be at most {MAX_HARMONICS:,}")
        found[int(k)] = checks.square(f"{name}[{k}]", matrix, n=n, like="the mean")
    return MappingProxyType(dict(sorted(found.items())))
