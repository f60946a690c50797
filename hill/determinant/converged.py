"""Liouville's characteristic equation P(z) = 0, converged or from a finite determinant.

By Liouville's theorem (6.3.1, 6.3.2) P(z) = Delta(alpha) prod_j (z - zeta_j) is a monic polynomial
of degree n in z = cos 2 pi alpha. The report finds its coefficients from the residues K_j of Delta.
A polynomial is just as well determined by its values, and those have no poles to meet: here it is
sampled on the circle |z| = 1, which takes every case the report excludes (sqrt(Fbar_jj) a whole or
half number, poles that coincide, negative Fbar_jj) as it takes the others. With more samples than
coefficients the theorem also checks itself: the samples must turn out to have leading coefficient 1
and no higher ones, and by how much they fail is a measured rounding error.
"""

from typing import Literal

import numpy as np

from hill import checks
from hill.arrays import EPS, Complex, Float
from hill.determinant import finite, residues
from hill.determinant.finite import Blocks
from hill.determinant.general_values import determinant
from hill.determinant.in_z import PolynomialInZ, polynomial_in_z
from hill.determinant.result import Characteristic, of_multipliers, of_z
from hill.determinant.rounding import coefficient_shifts
from hill.equation import HillEquation
from hill.periodic import PeriodicEquation

# Finite sizes M, 1.25 M, 1.5 M; the remainder is a series in 1/M that starts at the fifth power.
LEVELS = (1.0, 1.25, 1.5)
POWERS = (5, 6)
# Over 2,772 random systems, held against 600-bit arithmetic, the true error was 2.3 times the
# measured defect at most; tests/test_honesty.py fails if the product is ever too small.
SAFETY = 4.0

# From so many coordinates on the general determinant is the quicker one, and the roots are better
# known than P; unless harmonics reach so far that a group has more rows than this.
MANY, WIDE = 8, 240

# Eigenvectors of unit length with an inverse this large: P is then known by what the determinant's
# own values are, not by what Liouville's theorem measures, which does not see what is common to all
# of them. Of 39,300 systems (`benchmarks.honesty`) one was off by 1.5 bounds, with 6e12.
CONDITION = 1e6


def characteristic(
    equation: HillEquation | PeriodicEquation,
    *,
    truncation: Literal["converged", "report"] | int = "converged",
) -> Characteristic:
    """Solve a periodic equation, the matrix Hill equation (6.1.1) or any other, by its determinant.

    Parameters
    ----------
    equation : HillEquation or PeriodicEquation
        With a damping matrix a `HillEquation` is taken in general form.
    truncation : "converged", "report" or int, optional
        "converged" sums and extrapolates the determinant's tail. "report" keeps
        ``(sqrt|F_NN| + sqrt|F_jj|)/Omega + 1`` harmonics, at most 14, and takes residues as
        the report does (6.3.5); a whole number M >= 1 keeps M. `error` bounds the distance from the
        true coefficients in every case. Where a finite determinant's residues do not exist
        (two poles meet), it is sampled instead.

    Returns
    -------
    Characteristic

    Raises
    ------
    ValueError
        `truncation` unknown, or anything but "converged" for an equation that has no z; an `Omega`
        too small for the determinant.
    OverflowError
        The growth over one period exceeds what a float can hold.

    References
    ----------
    Sections 6.2 and 6.3 of the report; Whittaker and Watson, A Course of Modern Analysis, 19.42.
    """
    if isinstance(equation, PeriodicEquation) or np.ndim(equation.eta) > 0:
        if truncation != "converged":
            raise ValueError(
                f'truncation = {truncation!r}: must be "converged" for an equation without z'
            )
        return of_multipliers(equation)
    system = finite.blocks(equation)
    many = system.n >= MANY or _far_from_normal(system.Fbar)
    d = determinant(equation) if many and system.n * system.reach <= WIDE else None
    # what overflows is refused below, once, by what comes out
    with np.errstate(all="ignore"):
        found = polynomial_in_z(d) if d else None
        converged, error, data_error, levels = found or _extrapolated(system, equation)
    if not (np.all(np.isfinite(converged)) and np.isfinite(error)):
        raise OverflowError(finite.OVERFLOW)
    if truncation == "converged":
        # of an F far from normal with few rows the roots are known by P alone
        at_roots = d if system.n >= MANY else None
        return of_z(equation, converged, error, data_error, levels, "converged", at_roots)
    if truncation == "report":
        kept = residues.report_rule(equation)
    elif isinstance(truncation, str):
        raise ValueError(f'truncation = {truncation!r}: must be "converged", "report" or M >= 1')
    else:
        kept = (checks.count("truncation", truncation, least=1),) * system.n
    polynomial = residues.polynomial(system, kept)
    form: Literal["residues", "samples"] = "residues"
    if polynomial is None:
        polynomial, form = _sampled(system, max(kept)), "samples"
    error += float(np.max(np.abs(polynomial - converged)))
    return of_z(equation, polynomial, error, data_error, kept, form)


def _far_from_normal(F: Float) -> bool:
    """Whether rounding moves F's eigenvalues by more than `CONDITION` times itself."""
    right = np.linalg.eig(F)[1]
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:
        return True
    with np.errstate(over="ignore"):
        return bool(np.max(np.linalg.norm(left, axis=1)) > CONDITION)


def _extrapolated(system: Blocks, e: HillEquation) -> PolynomialInZ:
    """P, its error, what the data's errors add, and the truncations used."""
    try:
        converged, error, levels = _converged(system)
        rounded, data_error = _moved(system, e, converged)
    except ValueError as refused:
        raise ValueError(f"Omega = {e.Omega:g}: {refused}") from None
    return converged, error + rounded, data_error, levels


def _moved(system: Blocks, e: HillEquation, polynomial: Float) -> tuple[float, float]:
    """What rounding moves a coefficient by, and what the errors of the matrices do."""
    count = system.n // 2 + 2
    x = 1.0 / e.Omega**2
    F = x * (np.abs(e.F) + 0.25 * e.damping**2 * np.eye(system.n))
    every = e.data_error * np.ones_like(F)
    size = Blocks(F, {p: np.abs(B) for p, B in system.B.items()})
    given = Blocks(
        x * np.max(np.abs(e.F)) * every,
        {p: np.max(np.abs(B)) * every for p, B in system.B.items()},
    )
    for turn in (0.5, 0.45):
        # off the real axis, where elimination without pivots is safe but for a root on a point
        z = np.exp(1j * np.pi * (np.arange(count) + turn) / count)
        alpha = np.arccos(z) / (2.0 * np.pi)
        try:
            return coefficient_shifts(system, size, given, alpha, np.polyval(polynomial, z))
        except np.linalg.LinAlgError:
            continue
    return float("inf"), float("inf")


def _circle(n: int) -> tuple[Complex, Complex]:
    """Points z on the upper half of |z| = 1, and alpha = arccos(z)/2 pi."""
    z = np.exp(1j * np.pi * np.arange(n + 2) / (n + 1))
    return z, np.arccos(z) / (2.0 * np.pi)


def _coefficients(values: Complex) -> Float:
    """Coefficients, lowest power first, of the real polynomial with these values on `_circle`."""
    return np.fft.irfft(values.conj()[: len(values)], 2 * (len(values) - 1))


def _converged(system: Blocks) -> tuple[Float, float, tuple[int, ...]]:
    """Monic coefficients, their error bound, and the truncations used."""
    n = system.n
    _, alpha = _circle(n)
    least = finite.least_truncation(system)
    levels = tuple(int(least * level) for level in LEVELS)
    values = np.array(
        [
            finite.determinants(system, alpha, M, system.squares)
            * np.exp(finite.log_pair_tail(system, alpha, M))
            for M in levels
        ]
    )
    finest, coarse = _extrapolate(values, levels), _extrapolate(values[1:], levels[1:])
    tail = float(np.max(np.abs(finest - coarse)))

    coefficients = _coefficients(finest)
    higher = coefficients[n:].copy()
    higher[0] -= 1.0  # Liouville: the leading coefficient is 1, and there are no others
    size = float(np.max(np.abs(values)))
    # each of the 2 pi w radians of z's argument is known to an ulp
    rounding = float(np.max(np.abs(higher))) + EPS * (8 + 2 * np.pi * system.highest) * size
    polynomial = np.append(1.0, coefficients[:n][::-1])
    return polynomial, SAFETY * (tail + rounding), levels


def _extrapolate(values: Complex, levels: tuple[int, ...]) -> Complex:
    """Limit of values(M) = limit + sum_k c_k M**-POWERS[k]."""
    ratio = np.array(levels) / levels[-1]
    powers = POWERS[: len(levels) - 1]
    basis = np.column_stack([np.ones(len(levels))] + [ratio**-p for p in powers])
    limit: Complex = np.linalg.solve(basis, values)[0]
    return limit


def _sampled(system: Blocks, M: int) -> Float:
    """P(z) of the finite determinant (6.2.8) itself, at points without poles."""
    _, alpha = _circle(system.n)
    diagonal = np.diag(system.Fbar).astype(complex)
    values = finite.determinants(system, alpha, M, diagonal)
    return np.append(1.0, _coefficients(values)[: system.n][::-1])
