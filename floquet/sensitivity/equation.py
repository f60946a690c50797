"""How T and z move with everything in the matrix Hill equation.

z are the eigenvalues of a block A of the monodromy matrix, so ``dz = l dA r`` with the left and
right eigenvectors, ``l r = 1``; T follows from them by (7.1.1). Where a derivative does not exist
it is refused: at a double root, at the edges z = 1 and z = -1, and where two roots tie for the
largest growth.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.accuracy import BASE_ULPS
from floquet.arrays import EPS, Complex, Float
from floquet.eigenvalues import discs_from_polynomial, sorted_eigenvalues
from floquet.growth import ln_mu
from floquet.integrate.ode import parameter_values, shape, terms
from floquet.integrate.step_length import fastest_rate
from floquet.integrate.taylor import Taylor
from floquet.period import monodromy
from floquet.sensitivity import matrices
from floquet.sensitivity.eigenvalues import (
    APART,
    EigenvalueGradients,
    Roots,
    eigenvalue_gradients,
    leader,
)
from hill import HillEquation
from hill.precision import remark_of_slopes

# The run and the one it is checked by, as in `floquet.monodromy`: other steps.
RUN, CHECK = Taylor(), Taylor(order=29)


@dataclass(frozen=True, eq=False)
class Derivatives:
    """Derivatives of one number, or of several: then every array has one more axis in front.

    Attributes
    ----------
    Omega : float or ndarray
        With H, omega_L keeps its ratio to Omega: without a common period there is neither z nor T.
    gamma : float or ndarray
    eta : float or ndarray
        (n, n) for a damping matrix.
    F, G : (n, n) ndarray
        One for each element.
    H : (terms, n, n) ndarray
    """

    Omega: Any
    gamma: Any
    eta: Any
    F: NDArray[Any]
    G: NDArray[Any]
    H: NDArray[Any]


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """T, z and their derivatives, each with a bound on its absolute error.

    Attributes
    ----------
    T : float
        Characteristic argument (7.1.1), over ``omega_1``.
    z : (n,) complex ndarray
        cos 2 pi alpha as in `Monodromy`; empty with a damping matrix.
    dT, dT_error : Derivatives
        Of T, real; and bounds.
    dz, dz_error : Derivatives
        Of each z, complex, z along the first axis; and bounds on the moduli of the errors.
    remark : str
        Which derivatives of T are known to less than nine digits; empty where none is.
    """

    T: float
    z: Complex
    dT: Derivatives
    dT_error: Derivatives
    dz: Derivatives
    dz_error: Derivatives
    remark: str


def sensitivities(equation: HillEquation) -> Sensitivities:
    """Differentiate T and z with respect to every number in the matrix Hill equation (6.1.1).

    Each gradient is computed twice, as the monodromy matrix is: over half a period in
    ``u = exp(eta tau/2) q`` and over the whole period in q with other steps. The errors come from
    the difference and from what rounding may do to the eigenvectors.

    Parameters
    ----------
    equation : HillEquation
        `eta` may be a matrix: then T comes from the multipliers, and there is no z. For a
        `PeriodicEquation` see `general_sensitivities`.

    Returns
    -------
    Sensitivities
        Where every multiplier of u is on the unit circle T stays -eta, so that only eta moves it:
        the other derivatives, and their errors, are exactly zero.

    Raises
    ------
    ValueError
        A derivative does not exist, as far as the error of P tells: two z meet, the root of the
        largest growth is at z = 1 or z = -1, or two different roots tie for it.
    OverflowError
        As for `monodromy`.
    """
    m = monodromy(equation)
    matrix = np.ndim(equation.eta) > 0
    if matrix:
        run, check = matrices.multipliers(equation, RUN), matrices.multipliers(equation, CHECK)
    else:
        first = matrices.half_period if m.half_period else matrices.whole_period
        run, check = first(equation, RUN), matrices.damped_whole_period(equation, CHECK)
    p, period = parameter_values(equation), 2.0 * np.pi / equation.Omega
    centre = sorted_eigenvalues(run.matrix)
    radius = discs_from_polynomial(centre, m.polynomial, m.errors).radius
    roots = Roots("multiplier" if matrix else "z", centre, radius)
    growth = _growth(roots, _of_multiplier if matrix else _of_z)
    lead = _lead(roots, growth)
    wanted = [lead] if matrix and lead is not None else list(range(len(roots.values)))
    ulps = BASE_ULPS + fastest_rate(terms(p, shape(equation)), p.C) * period
    found = eigenvalue_gradients(run, check, roots, wanted, ulps)
    slope, error = _of_T(equation, growth, lead, found, wanted)
    if matrix:
        found = EigenvalueGradients(found.slope[:0], found.error[:0])
    dT, dT_error = _shaped(equation, slope), _shaped(equation, error)
    known = {
        name: (vars(dT)[name], vars(dT_error)[name], vars(equation)[name])
        for name in ("Omega", "gamma", "eta", "F", "G", "H")
    }
    return Sensitivities(
        T=m.T,
        z=m.z,
        dT=dT,
        dT_error=dT_error,
        dz=_shaped(equation, found.slope),
        dz_error=_shaped(equation, found.error),
        remark=remark_of_slopes(known),
    )


@dataclass(frozen=True, eq=False)
class _Growth:
    """ln |mu| of each root, between which bounds it is, its derivative and that one's error."""

    value: Float
    least: Float
    most: Float
    slope: Complex
    slope_error: Float


def _growth(roots: Roots, logarithm: Callable[[Complex, Float], _Growth]) -> _Growth:
    # an edge itself is singular, and refused
    with np.errstate(divide="ignore", invalid="ignore"):
        found = logarithm(roots.values, roots.radius)
    return replace(found, slope_error=found.slope_error + 8.0 * EPS * np.abs(found.slope))


def _of_z(z: Complex, radius: Float) -> _Growth:
    """Logarithm ln |mu|, and d ln mu/dz, for mu = z +- (z^2 - 1)^(1/2), the larger."""
    root = np.sqrt(z - 1.0) * np.sqrt(z + 1.0)
    root = np.where(np.abs(z + root) >= np.abs(z - root), root, -root)
    x, y = np.abs(z.real), np.abs(z.imag)
    # the slope's own is z (z^2 - 1)^(-3/2)
    nearest = [np.maximum(np.abs(z - edge) - radius, 0.0) for edge in (1.0, -1.0)]
    steepest = np.abs(z) + radius
    for distance in nearest:  # one after the other: z may be as large as floats are
        steepest = steepest / distance / np.sqrt(distance)
    return _Growth(
        value=ln_mu(x, y),
        least=ln_mu(np.maximum(x - radius, 0.0), np.maximum(y - radius, 0.0)),
        most=ln_mu(x + radius, y + radius),
        slope=1.0 / root,
        slope_error=radius * steepest,
    )


def _of_multiplier(mu: Complex, radius: Float) -> _Growth:
    size = np.abs(mu)
    least = np.maximum(size - radius, 0.0)
    return _Growth(
        np.log(size), np.log(least), np.log(size + radius), 1.0 / mu, radius / size / least
    )


def _lead(roots: Roots, growth: _Growth) -> int | None:
    """The root that T comes from; None where all of them stay on the unit circle."""
    if roots.name == "z":
        z = roots.values
        edge = np.minimum(np.abs(z - 1.0), np.abs(z + 1.0)) <= APART * roots.radius
        edge &= growth.most >= growth.least.max()
        if np.any(edge):
            raise ValueError(
                f"{roots.text(int(np.argmax(edge)))} is at the edge of instability as far as the "
                "error of P tells: T has no derivative there"
            )
        if np.all((z.imag == 0.0) & (np.abs(z) < 1.0)):
            return None
    return leader(roots, growth.least, growth.most)


def _of_T(
    equation: HillEquation,
    growth: _Growth,
    lead: int | None,
    found: EigenvalueGradients,
    wanted: list[int],
) -> tuple[Float, Float]:
    """Flat gradient of T = (Omega/pi) ln R - eta, and bounds on its error."""
    dT, error = np.zeros(found.slope.shape[1]), np.zeros(found.slope.shape[1])
    if lead is not None:
        row = wanted.index(lead)
        slope, off, dz = growth.slope[lead], growth.slope_error[lead], found.slope[row]
        dT += np.real(slope * dz)
        error += (np.abs(slope) + off) * found.error[row] + off * np.abs(dz)
        # the factor Omega/pi of (7.1.1)
        dT[0] += growth.value[lead] / equation.Omega
        error[0] += (growth.most - growth.least)[lead] / equation.Omega
        dT *= equation.Omega / np.pi
        error = error * equation.Omega / np.pi + 4.0 * EPS * np.abs(dT)
    if np.ndim(equation.eta) == 0:
        dT[2] -= 1.0
        error[2] += EPS * (lead is not None)
    return dT, error


def _shaped(equation: HillEquation, flat: NDArray[Any]) -> Derivatives:
    """From flat rows, in the order of `matrices.gradient`, to arrays shaped like the parameters."""
    shapes: list[tuple[int, ...]] = [(), (), np.shape(equation.eta)]
    shapes += [equation.F.shape, equation.G.shape, (len(equation.H), *equation.F.shape)]
    ends = np.cumsum([int(np.prod(one)) for one in shapes])
    parts = np.split(flat, ends[:-1], axis=-1)
    shaped = [x.reshape((*flat.shape[:-1], *one)) for x, one in zip(parts, shapes, strict=True)]
    numbers = [x.item() if x.ndim == 0 else x for x in shaped[:3]]
    return Derivatives(*numbers, *shaped[3:])
