"""The monodromy matrix of a general periodic equation, its multipliers, exponents and T.

Nothing is known of such an equation but its period, so all of that is integrated, in parts. Their
product is the monodromy matrix; multipliers that the product has lost, as they are smaller than its
rounding, come from the parts themselves (`floquet.general.modes`).
"""

from dataclasses import dataclass, replace

import numpy as np

from floquet.accuracy import OVERFLOW, ROUNDING_SAFETY, SAFETY, Bounded, bounded, largest_share
from floquet.arrays import EPS, Float
from floquet.charpoly import beyond_first_order, characteristic_polynomial
from floquet.eigenvalues import discs_from_matrix, discs_from_polynomial, sorted_eigenvalues
from floquet.general.mode_bounds import discs_one_by_one
from floquet.general.modes import merged, periodic_discs
from floquet.general.symmetry import pairs_decay
from floquet.growth import TINY, LogDiscs, growth_from_multipliers, logarithms
from floquet.integrate.methods import METHODS
from floquet.integrate.normal_form import NormalForm, normal_form
from floquet.integrate.parts import Grid, parts_needed
from floquet.integrate.parts_taylor import PartsTaylor
from floquet.products import chain
from floquet.result import Monodromy
from hill import PeriodicEquation
from hill.precision import remark

# Steps of the run and of its check in one part: orders 24 and 29 need steps in about that ratio.
STEPS, CHECK_STEPS = 3, 2
# The same where parts are as short as a step, so that none loses what decays.
SHORT_STEPS, SHORT_CHECK_STEPS = 2, 3

# The smallest multipliers are known to about this many ulps by the product; beyond, by the parts.
MAX_SPREAD = 1e4

# Rounding of a step, in ulps of the moduli summed.
ULPS = 1.5


@dataclass(frozen=True, eq=False)
class _Run:
    """What a method and its check make of the parts, and of their product; bounds as in `Parts`.

    `short` parts are known to a small part of their smallest singular values.
    """

    grid: Grid
    short: bool
    parts: Float
    check: Float
    parts_rounding: Float
    product: Float
    product_check: Float
    rounding: Float
    data: Float | None


def general_monodromy(
    equation: PeriodicEquation, method: str, rounded: Float | float = 0.0
) -> Monodromy:
    """As `floquet.monodromy`; `rounded` is what K is off already."""
    form = normal_form(equation, rounded)
    steps = PartsTaylor().steps(form)
    parts, times = parts_needed(steps, STEPS)
    run = _run(form, method, parts, STEPS * times, CHECK_STEPS * times)
    values = sorted_eigenvalues(run.product)
    if not np.min(np.abs(values)) * MAX_SPREAD > np.max(np.abs(values)):
        run = _run(form, method, steps, SHORT_STEPS, SHORT_CHECK_STEPS)
    found = bounded(run.product, run.product_check, run.rounding, ULPS, 0.0)
    further = beyond_first_order(run.product, float(np.linalg.norm(found.matrix_error)))
    # a coefficient that underflows is not known to be 0
    further[1:] += TINY
    found = replace(found, errors=found.errors + further)
    families = _families(run, found)
    m = len(run.product)
    mean = form.period * form.trace / m
    growth = growth_from_multipliers(families, form.period, mean)
    if growth.verdict == "undecided":
        growth = growth_from_multipliers(families, form.period, mean, pairs_decay(equation))
    value, off = logarithms(families)
    units = form.state_units(run.grid.unit)
    matrix, matrix_error = (units[:, None] * x / units for x in (run.product, found.matrix_error))
    with np.errstate(under="ignore"):
        multipliers = np.exp(value)
    return Monodromy(
        matrix=matrix,
        multipliers=multipliers,
        exponents=value / form.period,
        exponent_errors=off / form.period,
        polynomial=found.p,
        errors=found.errors,
        matrix_error=matrix_error,
        data_error=_data(run),
        z=np.empty(0, complex),
        T=growth.T,
        T_error=growth.T_error,
        verdict=growth.verdict,
        liouville_defect=_liouville(run.check, form),
        reversibility_defect=float("nan"),
        method=method,
        half_period=False,
        remark=remark(
            growth.T,
            growth.T_error,
            equation.Omega,
            growth.verdict,
            found.p,
            float(np.max(found.errors)),
        ),
    )


def _run(form: NormalForm, method: str, count: int, steps: int, check_steps: int) -> _Run:
    how = METHODS[method]
    grid = Grid.of(form, count, steps)
    with np.errstate(over="ignore", invalid="ignore"):
        own = PartsTaylor().bounded(form, grid)
        given = [x for x in (own.rounding, own.data) if x is not None]
        product, rounding, *rest = chain(own.matrices, *given)
    # not every method tells by itself that the solution is beyond a float
    if not all(np.all(np.isfinite(x)) for x in (product, rounding)):
        raise OverflowError(OVERFLOW)
    parts = own.matrices
    if how.parts != PartsTaylor():
        parts = how.parts(form, grid)
        (product,) = chain(parts)
    check = how.parts_check(form, grid.again(check_steps))
    (product_check,) = chain(check)
    return _Run(
        grid=grid,
        short=steps == SHORT_STEPS,
        parts=parts,
        check=check,
        parts_rounding=own.rounding,
        product=product,
        product_check=product_check,
        rounding=rounding,
        data=rest[0] if rest else None,
    )


def _families(run: _Run, found: Bounded) -> list[LogDiscs]:
    """Sets of discs, each of which holds all multipliers; the first are the best where possible."""
    values = sorted_eigenvalues(run.product)
    known = [
        discs_one_by_one(run.product, found.matrix_error),
        discs_from_matrix(run.product, found.matrix_error),
        discs_from_polynomial(values, found.p, found.errors),
    ]
    families = [LogDiscs.of(discs) for discs in known if discs is not None]
    if run.short:
        apart = np.abs(run.parts - run.check)
        of_all = largest_share(apart, run.parts_rounding) * run.parts_rounding
        own = ROUNDING_SAFETY * EPS * ULPS
        errors = SAFETY * np.maximum(apart, of_all) + own * run.parts_rounding
        families[:0] = periodic_discs(*merged(run.parts, errors))
    return families


def _data(run: _Run) -> float:
    """What the errors of the equation's numbers may move P by, to first order."""
    if run.data is None:
        return 0.0
    return float(np.max(characteristic_polynomial(run.product, run.data)[1]))


def _liouville(parts: Float, form: NormalForm) -> float:
    sign, log = np.linalg.slogdet(parts)
    ratio = float(np.sum(log) - form.period * form.trace)
    return float("inf") if ratio > 700.0 else float(np.abs(np.prod(sign) * np.exp(ratio) - 1.0))
