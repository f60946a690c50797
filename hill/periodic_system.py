"""A system of given periodic matrices, of second order or of first."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hill import checks
from hill.oscillations.steady import mean_frequencies
from hill.periodic import Fourier, PeriodicEquation
from hill.system import Parameter

Complex = NDArray[np.complexfloating[Any, Any]]


@dataclass(frozen=True, eq=False)
class PeriodicSystem:
    r"""Given matrices with their harmonics, at any Omega and share gamma of the pulsation.

    .. math::

       M \ddot q + (C_0 + \eta M + \gamma \tilde C) \dot q + (K_0 + \gamma \tilde K) q = 0
       \qquad \dot x = (A_0 + \gamma \tilde A) x

    Parameters
    ----------
    K : (n, n) array_like or Fourier, optional
        Stiffness; any consistent units.
    C : (n, n) array_like or Fourier, optional
        Damping and gyroscopic terms.
    M : (n, n) array_like, optional
        Mass, constant and nonsingular; the identity by default.
    A : (m, m) array_like or Fourier, optional
        In place of all these, of x' = A x; eta must be 0 then.
    frequency_names : sequence of str, optional
        One for each of `natural_frequencies`.

    Raises
    ------
    ValueError
        As `PeriodicEquation`; neither K nor A, or both.
    """

    M: Any
    C: Any
    K: Any
    A: Any
    frequency_names: tuple[str, ...] | None

    def __init__(
        self,
        *,
        K: ArrayLike | Fourier | None = None,
        C: ArrayLike | Fourier | None = None,
        M: ArrayLike | None = None,
        A: ArrayLike | Fourier | None = None,
        frequency_names: Sequence[str] | None = None,
    ) -> None:
        if (K is None) == (A is None):
            raise ValueError("K, A: one of them must be there, K of second order or A of first")
        if A is not None:
            if C is not None or M is not None:
                raise ValueError("A: is of first order; leave M and C out")
            whole = PeriodicEquation.first_order(A=A, Omega=1.0)
        else:
            assert K is not None
            whole = PeriodicEquation(K=K, C=C, M=M, Omega=1.0)
        names = None if frequency_names is None else tuple(frequency_names)
        checks.store(self, M=whole.M, C=whole.C, K=whole.K, A=whole.A, frequency_names=names)
        if names is not None and len(names) != len(self.natural_frequencies()):
            raise ValueError(f"frequency_names: must be {len(self.natural_frequencies())}")

    depends_on_Omega = False

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """None of its own."""
        return ()

    def varied(self) -> "PeriodicSystem":
        """Itself: there is nothing to vary."""
        return self

    def equation(self, Omega: float, gamma: float = 1.0, eta: float = 0.0) -> PeriodicEquation:
        """The equation at a forcing.

        Raises
        ------
        ValueError
            Omega, gamma or eta out of range; eta where the system is of first order.
        """
        share = checks.number("gamma", gamma)
        damping = checks.number("eta", eta)
        if self.A is not None:
            if damping:
                raise ValueError(f"eta = {damping:g}: must be 0 where A is given")
            return PeriodicEquation.first_order(A=_pulsating(self.A, share), Omega=Omega)
        C = _pulsating(self.C, share)
        if damping:
            C = Fourier(C.mean + damping * self.M, C.cos, C.sin, name="C")
        return PeriodicEquation(M=self.M, C=C, K=_pulsating(self.K, share), Omega=Omega)

    def natural_frequencies(self) -> Complex:
        """Of the mean system, as `hill.oscillations.steady.mean_frequencies`."""
        return mean_frequencies(self.equation(Omega=1.0))


def _pulsating(matrix: Fourier, share: float) -> Fourier:
    """The mean, and so much of every harmonic."""
    return Fourier(
        matrix.mean,
        {k: share * term for k, term in matrix.cos.items()},
        {k: share * term for k, term in matrix.sin.items()},
    )
