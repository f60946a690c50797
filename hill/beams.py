"""The report's two beams: parameters, frozen and validated, and what is asked of a beam.

The formulas are in :mod:`hill.matrices.uniform` and :mod:`hill.matrices.stepped`.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from hill import checks
from hill.arrays import Complex, Float
from hill.beam_common import (
    COMMON,
    MAX_G,
    MAX_MODES,
    RESONANCE_ULPS,
    SMALLEST,
    forcing,
    frequencies,
    matrix_error,
    names,
    refuse_resonance,
)
from hill.equation import HillEquation
from hill.matrices import stepped, uniform
from hill.periodic import with_sine
from hill.system import Parameter


@dataclass(frozen=True, kw_only=True)
class UniformBeam:
    """A uniform free-free beam pushed by a gimbaled, pulsating end thrust (chapter 4).

    Parameters
    ----------
    T0 : float
        Constant thrust ``T0 l**2 / (E I)``, Eq. (4.4.12).
    K_theta : float
        Gimbal angle over the rotation at the sensor, Eq. (4.1.5); 0 leaves rotation uncontrolled.
    xi_G : float
        Station of the attitude sensor, 0 to 1; the thrust acts at 1.
    omega_L : float, optional
        Fundamental longitudinal frequency over ``omega_1``, Eq. (4.4.9) as corrected.
    g : float, optional
        Structural damping factor of the longitudinal vibration, Eq. (4.2.34), 0 to 10,000.
    modes : int, optional
        N, the number of bending modes; the report has 2.
    quadrature_force : bool, optional
        Whether the force's part a quarter of a period behind the thrust, which the report leaves
        out (4.2.39), is in the equation. That is a `PeriodicEquation` then.

    Raises
    ------
    ValueError
        A parameter out of range, by name.
    """

    T0: float
    K_theta: float
    xi_G: float
    omega_L: float = math.inf
    g: float = 0.0
    modes: int = 2
    quadrature_force: bool = False

    def __post_init__(self) -> None:
        checks.store(
            self,
            T0=checks.number("T0", self.T0),
            K_theta=checks.number("K_theta", self.K_theta),
            xi_G=checks.station("xi_G", self.xi_G),
            omega_L=checks.positive("omega_L", self.omega_L, or_infinite=True),
            g=checks.between("g", self.g, 0.0, MAX_G),
            modes=checks.count("modes", self.modes, least=1, most=MAX_MODES),
            quadrature_force=checks.flag("quadrature_force", self.quadrature_force),
        )

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What may be varied; `modes` may not."""
        return (*COMMON, Parameter("g", 0.0, MAX_G, moves=("G",)))

    @property
    def depends_on_Omega(self) -> bool:
        """Whether G moves with Omega, as with a finite `omega_L`."""
        return math.isfinite(self.omega_L)

    @property
    def frequency_names(self) -> tuple[str, ...]:
        """As the report calls them: rotation first, then bending."""
        return names(self.modes)

    def singular_Omega(self, low: float, high: float) -> Float:
        """Omega from `low` to `high` where the axial force is infinite (4.4.16)."""
        if self.g > 0.0 or math.isinf(self.omega_L):
            return np.empty(0)
        first, last = math.ceil(low / self.omega_L), math.floor(high / self.omega_L)
        return self.omega_L * np.arange(max(first, 1), last + 1)

    def natural_frequencies(self) -> Float | Complex:
        """omega_(B) and omega_(1..N) under the constant thrust, over ``omega_1``.

        Returns
        -------
        (modes + 1,) ndarray
            Ascending by real part, real; complex where the beam has lost its stability, by
            divergence (a purely imaginary frequency) or by flutter (a conjugate pair).
        """
        return frequencies(uniform.steady(self.modes, self.T0, self.K_theta, self.xi_G))

    def equation(self, Omega: float, gamma: float, eta: float = 0.0, initial_terms: int = 0) -> Any:
        """Eq. (4.5.18) in closed form.

        Parameters
        ----------
        Omega : float
            Forcing frequency over ``omega_1``, > 0.
        gamma : float
            Thrust ratio T1/T0.
        eta : float, optional
            Transverse damping over ``omega_1``, Eq. (4.4.14).
        initial_terms : int, optional
            How many H_s of the vibration that starts from zero displacement and velocity
            (section 4.6) are kept. It needs a finite `omega_L`, a whole multiple of `Omega`,
            and no longitudinal damping, which would make it die out (4.2.40).

        Returns
        -------
        HillEquation, or PeriodicEquation with `quadrature_force`
            Of ``modes + 1`` coordinates: the bending modes, then the rotation.

        Raises
        ------
        ValueError
            A parameter out of range; an undamped longitudinal resonance.
        """
        Omega, sigma = forcing(Omega, self.omega_L)
        gamma = checks.number("gamma", gamma)
        terms = checks.count("initial_terms", initial_terms, least=0)
        if terms and not math.isfinite(self.omega_L):
            raise ValueError(f"initial_terms = {terms}: needs a finite omega_L, which is infinite")
        if terms and self.g > 0.0:
            raise ValueError(
                f"initial_terms = {terms}: must be 0 with g = {self.g:g}, "
                "longitudinal damping makes the free vibration die out (4.2.40)"
            )
        if self.g == 0.0:
            resonant = sigma >= 0.5 and abs(sigma - round(sigma)) <= RESONANCE_ULPS * math.ulp(
                sigma
            )
            refuse_resonance(resonant, Omega, self.omega_L)
        damped = np.sqrt(sigma**2 - 1j * self.g) if self.g else sigma
        beam = (self.modes, self.T0)
        G = uniform.pulsating(*beam, self.K_theta, self.xi_G, damped)
        late = uniform.out_of_phase(*beam, damped) if self.g else np.zeros_like(G)
        hidden = float(np.max(np.abs(late)) / max(np.max(np.abs(G)), SMALLEST))
        made = HillEquation(
            F=uniform.steady(*beam, self.K_theta, self.xi_G),
            G=G,
            gamma=gamma,
            Omega=Omega,
            eta=checks.number("eta", eta),
            H=[uniform.free_vibration(*beam, gamma, sigma, s) for s in range(1, terms + 1)],
            omega_L=self.omega_L,
            data_error=matrix_error(np.pi * abs(damped), abs(np.sin(np.pi * damped)), hidden),
        )
        return with_sine(made, -gamma * late) if self.quadrature_force else made


@dataclass(frozen=True, kw_only=True)
class SteppedBeam:
    """Two uniform sections joined by a rigid bulkhead, under the same thrust (chapter 5).

    Thrust, frequencies and time are made dimensionless with section 2, the one that is pushed.

    Parameters
    ----------
    T0 : float
        Constant thrust ``T0 l**2 / (E I_2)``, Eq. (5.4.6).
    K_theta, xi_G
        As for `UniformBeam`.
    xi_c : float
        Station of the step, 0 to 1.
    area_ratio, inertia_ratio : float
        A_1/A_2 (5.3.16) and I_1/I_2, > 0.
    omega_L : float, optional
        ``(pi/l) sqrt(E/rho) / omega_1``, Eq. (5.2.13).
    modes : int, optional
        N, the number of bending modes.

    Raises
    ------
    ValueError
        A parameter out of range, by name.
    """

    T0: float
    K_theta: float
    xi_G: float
    xi_c: float
    area_ratio: float
    inertia_ratio: float
    omega_L: float = math.inf
    modes: int = 2

    def __post_init__(self) -> None:
        checks.store(
            self,
            T0=checks.number("T0", self.T0),
            K_theta=checks.number("K_theta", self.K_theta),
            xi_G=checks.station("xi_G", self.xi_G),
            xi_c=checks.station("xi_c", self.xi_c),
            area_ratio=checks.positive("area_ratio", self.area_ratio),
            inertia_ratio=checks.positive("inertia_ratio", self.inertia_ratio),
            omega_L=checks.positive("omega_L", self.omega_L, or_infinite=True),
            modes=checks.count("modes", self.modes, least=1, most=MAX_MODES),
        )

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What may be varied; `modes` may not."""
        *thrust, elastic = COMMON
        return (
            *thrust,
            Parameter("xi_c", 0.0, 1.0),
            Parameter("area_ratio", 0.0),
            Parameter("inertia_ratio", 0.0, dependence="linear", moves=("F",)),
            elastic,
        )

    @property
    def depends_on_Omega(self) -> bool:
        """Whether G moves with Omega, as with a finite `omega_L`."""
        return math.isfinite(self.omega_L)

    @property
    def frequency_names(self) -> tuple[str, ...]:
        """As the report calls them: rotation first, then bending."""
        return names(self.modes)

    def singular_Omega(self, low: float, high: float) -> Float:
        """Omega from `low` to `high` where the axial force is infinite (5.3.13)."""
        if math.isinf(self.omega_L):
            return np.empty(0)
        least, most = low / self.omega_L, high / self.omega_L
        found = stepped.force_resonances(least, most, self.xi_c, self.area_ratio)
        return self.omega_L * found

    def natural_frequencies(self) -> Float | Complex:
        """omega_(B) and omega_(1..N) under the constant thrust, as for `UniformBeam`."""
        return frequencies(self._steady())

    def equation(
        self, Omega: float, gamma: float, eta: float = 0.0, initial_terms: int = 0
    ) -> HillEquation:
        """Eq. (5.4.9) in closed form, as for `UniformBeam`.

        `initial_terms` must be 0: the free longitudinal frequencies of a stepped bar are no
        multiples of one another, so that its vibration has no period.
        """
        Omega, sigma = forcing(Omega, self.omega_L)
        if checks.count("initial_terms", initial_terms, least=0):
            raise ValueError(
                f"initial_terms = {initial_terms}: must be 0, "
                "the free longitudinal vibration of a stepped beam has no period"
            )
        nu = np.pi * sigma
        inverse_beta = nu * stepped.force_stiffness(nu, self.xi_c, self.area_ratio)
        resonant = nu >= 1.0 and abs(inverse_beta) <= RESONANCE_ULPS * math.ulp(nu)
        refuse_resonance(resonant, Omega, self.omega_L)
        return HillEquation(
            F=self._steady(),
            G=stepped.reduce(self._mass(), self._thrust(sigma)),
            gamma=checks.number("gamma", gamma),
            Omega=Omega,
            eta=checks.number("eta", eta),
            omega_L=self.omega_L,
            data_error=matrix_error(nu, abs(inverse_beta), steep=self._steep(sigma)),
        )

    def _steady(self) -> Float:
        bending = stepped.bending(self.modes, self.xi_c, self.inertia_ratio)
        return stepped.reduce(self._mass(), bending + self._thrust(0.0))

    def _mass(self) -> Float:
        return stepped.mass(self.modes, self.xi_c, self.area_ratio)

    def _thrust(self, sigma: float) -> Float:
        step = (self.xi_c, self.area_ratio)
        return stepped.thrust(self.modes, self.T0, self.K_theta, self.xi_G, *step, sigma)

    def _steep(self, sigma: float) -> float:
        """What the reduction makes of an ulp."""
        step, still = (self.modes, self.xi_c, self.inertia_ratio), self._thrust(0.0)
        mass = self._mass(), 1.0 + self.area_ratio
        of_F = stepped.bending(*step) + still, stepped.bending_size(*step) + np.max(np.abs(still))
        of_G = (moves := self._thrust(sigma)), float(np.max(np.abs(moves)))
        return max(stepped.amplification(mass, load) for load in (of_F, of_G))
