"""How T and z move with the parameters of a system.

The chain rule: what T owes to the numbers of the equation (`floquet.sensitivity.equation`), times
what they owe to the parameter (`floquet.sensitivity.numbers`).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from floquet.arrays import EPS, Complex, Float
from floquet.sensitivity.equation import Derivatives, sensitivities
from floquet.sensitivity.numbers import FORCING, Moved, OutOfForm, moved_by
from floquet.witness import matrices_of
from hill import HillEquation, SteppedBeam, UniformBeam, parameter_values
from hill.precision import remark_of_slopes


@dataclass(frozen=True, eq=False)
class SystemSensitivities:
    """T, z and their derivatives by parameter, each with a bound on its absolute error.

    The bounds are for the equation's numbers as they are made; of a parameter that is not linear
    they stand on an estimate, of what a Chebyshev series leaves out, times 4.

    Attributes
    ----------
    values : dict of str to float
        The parameters: Omega, gamma, eta, then the system's own, as far as they are finite.
    T : float
    z : (n,) complex ndarray
        Empty with a damping matrix.
    dT, dT_error : dict of str to float
    dz : dict of str to (n,) complex ndarray
    dz_error : dict of str to (n,) float ndarray
    shared_matrices : bool
        Whether the matrices are the system's own, because the witness has none.
    remark : str
        Which derivatives of T are known to less than nine digits; empty where none is.
    left_out : tuple of str
        Parameters that are not differentiated: any other value of them, a control's rate for one,
        takes the equation out of Hill's form. See `general_sensitivities`.
    """

    values: dict[str, float]
    T: float
    z: Complex
    dT: dict[str, float]
    dT_error: dict[str, float]
    dz: dict[str, Complex]
    dz_error: dict[str, Float]
    shared_matrices: bool
    remark: str
    left_out: tuple[str, ...] = ()


BeamSensitivities = SystemSensitivities


def system_sensitivities(
    system: Any, *, Omega: float, gamma: float, eta: float = 0.0
) -> SystemSensitivities:
    """Differentiate T and z with respect to every parameter of a system and its forcing.

    Parameters
    ----------
    system : System
        A beam, whose matrices are the witness's own, or anybody's.
    Omega : float
        Forcing frequency, > 0. Where the matrices move with it, that is in the derivative; with H
        omega_L keeps its ratio to it.
    gamma : float
        Depth of the pulsation; the report's thrust ratio T1/T0.
    eta : float, optional
        Damping.

    Returns
    -------
    SystemSensitivities

    Raises
    ------
    ValueError
        As for `sensitivities`: T or z has no derivative there. A parameter too close to where a
        coefficient is singular; what is out of range.
    """
    make, shared = matrices_of(system)
    forcing = {"Omega": Omega, "gamma": gamma, "eta": eta}
    model = make(system, **forcing)
    if not isinstance(model, HillEquation):
        raise ValueError(
            f"{type(system).__name__}: must have a HillEquation, has a {type(model).__name__}"
        )
    s = sensitivities(model)
    own = {name: x for name, x in parameter_values(system).items() if isfinite(x)}
    values = {name: float(x) for name, x in forcing.items()} | own
    T, z, left_out = {}, {}, []
    for name, value in values.items():
        try:
            moved = moved_by(system, name, **forcing, value=value)
        except OutOfForm:
            left_out.append(name)
            continue
        T[name] = _chain(name, s.dT, s.dT_error, moved)
        z[name] = _chain(name, s.dz, s.dz_error, moved)
    known = {name: (*found, values[name]) for name, found in T.items()}
    return SystemSensitivities(
        values={name: values[name] for name in T},
        T=s.T,
        z=s.z,
        dT={name: float(found) for name, (found, _) in T.items()},
        dT_error={name: float(error) for name, (_, error) in T.items()},
        dz={name: found for name, (found, _) in z.items()},
        dz_error={name: error for name, (_, error) in z.items()},
        shared_matrices=shared,
        remark=remark_of_slopes(known),
        left_out=tuple(left_out),
    )


def beam_sensitivities(
    beam: UniformBeam | SteppedBeam, Omega: float, gamma: float, eta: float = 0.0
) -> SystemSensitivities:
    """`system_sensitivities` of one of the report's beams, T1/T0 = gamma, all over ``omega_1``."""
    return system_sensitivities(beam, Omega=Omega, gamma=gamma, eta=eta)


def _chain(name: str, slope: Derivatives, error: Derivatives, moved: Moved) -> tuple[Any, Any]:
    """Derivative through the equation's numbers, and straight where the forcing is one of them."""
    of, doubt = vars(slope), vars(error)
    total, bound = (_straight(by, name) for by in (of, doubt))
    for key, change in moved.slope.items():
        axes = tuple(range(-np.ndim(change), 0))
        unsure = moved.error[key]
        terms = of[key] * change
        total = total + np.sum(terms, axis=axes)
        bound = bound + 4.0 * EPS * np.sum(np.abs(terms), axis=axes)
        bound = bound + np.sum(doubt[key] * (np.abs(change) + unsure), axis=axes)
        bound = bound + np.sum(np.abs(of[key]) * unsure, axis=axes)
    return total, bound


def _straight(by: Mapping[str, Any], name: str) -> Any:
    """What is owed to the forcing's own number; to eta along the whole diagonal of a matrix."""
    if name not in FORCING:
        return 0.0
    found = by[name]
    whole = name == "eta" and np.ndim(found) >= 2 and np.shape(found)[-1] == np.shape(found)[-2]
    return np.trace(found, axis1=-2, axis2=-1) if whole else found
