"""How T and z move with the parameters of the report's beams.

The chain rule: what T owes to the elements of F and G, times what they owe to the parameter. The
matrices are linear in T0, K_theta and the inertia ratio and analytic in the others.
"""

from dataclasses import dataclass, fields, replace
from math import inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.sensitivity.derivative import differentiate
from floquet.sensitivity.equation import Derivatives, sensitivities
from floquet.weak_form import galerkin
from hill import SteppedBeam, UniformBeam

Complex = NDArray[np.complexfloating[Any, Any]]
Float = NDArray[np.floating[Any]]
Beam = UniformBeam | SteppedBeam
EPS = float(np.finfo(float).eps)

FAR = 2.0**30
LINEAR = {"T0": (-FAR, FAR), "K_theta": (-FAR, FAR), "inertia_ratio": (1.0 / FAR, FAR)}
"""Two values of what F and G are linear in, so far apart that no digit cancels."""

BOUNDS = {"xi_G": (0.0, 1.0), "xi_c": (0.0, 1.0), "g": (-1e4, 1e4)}
"""Ranges of the others; positive where nothing is said. G is even in g, Re f(sigma^2 - i g)."""

UNMOVED = {"omega_L": 0, "g": 0, "inertia_ratio": 1}
"""Which of (F, G) does not know the parameter."""


@dataclass(frozen=True, eq=False)
class BeamSensitivities:
    """T, z and their derivatives by parameter, each with a bound on its absolute error.

    Attributes
    ----------
    values : dict of str to float
        The parameters: Omega, gamma, eta, then the beam's own; omega_L only where it is finite.
    T : float
    z : (N + 1,) complex ndarray
    dT, dT_error : dict of str to float
    dz : dict of str to (N + 1,) complex ndarray
    dz_error : dict of str to (N + 1,) float ndarray
    """

    values: dict[str, float]
    T: float
    z: Complex
    dT: dict[str, float]
    dT_error: dict[str, float]
    dz: dict[str, Complex]
    dz_error: dict[str, Float]


# What a beam has beside numbers that may be varied.
FIXED = ("modes", "quadrature_force")


def beam_sensitivities(
    beam: Beam, Omega: float, gamma: float, eta: float = 0.0
) -> BeamSensitivities:
    """Differentiate T and z with respect to every continuous parameter of a beam.

    Parameters
    ----------
    beam : UniformBeam or SteppedBeam
    Omega : float
        Forcing frequency over ``omega_1``, > 0. With a finite ``omega_L`` the axial force, and
        with it G, depends on it too: that is in the derivative.
    gamma : float
        Thrust ratio T1/T0.
    eta : float, optional
        Transverse damping over ``omega_1``.

    Returns
    -------
    BeamSensitivities

    Raises
    ------
    ValueError
        As for `floquet.weak_form.galerkin` and `sensitivities`.
    """
    if isinstance(beam, UniformBeam) and beam.quadrature_force:
        raise ValueError("quadrature_force = True: must be False, sensitivities are of T in z")
    model = galerkin(beam, Omega, gamma, eta)
    s = sensitivities(model)
    own = {f.name: float(vars(beam)[f.name]) for f in fields(beam) if f.name not in FIXED}
    own = {name: value for name, value in own.items() if isfinite(value)}
    moved = {name: matrix_derivatives(beam, Omega, name) for name in own}
    none = np.zeros((2, *model.F.shape)), np.zeros(2)
    moved |= {"Omega": none, "gamma": none, "eta": none}
    if "omega_L" in own:
        # only their ratio enters
        by_Omega = -beam.omega_L / model.Omega
        moved["Omega"] = by_Omega * moved["omega_L"][0], abs(by_Omega) * moved["omega_L"][1]

    values = {"Omega": model.Omega, "gamma": model.gamma, "eta": model.damping} | own
    T = {name: _chain(name, s.dT, s.dT_error, *moved[name]) for name in values}
    z = {name: _chain(name, s.dz, s.dz_error, *moved[name]) for name in values}
    return BeamSensitivities(
        values=values,
        T=s.T,
        z=s.z,
        dT={name: float(found) for name, (found, _) in T.items()},
        dT_error={name: float(error) for name, (_, error) in T.items()},
        dz={name: found for name, (found, _) in z.items()},
        dz_error={name: error for name, (_, error) in z.items()},
    )


def matrix_derivatives(beam: Beam, Omega: float, name: str) -> tuple[Float, Float]:
    """Derivatives of F and G with respect to a parameter of the beam, at a fixed Omega.

    Parameters
    ----------
    beam : UniformBeam or SteppedBeam
    Omega : float
        Forcing frequency; G depends on it where ``omega_L`` is finite.
    name : str
        A field of the beam but ``modes``.

    Returns
    -------
    (2, N + 1, N + 1) ndarray
        dF and dG.
    (2,) ndarray
        Bounds on the absolute error of the elements of each.
    """

    def matrices(value: float) -> Float:
        value = abs(value) if name == "g" else value
        there = galerkin(replace(beam, **{name: value}), Omega, 0.0)  # type: ignore[arg-type]
        return np.array([there.F, there.G])

    if name in LINEAR:
        low, high = LINEAR[name]
        found: Float = (matrices(high) - matrices(low)) / (high - low)
        error: Float = 32.0 * EPS * np.abs(found).max(axis=(1, 2))
    else:
        value = float(vars(beam)[name])
        low, high = BOUNDS.get(name, (0.0, inf))
        width = 0.5 if name in BOUNDS else 0.5 * value
        try:
            found, error = differentiate(matrices, value, low, high, width)
        except ValueError:
            raise ValueError(
                f"{name} = {value:g}: is too close to where F or G is singular to differentiate"
            ) from None
    if name in UNMOVED:
        found[UNMOVED[name]] = error[UNMOVED[name]] = 0.0
    return found, error


def _chain(
    name: str, slope: Derivatives, error: Derivatives, moved: Float, unsure: Float
) -> tuple[Any, Any]:
    """Derivative through F and G, and straight where the equation has the parameter itself."""
    total: Any = vars(slope).get(name, 0.0)
    bound: Any = vars(error).get(name, 0.0)
    for k, key in enumerate(("F", "G")):
        terms, doubt = vars(slope)[key] * moved[k], vars(error)[key]
        total = total + terms.sum(axis=(-2, -1))
        bound = bound + 4.0 * EPS * np.abs(terms).sum(axis=(-2, -1))
        bound = bound + (doubt * (np.abs(moved[k]) + unsure[k])).sum(axis=(-2, -1))
        bound = bound + (np.abs(vars(slope)[key]) * unsure[k]).sum(axis=(-2, -1))
    return total, bound
