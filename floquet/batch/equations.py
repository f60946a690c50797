"""P(z) of many equations at once, without Python in the inner loop.

The points run through half a period side by side (`numpy_kernel`), by numpy or, where there is a
C compiler and enough of them, by a compiled kernel (`c_kernel`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from floquet.accuracy import moved_by_data
from floquet.arrays import EPS, Bool, Float
from floquet.batch import c_kernel
from floquet.batch.balance import balanced
from floquet.batch.general import general_polynomials
from floquet.batch.numpy_kernel import Found, March, Points, by_numpy
from floquet.batch.whole_period import by_whole_period
from floquet.many import MAX_FEW
from floquet.period import MAX_TERM_GROWTH, monodromy
from hill import HillEquation, PeriodicEquation
from hill.precision import poor_P

Kernel = Literal["auto", "compiled", "numpy"]
KERNELS = ("auto", "compiled", "numpy")

# Where "auto" compiles: building takes as long as numpy needs for about this many points. It does
# not look whether the build is there already: the same call is to give the same digits.
WORTH_COMPILING = 5000

# Equations that share their matrices by fewer than this, on average, go together unshared: to start
# a group takes numpy as long as 50 more points, an unshared point a third longer than a shared one.
MIN_GROUP = 32

# Rounding: ulps of the terms summed, times the square root of the radians of the fastest motion, as
# errors add up that do not know of each other, times what the terms have grown to: its root over
# SWELL, and all of it over GROWN beyond the 2 that an oscillation has by itself; ulps of what the
# data's rounding moves; ulps of P. Measured (`benchmarks.honesty`, 7,038 systems of fourteen
# classes): the true error was .24 of the bound at most, .01 in the median; with 8, 12 and 16
# coordinates .06 of it at most. With the root alone one of 9,852 systems was off by 1.6 bounds, and
# 600 next to it, which grow 18 times, by 4.2 at most, .8 now. In proportion to the radians, and
# with sums for roots of sums of squares, the bound was 14 times as wide for the same worst case.
ULPS, SWELL, GROWN, DATA_ULPS, P_ULPS = 8.0, 4.0, 1.2, 3.0, 4.0

# Relative bound above which `monodromy` is asked, whose two runs know better: thirty times the
# largest on the report's chart.
REFINE_ABOVE = 1e-10

# So many of them go through the whole period side by side: of three coordinates 2 take 1.2 times as
# long as one after the other, 4 .95 times, 8 .6 and 32 .3 times.
MIN_WHOLE = 4


@dataclass(frozen=True, eq=False)
class Polynomials:
    """P(z) of several equations.

    Attributes
    ----------
    coefficients : (k, n + 1) float ndarray
        Monic, highest power first.
    errors : (k,) float ndarray
        Bound on the absolute error of every coefficient, for the matrices as given (their own
        `data_error` is left out): truncation is below an ulp, rounding is bounded by a model that
        the tests hold against the arbiter.
    """

    coefficients: Float
    errors: Float

    @property
    def poor(self) -> Bool:
        """Whose coefficients are known to less than nine digits, (k,): `hill.precision`."""
        return poor_P(self.coefficients, self.errors)


@dataclass(frozen=True, eq=False)
class _Forcing:
    """Omega, gamma and eta of several points, each (k,)."""

    Omega: Float
    gamma: Float
    eta: Float

    def __getitem__(self, index: Any) -> "_Forcing":
        return _Forcing(self.Omega[index], self.gamma[index], self.eta[index])


def polynomials(
    equations: Sequence[HillEquation | PeriodicEquation], *, kernel: Kernel = "auto"
) -> Polynomials:
    """P(z) of many equations of one size, over half a period each; or of their multipliers.

    Quickest where many equations share F, G and H and differ in `Omega`, `gamma` and `eta`;
    `sweep` takes those as arrays.

    Parameters
    ----------
    equations : sequence of HillEquation or PeriodicEquation
        All with the same number of coordinates; `eta` one number. Where one is a
        `PeriodicEquation`, all are taken as such: the polynomials are those of the multipliers,
        (k, m + 1), over the whole period, by numpy.
    kernel : {"auto", "compiled", "numpy"}, optional
        "auto" builds the C kernel where there is work for it, `WORTH_COMPILING`, and a compiler.

    Raises
    ------
    ValueError
        Equations of different sizes; `eta` a matrix; no compiler for "compiled".
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    if not equations:
        return Polynomials(np.empty((0, 0)), np.empty(0))
    if any(isinstance(equation, PeriodicEquation) for equation in equations):
        if kernel not in ("auto", "numpy"):
            raise ValueError(f"kernel = {kernel!r}: must be auto or numpy for general equations")
        general = [e.general() if isinstance(e, HillEquation) else e for e in equations]
        return Polynomials(*general_polynomials(general))
    return _special([e for e in equations if isinstance(e, HillEquation)], kernel)


def _special(equations: Sequence[HillEquation], kernel: Kernel) -> Polynomials:
    n = equations[0].n
    if any(equation.n != n for equation in equations):
        raise ValueError("equations: must all have the same number of coordinates")
    groups = _alike(equations)
    if (
        kernel != "compiled"
        and not any(e.H for e in equations)
        and MIN_GROUP * len(groups) > len(equations)
    ):
        return Polynomials(*_unlike(equations))
    coefficients, errors = np.empty((len(equations), n + 1)), np.empty(len(equations))
    for members in groups:
        own = [equations[i] for i in members]
        march = _march(kernel, len(equations), own[0])
        coefficients[members], errors[members] = _many(own[0], _forcing(own), march)
    return Polynomials(coefficients, errors)


def sweep(
    equation: HillEquation,
    *,
    Omega: ArrayLike,
    gamma: ArrayLike,
    eta: ArrayLike = 0.0,
    kernel: Kernel = "auto",
) -> Polynomials:
    """P(z) of one beam, F and G, under many forcings.

    Parameters
    ----------
    equation : HillEquation
        F and G; its own `Omega`, `gamma` and `eta` are not used.
    Omega, gamma, eta : array_like
        Broadcast against each other to k points.
    kernel : {"auto", "compiled", "numpy"}, optional
        As for `polynomials`.

    Raises
    ------
    ValueError
        `equation` has terms H, whose frequency cannot stay while Omega varies; a value that is not
        finite, or an Omega not above 0.
    OverflowError
        The growth over one period exceeds what a float can hold.
    """
    if equation.H:
        raise ValueError("H: must be absent, its period would not stay a multiple of 2 pi/Omega")
    numbers = np.broadcast_arrays(*(np.asarray(v, float) for v in (Omega, gamma, eta)))
    forcing = _Forcing(*(values.ravel() for values in numbers))
    if not (np.isfinite(numbers).all() and forcing.Omega.min(initial=1.0) > 0.0):
        _refuse(forcing)
    march = _march(kernel, len(forcing.Omega), equation)
    return Polynomials(*_many(equation, forcing, march))


def _refuse(forcing: _Forcing) -> None:
    """Name the value that will not do."""
    for name, values in vars(forcing).items():
        bad = ~np.isfinite(values) | ((values <= 0.0) & (name == "Omega"))
        if np.any(bad):
            rule = "finite and greater than 0" if name == "Omega" else "finite"
            raise ValueError(f"{name} = {values[bad][0]}: must be {rule}")


def _march(kernel: str, work: int, equation: HillEquation) -> March:
    if kernel not in KERNELS:
        raise ValueError(f"kernel = {kernel!r}: must be one of {', '.join(KERNELS)}")
    if kernel == "numpy" or (kernel == "auto" and work < WORTH_COMPILING):
        return by_numpy
    found = c_kernel.march(equation.n, 1 + len(equation.H))
    if found is None and kernel == "compiled":
        raise ValueError('kernel = "compiled": found no working C compiler; use "auto" or "numpy"')
    return found or by_numpy


def _forcing(equations: Sequence[HillEquation]) -> _Forcing:
    numbers = ((e.Omega, e.gamma, e.damping) for e in equations)
    return _Forcing(*(np.array(v) for v in zip(*numbers, strict=True)))


def _alike(equations: Sequence[HillEquation]) -> list[list[int]]:
    """Indices of equations with the same matrices and the same harmonics."""
    groups: dict[Any, list[int]] = {}
    for i, e in enumerate(equations):
        harmonics = tuple(matrix.tobytes() for matrix in e.H), e.ratio if e.H else 0
        groups.setdefault((e.F.tobytes(), e.G.tobytes(), harmonics), []).append(i)
    return list(groups.values())


def _many(e: HillEquation, forcing: _Forcing, march: March) -> tuple[Float, Float]:
    """P and its error of one beam under each forcing."""
    ratio = e.ratio if e.H else 0
    phases = (1, *(s * ratio for s in range(1, len(e.H) + 1)))
    matrices = np.array([e.F, e.G, *e.H])
    return _solve(matrices, forcing, phases, march, lambda i: _under(e, forcing[i]))


def _unlike(equations: Sequence[HillEquation]) -> tuple[Float, Float]:
    """P and its error of equations each with F and G of its own."""
    matrices = np.array([[e.F for e in equations], [e.G for e in equations]])
    return _solve(matrices, _forcing(equations), (1,), by_numpy, lambda i: equations[i])


def _solve(
    matrices: Float,
    forcing: _Forcing,
    phases: tuple[int, ...],
    march: March,
    equation: Callable[[int], HillEquation],
) -> tuple[Float, Float]:
    """P and its error; neighbours in Omega go together, they need like steps."""
    ordered = np.argsort(forcing.Omega, kind="stable")
    Omega, gamma, eta = (v[ordered] for v in (forcing.Omega, forcing.gamma, forcing.eta))
    x = 1.0 / Omega**2
    own = matrices if matrices.ndim == 3 else matrices[:, ordered]
    weights = np.array([x, gamma * x] + [x] * (len(phases) - 1))
    points = Points(
        matrices=balanced(own, weights),
        weights=weights,
        shift=0.25 * eta**2 * x,
        phases=phases,
    )
    found = march(points)
    P, errors = np.empty_like(found.P), np.empty(len(x))
    size = np.sum(np.abs(found.P), axis=1)
    data, _ = moved_by_data(points.matrices[0], x, points.shift)
    P[ordered] = found.P
    errors[ordered] = EPS * _ulps(found, data, size)
    # as in `monodromy`: much growth makes the half period's inverse a poor one
    poor = ~((found.growth < MAX_TERM_GROWTH) & (errors[ordered] <= REFINE_ABOVE * size))
    asked = np.flatnonzero(poor)
    if len(asked) >= MIN_WHOLE and len(phases) == 1 and P.shape[1] - 1 <= MAX_FEW:
        there = ordered[asked]
        P[there], errors[there] = by_whole_period(
            points.own(asked), lambda k: equation(int(there[k]))
        )
        return P, errors
    for i in map(int, ordered[asked]):
        P[i], errors[i] = _bound(equation(i))
    return P, errors


def _ulps(found: Found, data: Float, size: Float) -> Float:
    """Ulps that the coefficients of each point are known to; not finite where it does not end."""
    radians = 2.0 + 2.0 * np.pi * found.rate
    with np.errstate(over="ignore", invalid="ignore"):
        grown = np.maximum(found.growth - 2.0, 0.0) / GROWN
        summed = np.sqrt(radians * (1.0 + found.growth / SWELL + grown**2)) * found.sensitivity
        return ULPS * summed + (DATA_ULPS * data + P_ULPS) * size


def _under(e: HillEquation, forcing: _Forcing) -> HillEquation:
    Omega, gamma, eta = float(forcing.Omega), float(forcing.gamma), float(forcing.eta)
    omega_L = e.ratio * Omega if e.H else e.omega_L
    return HillEquation(F=e.F, G=e.G, gamma=gamma, Omega=Omega, eta=eta, H=e.H, omega_L=omega_L)


def _bound(equation: HillEquation) -> tuple[Float, float]:
    m = monodromy(equation)
    return m.polynomial, m.error
