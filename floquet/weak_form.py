"""The coefficient matrices by quadrature, straight from the weak form of the beam's equation.

The witness of the closed forms in :mod:`hill`: no integral is done by hand here, orthogonality of
the modes is not used, and the axial force of the stepped bar is solved for numerically.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.matrix_rounding import amplification, matrix_error
from floquet.trial_functions import eigenvalues, sampled, trial_at
from hill import (
    Fourier,
    HillEquation,
    LongitudinalResonance,
    PeriodicEquation,
    SteppedBeam,
    UniformBeam,
    checks,
)

Array = NDArray[np.float64]
Complex = NDArray[np.complexfloating]
Force = Callable[[Array], Array]

# Omega/omega_L this many ulps from a resonance cannot be told from it: three roundings precede.
RESONANCE_ULPS = 4


def galerkin(
    beam: UniformBeam | SteppedBeam,
    Omega: float,
    gamma: float,
    eta: float = 0.0,
    initial_terms: int = 0,
) -> Any:
    """Reduce Eq. (4.4.22), or (5.3.8) for a stepped beam, by Galerkin's method (4.5.7).

    Parameters
    ----------
    beam : UniformBeam or SteppedBeam
        Dimensionless parameters; N = ``beam.modes``.
    Omega : float
        Forcing frequency over ``omega_1``, > 0.
    gamma : float
        Thrust ratio T1/T0.
    eta : float, optional
        Transverse damping over ``omega_1``; on a stepped beam it goes with the mass.
    initial_terms : int, optional
        How many H_s of the longitudinal vibration that starts from an unstrained bar are kept.
        Time and memory grow with it, and with ``Omega / omega_L``: the rule resolves every wave.

    Returns
    -------
    HillEquation, or PeriodicEquation with `quadrature_force`
        ``F``, ``G`` and each of ``H`` are (N + 1, N + 1), dimensionless, in the coordinates
        q_1 .. q_N (bending) and q_B (rotation).

    Raises
    ------
    ValueError
        A parameter out of range; `initial_terms` for a stepped beam, an infinite or
        incommensurate ``omega_L``, or with longitudinal damping; an undamped longitudinal
        resonance.
    """
    Omega = checks.positive("Omega", Omega)
    gamma = checks.number("gamma", gamma)
    terms = checks.count("initial_terms", initial_terms, least=0)
    _refuse_terms(beam, terms)
    sigma = Omega / beam.omega_L
    wave, complete = complex(sigma), None
    if isinstance(beam, SteppedBeam):
        step, area, inertia = beam.xi_c, beam.area_ratio, beam.inertia_ratio
        steady = _stepped_force(beam, 0.0, Omega)
        pulsating = _stepped_force(beam, sigma, Omega)
    else:
        step, area, inertia = 0.0, 1.0, 1.0
        wave = np.sqrt(sigma**2 - 1j * beam.g) if beam.g else wave
        steady = _uniform_force(beam, 0j, Omega)
        complete = _uniform_wave(beam, wave, Omega)
        pulsating = _uniform_force(beam, wave, Omega)

    roots = eigenvalues(beam.modes)
    # The fastest integrands are two modes times the axial force.
    xi, weight, shapes = sampled(beam.modes, np.pi * max(abs(wave), terms), step)
    w, slope, curvature = shapes
    w_end, slope_end, _ = trial_at(beam.modes, 1.0)
    slope_sensor = trial_at(beam.modes, beam.xi_G)[1]

    mass = roots[0] ** 4 * _inner(w, w, weight * np.where(xi < step, area, 1.0))
    bending = _inner(curvature, curvature, weight * np.where(xi < step, inertia, 1.0))
    end = _axial_end(w_end, slope_end) + beam.K_theta * np.outer(w_end, slope_sensor)

    def reduced(stiffness: Array) -> Array:
        # Only slopes enter, so the translation, last, has a column of zeros in every stiffness: it
        # is driven by the other coordinates, drives none, and leaves the system with its row.
        matrix: Array = np.linalg.solve(mass, stiffness)[:-1, :-1]
        return matrix

    def thrust(force: Array) -> Array:
        return -beam.T0 * _inner(slope, slope, weight * force)

    bends = (1.0 + inertia) * float(np.max(np.abs(_inner(curvature, curvature, weight))))
    mass_size, loads = (1.0 + area) * roots[0] ** 4, []
    for force, size in ((steady, bends), (pulsating, 0.0)):
        pushed = beam.T0 * end + thrust(force(xi))
        loads.append((pushed + (bending if size else 0.0), size + float(np.max(np.abs(pushed)))))

    # (4.6): the bar starts unstrained, xi + gamma Phi + sum C_s sin(s pi xi) = 0 on [0, 1).
    sines = [np.sin(s * np.pi * xi) for s in range(1, terms + 1)]
    start = steady(xi) + gamma * pulsating(xi)
    amplitudes = [-2.0 * float(np.sum(weight * start * sine)) for sine in sines]
    made = HillEquation(
        F=reduced(bending + beam.T0 * end + thrust(steady(xi))),
        G=reduced(beam.T0 * end + thrust(pulsating(xi))),
        gamma=gamma,
        Omega=Omega,
        eta=checks.number("eta", eta),
        # sin(s pi) = 0: these forces do nothing at the end.
        H=[reduced(thrust(c * sine)) for c, sine in zip(amplitudes, sines, strict=True)],
        omega_L=beam.omega_L,
        data_error=matrix_error(
            wave,
            pulsating(xi),
            complete(xi) if complete else None,
            max(amplification(mass, B, mass_size, size) for B, size in loads) if step else 0.0,
        ),
    )
    if isinstance(beam, SteppedBeam) or not beam.quadrature_force:
        return made
    whole = made.general()
    sine = {1: -gamma * out_of_phase(beam, Omega)}
    return PeriodicEquation(
        K=Fourier(whole.K.mean, cos=whole.K.cos, sin=sine),
        C=whole.C,
        Omega=whole.Omega,
        data_error=whole.data_error,
    )


def out_of_phase(beam: UniformBeam, Omega: float) -> Array:
    """What stands beside -gamma sin(Omega tau) as G stands beside gamma cos(Omega tau).

    The force of a damped bar that the report leaves out: Im Phi* in place of Re Phi* (4.2.39).

    Returns
    -------
    (N + 1, N + 1) ndarray
    """
    wave = np.sqrt((Omega / beam.omega_L) ** 2 - 1j * beam.g)
    force = _uniform_wave(beam, wave, Omega)
    roots = eigenvalues(beam.modes)
    xi, weight, (w, slope, _) = sampled(beam.modes, np.pi * abs(wave), 0.0)
    mass = roots[0] ** 4 * _inner(w, w, weight)
    stiffness = -beam.T0 * _inner(slope, slope, weight * np.imag(force(xi)))
    matrix: Array = np.linalg.solve(mass, stiffness)[:-1, :-1]
    return matrix


def _refuse_terms(beam: UniformBeam | SteppedBeam, terms: int) -> None:
    if terms and isinstance(beam, SteppedBeam):
        raise ValueError(f"initial_terms = {terms}: must be 0 for a stepped beam, it has no period")
    if terms and np.isinf(beam.omega_L):
        raise ValueError(f"initial_terms = {terms}: needs a finite omega_L, which is infinite")
    if terms and isinstance(beam, UniformBeam) and beam.g > 0.0:
        raise ValueError(f"initial_terms = {terms}: must be 0 with damping, g = {beam.g:g}")


def _refuse_resonance(sine: float, sigma: float, Omega: float) -> None:
    # sigma >= 0.5: no bar, stepped or not, resonates below a quarter wave.
    if sigma >= 0.5 and abs(sine) <= RESONANCE_ULPS * np.pi * np.spacing(sigma):
        raise LongitudinalResonance(
            f"Omega = {Omega:g} is a longitudinal resonance (omega_L = {Omega / sigma:g}): "
            "the undamped axial force is infinite"
        )


def _uniform_force(beam: UniformBeam, wave: complex, Omega: float) -> Force:
    """Phi = Re Phi*."""
    force = _uniform_wave(beam, wave, Omega)
    return lambda xi: np.real(force(xi))


def _uniform_wave(beam: UniformBeam, wave: complex, Omega: float) -> Callable[[Array], Complex]:
    """Phi* = sin(z xi)/sin(z), z = pi (sigma**2 - i g)**(1/2); Phi* = xi for z = 0."""
    if wave == 0:
        return lambda xi: xi.astype(complex)
    if beam.g == 0.0:
        _refuse_resonance(float(np.sin(np.pi * wave.real)), wave.real, Omega)
    # Im z <= 0: exp(i z xi) grows, so it is written from the far end; expm1 keeps a small z exact.
    z = np.pi * wave
    far = np.expm1(-2j * z)
    return lambda xi: np.exp(1j * z * (xi - 1.0)) * np.expm1(-2j * z * xi) / far


def _stepped_force(beam: SteppedBeam, sigma: float, Omega: float) -> Force:
    """P_x with P_x(0) = 0, P_x(1) = 1; sigma = 0 gives P_0, the share of the mass ahead of xi."""
    c, r = beam.xi_c, beam.area_ratio

    def cosine(x: float | Array) -> Array:
        return np.cos(np.pi * sigma * np.asarray(x))

    def sine(x: float | Array) -> Array:
        """sin(nu x)/nu, which is x for nu = 0."""
        return x * np.sinc(sigma * np.asarray(x))

    # P = r a sine(xi), u = a cosine(xi) ahead of the step; behind it, with x = xi - c,
    # P = d sine(x) + b cosine(x), u = d cosine(x) - nu**2 b sine(x). Rows: u, P at c; P at 1.
    system = np.array(
        [[cosine(c), -1.0, 0.0], [r * sine(c), 0.0, -1.0], [0.0, sine(1.0 - c), cosine(1.0 - c)]]
    )
    static = r * c + 1.0 - c  # the determinant for nu = 0; sin(nu)/nu for r = 1
    _refuse_resonance(np.pi * sigma * float(np.linalg.det(system)) / static, sigma, Omega)
    a, d, b = np.linalg.solve(system, np.array([0.0, 0.0, 1.0]))
    return lambda xi: np.where(xi < c, r * a * sine(xi), d * sine(xi - c) + b * cosine(xi - c))


def _axial_end(w_end: Array, slope_end: Array) -> Array:
    """w(1) P(1) y'(1): the thrust follows the tangent at the end (P(0) = 0 at the other)."""
    return np.outer(w_end, slope_end)


def _inner(test: Array, trial: Array, weight: Array) -> Array:
    return (test * weight) @ trial.T
